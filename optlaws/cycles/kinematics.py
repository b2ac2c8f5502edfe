"""A cycle with its laws in their places: values over time, extremes in segments, jumps at joints, and other speeds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from optlaws.cycles.specification.programme import Programme, TimedSegment
from optlaws.cycles.specification.segments import ConstantVelocity, CycleSegment, Dwell, Free, Move
from optlaws.errors import InputError
from optlaws.laws.making.transform import section
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.mechanisms.polydyne_cam import polydyne
from optlaws.motion.piece import Piece, unit_of, values_of_pieces
from optlaws.motion.quantities import TURN, positive_quantity
from optlaws.numbers import Array, Quantity
from optlaws.tolerances import CLOSURE, JUMP, SAME_TIME

Place = tuple[float, float]


@dataclass(frozen=True)
class SegmentPeaks:
    """Least and greatest position, velocity, acceleration and jerk in a segment, each with its time; SI units."""

    name: str
    start: float
    duration: float
    extremes: tuple[tuple[Place, Place], ...]

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu."""
        return max(abs(value) for value, _ in self.extremes[nu])


@dataclass(frozen=True)
class TimedCycle:
    """A cycle as numbers, the times of its joints with the last end among them, and the laws in their places."""

    programme: Programme
    starts: Sequence[float]
    pieces: Sequence[Piece]

    def values(self, times: Array, nu: int) -> Array:
        """The derivative of order nu at times; the cycle repeats."""
        period = self.programme.period
        turns = np.floor(times / period)
        values = values_of_pieces(self.pieces, np.clip(times - turns * period, 0.0, period), nu)
        return values + turns * sum(stretch.displacement for stretch in self.programme.stretches) if nu == 0 else values

    @property
    def timed(self) -> Iterator[tuple[TimedSegment, float, float]]:
        """The segments, each with the times at which it begins and ends."""
        return zip(self.programme.stretches, self.starts, self.starts[1:], strict=False)

    def peaks(self) -> tuple[SegmentPeaks, ...]:
        """Least and greatest values in every segment."""
        return tuple(
            SegmentPeaks(stretch.given.label, start, stop - start, self._extremes(stretch, start, stop))
            for stretch, start, stop in self.timed
        )

    def _extremes(self, stretch: TimedSegment, start: float, stop: float) -> tuple[tuple[Place, Place], ...]:
        piece = self._piece_at(start)
        if isinstance(stretch.given, Move | Free):
            return tuple(piece.extremes(nu, start, stop) for nu in range(4))
        # straight: what its law has beside is rounding
        low, high = sorted((float(piece.values(np.array([time]), 0)[0]), time) for time in (start, stop))
        speed = (stretch.displacement / (stop - start), start)
        return (low, high), (speed, speed), ((0.0, start),) * 2, ((0.0, start),) * 2

    def _piece_at(self, time: float) -> Piece:
        return next(piece for piece in reversed(self.pieces) if piece.start <= time)

    def jumps(self, peaks: Sequence[float]) -> tuple[dict[str, Any], ...]:
        """Jumps of velocity, acceleration and jerk where each segment starts; 0 where rounding of their peaks."""
        joints = []
        for start in self.starts[:-1]:
            sizes = [self._jump(start, nu) for nu in (1, 2, 3)]
            jumps = [0.0 if abs(size) <= JUMP * peak else size for size, peak in zip(sizes, peaks, strict=True)]
            joints.append({"time": start, "velocity": jumps[0], "acceleration": jumps[1], "jerk": jumps[2]})
        return tuple(joints)

    def _jump(self, start: float, nu: int) -> float:
        """The jump of a derivative, between pieces or inside a law of several segments."""
        for i, piece in enumerate(self.pieces):
            if piece.start == start:
                return piece.end(nu, 0) - self.pieces[i - 1].end(nu, 1)
        return next(piece.jump(start, nu) for piece in self.pieces if piece.start < start < piece.stop)

    def at_speed(self, share: float) -> list[CycleSegment]:
        """The segments at another speed: unchanged laws, durations multiplied by `share`, joint laws in parts."""
        segments: list[CycleSegment] = []
        for segment, start, stop in self.timed:
            time, name = f"{(stop - start) * share!r} s", segment.given.label
            if isinstance(segment.given, ConstantVelocity):
                velocity = self._shown(segment.displacement / (stop - start) / share)
                segments.append(ConstantVelocity(f"{velocity}/s", time, name=name))
            elif isinstance(segment.given, Dwell):
                segments.append(Dwell(time, name=name))
            else:
                segments += [replace(move, name=name) for move in self._moves(segment, (start, stop), share)]
        return segments

    def _shown(self, displacement: float) -> str:
        return f"{displacement!r} {unit_of(self.programme.axis)}"

    def _moves(self, stretch: TimedSegment, times: tuple[float, float], share: float) -> list[Move]:
        """The moves of a law in a stretch: one move, or two where the stretch ends at its starting position."""
        (start, stop), moved, piece = times, stretch.displacement, self._piece_at(times[0])
        same_time = SAME_TIME * self.programme.period
        alone = abs(piece.start - start) <= same_time and abs(piece.stop - stop) <= same_time
        if alone and abs(piece.stroke - moved) <= CLOSURE * abs(moved):
            return [Move(self._shown(moved), f"{(stop - start) * share!r} s", law=piece.law)]
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
            moves.append(Move(self._shown(way), f"{time!r} s", law=section(law, low, high)))
            left -= way
        return moves

    def of_cam(self, period: Quantity, damping: float) -> list[CycleSegment]:
        """The segments of the cam of an elastic follower: every move corrected by its frequency over its duration."""
        natural = positive_quantity(period, "time", "follower: period")
        if len(self.pieces) != len(self.programme.stretches):
            raise InputError(
                "the cam of an elastic follower is computed move by move: use moves in place of adjacent free motions"
            )
        segments: list[CycleSegment] = []
        for segment, piece in zip(self.programme.stretches, self.pieces, strict=True):
            time, name = f"{piece.duration!r} s", segment.given.label
            if piece.stroke == 0.0:
                segments.append(Dwell(time, name=name))
                continue
            try:
                law = polydyne(piece.law, TURN * piece.duration / natural, damping)
            except InputError as error:
                raise InputError(f"{segment.where}: {error}") from None
            segments.append(Move(self._shown(segment.displacement), time, law=law, name=name))
        return segments


def _break(law: PiecewiseLaw, piece: Piece, time: float) -> int:
    """The number of the break at a joint."""
    away = [abs(piece.start + place * piece.duration - time) for place in law.breaks]
    return away.index(min(away))
