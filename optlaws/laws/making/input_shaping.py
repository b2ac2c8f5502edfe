"""Input shaping: a law is executed faster and repeated, so that its residual vibrations cancel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import reduce
from itertools import pairwise
from math import cbrt, exp, pi, sqrt
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.laws.law import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array, circular_frequency, not_negative
from optlaws.numerics import chebyshev
from optlaws.tolerances import AGREEMENT

Shaper: TypeAlias = Literal["ZV", "MZV", "ZVD", "EI", "two-hump EI", "three-hump EI"]

#: what the EI shapers leave at their frequency, of what an unshaped step leaves
EI_RESIDUAL = 0.05

_LEAST_TIME = 0.05


class Impulse(NamedTuple):
    """A repetition of the law: when it begins, in damped periods, and its share of the way."""

    start: float
    share: float


def shaped_law(
    law: MotionLaw,
    frequency: float | Sequence[float],
    damping: float | Sequence[float] = 0.0,
    shaper: Shaper = "ZV",
) -> PiecewiseLaw:
    """A law shaped for one vibration or several, in the same total time: the law is accelerated and repeated.

    | shaper | repetitions | lasts, in damped periods | what it leaves |
    |---|---|---|---|
    | ZV | 2 | 1/2 | nothing at the frequency (Smith 1957) |
    | MZV | 3 | 3/4 | nothing at the frequency, and less than ZV beside it |
    | ZVD | 3 | 1 | nothing, and little beside it (Singer and Seering 1990) |
    | EI | 3 | 1 | 5 % at the frequency, at most that over a wider range (Singhose, Seering and Singer 1994) |
    | two-hump EI | 4 | 3/2 | at most 5 % over a still wider range (Singhose, Porter, Tuttle and Singer 1997) |
    | three-hump EI | 5 | 2 | the same, wider again |

    The EI shapers are those of undamped vibrations; with a damping their repetitions decay with it, which is exact for
    none and close below 0.1.

    Parameters
    ----------
    law
        A law from rest to rest, or an entry of the catalogue or a solution, which stand for theirs.
    frequency
        Undamped circular frequency nu, radians in the total time; several for a shaper of each, one after the other.
    damping
        Ratio zeta, below 1: one for all, or one for each frequency.
    shaper
        Which, by its name.

    Raises
    ------
    InputError
        If the shapers leave no time for the law itself, a number is out of range, or the law is none.

    Examples
    --------
    >>> from optlaws import Follower, smoothstep
    >>> law = shaped_law(smoothstep(3), 12.0)
    >>> round(Follower(12).response(law).residual_acceleration, 9), round(law.constants.C.value, 6)
    (0.0, 5.297373)
    >>> both = shaped_law(smoothstep(3), [20.0, 45.0], shaper="MZV")
    >>> [round(Follower(nu).response(both).residual_acceleration, 9) for nu in (20, 45)]
    [0.0, 0.0]
    """
    law = getattr(law, "law", law)
    if not isinstance(law, MotionLaw):
        raise InputError(f"law must be a motion law such as smoothstep(4), got {shortened(law)}")
    impulses = reduce(_convolved, _trains(frequency, damping, shaper))
    duration = 1.0 - impulses[-1].start
    if duration < _LEAST_TIME:
        periods = _SHARES[shaper](1.0)[-1].start
        raise InputError(
            f"{shaper} takes {periods:g} of a period of each vibration, {impulses[-1].start:.3g} of the total time at "
            f"the frequency {shortened(frequency)}, and leaves no time for the law; a slower motion or a stiffer "
            "machine has room for it"
        )
    inner = np.array(law.breaks if isinstance(law, PiecewiseLaw) else (0.0, 1.0))
    places = np.unique(np.concatenate([start + duration * inner for start, _ in impulses]).round(15))
    places[0], places[-1] = 0.0, 1.0
    breaks = places[np.append(np.diff(places) > AGREEMENT, True)]
    segments = [_segment(law, impulses, duration, float(low), float(high)) for low, high in pairwise(breaks)]
    return PiecewiseLaw(breaks, segments, float(law.a(0.0)))


def _trains(frequency: object, damping: object, shaper: Any) -> list[list[Impulse]]:
    """The repetitions of each vibration's shaper, in times of the law."""
    check_names([shaper], _SHARES, "shaper")
    frequencies = list(frequency) if isinstance(frequency, Sequence) and not isinstance(frequency, str) else [frequency]
    dampings = list(damping) if isinstance(damping, Sequence) and not isinstance(damping, str) else [damping]
    dampings = dampings * len(frequencies) if len(dampings) == 1 else dampings
    if not frequencies or len(dampings) != len(frequencies):
        raise InputError(
            f"one damping for all vibrations or one for each of the {len(frequencies)}, got {shortened(damping)}"
        )
    return [
        _train(circular_frequency(nu), not_negative(zeta, "damping"), _SHARES[shaper])
        for nu, zeta in zip(frequencies, dampings, strict=True)
    ]


