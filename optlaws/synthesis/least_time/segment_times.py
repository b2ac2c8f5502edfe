"""The least time over all laws from rest to rest, in closed form: segments of greatest jerk, acceleration, velocity.

A motion that gains a velocity within limits of acceleration and jerk takes no less than its phase of segments; the
sum of both phases and of the constant velocity between them is the least time (docs/theory/least-time.md).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate
from math import inf, sqrt

from optlaws.synthesis.least_time.move_limits import MoveLimits
from optlaws.tolerances import VALUE_ROUNDING

#: the least peak of the fourth derivative from rest to rest, of laws of order 4 and more: 3! 4³
_SNAP = 384.0
_SMOOTH_SNAP = 4
#: the order from which laws are at rest at their ends; above it they have no acceleration there
_AT_REST = 2


@dataclass(frozen=True)
class Phase:
    """The segments by which a velocity is gained: jerk, constant acceleration, jerk.

    Attributes
    ----------
    times
        Their three durations, s.
    distance
        What the motion covers meanwhile.
    """

    times: tuple[float, float, float]
    distance: float


@dataclass(frozen=True)
class LimitSegments:
    """The fastest motion of all laws from rest to rest: its seven segments.

    Attributes
    ----------
    times
        Their durations, s; 0 where a segment is not needed.
    """

    times: tuple[float, ...]

    @property
    def duration(self) -> float:
        """The least time of the segments, s."""
        return sum(self.times)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The times between segments as shares of the duration: breaks of pieces that reach the least time.

        Examples
        --------
        >>> segment_times(1.0, MoveLimits(jerk=1.0), 3).breaks
        (0.0, 0.25, 0.5, 0.75, 1.0)
        """
        duration = self.duration
        ends = [end / duration for end in accumulate(self.times)][:-1]
        inside = [0.0]
        for end in ends:
            if inside[-1] + VALUE_ROUNDING < end < 1.0 - VALUE_ROUNDING:
                inside.append(end)
        return (*inside, 1.0)


def segment_times(stroke: float, limits: MoveLimits, order: int) -> LimitSegments | None:
    """The segments of the fastest motion of all laws; None where no limit of velocity, acceleration or jerk bounds it.

    A limit of the snap is left out: with it, no law is as fast. At order 2 accelerations may jump at the ends.

    Examples
    --------
    >>> round(segment_times(1.0, MoveLimits(1.0, 1.0, 1.0, 1.0), 3).duration, 9)
    3.174802104
    """
    up, down, jerk, velocity = (
        inf if limit is None else limit
        for limit in (limits.acceleration, limits.deceleration, limits.jerk, limits.velocity)
    )
    if order < _AT_REST:
        # the velocities at the ends are free, so that uniform motion is the fastest
        up = down = jerk = inf
    peak = _peak_velocity(stroke, velocity, (up, down), jerk, order)
    if peak == inf:
        return None
    first, last = (_phase(peak, limit, jerk, order) for limit in (up, down))
    cruise = max(stroke - first.distance - last.distance, 0.0) / peak
    return LimitSegments((*first.times, cruise, *reversed(last.times)))


def time_of_any_law(stroke: float, limits: MoveLimits, order: int) -> float | None:
    """A time that no law from rest to rest is faster than, whatever its degree; None where none is known.

    Without a limit of the snap laws come as near as one likes. With it, the greater of two bounds is taken.

    Examples
    --------
    >>> time_of_any_law(384.0, MoveLimits(snap=1.0), 4), time_of_any_law(2.0, MoveLimits(1.0, 1.0, 1.0, 1.0), 3)
    (19.595918, 4.0)
    """
    segments = segment_times(stroke, limits, order)
    known = [] if segments is None else [segments.duration]
    if limits.snap is not None and order >= _SMOOTH_SNAP:
        known.append((_SNAP * stroke / limits.snap) ** 0.25)
    return max(known, default=None)


def _peak_velocity(
    stroke: float, velocity: float, accelerations: tuple[float, float], jerk: float, order: int
) -> float:
    """The velocity at which both phases cover the stroke, or the limit of the velocity if that is less."""

    def covered(peak: float) -> float:
        return sum(_phase(peak, limit, jerk, order).distance for limit in accelerations)

    if jerk == inf and min(accelerations) == inf:
        return velocity
    if velocity < inf and covered(velocity) <= stroke:
        return velocity
    low, high = 0.0, 1.0
    while covered(high) < stroke:
        low, high = high, 2.0 * high
    while low == 0.0 and covered(0.5 * high) > stroke:
        high *= 0.5
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if covered(middle) < stroke else (low, middle)
    return high


def _phase(gain: float, limit: float, jerk: float, order: int) -> Phase:
    """The fastest segments from a standstill to a velocity at which the acceleration is 0."""
    if jerk == inf:
        return Phase((0.0, gain / limit, 0.0), 0.5 * gain * gain / limit)
    if order > _AT_REST:
        if gain < limit * (limit / jerk):
            ramp = sqrt(gain / jerk)
            return Phase((ramp, 0.0, ramp), gain * ramp)
        ramp, total = limit / jerk, gain / limit + limit / jerk
        return Phase((ramp, max(total - 2.0 * ramp, 0.0), ramp), 0.5 * gain * total)
    # the acceleration may begin with its greatest value
    if 2.0 * gain < limit * (limit / jerk):
        ramp = sqrt(2.0 * gain / jerk)
        return Phase((0.0, 0.0, ramp), jerk * ramp * ramp * ramp / 3.0)
    ramp, steady = limit / jerk, gain / limit - 0.5 * limit / jerk
    return Phase((0.0, steady, ramp), limit * (0.5 * steady * steady + steady * ramp + ramp * ramp / 3.0))
