"""Segments with the laws of a motion at another speed, or of the cam that lets an elastic follower move so."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from optlaws.cycles.specification.programme import Programme, TimedSegment
from optlaws.cycles.specification.segments import ConstantVelocity, CycleSegment, Dwell, Move
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.making.transform import section
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.mechanisms.polydyne_cam import polydyne
from optlaws.motion.piece import Piece, unit_of
from optlaws.motion.quantities import TURN, Exact, positive_quantity
from optlaws.numbers import Quantity
from optlaws.tolerances import CLOSURE, SAME_TIME


def retimed_segments(
    programme: Programme, starts: Sequence[float], pieces: Sequence[Piece], share: float
) -> list[CycleSegment]:
    """The segments at another speed: unchanged laws, durations multiplied by `share`, joint laws in parts."""
    segments: list[CycleSegment] = []
    for stretch, (start, stop) in zip(programme.stretches, pairwise(starts), strict=True):
        time, name = Exact((stop - start) * share, "s"), stretch.given.label
        if isinstance(stretch.given, ConstantVelocity):
            velocity = Exact(stretch.displacement / (stop - start) / share, f"{unit_of(programme.axis)}/s")
            segments.append(ConstantVelocity(velocity, time, name=name))
        elif isinstance(stretch.given, Dwell):
            segments.append(Dwell(time, name=name))
        else:
            piece = next(piece for piece in reversed(pieces) if piece.start <= start)
            parts = _parts(stretch, piece, (start, stop), SAME_TIME * programme.period)
            segments += [
                Move(Exact(way, unit_of(programme.axis)), Exact(part * share, "s"), law=law, name=name)
                for way, part, law in parts
            ]
    return segments


def _parts(
    stretch: TimedSegment, piece: Piece, times: tuple[float, float], same_time: float
) -> list[tuple[float, float, MotionLaw]]:
    """Stroke, time and law of a stretch: of one move, or of two where the stretch ends at its starting position."""
    (start, stop), moved, law = times, stretch.displacement, piece.law
    alone = abs(piece.start - start) <= same_time and abs(piece.stop - stop) <= same_time
    if alone and abs(piece.stroke - moved) <= CLOSURE * abs(moved):
        return [(moved, stop - start, law)]
    if not isinstance(law, PiecewiseLaw):
        raise InputError(f"{stretch.where} ends where it begins: give it to a Cycle of its own at the other speed")
    first, last = (_break(law, piece, time) for time in times)
    ends = [first, last]
    if abs(moved) <= CLOSURE * abs(piece.stroke):
        heights = [abs(float(law(place)) - float(law(law.breaks[first]))) for place in law.breaks[first : last + 1]]
        ends.insert(1, first + heights.index(max(heights)))
    parts, left = list[tuple[float, float, MotionLaw]](), moved
    for low, high in pairwise(ends):
        way = left if high == last else piece.stroke * (float(law(law.breaks[high])) - float(law(law.breaks[low])))
        parts.append((way, piece.duration * (law.breaks[high] - law.breaks[low]), section(law, low, high)))
        left -= way
    return parts


def _break(law: PiecewiseLaw, piece: Piece, time: float) -> int:
    """The number of the break at a joint."""
    away = [abs(piece.start + place * piece.duration - time) for place in law.breaks]
    return away.index(min(away))


def segments_of_cam(
    programme: Programme, pieces: Sequence[Piece], period: Quantity, damping: float
) -> list[CycleSegment]:
    """The segments of the cam of an elastic follower: every move corrected by its frequency over its duration."""
    natural = positive_quantity(period, "time", "follower: period")
    if len(pieces) != len(programme.stretches):
        raise InputError(
            "the cam of an elastic follower is computed move by move: use moves in place of adjacent free motions"
        )
    segments: list[CycleSegment] = []
    for stretch, piece in zip(programme.stretches, pieces, strict=True):
        time, name = Exact(piece.duration, "s"), stretch.given.label
        if piece.stroke == 0.0:
            segments.append(Dwell(time, name=name))
            continue
        try:
            law = polydyne(piece.law, TURN * piece.duration / natural, damping)
        except InputError as error:
            raise InputError(f"{stretch.where}: {error}") from None
        segments.append(Move(Exact(stretch.displacement, unit_of(programme.axis)), time, law=law, name=name))
    return segments
