"""Derivatives and peaks of stored laws by mpmath, to as many digits as it works with."""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from mpmath import mp, mpf  # type: ignore[import-untyped]
from numpy.typing import NDArray

from optlaws import PiecewiseLaw, PolynomialLaw
from tests.internals.laws import FractionalSegment, HarmonicSegment, PolynomialSegment, PowerSegment, SineSegment

Function = Callable[[Any], Any]
DENSE = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 20001))


class Exact:
    """A polynomial law: its powers are exact rationals."""

    def __init__(self, law: PolynomialLaw) -> None:
        powers = [mpf(value.numerator) / value.denominator for value in law.exact_powers()]
        self.orders = [powers]
        for _ in range(6):
            powers = [n * value for n, value in enumerate(powers)][1:] or [mpf(0)]
            self.orders.append(powers)

    def __call__(self, k: mpf, nu: int) -> mpf:
        total = mpf(0)
        for value in reversed(self.orders[nu]):
            total = total * k + value
        return total

    def peak(self, nu: int, samples: NDArray[np.float64]) -> mpf:
        return self._highest(samples, lambda k: self(k, nu), lambda k: self(k, nu + 1), lambda k: self(k, nu + 2))

    def power_peak(self, samples: NDArray[np.float64]) -> mpf:
        def value(k: mpf) -> mpf:
            return self(k, 1) * self(k, 2)

        def slope(k: mpf) -> mpf:
            return self(k, 2) ** 2 + self(k, 1) * self(k, 3)

        def bend(k: mpf) -> mpf:
            return 3 * self(k, 2) * self(k, 3) + self(k, 1) * self(k, 4)

        return self._highest(samples, value, slope, bend)

    @staticmethod
    def _highest(samples: NDArray[np.float64], value: Function, slope: Function, bend: Function) -> mpf:
        best = max(abs(value(mpf(0))), abs(value(mpf(1))))
        size = np.abs(samples)
        inner = size[1:-1]
        tops = 1 + np.flatnonzero((inner >= size[:-2]) & (inner >= size[2:]) & (inner >= size.max() * (1 - 1e-5)))
        for k in DENSE[tops[:: max(1, len(tops) // 20)]]:
            place = mpf(float(k))
            for _ in range(7):
                steep = bend(place)
                place -= slope(place) / steep if steep else 0
            if 0 <= place <= 1:
                best = max(best, abs(value(place)))
        return best


def stretches(law: PiecewiseLaw, nu: int, share: float = 0.0) -> list[tuple[Function, mpf, mpf]]:
    """A derivative of order nu >= 2 by the time since the start of each segment, and its ends, a share of it aside."""
    found = []
    for i, segment in enumerate(law.segments):
        length = mpf(law.breaks[i + 1]) - mpf(law.breaks[i])
        found.append((derivative(acceleration(segment, length), nu - 2), share * length, length - share * length))
    return found


def derivative(f: Function, order: int) -> Function:
    return lambda s: mp.diff(f, s, order) if order else f(s)


def acceleration(segment: Any, length: mpf) -> Function:
    if isinstance(segment, PolynomialSegment):
        return lambda s: mp.fsum(
            value * mp.chebyt(n, 2 * s / length - 1) for n, value in enumerate(segment.acceleration)
        )
    if isinstance(segment, SineSegment | HarmonicSegment):
        sines = (segment,) if isinstance(segment, SineSegment) else segment.sines
        return lambda s: mp.fsum(
            sine.amplitude * mp.sin(sine.frequency * s + sine.phase)
            + mp.fsum(power * s**n for n, power in enumerate(sine.powers))
            for sine in sines
        )
    if isinstance(segment, PowerSegment):
        start, more = mpf(segment.b0) ** 2, mpf(segment.b1) ** 2 - mpf(segment.b0) ** 2
        return lambda s: more / (2 * length) / mp.sqrt(start + more * s / length)
    assert isinstance(segment, FractionalSegment)

    def of_powers(s: mpf) -> mpf:
        v = segment.first + (mpf(segment.last) - segment.first) * s / length
        return v**segment.exponent * mp.fsum(q * v**n for n, q in enumerate(segment.coefficients))

    return of_powers


def highest(functions: Iterable[tuple[Function, mpf, mpf]], steps: int = 36) -> mpf:
    """The greatest magnitude of functions between their ends: golden sections about the good ones of 25 places each.

    Peaks of an optimum are as high as one another but for their last digit: the best place need not be at the highest.
    """
    tops = []
    for f, low, high in functions:
        places = [low + (high - low) * i / 24 for i in range(25)]
        values = [abs(f(s)) for s in places]
        for i, value in enumerate(values):
            before, after = max(i - 1, 0), min(i + 1, 24)
            if value >= max(values[before], values[after]):
                tops.append((value, f, places[before], places[after]))
    best = max(value for value, *_ in tops)
    return max(best, *(_risen(f, low, high, steps) for value, f, low, high in tops if value >= 0.97 * best))


def _risen(f: Function, low: mpf, high: mpf, steps: int) -> mpf:
    golden = (mp.sqrt(5) - 1) / 2
    for _ in range(steps):
        left, right = high - golden * (high - low), low + golden * (high - low)
        low, high = (low, right) if abs(f(left)) > abs(f(right)) else (left, high)
    return max(abs(f(low)), abs(f(high)))
