"""An axis whose segments may take other durations: instants and passes as sums of them, for linear programs."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

from optlaws.cycles.optimisation.motion_limits import LimitKey, limits_of_segment, read_limits, word_of
from optlaws.cycles.specification.programme import TimedSegment
from optlaws.cycles.specification.segments import Dwell, Move
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.laws import MotionLaw
from optlaws.motion.quantities import either
from optlaws.numbers import Array
from optlaws.synthesis.functionals.makers import peak
from optlaws.tolerances import INTERLOCK, PASS_WIDTH

#: a time as seconds and a share of the period
Spell = tuple[float, float]


@dataclass(frozen=True)
class PlannedSegment:
    """A segment with its law and between which durations it may be; positions in SI units."""

    name: str
    start: float
    stop: float
    law: MotionLaw | None
    duration: float
    least: Spell
    most: Spell | None
    limit: str

    @property
    def moves(self) -> bool:
        """Whether the segment moves its axis."""
        return self.law is not None

    @property
    def acceleration(self) -> float:
        """The greatest acceleration times the square of the duration."""
        return 0.0 if self.law is None else float(self.law.peak(2).value) * abs(self.stop - self.start)

    def share(self, position: float) -> float:
        """After which share of its duration the segment is at a position; 0 or 1 where that is beyond its ends."""
        from scipy.optimize import brentq

        assert self.law is not None  # noqa: S101 - of moves alone
        law, height = self.law, (position - self.start) / (self.stop - self.start)
        if not 0.0 < height < 1.0:
            return 0.0 if height <= 0.0 else 1.0
        return float(brentq(lambda k: float(law.a(k)) - height, 0.0, 1.0, xtol=PASS_WIDTH))

    def position(self, share: float) -> float:
        """The position after a share of its duration."""
        if self.law is None:
            return self.start
        return self.start + (self.stop - self.start) * float(self.law.a(share))


@dataclass(frozen=True)
class AxisPlan:
    """The segments of an axis, and the indices of their durations among the unknowns of a program.

    The last two unknowns are the period and the pace, to which the durations of some moves are in proportion.
    """

    name: str
    segments: tuple[PlannedSegment, ...]
    first: int
    count: int

    @property
    def stroke(self) -> float:
        """Between the least and the greatest position at joints."""
        return max(self.positions) - min(self.positions)

    @property
    def positions(self) -> list[float]:
        """Positions at the joints, both ends included."""
        return [*(segment.start for segment in self.segments), self.segments[-1].stop]

    def instant(self, joint: int) -> Array:
        """The time of a joint as a row over the unknowns."""
        row = np.zeros(self.count)
        row[self.first : self.first + joint] = 1.0
        return row

    def event(self, segment: int, share: float) -> Array:
        """The time after a share of a segment as a row over the unknowns."""
        row = self.instant(segment)
        row[self.first + segment] = share
        return row

    def beyond(self, joint: int, level: float, sign: float) -> bool:
        """Whether a joint is above a level, or below it where the sign is -1; what touches it is."""
        return sign * (self.positions[joint] - level) >= -INTERLOCK * self.stroke

    def window(self, joint: int, level: float, sign: float) -> tuple[Array | None, Array | None]:
        """Times around a joint between which the axis stays beyond a level; None for an end up to which it does."""
        return self._edge(joint, level, sign, -1), self._edge(joint, level, sign, 1)

    def _edge(self, joint: int, level: float, sign: float, way: int) -> Array | None:
        ends = range(joint - 1, -1, -1) if way < 0 else range(joint, len(self.segments))
        for i in ends:
            if not self.beyond(i if way < 0 else i + 1, level, sign):
                return self.event(i, self.segments[i].share(level))
        return None


def plan_of(cycle: Any, name: str, first: int, count: int, goal: str, *, longer: bool) -> AxisPlan:  # noqa: ANN401
    """The plan of a cycle of moves and dwells.

    Parameters
    ----------
    cycle, name
        A cycle and the name of its axis.
    first, count
        Where its durations begin among how many unknowns.
    goal
        "period": moves with limits take the least time that these allow. "acceleration": all keep their times.
    longer
        Of an acceleration: whether moves of this axis may take longer times.
    """
    pieces = {piece.start: piece for piece in cycle.pieces}
    position, segments = cycle.programme.start, []
    for stretch, peaks in zip(cycle.programme.stretches, cycle.peaks, strict=True):
        piece = pieces.get(peaks.start)
        where = f"axis {name}: {stretch.where}"
        if not isinstance(stretch.given, Move | Dwell) or piece is None or abs(piece.duration - peaks.duration) > (
            INTERLOCK * peaks.duration
        ):  # fmt: skip
            raise InputError(f"{where}: only moves from rest to rest and dwells are put together anew")
        law = None if isinstance(stretch.given, Dwell) or stretch.displacement == 0.0 else piece.law
        stop = position + stretch.displacement
        limit = ""
        if law is None:
            least, most = dwell_spell(stretch, where)
        else:
            if max(abs(law.b(0.0)), abs(law.b(1.0))) > INTERLOCK:
                raise InputError(f"{where}: only moves from rest to rest and dwells are put together anew")
            shortest, limit = _least_time(cycle, stretch, law, where) if goal == "period" or longer else (None, "")
            least, most = _durations(stretch, peaks.duration, shortest, longer=longer)
        label = stretch.given.name or f"segment {stretch.number}"
        segments.append(PlannedSegment(label, position, stop, law, peaks.duration, least, most, limit))
        position = stop
    return AxisPlan(name, tuple(segments), first, count)


def dwell_spell(stretch: TimedSegment, where: str) -> tuple[Spell, Spell | None]:
    """The least duration of a dwell: its given or least allowed value, 0 where the duration is omitted."""
    given = stretch.given
    assert isinstance(given, Dwell)  # noqa: S101 - or a move by nothing, which has a duration as well
    text = given.duration if given.least is None else given.least
    if isinstance(text, list | tuple):
        text = text[0]
    return ((0.0, 0.0) if text is None else _spell(text, f"{where}: duration")), None


def _durations(
    stretch: TimedSegment, duration: float, shortest: float | None, *, longer: bool
) -> tuple[Spell, Spell | None]:  # fmt: skip
    if longer:
        return (shortest or 0.0, 0.0), None
    if shortest is not None:
        return (shortest, 0.0), (shortest, 0.0)
    text = stretch.given.duration
    fixed = _spell(text, stretch.where) if isinstance(text, str) else (duration, 0.0)
    return fixed, fixed


def _spell(text: Any, where: str) -> Spell:  # noqa: ANN401 - a quantity
    kind, value = either(text, ("angle", "time"), where)
    return (0.0, value / (2.0 * np.pi)) if kind == "angle" else (value, 0.0)


def _least_time(cycle: Any, stretch: TimedSegment, law: MotionLaw, where: str) -> tuple[float | None, str]:  # noqa: ANN401
    """The least time of a move under the limits of its axis, and which binds; none where it has no limits."""
    limits = limits_of_segment(stretch, read_limits(cycle.limits, cycle.axis, "limits"), cycle.axis)
    times = []
    for key, most in limits.items():
        nu, name = (key if isinstance(key, int) else key.nu), word_of(key, cycle.axis)
        if nu > 0:
            greatest = _greatest(law, key, stretch.displacement)
            if not greatest < inf:
                raise InfeasibleProblem(f"{where}: its law has no finite {name}, and so keeps no limit of it")
            times.append(((greatest / most) ** (1.0 / nu), f"{name} of {where}"))
    return max(times, default=(None, ""))


def _greatest(law: MotionLaw, key: LimitKey, stroke: float) -> float:
    """The greatest value of a limited derivative, or of one side of it, over the stroke, for a duration of 1 s."""
    if isinstance(key, int):
        return float(law.peak(key).value) * abs(stroke)
    side = peak("abcj"[key.nu], side="high" if key.sign * stroke > 0.0 else "low")
    return float(side.value(law)) * abs(stroke)
