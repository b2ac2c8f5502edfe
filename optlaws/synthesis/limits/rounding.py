"""Doubles on one side of the number they stand for: bounds are rounded outward, and tested exactly."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import inf, isfinite, nextafter, sqrt, ulp
from sys import float_info


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
