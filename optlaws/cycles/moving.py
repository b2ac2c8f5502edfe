"""How a cycle moves: values over time, least and greatest values in every segment, leaps at every joint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.cycles.asked.conversion import Piece
from optlaws.cycles.asked.programme import Programme, Stretch
from optlaws.cycles.asked.segments import Free, Move

Array = NDArray[np.float64]
Place = tuple[float, float]

JOINED = 1e-9  # a leap below this share of the derivative's greatest value is rounding


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


def values_at(asked: Programme, pieces: Sequence[Piece], times: Array, nu: int) -> Array:
    """The derivative of order nu at times, of a cycle that repeats."""
    turns = np.floor(times / asked.period)
    within = np.clip(times - turns * asked.period, 0.0, asked.period)
    starts = np.array([piece.start for piece in pieces])
    which = np.maximum(np.searchsorted(starts, within, side="right") - 1, 0)
    values = np.empty(times.shape)
    for i, piece in enumerate(pieces):
        here = which == i
        values[here] = piece.values(within[here], nu)
    return values + turns * sum(stretch.displacement for stretch in asked.stretches) if nu == 0 else values


def segment_peaks(asked: Programme, starts: Sequence[float], pieces: Sequence[Piece]) -> tuple[SegmentPeaks, ...]:
    """Least and greatest values in every segment; `starts` are the times of all joints, the last end among them."""
    return tuple(
        SegmentPeaks(stretch.given.label, start, stop - start, _extremes(stretch, pieces, start, stop))
        for stretch, (start, stop) in zip(asked.stretches, pairwise(starts), strict=True)
    )


def leaps(starts: Sequence[float], pieces: Sequence[Piece], peaks: Sequence[float]) -> tuple[dict[str, Any], ...]:
    """By how much velocity, acceleration and jerk leap where each segment starts; 0 where that is but rounding."""
    leaps_there = []
    for start in starts:
        sizes = [_leap(pieces, start, nu) for nu in (1, 2, 3)]
        kept = [0.0 if abs(size) <= JOINED * peak else size for size, peak in zip(sizes, peaks, strict=True)]
        leaps_there.append({"time": start, "velocity": kept[0], "acceleration": kept[1], "jerk": kept[2]})
    return tuple(leaps_there)


def _leap(pieces: Sequence[Piece], start: float, nu: int) -> float:
    """Of a derivative: between pieces, or inside one of several segments."""
    for i, piece in enumerate(pieces):
        if piece.start == start:
            return piece.end(nu, 0) - pieces[i - 1].end(nu, 1)
    return next(piece.leap(start, nu) for piece in pieces if piece.start < start < piece.stop)


def _extremes(stretch: Stretch, pieces: Sequence[Piece], start: float, stop: float) -> tuple[tuple[Place, Place], ...]:
    piece = next(earlier for earlier in reversed(pieces) if earlier.start <= start)
    if isinstance(stretch.given, Move | Free):
        return tuple(piece.extremes(nu, start, stop) for nu in range(4))
    # straight: what its law has beside is rounding
    low, high = sorted((float(piece.values(np.array([time]), 0)[0]), time) for time in (start, stop))
    speed = (stretch.displacement / (stop - start), start)
    return (low, high), (speed, speed), ((0.0, start),) * 2, ((0.0, start),) * 2
