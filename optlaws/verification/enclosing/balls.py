"""Between Python's numbers and python-flint's: exact one way, rounded outward the other."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from math import ceil, inf
from typing import Any

from flint import arb, ctx, fmpq, fmpq_poly

from optlaws.numerics.exact import rounded_down, rounded_up

#: balls that hold the least and the greatest value of something
Extremes = tuple[arb, arb]

_PLACES, _EXACT = 128, 4096


def rational(value: float | Fraction) -> fmpq:
    """The exact value of a float or Fraction."""
    exact = Fraction(value)
    return fmpq(exact.numerator, exact.denominator)


def ball(value: float | Fraction | fmpq) -> arb:
    """A ball around the value, at the precision at work."""
    return arb(value if isinstance(value, fmpq) else rational(value))


def upper(value: arb) -> Fraction:
    """An upper bound of the ball, with 128 bits."""
    with ctx.workprec(_EXACT):  # every operation on a ball rounds to the precision at work, this one too
        mantissa, exponent = (int(part) for part in value.upper().man_exp())
    return Fraction(ceil(Fraction(mantissa) * Fraction(2) ** (exponent + _PLACES)), 2**_PLACES)


def lower(value: arb) -> Fraction:
    """A lower bound of the ball, with 128 bits."""
    with ctx.workprec(_EXACT):
        return -upper(-value)


def enclosed(value: arb) -> tuple[float, float]:
    """The two doubles that enclose a ball, which may be infinite."""
    if value.is_finite():
        return rounded_down(lower(value)), rounded_up(upper(value))
    return (inf, inf) if value == arb.pos_inf() else (-inf, inf)


def at(polynomial: fmpq_poly, x: arb) -> arb:
    """The value of a polynomial at a ball."""
    value: arb = polynomial.numer()(x) / arb(polynomial.denom())
    return value


def root(square: arb) -> arb:
    """The root of what is not negative, though its ball may reach below 0."""
    return square.sqrt() if square > 0 else arb(0).union(square.upper().max(arb(0)).sqrt())


@contextmanager
def series_length(count: int) -> Iterator[None]:
    """Set the number of terms of Taylor series for the time of a `with` block."""
    before: Any = ctx.cap
    ctx.cap = count
    try:
        yield
    finally:
        ctx.cap = before
