"""Polynomials on [0, 1] by their Bernstein coefficients, many at once, between which every value lies; differences."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import comb
from typing import NamedTuple

import numpy as np

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.chebyshev import nodes
from optlaws.tolerances import OPERATIONS_ROUNDING, TIE

_DIFFERENCE_ROUNDING = 2.0**-42  # of two functions: their difference is known to no more
_TOP_WIDTH = 1e-4  # of an interval: a smooth top is flat to TIE over about so much
_DIFFERENCE_SHARE = 1e-10  # of the greatest difference: to so much it is resolved

PARTS = 8
_ROUNDS = 20


class GreatestValue(NamedTuple):
    """The greatest value of polynomials on [0, 1], its row and its place."""

    value: float
    row: int
    u: float


def from_powers(powers: Array) -> Array:
    """Bernstein coefficients of polynomials given by ascending powers of u, a row each.

    >>> from_powers(np.array([[0.0, 0.0, 1.0]]))
    array([[0., 0., 1.]])
    """
    return powers @ _of_powers(powers.shape[1] - 1)


def from_values(values: Array) -> Array:
    """Bernstein coefficients of polynomials given by their values at (x + 1)/2 of the Chebyshev nodes x, a row each.

    >>> from_values((nodes(3)[None] + 1.0) ** 2).round(12) + 0.0
    array([[0., 0., 4.]])
    """
    return values @ _of_values(values.shape[1])


def top(control: Array) -> GreatestValue:
    """The greatest value of polynomials on [0, 1], given by Bernstein coefficients, a row each.

    What can still be higher than the highest value met is cut in eight, to rounding; of places as high as one another
    the first is returned.

    >>> top(from_powers(np.array([[0.0, 1.0, -1.0]])))
    GreatestValue(value=0.25, row=0, u=0.5)
    """
    scale = float(np.abs(control).max())
    rows, lows, width = np.arange(len(control)), np.zeros(len(control)), 1.0
    best = -np.inf
    met: list[Array] = []
    for _ in range(_ROUNDS):
        best = max(best, float(control[:, [0, -1]].max()))
        for side, u in ((0, lows), (-1, lows + width)):
            near = control[:, side] >= best - TIE * scale
            met.append(np.stack([rows[near], u[near], control[near, side]]))
        higher = control.max(axis=1) > best + OPERATIONS_ROUNDING * scale
        if not higher.any():
            break
        width /= PARTS
        control = in_parts(control[higher])
        rows, lows = np.repeat(rows[higher], PARTS), (lows[higher, None] + width * np.arange(PARTS)).ravel()
    which, place = _first(np.concatenate(met, axis=1), best - TIE * scale)
    return GreatestValue(best, which, place)


def in_parts(control: Array) -> Array:
    """Bernstein coefficients of the same polynomials on eight equal parts of [0, 1], one row after the other.

    >>> in_parts(np.array([[0.0, 8.0]]))[[0, 7]].tolist()
    [[0.0, 1.0], [7.0, 8.0]]
    """
    return (control @ _cuts(control.shape[1] - 1)).reshape(-1, control.shape[1])


def _first(places: Array, least: float) -> tuple[int, float]:
    """Row and place of the first of the highest tops; only tops above a threshold count."""
    rows, u, values = places[:, places[2] >= least]
    first = int(np.lexsort((u, rows))[0])
    same_top = (rows == rows[first]) & (u <= u[first] + _TOP_WIDTH)
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
    """The matrices from control points to the control points of eight equal parts, side by side."""
    left = np.array([[comb(i, j) / 2.0**i for i in range(degree + 1)] for j in range(degree + 1)])
    matrices = [np.eye(degree + 1)]
    while len(matrices) < PARTS:
        matrices = [matrix @ half for matrix in matrices for half in (left, left[::-1, ::-1])]
    joined = np.concatenate(matrices, axis=1)
    joined.setflags(write=False)
    return joined


Function = Callable[[Array], Array]

_NODES = 10
_CUTS = 30


def greatest_difference(first: Function, second: Function, places: Array) -> tuple[float, float]:
    """An estimate of the greatest |first - second| and of where it is, between places among which both are smooth.

    Parts between the places are halved until a series of ten terms resolves the difference to rounding, or to 1e-10 of
    its greatest value; of the series the extremes are taken. It is an estimate: functions are evaluated at the nodes of
    parts alone, and a bump between these, narrower than any part, is not seen.

    Parameters
    ----------
    first, second
        Functions of arrays of places.
    places
        Increasing: both ends, and where one of the two is not smooth.

    Examples
    --------
    >>> value, x = greatest_difference(np.sin, lambda x: x, np.array([0.0, 1.0]))
    >>> round(value, 12) == round(1.0 - float(np.sin(1.0)), 12), x
    (True, 1.0)
    """
    low, high = places[:-1], places[1:]
    parts: list[tuple[Array, Array, Array]] = []
    size, greatest = 0.0, 0.0  # of all that has been met: what is rounding beside them is resolved
    for _ in range(_CUTS):
        x = low[:, None] + (high - low)[:, None] * (nodes(_NODES) + 1.0) / 2.0
        theirs = np.asarray(second(x.ravel()), dtype=np.float64).reshape(x.shape)
        if not np.isfinite(theirs).all():
            raise InputError("the motion to compare with must have finite values on the whole interval")
        values = first(x.ravel()).reshape(x.shape) - theirs
        size, greatest = max(size, float(np.abs(theirs).max())), max(greatest, float(np.abs(values).max()))
        tail = np.abs(chebyshev.from_values(values.T)[-2:]).max(axis=0)
        done = tail <= max(_DIFFERENCE_ROUNDING * size, _DIFFERENCE_SHARE * greatest)
        parts.append((from_values(values)[done], low[done], high[done]))
        if done.all():
            table, start, stop = (np.concatenate(several) for several in zip(*parts, strict=True))
            order = np.argsort(start)
            highest = top(np.stack([table[order], -table[order]], axis=1).reshape(-1, _NODES))
            row = order[highest.row // 2]
            return highest.value, float(start[row] + (stop[row] - start[row]) * highest.u)
        low, high = low[~done], high[~done]
        middle = (low + high) / 2.0
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    raise InputError(f"the motion is not smooth near x = {float(low[0])!r}: name its breaks")
