"""The timing diagram from which axes whose least period is sought begin: what has no duration gets one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

from optlaws.cycles.axes.planned_axes import planned
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.periods import Extent, duration_range
from optlaws.cycles.specification.segments import CycleSegment, Dwell
from optlaws.errors import InfeasibleProblem, InputError, located
from optlaws.motion.quantities import Exact
from optlaws.tolerances import CLOSURE

_Segments: TypeAlias = Sequence[CycleSegment]

_ROOM = 2.0  # of the period beside the one that the slowest axis needs by itself


def first_diagram(
    axes: Mapping[str, _Segments], cycle_of: Callable[[str, _Segments, Exact], Cycle], period: float | None
) -> tuple[dict[str, _Segments], float]:
    """The segments of axes, each with a duration, and the period: the given one, or a longer one where that is short.

    A move without a duration takes its least time within its limits; dwells share what is left, and a dwell that is
    longer than its duration keeps this as its least one.

    Raises
    ------
    InputError
        If a move has neither a duration nor limits, or all durations are angles, and no period is given.
    InfeasibleProblem
        If the angles of an axis leave its other segments no time.
    """
    timed = dict[str, _Timed]()
    for name, segments in axes.items():
        with located(f"axis {name}"):
            timed[name] = _Timed.of(name, segments, cycle_of, period)
    longest = max(each.period for each in timed.values())
    if period is None and longest == 0.0:
        raise InputError(
            "all durations are angles, which leave the period open: leave out those of moves with limits, give times "
            'such as "0.2 s", or a speed such as "45 rpm"'
        )
    if period is None or period < longest * (1.0 + CLOSURE):
        period = _ROOM * longest
    return {name: each.at(period) for name, each in timed.items()}, period


@dataclass(frozen=True)
class _Timed:
    """The segments of an axis with the least duration of each segment, and whether it may be longer in the diagram."""

    segments: _Segments
    least: Sequence[Extent]
    longer: Sequence[bool]

    @classmethod
    def of(
        cls,
        name: str,
        segments: _Segments,
        cycle_of: Callable[[str, _Segments, Exact], Cycle],
        period: float | None,
    ) -> _Timed:
        ranges = [duration_range(each.duration) for each in segments]
        free = [not each.fixed for each in ranges]
        least = [_least(each, given.least) for each, given in zip(segments, ranges, strict=True)]
        sought = [i for i, each in enumerate(segments) if free[i] and not isinstance(each, Dwell)]
        if sought:
            known = _Timed(segments, least, free)
            trial = period if period is not None and period > known.period else _ROOM * known.period or 1.0
            plan = planned(name, cycle_of(name, known.at(trial), Exact(trial, "s")), "fastest", None)
            for i in sought:
                if period is None and not plan[i].binds:
                    raise InputError(
                        f"segment {i + 1} ({segments[i].label}): nothing bounds its time: give it a duration, or "
                        'limits, such as limits = { acceleration = "20 m/s^2" }, or all axes either a speed such as '
                        '"200 rpm" or a period such as "0.3 s"'
                    )
                least[i] = max(least[i], plan[i].least, key=lambda extent: extent.at(trial))
        dwells = [isinstance(each, Dwell) for each in segments]
        waits = [dwell and some for dwell, some in zip(dwells, free, strict=True)]
        return cls(segments, least, next((places for places in (waits, free, dwells) if any(places)), free))

    @property
    def period(self) -> float:
        """The least period of the axis by itself."""
        shares, seconds = (sum(each) for each in zip(*self.least, strict=True))
        if shares >= 1.0 and seconds > 0.0:
            raise InfeasibleProblem("the angles of its segments leave the others no time: shorten one of them")
        return seconds / (1.0 - shares) if seconds else 0.0

    def at(self, period: float) -> _Segments:
        """The segments in a period, of which those that may be longer share what is left in equal parts."""
        part = (period - sum(each.at(period) for each in self.least)) / max(sum(self.longer), 1)
        segments: list[Any] = list(self.segments)
        for i, (segment, least, longer) in enumerate(zip(segments, self.least, self.longer, strict=True)):
            if longer or segment.duration is None:
                known = {"least": segment.least or segment.duration or "0 s"} if isinstance(segment, Dwell) else {}
                duration = Exact(least.at(period) + longer * part, "s")
                segments[i] = replace(segment, duration=duration, **known)
        return tuple(segments)


def _least(segment: CycleSegment, given: Extent) -> Extent:
    if segment.duration is None and isinstance(segment, Dwell) and segment.least is not None:
        return duration_range(segment.least).least
    return given
