"""How controllers interpolate tables: each way as polynomials between the points, which then have exact peaks."""

from __future__ import annotations

from functools import lru_cache
from math import factorial
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.motion.polynomials import PiecewiseMotion

Array = NDArray[np.float64]
Ends = Literal["clamped", "natural", "periodic"]


def linear(x: Array, y: Array) -> PiecewiseMotion:
    """Straight lines between points: the velocity leaps at each.

    Examples
    --------
    >>> linear(np.array([0.0, 1.0, 3.0]), np.array([0.0, 2.0, 0.0])).peak(1)
    Extreme(value=2.0, x=0.0)
    """
    return PiecewiseMotion(x, linear_powers(x, y))


def cubic_spline(
    x: Array, y: Array, ends: Ends = "clamped", slopes: tuple[float, float] = (0.0, 0.0)
) -> PiecewiseMotion:
    """The cubic spline through points, whose acceleration is continuous.

    Parameters
    ----------
    x, y
        Points, shape (n,).
    ends
        "clamped" to slopes, "natural" without acceleration at the ends, "periodic".
    slopes
        At both ends, where it is clamped.

    Raises
    ------
    InputError
        If it is periodic and its first and last position differ.

    Examples
    --------
    >>> spline = cubic_spline(np.array([0.0, 40.0, 100.0]), np.array([0.0, 20.0, 25.0]), slopes=(1.0, 0.0))
    >>> [round(coefficient, 9) for coefficient in spline.coefficients[0]]
    [0.0, 1.0, -0.0175, 0.000125]
    """
    return PiecewiseMotion(x, spline_powers(x, y, ends, slopes))


def hermite(x: Array, values: Array) -> PiecewiseMotion:
    """Polynomials of degree 2m - 1 that have m given derivatives at each point: y, V, A for the quintic of XYVA.

    Parameters
    ----------
    x
        Points, shape (n,).
    values
        y and its first m - 1 derivatives there, shape (m, n).

    Examples
    --------
    >>> motion = hermite(np.array([0.0, 2.0]), np.array([[0.0, 1.0], [0.0, 0.0], [0.0, 0.0]]))
    >>> motion.coefficients[0]
    (0.0, 0.0, 0.0, 1.25, -0.9375, 0.1875)
    """
    return PiecewiseMotion(x, hermite_powers(x, values))


def akima(x: Array, y: Array) -> PiecewiseMotion:
    """Akima's cubics, as Modelica's tables take them: the acceleration leaps at each point.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 6)
    >>> round(akima(x, x**2)(0.5), 9)
    0.25
    """
    return PiecewiseMotion(x, akima_powers(x, y))


def sampled(motion: PiecewiseMotion, ticks: int) -> PiecewiseMotion:
    """A motion as a task hears of it so many times: straight lines between equal steps.

    Examples
    --------
    >>> sampled(PiecewiseMotion([0, 1], [[0, 0, 1]]), 2)(0.5, 1)
    1.5
    """
    x = np.linspace(motion.start, motion.stop, ticks + 1)
    return linear(x, motion(x))


def linear_powers(x: Array, y: Array) -> Array:
    """Ascending powers of `linear`, a row for each piece."""
    return np.column_stack([y[:-1], np.diff(y) / np.diff(x)])


def spline_powers(x: Array, y: Array, ends: Ends, slopes: tuple[float, float]) -> Array:
    """Ascending powers of `cubic_spline`, a row for each piece.

    Raises
    ------
    InputError
        If it is periodic and its first and last position differ.
    """
    from scipy.interpolate import CubicSpline

    if ends == "periodic" and y[0] != y[-1]:
        raise InputError("a periodic spline ends at the position where it begins; clamp one that advances")
    conditions: Any = ((1, slopes[0]), (1, slopes[1])) if ends == "clamped" else ends
    return np.asarray(CubicSpline(x, y, bc_type=conditions).c.T[:, ::-1])


def akima_powers(x: Array, y: Array) -> Array:
    """Ascending powers of `akima`, a row for each piece."""
    from scipy.interpolate import Akima1DInterpolator

    return np.asarray(Akima1DInterpolator(x, y).c.T[:, ::-1])


def hermite_powers(x: Array, values: Array) -> Array:
    """Ascending powers of `hermite`, a row for each piece."""
    m = len(values)
    lengths = np.diff(x)
    powers = lengths[:, None] ** np.arange(2 * m)
    scaled = values.T[:, :m] / np.array([factorial(i) for i in range(m)])
    first, second = scaled[:-1] * powers[:, :m], scaled[1:] * powers[:, :m]
    # the position is taken from the point before: differences keep the digits that large positions would cost
    second[:, 0] -= first[:, 0]
    moved = first.copy()
    moved[:, 0] = 0.0
    rows = np.hstack([moved, second]) @ _from_ends(m).T / powers
    rows[:, :m] = scaled[:-1]
    return rows


@lru_cache(maxsize=8)
def _from_ends(m: int) -> Array:
    """Powers of u on [0, 1] of the polynomial whose scaled derivatives f^(i)/i! at 0, then at 1, are given."""
    count = 2 * m
    table = np.zeros((count, count))
    table[:m, :m] = np.eye(m)
    for i in range(m):
        for n in range(i, count):
            table[m + i, n] = factorial(n) / (factorial(n - i) * factorial(i))
    return np.asarray(np.rint(np.linalg.inv(table)))
