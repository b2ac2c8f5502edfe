"""The usual law: what a cycle does where nobody optimised it, beside which every result stands."""

from __future__ import annotations

from dataclasses import replace
from math import isclose
from typing import TYPE_CHECKING

from optlaws.cycles.placed import with_laws
from optlaws.cycles.specification.programme import LawSpan, is_optimal
from optlaws.cycles.specification.segments import CycleSegment, Free, Move
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.laws.making.transform import with_end_velocity
from optlaws.motion.piece import moves_at, named_law
from optlaws.tolerances import CLOSURE

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Cycle


def usual_cycle(cycle: Cycle) -> Cycle | None:
    """The cycle with modified sine in all its moves, added to the uniform motion between equal velocities; no limits.

    None where the moves have that law already, or one of them cannot: its ends have two velocities, or it passes given
    points.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise
    >>> cycle = Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm")
    >>> usual = usual_cycle(cycle)
    >>> round(usual.peak(2), 4), usual_cycle(usual) is None
    (19.348, True)
    """
    if _has_usual_law(cycle):
        return None
    try:
        segments = segments_with(USUAL, cycle)
        for i in comparable_moves(cycle):
            segments[i] = replace(segments[i], limits={})  # type: ignore[type-var] # dataclasses
        usual = with_laws(cycle, segments, limits={})
        usual.unchecked()
    except InputError:
        return None
    return usual


def why_without_usual_law(cycle: Cycle) -> str:
    """Why a cycle has no `usual_cycle`; empty where that law is its own.

    Examples
    --------
    >>> from optlaws import Cycle, Free, Return
    >>> through = Free("60 mm", "0.3 s", via=[("0.1 s", "50 mm")])
    >>> why_without_usual_law(Cycle([through, Return("60 mm")], period="1 s"))
    'modified sine cannot stand beside these laws: they pass given points, or have other velocities at their ends'
    """
    if _has_usual_law(cycle):
        return ""
    return f"{USUAL} cannot stand beside these laws: they pass given points, or have other velocities at their ends"


def _has_usual_law(cycle: Cycle) -> bool:
    """Whether all moves that may have another law have the usual one."""
    return all(getattr(cycle.segments[i], "law", None) == USUAL for i in comparable_moves(cycle))


def comparable_moves(cycle: Cycle) -> tuple[int, ...]:
    """The numbers, from 0, of the segments that may have another law: all moves but those whose law ends in motion.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Return, Rise
    >>> comparable_moves(Cycle([Rise("35 mm", "120 deg"), Dwell("60 deg"), Return()], speed="200 rpm"))
    (0, 2)
    """
    return tuple(i for i, each in enumerate(cycle.segments) if _may_have_another_law(each))


def _may_have_another_law(segment: CycleSegment) -> bool:
    return is_optimal(segment) or (
        isinstance(segment, Move) and not moves_at(named_law(segment.law, segment.label), 0, 1)
    )


def segments_with(law: str, cycle: Cycle) -> list[CycleSegment]:
    """The segments of a cycle with a law of the catalogue in all its comparable moves.

    Where a motion begins and ends with one velocity, the law is added to the uniform motion (eq. 1.17).

    Raises
    ------
    InputError
        If one of them passes given points, or has a velocity at its ends that the law cannot have.
    """
    given, segments = cycle.specification, list(cycle.segments)
    fixed = all(stretch.fixed for stretch in given.programme.stretches)
    alone = [span for span in given.layout.spans if len(span.stretches) == 1 and not span.turns] if fixed else []
    spans = {span.stretches[0].number - 1: span for span in alone}
    for i in comparable_moves(cycle):
        segments[i] = _with_law(law, segments[i], spans.get(i))
    return segments


def _with_law(name: str, segment: CycleSegment, span: LawSpan | None) -> CycleSegment:
    added = None if span is None else _on_uniform_motion(name, span)
    law = name if added is None else added
    if isinstance(segment, Free):
        if segment.via:
            raise InputError(f"{segment.label}: a law of the catalogue passes no points that are given")
        return Move(segment.by, segment.duration, to=segment.to, law=law, limits=segment.limits, name=segment.label)
    if isinstance(segment, Move) and added is None and (segment.start_velocity, segment.end_velocity) != (None, None):
        raise InputError(f"{segment.label}: a law of the catalogue has not these velocities at its ends")
    return replace(segment, law=law, start_velocity=None, end_velocity=None)  # type: ignore[type-var] # a dataclass


def _on_uniform_motion(name: str, span: LawSpan) -> MotionLaw | None:
    """A law of the catalogue added to the uniform motion of a span between equal velocities; None without these."""
    first, last = span.first.velocity, span.last.velocity
    if not (first and span.displacement and isclose(first, last, rel_tol=CLOSURE)):
        return None
    return with_end_velocity(named_law(name, span.where), first * span.duration / span.displacement)
