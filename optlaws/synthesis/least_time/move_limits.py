"""Limits of a motion whose time is sought, and the least time over all laws within them in closed form.

A motion that gains a velocity within limits of acceleration and jerk takes no less than its phase of segments, of
greatest jerk, acceleration and velocity; the sum of both phases and of the constant velocity between them is the least
time (docs/how-to/least-time.md). A follower vibrates more often in longer times, which may leave more of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import accumulate
from math import inf, nextafter, sqrt
from typing import Any, NamedTuple

from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Choice, Number
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numerics.roots import bisect
from optlaws.synthesis.problem.constants import B, C, C_minus, C_plus, Functional, J, snap
from optlaws.synthesis.problem.named_constants import named
from optlaws.tolerances import LIMIT_ROUNDING, OPERATIONS_ROUNDING, VALUE_ROUNDING


class TimedLimit(NamedTuple):
    """A limit of a law in a time: its name, the constant of the law and the greatest allowed value."""

    name: str
    constant: Functional
    bound: float

    def share(self, law: MotionLaw) -> float:
        """The share of the limit that a law takes."""
        return float(self.constant.value(law) / self.bound)


@dataclass(frozen=True)
class SpanLimit:
    """A limit along a span as a function of its time, or of a scale of its time.

    Attributes
    ----------
    name, most
        What is limited, and how much of it is allowed in SI units.
    term
        The limited constant of the law and its greatest allowed value, in a time.
    nu
        The order of the derivative that is limited, of which so high a power of the time is allowed; 0 of others.
    scales
        Whether a law that keeps the limit keeps it in every longer time.
    key
        What the caller knows it by.
    """

    name: str
    most: float
    term: Callable[[float], tuple[Functional, float]]
    nu: int = 0
    scales: bool = True
    key: Any = None

    def at(self, duration: float) -> TimedLimit:
        """The limit in a time."""
        return TimedLimit(self.name, *self.term(duration))

    @property
    def rate(self) -> float:
        """The greatest allowed value in a time of 1."""
        return self.term(1.0)[1]


def derivative_limit(name: str, most: float, constant: Functional, nu: int, rate: float, key: Any = None) -> SpanLimit:
    """The limit of a derivative of the law, in 1/s^nu."""
    return SpanLimit(name, most, lambda duration: (constant, rate * power(duration, nu)), nu, key=key)


def power(duration: float, nu: int) -> float:
    """A time to a whole power by products, which every machine rounds alike.

    >>> power(1.5, 3)
    3.375
    """
    product = duration
    for _ in range(nu - 1):
        product *= duration
    return product


_LIMIT = Number(above=0.0)


@declared
class MoveLimits(Declared, title="limits of a move"):
    """Limits of a move, in units of the stroke and seconds.

    >>> MoveLimits(velocity=1.0, acceleration=12.0, deceleration=8.0).symmetric
    False
    """

    velocity: float | None = entry(_LIMIT, "The greatest magnitude.", default=None)
    acceleration: float | None = entry(_LIMIT, "The greatest in the direction of the stroke.", default=None)
    deceleration: float | None = entry(_LIMIT, "The greatest against it.", default=None)
    jerk: float | None = entry(_LIMIT, "The greatest magnitude.", default=None)
    snap: float | None = entry(_LIMIT, "The greatest magnitude.", default=None)

    @property
    def symmetric(self) -> bool:
        """Whether a law and its mirror image keep the limits alike."""
        return self.acceleration == self.deceleration

    def along(self, stroke: float) -> tuple[SpanLimit, ...]:
        """The limits of the law with stroke 1, the lowest derivative first.

        >>> [limit.at(2.0) for limit in MoveLimits(velocity=1.0, deceleration=8.0).along(0.5)][1]
        TimedLimit(name='deceleration', constant=C_minus, bound=64.0)
        """
        both = self.symmetric
        known = (
            ("velocity", B, 1, self.velocity),
            ("acceleration", C if both else C_plus, 2, self.acceleration),
            ("deceleration", C_minus, 2, None if both else self.deceleration),
            ("jerk", J, 3, self.jerk),
            ("snap", snap, 4, self.snap),
        )
        return tuple(
            derivative_limit(name, most, of, nu, most / stroke) for name, of, nu, most in known if most is not None
        )

    def scaled(self, name: str, factor: float) -> MoveLimits:
        """The limits with one of them multiplied by a factor; both sides of a common acceleration limit are scaled.

        >>> MoveLimits(acceleration=8.0, deceleration=8.0).scaled("acceleration", 2.0).deceleration
        16.0
        """
        names = ("acceleration", "deceleration") if name == "acceleration" and self.symmetric else (name,)
        return replace(self, **{each: factor * getattr(self, each) for each in names})


#: the least peak of the fourth derivative from rest to rest, of laws of order 4 and more: 3! 4³
_SNAP, _SMOOTH_SNAP = 384.0, 4
#: the order from which laws are at rest at their ends; above it they have no acceleration there
_AT_REST = 2

#: the times of the segments by which a velocity is gained, jerk, constant acceleration and jerk, and what they cover
#: beside that with the first velocity
Phase = tuple[tuple[Any, Any, Any], Any]


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
        inside = [0.0]
        for end in [end / self.duration for end in accumulate(self.times)][:-1]:
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
    times, straight = phase(abs(ends[1] - ends[0]), up if ends[1] > ends[0] else down, jerk, order)
    slow = min(ends) * sum(times)
    if slow + straight - stroke > OPERATIONS_ROUNDING * (stroke + abs(slow) + straight):
        # too fast at an end for so short a way, it is slower between, or goes back: its image is faster
        stroke, ends, up, down = -stroke, (-ends[0], -ends[1]), down, up
        velocity = 0.0 if forward else velocity

    def phases(above: float) -> tuple[Phase, Phase]:
        first, last = (max(ends) - end + above for end in ends)
        return phase(first, up, jerk, order), phase(last, down, jerk, order)

    def covered(above: float) -> float:
        return float(sum(end * sum(times) + far for end, (times, far) in zip(ends, phases(above), strict=True)))

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


def scale_of_any_law(limits: MoveLimits, order: int, ends: tuple[float, float]) -> float | None:
    """The least scale of the time of all laws with the stroke 1 whose end velocities are such shares of the mean one.

    In a longer time the limits of the law are wider, so that what is too short is known of all shorter ones too.

    >>> scale_of_any_law(MoveLimits(acceleration=1.0, deceleration=1.0), 2, (0.0, 1.0))  # root of 1 + root of 2
    1.553773974
    """
    if not any(ends):
        return time_of_any_law(1.0, limits, order)

    def too_short(scale: float) -> bool:
        first, last = (end / scale for end in ends)
        if limits.velocity is not None and max(abs(first), abs(last)) > limits.velocity:
            return True
        segments = segment_times(1.0, limits, order, (first, last))
        return segments is not None and segments.duration > scale

    low, high = 0.5, 1.0
    while too_short(high):
        low, high = high, 2.0 * high
    while not too_short(low):
        low, high = 0.5 * low, low
        if low < VALUE_ROUNDING:
            return None
    return bisect(too_short, low, high)[0]


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


def phase(gain: Any, limit: Any, jerk: Any, order: int, root: Callable[[Any], Any] = sqrt) -> Phase:
    """The fastest segments from a standstill to a velocity at which the acceleration is 0, in floats or in fractions.

    Times and ways are no less than they are where roots are none less, and no more where these are none more.
    """
    none = type(gain)(0)
    if jerk == inf:
        return (none, none if limit == inf else gain / limit, none), none if limit == inf else gain * gain / 2 / limit
    if order > _AT_REST:
        if gain < limit * (limit / jerk):
            ramp = root(gain / jerk)
            return (ramp, none, ramp), gain * ramp
        ramp, total = limit / jerk, gain / limit + limit / jerk
        return (ramp, max(total - 2 * ramp, none), ramp), gain * total / 2
    # the acceleration may begin with its greatest value
    if 2 * gain < limit * (limit / jerk):
        ramp = root(2 * gain / jerk)
        return (none, none, ramp), jerk * ramp * ramp * ramp / 3
    ramp, steady = limit / jerk, gain / limit - limit / jerk / 2
    return (none, steady, ramp), limit * (steady * steady / 2 + steady * ramp + ramp * ramp / 3)


#: the names of the limits
RESIDUALS = RESIDUAL, RESIDUAL_DISPLACEMENT = "residual acceleration", "residual displacement"


@declared
class FollowerResidual(Declared, title="the residual vibration of a move"):
    """The residual acceleration or displacement of an elastic follower after a move, with its limit.

    >>> FollowerResidual(95.0, 105.0, 0.05, most=0.4).limit_in(0.2, stroke=0.1)
    TimedLimit(name='residual acceleration', constant=residual(frequency=(19.0, 21.0), damping=0.05), bound=0.16)
    >>> FollowerResidual(95.0, 105.0, 0.05, 4e-5, of="displacement").limit_in(0.2, stroke=0.1).bound
    0.0004
    """

    newer = ("of",)

    lowest: float = entry(_LIMIT, "Its least natural circular frequency, rad/s.")
    highest: float = entry(_LIMIT, "The greatest.")
    damping: float = entry(Number(least=0.0), "Its damping ratio, below 1.")
    most: float = entry(
        _LIMIT,
        "The greatest amplitude after the move: of its acceleration, in units of the stroke a square second, or of its "
        "displacement, in those of the stroke.",
    )
    of: str = entry(Choice("acceleration", "displacement"), "What of the vibration is limited.", default="acceleration")

    def _check(self) -> None:
        if self.lowest > self.highest or self.damping >= 1.0:
            raise InputError("the frequencies of a follower must be in order, and its damping below 1")

    @property
    def name(self) -> str:
        """The name of the limit."""
        return f"residual {self.of}"

    def along(self, stroke: float) -> SpanLimit:
        """The limit of a law with the stroke 1 over the time."""
        return SpanLimit(self.name, self.most, lambda duration: self.limit_in(duration, stroke)[1:])

    def limit_in(self, duration: float, stroke: float) -> TimedLimit:
        """The limit of a law with the stroke 1 in a time."""
        low, high = (frequency * duration for frequency in (self.lowest, self.highest))
        unit = 1.0 if self.of == "displacement" else duration * duration
        return self._limit(low, high, self.most * unit / stroke)

    def limit_over(
        self, shortest: float, longest: float, stroke: float, velocity: float, acceleration: float
    ) -> TimedLimit:
        """A limit of every law that keeps the residual's in some time from the shortest to the longest.

        The frequencies nu = omega T that all these times have in common are limited by what is allowed in the longest.
        Where there are none, the middle between them is: there the amplitude is greater by its slope times the
        distance at most, which is bounded by the integrals of |k - 1/2| |b| and |k - 1/2| |c| in any such law:
        `velocity` and `acceleration`. The limit is infinite where these are.

        >>> FollowerResidual(95.0, 105.0, 0.05, most=0.4).limit_over(0.199, 0.2, 0.1, 0.5, 2.0).constant
        residual(frequency=(19.000000000000004, 20.894999999999996), damping=0.05)
        >>> certain = FollowerResidual(100.0, 100.0, 0.0, most=0.4)
        >>> round(certain.limit_over(0.1998, 0.2, 0.1, 0.5, 2.0).bound, 6)
        0.55972
        """
        low, high = nextafter(self.lowest * longest, inf), nextafter(self.highest * shortest, 0.0)
        wider = 1.0 + LIMIT_ROUNDING
        displaced = self.of == "displacement"
        most = self.most / stroke * wider if displaced else self.most * longest / stroke * wider
        if low <= high:
            return self._limit(low, high, most if displaced else most * longest)
        # |P| = nu/s |integral of exp(nu u (1 - k)) c|: half of the wave is taken out, so that its slope has |k - 1/2|
        nu, apart = 0.5 * (low + high), 0.5 * (low - high) * wider
        damped, share = sqrt((1.0 - self.damping) * (1.0 + self.damping)), 1.0 - 0.5 * self.damping * apart
        if share <= 0.0:
            return self._limit(nu, nu, inf)
        # of the place nearest to the middle at which a limit is kept: its |P| / nu and |P| / nu^2
        slope = most * low if displaced else most / self.lowest
        amplitude = most if displaced else self.most / stroke / self.lowest**2
        by_acceleration = nu * (slope + apart * acceleration / damped)
        by_velocity = nu * nu * (amplitude + apart * velocity / damped)
        unit = nu * nu if displaced else 1.0
        return self._limit(nu, nu, min(by_acceleration, by_velocity) / unit / share * wider)

    def _limit(self, low: float, high: float, bound: float) -> TimedLimit:
        spread = repr(low) if low == high else f"({low!r}, {high!r})"
        of = ", of=displacement" if self.of == "displacement" else ""
        return TimedLimit(self.name, named(f"residual(frequency={spread}, damping={self.damping!r}{of})"), bound)
