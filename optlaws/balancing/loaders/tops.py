"""The tops of an executive law's velocity, where it reaches its peak B and the loader stands still."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import isfinite

import numpy as np

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numerics.tolerances import AGREEMENT, TOP_POINT, TOP_REACHED, TOP_STEP

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
    >>> from optlaws.laws import smoothstep
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
    """Stretches of [low, high] on which |b| reaches B, each with the least room around it."""
    if not low < high or depth > MOST:
        return []
    least, most = law.extrema(1, (low, high))
    k = most.k if most.value >= -least.value else least.k
    if max(most.value, -least.value) < B * (1.0 - TOP_REACHED):
        return []
    start, end = (_left_behind(law, B, k, limit) for limit in (low, high))
    return [
        *_regions(law, B, low, start, depth + 1),
        (start, end),
        *_regions(law, B, end, high, depth + 1),
    ]


def _left_behind(law: MotionLaw, B: float, k: float, limit: float) -> float:
    """The first place on the way from k to the limit where |b| is clearly below B."""
    step = TOP_STEP if limit > k else -TOP_STEP
    place = k
    while (limit - place) * step > 0.0:
        place += step
        if (limit - place) * step <= 0.0:
            break
        if abs(law.b(place)) < B * (1.0 - TOP_REACHED):
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
        if last - first < TOP_POINT:
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
    """A stationary point of b by Newton's method; a peak at a break, where c leaps, stays."""
    for _ in range(3):
        c, j = law.c(k), law.j(k)
        if not (isfinite(c) and isfinite(j)) or j == 0.0 or abs(c / j) > TOP_STEP:
            break
        k = min(max(k - c / j, low), high)
    return k
