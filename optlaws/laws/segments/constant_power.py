"""Segments of constant kinetic power: the square of the velocity runs straight."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, log, prod

import numpy as np

from optlaws.errors import InputError
from optlaws.laws.segments.fractional import FractionalSegment
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.numbers import Array


@dataclass(frozen=True)
class PowerSegment(Segment, kind="power"):
    """Constant kinetic power: b² runs straight from b0² to b1², so that d = (b1² - b0²) / (2 length) throughout.

    This is b = sqrt(p + q s) with p = b0² and q = 2d, written so that a velocity of zero at either end is exact.
    There c and all derivatives above are infinite, and given as such; the integral of c² is infinite too.

    Parameters
    ----------
    b0, b1
        Velocities at the two ends, not both zero and not of opposite signs.

    Examples
    --------
    >>> segment = PowerSegment(0.0, 1.5)
    >>> segment.derivative(np.array([0.0, 1.0]), 0.5, 2), segment.power(np.array([0.0, 1.0]), 0.5)
    (array([inf, 1.5]), array([2.25, 2.25]))
    """

    b0: float
    b1: float

    def __post_init__(self) -> None:
        self._check()
        if self.b0 * self.b1 < 0.0 or self.b0 == self.b1 == 0.0:
            raise InputError(f"velocities of a power segment must not differ in sign or both be zero, got {self}")

    def derivative(self, u: Array, length: float, nu: int) -> Array:
        sign = 1.0 if self.b0 + self.b1 > 0.0 else -1.0
        square = self.b0**2 * (1.0 - u) + self.b1**2 * u
        b = np.sqrt(square)
        if nu == 0:
            first = abs(self.b0)
            total = np.where(b + first == 0.0, 1.0, b + first)
            return sign * u * length * (2.0 / 3.0) * (first * first + first * b + square) / total
        order = nu - 1
        rate = 2.0 * self._power(length)
        if order == 0 or rate == 0.0:
            return sign * b if order == 0 else np.zeros_like(u)
        factor = sign * prod((0.5 - i) * rate for i in range(order))
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray(factor * square ** (0.5 - order))

    def power(self, u: Array, length: float) -> Array:
        """Kinetic power d = b c at u, the same everywhere and finite where c is not."""
        return np.full(np.shape(u), self._power(length))

    def candidates(self, length: float, nu: int) -> Array:  # noqa: ARG002 - what others of its kind need
        return np.empty(0)

    def power_candidates(self, length: float) -> Array:  # noqa: ARG002 - what others of its kind need
        return np.empty(0)

    def square(self, length: float, nu: int) -> float:
        # with v = b², v' = q constant: the derivative of order nu is q^m v^(1/2-m) times a number, m = nu - 1
        m, q = nu - 1, 2.0 * self._power(length)
        start, end = self.b0 * self.b0, self.b1 * self.b1
        if m > 0 and (q == 0.0 or start * end == 0.0):
            return 0.0 if q == 0.0 else inf
        if m == 0:
            return 0.5 * length * (start + end)
        factor = prod(0.5 - i for i in range(m)) ** 2 * q ** (2 * m - 1)
        if m == 1:
            return factor * log(end / start)
        return factor * (end ** (2 - 2 * m) - start ** (2 - 2 * m)) / (2 - 2 * m)

    def scaled(self, length: float, scale: float, drift: float = 0.0) -> Segment:
        if drift == 0.0 and scale != 0.0:
            return PowerSegment(scale * self.b0, scale * self.b1)
        if self.b0 == self.b1:
            return PolynomialSegment((), scale * self.b0 + drift)
        return self.fractional(length).scaled(length, scale, drift)

    def backwards(self, length: float) -> Segment:  # noqa: ARG002 - what others of its kind need
        return PowerSegment(self.b1, self.b0)

    def times(self, length: float, y: Array) -> Segment:
        if self.b0 == self.b1:
            return PolynomialSegment((), self.b0)
        return self.fractional(length).times(length, y)

    def fractional(self, length: float) -> FractionalSegment:
        """Constant kinetic power as a power -1/2 of time.

        Examples
        --------
        >>> PowerSegment(0.0, 2.0).fractional(0.5)
        FractionalSegment(exponent=-0.5, first=0.0, last=4.0, coefficients=(4.0,), steady=0.0)
        """
        sign = 1.0 if self.b0 + self.b1 > 0.0 else -1.0
        first, last = self.b0**2, self.b1**2
        return FractionalSegment(-0.5, first, last, (sign * 0.5 * (last - first) / length,))

    def _power(self, length: float) -> float:
        return 0.5 * (self.b1 - self.b0) * (self.b1 + self.b0) / length
