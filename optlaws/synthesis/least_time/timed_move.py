"""A motion of which the time is sought, the problem that its limits define in a given time, and what is least in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import comb, factorial, inf, nextafter
from typing import TypeVar

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Choice, Number, ReadBy
from optlaws.errors import InputError
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import constant
from optlaws.kept import kept_property
from optlaws.numerics.roots import bisect
from optlaws.synthesis.functionals.makers import integral, peak, rms
from optlaws.synthesis.least_time.motor_torque import MotorTorque
from optlaws.synthesis.least_time.move_limits import (
    RESIDUALS,
    FollowerResidual,
    LimitSegments,
    MoveLimits,
    SpanLimit,
    TimedLimit,
    power,
    segment_times,
    time_of_any_law,
)
from optlaws.synthesis.problem.constants import B, C, C_minus, C_plus, Functional, J, rms_c, rms_j, rms_snap, snap
from optlaws.synthesis.problem.expression import Expression, maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range, at_most
from optlaws.synthesis.proof.data import problem_of
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.tolerances import MIRROR

_EXAMPLE = "{'velocity': 1.0, 'acceleration': 12.0}"
_HIGHEST = 4

TimedT = TypeVar("TimedT", bound="Timed")

#: a time to the powers 1 to 4, or what stands for them in a Bernstein form
Powers = tuple[float, ...]


class Timed:
    """A motion of which the time is sought: the space of its laws, and limits along it as functions of the time.

    Unless a kind of motion says otherwise, its ends are in every time those of its problem.
    """

    problem: Problem

    @property
    def along(self) -> tuple[SpanLimit, ...]:
        """The limits of the law."""
        raise NotImplementedError

    @property
    def begin(self) -> float:
        """A time in which the search may begin: where it is known, one that is too short by little."""
        raise NotImplementedError

    @property
    def best_possible(self) -> float | None:
        """The time that no law of any degree is faster than; None where it is not known."""
        return None

    @property
    def rates(self) -> tuple[SpanLimit, ...]:
        """The limits of derivatives."""
        return tuple(limit for limit in self.along if limit.nu)

    @property
    def of_rates(self) -> bool:
        """Whether these are all limits, so that the multipliers of one time speak of all times."""
        return len(self.rates) == len(self.along)

    @property
    def stays_possible(self) -> bool:
        """Whether a law that keeps all limits but the residual's keeps them in every longer time."""
        return all(limit.scales for limit in self.along)

    @property
    def at_rest(self) -> bool:
        """Whether both ends are at rest: then limits that hold in a time hold in any longer time."""
        return True

    @property
    def concave(self) -> bool:
        """Whether multipliers give a concave function of the time: only velocities may be nonzero at the ends."""
        return True

    @property
    def moving(self) -> tuple[tuple[float, float], ...]:
        """Velocity, acceleration and so on at both ends where they are given, in units of the stroke and seconds."""
        return ()

    @property
    def residual(self) -> FollowerResidual | None:
        """The vibration that is left, with its limit, which a longer time may break; None without a follower."""
        return None

    @property
    def without_residual(self) -> Timed:
        return self

    def least_conceivable(self) -> float:
        """A time that no motion is faster than."""
        return 0.0

    def limits_in(self, duration: float) -> tuple[TimedLimit, ...]:
        """Every limit in a time, as a bound of a constant of the law."""
        return tuple(limit.at(duration) for limit in self.along)

    def limits_over(self, shortest: float, longest: float) -> tuple[TimedLimit, ...]:  # noqa: ARG002 - of vibrations
        """Limits of every law from rest to rest that keeps the motion's limits in some time of an interval."""
        return self.limits_in(longest)

    def within(self, duration: float, shortest: float | None = None) -> Problem:
        """The problem of the laws that keep every limit in a time: its ends, and bounds B <= v T/h, C <= a T²/h.

        With a shortest time it is a problem of every law that keeps them in some time between these two.

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

        >>> move = TimedMove(Problem(order=3), 1.0, MoveLimits(jerk=1.0), end_velocity=1.0, end_acceleration=0.5)
        >>> [each.range("J").high for each in move.within_control_points(1.0, 2.0)]
        [1.0, 2.0, 4.0, 8.0]
        """
        ends = (nu for nu, rates in enumerate(self.moving, start=1) if any(rates))
        degree = max([2, *ends, *(limit.nu for limit in self.rates)])
        points = [control_point(shortest, longest, i, degree) for i in range(degree + 1)]
        known = [(limit.name, *limit.term(1.0), limit.nu) for limit in self.rates]
        return [
            self._within([TimedLimit(name, of, rate * powers[nu - 1]) for name, of, rate, nu in known], powers)
            for powers in points
        ]

    def shares(self, duration: float, ends: Powers | None = None, shortest: float | None = None) -> Problem:
        """The problem of the least greatest share of the limits in a time; with the ends of other powers if given.

        With a shortest time the limits are those of all times between.

        >>> TimedMove(Problem(order=3), 1.0, MoveLimits(velocity=1.0, jerk=1.0)).shares(2.0).minimise
        'max(0.5*B, 0.125*J)'
        """
        limits = self.limits_in(duration) if shortest is None else self.limits_over(shortest, duration)
        parts = [limit.constant / limit.bound for limit in limits]
        objective: Expression = maximum(*parts).expression() if len(parts) > 1 else parts[0]
        return replace(
            self.problem, boundary=self._ends(powers_of(duration) if ends is None else ends), minimise=objective
        )

    def _within(self, limits: Sequence[TimedLimit], powers: Powers) -> Problem:
        bounds: dict[object, Range] = dict(self.problem.bounds)
        most: dict[Functional, float] = {}
        for limit in limits:
            most[limit.constant] = min(limit.bound, most.get(limit.constant, limit.bound))
        bounds.update((constant, at_most(bound)) for constant, bound in most.items())
        return replace(self.problem, boundary=self._ends(powers), bounds=bounds)

    def _ends(self, powers: Powers) -> BoundaryConditions | None:  # noqa: ARG002 - of ends that move
        return self.problem.boundary


