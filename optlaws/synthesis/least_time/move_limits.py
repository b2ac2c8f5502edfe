"""Limits of velocity, acceleration, jerk and snap of a move, and the problem that they define in a given time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import comb, factorial, inf, nextafter
from typing import Any, NamedTuple

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Number
from optlaws.errors import InputError
from optlaws.numbers import finite, positive
from optlaws.synthesis.least_time.follower_residual import FollowerResidual
from optlaws.synthesis.least_time.motor_torque import MotorTorque, TimedLimit
from optlaws.synthesis.problem.constants import B, C, C_minus, C_plus, Functional, J, snap
from optlaws.synthesis.problem.expression import Expression, maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import at_most
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

_EXAMPLE = "{'velocity': 1.0, 'acceleration': 12.0}"
_HIGHEST = 4

#: a time to the powers 1 to 4, or what stands for them in a Bernstein form
Powers = tuple[float, ...]


class RateLimit(NamedTuple):
    """A limit of one derivative: its name, the constant of the law, the order of the derivative and the limit."""

    name: str
    constant: Functional
    nu: int
    rate: float


_LIMIT = Number(above=0.0)


@declared
class MoveLimits(Declared, title="limits of a move"):
    """Limits of a move, in units of the stroke and seconds.

    Examples
    --------
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

    def rates(self, stroke: float) -> tuple[RateLimit, ...]:
        """The limits of the law with stroke 1, in 1/s^nu, the lowest derivative first.

        Examples
        --------
        >>> [
        ...     (limit.name, limit.constant, limit.rate)
        ...     for limit in MoveLimits(velocity=1.0, deceleration=8.0).rates(0.5)
        ... ]
        [('velocity', B, 2.0), ('deceleration', C_minus, 16.0)]
        """
        both = self.symmetric
        known = (
            ("velocity", B, 1, self.velocity),
            ("acceleration", C if both else C_plus, 2, self.acceleration),
            ("deceleration", C_minus, 2, None if both else self.deceleration),
            ("jerk", J, 3, self.jerk),
            ("snap", snap, 4, self.snap),
        )
        return tuple(RateLimit(name, of, nu, limit / stroke) for name, of, nu, limit in known if limit is not None)

    def scaled(self, name: str, factor: float) -> MoveLimits:
        """The limits with one of them multiplied by a factor; both sides of a common acceleration limit are scaled.

        Examples
        --------
        >>> MoveLimits(acceleration=8.0, deceleration=8.0).scaled("acceleration", 2.0).deceleration
        16.0
        """
        names = ("acceleration", "deceleration") if name == "acceleration" and self.symmetric else (name,)
        return replace(self, **{each: factor * getattr(self, each) for each in names})


