"""Spans run slower: their times longer, the states at their joints less, their limits shares that fall with the scale.

A motion that is run `scale` times slower has its velocity divided by the scale, its acceleration by the square of it.
A share of a derivative of order nu so falls with the power nu of the scale, whatever the law: a law that keeps such a
limit keeps it at every lower speed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import exp, inf, log

from optlaws.cycles.optimisation.motion_limits import Side
from optlaws.cycles.specification.joints import LawSpan
from optlaws.laws import MotionLaw
from optlaws.synthesis.problem.constants import Functional
from optlaws.tolerances import LEAST_SHARE, SAME_TIME

_SLOWEST = 2.0**40


@dataclass(frozen=True)
class SpanLimit:
    """A limit of a span as a share of its allowed value; the limit is satisfied where the share is at most 1.

    Attributes
    ----------
    key, most
        The side that is limited, and its limit in SI units.
    term
        The limited constant of the law, and the share that one unit of it takes, at a scale of the time.
    scales
        Whether a law that satisfies the limit satisfies it at every lower speed.
    """

    key: Side
    most: float
    term: Callable[[float], tuple[Functional, float]]
    scales: bool = True

    def share(self, law: MotionLaw, scale: float) -> float:
        """The share of the limit that a law uses, at a scale of the time."""
        constant, weight = self.term(scale)
        return constant.value(law) * weight

    def least_scale(self, law: MotionLaw) -> float:
        """The least scale from which on a law satisfies the limit; infinite if no scale does, 0 if all do."""
        from scipy.optimize import brentq

        if self.key.kind.order:
            return float(max(self.share(law, 1.0), 0.0) ** (1.0 / self.key.kind.order))
        high = 1.0
        while self.share(law, high) > 1.0:
            high *= 2.0
            if high > _SLOWEST:
                return inf
        low = 0.5 * high
        while self.share(law, low) <= 1.0:
            low, high = 0.5 * low, low
            if low < 1.0 / _SLOWEST:
                return 0.0
        root = brentq(
            lambda place: log(max(self.share(law, exp(place)), LEAST_SHARE)),
            log(low),
            log(high),
            xtol=SAME_TIME,
            rtol=SAME_TIME,
        )
        return exp(float(root))


def slower(span: LawSpan, scale: float) -> LawSpan:
    """The span slowed down by a factor: its times are longer, its velocities and accelerations smaller.

    >>> from optlaws.cycles.specification.joints import State
    >>> span = LawSpan((), (0.5,), 1.0, 0.0, 0.1, State(1.0, 8.0), State(0.0, 0.0), ((0.75, 0.05),))
    >>> slower(span, 2.0).stop, slower(span, 2.0).first, slower(span, 2.0).via
    (2.0, State(velocity=0.5, acceleration=2.0), ((1.5, 0.05),))
    """
    first, last, *states = (
        None
        if state is None
        else state._replace(velocity=state.velocity / scale, acceleration=state.acceleration / scale**2)
        for state in (span.first, span.last, *span.states)
    )
    if first is None or last is None:
        raise AssertionError  # they are known
    return replace(
        span,
        starts=tuple(start * scale for start in span.starts),
        stop=span.stop * scale,
        first=first,
        last=last,
        via=tuple((time * scale, position) for time, position in span.via),
        states=tuple(states),
    )
