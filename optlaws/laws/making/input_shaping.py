"""Input shaping: a law run faster and repeated, so that what it leaves of one vibration cancels (ZV, ZVD)."""

from __future__ import annotations

from itertools import pairwise
from math import exp, pi, sqrt
from typing import Literal

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.law import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array, circular_frequency, not_negative
from optlaws.numerics import chebyshev
from optlaws.tolerances import AGREEMENT

Shaper = Literal["ZV", "ZVD"]

_LEAST_TIME = 0.05


def shaped_law(law: MotionLaw, frequency: float, damping: float = 0.0, shaper: Shaper = "ZV") -> PiecewiseLaw:
    """A law shaped for one vibration, in the same total time: repeated half a period later, and itself as much faster.

    Zero vibration (ZV) has two repetitions and leaves nothing of that vibration; zero vibration and derivative (ZVD)
    has three and leaves little where the frequency is a little off too (Singer and Seering 1990).

    Parameters
    ----------
    law
        A law from rest to rest, or an entry of the catalogue or a solution, which stand for theirs.
    frequency
        Undamped circular frequency nu, radians in the total time.
    damping
        Ratio zeta, below 1.
    shaper
        "ZV" or "ZVD".

    Raises
    ------
    InputError
        If half a period (ZV) or a whole one (ZVD) leaves no time for the law itself, a number is out of range, or the
        law is none.

    Examples
    --------
    >>> from optlaws import Follower, smoothstep
    >>> law = shaped_law(smoothstep(3), 12.0)
    >>> round(Follower(12).response(law).residual_acceleration, 9), round(law.constants.C.value, 6)
    (0.0, 5.297373)
    """
    law = getattr(law, "law", law)
    if not isinstance(law, MotionLaw):
        raise InputError(f"law must be a motion law such as smoothstep(4), got {shortened(law)}")
    impulses = _impulses(circular_frequency(frequency), not_negative(damping, "damping"), shaper)
    duration = 1.0 - impulses[-1][0]
    if duration < _LEAST_TIME:
        periods = "half a period" if len(impulses) == 2 else "a period"
        raise InputError(
            f"{shaper} takes {periods} of the vibration, {impulses[-1][0]:.3g} of the total time at the frequency "
            f"{frequency:g}, and leaves no time for the law; a slower motion or a stiffer machine has room for it"
        )
    inner = np.array(law.breaks if isinstance(law, PiecewiseLaw) else (0.0, 1.0))
    places = np.unique(np.concatenate([start + duration * inner for start, _ in impulses]).round(15))
    places[0], places[-1] = 0.0, 1.0
    breaks = places[np.append(np.diff(places) > AGREEMENT, True)]
    segments = [_segment(law, impulses, duration, float(low), float(high)) for low, high in pairwise(breaks)]
    return PiecewiseLaw(breaks, segments, float(law.a(0.0)))


def _impulses(frequency: float, damping: float, shaper: object) -> list[tuple[float, float]]:
    """Times and shares of the repetitions."""
    if damping >= 1.0:
        raise InputError(f"damping must be below 1, got {damping:g}: from the critical damping on nothing vibrates")
    if shaper not in {"ZV", "ZVD"}:
        raise InputError(f'shaper must be "ZV" or "ZVD", got {shortened(shaper)}')
    root = sqrt(1.0 - damping * damping)
    half, left = pi / (frequency * root), exp(-damping * pi / root)
    if shaper == "ZV":
        return [(0.0, 1.0 / (1.0 + left)), (half, left / (1.0 + left))]
    total = (1.0 + left) ** 2
    return [(0.0, 1.0 / total), (half, 2.0 * left / total), (2.0 * half, left * left / total)]


def _segment(
    law: MotionLaw, impulses: list[tuple[float, float]], duration: float, low: float, high: float
) -> PolynomialSegment:
    middle = 0.5 * (low + high)
    running = [(start, share) for start, share in impulses if start < middle < start + duration]

    def total(k: Array, nu: int) -> Array:
        values = np.zeros(np.shape(k))
        for start, share in running:
            values += share / duration**nu * np.asarray(law(np.clip((k - start) / duration, 0.0, 1.0), nu))
        return values

    c = chebyshev.interpolated(lambda x: total(low + 0.5 * (high - low) * (x + 1.0), 2), "the acceleration")
    return PolynomialSegment(tuple(c.tolist()), float(total(np.array(low), 1)))