@dataclass(frozen=True)
class TimedMove:
    """A move of which the time is sought: the space of its laws, its stroke, its limits and its motion at the ends.

    Attributes
    ----------
    problem
        Order, basis, windows and shape of the laws; it bounds none of the limited constants.
    stroke
        How far, in units of which the limits are.
    limits
        What the move must keep.
    start_velocity, end_velocity
        Velocities at the ends, in units of the stroke a second.
    end_acceleration, end_jerk
        Of a move that begins at rest, at its end; the order is 3 or 4 at least for them.
    torque
        At the motor, with its limits; only for laws from rest to rest that never turn back. None without a motor.
    residual
        The vibration that is left in a follower, with its limit; only from rest to rest. None without a follower.

    Raises
    ------
    InputError
        If the problem has limits, an objective or ends of its own or is not convex, or a number is out of range.
    """

    problem: Problem
    stroke: float
    limits: MoveLimits
    start_velocity: float = 0.0
    end_velocity: float = 0.0
    torque: MotorTorque | None = None
    residual: FollowerResidual | None = None
    end_acceleration: float = 0.0
    end_jerk: float = 0.0

    def __post_init__(self) -> None:
        if not self.limits.to_dict() and self.torque is None:
            raise InputError(f"limits must name one at least, as in {_EXAMPLE}")
        object.__setattr__(self, "stroke", positive(self.stroke, "stroke"))
        for name in ("start_velocity", "end_velocity"):
            object.__setattr__(self, name, finite(getattr(self, name), name))
            most = self.limits.velocity
            if most is not None and abs(getattr(self, name)) > most:
                raise InputError(f"{name} is beyond the limit of the velocity: no move keeps it, however long it takes")
        self._check_end()
        even = self.at_rest and self.limits.symmetric and self.torque is None
        object.__setattr__(self, "problem", _checked(self.problem, even=even))
        if self.torque is not None and not (self.at_rest and self.problem.monotone):
            raise InputError("a torque at the motor is limited from rest to rest, by laws that never turn back")
        if self.torque is not None:
            self.torque.check_mean()
        if self.residual is not None and not self.at_rest:
            raise InputError("the vibration that is left is limited from rest to rest")
        if not self.at_rest and self.problem.order < max(2, self._lowest.nu):
            raise InputError(
                f"ends that move need order >= {max(2, self._lowest.nu)} where the {self._lowest.name} is the lowest "
                f"derivative that is limited, got order {self.problem.order}"
            )

    def _check_end(self) -> None:
        """Refuse an acceleration and a jerk at the end that the start, the order or a limit does not allow."""
        limits = self.limits
        sides = limits.deceleration if self.end_acceleration < 0.0 else limits.acceleration
        for name, least, most in (("end_acceleration", 3, sides), ("end_jerk", 4, limits.jerk)):
            value = finite(getattr(self, name), name)
            object.__setattr__(self, name, value)
            if value and self.start_velocity:
                raise InputError(f"{name} is that of a move which begins at rest: give no start_velocity")
            if value and self.problem.order < least:
                raise InputError(f"{name} needs order >= {least}, got order {self.problem.order}")
            if most is not None and abs(value) > most:
                what = name.removeprefix("end_")
                raise InputError(f"{name} is beyond the limit of the {what}: no move keeps it, however long it takes")

    @property
    def at_rest(self) -> bool:
        """Whether both ends are at rest: then limits that hold in a time hold in any longer time."""
        return self.start_velocity == self.end_velocity == 0.0 and self.concave

    @property
    def concave(self) -> bool:
        """Whether multipliers give a concave function of the time: only velocities may be nonzero at the ends."""
        return self.end_acceleration == self.end_jerk == 0.0

    @property
    def stays_possible(self) -> bool:
        """Whether a law that keeps all limits but the residual's keeps them in every longer time."""
        if self.torque is None:
            return self.at_rest
        greatest = inf if self.limits.velocity is None else self.limits.velocity / self.stroke
        return self.torque.grows_possible and self.torque.brakes_with_load(greatest)

    @property
    def rates(self) -> tuple[RateLimit, ...]:
        """The limits of the law with stroke 1, in 1/s^nu."""
        return self.limits.rates(self.stroke)

    def limits_in(self, duration: float) -> tuple[TimedLimit, ...]:
        """Every limit in a time, as a bound of a constant of the law."""
        of_rates = self._limits_of_rates(powers_of(duration))
        torques = () if self.torque is None else self.torque.limits_in(duration)
        left = () if self.residual is None else (self.residual.limit_in(duration, self.stroke),)
        return (*of_rates, *torques, *left)

    def limits_over(self, shortest: float, longest: float) -> tuple[TimedLimit, ...]:
        """Limits of every law from rest to rest that keeps the move's limits in some time of an interval.

        Limits that hold in a time hold in every longer one, except that of the residual vibration.
        """
        if self.residual is None:
            return self.limits_in(longest)
        left = self.residual.limit_over(shortest, longest, self.stroke, *self._sizes_in(longest))
        return (*self.without_residual.limits_in(longest), *((left,) if left.bound < inf else ()))

    def _sizes_in(self, duration: float) -> tuple[float, float]:
        """A priori bounds of laws within the limits in a time: the integrals of |k - 1/2| |b| and of |k - 1/2| |c|."""
        most = {limit.constant: limit.bound for limit in self.without_residual.limits_in(duration)}
        smooth = getattr(self.problem.basis, "continuity", 2) >= 2
        velocity, jerk = 0.25 * most.get(B, inf), most.get(J, inf) if smooth else inf
        up, down = (most.get(side, most.get(C, inf)) for side in (C_plus, C_minus))
        # what is gained is lost again: the integral of |c| is at most twice that of one side; and c vanishes somewhere
        acceleration = min(0.25 * max(up, down), up, down, 0.25 * jerk)
        return min(velocity, 0.5) if self.problem.monotone else velocity, acceleration

    @property
    def without_residual(self) -> TimedMove:
        """The move without its residual limit; every law of the original move remains a law of this one."""
        return replace(self, residual=None)

    @property
    def _lowest(self) -> RateLimit:
        return min(self.rates, key=lambda limit: limit.nu)

    def within(self, duration: float, shortest: float | None = None) -> Problem:
        """The problem of the laws that keep every limit in a time: its ends, and bounds B <= v T/h, C <= a T²/h.

        With a shortest time it is a problem of every law that keeps them in some time between these two.

        Examples
        --------
        >>> move = TimedMove(Problem(order=3), 2.0, MoveLimits(velocity=1.0, jerk=3.0))
        >>> move.within(4.0)
        Problem(B=at_most(2.0), order=3, basis=Chebyshev(degree=9), minimise='C', J=at_most(96.0))
        """
        limits = self.limits_in(duration) if shortest is None else self.limits_over(shortest, duration)
        return self._within(limits, powers_of(duration))

    def within_control_points(self, shortest: float, longest: float) -> list[Problem]:
        """The problems of the times between two, in Bernstein form: of each time a convex mean of them, in its numbers.

        What multipliers leave is affine in the powers of the time, so that a contradiction by the same multipliers in
        all of these problems is one in every time between.

        Examples
        --------
        >>> move = TimedMove(Problem(order=3), 1.0, MoveLimits(jerk=1.0), end_velocity=1.0, end_acceleration=0.5)
        >>> [each.range("J").high for each in move.within_control_points(1.0, 2.0)]
        [1.0, 2.0, 4.0, 8.0]
        """
        degree = max([3 if self.end_jerk else 2, *(limit.nu for limit in self.rates)])
        points = [control_point(shortest, longest, i, degree) for i in range(degree + 1)]
        return [self._within(self._limits_of_rates(powers), powers) for powers in points]

    def _limits_of_rates(self, powers: Powers) -> tuple[TimedLimit, ...]:
        return tuple(TimedLimit(limit.name, limit.constant, limit.rate * powers[limit.nu - 1]) for limit in self.rates)

    def _within(self, limits: tuple[TimedLimit, ...], powers: Powers) -> Problem:
        bounds = {limit.constant: at_most(limit.bound) for limit in limits}
        return replace(self.problem, boundary=self._ends(powers), bounds={**self.problem.bounds, **bounds})

    def shares(self, duration: float, ends: Powers | None = None, shortest: float | None = None) -> Problem:
        """The problem of the least greatest share of the limits in a time; with the ends of other powers if given.

        With a shortest time the limits are those of all times between.

        Examples
        --------
        >>> TimedMove(Problem(order=3), 1.0, MoveLimits(velocity=1.0, jerk=1.0)).shares(2.0).minimise
        'max(0.5*B, 0.125*J)'
        """
        limits = self.limits_in(duration) if shortest is None else self.limits_over(shortest, duration)
        parts = [limit.constant / limit.bound for limit in limits]
        objective: Expression = maximum(*parts).expression() if len(parts) > 1 else parts[0]
        return replace(
            self.problem, boundary=self._ends(powers_of(duration) if ends is None else ends), minimise=objective
        )

    def _ends(self, powers: Powers) -> BoundaryConditions | None:
        """The motion at the ends as a law of a time with these powers has it."""
        if self.at_rest:
            return None
        start, end = (
            tuple(rate * powers[i] / self.stroke if rate else 0.0 for i, rate in enumerate(rates))
            for rates in (self.rates_at_start, self.rates_at_end)
        )
        return BoundaryConditions((0.0, *start), (1.0, *end))

    @property
    def velocities(self) -> tuple[float, float]:
        """The velocities at both ends."""
        return self.start_velocity, self.end_velocity

    @property
    def rates_at_start(self) -> tuple[float, ...]:
        """Velocity, acceleration, jerk at the start, as many as the order has conditions."""
        return self._as_conditions(self.start_velocity, 0.0, 0.0)

    @property
    def rates_at_end(self) -> tuple[float, ...]:
        """Velocity, acceleration, jerk at the end, as many as the order has conditions."""
        return self._as_conditions(self.end_velocity, self.end_acceleration, self.end_jerk)

    def _as_conditions(self, *rates: float) -> tuple[float, ...]:
        count = self.problem.order - 1
        return (rates + (0.0,) * count)[:count]

    def least_conceivable(self) -> float:
        """A time that no motion is faster than, by the lowest derivative that is limited and the velocity at an end."""
        if not self.rates:
            return 0.0
        lowest = self._lowest
        # a deceleration alone bounds what is covered before the end, all others what is covered after the start
        velocity = self.end_velocity if lowest.constant == C_minus else self.start_velocity
        start = 0.0 if lowest.nu == 1 else max(velocity, 0.0) / self.stroke

        def far(duration: float) -> float:
            return start * duration + lowest.rate * power(duration, lowest.nu) / factorial(lowest.nu)

        high: float = (factorial(lowest.nu) / lowest.rate) ** (1.0 / lowest.nu)
        while far(high) <= 1.0:
            high = nextafter(high, inf)
        low = 0.0 if start else nextafter(high, 0.0)
        while low < (middle := 0.5 * (low + high)) < high:
            low, high = (middle, high) if far(middle) <= 1.0 else (low, middle)
        return high


