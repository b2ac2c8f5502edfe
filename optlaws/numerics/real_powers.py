"""Sums of real powers of v >= 0: values and all their positive roots."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from math import inf, log

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics.roots import bisect
from optlaws.tolerances import SAME_EXPONENT

Sum = Mapping[float, float]  # exponent: coefficient


def gathered(terms: Iterable[tuple[float, float]]) -> dict[float, float]:
    """A sum of its terms, pairs of exponent and coefficient; exponents that differ by rounding are one.

    >>> gathered([(1.5, 2.0), (0.0, 1.0), (1.5, -2.0)])
    {0.0: 1.0}
    """
    total: dict[float, float] = {}
    last = -inf
    for exponent, coefficient in sorted(terms):
        last = last if exponent - last < SAME_EXPONENT else exponent
        total[last] = total.get(last, 0.0) + coefficient
    return {exponent: coefficient for exponent, coefficient in total.items() if coefficient != 0.0}


def value(powers: Sum, v: Array) -> Array:
    """Values at v >= 0; a negative power of zero is infinite, with the sign of its coefficient.

    >>> value({0.0: 1.0, 1.5: 2.0}, np.array([0.0, 4.0]))
    array([ 1., 17.])
    """
    total = np.zeros(np.shape(v))
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        for exponent in sorted(powers, reverse=True):  # the lowest last: at zero it decides
            part = powers[exponent] * v**exponent
            total = np.where(np.isinf(part), part, total + part)
    return total


def derivative(powers: Sum) -> dict[float, float]:
    """The derivative of the power with respect to v.

    >>> derivative({0.0: 1.0, 1.5: 2.0})
    {0.5: 3.0}
    """
    return {exponent - 1.0: exponent * factor for exponent, factor in powers.items() if exponent != 0.0}


def product(first: Sum, second: Sum) -> dict[float, float]:
    """The product of two sums of powers.

    >>> product({0.5: 2.0}, {0.5: 1.0, -0.5: 3.0})
    {0.0: 6.0, 1.0: 2.0}
    """
    return gathered((i + n, a * b) for i, a in first.items() for n, b in second.items())


def integral(powers: Sum, low: float, high: float) -> float:
    """Integral from low to high, both >= 0; infinite where it diverges.

    >>> integral({-0.5: 1.0}, 0.0, 4.0)
    4.0
    """
    total = 0.0
    for exponent, coefficient in powers.items():
        above = exponent + 1.0
        if low == 0.0 and above <= 0.0:
            return inf if coefficient > 0.0 else -inf
        part = log(high / low) if above == 0.0 else (high**above - low**above) / above
        total += coefficient * part
    return total


def roots(powers: Sum, low: float, high: float) -> list[float]:
    """Every v in (low, high), low >= 0, where the sum changes sign.

    Divided by its lowest power and differentiated, a sum of n terms becomes one of n - 1 terms whose roots separate
    those of the first (Rolle); halving finds them one by one.

    >>> [round(v, 12) for v in roots({0.0: 1.0, 0.5: -3.0, 1.0: 2.0}, 0.0, 4.0)]
    [0.25, 1.0]
    """
    if len(powers) < 2:
        return []
    lowest = min(powers)
    divided = {exponent - lowest: factor for exponent, factor in powers.items()}
    marks = [low, *roots(derivative(divided), low, high), high]
    heights = [_at(divided, v) for v in marks]
    zeros = [v for v, height in zip(marks[1:-1], heights[1:-1], strict=True) if height == 0.0]
    zeros += [
        sum(bisect(partial(_same_sign, divided, before), start, end)) / 2.0
        for start, end, before, after in zip(marks, marks[1:], heights, heights[1:], strict=False)
        if before * after < 0.0
    ]
    return sorted(zeros)


def _at(powers: Sum, v: float) -> float:
    return float(sum(factor * v**exponent for exponent, factor in powers.items()))


def _same_sign(powers: Sum, height: float, v: float) -> bool:
    return _at(powers, v) * height > 0.0
