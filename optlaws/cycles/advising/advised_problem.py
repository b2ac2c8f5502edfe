"""A dimensionless problem whose laws are compared: its constants, and the standard laws within its bounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf
from typing import Any

from optlaws.cycles.advising.advised_law import AdvisedLaw, LawMeasure, ProvenLeast
from optlaws.cycles.advising.further_bounds import least_near, with_most
from optlaws.cycles.limit_rows import LimitTaken
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.reading import read_law
from optlaws.synthesis.least_time.follower_residual import RESIDUAL
from optlaws.synthesis.problem.constants import B, C, D, Functional, J, rms_c
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.evaluation import evaluate
from optlaws.synthesis.solve import synthesize

_CONSTANTS: dict[str, tuple[Functional, str]] = {
    "velocity": (B, "h/T"),
    "acceleration": (C, "h/T²"),
    "jerk": (J, "h/T³"),
    "rms acceleration": (rms_c, "h/T²"),
    "power": (D, "h²/T³"),
}


@dataclass(frozen=True)
class AdvisedProblem:
    """A dimensionless problem, with the follower that its motion leaves vibrating; laws are compared within it.

    Attributes
    ----------
    problem
        As it is given.
    residual
        The residual acceleration of the follower as a constant of the law, or None.
    """

    problem: Problem
    residual: Functional | None = None

    @property
    def minimise(self) -> str:
        """The measure that is to be least."""
        terms = self.problem.objective.terms
        constant = terms[0][1] if len(terms) == 1 and terms[0][0] == 1.0 else None
        names = [name for name, known in self._constants.items() if known == constant]
        return names[0] if names else self.problem.titled(str(self.problem.minimise))

    @kept_property
    def _constants(self) -> dict[str, Functional]:
        known = {name: constant for name, (constant, _) in _CONSTANTS.items()}
        return known if self.residual is None else {**known, RESIDUAL: self.residual}

    @property
    def measures(self) -> tuple[LawMeasure, ...]:
        """Everything that laws are compared by, in units of the stroke h and the time T."""
        units = {name: unit for name, (_, unit) in _CONSTANTS.items()} | {RESIDUAL: "h/T²"}
        names = dict.fromkeys((*self._constants, self.minimise))
        return tuple(LawMeasure(name, units.get(name, "")) for name in names)

    @property
    def limited(self) -> frozenset[str]:
        """The measures that are bounded."""
        bounded = [constant for constant, _ in self.problem.bounded]
        bounded += [B] if self.problem.range("B") is not None else []
        return frozenset(name for name, constant in self._constants.items() if constant in bounded)

    @property
    def objectives(self) -> tuple[str, ...]:
        """The measures that laws can be least in."""
        names = dict.fromkeys((*self._constants, self.minimise))
        return tuple(name for name in names if name not in {"velocity", "power"} or name == self.minimise)

    @property
    def usual(self) -> None:
        """No name, as the law of a problem is sought."""

    def minimising(self, minimise: str) -> AdvisedProblem:
        """The same problem with another objective: a measure by its name, or an objective of `Problem`.

        Raises
        ------
        InputError
            If nothing of this name can be minimised.
        """
        objective = self._constants.get(minimise, minimise)
        return replace(self, problem=replace(self.problem, minimise=objective))

    def given(self) -> None:
        """No laws, as the law of a problem is sought."""

    def standard(self, name: str) -> AdvisedLaw:
        """A law of the catalogue, with its use of the bounds.

        Raises
        ------
        InputError
            If the problem's ends are not at rest.
        """
        if self.problem.boundary is not None:
            raise InputError("a law of the catalogue goes from rest to rest, and the problem does not")
        return self._advised(name, "standard", read_law(name))

    def least(self, name: str, minimise: str, most: Mapping[str, float]) -> AdvisedLaw:
        """The law that is least in a measure and takes no more of others, within all bounds.

        Raises
        ------
        InfeasibleProblem, SolverFailure
            If no law satisfies all of that, or the search fails.
        """
        problem = self.problem
        for other, value in most.items():
            problem = with_most(problem, self._constants[other], value)
        if minimise != self.minimise:
            constant = self._constants[minimise]
            problem = replace(problem, minimise=constant, symmetric=problem.symmetric and constant.even)
        return self._solved(name, minimise, problem)

    def near(self, name: str, best: AdvisedLaw, minimise: str, share: float) -> AdvisedLaw:
        """The law that is least in one measure among all laws within a share of an optimum of another measure.

        Raises
        ------
        InputError
            If what is least there is a sum of constants.
        InfeasibleProblem, SolverFailure
            If the search fails.
        """
        return self._solved(name, minimise, least_near(best.solutions[0], self._constants[minimise], share))

    def _solved(self, name: str, minimise: str, problem: Problem) -> AdvisedLaw:
        solution = synthesize(problem)
        space = f"laws of order {problem.order} with Z of degree {getattr(problem.basis, 'degree', 0)}"
        proof = ProvenLeast(minimise, solution.lower_bound, solution.limit, space, solution.status)
        return replace(self._advised(name, "optimal", solution.law), solutions=(solution,), proof=proof)

    def _advised(self, name: str, kind: Any, law: MotionLaw) -> AdvisedLaw:  # noqa: ANN401
        values = {measure: float(constant.value(law)) for measure, constant in self._constants.items()}
        values.setdefault(self.minimise, evaluate(self.problem, law).objective)
        return AdvisedLaw(name, kind, law, values, tuple(self._limits(law)))

    def _limits(self, law: MotionLaw) -> list[LimitTaken]:
        velocity, problem = self.problem.range("B"), self.problem
        bounded = [*([] if velocity is None else [(B, velocity)]), *problem.bounded]
        names = {constant: name for name, constant in self._constants.items()}
        taken = [
            LimitTaken(
                names.get(constant, constant.title), "", float(constant.value(law)), limits.high, f"{limits.high:.6g}"
            )
            for constant, limits in bounded
            if limits.high < inf
        ]
        excess = evaluate(replace(problem, B=None, C=None, D=None, J=None, bounds={}), law).excess
        if problem.windows or problem.monotone:
            taken.append(LimitTaken("windows", "", 1.0 + max(excess, 0.0), 1.0, ""))
        return taken
