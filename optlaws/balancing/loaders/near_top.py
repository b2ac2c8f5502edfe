"""The velocity of the loader near its standstill: series of sqrt(B² - b²) in the distance t from the top of b."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import comb, factorial, inf, isfinite, log2, sqrt

import numpy as np

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.tolerances import CONVERGENCE_RADIUS, VALUE_ROUNDING

Derivative = Callable[[float, int], float]

TERMS = 48
OVERFLOW = 1e120
REACH = 0.35  # share of the radius of convergence that the series is used on: 0.35^48 = 1e-22


@dataclass(frozen=True, slots=True)
class PuiseuxSeries:
    """The series sum coefficients[n] t^(exponent + step n) for 0 <= t <= reach."""

    exponent: float
    step: float
    coefficients: tuple[float, ...]
    reach: float

    def derivative(self, t: Array, order: int) -> Array:
        """Derivative of some order with respect to t; inf or -inf at t = 0 where it grows without limit."""
        first, values = self._factored(order)
        lead, rest = first, np.polynomial.polynomial.polyval(t**self.step, values)
        with np.errstate(divide="ignore"):
            return np.asarray(np.where(rest == 0.0, 0.0, t**lead * np.where(rest == 0.0, 1.0, rest)))

    def integral(self, t: Array) -> Array:
        """Integral from 0 to t."""
        powers = self.exponent + self.step * np.arange(len(self.coefficients)) + 1.0
        values = np.array(self.coefficients) / powers
        return np.asarray(t ** (self.exponent + 1.0) * np.polynomial.polynomial.polyval(t**self.step, values))

    def roots(self, order: int) -> Array:
        """Every t in (0, reach) where the derivative of some order may be zero."""
        half = 0.5 * self.reach**self.step
        powers = half * (chebyshev.nodes(TERMS) + 1.0)
        series = chebyshev.from_values(np.polynomial.polynomial.polyval(powers, self._factored(order)[1]))
        return np.asarray((half * (chebyshev.real_parts_of_roots(series) + 1.0)) ** (1.0 / self.step))

    def square(self, order: int) -> float:
        """Integral over 0 <= t <= reach of the square of the derivative of some order; inf where it diverges."""
        first, values = self._factored(order)
        both = np.convolve(values, values)
        powers = 2.0 * first + self.step * np.arange(len(both)) + 1.0
        if powers[0] <= 0.0:
            return inf
        return float(both @ (self.reach**powers / powers))

    def _factored(self, order: int) -> tuple[float, Array]:
        """The derivative as t^first times a polynomial in t^step, led by a term that does not vanish."""
        powers = self.exponent + self.step * np.arange(len(self.coefficients))
        values = np.array(self.coefficients)
        for i in range(order):
            values = values * (powers - i)
        nonzero = np.flatnonzero(values)
        lead = int(nonzero[0]) if len(nonzero) else 0
        return float(powers[lead] - order), values[lead:]


@dataclass(frozen=True, slots=True)
class VelocityDeficit:
    """Series of the deficit w = B - |b| beside a top of the velocity, and of sqrt(w (2B - w)), the `root`."""

    deficit: PuiseuxSeries
    root: PuiseuxSeries

    def energy(self, t: Array, B: float, order: int) -> list[Array]:
        """Derivatives 0 to `order` of w (2B - w) with respect to t > 0."""
        w = [self.deficit.derivative(t, i) for i in range(order + 1)]
        orders = [w[0] * (2.0 * B - w[0])]
        for n in range(1, order + 1):
            cross = sum(comb(n, i) * w[i] * w[n - i] for i in range(1, n))
            orders.append(2.0 * (B - w[0]) * w[n] - cross)
        return orders


def velocity_deficit(derivative: Derivative, B: float, length: float, where: str) -> VelocityDeficit:
    """The deficit beside a top from one-sided derivatives of |b| with respect to t, `derivative(t, order)`.

    Either |b| is analytic there, or c is a power of t.
    """
    taylor = _taylor(derivative, B, length)
    if taylor is not None:
        radius = _radius(taylor, B)
        w = [0.0, *taylor]
        for n in range(1, TERMS):
            if abs(w[n]) * min(radius, length) ** n > VALUE_ROUNDING * B:
                break
            w[n] = 0.0
        return _series_of(w, 1.0, B, reach=REACH * radius, length=length, where=where)
    p = _power(derivative, length)
    if p is None:
        raise InputError(f"velocity of the law at k = {where} must fall analytically or as a power of the distance")
    w = [0.0, -derivative(length, 1) * length**-p / (p + 1.0), *([0.0] * (TERMS - 1))]
    return _series_of(w, p + 1.0, B, reach=inf, length=length, where=where)


def _taylor(derivative: Derivative, B: float, length: float) -> list[float] | None:
    """Terms 1 to TERMS of w in powers of t; None where the series is of no use on the length."""
    coefficients: list[float] = []
    for n in range(1, TERMS + 1):
        coefficient = -derivative(0.0, n) / factorial(n)
        if n >= 3 and not (abs(coefficient) / B) ** (1.0 / n) * CONVERGENCE_RADIUS * length <= 1.0:
            return None
        coefficients.append(coefficient)
    return coefficients


def _series_of(w: list[float], step: float, B: float, *, reach: float, length: float, where: str) -> VelocityDeficit:
    energy = -np.convolve(w, w)[: TERMS + 1]
    energy += 2.0 * B * np.array(w)
    lead = int(np.flatnonzero(energy)[0]) if energy.any() else 0
    h = energy[lead:]
    if lead == 0 or h[0] < 0.0:
        raise InputError(f"velocity of the law at k = {where} must be below its peak B on both sides of the top")
    q = [sqrt(h[0])]
    for n in range(1, len(h)):
        q.append((h[n] - sum(q[i] * q[n - i] for i in range(1, n))) / (2.0 * q[0]))
        if abs(q[-1]) > OVERFLOW * q[0]:  # tops that all but meet: fewer terms on a shorter reach do as well
            break
    near = min(length, reach, (REACH * _radius(q[1:], q[0])) ** (1.0 / step))
    return VelocityDeficit(
        PuiseuxSeries(0.0, step, tuple(w), min(reach, length)), PuiseuxSeries(0.5 * step * lead, step, tuple(q), near)
    )


def _radius(coefficients: list[float], scale: float) -> float:
    """An estimate from below of the radius of convergence."""
    rates = [(abs(coefficient) / scale) ** (1.0 / n) for n, coefficient in enumerate(coefficients, 1) if n >= 3]
    return float(1.0 / max(*rates, 1e-3))


def _power(derivative: Derivative, length: float) -> float | None:
    """The exponent of c where it is a power of t."""
    values = [derivative(length * 0.5**i, 1) for i in range(5)]
    if not all(isfinite(value) and value < 0.0 for value in values):
        return None
    exponents = [log2(high / low) for high, low in pairwise(values)]
    if max(exponents) - min(exponents) > 1e-9:
        return None
    return float(np.mean(exponents))
