"""Plane curves as functions of the cam's angle, and curves of polynomials: points, derivatives, normals, offsets."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import comb
from typing import Any, Self

import numpy as np

from optlaws.numbers import Array, derivative, finite, number_or_array, real_times, whole
from optlaws.numerics import chebyshev
from optlaws.numerics.interval import Interval
from optlaws.numerics.splines import periodic_slopes
from optlaws.numerics.taylor import Jet, Pair
from optlaws.tolerances import ROUNDOFF

_CONTROL_POINT_BLUR = 128.0 * ROUNDOFF  # of the greatest control point: values are means of these

_MOST = 1_000_000


class Outline(ABC):
    """A closed plane curve that is known by its jets, over a parameter of its own or over the cam's angle.

    Between `breaks`, which increase, over the cam's angle from 0 to 2 pi, it is smooth. In intervals of places `jets`
    encloses it: statements on deviations rest on that.
    """

    @property
    @abstractmethod
    def breaks(self) -> tuple[float, ...]:
        """Places between which it is smooth, both ends included."""

    @abstractmethod
    def jets(self, places: Array | Interval, order: int, /) -> Pair:
        """Both coordinates with their Taylor terms by the parameter, at places or in intervals between breaks."""

    def __call__(self, places: Array, nu: int = 0) -> Array:
        """Points in metres, or derivatives by the parameter, shape of `places` and two more."""
        return np.stack([jet.derivative(nu) for jet in self.jets(np.asarray(places, dtype=np.float64), nu)], axis=-1)


@dataclass(frozen=True, eq=False)
class PiecewiseCurve(Outline):
    """Polynomials between knots, a row of coordinates each: what is enclosed are these, which are splines to rounding.

    `powers` are ascending in t, |t| <= 1 between two knots, shape (degree + 1, n, coordinates); coordinates may be
    `blur` away from those of the spline, for rounding.
    """

    knots: Array
    powers: Array
    blur: float

    @classmethod
    def of_spline(cls, knots: Array, controls: Array, degree: int) -> Self:
        """The pieces of a B-spline, control points of shape (count, coordinates), by de Boor's algorithm."""
        places = np.unique(knots[degree : len(knots) - degree])
        spans = np.searchsorted(knots, places[:-1], side="right") - 1
        t = chebyshev.nodes(degree + 1)
        at = 0.5 * (places[1:] + places[:-1]) + np.multiply.outer(t, 0.5 * np.diff(places))
        values = [
            np.broadcast_to(controls[spans - degree + k], (*at.shape, controls.shape[1])) for k in range(degree + 1)
        ]
        for r in range(1, degree + 1):
            for k in range(degree, r - 1, -1):
                low, high = knots[spans - degree + k], knots[spans + k + 1 - r]
                share = ((at - low) / (high - low))[..., None]
                values[k] = (1.0 - share) * values[k - 1] + share * values[k]
        powers = np.einsum("kt,tnd->knd", np.linalg.inv(np.vander(t, increasing=True)), values[degree])
        return cls(places, powers, _CONTROL_POINT_BLUR * float(np.abs(controls).max()))

    @classmethod
    def closed(cls, places: Array, values: Array) -> Self:
        """The closed cubic spline through rows of values, the last of which is the first again."""
        width, rises = np.diff(places)[:, None], np.diff(values, axis=0)
        slopes = closed_slopes(places, values)
        half, before, after = 0.5 * width, slopes[:-1], slopes[1:]
        bend, twist = 0.25 * half * (after - before), 0.25 * half * (after + before)
        powers = np.array([0.5 * (values[:-1] + values[1:]) - bend, 0.75 * rises - twist, bend, twist - 0.25 * rises])
        return cls(places, powers, _CONTROL_POINT_BLUR * float(np.abs(values).max()))

    @property
    def breaks(self) -> tuple[float, ...]:
        return tuple(self.knots.tolist())

    def jets(self, places: Array | Interval, order: int) -> Any:
        """The Taylor terms of each coordinate; intervals must lie between two knots."""
        middle = places.middle if isinstance(places, Interval) else np.asarray(places)
        piece = np.clip(np.searchsorted(self.knots, middle, side="right") - 1, 0, len(self.knots) - 2)
        low, high = self.knots[:-1], self.knots[1:]
        half, powers = 0.5 * (high - low)[piece], self.powers[:, piece]
        t = (places - 0.5 * (high + low)[piece]) / half
        return [
            Jet(tuple(_term(powers[..., i], t, half, nu) for nu in range(order + 1))) for i in range(powers.shape[2])
        ]


def closed_slopes(places: Array, values: Array) -> Array:
    """The slopes at its places of the closed cubic spline through rows of values; the last is the first again."""
    steps = np.diff(places)
    return np.column_stack([periodic_slopes(steps, np.diff(column) / steps) for column in values.T])


def _term(powers: Array, t: Any, half: Array, nu: int) -> Any:
    total = t * 0.0
    for k in range(len(powers) - 1, nu - 1, -1):
        total = total * t + comb(k, nu) * powers[k]
    return total / half**nu


class CurveByAngle(ABC):
    """A curve on a cam as a function of the cam's angle; call it for points or derivatives by the angle."""

    @property
    @abstractmethod
    def breaks(self) -> tuple[float, ...]:
        """Angles between which it is smooth, both ends included, rad."""

    @abstractmethod
    def jets(self, angle: Any, order: int, *, before: bool = False) -> tuple[Jet, ...]:
        """The coordinates with their derivatives up to an order."""

    def __call__(self, angle: Any, nu: int = 0, *, before: bool = False) -> Array:
        """Points, or derivatives of order nu by the angle, m.

        Parameters
        ----------
        angle
            Of the cam, rad; a number or an array of any shape.
        nu
            Order of the derivative.
        before
            At a break, take what is just before it.

        Returns
        -------
        An array of the shape of `angle` and one more axis: x and y, of a curve in space z too.

        Raises
        ------
        InputError
            If an angle is no finite number, or out of the interval of a curve that is not closed; so do other methods.
        """
        nu = derivative(nu)
        jets = self.jets(real_times(angle), nu, before=before)
        return np.stack([jet.derivative(nu) for jet in jets], axis=-1)


