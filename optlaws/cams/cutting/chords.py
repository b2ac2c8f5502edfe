"""Polygons in place of a curve: as few corners as a tolerance allows, and the greatest deviation proven."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.cutting.outline import Outline, curvature, divided, speed
from optlaws.series.enclosed import bounds

Array = NDArray[np.float64]

GROWTH = 1.06
FEWEST = 3


@dataclass(frozen=True, eq=False)
class Polygon:
    """A closed polygon with its corners on an outline.

    Attributes
    ----------
    corners
        Metres, shape (n, 2); the last one leads back to the first.
    angles
        Where on the outline they are, radians.
    deviation
        Proven: no place of the outline is farther from its chord, m.
    """

    corners: Array
    angles: Array
    deviation: float


def polygon(outline: Outline, tolerance: float) -> Polygon:
    """The polygon through points of an outline from which no place of it is farther than a tolerance in metres."""

    def density(angles: Array) -> Array:
        # a chord of the length c is c² curvature / 8 off
        return speed(outline, angles) * np.sqrt(np.abs(curvature(outline, angles)) / (8.0 * tolerance))

    factor = 1.0
    while True:
        angles = divided(outline, density, factor)
        deviation = float(_deviations(outline, angles).max()) if len(angles) > FEWEST else np.inf
        if deviation <= tolerance:
            return Polygon(outline(angles[:-1]), angles[:-1], deviation)
        factor *= GROWTH


def _deviations(outline: Outline, angles: Array) -> Array:
    """Of each chord, the greatest distance of the outline from it, as it is proven."""
    ends = outline(angles)
    chords = np.diff(ends, axis=0)
    normals = np.stack([-chords[:, 1], chords[:, 0]], axis=1) / np.linalg.norm(chords, axis=1)[:, None]

    def off(places: Array) -> Array:
        return np.asarray(np.einsum("nij,nj->ni", outline(places) - ends[:-1, None, :], normals))

    low, high = bounds(off, angles[:-1], angles[1:])
    return np.maximum(np.abs(low), np.abs(high))