def power(duration: float, nu: int) -> float:
    """A time to a whole power by products, which every machine rounds alike.

    >>> power(1.5, 3)
    3.375
    """
    product = duration
    for _ in range(nu - 1):
        product *= duration
    return product


def powers_of(duration: float) -> Powers:
    """A time to the powers 1 to 4.

    >>> powers_of(2.0)
    (2.0, 4.0, 8.0, 16.0)
    """
    return tuple(power(duration, nu) for nu in range(1, _HIGHEST + 1))


def control_point(shortest: float, longest: float, i: int, degree: int) -> Powers:
    """The Bernstein coefficients of number i of the powers of the time between two, up to the degree.

    >>> control_point(1.0, 2.0, 1, 2)
    (1.5, 2.0)
    """

    def coefficient(nu: int) -> float:
        return sum(
            comb(i, k) * comb(degree - i, nu - k) / comb(degree, nu) * longest**k * shortest ** (nu - k)
            for k in range(max(0, nu - degree + i), min(i, nu) + 1)
        )

    return tuple(coefficient(nu) for nu in range(1, degree + 1))


def _checked(problem: Any, *, even: bool) -> Problem:
    """The problem that gives the space of laws; where limits or ends differ, its laws need not be symmetric."""
    if not isinstance(problem, Problem):
        raise InputError(f"the least time is sought of a Problem, got {type(problem).__name__}")
    given = [name for name in ("B", "C", "D", "J") if getattr(problem, name) is not None]
    given += [constant.name for constant in problem.bounds if constant in {C_plus, C_minus, snap}]
    if given:
        raise InputError(f"the problem of a least time leaves {', '.join(given)} free: say it in limits, with its unit")
    if problem.minimise != "C":
        raise InputError(f"a least time minimises nothing else: leave out minimise={shortened(problem.minimise)}")
    if problem.boundary is not None:
        raise InputError("the problem of a least time has no boundary: give start_velocity and end_velocity")
    if problem.inflexion is not None:
        raise InputError("the problem of a least time has no inflexion: the velocity is greatest where it is fastest")
    low = [constant.title for constant, limits in problem.bounded if limits.low > 0.0 or limits.high == inf]
    if low or not problem.convex:
        which = f": {', '.join(low)} is bounded from below" if low else ""
        raise InputError(f"a least time is proven where every bound and window is convex, not so here{which}")
    return problem if even or not problem.symmetric else replace(problem, symmetric=False)