@declared
class TimedMove(Timed, Declared, title="a move"):
    """A move of which the time is sought: the space of its laws, its stroke, its limits and its motion at the ends.

    Raises
    ------
    InputError
        If the problem has limits, an objective or ends of its own or is not convex, or a number is out of range.
    """

    writes_defaults = True
    newer = ("torque", "residual", "end_acceleration", "end_jerk")

    problem: Problem = entry(
        ReadBy(
            lambda given: given if isinstance(given, Problem) else problem_of(given), "a `Problem`", Problem.to_dict
        ),
        "Order, basis, windows and shape of the laws; it bounds none of the limited constants.",
        name="space",
    )
    stroke: float = entry(Number(above=0.0), "How far, in units of which the limits are.")
    limits: MoveLimits = entry(ValueOf(MoveLimits), "What the move must keep.")
    start_velocity: float = entry(Number(), "In units of the stroke a second.", default=0.0)
    end_velocity: float = entry(Number(), "In these units.", default=0.0)
    torque: MotorTorque | None = entry(
        ValueOf(MotorTorque),
        "At the motor, with its limits; only for laws from rest to rest that never turn back.",
        default=None,
    )
    residual: FollowerResidual | None = entry(
        ValueOf(FollowerResidual),
        "The vibration that is left in a follower, with its limit; only from rest to rest.",
        default=None,
    )
    end_acceleration: float = entry(
        Number(), "Of a move that begins at rest, at its end; the order is 3 at least.", default=0.0
    )
    end_jerk: float = entry(Number(), "As the acceleration; the order is 4 at least.", default=0.0)

    def _check(self) -> None:
        if not self.limits.to_dict() and self.torque is None:
            raise InputError(f"limits must name one at least, as in {_EXAMPLE}")
        for name in ("start_velocity", "end_velocity"):
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
        limits = self.limits
        sides = limits.deceleration if self.end_acceleration < 0.0 else limits.acceleration
        for name, least, most in (("end_acceleration", 3, sides), ("end_jerk", 4, limits.jerk)):
            value = getattr(self, name)
            if value and self.start_velocity:
                raise InputError(f"{name} is that of a move which begins at rest: give no start_velocity")
            if value and self.problem.order < least:
                raise InputError(f"{name} needs order >= {least}, got order {self.problem.order}")
            if most is not None and abs(value) > most:
                what = name.removeprefix("end_")
                raise InputError(f"{name} is beyond the limit of the {what}: no move keeps it, however long it takes")

    @kept_property
    def segments(self) -> LimitSegments | None:
        """The motion that no law of any degree is faster than; None where none is known, as with a torque alone.

        A motor is left out, and so is an acceleration or a jerk at the end, with which none is known.
        """
        if not self.concave:
            return None
        ends = self.start_velocity, self.end_velocity
        return segment_times(self.stroke, self.limits, self.problem.order, ends, forward=self.problem.monotone)

    @property
    def limit_breaks(self) -> tuple[float, ...]:
        """Breaks of pieces of degree 3 that reach the limit, 1/2 among them; empty where no segments are known."""
        segments = self.segments
        if segments is None or not segments.are_reached or self.torque is not None:
            return ()
        return tuple(sorted([0.5, *(k for k in segments.breaks if abs(k - 0.5) > MIRROR)]))

    @kept_property
    def best_possible(self) -> float | None:
        """The time that no law of any degree is faster than; within a torque, that no law which never turns back is."""
        known = [0.0 if self.segments is None else self.segments.duration, self.limit_of_torque or 0.0]
        if self.at_rest:
            known.append(time_of_any_law(self.stroke, self.limits, self.problem.order) or 0.0)
        return max(known) or None

    @kept_property
    def limit_of_torque(self) -> float | None:
        """The time in the phase plane of the torque that no law is faster than; None where nothing is known."""
        if self.torque is None:
            return None
        sides = [limit for limit in (self.limits.acceleration, self.limits.deceleration) if limit is not None]
        # a bound of both ways is the greater one, so that none of the laws is left out
        acceleration = max(sides) / self.stroke if len(sides) == 2 else inf
        velocity = inf if self.limits.velocity is None else self.limits.velocity / self.stroke
        return self.torque.limit(velocity, acceleration)

    @property
    def begin(self) -> float:
        return max(self.best_possible or 0.0, self.least_conceivable()) or 1.0

    @property
    def at_rest(self) -> bool:
        return self.start_velocity == self.end_velocity == 0.0 and self.concave

    @property
    def concave(self) -> bool:
        return self.end_acceleration == self.end_jerk == 0.0

    @property
    def stays_possible(self) -> bool:
        if self.torque is None:
            return self.at_rest
        greatest = inf if self.limits.velocity is None else self.limits.velocity / self.stroke
        return self.torque.grows_possible and self.torque.brakes_with_load(greatest)

    @property
    def along(self) -> tuple[SpanLimit, ...]:
        """The limits of the law with stroke 1."""
        torques = () if self.torque is None else self.torque.along()
        left = () if self.residual is None else (self.residual.along(self.stroke),)
        return (*self.limits.along(self.stroke), *torques, *left)

    def limits_over(self, shortest: float, longest: float) -> tuple[TimedLimit, ...]:
        """Limits of every law from rest to rest that keeps the move's limits in some time of an interval.

        Limits that hold in a time hold in every longer one, except that of the residual vibration.
        """
        if self.residual is None:
            return self.limits_in(longest)
        left = self.residual.limit_over(shortest, longest, self.stroke, *self._sizes_in(longest))
        return (*self.without_residual.limits_in(longest), *((left,) if left.bound < inf else ()))

    def _sizes_in(self, duration: float) -> tuple[float, float]:
        # a priori bounds of laws within the limits: the integrals of |k - 1/2| |b| and of |k - 1/2| |c|
        most = {limit.constant: limit.bound for limit in self.without_residual.limits_in(duration)}
        smooth = getattr(self.problem.basis, "continuity", 2) >= 2
        velocity, jerk = 0.25 * most.get(B, inf), most.get(J, inf) if smooth else inf
        up, down = (most.get(side, most.get(C, inf)) for side in (C_plus, C_minus))
        # what is gained is lost again: the integral of |c| is at most twice that of one side; and c vanishes somewhere
        acceleration = min(0.25 * max(up, down), up, down, 0.25 * jerk)
        return min(velocity, 0.5) if self.problem.monotone else velocity, acceleration

    @property
    def without_residual(self) -> TimedMove:
        return replace(self, residual=None)

    @property
    def _lowest(self) -> SpanLimit:
        return min(self.rates, key=lambda limit: limit.nu)

    def _ends(self, powers: Powers) -> BoundaryConditions | None:
        if self.at_rest:
            return None
        start, end = (
            [rates[side] * powers[i] / self.stroke if rates[side] else 0.0 for i, rates in enumerate(self.moving)]
            for side in (0, 1)
        )
        return BoundaryConditions((0.0, *start), (1.0, *end))

    @property
    def moving(self) -> tuple[tuple[float, float], ...]:
        """Velocity, acceleration and jerk at both ends, as many as the order has conditions."""
        given = ((self.start_velocity, self.end_velocity), (0.0, self.end_acceleration), (0.0, self.end_jerk))
        count = self.problem.order - 1
        return (*given, *((0.0, 0.0),) * count)[:count]

    def least_conceivable(self) -> float:
        """A time that no motion is faster than, by the lowest derivative that is limited and the velocity at an end."""
        if not self.rates:
            return 0.0
        nu, (constant, rate) = self._lowest.nu, self._lowest.term(1.0)
        # a deceleration alone bounds what is covered before the end, all others what is covered after the start
        velocity = self.end_velocity if constant == C_minus else self.start_velocity
        start = 0.0 if nu == 1 else max(velocity, 0.0) / self.stroke

        def too_short(duration: float) -> bool:
            return start * duration + rate * power(duration, nu) / factorial(nu) <= 1.0

        high: float = (factorial(nu) / rate) ** (1.0 / nu)
        while too_short(high):
            high = nextafter(high, inf)
        return bisect(too_short, 0.0 if start else nextafter(high, 0.0), high)[1]


