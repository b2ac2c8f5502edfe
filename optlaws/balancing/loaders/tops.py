"""The tops of an executive law's velocity, where its loader stands still, and series beside them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import comb, factorial, inf, isfinite, log2, sqrt

import numpy as np

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.tolerances import AGREEMENT, VALUE_ROUNDING

_CONVERGENCE_RADIUS = 1e-3  # of a length: a smaller radius of convergence is of no use
_TOP_REACHED = 1e-10  # of B: velocities so near count as B
_TOP_STEP = 1e-6  # of a law: the first step along its top
_TOP_POINT = 1e-4  # a narrower top is a point: b - B is of the fourth order in it

MOST = 41


@dataclass(frozen=True, slots=True)
class VelocityTop:
    """A place, or a stretch of k, where |b| = B; the loader stands still there, and reverses."""

    first: float
    last: float


def is_symmetric(law: MotionLaw) -> bool:
    """Whether b(1 - k) = b(k), to rounding."""
    k = np.linspace(0.0, 0.5, 65)
    return bool(np.abs(law.b(k) - law.b(1.0 - k)).max() <= AGREEMENT * law.peak(1).value)


@lru_cache(maxsize=256)
def tops(law: MotionLaw) -> tuple[VelocityTop, ...]:
    """Every top of the velocity, in order.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> tops(smoothstep(2))
    (VelocityTop(first=0.5, last=0.5),)
    """
    B = law.peak(1).value
    if not (isfinite(B) and B > 0.0):
        raise InputError(f"law must move with finite velocity to have a loader; its peak velocity B is {B:g}")
    regions = sorted(_regions(law, B, 0.0, 1.0))
    places = tuple(_narrowed(law, B, *region) for region in regions)
    at_places = ", ".join(
        f"{place.first:.6g}" if place.first == place.last else f"{place.first:.6g} to {place.last:.6g}"
        for place in places
    )
    if places[0].first <= 0.0 or places[-1].last >= 1.0:
        raise InputError(
            f"law must reach its peak velocity B = {B:.6g} inside the motion, where the loader reverses; it has it at "
            f"k = {at_places}"
        )
    if len(places) % 2 == 0:
        raise InputError(
            f"law must reach its peak velocity B = {B:.6g} an odd number of times, for the loader reverses at each; it "
            f"does so at k = {at_places}"
        )
    return places


def _regions(law: MotionLaw, B: float, low: float, high: float, depth: int = 0) -> list[tuple[float, float]]:
    """Stretches of [low, high] on which |b| reaches B, each with a small margin on both sides."""
    if not low < high or depth > MOST:
        return []
    least, most = law.extrema(1, (low, high))
    k = most.k if most.value >= -least.value else least.k
    if max(most.value, -least.value) < B * (1.0 - _TOP_REACHED):
        return []
    start, end = (_left_behind(law, B, k, limit) for limit in (low, high))
    return [
        *_regions(law, B, low, start, depth + 1),
        (start, end),
        *_regions(law, B, end, high, depth + 1),
    ]


def _left_behind(law: MotionLaw, B: float, k: float, limit: float) -> float:
    """The first place on the way from k to the limit where |b| is clearly below B."""
    step = _TOP_STEP if limit > k else -_TOP_STEP
    place = k
    while (limit - place) * step > 0.0:
        place += step
        if (limit - place) * step <= 0.0:
            break
        if abs(law.b(place)) < B * (1.0 - _TOP_REACHED):
            return place
        step *= 1.5
    return limit


def _narrowed(law: MotionLaw, B: float, low: float, high: float) -> VelocityTop:
    least, most = law.extrema(1, (low, high))
    first = most.k if most.value >= -least.value else least.k
    last = _end_of_flat(law, B, first)
    if last == first:
        first = last = _polished(law, first, low, high)
    if low < 0.5 < high and is_symmetric(law):
        first, last = min(first, 1.0 - last), max(last, 1.0 - first)
        if last - first < _TOP_POINT:
            first = last = 0.5
    return VelocityTop(first, last)


def _end_of_flat(law: MotionLaw, B: float, first: float) -> float:
    last = first
    for start, end in pairwise([first, *(k for k in law.breaks if k > first)]):
        inside = np.abs(law.b(np.linspace(start, end, 11)[1:-1]))
        if (inside < B * (1.0 - 1e-14)).any():
            break
        last = end
    return last


def _polished(law: MotionLaw, k: float, low: float, high: float) -> float:
    """A stationary point of b by Newton's method; a peak at a break, where c jumps, stays."""
    for _ in range(3):
        c, j = law.c(k), law.j(k)
        if not (isfinite(c) and isfinite(j)) or j == 0.0 or abs(c / j) > _TOP_STEP:
            break
        k = min(max(k - c / j, low), high)
    return k


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

    def derivative(self, t: Array, nu: int) -> Array:
        """Derivative of order nu with respect to t; inf or -inf at t = 0 where it grows without limit."""
        first, values = self._factored(nu)
        lead, rest = first, np.polynomial.polynomial.polyval(t**self.step, values)
        with np.errstate(divide="ignore"):
            return np.asarray(np.where(rest == 0.0, 0.0, t**lead * np.where(rest == 0.0, 1.0, rest)))

    def integral(self, t: Array) -> Array:
        """Integral from 0 to t."""
        powers = self.exponent + self.step * np.arange(len(self.coefficients)) + 1.0
        values = np.array(self.coefficients) / powers
        return np.asarray(t ** (self.exponent + 1.0) * np.polynomial.polynomial.polyval(t**self.step, values))

    def roots(self, nu: int) -> Array:
        """Every t in (0, reach) where the derivative of order nu may be zero."""
        half = 0.5 * self.reach**self.step
        powers = half * (chebyshev.nodes(TERMS) + 1.0)
        series = chebyshev.from_values(np.polynomial.polynomial.polyval(powers, self._factored(nu)[1]))
        return np.asarray((half * (chebyshev.real_parts_of_roots(series) + 1.0)) ** (1.0 / self.step))

    def square(self, nu: int) -> float:
        """Integral over 0 <= t <= reach of the square of the derivative of order nu; inf where it diverges."""
        first, values = self._factored(nu)
        both = np.convolve(values, values)
        powers = 2.0 * first + self.step * np.arange(len(both)) + 1.0
        if powers[0] <= 0.0:
            return inf
        return float(both @ (self.reach**powers / powers))

    def _factored(self, nu: int) -> tuple[float, Array]:
        """The derivative as t^first times a polynomial in t^step, led by a term that does not vanish."""
        powers = self.exponent + self.step * np.arange(len(self.coefficients))
        values = np.array(self.coefficients)
        for i in range(nu):
            values = values * (powers - i)
        nonzero = np.flatnonzero(values)
        lead = int(nonzero[0]) if len(nonzero) else 0
        return float(powers[lead] - nu), values[lead:]


@dataclass(frozen=True, slots=True)
class VelocityDeficit:
    """Series of the deficit w = B - |b| beside a top of the velocity, and of sqrt(w (2B - w)), the `root`."""

    deficit: PuiseuxSeries
    root: PuiseuxSeries

    def energy(self, t: Array, B: float, nu: int) -> list[Array]:
        """Derivatives 0 to `nu` of w (2B - w) with respect to t > 0."""
        w = [self.deficit.derivative(t, i) for i in range(nu + 1)]
        orders = [w[0] * (2.0 * B - w[0])]
        for n in range(1, nu + 1):
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
        if n >= 3 and not (abs(coefficient) / B) ** (1.0 / n) * _CONVERGENCE_RADIUS * length <= 1.0:
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
