"""The retiming of a cycle: the same laws at another speed, and the cam for an elastic follower."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from optlaws.cycles.specification.programme import Programme, TimedSegment
from optlaws.cycles.specification.segments import ConstantVelocity, CycleSegment, Dwell, Move
from optlaws.errors import InputError
from optlaws.laws.making.transform import section
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.mechanisms.follower.polydyne import polydyne
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import TURN, positive_quantity
from optlaws.numbers import Quantity
from optlaws.numerics.tolerances import CLOSURE


@dataclass(frozen=True)
class TimedCycle:
    """A cycle with its laws: the segments as given and as numbers, times of joints, the laws in their places."""

    segments: Sequence[CycleSegment]
    programme: Programme
    starts: Sequence[float]
    pieces: Sequence[Piece]

    def by_segment(self, why: str) -> Iterator[tuple[TimedSegment, CycleSegment, Piece]]:
        """Segments with their pieces, where each has one.

        Raises
        ------
        InputError
            If one law is of several segments.
        """
        if len(self.pieces) != len(self.segments):
            raise InputError(f"{why}: take moves in place of free motions that meet")
        return zip(self.programme.stretches, self.segments, self.pieces, strict=True)

    def shown(self, displacement: float) -> str:
        """A displacement as a text with its unit."""
        return f"{displacement!r} {'m' if self.programme.axis == 'length' else 'rad'}"


def segments_at(cycle: TimedCycle, share: float) -> list[CycleSegment]:
    """Every law as it is, every duration as many times as long as `share` says; a law of several segments in parts.

    Raises
    ------
    InputError
        If a law of one polynomial ends where it begins.
    """
    segments: list[CycleSegment] = []
    times = zip(cycle.programme.stretches, pairwise(cycle.starts), strict=True)
    for segment, (start, stop) in times:
        time, name = f"{(stop - start) * share!r} s", segment.given.label
        if isinstance(segment.given, ConstantVelocity):
            velocity = cycle.shown(segment.displacement / (stop - start) / share)
            segments.append(ConstantVelocity(f"{velocity}/s", time, name=name))
        elif isinstance(segment.given, Dwell):
            segments.append(Dwell(time, name=name))
        else:
            piece = next(piece for piece in reversed(cycle.pieces) if piece.start <= start)
            segments += [replace(move, name=name) for move in _moves(cycle, piece, segment, (start, stop), share)]
    return segments


def _moves(
    cycle: TimedCycle, piece: Piece, stretch: TimedSegment, times: tuple[float, float], share: float
) -> list[Move]:
    """The moves of a law in a stretch: one, or two where it ends where it begins."""
    (start, stop), moved = times, stretch.displacement
    if piece.stroke == moved and (piece.start, piece.stop) == (start, stop):
        return [Move(cycle.shown(moved), f"{(stop - start) * share!r} s", law=piece.law)]
    law = piece.law
    if not isinstance(law, PiecewiseLaw):
        raise InputError(f"{stretch.where} ends where it begins: give it to a Cycle of its own at the other speed")
    first, last = (_break(law, piece, time) for time in times)
    ends = [first, last]
    if abs(moved) <= CLOSURE * abs(piece.stroke):
        heights = [abs(float(law(place)) - float(law(law.breaks[first]))) for place in law.breaks[first : last + 1]]
        ends.insert(1, first + heights.index(max(heights)))
    moves, left = list[Move](), moved
    for low, high in pairwise(ends):
        way = left if high == last else piece.stroke * (float(law(law.breaks[high])) - float(law(law.breaks[low])))
        time = piece.duration * (law.breaks[high] - law.breaks[low]) * share
        moves.append(Move(cycle.shown(way), f"{time!r} s", law=section(law, low, high)))
        left -= way
    return moves


def _break(law: PiecewiseLaw, piece: Piece, time: float) -> int:
    """The number of the break at a joint."""
    away = [abs(piece.start + place * piece.duration - time) for place in law.breaks]
    return away.index(min(away))


def cam_segments(cycle: TimedCycle, period: Quantity, damping: float) -> list[CycleSegment]:
    """Every move corrected by the follower's frequency over its own duration.

    Raises
    ------
    InputError
        If a move is not from rest to rest by a law whose jerk is continuous and 0 at both ends.
    """
    natural = positive_quantity(period, "time", "follower: period")
    segments: list[CycleSegment] = []
    for segment, given, piece in cycle.by_segment("the cam of an elastic follower is made move by move"):
        time = f"{piece.duration!r} s"
        if piece.stroke == 0.0:
            segments.append(Dwell(time, name=given.label))
            continue
        try:
            law = polydyne(piece.law, TURN * piece.duration / natural, damping)
        except InputError as error:
            raise InputError(f"{segment.where}: {error}") from None
        segments.append(Move(cycle.shown(segment.displacement), time, law=law, name=given.label))
    return segments
