"""A cycle as numbers: durations that sum, positions that close, velocities that meet; errors state the remedy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Any

from optlaws.cycles.specification.limits import AXES, Limits, Sides, read_limits, sides, tightest
from optlaws.cycles.specification.segments import (
    OPTIMAL,
    ConstantVelocity,
    CycleSegment,
    Dwell,
    Free,
    Move,
    Return,
    Rise,
)
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.motion.quantities import TURN, Kind, check_scale, either, in_small_units, positive_quantity, quantity
from optlaws.sentences import Amount, sentence
from optlaws.tolerances import CLOSURE, SAME_TIME


@dataclass(frozen=True)
class TimedSegment:
    """A segment in SI units: least and greatest duration, displacement and its own limits, and the user's segment."""

    number: int
    given: CycleSegment
    least: float
    most: float
    displacement: float
    limits: Limits = field(default_factory=dict, hash=False)

    @property
    def fixed(self) -> bool:
        """Whether the duration of the segment is one value."""
        return self.least == self.most

    @property
    def where(self) -> str:
        """The name that errors give it."""
        return f"segment {self.number} ({self.given.label})"

    def sides(self, of_cycle: Limits) -> Sides:
        """The limited sides of the segment: by its own limits and the cycle's, whichever are lower.

        Raises
        ------
        InputError
            If slowing down has a limit where the motion may turn back, or what ends where it begins must not turn back.
        """
        limits = tightest(of_cycle, self.limits)
        if isinstance(self.given, Free) and Kind.ACCELERATION_ALONG in limits:
            raise InputError(
                f"{self.where} may turn back, where speeding up and slowing down are of no one direction: give its "
                "acceleration as the least and the greatest, such as ('-8 m/s^2', '12 m/s^2'), in place of a "
                "deceleration"
            )
        if isinstance(self.given, Free) and Kind.VELOCITY_ALONG in limits and not self.displacement:
            raise InputError(
                f"{self.where} ends where it begins, so that it must turn back: give the limit of its velocity as "
                "one quantity, or as a least one below 0"
            )
        return sides(limits, -1.0 if self.displacement < 0.0 else 1.0)


@dataclass(frozen=True)
class Programme:
    """A cycle as numbers in SI units: its period, its stretches, and the position at its start."""

    period: float
    axis: str
    stretches: tuple[TimedSegment, ...]
    start: float

    @property
    def advance(self) -> float:
        """How far a cycle is beyond the one before."""
        return sum(stretch.displacement for stretch in self.stretches)


def period_of(speed: Any, period: Any) -> float:
    """Duration of a cycle in seconds, from the master's speed or given."""
    if (speed is None) == (period is None):
        raise InputError('a cycle has either a speed such as "200 rpm" or a period such as "0.3 s"')
    if speed is None:
        return positive_quantity(period, "time", "period")
    turn = TURN / positive_quantity(speed, "angular velocity", "speed")
    check_scale(turn, "s", "speed: a turn", speed)
    return turn


def axis_of(segments: Sequence[CycleSegment]) -> str:
    """Whether positions are lengths or angles, by the first that is given; lengths if none is."""
    for segment in segments:
        for value in (getattr(segment, "by", None), getattr(segment, "to", None)):
            if value is not None:
                return either(value, ("length", "angle"), f"{segment.label}: displacement")[0]
        if isinstance(segment, ConstantVelocity):
            kind = either(segment.velocity, ("velocity", "angular velocity"), f"{segment.label}: velocity")[0]
            return "length" if kind == "velocity" else "angle"
    return "length"


def programme(segments: Sequence[CycleSegment], period: float, start: Any, advance: Any) -> Programme:
    """A cycle as numbers."""
    axis = axis_of(segments)
    first = 0.0 if start is None else quantity(start, axis, "start")
    forward = 0.0 if advance is None else quantity(advance, axis, "advance")
    durations = _durations(segments, period)
    stretches: list[TimedSegment] = []
    position = first
    for i, (segment, (least, most)) in enumerate(zip(segments, durations, strict=True)):
        where = f"segment {i + 1} ({segment.label})"
        moved = _displacement(segment, axis, where, here=position, last=first + forward, duration=least)
        limits = read_limits(segment.limits if isinstance(segment, Move | Free) else {}, axis, f"{where}: limits")
        stretches.append(TimedSegment(i + 1, segment, least, most, moved, limits))
        position += moved
    _check_closed(position - first, forward, stretches, axis)
    return Programme(period, axis, tuple(stretches), first)


