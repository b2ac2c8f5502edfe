"""Proven bounds of the error of a motion that is evaluated in floating point."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import comb, factorial, inf, nextafter, perm, prod

import numpy as np

from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numbers import Array
from optlaws.numerics import exact
from optlaws.tolerances import ROUNDOFF, TINY


@dataclass(frozen=True)
class FloatingPoint:
    """Floating-point numbers of IEEE 754, rounded to nearest.

    Attributes
    ----------
    name
        As IEC 61131-3 calls it.
    unit
        The unit roundoff u: a result is the exact one times 1 + d, |d| <= u.
    least
        The least normal number: below it a result may miss by u times this instead.
    """

    name: str
    unit: Fraction
    least: Fraction


DOUBLE = FloatingPoint("LREAL", Fraction(1, 2**53), Fraction(1, 2**1022))
SINGLE = FloatingPoint("REAL", Fraction(1, 2**24), Fraction(1, 2**126))
ORDERS = 4


def as_stored(motion: PiecewiseMotion, arithmetic: FloatingPoint) -> PiecewiseMotion:
    """The motion in the numbers that an arithmetic has, each polynomial moved to where its break comes to lie."""
    if arithmetic is DOUBLE:
        return motion
    breaks = motion.in_single().breaks
    rows = [[float(c) for c in row] for row in _moved(motion, breaks)]
    return PiecewiseMotion(breaks, rows).in_single()


def error_bounds(motion: PiecewiseMotion, arithmetic: FloatingPoint = DOUBLE) -> tuple[float, ...]:
    """Bounds of the error of position, velocity, acceleration and jerk, rounded up, over all pieces.

    Horner's scheme with s = x - x_i runs through the powers from the highest, and gives the derivatives with it:
    a_m <- a_m s + a_(m-1). Every value is a sum of products of one coefficient and factors s, each product rounded
    at most twice in each of its degree + 1 steps and once more for each s; so by the usual argument the error is at
    most gamma times the same sum over magnitudes, gamma = N u/(1 - N u), N = 3 (degree + 1) + 1, the last for the
    factor m! of the derivative. Fused operations round less. What underflows adds a term of the least normal number,
    and what the rounding of coefficients costs is computed exactly. Each piece lies between its breaks as the
    arithmetic holds them.

    Parameters
    ----------
    motion
        The motion.
    arithmetic
        In which it is stored and evaluated.

    Raises
    ------
    InputError
        If the arithmetic cannot hold the motion.

    Examples
    --------
    >>> motion = PiecewiseMotion([0.0, 1.0], [[0.0, 0.0, 3.0, -2.0]])
    >>> [f"{bound:.1e}" for bound in error_bounds(motion)]
    ['7.2e-15', '1.7e-14', '2.6e-14', '1.7e-14']
    """
    run = as_stored(motion, arithmetic)
    count = 3 * (run.degree + 1) + 1
    gamma = count * arithmetic.unit / (1 - count * arithmetic.unit)
    bounds = [Fraction(0)] * ORDERS
    for i, meant in enumerate(_moved(motion, run.breaks)):
        row = [Fraction(c) for c in run.coefficients[i]]
        missed = [a - b for a, b in zip(row, meant, strict=True)]
        length = Fraction(run.breaks[i + 1]) - Fraction(run.breaks[i])
        for nu in range(ORDERS):
            error = gamma * _magnitude(row, length, nu) + _magnitude(missed, length, nu)
            bounds[nu] = max(bounds[nu], error + _underflow(row, length, nu, arithmetic))
    rounded = ((float(bound), bound) for bound in bounds)
    return tuple(number if Fraction(number) >= bound else nextafter(number, inf) for number, bound in rounded)


def _moved(motion: PiecewiseMotion, breaks: tuple[float, ...]) -> list[list[Fraction]]:
    """The exact polynomials in powers of x less other breaks."""
    return [
        exact.shifted([Fraction(c) for c in row], Fraction(there) - Fraction(here))
        for row, here, there in zip(motion.coefficients, motion.breaks, breaks, strict=False)
    ]


def _magnitude(row: list[Fraction], length: Fraction, nu: int) -> Fraction:
    """The sum over magnitudes of all terms of the derivative of order nu at the end of a piece."""
    return sum(
        (perm(n, nu) * abs(c) * length ** (n - nu) for n, c in enumerate(row) if n >= nu),
        Fraction(0),
    )


def _underflow(row: list[Fraction], length: Fraction, nu: int, arithmetic: FloatingPoint) -> Fraction:
    """What products that underflow may add to the derivative of order nu at the end of a piece.

    The product of each order m misses in each step by at most u times the least normal number. In the `left` steps
    behind it the recurrence makes of it comb(left, nu - m) length**(left - nu + m) times as much, and twice that covers
    the roundings on the way. Products of the leading zeros of a row are exact.
    """
    degree = max((n for n, c in enumerate(row) if c), default=0)
    carried = sum(
        (comb(left, n) * length ** (left - n) for left in range(degree + 1) for n in range(min(left, nu) + 1)),
        Fraction(0),
    )
    return 2 * factorial(nu) * carried * arithmetic.unit * arithmetic.least


_BOUND_ROUNDING = 2.0**-30  # of a bound of roundings: more than its own sum of positive numbers is rounded by
#: roundings of a step, of a mixed coefficient with its own, and of a place in [-1, 1] less what its scale adds
_STEP, _MIXED, _PLACE = 4, 8, 6


def summation_bounds(magnitudes: Array, scale: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Bounds of the error and of the value of a series and its three derivatives by k, for every x in [-1, 1].

    Clenshaw's recurrence b_n = c_n + 2 x b_(n+1) - b_(n+2) is run with its derivatives, of which the order m has
    2 m b_(n+1) of the order m - 1 in place of c_n. What a step is rounded by counts as a change of c_n: at n and of the
    order s it changes the derivative m by comb(m, s) times the derivative m - s of T_n, which is greatest at x = 1. A
    step is rounded at most four times, each by a unit roundoff of its terms; they are bounded by the derivatives at 1
    of the Chebyshev polynomials of the second kind. Fused operations round less.

    The magnitudes are those of the coefficients, shape (n,), of several series that are mixed by weights from 0 to 1
    the greatest each; `scale` is dx/dk, by which each derivative is multiplied.

    >>> errors, values = summation_bounds(np.array([0.5, 0.5]), 2.0)
    >>> [f"{error:.1e}" for error in errors], [round(value, 12) for value in values]
    (['2.8e-15', '3.1e-15', '1.0e-300', '1.0e-300'], [1.0, 1.0, 0.0, 0.0])
    """
    last = len(magnitudes) - 1
    first_kind = np.array([[_at_end(n, m) for n in range(last + 2)] for m in range(ORDERS + 2)])
    rounded = magnitudes * (1.0 + _gamma(_MIXED))
    changes = _changes(rounded, first_kind)
    errors, values = [], []
    for m in range(ORDERS):
        value = float(first_kind[m, : last + 1] @ rounded)
        moved = ((2.0 * scale + _PLACE) * ROUNDOFF) * float(first_kind[m + 1, : last + 1] @ rounded)
        total = _gamma(_MIXED) * value + moved
        total += sum(comb(m, s) * float(changes[s] @ first_kind[m - s, : last + 1]) for s in range(m + 1))
        factor = scale**m * (1.0 + _BOUND_ROUNDING)
        errors.append(factor * (total + _gamma(4 * m + 4) * (value + total)) + TINY)
        values.append(scale**m * value)
    return tuple(errors), tuple(values)


