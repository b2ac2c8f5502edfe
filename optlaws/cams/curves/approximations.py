"""Polygons, tangent arcs and splines in place of an outline, within a tolerance that is proven."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, inf, sqrt, tau
from typing import Any

import numpy as np

from optlaws.cams.curves.plane_curve import Outline, PiecewiseCurve, closed_slopes
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.branch_and_bound import extremes
from optlaws.numerics.interval import Interval, middle
from optlaws.numerics.taylor import Jet, Pair
from optlaws.tolerances import BEFORE_BREAK, DEVIATIONS, RADIUS_ROUNDING

_SMALLEST_SPEED = 1e-9  # of a place on an outline, so that shares of it can be taken
_OUTLINE_SHARE = 1e-3  # no part of an outline is left without places, however straight it is

Density = Callable[[Array], Array]

MOST_PARTS = 200_000
_SAMPLES = 1025


def stretches(outline: Outline) -> list[tuple[float, float]]:
    """The smooth stretches of an outline, in radians."""
    breaks = [float(place) for place in outline.breaks]
    if len(breaks) < 2 or abs(breaks[0]) > 1e-12 or abs(breaks[-1] - tau) > 1e-9:
        raise InputError("only a closed outline can be cut: its breaks must run from 0 to a whole turn")
    return list(pairwise(breaks))


def divided(outline: Outline, density: Density, factor: float = 1.0) -> Array:
    """Angles from 0 to a whole turn, the breaks among them, at a multiple of a density in parts per radian."""
    shares = [_accumulated(density, *ends) for ends in stretches(outline)]
    parts = factor * sum(float(sums[-1]) for _, sums in shares)
    if parts > MOST_PARTS:
        raise InputError(f"tolerance requires {parts:.3g} parts, more than {MOST_PARTS}: give a wider one")
    cuts = [np.zeros(1)]
    for places, sums in shares:
        count = max(1, ceil(factor * float(sums[-1])))
        cuts.append(np.interp(np.linspace(0.0, float(sums[-1]), count + 1)[1:], sums, places))
    return np.concatenate(cuts)


def _accumulated(density: Density, start: float, stop: float) -> tuple[Array, Array]:
    """Places on a stretch, and the density integrated up to them."""
    places = np.linspace(start, stop, _SAMPLES)
    values = density(0.5 * (places[1:] + places[:-1]))
    values = values + _OUTLINE_SHARE * max(float(values.max()), _SMALLEST_SPEED)
    return places, np.append(0.0, np.cumsum(values)) * (stop - start) / (_SAMPLES - 1)


def curvature(outline: Outline, angles: Array) -> Array:
    """Signed curvature, 1/m: positive where the outline turns left as the angle grows."""
    first, second = outline(angles, 1), outline(angles, 2)
    speed = np.hypot(first[..., 0], first[..., 1])
    return np.asarray((first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]) / speed**3)


def speed(outline: Outline, angles: Array) -> Array:
    """Metres per radian along the outline."""
    first = outline(angles, 1)
    return np.hypot(first[..., 0], first[..., 1])


def greatest_deviation(
    off: Callable[[Any, int], Jet], places: Array, tolerance: float, *, share: float, order: int = 2
) -> float:
    """The greatest magnitude of a deviation between places where it is smooth, as `extremes` proves it.

    Where it is above a tolerance, it is one that the deviation has.
    """
    met = float(np.abs(off(0.5 * (places[1:] + places[:-1]), 0).terms[0]).max())
    if met > tolerance:
        return met
    known = extremes(off, places, share=share, order=order, enough=tolerance, magnitude=True)
    return known.peak if known.peak > tolerance else known.bound


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
        deviation = _chord_deviation(outline, angles, tolerance) if len(angles) > FEWEST else np.inf
        if deviation <= tolerance:
            return Polygon(outline(angles[:-1]), angles[:-1], deviation)
        factor *= GROWTH


def _chord_deviation(outline: Outline, angles: Array, tolerance: float) -> float:
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


DEGREES = (3, 5)
_FIRST_PIECES = 48
_MORE_PIECES = 1.25
_NEAR = 0.1  # how near the square of the deviation is enclosed


@dataclass(frozen=True, eq=False)
class Spline(Outline):
    """A closed clamped B-spline of degree 3 or 5 over the cam's angle, rad, control points in m, shape (n, 2).

    At no angle is it farther from the outline than `deviation`, m: proven.
    """

    degree: int
    knots: Array
    controls: Array
    deviation: float

    @kept_property
    def _pieces(self) -> PiecewiseCurve:
        return PiecewiseCurve.of_spline(self.knots, self.controls, self.degree)

    @property
    def blur(self) -> float:
        """The distance by which rounding can separate the enclosed polynomials from the spline, m."""
        return self._pieces.blur

    def jets(self, places: Array | Interval, order: int) -> Pair:
        x, y = self._pieces.jets(places, order)
        return x, y

    @property
    def breaks(self) -> tuple[float, ...]:
        return self._pieces.breaks


def spline(outline: Outline, tolerance: float, degree: int = 3) -> Spline:
    """The spline through points of an outline, nowhere farther from the outline than a tolerance in metres.

    One of degree 3 has a continuous curvature everywhere, at the seam as well. One of degree 5 ends at each break of
    the outline and begins again with its direction and curvature.
    """
    if degree not in DEGREES:
        raise InputError(f"degree of a spline must be 3 or 5, got {degree}")
    parts = _FIRST_PIECES
    while parts <= MOST_PARTS:
        fitted = through(outline, even(outline, parts), degree, tolerance)
        if fitted.deviation <= tolerance:
            return fitted
        # the error of an interpolating spline falls with the power degree + 1 of the distance of its knots
        parts = int(parts * max(_MORE_PIECES, 1.02 * (fitted.deviation / tolerance) ** (1.0 / (degree + 1)))) + 1
    raise InputError(f"tolerance requires more than {MOST_PARTS} pieces of degree {degree}: give a wider one")


def even(outline: Outline, parts: int) -> Array:
    """Angles from 0 to a whole turn, the breaks among them, with steps of at most a share of the turn."""
    fitted = [np.zeros(1)]
    for start, stop in stretches(outline):
        count = max(1, round(parts * (stop - start) / tau))
        fitted.append(np.linspace(start, stop, count + 1)[1:])
    return np.concatenate(fitted)


def through(outline: Outline, angles: Array, degree: int, tolerance: float = inf) -> Spline:
    """The spline through the places of an outline at angles from 0 to a whole turn, its breaks among them.

    Where it is farther off than a tolerance, its deviation is one that it has, and not proven to be the greatest.
    """
    runs = [(0.0, float(angles[-1]))] if degree == 3 else stretches(outline)
    knots, controls = [np.zeros(1)], [outline(np.zeros(1))]
    for start, stop in runs:
        inside = angles[(angles >= start - 1e-12) & (angles <= stop + 1e-12)]
        own_knots, own_controls = _clamped(outline, inside, degree)
        knots.append(own_knots[1 : -degree - 1] if len(knots) == 1 else own_knots[degree + 1 : -degree - 1])
        knots.append(np.full(degree, stop))
        controls.append(own_controls[1:])
    whole = np.append(np.concatenate(knots), angles[-1])
    fitted = Spline(degree, whole, np.concatenate(controls), 0.0)
    return Spline(degree, fitted.knots, fitted.controls, _spline_deviation(outline, fitted, tolerance))


def _clamped(outline: Outline, angles: Array, degree: int) -> tuple[Array, Array]:
    """Knots and control points through places, with derivatives given at both ends."""
    points = outline(angles)
    if degree == 3:
        points[-1] = points[0]
        return _closed(angles, points)
    from scipy.interpolate import make_interp_spline

    ends = (
        _derivatives(outline, angles[0]),
        _derivatives(outline, angles[-1] - BEFORE_BREAK * (angles[-1] - angles[-2])),
    )
    spline = make_interp_spline(angles, points, k=degree, bc_type=ends)  # type: ignore[arg-type] # stubs know no pairs
    return np.asarray(spline.t), np.asarray(spline.c)


def _closed(angles: Array, points: Array) -> tuple[Array, Array]:
    """Knots and control points of the closed cubic spline: its polar forms of three knots in a row."""
    slopes, widths = closed_slopes(angles, points), np.diff(angles)[:, None]
    bends = (6.0 * np.diff(points, axis=0) / widths - 4.0 * slopes[:-1] - 2.0 * slopes[1:]) / widths
    before, after = np.pad(-widths, ((1, 0), (0, 0))), np.pad(widths, ((0, 1), (0, 0)))
    inner = points + slopes * (before + after) / 3.0 + np.vstack([bends, bends[:1]]) * before * after / 6.0
    return np.pad(angles, 3, mode="edge"), np.vstack([points[:1], inner, points[-1:]])


def _derivatives(outline: Outline, angle: float) -> list[tuple[int, Array]]:
    return [(nu, outline(np.array([angle]), nu)[0]) for nu in (1, 2)]


def _spline_deviation(outline: Outline, fitted: Spline, tolerance: float) -> float:
    """The proven greatest distance between places of one angle; a sampled one if that already is too great."""

    def square(angle: Array | Interval, order: int) -> Jet:
        (x, y), (along, up) = fitted.jets(angle, order), outline.jets(angle, order)
        return (x - along) * (x - along) + (y - up) * (y - up)

    farthest = greatest_deviation(square, np.array(fitted.breaks), tolerance**2, share=_NEAR, order=fitted.degree + 1)
    return sqrt(farthest) + 2.0 * fitted.blur
