"""Moves of a fitted motion, with the sum of squares of their rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from optlaws.cycles.old_tables.curve_fit import CurveFit
from optlaws.cycles.old_tables.peak_intervals import PeakInterval
from optlaws.cycles.old_tables.standard import criterion

#: of the places where an end was looked for: about the farthest one
_AT_BOUND = 1e-3


@dataclass(frozen=True, eq=False)
class FittedMove:
    """A stretch of a motion between two turning points or ends.

    Attributes
    ----------
    start, stop, low, high
        Where it begins and ends, and the positions there.
    fits
        Splines that the rows do not exclude, the best one first; none where a standard law alone is fitted.
    name, nearest
        The standard law that the rows do not exclude, "" where they exclude all; the one that is nearest.
    peaks
        The intervals of velocity, acceleration and jerk.
    slopes
        The velocities of the lines beside it. Where these meet is a corner, a move without length.
    corners
        Whether the velocity jumps at its ends.
    """

    start: float
    stop: float
    low: float
    high: float
    fits: tuple[CurveFit, ...]
    name: str
    nearest: str
    peaks: tuple[PeakInterval, ...] = ()
    slopes: tuple[float, float] = (0.0, 0.0)
    corners: tuple[bool, bool] = (False, False)

    @property
    def is_corner(self) -> bool:
        """Whether it is the place alone at which two lines meet."""
        return self.start == self.stop

    @property
    def ends_at_bounds(self) -> list[float]:
        """Its ends that lie as far within the rests beside it as these were looked for."""
        ends = []
        for fit in self.fits[:1]:
            (before, after), near = fit.ends, [_AT_BOUND * (end.high - end.low) for end in fit.ends]
            ends += [fit.start] if self.start == fit.start <= before.low + near[0] and before.line else []
            ends += [fit.stop] if self.stop == fit.stop >= after.high - near[1] and after.line else []
        return ends

    def position_before(self, place: float) -> float:
        """The position at a place before it, on the line from which it starts."""
        return self.low + self.slopes[0] * (place - self.start)

    def position_behind(self, place: float) -> float:
        """The position at a place behind it, on the line in which it ends."""
        return self.high + self.slopes[1] * (place - self.stop)

    def moved(self, along: float, up: float) -> FittedMove:
        """The move, moved along the master and up."""
        fits = tuple(fit.moved(along, up) for fit in self.fits)
        start, stop = self.start + along, self.stop + along
        return replace(self, fits=fits, start=start, stop=stop, low=self.low + up, high=self.high + up)


class Parts(NamedTuple):
    """Moves, the sum of squares of their rows, the number of parameters, and places far off that are left out."""

    moves: list[FittedMove]
    squares: float
    free: int
    far: list[float]

    def criterion(self, rows: int) -> float:
        """Schwarz's criterion for these rows."""
        return criterion(self.squares, self.free, rows)

    @classmethod
    def joined(cls, parts: Sequence[Parts], free: int = 0) -> Parts:
        """Parts after each other, with further parameters."""
        moves, far = [move for part in parts for move in part.moves], [place for part in parts for place in part.far]
        return cls(moves, sum(part.squares for part in parts), free + sum(part.free for part in parts), far)


def is_at_corner(before: Parts, after: Parts) -> bool:
    """Whether the velocity jumps where a line between two moves begins or ends."""
    return any(move.corners[1] for move in before.moves[-1:]) or any(move.corners[0] for move in after.moves[:1])


def is_between_longer(before: Parts, after: Parts) -> bool:
    """Whether less is between two moves than each is long, so that it may be the middle of one motion."""
    if not before.moves or not after.moves:
        return False
    last, first = before.moves[-1], after.moves[0]
    return first.start - last.stop < min(last.stop - last.start, first.stop - first.start)
