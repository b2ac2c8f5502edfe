"""An axis whose segments may take other durations: instants and passes as sums of them, for linear programs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any, Literal

import numpy as np

from optlaws.cycles.greatest_speed.fastest_search import FastestSearch
from optlaws.cycles.greatest_speed.timed_spans import slower
from optlaws.cycles.optimisation.motion_limits import word_of
from optlaws.cycles.optimisation.optimal import solve
from optlaws.cycles.specification.joints import LawSpan
from optlaws.cycles.specification.programme import TimedSegment, is_optimal
from optlaws.cycles.specification.segments import Dwell, Move
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure, located
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.motion.piece import named_law
from optlaws.motion.quantities import either
from optlaws.numbers import Array
from optlaws.tolerances import INTERLOCK, PASS_WIDTH

#: a time as seconds and a share of the period
Spell = tuple[float, float]
#: how the moves of an axis find their laws and times
Way = Literal["fastest", "gentlest", "kept"]


@dataclass(frozen=True)
class PlannedSegment:
    """A segment with its law and between which durations it may be; positions in SI units."""

    name: str
    start: float
    stop: float
    law: MotionLaw | None
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

    @kept_property
    def stroke(self) -> float:
        """Between the least and the greatest position at joints."""
        return max(self.positions) - min(self.positions)

    @kept_property
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


@dataclass(frozen=True)
class OwnLaws:
    """An axis whose moves have laws of their own, each from rest to rest.

    Attributes
    ----------
    cycle, name
        A cycle and the name of its axis.
    way
        "fastest": moves with limits take the least time that these allow, others keep theirs. "gentlest": moves have
        the least acceleration, and take at least that time. "kept": they are as in the cycle.
    """

    cycle: Any
    name: str
    way: Way

    @property
    def follows_times(self) -> bool:
        """Whether a law is another one in another time, as limits let it."""
        return self.way == "gentlest" and any(self.cycle.limits_of_segments)

    def plan(self, first: int, count: int, times: Sequence[float] | None) -> AxisPlan:
        """The plan of the axis.

        Parameters
        ----------
        first, count
            Where its durations begin among how many unknowns.
        times
            Durations of all segments, in which laws are gentlest; without, they are the fastest.

        Raises
        ------
        InputError
            If a segment is no move from rest to rest and no dwell, or a limit is of the whole cycle.
        InfeasibleProblem
            If a law that is given keeps a limit in no time.
        """
        if self.way == "fastest" and (self._search.objective.shares or self._search.objective.loaded):
            raise InputError(
                f"axis {self.name}: a limit of its whole cycle cannot be kept while the period is sought: leave out "
                "that of the energy, of a root mean square or of a load, and look at what the result has"
            )
        position, segments = self.cycle.programme.start, []
        for i, stretch in enumerate(self._stretches):
            if not isinstance(stretch.given, Move | Dwell):
                raise self._refused(stretch)
            stop, label = position + stretch.displacement, stretch.given.name or f"segment {stretch.number}"
            if isinstance(stretch.given, Dwell) or stretch.displacement == 0.0:
                least, most = _spell_of_dwell(stretch, f"axis {self.name}: {stretch.where}")
                segments.append(PlannedSegment(label, position, stop, None, least, most, ""))
                continue
            with located(f"axis {self.name}"):
                law, shortest, limit = self._of_move(i, stretch, times)
            if max(abs(law.b(0.0)), abs(law.b(1.0))) > INTERLOCK:
                raise self._refused(stretch)
            least, most = self._durations(i, stretch, shortest)
            segments.append(PlannedSegment(label, position, stop, law, least, most, limit))
            position = stop
        return AxisPlan(self.name, tuple(segments), first, count)

    @property
    def _stretches(self) -> tuple[TimedSegment, ...]:
        return self.cycle.programme.stretches  # type: ignore[no-any-return]

    @kept_property
    def _search(self) -> FastestSearch:
        objective = self.cycle._cycle_objective  # noqa: SLF001 - the cycle's own room
        if self.way == "gentlest":
            objective = replace(objective, minimise="acceleration")
        return FastestSearch(self.cycle.programme, objective, {})

    def _of_move(
        self, i: int, stretch: TimedSegment, times: Sequence[float] | None
    ) -> tuple[MotionLaw, float | None, str]:
        """The law of a move, its least time unless it keeps the one it has, and the limit that binds there."""
        if self.way == "kept":
            return self._as_it_is(i, stretch), None, ""
        search, span, law = self._search, self._search.alone(i), None
        if isinstance(stretch.given, Move) and not is_optimal(stretch.given):
            law = named_law(stretch.given.law, stretch.where)
        elif search.objective.of_load:
            raise self._refused(stretch)
        elif self.way == "gentlest" and times is not None:
            law = self._gentlest(slower(span, times[i] / span.duration))
        least = search.fastest(span) if law is None else search.of_law(span, law)
        if not least.limits:
            law = law or solve(span, search.objective, self.cycle.axis)[0].law
            return law, 0.0 if self.way == "gentlest" else None, ""
        limit = word_of(least.binding[0].key, self.cycle.axis)
        if least.law is None or not least.scale < inf:
            raise InfeasibleProblem(f"{stretch.where}: its law has no finite {limit}, and so keeps no limit of it")
        return least.law, least.needed, f"{limit} of axis {self.name}: {stretch.where}"

    def _as_it_is(self, i: int, stretch: TimedSegment) -> MotionLaw:
        """The law that a move has in the cycle."""
        start, duration = self.cycle.peaks[i].start, self.cycle.peaks[i].duration
        piece = next((piece for piece in self.cycle.pieces if piece.start == start), None)
        if piece is None or abs(piece.duration - duration) > INTERLOCK * duration:
            raise self._refused(stretch)
        return piece.law  # type: ignore[no-any-return]

    def _gentlest(self, span: LawSpan) -> MotionLaw | None:
        """The law of the least acceleration within the limits; None where its time is too short for these."""
        try:
            return solve(span, self._search.objective, self.cycle.axis)[0].law
        except (InfeasibleProblem, SolverFailure):
            return None

    def _durations(self, i: int, stretch: TimedSegment, shortest: float | None) -> tuple[Spell, Spell | None]:
        if shortest is not None:
            return (shortest, 0.0), None if self.way == "gentlest" else (shortest, 0.0)
        text = stretch.given.duration
        fixed = _spell(text, stretch.where) if isinstance(text, str) else (float(self.cycle.durations[i]), 0.0)
        return fixed, fixed

    def _refused(self, stretch: TimedSegment) -> InputError:
        return InputError(
            f"axis {self.name}: {stretch.where}: only moves from rest to rest and dwells are put together anew"
        )


def _spell_of_dwell(stretch: TimedSegment, where: str) -> tuple[Spell, Spell | None]:
    """The least duration of a dwell: its given or least allowed value, 0 where the duration is omitted."""
    given = stretch.given
    assert isinstance(given, Dwell)  # noqa: S101 - or a move by nothing, which has a duration as well
    text = given.duration if given.least is None else given.least
    if isinstance(text, list | tuple):
        text = text[0]
    return ((0.0, 0.0) if text is None else _spell(text, f"{where}: duration")), None


def _spell(text: Any, where: str) -> Spell:
    kind, value = either(text, ("angle", "time"), where)
    return (0.0, value / (2.0 * np.pi)) if kind == "angle" else (value, 0.0)
