"""Exponential moments of Legendre polynomials: modified spherical Bessel functions of complex argument."""

from __future__ import annotations

from functools import lru_cache
from math import ceil

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.tolerances import TINY

Complex = NDArray[np.complex128]


def moments(sigma: Complex, count: int) -> Complex:
    """Half the integral over |x| <= 1 of P_n(x) exp(sigma (1 - x)), n = 0 ... count - 1.

    It is (-1)^n exp(sigma) i_n(sigma), and for imaginary sigma a spherical Bessel function j_n. The ratios of
    consecutive n come from their recurrence run downwards, which is stable for every argument.

    Parameters
    ----------
    sigma
        Arguments, shape (m,), not zero and with real part at most 0.
    count
        Number of polynomials.

    Returns
    -------
    Complex array, shape (m, count).

    Examples
    --------
    >>> moments(np.array([-0.5 + 0.0j]), 2).real.round(9).tolist()
    [[0.632120559, 0.103638324]]
    """
    table = np.empty((len(sigma), max(count, 2)), dtype=np.complex128)
    size = np.abs(sigma)
    order = np.argsort(size)
    low = 0
    while low < len(order):  # arguments of like size share the length of their recurrence
        high = max(low + 1, int(np.searchsorted(size[order], max(8.0, 1.5 * size[order[low]]), side="right")))
        some = order[low:high]
        table[some] = _alike(sigma[some], table.shape[1], float(size[order[high - 1]]))
        low = high
    return table[:, :count]


def _alike(sigma: Complex, count: int, largest: float) -> Complex:
    ratio = np.zeros(len(sigma), dtype=np.complex128)
    ratios = np.empty((len(sigma), count), dtype=np.complex128)
    top = max(count, ceil(largest)) + 20 + ceil(8.0 * largest ** (1.0 / 3.0))
    inverse = 1.0 / sigma
    for n in range(top, 0, -1):
        below = ratio - (2.0 * n + 1.0) * inverse
        below[below == 0.0] = TINY
        ratio = 1.0 / below
        if n < count:
            ratios[:, n] = ratio
    decay = np.exp(2.0 * sigma)
    first = np.expm1(2.0 * sigma) * (0.5 * inverse)
    second = (first - 0.5 * (decay + 1.0)) * inverse
    # the larger of the two is known without cancellation
    from_second = np.abs(second) > np.abs(first)
    table = np.empty_like(ratios)
    table[:, 0] = first
    table[:, 1] = np.where(from_second, second, first * ratios[:, 1])
    for n in range(2, count):
        table[:, n] = table[:, n - 1] * ratios[:, n]
    return table


@lru_cache(maxsize=64)
def legendre_from_chebyshev(count: int) -> Array:
    """Matrix that turns `count` Chebyshev coefficients into Legendre ones.

    Examples
    --------
    >>> legendre_from_chebyshev(3).round(6).tolist()
    [[1.0, 0.0, -0.333333], [0.0, 1.0, 0.0], [0.0, 0.0, 1.333333]]
    """
    x, weights = np.polynomial.legendre.leggauss(count)
    values = np.polynomial.legendre.legvander(x, count - 1)
    scale = np.arange(count) + 0.5
    table: Array = scale[:, None] * (values.T @ (weights[:, None] * chebyshev.basis_values(x, count)))
    table = np.triu(table)
    table[np.add.outer(np.arange(count), np.arange(count)) % 2 == 1] = 0.0
    return table
