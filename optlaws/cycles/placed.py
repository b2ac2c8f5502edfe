"""Segments with their laws in their places: their extremes, the same at another speed, and the cam of a follower."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from optlaws.cycles.specification.programme import Programme, TimedSegment
from optlaws.cycles.specification.segments import ConstantVelocity, CycleSegment, Dwell, Free, Move
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.motion.piece import Piece, unit_of
from optlaws.motion.quantities import QUANTITIES, TURN, Exact, positive_quantity
from optlaws.numbers import Quantity
from optlaws.tolerances import CLOSURE, SAME_TIME

Place = tuple[float, float]


@dataclass(frozen=True)
class SegmentPeaks:
    """A segment in its place: its least and greatest position, velocity, acceleration and jerk; SI units.

    Attributes
    ----------
    stretch
        The segment in numbers.
    piece
        Its law in its place, which may be that of its neighbours too.
    start, stop
        When it begins and ends.
    """

    stretch: TimedSegment
    piece: Piece
    start: float
    stop: float

    @property
    def name(self) -> str:
        """The name of the segment, or of its kind."""
        return self.stretch.given.label

    @property
    def duration(self) -> float:
        """How long it takes."""
        return self.stop - self.start

    @property
    def moves(self) -> bool:
        """Whether it has a law; else it is straight."""
        return isinstance(self.stretch.given, Move | Free)

    @kept_property
    def extremes(self) -> tuple[tuple[Place, Place], ...]:
        """The least and the greatest value of the position and of its derivatives up to the jerk, with their times."""
        return tuple(map(self._ends, range(len(QUANTITIES))))

    def ends(self, nu: int) -> tuple[Place, Place]:
        """The least and the greatest value of a derivative over the whole of it, each with its time."""
        return self.extremes[nu] if nu < len(QUANTITIES) else self._ends(nu)

    def _ends(self, nu: int) -> tuple[Place, Place]:
        if self.moves or nu == 0:
            return self.piece.extremes(nu, self.start, self.stop)
        # straight: what its law has beside is rounding
        return ((self.stretch.displacement / self.duration if nu == 1 else 0.0, self.start),) * 2

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu."""
        return max(abs(value) for value, _ in self.ends(nu))


def segments_in_place(
    programme: Programme, starts: Sequence[float], pieces: Sequence[Piece]
) -> tuple[SegmentPeaks, ...]:
    """The segments whose laws are among the pieces."""
    placed = []
    for stretch, (start, stop) in zip(programme.stretches, pairwise(starts), strict=True):
        at = [piece for piece in pieces if piece.start <= start < piece.stop]
        placed += [SegmentPeaks(stretch, piece, start, stop) for piece in at[-1:]]
    return tuple(placed)


def retimed_segments(placed: Sequence[SegmentPeaks], axis: str, share: float) -> list[CycleSegment]:
    """The segments at another speed: unchanged laws, durations multiplied by `share`, joint laws in parts."""
    segments, same_time = list[CycleSegment](), SAME_TIME * placed[-1].stop
    for each in placed:
        time, moved = Exact(each.duration * share, "s"), each.stretch.displacement
        if isinstance(each.stretch.given, ConstantVelocity):
            velocity = Exact(moved / each.duration / share, f"{unit_of(axis)}/s")
            segments.append(ConstantVelocity(velocity, time, name=each.name))
        elif isinstance(each.stretch.given, Dwell):
            segments.append(Dwell(time, name=each.name))
        else:
            segments += [
                Move(Exact(way, unit_of(axis)), Exact(part * share, "s"), law=law, name=each.name)
                for way, part, law in _parts(each, same_time)
            ]
    return segments


def _parts(placed: SegmentPeaks, same_time: float) -> list[tuple[float, float, MotionLaw]]:
    """Stroke, time and law of a segment: of one move, or of two where it ends at its starting position."""
    moved, piece, law, times = placed.stretch.displacement, placed.piece, placed.piece.law, (placed.start, placed.stop)
    alone = abs(piece.start - placed.start) <= same_time and abs(piece.stop - placed.stop) <= same_time
    if alone and abs(piece.stroke - moved) <= CLOSURE * abs(moved):
        return [(moved, placed.duration, law)]
    if not isinstance(law, PiecewiseLaw):
        raise InputError(
            f"{placed.stretch.where} ends where it begins: give it to a Cycle of its own at the other speed"
        )
    from optlaws.laws.making.transform import section

    joints = [piece.start + place * piece.duration for place in law.breaks]
    first, last = (min(range(len(joints)), key=lambda i: abs(joints[i] - time)) for time in times)
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


def segments_of_cam(
    programme: Programme, pieces: Sequence[Piece], period: Quantity, damping: float
) -> list[CycleSegment]:
    """The segments of the cam of an elastic follower: every move corrected by its frequency over its duration."""
    from optlaws.mechanisms.machine.polydyne import polydyne

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
