"""Splines in place of a curve: B-splines of degree 3 or 5, clamped, within a tolerance that is proven."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt, tau

import numpy as np

from optlaws.cams.curves.outline import MOST_PARTS, Outline, greatest_deviation, stretches
from optlaws.cams.curves.plane_curve import CurveByJets, PiecewiseCurve, closed_slopes
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet, Pair
from optlaws.tolerances import BEFORE_BREAK

DEGREES = (3, 5)
_FIRST = 48
_GROWTH = 1.25
_NEAR = 0.1  # how near the square of the deviation is enclosed


@dataclass(frozen=True, eq=False)
class Spline(CurveByJets):
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
        """The knots of the spline, each listed once, as an outline needs them."""
        return self._pieces.breaks


def spline(outline: Outline, tolerance: float, degree: int = 3) -> Spline:
    """The spline through points of an outline, nowhere farther from the outline than a tolerance in metres.

    One of degree 3 has a continuous curvature everywhere, at the seam as well. One of degree 5 ends at each break of
    the outline and begins again with its direction and curvature.
    """
    if degree not in DEGREES:
        raise InputError(f"degree of a spline must be 3 or 5, got {degree}")
    parts = _FIRST
    while parts <= MOST_PARTS:
        fitted = through(outline, even(outline, parts), degree, tolerance)
        if fitted.deviation <= tolerance:
            return fitted
        # the error of an interpolating spline falls with the power degree + 1 of the distance of its knots
        parts = int(parts * max(_GROWTH, 1.02 * (fitted.deviation / tolerance) ** (1.0 / (degree + 1)))) + 1
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
    return Spline(degree, fitted.knots, fitted.controls, _deviation(outline, fitted, tolerance))


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


def _deviation(outline: Outline, fitted: Spline, tolerance: float) -> float:
    """The proven greatest distance between places of one angle; a sampled one if that already is too great."""

    def square(angle: Array | Interval, order: int) -> Jet:
        (x, y), (along, up) = fitted.jets(angle, order), outline.jets(angle, order)
        return (x - along) * (x - along) + (y - up) * (y - up)

    farthest = greatest_deviation(square, np.array(fitted.breaks), tolerance**2, share=_NEAR, order=fitted.degree + 1)
    return sqrt(farthest) + 2.0 * fitted.blur
