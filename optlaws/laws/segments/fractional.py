"""Segments whose acceleration falls or rises with any real power of time, exact as they stand."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, log

import numpy as np

from optlaws.errors import InputError
from optlaws.laws.segments.segment import Segment
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
