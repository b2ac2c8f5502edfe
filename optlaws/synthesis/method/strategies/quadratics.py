"""Integrals with kinks or without convexity: a linear program finds the kinks, quadratic programs the optimum."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.curved import IntegralFamily
from optlaws.synthesis.families.family import Points, Program
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.method.discretised.grids import with_extrema
from optlaws.synthesis.method.discretised.ipopt import Answer
from optlaws.synthesis.method.discretised.quadratic_steps import stepwise_on_points
from optlaws.synthesis.method.discretised.straight import straight_optimum
from optlaws.synthesis.method.strategies.identified import as_answered, optimum_near
from optlaws.synthesis.method.strategies.strategy import Strategy
from optlaws.tolerances import EXCESS, STEP_SETTLED

_STEP_OF_SMOOTH = 1e-2  # the same where formulas without kinks stand for those with
_STEP_SHOWS_CONTACTS = 1e-4  # the same: after one that is less Newton's method may find the exact contacts

#: how far a linear program may go, in times the greatest variable: beyond what laws of the field have
_REACH = 1e4
#: places of an integral in the first linear program, and in further ones where that does not show the kinks
_PLACES = (160, 640)
_ROUNDS = 14
#: the radius of kinks that are made smooth, as a share of the integral
_RADIUS = 0.2


def bends_both_ways(program: Program) -> bool:
    """Whether a program contains an integral with kinks or without convexity.

    Interior points lose their way there; quadratic programs never leave the start for a worse law.
    """
    integrals = (family for family in program.families if isinstance(family, IntegralFamily))
    return any(isinstance(family, KinkedIntegralFamily) or not family.convex for family in integrals)


@dataclass(eq=False)
class ByQuadratics(Strategy[list[Points], ActiveSet]):
    """The optimum on the points by quadratic programs, round by round.

    Attributes
    ----------
    program
        What is solved.
    x
        Where the next round begins.
    holds
        Checks from x alone, faster than the families do, whether every constraint holds.
    straight
        Whether a linear program shows the kinks first; else, near an optimum, smooth formulas do.
    count, iterations, answer
        The rounds and the quadratic programs so far, and where these led.
    """

    program: Program
    x: Array
    holds: Callable[[Array], bool] | None = None
    rounds: int = _ROUNDS
    straight: bool = True
    count: int = 0
    iterations: int = 0
    answer: Answer | None = None

    def answered(self, points: list[Points]) -> tuple[ActiveSet | None, list[Points] | None]:
        """The optimum, or the points with the extrema of the answer; neither if the step fails."""
        if self.count == 0 and not self.straight:
            self._smoothed(points)
        if self.count == 0 and self.straight:
            optimum, points = self._straightened(points)
            if optimum is not None:
                return optimum, None
        self.count += 1
        self._stepped(points, _STEP_SHOWS_CONTACTS)
        optimum = self._shown(points)
        if optimum is None:
            self._stepped(points, STEP_SETTLED)
            optimum = self._shown(points)
        answer = self.answer
        if optimum is not None or answer is None:
            return optimum, None
        onward = with_extrema(self.program, points, answer.x)
        known = all(len(new.u) == len(old.u) for new, old in zip(onward, points, strict=True))
        if (known or answer.success) and self.program.violation(answer.x) <= EXCESS:
            # an optimum may be so flat that no exact active set shows
            return as_answered(points, answer), None
        return (None, None) if known else (None, onward)

    def _straightened(self, points: list[Points]) -> tuple[ActiveSet | None, list[Points]]:
        """The optimum that linear programs show, each with more places; or the points with the extrema of the last."""
        reach = _REACH * max(1.0, float(np.abs(self.x).max()))
        for places in _PLACES:
            self.answer = straight_optimum(self.program, points, self.x, reach=reach, places=places)
            if self.answer is None:
                break
            self.x, self.iterations = self.answer.x, self.iterations + self.answer.iterations
            optimum = self._shown(points)
            if optimum is not None:
                return optimum, points
            points = with_extrema(self.program, points, self.x)
        return None, points

    def _smoothed(self, points: list[Points]) -> None:
        """Some steps with integrals of smooth formulas, whose kinks are not in the way yet."""
        if not any(isinstance(family, KinkedIntegralFamily) for family in self.program.families):
            return
        families = tuple(
            family.rounded(_RADIUS, self.x) if isinstance(family, KinkedIntegralFamily) else family
            for family in self.program.families
        )
        answer = stepwise_on_points(replace(self.program, families=families), points, self.x, _STEP_OF_SMOOTH)
        if answer is not None:
            self.x, self.iterations = answer.x, self.iterations + answer.iterations

    def _stepped(self, points: list[Points], settled: float) -> None:
        """The answer that quadratic programs lead to, until a step is less than a share of the variables."""
        self.answer = stepwise_on_points(self.program, points, self.x, settled)
        if self.answer is not None:
            self.x, self.iterations = self.answer.x, self.iterations + self.answer.iterations

    def _shown(self, points: list[Points]) -> ActiveSet | None:
        """The optimum that the answer is near to."""
        return None if self.answer is None else optimum_near(self.program, self.holds, points, self.answer)
