"""Polygons and tangent arcs in place of a curve, within a tolerance that is proven."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from optlaws.cams.curves.outline import Outline, curvature, divided, greatest_deviation, speed
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval, middle
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import DEVIATIONS, RADIUS_ROUNDING

GROWTH = 1.06
FEWEST = 3


@dataclass(frozen=True, eq=False)
class Polygon:
    """A closed polygon with corners at angles of an outline, m, shape (n, 2), and the proven deviation from that."""

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
    """The proven greatest distance of the outline from its chords; a sampled one if that already is too great."""
    ends = outline(angles)
    chords = np.diff(ends, axis=0)
    normals = np.stack([-chords[:, 1], chords[:, 0]], axis=1) / np.linalg.norm(chords, axis=1)[:, None]

    def off(angle: Array | Interval, order: int) -> Jet:
        which = np.searchsorted(angles[1:-1], middle(angle))
        x, y = outline.jets(angle, order)
        distance: Jet = (x - ends[which, 0]) * normals[which, 0] + (y - ends[which, 1]) * normals[which, 1]
        return distance

    return greatest_deviation(off, angles, tolerance, share=DEVIATIONS)


STRAIGHT = 1e3  # radius in metres from which an arc is a line
_STEPS = 5
_CUBED = 192.0  # a pair of arcs over the length s is s³ dκ/ds / 192 off, or nearly
_ARC_NEAR = 1e-2  # how near deviations are enclosed
_SMALL = 0.9


@dataclass(frozen=True, eq=False)
class Arcs:
    """A closed chain of arcs, each touching the next; no place of the outline is `deviation` off, m: proven.

    `points` are where arcs begin, m, shape (n, 2); `bulges` the tangents of a quarter of their angles, positive where
    an arc turns left, 0 for a line, shape (n,).
    """

    points: Array
    bulges: Array
    deviation: float

    @property
    def ends(self) -> Array:
        """The end points of the arcs, m, shape (n, 2)."""
        return np.roll(self.points, -1, axis=0)

    @property
    def radii(self) -> Array:
        """Radii, m; inf for lines."""
        chords = np.linalg.norm(self.ends - self.points, axis=1)
        with np.errstate(divide="ignore"):
            return np.asarray(chords * (1.0 + self.bulges**2) / (4.0 * np.abs(self.bulges)))

    @property
    def centres(self) -> Array:
        """Centres, m, shape (n, 2); not finite for lines."""
        return _centres(self.points, self.ends, self.bulges)


def arcs(outline: Outline, tolerance: float) -> Arcs:
    """Tangent arcs from which no place of an outline is farther than a tolerance in metres.

    Between two places of the outline with its directions there stands a pair of arcs that touch each other, so that
    the chain has no corner; the curvature jumps from arc to arc.
    """

    def density(angles: Array) -> Array:
        # how far a pair of arcs is off grows with the change of the curvature along it, and with its length cubed
        step = 1e-4
        turned = curvature(outline, angles + 0.5 * step) - curvature(outline, angles - 0.5 * step)
        along = speed(outline, angles)
        return along * np.cbrt(np.abs(turned) / (step * along) / (_CUBED * tolerance))

    factor = 1.0
    while True:
        angles = divided(outline, density, factor)
        if len(angles) <= FEWEST:
            factor *= GROWTH
            continue
        chain = _chain(outline, angles, tolerance)
        if chain.deviation <= tolerance + RADIUS_ROUNDING:
            return chain
        factor *= max(GROWTH, float(np.cbrt(chain.deviation / tolerance)))


def _chain(outline: Outline, angles: Array, tolerance: float) -> Arcs:
    points, tangents = outline(angles), _directions(outline, angles)
    joints = _joints(points[:-1], points[1:], tangents[:-1], tangents[1:])
    corners = np.stack([points[:-1], joints], axis=1).reshape(-1, 2)
    bulges = np.empty(len(corners))
    bulges[0::2] = _bulges(points[:-1], joints, tangents[:-1])
    bulges[1::2] = -_bulges(points[1:], joints, -tangents[1:])
    places = np.append(np.stack([angles[:-1], _beside(outline, angles, joints)], axis=1).ravel(), angles[-1])
    return Arcs(corners, bulges, _arc_deviation(outline, places, Arcs(corners, bulges, 0.0), tolerance))


def _directions(outline: Outline, angles: Array) -> Array:
    first = outline(angles, 1)
    return np.asarray(first / np.linalg.norm(first, axis=-1, keepdims=True))


def _joints(starts: Array, ends: Array, first: Array, last: Array) -> Array:
    """The points where the two arcs of each pair meet, both reaching equally far along their tangents."""
    across = ends - starts
    both = first + last
    square = np.einsum("ij,ij->i", across, across)
    along = np.einsum("ij,ij->i", across, both)
    turned = 2.0 * (1.0 - np.einsum("ij,ij->i", first, last))
    # turned reach² + 2 along reach = square, written so that it keeps its digits where nothing turns
    reach = square / (along + np.sqrt(along**2 + turned * square))
    return np.asarray(0.5 * (starts + ends + reach[:, None] * (first - last)))


def _bulges(starts: Array, ends: Array, tangents: Array) -> Array:
    """The tangent of a quarter of the angle of arcs that leave along tangents."""
    chords = ends - starts
    turn = tangents[:, 0] * chords[:, 1] - tangents[:, 1] * chords[:, 0]
    along = np.einsum("ij,ij->i", tangents, chords)
    half = np.arctan2(turn, along)
    bulges = np.tan(0.5 * half)
    lengths = np.linalg.norm(chords, axis=1)
    return np.where(np.abs(bulges) * 4.0 * STRAIGHT < lengths, 0.0, bulges)


def _beside(outline: Outline, angles: Array, joints: Array) -> Array:
    """Angles at which the outline passes the joints: where they are straight beside it."""
    at = 0.5 * (angles[:-1] + angles[1:])
    for _ in range(_STEPS):
        x, y = outline.jets(at, 1)
        (along, up), (beyond, above) = ((jet.terms[1] for jet in (x, y)), (joints.T - [x.terms[0], y.terms[0]]))
        step = (beyond * along + above * up) / (along * along + up * up)
        at = np.clip(at + step, angles[:-1], angles[1:])
    return at


def _centres(starts: Array, ends: Array, bulges: Array) -> Array:
    chords = ends - starts
    left = np.stack([-chords[:, 1], chords[:, 0]], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return 0.5 * (starts + ends) + ((1.0 - bulges**2) / (4.0 * bulges))[:, None] * left


def _arc_deviation(outline: Outline, places: Array, chain: Arcs, tolerance: float) -> float:
    """The proven greatest distance of the outline from its arcs; a sampled one if that already is too great."""
    starts, bulges, chords = chain.points, chain.bulges, chain.ends - chain.points
    lengths = np.linalg.norm(chords, axis=1)
    along = chords / lengths[:, None]
    bends = 4.0 * bulges / ((1.0 + bulges**2) * lengths)
    height = 0.5 * lengths * bulges  # of the arc over the middle of its chord, to the right

    def off(angle: Array | Interval, order: int) -> Jet:
        # distance from the circle, up to second order in it: exact at 0, and finite for lines
        i = np.searchsorted(places[1:-1], middle(angle))
        x, y = outline.jets(angle, order)
        x, y = x - starts[i, 0], y - starts[i, 1]
        x, y = x * along[i, 0] + y * along[i, 1] - 0.5 * lengths[i], y * along[i, 0] - x * along[i, 1] + height[i]
        distance: Jet = y - (x * x + y * y) * (0.5 * bends[i])
        return distance

    most = greatest_deviation(off, places, tolerance + RADIUS_ROUNDING, share=_ARC_NEAR)
    # e = d + bend d²/2 for the distance d to the right: |d| <= |e| / (1 - |bend e|) where bend e is small
    share = float(np.abs(bends).max()) * most
    return most / (1.0 - share) if share < _SMALL else np.inf
