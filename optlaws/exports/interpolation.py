"""Interpolations of tables as controllers compute them: powers of the polynomials between points, with exact peaks."""

from __future__ import annotations

from functools import lru_cache
from math import factorial
from typing import Any, Literal

import numpy as np

from optlaws.errors import InputError
from optlaws.numbers import Array

Ends = Literal["clamped", "natural", "periodic"]


def linear_powers(x: Array, y: Array) -> Array:
    """Ascending powers of straight lines between points, a row for each piece: the velocity jumps at each point.

    >>> linear_powers(np.array([0.0, 1.0, 3.0]), np.array([0.0, 2.0, 0.0])).tolist()
    [[0.0, 2.0], [2.0, -1.0]]
    """
    return np.column_stack([y[:-1], np.diff(y) / np.diff(x)])


def spline_powers(x: Array, y: Array, ends: Ends = "clamped", slopes: tuple[float, float] = (0.0, 0.0)) -> Array:
    """Ascending powers of the cubic spline through points, whose acceleration is continuous, a row for each piece.

    Its ends are "clamped" to slopes, "natural" without acceleration, or "periodic".

    >>> powers = spline_powers(np.array([0.0, 40.0, 100.0]), np.array([0.0, 20.0, 25.0]), slopes=(1.0, 0.0))
    >>> [round(power, 9) for power in powers[0].tolist()]
    [0.0, 1.0, -0.0175, 0.000125]
    """
    from scipy.interpolate import CubicSpline

    if ends == "periodic" and y[0] != y[-1]:
        raise InputError("a periodic spline ends at the position where it begins; clamp one that advances")
    conditions: Any = ((1, slopes[0]), (1, slopes[1])) if ends == "clamped" else ends
    return np.asarray(CubicSpline(x, y, bc_type=conditions).c.T[:, ::-1])


def akima_powers(x: Array, y: Array) -> Array:
    """Akima's cubics in ascending powers, as in Modelica's tables: the acceleration jumps at each point.

    >>> x = np.linspace(0.0, 1.0, 6)
    >>> akima_powers(x, x**2)[0].round(9).tolist()
    [0.0, 0.0, 1.0, 0.0]
    """
    from scipy.interpolate import Akima1DInterpolator

    return np.asarray(Akima1DInterpolator(x, y).c.T[:, ::-1])


def hermite_powers(x: Array, values: Array) -> Array:
    """Ascending powers of degree 2m - 1 that have m given derivatives at each point: y, V, A for the quintic of XYVA.

    Points have the shape (n,), values (m, n).

    >>> hermite_powers(np.array([0.0, 2.0]), np.array([[0.0, 1.0], [0.0, 0.0], [0.0, 0.0]])).tolist()
    [[0.0, 0.0, 0.0, 1.25, -0.9375, 0.1875]]
    """
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
