"""Polynomials in ascending powers, in exact arithmetic."""

from __future__ import annotations

from fractions import Fraction
from math import comb

Polynomial = list[Fraction]


def times(first: Polynomial, second: Polynomial) -> Polynomial:
    """The product.

    Examples
    --------
    >>> times([Fraction(1), Fraction(1)], [Fraction(-1), Fraction(1)])
    [Fraction(-1, 1), Fraction(0, 1), Fraction(1, 1)]
    """
    if not first or not second:
        return []
    product = [Fraction(0)] * (len(first) + len(second) - 1)
    for i, p in enumerate(first):
        for j, q in enumerate(second):
            product[i + j] += p * q
    return product


def plus(first: Polynomial, second: Polynomial) -> Polynomial:
    """The sum.

    Examples
    --------
    >>> plus([Fraction(1)], [Fraction(1), Fraction(2)])
    [Fraction(2, 1), Fraction(2, 1)]
    """
    total = [Fraction(0)] * max(len(first), len(second))
    for polynomial in (first, second):
        for i, value in enumerate(polynomial):
            total[i] += value
    return total


def shifted(polynomial: Polynomial, by: Fraction | int) -> Polynomial:
    """Powers of h of p(h + by).

    Examples
    --------
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

    Examples
    --------
    >>> edge(1)
    [Fraction(0, 1), Fraction(-1, 1), Fraction(1, 1)]
    """
    return [Fraction(0)] * order + [Fraction((-1) ** (order - i) * comb(order, i)) for i in range(order + 1)]