def time_of(value: Any, period: float, name: str) -> float:
    """A time, or an angle of the master as a time."""
    kind, number = either(value, ("angle", "time"), name)
    return number / TURN * period if kind == "angle" else number


def _durations(segments: Sequence[CycleSegment], period: float) -> list[tuple[float, float]]:
    bounds = [
        _bounds(segment, period, f"segment {i + 1} ({segment.label}): duration") for i, segment in enumerate(segments)
    ]
    low, high = (sum(side) for side in zip(*bounds, strict=True))
    free = [i for i, (least, most) in enumerate(bounds) if least != most]
    if low > period * (1.0 + CLOSURE) or high < period * (1.0 - CLOSURE):
        total = low if low > period else high
        share = 360.0 * total / period
        raise InputError(
            sentence(
                "the durations sum to {} ({} s), not to {} ({} s): {} segments by {} in all, or leave out the duration "
                "of one of them: it then has the rest of the time",
                Amount(share, "deg", 9), f"{total:.9g}", Amount(360.0, "deg"), f"{period:.9g}",
                "shorten" if total > period else "lengthen", Amount(abs(share - 360.0), "deg", 9),
            )
        )  # fmt: skip
    if len(free) == 1:
        left = period - (low - bounds[free[0]][0])
        if left <= CLOSURE * period:
            raise InputError(f"segment {free[0] + 1} ({segments[free[0]].label}): nothing is left for it")
        bounds[free[0]] = (left, left)
    for i in free if len(free) > 1 else ():
        if not isinstance(segments[i], Move):
            raise InputError(
                f"segment {i + 1} ({segments[i].label}): give it a duration; with several free ones only moves share"
                " what is left"
            )
    return bounds


def _bounds(segment: CycleSegment, period: float, name: str) -> tuple[float, float]:
    if segment.duration is None:
        return 0.0, inf
    if isinstance(segment.duration, list | tuple):
        least, most = (time_of(value, period, name) for value in segment.duration)
    else:
        least = most = time_of(segment.duration, period, name)
    if not 0.0 < least <= most and not (least == 0.0 < most):
        raise InputError(f"{name} must be above 0, the least first, got {shortened(segment.duration)}")
    if most <= SAME_TIME * period:
        raise InputError(
            f"{name} is too short beside the cycle's {period:.6g} s, got {shortened(segment.duration)}: leave the "
            "segment out"
        )
    return least, most


def _displacement(segment: CycleSegment, axis: str, where: str, *, here: float, last: float, duration: float) -> float:
    if isinstance(segment, ConstantVelocity):
        return quantity(segment.velocity, AXES[axis][1], f"{where}: velocity") * duration
    if isinstance(segment, Dwell):
        return 0.0
    assert isinstance(segment, Move | Free)  # noqa: S101 - there are no other kinds
    if (segment.by is None) == (segment.to is None):
        if segment.by is None and isinstance(segment, Return):
            return last - here
        raise InputError(f"{where}: give it either a displacement `by` or a position `to`")
    if segment.to is not None:
        return quantity(segment.to, axis, f"{where}: to") - here
    moved = quantity(segment.by, axis, f"{where}: by")
    if moved == 0.0 and isinstance(segment, Rise | Return):
        raise InputError(f"{where}: `by` must not be 0, got {shortened(segment.by)}: what does not move is a Dwell")
    if moved < 0.0 and isinstance(segment, Rise | Return):
        raise InputError(
            f"{where}: `by` is given as a positive displacement, got {shortened(segment.by)}; or take a Move"
        )
    return -moved if isinstance(segment, Return) else moved


def _check_closed(moved: float, forward: float, stretches: Sequence[TimedSegment], axis: str) -> None:
    size = max((abs(stretch.displacement) for stretch in stretches), default=0.0)
    if abs(moved - forward) <= CLOSURE * max(size, abs(forward)):
        return
    shown, due = (in_small_units(angle, axis) for angle in (moved, forward))
    raise InputError(
        sentence(
            "the positions do not close: the cycle ends {} from its start, not {}: change a displacement by {}, end "
            "with Return(duration=...), or give advance={} if each cycle goes on from there",
            shown, due, in_small_units(forward - moved, axis), repr(str(shown)),
        )
    )  # fmt: skip


def is_optimal(segment: CycleSegment) -> bool:
    """Whether the segment's law is optimised."""
    return isinstance(segment, Free) or (
        isinstance(segment, Move) and isinstance(segment.law, str) and segment.law == OPTIMAL
    )