def _train(frequency: float, damping: float, shares: Callable[[float], list[Impulse]]) -> list[Impulse]:
    if damping >= 1.0:
        raise InputError(f"damping must be below 1, got {damping:g}: from the critical damping on nothing vibrates")
    root = sqrt(1.0 - damping * damping)
    # how much of a vibration a damped period leaves
    impulses = shares(exp(-2.0 * pi * damping / root))
    total = sum(impulse.share for impulse in impulses)
    period = 2.0 * pi / (frequency * root)
    return [Impulse(impulse.start * period, impulse.share / total) for impulse in impulses]


def _convolved(first: list[Impulse], second: list[Impulse]) -> list[Impulse]:
    """Every repetition of one repeated by the other, in the order of time."""
    return sorted(Impulse(x.start + y.start, x.share * y.share) for x in first for y in second)


def _decaying(starts: Sequence[float], shares: Sequence[float]) -> Callable[[float], list[Impulse]]:
    """Shares at starts in periods, which a vibration that a period leaves so much of takes up less and less."""
    return lambda left: [Impulse(start, share * left**start) for start, share in zip(starts, shares, strict=True)]


def _two_humps(v: float) -> list[float]:
    X = cbrt(v * v * (sqrt(1.0 - v * v) + 1.0))
    outer = (3.0 * X * X + 2.0 * X + 3.0 * v * v) / (16.0 * X)
    return [outer, 0.5 - outer, 0.5 - outer, outer]


def _three_humps(v: float) -> list[float]:
    outer = (1.0 + 3.0 * v + 2.0 * sqrt(2.0 * (v + 1.0) * v)) / 16.0
    beside = (1.0 - v) / 4.0
    return [outer, beside, 1.0 - 2.0 * (outer + beside), beside, outer]


_V = EI_RESIDUAL
_SHARES: dict[str, Callable[[float], list[Impulse]]] = {
    "ZV": _decaying([0.0, 0.5], [1.0, 1.0]),
    "MZV": _decaying([0.0, 0.375, 0.75], [1.0 - sqrt(0.5), sqrt(2.0) - 1.0, 1.0 - sqrt(0.5)]),
    "ZVD": _decaying([0.0, 0.5, 1.0], [1.0, 2.0, 1.0]),
    "EI": _decaying([0.0, 0.5, 1.0], [1.0 + _V, 2.0 - 2.0 * _V, 1.0 + _V]),
    "two-hump EI": _decaying([0.0, 0.5, 1.0, 1.5], _two_humps(_V)),
    "three-hump EI": _decaying([0.0, 0.5, 1.0, 1.5, 2.0], _three_humps(_V)),
}


def _segment(law: MotionLaw, impulses: list[Impulse], duration: float, low: float, high: float) -> PolynomialSegment:
    middle = 0.5 * (low + high)
    running = [(start, share) for start, share in impulses if start < middle < start + duration]

    def total(k: Array, nu: int) -> Array:
        values = np.zeros(np.shape(k))
        for start, share in running:
            values += share / duration**nu * np.asarray(law(np.clip((k - start) / duration, 0.0, 1.0), nu))
        return values

    c = chebyshev.interpolated(lambda x: total(low + 0.5 * (high - low) * (x + 1.0), 2), "the acceleration")
    return PolynomialSegment(tuple(c.tolist()), float(total(np.array(low), 1)))
