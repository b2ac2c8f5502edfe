"""Segments whose acceleration falls or rises with any real power of time, exact as they stand.

Where the kinetic power is constant, the square of the velocity runs straight.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, log, prod

import numpy as np

from optlaws.errors import InputError
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.numbers import Array
from optlaws.numerics.roots import bisect
from optlaws.tolerances import SAME_EXPONENT

_SMALLEST_RATIO = 1e-30  # of two ends of a power: below it a power may overflow


class PowerSum(dict[float, float]):
    """A sum of real powers of v >= 0: coefficients by exponents.

    >>> sum_of_powers = PowerSum({0.0: 1.0, 1.5: 2.0})
    >>> sum_of_powers.value(np.array([0.0, 4.0])), sum_of_powers.slope()
    (array([ 1., 17.]), {0.5: 3.0})
    >>> PowerSum({0.5: 2.0}).times(PowerSum({0.5: 1.0, -0.5: 3.0})), PowerSum({-0.5: 1.0}).integral(0.0, 4.0)
    ({0.0: 6.0, 1.0: 2.0}, 4.0)
    """

    @classmethod
    def of(cls, terms: Iterable[tuple[float, float]]) -> PowerSum:
        """A sum of its terms, pairs of exponent and coefficient; exponents that differ by rounding are one.

        >>> PowerSum.of([(1.5, 2.0), (0.0, 1.0), (1.5, -2.0)])
        {0.0: 1.0}
        """
        total: dict[float, float] = {}
        last = -inf
        for exponent, coefficient in sorted(terms):
            last = last if exponent - last < SAME_EXPONENT else exponent
            total[last] = total.get(last, 0.0) + coefficient
        return cls({exponent: coefficient for exponent, coefficient in total.items() if coefficient != 0.0})

    def value(self, v: Array) -> Array:
        """Values at v >= 0; a negative power of zero is infinite, with the sign of its coefficient."""
        total = np.zeros(np.shape(v))
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            for exponent in sorted(self, reverse=True):  # the lowest last: at zero it decides
                part = self[exponent] * v**exponent
                total = np.where(np.isinf(part), part, total + part)
        return total

    def slope(self, rate: float = 1.0) -> PowerSum:
        """The derivative by what v changes with at a rate."""
        return PowerSum({e - 1.0: e * factor * rate for e, factor in self.items() if e != 0.0})

    def times(self, other: PowerSum) -> PowerSum:
        """The product of two sums."""
        return PowerSum.of((i + n, a * b) for i, a in self.items() for n, b in other.items())

    def integral(self, low: float, high: float) -> float:
        """Integral from low to high, both >= 0; infinite where it diverges."""
        total = 0.0
        for exponent, coefficient in self.items():
            above = exponent + 1.0
            if low == 0.0 and above <= 0.0:
                return inf if coefficient > 0.0 else -inf
            part = log(high / low) if above == 0.0 else (high**above - low**above) / above
            total += coefficient * part
        return total

    def roots(self, low: float, high: float) -> list[float]:
        """Every v in (low, high), low >= 0, where the sum changes sign.

        Divided by its lowest power and differentiated, a sum of n terms becomes one of n - 1 terms whose roots separate
        those of the first (Rolle); halving finds them one by one.

        >>> [round(v, 12) for v in PowerSum({0.0: 1.0, 0.5: -3.0, 1.0: 2.0}).roots(0.0, 4.0)]
        [0.25, 1.0]
        """
        if len(self) < 2:
            return []
        lowest = min(self)
        divided = PowerSum({exponent - lowest: factor for exponent, factor in self.items()})
        marks = [low, *divided.slope().roots(low, high), high]

        def at(v: float) -> float:
            return float(sum(factor * v**exponent for exponent, factor in divided.items()))

        zeros = [v for v in marks[1:-1] if at(v) == 0.0]
        for start, end in pairwise(marks):
            before = at(start)
            if before * at(end) < 0.0:
                zeros.append(sum(bisect(lambda v: at(v) * before > 0.0, start, end)) / 2.0)  # noqa: B023 - called at once
        return sorted(zeros)


@dataclass(frozen=True)
class FractionalSegment(Segment, kind="fractional"):
    """Acceleration c = v^exponent (q0 + q1 v + q2 v² + ...), v running straight from `first` to `last`.

    Velocity is `steady` plus powers of v, each integrated from v = 0; so a segment whose v ends at zero ends with the
    velocity `steady` exactly. With a negative exponent c is infinite there, and given as such.

    Parameters
    ----------
    exponent
        Any number above -1; one within 1e-9 of an integer is taken for it.
    first, last
        v at the start and at the end of the segment, at least 0 and different.
    coefficients
        q0, q1, ...
    steady
        Velocity apart from the powers of v.

    Examples
    --------
    >>> fall = FractionalSegment(1.5, 1.0, 0.0, (4.0,), 2.0)
    >>> fall.derivative(np.array([0.0, 0.75, 1.0]), 0.5, 2)
    array([4. , 0.5, 0. ])
    """

    exponent: float
    first: float
    last: float
    coefficients: tuple[float, ...]
    steady: float = 0.0

    def __post_init__(self) -> None:
        self._check()
        if abs(self.exponent - round(self.exponent)) < SAME_EXPONENT:
            object.__setattr__(self, "exponent", float(round(self.exponent)))
        low, high = sorted((self.first, self.last))
        if self.exponent <= -1.0 or low < 0.0 or low == high:
            raise InputError(f"a fractional segment needs exponent > -1 and first, last >= 0 and different, got {self}")
        if 0.0 < low < _SMALLEST_RATIO * high:
            raise InputError(f"first and last of a fractional segment must be 0 or of sizes that compare, got {self}")

    def derivative(self, u: Array, length: float, nu: int) -> Array:
        v = self._v(u)
        if nu > 0:
            return self.powers(length, nu).value(v)
        rate = (self.last - self.first) / length
        raised = PowerSum({e + 1.0: q / ((e + 1.0) * rate) for e, q in self._swing(length).items()})
        start = raised.value(np.array(self.first))
        return np.asarray(self.steady * length * u + raised.value(v) - start, dtype=np.float64)

    def power(self, u: Array, length: float) -> Array:
        """Kinetic power d = b c at u, finite where c is infinite and b zero."""
        return self.power_powers(length).value(self._v(u))

    def candidates(self, length: float, nu: int) -> Array:
        return self._u(self.powers(length, nu + 1))

    def power_candidates(self, length: float) -> Array:
        return self._u(self.power_powers(length).slope())

    def square(self, length: float, nu: int) -> float:
        powers = self.powers(length, nu)
        low, high = sorted((self.first, self.last))
        return powers.times(powers).integral(low, high) * length / (high - low)

    def scaled(self, length: float, scale: float, drift: float = 0.0) -> Segment:  # noqa: ARG002 - others need it
        coefficients = tuple(scale * coefficient for coefficient in self.coefficients)
        return replace(self, coefficients=coefficients, steady=scale * self.steady + drift)

    def backwards(self, length: float) -> Segment:  # noqa: ARG002 - what others of its kind need
        return replace(
            self,
            first=self.last,
            last=self.first,
            coefficients=tuple(-coefficient for coefficient in self.coefficients),
        )

    def times(self, length: float, y: Array) -> Segment:  # noqa: ARG002 - what others of its kind need
        # x = 2u - 1 is straight in v: x = (2v - first - last) / (last - first)
        span = self.last - self.first
        place = np.polynomial.Polynomial([-(self.first + self.last) / span, 2.0 / span])
        factor = np.polynomial.Polynomial(np.polynomial.chebyshev.cheb2poly(y))(place)
        changed = np.polynomial.Polynomial(self.coefficients) * factor
        return replace(self, coefficients=tuple(changed.coef.tolist()))

    def plus_derivatives(self, length: float, once: float, twice: float) -> Segment:
        c, j, s = (self.powers(length, nu) for nu in (2, 3, 4))
        terms = ((e, factor * q) for powers, factor in ((c, 1.0), (j, once), (s, twice)) for e, q in powers.items())
        total = PowerSum.of(terms)
        lowest, highest = min(total, default=0.0), max(total, default=0.0)
        if lowest <= -1.0:
            return super().plus_derivatives(length, once, twice)
        coefficients = [0.0] * (round(highest - lowest) + 1)
        for e, q in total.items():
            coefficients[round(e - lowest)] = q
        # what is constant in b, c and j is no power of v that c has
        steady = self.steady + once * c.get(0.0, 0.0) + twice * j.get(0.0, 0.0)
        return replace(self, exponent=lowest, coefficients=tuple(coefficients), steady=steady)

    def at_rest(self, length: float, share: float) -> Segment:
        if self.exponent < 0.0:
            swing = float(np.abs(self.derivative(np.array([0.0, 1.0]), length, 1)).max())
            if abs(self.steady) <= share * swing:
                return replace(self, steady=0.0)
        return self

    def _v(self, u: Array) -> Array:
        return np.asarray(self.first * (1.0 - u) + self.last * u, dtype=np.float64)

    def _u(self, powers: PowerSum) -> Array:
        low, high = sorted((self.first, self.last))
        roots = np.array(powers.roots(low, high))
        return (roots - self.first) / (self.last - self.first)

    def _swing(self, length: float) -> PowerSum:
        """Velocity without its steady part, in powers of v."""
        rate = (self.last - self.first) / length
        terms = ((self.exponent + i + 1.0, q) for i, q in enumerate(self.coefficients))
        return PowerSum.of((e, q / (e * rate)) for e, q in terms)

    def powers(self, length: float, nu: int) -> PowerSum:
        """The derivative of order nu, at least 1, in powers of v."""
        if nu == 1:
            return PowerSum.of([(0.0, self.steady), *self._swing(length).items()])
        rate = (self.last - self.first) / length
        terms = PowerSum.of((self.exponent + i, q) for i, q in enumerate(self.coefficients))
        for _ in range(nu - 2):
            terms = terms.slope(rate)
        return terms

    def power_powers(self, length: float) -> PowerSum:
        """The kinetic power d = b c in powers of v."""
        return self.powers(length, 1).times(self.powers(length, 2))


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
