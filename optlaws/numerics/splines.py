"""Interpolations of tables as controllers compute them: powers of lines, splines and Hermite polynomials."""

from __future__ import annotations

from functools import lru_cache
from math import factorial
from typing import Literal

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
    if ends == "periodic" and y[0] != y[-1]:
        raise InputError("a periodic spline ends at the position where it begins; clamp one that advances")
    steps = np.diff(x)
    chords = np.diff(y) / steps
    if ends == "periodic":
        at_points = periodic_slopes(steps, chords)
    else:
        free = ends == "natural"
        first, last = (3.0 * chords[0], 3.0 * chords[-1]) if free else slopes
        rows = _continuous(steps[:-1], steps[1:], chords[:-1], chords[1:])
        centre, beside = (2.0, 1.0) if free else (1.0, 0.0)
        below, diagonal, above, right = (
            np.concatenate([[at_start], inside, [at_end]])
            for at_start, inside, at_end in zip(
                (0.0, centre, beside, first), rows, (beside, centre, 0.0, last), strict=True
            )
        )
        at_points = _tridiagonal(below, diagonal, above, right)
    bends = (at_points[:-1] + at_points[1:] - 2.0 * chords) / steps
    return np.column_stack([y[:-1], at_points[:-1], (chords - at_points[:-1]) / steps - bends, bends / steps])


def _continuous(before: Array, after: Array, chord: Array, next_chord: Array) -> tuple[Array, Array, Array, Array]:
    """Rows by which the acceleration is continuous at points: three neighbouring slopes, and the right-hand side."""
    return after, 2.0 * (before + after), before, 3.0 * (after * chord + before * next_chord)


def periodic_slopes(steps: Array, chords: Array) -> Array:
    """The slopes of a periodic cubic spline at all points, of which the last is the first again.

    >>> periodic_slopes(np.ones(4), np.array([1.0, -1.0, -1.0, 1.0])).round(12) + 0.0
    array([ 1.5,  0. , -1.5,  0. ,  1.5])
    """
    below, diagonal, above, right = _continuous(np.roll(steps, 1), steps, np.roll(chords, 1), chords)
    if len(steps) < 3:  # both neighbours are one point, or the point itself
        table = np.diag(diagonal)
        for i in range(len(steps)):
            table[i, i - 1] += below[i]
            table[i, (i + 1) % len(steps)] += above[i]
        slopes = np.linalg.solve(table, right)
    else:
        # without its corners the matrix is tridiagonal; they are of rank one (Sherman and Morrison)
        corner, ratio = -diagonal[0], above[-1] / -diagonal[0]
        column = np.zeros(len(steps))
        column[[0, -1]] = corner, above[-1]
        diagonal[0] -= corner
        diagonal[-1] -= below[0] * ratio
        plain, of_column = (_tridiagonal(below, diagonal, above, side) for side in (right, column))
        share = below[0] / corner
        slopes = plain - of_column * (plain[0] + share * plain[-1]) / (1.0 + of_column[0] + share * of_column[-1])
    return np.append(slopes, slopes[0])


def _tridiagonal(below: Array, diagonal: Array, above: Array, right: Array) -> Array:
    """The solution of a tridiagonal system, whose diagonal outweighs what is beside it: no pivots are needed.

    Plain numbers, for scipy takes longer to import than a thousand such systems to solve.
    """
    beside, known = [0.0], [0.0]
    for low, centre, up, side in zip(*(part.tolist() for part in (below, diagonal, above, right)), strict=True):
        pivot = centre - low * beside[-1]
        known.append((side - low * known[-1]) / pivot)
        beside.append(up / pivot)
    solution = [known.pop()]
    for value, up in zip(known[:0:-1], beside[-2:0:-1], strict=True):
        solution.append(value - up * solution[-1])
    return np.array(solution[::-1])


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