def _checked(problem: Problem, *, even: bool) -> Problem:
    # where limits or ends differ, its laws need not be symmetric
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


#: of the motion: the order of the derivative, and the constant of the law
RATES: dict[str, tuple[int, Functional]] = {
    "velocity": (1, B),
    "acceleration": (2, C),
    "jerk": (3, J),
    "snap": (4, snap),
    "rms acceleration": (2, rms_c),
    "rms jerk": (3, rms_j),
    "rms snap": (4, rms_snap),
}
#: at a motor, with the unit
AT_MOTOR = {"torque": "N m", "rms torque": "N m", "energy": "J"}
#: what is left vibrating in a follower
OBJECTIVES = (*RATES, *AT_MOTOR, *RESIDUALS)
_SMOOTH = 3


@declared
class MoveObjective(Declared, title="what is least in a move"):
    """An objective of a move of given time.

    Raises
    ------
    InputError
        If the name is unknown, or there is not what it needs and nothing else.

    >>> MoveObjective("acceleration").in_time(0.2, stroke=0.1)
    TimedLimit(name='acceleration', constant=C, bound=0.4)
    """

    writes_defaults = True

    name: str = entry(Choice(*OBJECTIVES), "What is least.")
    torque: MotorTorque | None = entry(
        ValueOf(MotorTorque), "At the motor; its limit is 1 N m and says nothing.", default=None
    )
    way: float | None = entry(Number(above=0.0), "Of an energy: how far the motor turns, rad.", default=None)
    regeneration: float = entry(
        Number(least=0.0, most=1.0), "Of an energy: the share of the braking energy that is fed back.", default=0.0
    )
    residual: FollowerResidual | None = entry(
        ValueOf(FollowerResidual), "What is left vibrating; its limit is 1 and says nothing.", default=None
    )

    def _check(self) -> None:
        needs = (self.name in AT_MOTOR, self.name == "energy", self.name in RESIDUALS)
        if needs != (self.torque is not None, self.way is not None, self.residual is not None):
            raise InputError(f"{self.named}: the {self.name} needs its motor or its follower, and nothing else")
        if self.torque is not None and (self.torque.peak, self.torque.rms) != (None, 1.0):
            raise InputError(f"{self.named}: its torque has the limit 1 N m of its root mean square alone")
        if self.residual is not None and (self.residual.most, self.residual.name) != (1.0, self.name):
            raise InputError(f"{self.named}: its residual is the {self.name}, with the limit 1")
        if self.regeneration and self.way is None:
            raise InputError(f"{self.named}: regeneration is a share of an energy, got {self.regeneration!r}")

    def in_time(self, duration: float, stroke: float) -> TimedLimit:
        """The constant of the law that is minimised, and its unit in SI."""
        if self.name in RATES:
            nu, of = RATES[self.name]
            return TimedLimit(self.name, of, power(duration, nu) / stroke)
        if self.residual is not None:
            return self.residual.limit_in(duration, stroke)
        assert self.torque is not None  # noqa: S101 - as was checked
        text, unit = self.torque.text(duration), duration * duration / self.torque.unit
        if self.way is None:
            return TimedLimit(self.name, (rms if self.name == "rms torque" else peak)(text), unit)
        taken = f"({text})*b"
        braked = f"{self.regeneration!r}*{taken}" if self.regeneration else "0"
        energy = taken if self.regeneration == 1.0 else f"max({taken}, {braked})"
        return TimedLimit(self.name, integral(energy), unit / self.way)

    def problem(self, move: TimedMove, duration: float) -> Problem:
        """The problem of the laws that keep the limits of a move in a time, with what is least in it."""
        return replace(move.within(duration), minimise=self.in_time(duration, move.stroke).constant)

    @property
    def nu(self) -> int:
        """A law takes this power of s less where it is played s times as long, at least; 0 of torques and energy."""
        return RATES[self.name][0] if self.name in RATES else 0

    def falls(self, move: TimedMove) -> bool:
        """Whether a longer time never needs more: docs/how-to/least-time.md."""
        if not move.at_rest or move.residual is not None or self.residual is not None:
            return False
        if move.torque is not None and not move.torque.grows_possible:
            return False
        if self.torque is None:
            return True
        inertia, load = (constant(read(text, ("a",))) for text in (self.torque.inertia, self.torque.load))
        if inertia is None or load is None or self.torque.gear is not None:
            return False
        if self.name == "torque":
            return self.torque.friction == 0.0 or load >= 0.0 or move.problem.order >= _SMOOTH
        return self.torque.friction == 0.0 or load >= 0.0