def _changes(rounded: Array, first_kind: Array) -> Array:
    """Rounding bounds of each step of each order, shape (orders, n); the last sum is the step of n = 0."""
    count = len(rounded)
    changes, terms = np.zeros((ORDERS, count)), np.zeros((ORDERS, count + 2))
    # U_n is the derivative of T_(n+1), divided by n + 1
    second_kind = first_kind[1:, 1:] / np.arange(1, first_kind.shape[1])
    for n in range(count - 1, -1, -1):
        for m in range(ORDERS):
            given = rounded[n] if m == 0 else 2.0 * m * terms[m - 1, n + 1]
            changes[m, n] = _gamma(_STEP) * (given + 2.0 * terms[m, n + 1] + terms[m, n + 2])
            by_order = [changes[s, n:] + (rounded[n:] if s == 0 else 0.0) for s in range(m + 1)]
            terms[m, n] = sum(
                comb(m, s) * float(given_there @ second_kind[m - s, : count - n])
                for s, given_there in enumerate(by_order)
            )
    return changes


def _at_end(n: int, m: int) -> float:
    """The derivative of order m of T_n at 1."""
    return float(prod((n * n - i * i) / (2 * i + 1) for i in range(m)))


def _gamma(count: int) -> float:
    return count * ROUNDOFF / (1.0 - count * ROUNDOFF)
