"""Polygons in place of a curve: as few corners as a tolerance allows, and the greatest deviation proven."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.cutting.outline import Outline, curvature, divided, greatest_deviation, speed
from optlaws.series.enclosures.interval_arrays import Interval, middle
from optlaws.series.enclosures.jets import Jet

Array = NDArray[np.float64]

GROWTH = 1.06
FEWEST = 3
_NEAR = 1e-3  # how near deviations are enclosed


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
        deviation = _deviation(outline, angles, tolerance) if len(angles) > FEWEST else np.inf
        if deviation <= tolerance:
            return Polygon(outline(angles[:-1]), angles[:-1], deviation)
        factor *= GROWTH


def _deviation(outline: Outline, angles: Array, tolerance: float) -> float:
    """The greatest distance of the outline from its chords, as it is proven; one that is met where that is too far."""
    ends = outline(angles)
    chords = np.diff(ends, axis=0)
    normals = np.stack([-chords[:, 1], chords[:, 0]], axis=1) / np.linalg.norm(chords, axis=1)[:, None]

    def off(angle: Array | Interval, order: int) -> Jet:
        which = np.searchsorted(angles[1:-1], middle(angle))
        x, y = outline.jets(angle, order)
        distance: Jet = (x - ends[which, 0]) * normals[which, 0] + (y - ends[which, 1]) * normals[which, 1]
        return distance

    return greatest_deviation(off, angles, tolerance, share=_NEAR)
