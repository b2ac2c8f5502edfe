"""The kinematics of a cycle: values over time, extremes in every segment, jumps at every joint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from optlaws.cycles.specification.programme import Programme, TimedSegment
from optlaws.cycles.specification.segments import Free, Move
from optlaws.motion.piece import Piece, values_of_pieces
from optlaws.numbers import Array
from optlaws.numerics.tolerances import JUMP

Place = tuple[float, float]


@dataclass(frozen=True)
class SegmentPeaks:
    """Least and greatest position, velocity, acceleration and jerk in a segment, each with its time; SI units."""

    name: str
    start: float
    duration: float
    extremes: tuple[tuple[tuple[float, float], tuple[float, float]], ...]

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu."""
        return max(abs(value) for value, _ in self.extremes[nu])


def values_at(programme: Programme, pieces: Sequence[Piece], times: Array, nu: int) -> Array:
    """The derivative of order nu at times, of a cycle that repeats."""
    turns = np.floor(times / programme.period)
    within = np.clip(times - turns * programme.period, 0.0, programme.period)
    values = values_of_pieces(pieces, within, nu)
    return values + turns * sum(stretch.displacement for stretch in programme.stretches) if nu == 0 else values


def segment_peaks(programme: Programme, starts: Sequence[float], pieces: Sequence[Piece]) -> tuple[SegmentPeaks, ...]:
    """Least and greatest values in every segment; `starts` are the times of all joints, the last end among them."""
    return tuple(
        SegmentPeaks(stretch.given.label, start, stop - start, _extremes(stretch, pieces, start, stop))
        for stretch, (start, stop) in zip(programme.stretches, pairwise(starts), strict=True)
    )


def jumps_at_joints(
    starts: Sequence[float], pieces: Sequence[Piece], peaks: Sequence[float]
) -> tuple[dict[str, Any], ...]:
    """Jumps of velocity, acceleration and jerk where each segment starts; 0 where they are but rounding."""
    joints = []
    for start in starts:
        sizes = [_jump(pieces, start, nu) for nu in (1, 2, 3)]
        jumps = [0.0 if abs(size) <= JUMP * peak else size for size, peak in zip(sizes, peaks, strict=True)]
        joints.append({"time": start, "velocity": jumps[0], "acceleration": jumps[1], "jerk": jumps[2]})
    return tuple(joints)


def _jump(pieces: Sequence[Piece], start: float, nu: int) -> float:
    """The jump of a derivative, between pieces or inside a law of several segments."""
    for i, piece in enumerate(pieces):
        if piece.start == start:
            return piece.end(nu, 0) - pieces[i - 1].end(nu, 1)
    return next(piece.leap(start, nu) for piece in pieces if piece.start < start < piece.stop)


def _extremes(
    stretch: TimedSegment, pieces: Sequence[Piece], start: float, stop: float
) -> tuple[tuple[Place, Place], ...]:
    piece = next(earlier for earlier in reversed(pieces) if earlier.start <= start)
    if isinstance(stretch.given, Move | Free):
        return tuple(piece.extremes(nu, start, stop) for nu in range(4))
    # straight: what its law has beside is rounding
    low, high = sorted((float(piece.values(np.array([time]), 0)[0]), time) for time in (start, stop))
    speed = (stretch.displacement / (stop - start), start)
    return (low, high), (speed, speed), ((0.0, start),) * 2, ((0.0, start),) * 2
