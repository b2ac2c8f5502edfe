"""Points as a target stores them, with its rounding, and the motion that it computes from them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.format import Request
from optlaws.exports.spacing import PointTable, chosen, places
from optlaws.motion.motion import Motion
from optlaws.numbers import Array
from optlaws.numerics.splines import Ends, hermite_powers, linear_powers, spline_powers
from optlaws.tolerances import CLOSURE

_TABLE_ROUNDING = 2.0**-46  # of a column of a table: less is printed as 0

#: by interpolations: how many derivatives points have, with the position
HERMITE = {"c1": 2, "quintic": 3, "septic": 4}
DEGREES = {1: "linear", 2: "cubic Hermite", 3: "quintic Hermite", 4: "Hermite of degree 7"}


@dataclass(frozen=True)
class NumberFormat:
    """The numbers that a target holds: steps over the stroke, digits behind the decimal sign, doubles or REAL32."""

    counts: int | None = None
    digits: int | None = None
    single: bool = False

    def resolution(self, motion: Motion) -> float:
        """Step of positions in units of the slave; 0 for doubles."""
        top = max(abs(value) for value, _ in motion.extrema(0))
        return max(
            motion.stroke / self.counts if self.counts else 0.0,
            0.0 if self.digits is None else 10.0**-self.digits,
            float(np.spacing(np.float32(top))) if self.single else 0.0,
        )

    def positions(self, y: Array, motion: Motion) -> Array:
        """Positions as the target stores them."""
        step = motion.stroke / self.counts if self.counts else 0.0
        return self.numbers(np.rint(y / step) * step if step else y)

    def numbers(self, values: Array) -> Array:
        """Numbers as the target stores them."""
        rounded = values if self.digits is None else np.round(values, self.digits)
        return (rounded.astype(np.float32).astype(np.float64) if self.single else rounded) + 0.0


#: how many points, or the places of the master where they are
Points = int | Array


def point_table(
    motion: Motion, points: Points, numbers: NumberFormat, interpolation: str, *, ends: Ends = "clamped"
) -> PointTable:
    """Points as the target stores them and what it lays between them: linear, cubic, akima, c1, quintic or septic.

    A spline is clamped to the velocities of the motion's ends, natural, or periodic: then it ends exactly where it
    begins, as the motion does but for rounding.
    """
    if interpolation in HERMITE:
        return hermite_table(motion, points, numbers, HERMITE[interpolation])
    exact = points if isinstance(points, np.ndarray) else places(motion, points, straight=interpolation == "linear")
    x = numbers.numbers(exact)
    if (np.diff(x) <= 0.0).any():
        raise InputError(
            f"{len(x)} points of the master are closer than the digits can represent: take fewer points, more digits, "
            "or a unit that is smaller"
        )
    y, resolution = numbers.positions(np.asarray(motion(exact)), motion), numbers.resolution(motion)
    if interpolation != "cubic":
        powers = linear_powers(x, y) if interpolation == "linear" else akima_powers(x, y)
        return PointTable(x, y[None], powers, resolution)
    if ends == "periodic":
        y[-1] = y[0]
    slopes = end_slopes(motion, numbers)
    powers = spline_powers(x, y, ends, (float(slopes[0]), float(slopes[1])))
    return PointTable(x, y[None], powers, resolution, partial(rounding_bound, motion, x, y, slopes))


def end_slopes(motion: Motion, number_format: NumberFormat) -> Array:
    """The velocities of a motion's ends as the target stores them, 0 where rounding beside the mean has missed it."""
    slopes = np.array(motion.ends(1))
    rounding = _TABLE_ROUNDING * motion.stroke / motion.length
    return number_format.numbers(np.where(np.abs(slopes) <= rounding, 0.0, slopes))


def akima_powers(x: Array, y: Array) -> Array:
    """Akima's cubics in ascending powers, as in Modelica's tables: the acceleration jumps at each point.

    >>> x = np.linspace(0.0, 1.0, 6)
    >>> akima_powers(x, x**2)[0].round(9).tolist()
    [0.0, 0.0, 1.0, 0.0]
    """
    from scipy.interpolate import Akima1DInterpolator

    return np.asarray(Akima1DInterpolator(x, y).c.T[:, ::-1])


def hermite_table(
    motion: Motion, points: Points, numbers: NumberFormat, orders: int, *, with_derivatives: bool = True
) -> PointTable:
    """Positions with derivatives for Hermite polynomials of the controller; their number or places are given.

    Where the table has no derivatives the controller computes them, and they are taken as the law's.
    """
    exact = points if isinstance(points, np.ndarray) else places(motion, points, straight=True)
    values = _without_rounding(np.array([motion(exact, nu) for nu in range(orders)]))
    if not np.isfinite(values).all():
        raise InputError(
            "the law's acceleration or jerk is infinite at a point: export positions alone, or another law"
        )
    x = numbers.numbers(exact)
    derivatives = numbers.numbers(values[1:]) if with_derivatives else values[1:]
    stored_values = np.vstack([numbers.positions(values[0], motion)[None], derivatives])
    return PointTable(x, stored_values, hermite_powers(x, stored_values), numbers.resolution(motion))


def chosen_table(
    motion: Motion,
    request: Request,
    interpolation: str,
    most: int,
    *,
    least: int = 2,
    single: bool = False,
    ends: Ends = "clamped",
) -> PointTable:
    """The table for an interpolation with the requested number of points, or with the best number."""
    numbers = NumberFormat(request.counts, request.digits, single)
    make = partial(point_table, motion, numbers=numbers, interpolation=interpolation, ends=ends)
    return chosen(motion, request, make, least=least, most=most)


def is_cyclic(motion: Motion) -> bool:
    """Whether a motion repeats itself where it began."""
    return motion.repeats and abs(motion.advance) <= CLOSURE * motion.stroke


def _without_rounding(values: Array) -> Array:
    """The values with 0 where rounding, beside the greatest of their row, has missed it."""
    return np.where(np.abs(values) <= _TABLE_ROUNDING * np.abs(values).max(axis=1, keepdims=True), 0.0, values)


def rounding_bound(motion: Motion, x: Array, y: Array, slopes: Array) -> float:
    """The greatest addition of roundings to the acceleration of a clamped cubic spline: 6 eps/dx², for errors of eps/2.

    The spline's accelerations at its points solve a system whose diagonal is twice the sum of what is beside it, with
    six times the second divided differences of the positions on the right; these are wrong by eps/(h_i h_i+1) at most.

    >>> from optlaws.motion.motion import motion_of_law
    >>> from optlaws import smoothstep
    >>> motion = motion_of_law(smoothstep(3), stroke="1 m", duration="1 s")
    >>> x = np.linspace(0.0, 1.0, 11)
    >>> round(rounding_bound(motion, x, motion(x) + 0.001 * (-1.0) ** np.arange(11), np.zeros(2)), 9)
    1.2
    """
    exact = np.asarray(motion(np.clip(x, motion.start, motion.stop)))
    eps = 2.0 * float(np.abs(y - exact).max())
    steps = np.diff(x)
    ends = np.abs(slopes - np.array(motion.ends(1))) * 6.0 / steps[[0, -1]]
    inner = float((6.0 * eps / (steps[1:] * steps[:-1])).max(initial=0.0))
    return max(inner, float((6.0 * eps / steps[[0, -1]] ** 2 + ends).max()))
