"""The number that runs along a proven front, and whether laws and bounds between two of its values are known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.suggest import unknown_key
from optlaws.synthesis.problem.constants import ALIASES, FUNCTIONALS, MAKERS, Functional
from optlaws.synthesis.problem.expression import Expression, Term
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.named_constants import named
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range

#: before the name of a term of the objective: its weight runs
WEIGHT = "weight of "


@dataclass(frozen=True)
class RunningNumber:
    """A peak velocity, an upper bound of a constant or a weight of the objective, in a problem that is convex in it.

    B and bounds stand on the right side of rows, so that the least objective is convex in them: laws between two laws
    keep the bounds between, and a certificate bounds the objective at every value. Weights stand in the objective, so
    that it is the other way round: a law is one at every weight, and certificates may be averaged.

    Parameters
    ----------
    problem
        What else is asked.
    name
        "B", which is given as a number; "C", "J", "rms_c" or another constant, which is bounded from above; or
        "weight of C", the weight of a term of the objective.

    Raises
    ------
    InputError
        If there is no such number, the problem gives it already, or it is not convex.

    Examples
    --------
    >>> number = RunningNumber(Problem(order=4), "rms_c")
    >>> number.at(3.7)
    Problem(B=None, order=4, basis=Chebyshev(degree=9), minimise='C', bounds={'rms_c': at_most(3.7)})
    """

    problem: Problem
    name: str

    def __post_init__(self) -> None:
        if self.concave:
            self._weighted(1.0)
        else:
            self._check_free()
        _check_convex(self.at(2.0))

    @property
    def concave(self) -> bool:
        """Whether the least objective is concave in the number: of weights."""
        return self.name.startswith(WEIGHT)

    def at(self, value: float) -> Problem:
        """The problem at a value of the number.

        Raises
        ------
        InputError
            If it can have no such value.
        """
        if self.concave:
            return replace(self.problem, minimise=self._weighted(value))
        if self.name == "B":
            return self._at_two.at_velocity(value)
        bounds: Mapping[Any, Any] = {**self.problem.bounds, self._constant: Range(0.0, value)}
        return replace(self.problem, bounds=bounds)

    @kept_property
    def _at_two(self) -> Problem:
        return replace(self.problem, B=2.0)

    @property
    def weighted(self) -> Term:
        """The term of the objective whose weight runs."""
        return self.problem.objective.terms[self._place][1]

    @property
    def _constant(self) -> Functional:
        known = FUNCTIONALS | ALIASES
        if "(" in self.name:
            return named(self.name)
        if self.name not in known:
            raise InputError(unknown_key(self.name, (*known, *MAKERS), "constant"))
        return known[self.name]

    def _check_free(self) -> None:
        name = self._constant.name
        if self.problem.range(name) is not None:
            given = getattr(self.problem, name) if name in CONSTANTS else self.problem.range(name)
            raise InputError(f"{name} runs: leave it out of the problem, got {given!r}")

    @property
    def _place(self) -> int:
        wanted = self.name.removeprefix(WEIGHT)
        known = [repr(term) for _, term in self.problem.objective.terms]
        if len(known) < 2:
            raise InputError(f"a weight runs in an objective of several terms, got {self.problem.objective!r}")
        if wanted not in known:
            raise InputError(unknown_key(wanted, known, "term of the objective"))
        return known.index(wanted)

    def _weighted(self, weight: float) -> Expression:
        """The objective with another weight of the term."""
        changed = list(self.problem.objective.terms)
        changed[self._place] = (weight, self.weighted)
        return Expression(tuple(changed))


def _check_convex(problem: Problem) -> None:
    """Refuse problems whose laws between two laws may be none of it: with D, or with peaks bounded from below."""
    for constant in sorted(problem.constants, key=repr):
        if not constant.convex:
            raise InputError(
                f"{constant.title} is not convex, so that two laws prove nothing of the laws between: pareto_front "
                "exchanges it point by point"
            )
        asked = problem.range(constant.name)
        if constant.name != "B" and asked is not None and asked.low > 0.0:
            raise InputError(
                f"{constant.title} is bounded from below, which laws between two need not keep: bound it from above"
            )
    velocity = problem.range("B")
    if velocity is not None and velocity.low > 0.0 and problem.peak_at is None:
        raise InputError(
            f"B = {problem.B!r} says nothing of the place of the peak velocity, and laws between two laws need not "
            "have it: give inflexion, or at_most"
        )
