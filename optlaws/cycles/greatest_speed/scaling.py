"""Spans run slower: their times longer, the states at their joints less."""

from __future__ import annotations

from dataclasses import replace

from optlaws.cycles.specification.joints import LawSpan


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
