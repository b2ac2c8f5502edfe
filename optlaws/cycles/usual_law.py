"""The usual law: what a cycle does where nobody optimised it, beside which every result stands."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from optlaws.cycles.placed import with_laws
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.specification.segments import CycleSegment, Free, Move
from optlaws.errors import InputError
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.motion.piece import moves_at, named_law

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Cycle


def usual_cycle(cycle: Cycle) -> Cycle | None:
    """The cycle with modified sine in all its moves from rest to rest, without limits.

    None where the moves have that law already, or one of them cannot: it ends in motion, or passes given points.

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
    moves = [i for i, each in enumerate(cycle.segments) if may_have_another_law(each)]
    try:
        usual_moves = {i: replace(with_law(USUAL, cycle.segments[i]), limits={}) for i in moves}  # type: ignore[type-var] # dataclasses
        segments = [usual_moves.get(i, each) for i, each in enumerate(cycle.segments)]
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
    'modified sine cannot stand beside these laws: it goes from rest to rest, and not all of these moves do'
    """
    if _has_usual_law(cycle):
        return ""
    return f"{USUAL} cannot stand beside these laws: it goes from rest to rest, and not all of these moves do"


def _has_usual_law(cycle: Cycle) -> bool:
    """Whether all moves that may have another law have the usual one."""
    return all(getattr(each, "law", None) == USUAL for each in cycle.segments if may_have_another_law(each))


def may_have_another_law(segment: CycleSegment) -> bool:
    """Whether a segment is a motion that is optimised, or a move whose given law does not end in motion."""
    return is_optimal(segment) or (
        isinstance(segment, Move) and not moves_at(named_law(segment.law, segment.label), 0, 1)
    )


def with_law(law: str, segment: CycleSegment) -> CycleSegment:
    """A segment with a law of the catalogue."""
    if isinstance(segment, Free):
        if segment.via:
            raise InputError(f"{segment.label}: a law of the catalogue passes no points that are given")
        return Move(segment.by, segment.duration, to=segment.to, law=law, limits=segment.limits, name=segment.label)
    if isinstance(segment, Move) and (segment.start_velocity, segment.end_velocity) != (None, None):
        raise InputError(f"{segment.label}: a law of the catalogue has no velocity at its ends")
    return replace(segment, law=law)  # type: ignore[type-var] # a dataclass
