"""Gegenbauer polynomials: the well-conditioned coordinates of polynomial laws."""

from __future__ import annotations

import numpy as np

from optlaws.numbers import Array


def gegenbauer(index: float, degree: int, x: Array) -> Array:
    """Gegenbauer polynomials of the given index, degrees 0 to `degree`, one row each, by their recurrence.

    >>> gegenbauer(0.5, 2, np.array([1.0]))[:, 0].tolist()
    [1.0, 1.0, 1.0]
    """
    rows = np.empty((degree + 1, len(x)))
    rows[0] = 1.0
    if degree:
        rows[1] = 2.0 * index * x
    for m in range(1, degree):
        rows[m + 1] = (2 * (m + index) * x * rows[m] - (m + 2 * index - 1) * rows[m - 1]) / (m + 1)
    return rows


def even_gegenbauer_jet(index: float, terms: int, t: Array) -> Array:
    """Gegenbauer polynomials of degrees 0, 2, ..., 2 `terms` in x with t = 2x² - 1, and two derivatives by t.

    Shape (3, points, terms + 1). By recurrence, so that the relative error stays small where the values are small
    beside those at x = 1, which no series in a fixed basis can give.
    """
    square = (t + 1.0) / 2.0
    rows = np.zeros((terms + 1, 3, len(t)))
    rows[0, 0] = 1.0
    shift = np.zeros((3, len(t)))
    for m in range(terms):
        n = 2 * m
        up, up2 = ((n + i + 1) / (2 * (n + i + index)) for i in (0, 1))
        down2 = (n + 2 * index) / (2 * (n + 1 + index))
        shift[1:] = rows[m, :2]
        shift[1] /= 2.0
        following = square * rows[m] + shift
        if n:
            down = (n + 2 * index - 1) / (2 * (n + index))
            before = n / (2 * (n - 1 + index))
            down0 = (n + 2 * index - 2) / (2 * (n - 1 + index))
            following -= (up * down2 + down * before) * rows[m] + down * down0 * rows[m - 1]
        else:
            following -= up * down2 * rows[m]
        rows[m + 1] = following / (up * up2)
    return rows.transpose(1, 2, 0)