class PlaneCurve(CurveByAngle, Outline):
    """A curve around a cam's centre, as a function of the cam's angle; call it for points or derivatives by the angle.

    Coordinates are those of the cam, in metres, with the follower's at the angle 0; angles are in radians. Curves are
    as smooth as the motion; at its breaks they have their values just after them, or with `before=True` just before.

    Examples
    --------
    >>> from optlaws import DiscCam
    >>> from optlaws import CamMotion
    >>> from optlaws import TranslatingRoller
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> pitch = DiscCam(rise, prime_radius="80 mm", follower=TranslatingRoller("12 mm")).pitch_curve
    >>> pitch([0.0, 1.0]).shape, pitch(1.0, nu=2).shape, round(float(np.hypot(*pitch(0.0))), 9)
    ((2, 2), (2,), 0.08)
    """

    @property
    @abstractmethod
    def closed(self) -> bool:
        """Whether the curve returns to its start after a turn."""

    @property
    @abstractmethod
    def turning(self) -> float:
        """1 where it is run through clockwise as the angle grows, under a cam that turns counterclockwise; else -1."""

    @abstractmethod
    def jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> Pair:
        """Both coordinates with their derivatives up to an order, in intervals between two breaks all they may be."""

    @property
    def interval(self) -> tuple[float, float]:
        """The first and the last angle, rad."""
        return self.breaks[0], self.breaks[-1]

    def normal(self, angle: Any, *, before: bool = False) -> Array:
        """The unit normal away from the cam, shape of `angle` and two more."""
        x, y = self.normal_jets(real_times(angle), 0, before=before)
        return np.stack([x.terms[0], y.terms[0]], axis=-1)

    def tangent(self, angle: Any, *, before: bool = False) -> Array:
        """The unit tangent, in the direction in which the angle grows."""
        x, y = self.normal_jets(real_times(angle), 0, before=before)
        return self.turning * np.stack([y.terms[0], -x.terms[0]], axis=-1)

    def curvature(self, angle: Any, *, before: bool = False) -> Any:
        """The curvature, 1/m: above 0 where the curve is convex, below where it is concave.

        It is infinite at a cusp, and negative beyond one that ends in a loop.
        """
        x, y = self.jets(real_times(angle), 2, before=before)
        tangents, (nx, ny) = (x.slope(), y.slope()), self.normal_jets(real_times(angle), 1, before=before)
        # the normal turns by the curvature times the way along the tangent
        sign = self.turning
        along = (tangents[0].terms[0] * ny.terms[0] - tangents[1].terms[0] * nx.terms[0]) * sign
        turns = (nx.terms[1] * ny.terms[0] - ny.terms[1] * nx.terms[0]) * sign
        with np.errstate(divide="ignore", invalid="ignore"):
            return number_or_array(turns / along)

    def radius_of_curvature(self, angle: Any, *, before: bool = False) -> Any:
        """The radius of curvature, m, with the sign of the curvature; infinite where the curve is straight."""
        with np.errstate(divide="ignore"):
            return number_or_array(1.0 / np.asarray(self.curvature(angle, before=before)))

    def offset(self, distance: float) -> OffsetCurve:
        """The parallel curve at a distance in metres: outward, or inward where the distance is negative."""
        return OffsetCurve(self, finite(distance, "distance"))

    def samples(self, count: int = 721) -> tuple[Array, Array]:
        """Equally spaced angles with every break among them, and the points there."""
        even = np.linspace(*self.interval, whole(count, "count", least=2, most=_MOST))
        angles = np.unique(np.concatenate([even, self.breaks]))
        return angles, self(angles)

    def normal_jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> Pair:
        """The unit normal away from the cam with its derivatives up to an order."""
        x, y = (jet.slope() for jet in self.jets(angle, order + 1, before=before))
        length = (x * x + y * y).root()
        return y / length * -self.turning, x / length * self.turning

    def frame_jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> tuple[Pair, Pair]:
        """Points and unit normals with their derivatives up to an order."""
        return self.jets(angle, order, before=before), self.normal_jets(angle, order, before=before)


@dataclass(frozen=True)
class CurveAlongNormals(PlaneCurve):
    """A curve that is off another along its normals."""

    base: PlaneCurve

    @property
    def breaks(self) -> tuple[float, ...]:
        return self.base.breaks

    @property
    def closed(self) -> bool:
        return self.base.closed

    @property
    def turning(self) -> float:
        return self.base.turning


@dataclass(frozen=True)
class OffsetCurve(CurveAlongNormals):
    """The curve at a distance from another, along its normals; outward where the distance is above 0, m."""

    distance: float

    def jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> Pair:
        if self.distance == 0.0:
            return self.base.jets(angle, order, before=before)
        return self.frame_jets(angle, order, before=before)[0]

    def normal_jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> Pair:
        return self.base.normal_jets(angle, order, before=before)

    def frame_jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> tuple[Pair, Pair]:
        (x, y), normal = self.base.frame_jets(angle, order, before=before)
        if self.distance == 0.0:
            return (x, y), normal
        return (x + normal[0] * self.distance, y + normal[1] * self.distance), normal

    def offset(self, distance: float) -> OffsetCurve:
        return OffsetCurve(self.base, self.distance + finite(distance, "distance"))
