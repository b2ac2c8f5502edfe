"""Polynomials in rational arithmetic: powers of k and Chebyshev polynomials T_n(2k - 1), products, sums and shifts.

Power coefficients of a good law reach 6e7 at degree 17 and 1e20 at degree 59, with alternating signs. Nothing may be
rounded on the way between the two bases, so integers do the work and each result is rounded once. Bounds are rounded
outward, to doubles on one side of the number they stand for, and tested exactly.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import zip_longest
from math import comb, factorial, inf, isfinite, lcm, nextafter, sqrt, ulp
from sys import float_info
from typing import Any

import numpy as np

from optlaws.numbers import fractions

Polynomial = list[Fraction]  # ascending powers


def chebyshev_from_powers(coefficients: Iterable[Any]) -> tuple[float, ...]:
    """Chebyshev series in 2k - 1 of a polynomial given by ascending powers of k, rounded once.

    >>> chebyshev_from_powers([-3, 6])
    (0.0, 3.0)
    """
    return rounded(exact_chebyshev(fractions(coefficients, "coefficients")))


def powers_from_chebyshev(coefficients: Iterable[Any]) -> tuple[float, ...]:
    """Ascending powers of k of a polynomial given by its Chebyshev series in 2k - 1, rounded once.

    >>> powers_from_chebyshev([0.0, 3.0])
    (-3.0, 6.0)
    """
    return rounded(exact_powers(fractions(coefficients, "coefficients")))


def exact_chebyshev(powers: Sequence[Fraction]) -> list[Fraction]:
    """Chebyshev series of sum powers[n] k^n, by 4^n k^n = C(2n, n) + 2 sum_m C(2n, n-m) T_m(2k - 1).

    >>> exact_chebyshev([Fraction(0), Fraction(0), Fraction(8)])
    [Fraction(3, 1), Fraction(4, 1), Fraction(1, 1)]
    """
    return _changed(powers, _power_row, 4)


def exact_powers(series: Sequence[Fraction]) -> list[Fraction]:
    """Powers of k of sum series[n] T_n(2k - 1).

    >>> exact_powers([Fraction(0), Fraction(0), Fraction(1)])
    [Fraction(1, 1), Fraction(-8, 1), Fraction(8, 1)]
    """
    return _changed(series, _chebyshev_row, 1)


def rounded(values: Iterable[Fraction]) -> tuple[float, ...]:
    """The floats nearest to fractions.

    >>> rounded([Fraction(1, 4)])
    (0.25,)
    """
    return tuple(float(value) for value in values)


def times(first: Polynomial, second: Polynomial) -> Polynomial:
    """The product of two polynomials.

    >>> times([Fraction(1), Fraction(1)], [Fraction(-1), Fraction(1)])
    [Fraction(-1, 1), Fraction(0, 1), Fraction(1, 1)]
    """
    if not first or not second:
        return []
    product: Polynomial = np.convolve(np.array(first, dtype=object), np.array(second, dtype=object)).tolist()
    return product


def plus(first: Polynomial, second: Polynomial) -> Polynomial:
    """The sum of two polynomials.

    >>> plus([Fraction(1)], [Fraction(1), Fraction(2)])
    [Fraction(2, 1), Fraction(2, 1)]
    """
    return [p + q for p, q in zip_longest(first, second, fillvalue=Fraction(0))]


def shifted(polynomial: Polynomial, by: Fraction | int) -> Polynomial:
    """Powers of h of p(h + by).

    >>> shifted([Fraction(0), Fraction(0), Fraction(1)], 1)
    [Fraction(1, 1), Fraction(2, 1), Fraction(1, 1)]
    """
    moved = [Fraction(0)] * len(polynomial)
    for n, value in enumerate(polynomial):
        for i in range(n + 1):
            moved[i] += value * comb(n, i) * by ** (n - i)
    return moved


def edge(order: int) -> Polynomial:
    """k^l (k-1)^l, by which eq. 8 multiplies Z.

    >>> edge(1)
    [Fraction(0, 1), Fraction(-1, 1), Fraction(1, 1)]
    """
    return [Fraction(0)] * order + [Fraction((-1) ** (order - i) * comb(order, i)) for i in range(order + 1)]


def _changed(values: Sequence[Fraction], row: Callable[[int], tuple[int, ...]], base: int) -> list[Fraction]:
    # row(n) holds base^n times column n of the change of basis, in integers
    if not values:
        return []
    common = lcm(*(value.denominator for value in values))
    top = len(values) - 1
    totals = [0] * len(values)
    for n, value in enumerate(values):
        weight = value.numerator * (common // value.denominator) * base ** (top - n)
        if weight:
            for m, entry in enumerate(row(n)):
                totals[m] += weight * entry
    denominator = common * base**top
    return [Fraction(total, denominator) for total in totals]


@lru_cache(maxsize=256)
def _power_row(n: int) -> tuple[int, ...]:
    return (comb(2 * n, n), *(2 * comb(2 * n, n - m) for m in range(1, n + 1)))


@lru_cache(maxsize=256)
def _chebyshev_row(n: int) -> tuple[int, ...]:
    if n == 0:
        return (1,)
    return tuple(
        (-1) ** (n - i) * 4**i * n * factorial(n + i - 1) // (factorial(n - i) * factorial(2 * i)) for i in range(n + 1)
    )


def rounded_down(value: Fraction) -> float:
    """The greatest double that is not above an exact number.

    >>> rounded_down(Fraction(9, 4)), rounded_down(Fraction(2, 3)) <= Fraction(2, 3)
    (2.25, True)
    """
    try:
        nearest = float(value)
    except OverflowError:
        return float_info.max if value > 0 else -inf
    return not_above(nearest, lambda x: x <= value)


def rounded_up(value: Fraction) -> float:
    """The least double that is not below an exact number.

    >>> rounded_up(Fraction(9, 4)), rounded_up(Fraction(2, 3)) >= Fraction(2, 3)
    (2.25, True)
    """
    return -rounded_down(-value)


def not_above(value: float, below: Callable[[Fraction], bool]) -> float:
    """A computed value, lowered by the least amount that makes `below` true for the exact value.

    Parameters
    ----------
    value
        The exact number, but for rounding.
    below
        Whether a rational number is not above the exact one, decided without rounding.
    """
    steps = 1.0
    while isfinite(value) and not below(Fraction(value)):
        value = min(nextafter(value, -inf), value - steps * ulp(value))
        steps *= 2.0
    return value


def root_rounded_down(offset: Fraction, factor: Fraction, square: Fraction) -> float:
    """A double just below offset + factor * sqrt(square), with a factor and a square of at least 0.

    >>> root_rounded_down(Fraction(1), Fraction(2), Fraction(9, 4))
    4.0
    """
    value = float(offset) + float(factor) * sqrt(float(square))
    return not_above(value, lambda x: x <= offset or (x - offset) ** 2 <= factor**2 * square)
