"""The least time over all laws from rest to rest, in closed form: segments of greatest jerk, acceleration, velocity.

A motion that gains a velocity within limits of acceleration and jerk takes no less than its phase of segments; the
sum of both phases and of the constant velocity between them is the least time (docs/theory/least-time.md).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import accumulate
from math import inf, sqrt

from optlaws.numerics.roots import bisect
from optlaws.synthesis.least_time.move_limits import MoveLimits
from optlaws.tolerances import OPERATIONS_ROUNDING, VALUE_ROUNDING

#: the least peak of the fourth derivative from rest to rest, of laws of order 4 and more: 3! 4³
_SNAP = 384.0
_SMOOTH_SNAP = 4
#: the order from which laws are at rest at their ends; above it they have no acceleration there
_AT_REST = 2


#: the times of the segments by which a velocity is gained, jerk, constant acceleration and jerk, and what they cover
#: beside that with the first velocity
Phase = tuple[tuple[float, float, float], float]


@dataclass(frozen=True)
class LimitSegments:
    """The times of the seven segments of the fastest motion, 0 of those that are not needed.

    They `are_reached` where laws come as near as one likes: not where a limit of the jerk is left out.
    """

    times: tuple[float, ...]
    are_reached: bool = True

    @property
    def duration(self) -> float:
        return sum(self.times)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The times between segments as shares of the duration: breaks of pieces that reach the least time.

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


def segment_times(
    stroke: float, limits: MoveLimits, order: int, ends: tuple[float, float] = (0.0, 0.0), *, forward: bool = False
) -> LimitSegments | None:
    """The segments of the fastest motion of all laws; None where no limit of velocity, acceleration or jerk bounds it.

    A limit of the snap is left out: with it, no law is as fast. At order 2 accelerations may jump at the ends, which
    is exact from rest to rest; where an end moves, the jerk is left out there.

    The order is 2 at least where the `ends` have velocities; laws that go `forward` never turn back.

    >>> round(segment_times(1.0, MoveLimits(1.0, 1.0, 1.0, 1.0), 3).duration, 9)
    3.174802104
    >>> segment_times(1.0, MoveLimits(2.0, 1.0, 1.0), 3, (2.0, 0.0)).times  # it stops beyond its end, and turns back
    (0.0, 3.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    """
    up, down, jerk, velocity = (
        inf if limit is None else limit
        for limit in (limits.acceleration, limits.deceleration, limits.jerk, limits.velocity)
    )
    if order < _AT_REST:
        # the velocities at the ends are free, so that uniform motion is the fastest
        up = down = jerk = inf
    jumps = order == _AT_REST and any(ends) and jerk < inf
    if jumps:
        jerk = inf
    if jerk == up == down == velocity == inf:
        return None
    times, straight = _phase(abs(ends[1] - ends[0]), up if ends[1] > ends[0] else down, jerk, order)
    slow = min(ends) * sum(times)
    if slow + straight - stroke > OPERATIONS_ROUNDING * (stroke + abs(slow) + straight):
        # too fast at an end for so short a way, it is slower between, or goes back: its image is faster
        stroke, ends, up, down = -stroke, (-ends[0], -ends[1]), down, up
        velocity = 0.0 if forward else velocity

    def phases(above: float) -> tuple[Phase, Phase]:
        first, last = (max(ends) - end + above for end in ends)
        return _phase(first, up, jerk, order), _phase(last, down, jerk, order)

    def covered(above: float) -> float:
        return sum(end * sum(times) + far for end, (times, far) in zip(ends, phases(above), strict=True))

    most = velocity - max(ends)
    above = most if jerk == up == down == inf or covered(most) <= stroke else _crossing(covered, stroke)
    cruise = 0.0 if above < most else (stroke - covered(most)) / velocity if velocity else inf
    (first, _), (last, _) = phases(above)
    return LimitSegments((*first, cruise, *reversed(last)), not jumps)


def time_of_any_law(stroke: float, limits: MoveLimits, order: int) -> float | None:
    """A time that no law from rest to rest is faster than, whatever its degree; None where none is known.

    Without a limit of the snap laws come as near as one likes. With it, the greater of two bounds is taken.

    >>> time_of_any_law(384.0, MoveLimits(snap=1.0), 4), time_of_any_law(2.0, MoveLimits(1.0, 1.0, 1.0, 1.0), 3)
    (19.595918, 4.0)
    """
    segments = segment_times(stroke, limits, order)
    known = [] if segments is None else [segments.duration]
    if limits.snap is not None and order >= _SMOOTH_SNAP:
        known.append((_SNAP * stroke / limits.snap) ** 0.25)
    return max(known, default=None)


def _crossing(covered: Callable[[float], float], stroke: float) -> float:
    """The least velocity above that of the faster end with which the phases cover the stroke."""
    if covered(0.0) >= stroke:
        return 0.0
    low, high = 0.0, 1.0
    while covered(high) < stroke:
        low, high = high, 2.0 * high
    while low == 0.0 and covered(0.5 * high) > stroke:
        high *= 0.5
    return bisect(lambda above: covered(above) < stroke, low, high)[1]


def _phase(gain: float, limit: float, jerk: float, order: int) -> Phase:
    """The fastest segments from a standstill to a velocity at which the acceleration is 0."""
    if jerk == inf:
        return (0.0, gain / limit, 0.0), 0.5 * gain * gain / limit
    if order > _AT_REST:
        if gain < limit * (limit / jerk):
            ramp = sqrt(gain / jerk)
            return (ramp, 0.0, ramp), gain * ramp
        ramp, total = limit / jerk, gain / limit + limit / jerk
        return (ramp, max(total - 2.0 * ramp, 0.0), ramp), 0.5 * gain * total
    # the acceleration may begin with its greatest value
    if 2.0 * gain < limit * (limit / jerk):
        ramp = sqrt(2.0 * gain / jerk)
        return (0.0, 0.0, ramp), jerk * ramp * ramp * ramp / 3.0
    ramp, steady = limit / jerk, gain / limit - 0.5 * limit / jerk
    return (0.0, steady, ramp), limit * (0.5 * steady * steady + steady * ramp + ramp * ramp / 3.0)
