"""Segments of an axis whose durations are sought: their laws, and between which durations these may be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import inf, sqrt
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.greatest_speed.fastest_search import FastestSearch
from optlaws.cycles.greatest_speed.timed_spans import slower
from optlaws.cycles.optimisation.optimal import solve
from optlaws.cycles.specification.limits import word_of
from optlaws.cycles.specification.periods import Extent, extent
from optlaws.cycles.specification.programme import TimedSegment, is_optimal
from optlaws.cycles.specification.segments import Dwell, Move
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure, located
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.motion.piece import moves_at, named_law
from optlaws.numbers import Array
from optlaws.numerics.roots import bracketed_roots
from optlaws.sentences import listed
from optlaws.tolerances import INTERLOCK

#: how the moves of an axis find their laws and times
Way = Literal["fastest", "least acceleration", "kept"]
NOTHING = Extent(0.0, 0.0)
#: how names of what binds begin where it is a dwell
DWELL = "dwell "


@dataclass(frozen=True)
class PlannedSegment:
    """A segment with its law and between which durations it may be; positions in SI units.

    `binds` names what its least duration is by, and `effort` is that at the pace 1, 0 where it does not change with it.
    """

    start: float
    stop: float
    law: MotionLaw | None = None
    least: Extent = NOTHING
    most: Extent | None = None
    binds: str = ""
    effort: float = 0.0
    _found: dict[bytes, Array] = field(default_factory=dict, init=False, repr=False, compare=False)

    def shares(self, positions: Array) -> Array:
        """After which shares of its duration it is at positions; 0 or 1 where they are beyond its ends."""
        if (known := self._found.get(positions.tobytes())) is not None:
            return known
        heights = np.clip((positions - self.start) / (self.stop - self.start), 0.0, 1.0)
        inside = (heights > 0.0) & (heights < 1.0)
        shares, of = heights.copy(), heights[inside]
        if self.law is not None and of.size:
            law, ends = self.law, (np.zeros(of.size), np.ones(of.size))
            shares[inside] = bracketed_roots(lambda k: law.a(k) - of, ends, (-of, 1.0 - of))
        self._found[positions.tobytes()] = shares
        return shares

    def positions(self, shares: Array) -> Array:
        """The positions after shares of its duration."""
        way = 0.0 if self.law is None else (self.stop - self.start) * self.law.a(shares)
        return np.full(shares.shape, self.start) + way


@dataclass(frozen=True, eq=False)
class AxisPlan:
    """The segments of an axis, and the indices of their durations among the unknowns of a program.

    The last two unknowns are the period and the pace, to which the durations of some moves are in proportion.
    """

    name: str
    segments: Sequence[PlannedSegment]
    first: int
    count: int

    @kept_property
    def positions(self) -> list[float]:
        """Positions at the joints, both ends included."""
        return [*(segment.start for segment in self.segments), self.segments[-1].stop]

    @kept_property
    def _slack(self) -> float:
        return INTERLOCK * (max(self.positions) - min(self.positions))

    def events(self, segment: int, shares: Array) -> Array:
        """The times after shares of a segment as rows over the unknowns."""
        rows = np.zeros((len(shares), self.count))
        rows[:, self.first : self.first + segment] = 1.0
        rows[:, self.first + segment] = shares
        return rows

    def beyond(self, joint: int, levels: Array, sign: float) -> NDArray[np.bool_]:
        """Whether a joint is above levels, or below them where the sign is -1; what touches them is."""
        return np.asarray(sign * (self.positions[joint] - levels) >= -self._slack)

    def leaves(self, joint: int, levels: Array, sign: float, way: int) -> Array:
        """When the axis leaves levels, before or after a joint at which it is beyond them; NaN where it does not."""
        rows, left = np.full((len(levels), self.count), np.nan), np.ones(len(levels), dtype=bool)
        for i in range(joint - 1, -1, -1) if way < 0 else range(joint, len(self.segments)):
            here = left & ~self.beyond(i if way < 0 else i + 1, levels, sign)
            if here.any():
                rows[here] = self.events(i, self.segments[i].shares(levels[here]))
                left &= ~here
        return rows


def planned(name: str, cycle: Cycle, way: Way, times: Sequence[float] | None) -> list[PlannedSegment]:
    """The segments of an axis, whose moves have laws of their own, each from rest to rest.

    "fastest": moves with limits take the least time that these allow, others keep theirs. "least acceleration": they
    have the least acceleration in the times of all segments, or are the fastest without such, and may take longer.
    "kept": they are as in the cycle.

    Raises
    ------
    InputError
        If a segment is no move from rest to rest and no dwell, or a limit is of the whole cycle.
    InfeasibleProblem
        If a law that is given keeps a limit in no time.
    """
    with located(f"axis {name}"):
        objective = cycle.specification.in_si
        if way == "least acceleration":
            objective = replace(objective, minimise="acceleration")
        if way == "fastest" and (objective.shares or objective.loaded):
            raise InputError(
                "a limit of its whole cycle cannot be kept while the period is sought: leave out that of the energy, "
                "of a root mean square or of a load, and look at what the result has"
            )
        search, offsets = FastestSearch(cycle.programme, objective, {}), cycle.programme.offsets
        segments = list[PlannedSegment]()
        for i, stretch in enumerate(cycle.programme.stretches):
            given = stretch.given
            if not isinstance(given, Move | Dwell):
                raise _refused(stretch)
            segment = PlannedSegment(offsets[i], offsets[i + 1])
            if isinstance(given, Dwell) or stretch.displacement == 0.0:
                # as given or allowed, of two the first; nothing where none is
                least: Any = getattr(given, "least", None) or given.duration or "0 s"
                lasts = extent(least[0] if isinstance(least, tuple) else least)
                label = f"{DWELL}{given.name or f'segment {stretch.number}'} of {name}"
                segments.append(replace(segment, least=lasts, binds=label if lasts != NOTHING else ""))
                continue
            segment = _of_move(segment, i, cycle, way, search, times)
            if segment.binds:
                segment = replace(segment, binds=f"{segment.binds} of axis {name}: {stretch.where}")
            law: Any = segment.law
            if moves_at(law, 0, 1):
                raise _refused(stretch)
            if way == "least acceleration":
                # limits bind the laws in the times that are sought
                share = law.peak(2).value * abs(stretch.displacement) / cycle.specification.unchecked().peak(2)
                segment = replace(segment, effort=sqrt(share))
            segments.append(segment)
        return segments


def _of_move(
    segment: PlannedSegment, i: int, cycle: Cycle, way: Way, search: FastestSearch, times: Sequence[float] | None
) -> PlannedSegment:
    """A move with its law, between which durations it may be, and the limit that binds where it is shortest."""
    stretch, law = cycle.programme.stretches[i], None
    if way == "kept":
        fixed, placed, piece = _given(cycle, i), cycle.peaks[i], cycle.peaks[i].piece
        if piece.start != placed.start or abs(piece.duration - placed.duration) > INTERLOCK * placed.duration:
            raise _refused(stretch)
        return replace(segment, law=piece.law, least=fixed, most=fixed)
    span = search.alone(i)
    if isinstance(stretch.given, Move) and not is_optimal(stretch.given):
        law = named_law(stretch.given.law, stretch.where)
    elif search.objective.of_load:
        raise _refused(stretch)
    elif way == "least acceleration" and times is not None:
        try:
            law = solve(slower(span, times[i] / span.duration), search.objective)[0].law
        except (InfeasibleProblem, SolverFailure):
            law = None  # the time is too short for the limits
    known = search.fastest(span) if law is None else search.of_law(span, law)
    if not known.along:
        law = law or solve(span, search.objective)[0].law
        fixed = NOTHING if way == "least acceleration" else _given(cycle, i)
        return replace(segment, law=law, least=fixed, most=None if way == "least acceleration" else fixed)
    limits = list(dict.fromkeys(word_of(limit.key, cycle.axis) for limit in known.binding))
    if known.law is None or not known.scale < inf:
        raise InfeasibleProblem(f"{stretch.where}: its law has no finite {limits[0]}, and so keeps no limit of it")
    least = Extent(0.0, known.needed)
    return replace(
        segment,
        law=known.law,
        least=least,
        most=None if way == "least acceleration" else least,
        binds=listed(limits),
    )


def _given(cycle: Cycle, i: int) -> Extent:
    """The duration that a move keeps: an angle of the master, or a time."""
    text = cycle.segments[i].duration
    return extent(text) if isinstance(text, str) else Extent(0.0, float(cycle.durations[i]))


def _refused(stretch: TimedSegment) -> InputError:
    return InputError(f"{stretch.where}: only moves from rest to rest and dwells are put together anew")
