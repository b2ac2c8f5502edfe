"""Proven bounds of the error of a motion that is evaluated in floating point."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import factorial, inf, nextafter, perm

from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numerics import exact


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
    """The motion in the numbers that an arithmetic has, each polynomial moved to where its break comes to lie.

    >>> as_stored(PiecewiseMotion([0.1, 1.1], [[0.0, 1.0]]), SINGLE).coefficients
    ((1.4901161415892261e-09, 1.0),)
    """
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
            bounds[nu] = max(bounds[nu], error + _underflow(run.degree, length, nu, arithmetic))
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


def _underflow(degree: int, length: Fraction, nu: int, arithmetic: FloatingPoint) -> Fraction:
    # four products a step may each miss by u times the least normal number, which at most 2^degree paths then carry on,
    # with at most as many factors s as there are steps; twice that covers the roundings on the way
    paths = Fraction((4 * degree + 2) * 2 ** (degree + 1)) * max(Fraction(1), length) ** degree
    return factorial(nu) * paths * arithmetic.unit * arithmetic.least
