"""Problems that were solved together: their laws, numbers and proofs, all at once or one by one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.numerics.tolerances import OPTIMALITY_GAP
from optlaws.synthesis.arrays.solved_batch import NO_CONTACT, SolvedBatch
from optlaws.synthesis.families.peaks import constant_of_series
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.certificate import OBJECTIVE, Certificate
from optlaws.synthesis.proof.make import certificate, certify
from optlaws.synthesis.search import status_of
from optlaws.synthesis.solution import Solution, Status, measure, partly_known
from optlaws.synthesis.spaces.bases import PolynomialBasis
from optlaws.synthesis.spaces.polynomials.space import PolynomialSpace
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.synthesis.spaces.splines import PiecewiseBasis


@dataclass(frozen=True, eq=False)
class SolvedPart:
    """Problems of one kind that were solved together: which, their program but for numbers, and their optima."""

    places: NDArray[np.intp]
    model: Model
    found: SolvedBatch

    @property
    def coordinates(self) -> Array:
        """The coordinates of each law."""
        return self.found.x[:, : self.model.space.terms]

    @property
    def statuses(self) -> NDArray[np.object_]:
        """Optimal, but where the problem is not convex and the bound does not meet the objective."""
        optimal = np.full(len(self.places), Status.OPTIMAL, dtype=object)
        if self.model.problem.convex:
            return optimal
        off = np.abs(self.found.objective - self.found.bound) > OPTIMALITY_GAP * measure(
            self.found.objective, self.model.problem.objective.scale
        )
        optimal[off] = Status.LOCAL
        return optimal

    @property
    def z_series(self) -> Array:
        """Chebyshev coefficients of Z in 2k - 1, law by law."""
        space = self.model.space
        base = space.z_series(np.zeros(space.terms))
        columns = np.array([space.z_series(unit) for unit in np.eye(space.terms)]).reshape(space.terms, -1)
        return np.asarray(self.coordinates @ (columns - base) + base)

    @property
    def z(self) -> Array:
        """Coefficients of Z in the problems' basis, law by law."""
        basis = self.model.problem.basis
        if not isinstance(basis, PolynomialBasis | PiecewiseBasis):
            return np.empty((len(self.places), 0))
        return np.array([basis.coefficients(series) for series in self.z_series])

    def constant(self, name: str, *, one_objective: bool) -> Array:
        """A constant of each law; `one_objective` says that all minimise what the first does."""
        if one_objective and repr(self.model.problem.objective) == name:
            return self.found.objective
        space = self.model.space
        if not isinstance(space, PolynomialSpace):
            return np.array([constant_of(space.law(coordinate), name) for coordinate in self.coordinates])
        laws = [space.series(nu) for nu in (1, 2, 3)]
        b, c, j = (self.coordinates @ series[:, :-1].T + series[:, -1] for series in laws)
        return constant_of_series(name, b, c, j)

    @property
    def contacts(self) -> dict[str, NDArray[Any]]:
        """Where rows bind, as columns of the laws' contacts."""
        laws = self.found
        names = np.array([*(family.name for family in self.model.program.families), ""], dtype=object)
        none = laws.family == NO_CONTACT
        k = np.full(laws.u.shape, np.nan)
        for i, family in enumerate(self.model.program.families):
            mine = laws.family == i
            k[mine] = np.clip(family.k(laws.u[mine]), 0.0, 1.0)
        rows: dict[str, NDArray[Any]] = {"constraint": names[laws.family], "k": k}
        rows["sign"] = np.where(none, np.nan, laws.sign)
        # of the problem's own rows, as certificates have them
        units = np.array([*(self.model.unit / family.unit for family in self.model.program.families), 1.0])
        rows["multiplier"] = np.where(none, np.nan, laws.multiplier * units[laws.family])
        return rows

    def solution(self, row: int, problem: Problem, seconds: float) -> Solution:
        """The solution of a row, of which only what the array holds is there before it is asked for."""
        model, bound = self.model, float(self.found.bound[row])

        def lower_bound(solution: Solution) -> float:
            return max(bound, -inf if solution.limit is None else solution.limit)

        def proof(solution: Solution) -> Certificate:
            own = replace(model, problem=problem)
            if problem.convex:
                return certificate(own, solution.active_set, OBJECTIVE)
            return certify(own, solution.active_set, solution.objective, solution.limit)

        objective = float(self.found.objective[row])
        known = {
            "problem": problem,
            "objective": objective,
            "iterations": 0,
            "seconds": seconds,
            "starts": () if problem.convex else (objective,),
        }
        later: dict[str, Callable[[Solution], Any]] = {
            "active_set": lambda _: self.found.active_set(row),
            "law": lambda solution: model.law(solution.active_set.x),
            "z_series": lambda solution: tuple(model.space.z_series(model.coordinates(solution.active_set.x)).tolist()),
            "certificate": proof,
            "limit": lambda solution: known_limit(solution.problem),
            "lower_bound": lower_bound,
            "status": lambda solution: status_of(
                solution.objective, solution.lower_bound, problem.objective.scale, proven=problem.convex
            ),
        }
        return partly_known(known, later)


def constant_of(law: MotionLaw, name: str) -> float:
    """A constant of one law by its name.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> constant_of(smoothstep(2), "C")
    6.0
    """
    value = getattr(law.constants, name)
    return float(value.value if name in CONSTANTS else value)


def stored_laws(space: LawSpace, coordinates: Array) -> list[dict[str, Any]]:
    """What `law.to_dict()` of each law is; coordinates have a row for each law.

    Examples
    --------
    >>> from optlaws.synthesis import Problem, synthesize
    >>> from optlaws.synthesis.program.writer import model_of
    >>> solution = synthesize(Problem(B=1.7, order=4))
    >>> model = model_of(solution.problem)
    >>> stored_laws(model.space, model.coordinates(solution.active_set.x)[None]) == [solution.law.to_dict()]
    True
    """
    if not isinstance(space, PolynomialSpace) or not len(coordinates):
        return [space.law(row).to_dict() for row in coordinates]
    first = space.law(coordinates[0]).to_dict()
    accelerations, starts = space.laws(coordinates)
    return [
        {**first, "acceleration": _kept(row), "b0": start}
        for row, start in zip(accelerations.tolist(), starts.tolist(), strict=True)
    ]


def _kept(row: list[float]) -> list[float]:
    while row and row[-1] == 0.0:
        row.pop()
    return row
