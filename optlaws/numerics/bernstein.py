"""Polynomials on [0, 1] by their Bernstein coefficients, many at once: between these every value lies."""

from __future__ import annotations

from functools import lru_cache
from math import comb
from typing import NamedTuple

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics.chebyshev import nodes
from optlaws.numerics.tolerances import OPERATIONS_ROUNDING, TIE, TOP_WIDTH

PARTS = 8
_ROUNDS = 20


class GreatestValue(NamedTuple):
    """The greatest value of polynomials on [0, 1]: between `value`, which is taken, and `above`; its row and place."""

    value: float
    above: float
    row: int
    u: float


def from_powers(powers: Array) -> Array:
    """Bernstein coefficients of polynomials given by ascending powers of u, a row each.

    Examples
    --------
    >>> from_powers(np.array([[0.0, 0.0, 1.0]]))
    array([[0., 0., 1.]])
    """
    return powers @ _of_powers(powers.shape[1] - 1)


def from_values(values: Array) -> Array:
    """Bernstein coefficients of polynomials given by their values at (x + 1)/2 of the Chebyshev nodes x, a row each.

    Examples
    --------
    >>> from_values((nodes(3)[None] + 1.0) ** 2).round(12) + 0.0
    array([[0., 0., 4.]])
    """
    return values @ _of_values(values.shape[1])


def top(control: Array) -> GreatestValue:
    """The greatest value of polynomials on [0, 1], given by Bernstein coefficients, a row each.

    What can still be higher than the highest value met is cut in eight, to rounding; of places as high as one another
    the first is told.

    Examples
    --------
    >>> top(from_powers(np.array([[0.0, 1.0, -1.0]])))
    GreatestValue(value=0.25, above=0.25, row=0, u=0.5)
    """
    scale = float(np.abs(control).max())
    rows, lows, width = np.arange(len(control)), np.zeros(len(control)), 1.0
    best, above = -np.inf, -np.inf
    met: list[Array] = []
    for _ in range(_ROUNDS):
        best = max(best, float(control[:, [0, -1]].max()))
        for side, u in ((0, lows), (-1, lows + width)):
            near = control[:, side] >= best - TIE * scale
            met.append(np.stack([rows[near], u[near], control[near, side]]))
        height = control.max(axis=1)
        higher = height > best + OPERATIONS_ROUNDING * scale
        above = max(above, float(height[~higher].max(initial=-np.inf)))
        if not higher.any():
            break
        width /= PARTS
        control = in_parts(control[higher])
        rows, lows = np.repeat(rows[higher], PARTS), (lows[higher, None] + width * np.arange(PARTS)).ravel()
    else:
        above = max(above, float(control.max()))
    which, place = _first(np.concatenate(met, axis=1), best - TIE * scale)
    return GreatestValue(best, max(above, best), which, place)


def in_parts(control: Array) -> Array:
    """Bernstein coefficients of the same polynomials on eight equal parts of [0, 1], one row after the other.

    Examples
    --------
    >>> in_parts(np.array([[0.0, 8.0]]))[[0, 7]].tolist()
    [[0.0, 1.0], [7.0, 8.0]]
    """
    return (control @ _cuts(control.shape[1] - 1)).reshape(-1, control.shape[1])


def _first(places: Array, least: float) -> tuple[int, float]:
    """Row and place of the first of the highest tops: of rows, places and values, those of at least a value count."""
    rows, u, values = places[:, places[2] >= least]
    first = int(np.lexsort((u, rows))[0])
    same_top = (rows == rows[first]) & (u <= u[first] + TOP_WIDTH)
    highest = int(np.argmax(np.where(same_top, values, -np.inf)))
    return int(rows[highest]), float(u[highest])


@lru_cache(maxsize=64)
def _of_powers(degree: int) -> Array:
    matrix = np.array([[comb(i, n) / comb(degree, n) for i in range(degree + 1)] for n in range(degree + 1)])
    matrix.setflags(write=False)
    return matrix


@lru_cache(maxsize=64)
def _of_values(count: int) -> Array:
    degree, u = count - 1, (nodes(count) + 1.0) / 2.0
    basis = np.array([comb(degree, i) * u**i * (1.0 - u) ** (degree - i) for i in range(count)])
    matrix: Array = np.linalg.inv(basis)
    matrix.setflags(write=False)
    return matrix


@lru_cache(maxsize=64)
def _cuts(degree: int) -> Array:
    """The matrices that take control points to those of eight equal parts, side by side."""
    left = np.array([[comb(i, j) / 2.0**i for i in range(degree + 1)] for j in range(degree + 1)])
    matrices = [np.eye(degree + 1)]
    while len(matrices) < PARTS:
        matrices = [matrix @ half for matrix in matrices for half in (left, left[::-1, ::-1])]
    joined = np.concatenate(matrices, axis=1)
    joined.setflags(write=False)
    return joined
