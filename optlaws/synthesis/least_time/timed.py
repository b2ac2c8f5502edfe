"""What a search of a least time knows of a motion: the space of its laws, and limits that depend on the time."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from math import comb

from optlaws.laws import MotionLaw
from optlaws.synthesis.least_time.follower_residual import FollowerResidual
from optlaws.synthesis.least_time.move_limits import RateLimit, TimedLimit
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.expression import Expression, maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range, at_most
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

_HIGHEST = 4

#: a time to the powers 1 to 4, or what stands for them in a Bernstein form
Powers = tuple[float, ...]


class Timed(ABC):
    """A motion of which the time is sought; unless it says otherwise, its ends are in every time those of its problem.

    `problem` is the space of its laws, without its limits.
    """

    problem: Problem

    @property
    @abstractmethod
    def rates(self) -> tuple[RateLimit, ...]:
        """The limits of derivatives of the law with stroke 1, in 1/s^nu."""

    @property
    @abstractmethod
    def of_rates(self) -> bool:
        """Whether these are all limits, so that the multipliers of one time speak of all times."""

    @property
    @abstractmethod
    def stays_possible(self) -> bool:
        """Whether a law that keeps all limits but the residual's keeps them in every longer time."""

    @property
    @abstractmethod
    def begin(self) -> float:
        """A time in which the search may begin: where it is known, one that is too short by little."""

    @abstractmethod
    def limits_in(self, duration: float) -> tuple[TimedLimit, ...]:
        """Every limit in a time, as a bound of a constant of the law."""

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
        """The motion without that limit."""
        return self

    def least_conceivable(self) -> float:
        """A time that no motion is faster than."""
        return 0.0

    def limits_over(self, shortest: float, longest: float) -> tuple[TimedLimit, ...]:  # noqa: ARG002 - of vibrations
        """Limits of every law from rest to rest that keeps the motion's limits in some time of an interval."""
        return self.limits_in(longest)

    def greatest_share(self, law: MotionLaw, duration: float) -> float:
        """The greatest share of a limit that a law takes in a time."""
        return max(limit.constant.value(law) / limit.bound for limit in self.limits_in(duration))

    def within(self, duration: float, shortest: float | None = None) -> Problem:
        """The problem of the laws that keep every limit in a time: its ends, and bounds B <= v T/h, C <= a T²/h.

        With a shortest time it is a problem of every law that keeps them in some time between these two.

        Examples
        --------
        >>> from optlaws.synthesis.least_time.timed_move import MoveLimits, TimedMove
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
        >>> from optlaws.synthesis.least_time.timed_move import MoveLimits, TimedMove
        >>> move = TimedMove(Problem(order=3), 1.0, MoveLimits(jerk=1.0), end_velocity=1.0, end_acceleration=0.5)
        >>> [each.range("J").high for each in move.within_control_points(1.0, 2.0)]
        [1.0, 2.0, 4.0, 8.0]
        """
        ends = (nu for nu, rates in enumerate(self.moving, start=1) if any(rates))
        degree = max([2, *ends, *(limit.nu for limit in self.rates)])
        points = [control_point(shortest, longest, i, degree) for i in range(degree + 1)]
        return [self._within(self._limits_of_rates(powers), powers) for powers in points]

    def shares(self, duration: float, ends: Powers | None = None, shortest: float | None = None) -> Problem:
        """The problem of the least greatest share of the limits in a time; with the ends of other powers if given.

        With a shortest time the limits are those of all times between.

        Examples
        --------
        >>> from optlaws.synthesis.least_time.timed_move import MoveLimits, TimedMove
        >>> TimedMove(Problem(order=3), 1.0, MoveLimits(velocity=1.0, jerk=1.0)).shares(2.0).minimise
        'max(0.5*B, 0.125*J)'
        """
        limits = self.limits_in(duration) if shortest is None else self.limits_over(shortest, duration)
        parts = [limit.constant / limit.bound for limit in limits]
        objective: Expression = maximum(*parts).expression() if len(parts) > 1 else parts[0]
        return replace(
            self.problem, boundary=self._ends(powers_of(duration) if ends is None else ends), minimise=objective
        )

    def _limits_of_rates(self, powers: Powers) -> tuple[TimedLimit, ...]:
        return tuple(TimedLimit(limit.name, limit.constant, limit.rate * powers[limit.nu - 1]) for limit in self.rates)

    def _within(self, limits: Sequence[TimedLimit], powers: Powers) -> Problem:
        bounds: dict[object, Range] = dict(self.problem.bounds)
        most: dict[Functional, float] = {}
        for limit in limits:
            most[limit.constant] = min(limit.bound, most.get(limit.constant, limit.bound))
        bounds.update((constant, at_most(bound)) for constant, bound in most.items())
        return replace(self.problem, boundary=self._ends(powers), bounds=bounds)

    def _ends(self, powers: Powers) -> BoundaryConditions | None:  # noqa: ARG002 - of ends that move
        """The motion at the ends as a law of a time with these powers has it."""
        return self.problem.boundary


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
