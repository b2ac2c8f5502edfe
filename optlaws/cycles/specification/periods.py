"""When, in a cycle: angles of the master, times and free durations, and the least period that they leave."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Any, NamedTuple

from optlaws.cycles.specification.segments import CycleSegment
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.motion.quantities import TURN, either
from optlaws.numerics.roots import bisect
from optlaws.shown.summary import Row
from optlaws.tolerances import SAME_TIME


class Extent(NamedTuple):
    """A duration or an instant, or a bound of one: a share of the period and a time in seconds, one of which is 0."""

    share: float
    time: float

    def at(self, period: float) -> float:
        """The duration at a period, in seconds."""
        return self.share * period + self.time


class DurationRange(NamedTuple):
    """The least and the greatest duration of a segment, which are the same where it is given."""

    least: Extent
    most: Extent

    @property
    def fixed(self) -> bool:
        """Whether the duration is given."""
        return self.least == self.most

    @property
    def turns(self) -> bool:
        """Whether the range is an angle, which takes a fixed share of every period."""
        return self.fixed and self.least.time == 0.0


def duration_ranges(segments: Sequence[CycleSegment]) -> tuple[DurationRange, ...]:
    """Ranges of the durations; a single free duration turns with the master if all others do.

    >>> from optlaws import Dwell, Return, Rise
    >>> [given.least.share for given in duration_ranges([Rise("35 mm", "90 deg"), Dwell("180 deg"), Return()])]
    [0.25, 0.5, 0.25]
    """
    ranges = [duration_range(segment.duration) for segment in segments]
    free = [i for i, given in enumerate(ranges) if not given.fixed]
    if len(free) == 1 and all(given.turns for i, given in enumerate(ranges) if i != free[0]):
        left = Extent(1.0 - sum(given.least.share for i, given in enumerate(ranges) if i != free[0]), 0.0)
        ranges[free[0]] = DurationRange(left, left)
    return tuple(ranges)


def duration_range(duration: Any, name: str = "duration") -> DurationRange:
    """The range of a duration as a person gives it: one, two between which it is free, or None."""
    if duration is None:
        return DurationRange(Extent(0.0, 0.0), Extent(inf, 0.0))
    least, most = duration if isinstance(duration, list | tuple) else (duration, duration)
    return DurationRange(extent(least, name), extent(most, name))


def extent(value: Any, name: str = "duration") -> Extent:
    """A duration or an instant as a person gives it, an angle of the master or a time; errors call it `name`."""
    kind, number = either(value, ("angle", "time"), name)
    return Extent(number / TURN, 0.0) if kind == "angle" else Extent(0.0, number)


def least_period(ranges: Sequence[DurationRange], needed: Sequence[float]) -> float:
    """The least period that accommodates the least times of the free segments; 0 if all segments are angles.

    Raises
    ------
    InputError
        If the durations leave nothing free, or nothing stops a free dwell from vanishing.
    """
    if all(given.turns for given in ranges):
        return 0.0
    if all(given.fixed for given in ranges):
        raise InputError(
            "the durations are given and one of them is a time, so that the period is what they sum to: leave the "
            "duration of a segment out, or give angles, which turn with the master"
        )
    period = 0.0
    for _ in range(len(ranges) + 1):
        parts = [_binding(given, time, period) for given, time in zip(ranges, needed, strict=True)]
        turning, staying = sum(part.share for part in parts), sum(part.time for part in parts)
        if turning >= 1.0:
            raise InfeasibleProblem(
                "the angles of the segments leave the others no time at any speed: shorten an angle or a least duration"
            )
        following = staying / (1.0 - turning)
        if following <= period * (1.0 + SAME_TIME):
            break
        period = following
    return period


def _binding(given: DurationRange, needed: float, period: float) -> Extent:
    """The least share of a period that a segment needs."""
    if given.fixed or given.least.at(period) > needed:
        return given.least
    return Extent(0.0, needed)


def durations_at(ranges: Sequence[DurationRange], needed: Sequence[float], period: float) -> tuple[float, ...]:
    """The durations at a period: free motions share the remaining time in proportion to their least times.

    >>> free = DurationRange(Extent(0.0, 0.0), Extent(inf, 0.0))
    >>> durations_at([free, DurationRange(Extent(0.25, 0.0), Extent(0.25, 0.0)), free], [0.1, 0.0, 0.2], 1.0)
    (0.25, 0.25, 0.5)
    """
    free = [i for i, given in enumerate(ranges) if not given.fixed]
    left = period - sum(given.least.at(period) for given in ranges if given.fixed)
    sizes = {i: needed[i] or (1.0 if len(free) == 1 else 0.0) for i in free}

    def at(factor: float) -> dict[int, float]:
        return {i: min(max(factor * sizes[i], ranges[i].least.at(period)), _most(ranges[i], period)) for i in free}

    total = sum(sizes.values())
    shared = at(left / total) if total else {}
    if abs(sum(shared.values()) - left) > SAME_TIME * period:
        high = 2.0 * left / min(size for size in sizes.values() if size)
        shared = at(0.5 * sum(bisect(lambda factor: sum(at(factor).values()) < left, 0.0, high)))
    return tuple(shared.get(i, given.least.at(period)) for i, given in enumerate(ranges))


def _most(given: DurationRange, period: float) -> float:
    return inf if given.most.share == inf else given.most.at(period)


def best_possible_row(best: float | None, least: float, laws: str = "of any degree") -> Row:
    """What is known of the time of all laws, beside the least time of those of a space.

    >>> best_possible_row(None, 0.2).text(), best_possible_row(0.2, 0.21).note
    ('not known', 'no law of any degree takes less; the least time is 5 % above it')
    """
    if best is None:
        return Row("best possible", "not known", note=f"for laws {laws}")
    above = 100.0 * max(least / best - 1.0, 0.0)
    return Row("best possible", best, "s", note=f"no law {laws} takes less; the least time is {above:.2g} % above it")
