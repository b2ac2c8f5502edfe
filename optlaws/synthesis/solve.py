"""synthesize(problem) -> Solution: least peak acceleration at a given peak velocity, with proof."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import ceil, floor
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.synthesis import certificate as proof
from optlaws.synthesis.active_set import ActiveSet
from optlaws.synthesis.certificate import Certificate, Contact
from optlaws.synthesis.exchange import VIOLATION, Outcome, solve
from optlaws.synthesis.limits import acceleration_limit
from optlaws.synthesis.problem import Problem
from optlaws.synthesis.programs import ACCELERATION, BELOW_PEAK, extreme_velocity, least_acceleration, least_violation
from optlaws.synthesis.rows import Program
from optlaws.synthesis.solution import Solution, Status
from optlaws.synthesis.space import symmetric_space

GAP = 1e-8
# what passes without a look at the divided rows, in which a contact pinned to the middle may hide a larger excess
_ROUNDING = 1e-13

Array = NDArray[np.float64]


def synthesize(problem: Problem, *, start: Solution | None = None) -> Solution:
    """Find the law that minimises the problem's constant and prove it.

    Parameters
    ----------
    problem
        What to solve.
    start
        A solution of a neighbouring problem (same order, degree and constraints, another B): its contacts are
        continued by Newton's method and IPOPT is called only where that fails. The answer is the same.

    Returns
    -------
    Solution
        The law, its constants, the lower bound and the limit.

    Raises
    ------
    InfeasibleProblem
        If no law of the problem exists; `proof` is a certificate of that.
    SolverFailure
        If no law could be found although none was shown not to exist.

    Examples
    --------
    >>> solution = synthesize(Problem(B=1.641, order=4))
    >>> round(solution.objective, 8), solution.gap < 1e-8
    (5.08070242, True)
    """
    began = perf_counter()
    _check_types(problem, start)
    program = least_acceleration(problem.order, problem.terms, monotone=problem.monotone)
    warm = start.active_set if start is not None and _neighbours(problem, start.problem) else None
    candidate = _Candidate(problem)
    outcome = solve(program, problem.B, warm, holds=candidate.holds)
    if outcome.optimum is None:
        raise _failure(problem, outcome)
    return _solution(candidate, program, outcome, outcome.optimum, began)


class _Candidate:
    """The law of the coordinates tried last, with what it is worth on the whole interval."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.space = symmetric_space(problem.order, problem.terms)
        self.coordinates: Array = np.empty(0)

    def holds(self, x: Array) -> bool:
        """Whether the law keeps to the velocity constraints, and its C to the one claimed in x."""
        self.coordinates = x[:-1]
        self.law = self.space.law(self.coordinates)
        self.objective = self.law.peak(2).value
        lowest, highest = self.law.extrema(1)
        excess = max(highest.value - self.problem.B, -lowest.value if self.problem.monotone else 0.0)
        self.excess = excess / self.problem.B
        return self.excess <= _ROUNDING and self.objective <= float(x[-1]) * (1.0 + _ROUNDING)


def sweep(problems: Iterable[Problem]) -> Iterator[Solution]:
    """Solve problems in turn, each warm started by the one before it where they are neighbours.

    Examples
    --------
    >>> from dataclasses import replace
    >>> first = Problem(B=1.6, order=4)
    >>> [round(s.objective, 6) for s in sweep(replace(first, B=B) for B in (1.6, 1.62))]
    [5.262224, 5.173677]
    """
    previous: Solution | None = None
    for problem in problems:
        previous = synthesize(problem, start=previous)
        yield previous


def _check_types(problem: object, start: object) -> None:
    if not isinstance(problem, Problem):
        raise InputError(f"synthesize takes a Problem, got {type(problem).__name__}")
    if start is not None and not isinstance(start, Solution):
        raise InputError(f"start must be a Solution of a neighbouring problem, got {type(start).__name__}")


def _neighbours(first: Problem, second: Problem) -> bool:
    return (first.order, first.terms, first.monotone) == (second.order, second.terms, second.monotone)


def _solution(candidate: _Candidate, program: Program, outcome: Outcome, optimum: ActiveSet, began: float) -> Solution:
    problem = candidate.problem
    if candidate.excess > VIOLATION:
        msg = f"the law found breaks a velocity constraint by {candidate.excess:.1e} of B"
        raise SolverFailure(msg, problem=problem, tried=f"IPOPT said {outcome.status!r}")
    found = certify(problem, program, optimum)
    gap = (candidate.objective - found.bound) / candidate.objective
    return Solution(
        problem=problem,
        law=candidate.law,
        z_series=tuple(candidate.space.z_series(candidate.coordinates).tolist()),
        objective=candidate.objective,
        certificate=found,
        limit=acceleration_limit(problem.B, monotone=problem.monotone, order=problem.order),
        status=Status.OPTIMAL if gap <= GAP else Status.INACCURATE,
        iterations=outcome.iterations,
        seconds=perf_counter() - began,
        active_set=optimum,
    )


def certify(problem: Problem, program: Program, optimum: ActiveSet) -> Certificate:
    """Turn contacts and multipliers of the program into a certificate that speaks of the law itself."""
    contacts = [Contact(proof.MIDDLE, 0.5, optimum.equality_multiplier)]
    space = symmetric_space(problem.order, problem.terms)
    for i, family in enumerate(program.families):
        mine = np.flatnonzero(optimum.family == i)
        for j, k in zip(mine, family.k(optimum.u[mine]), strict=True):
            multiplier = float(optimum.multipliers[j])
            if family.name == ACCELERATION:
                name = proof.UPPER if optimum.s[j] > 0 else proof.LOWER
            elif family.name == BELOW_PEAK:
                name = proof.CHORD
            else:
                name, multiplier = proof.RATIO, multiplier / space.base_ratio
            contacts.append(Contact(name, float(k), multiplier))
    return Certificate(problem.order, problem.basis.degree, problem.B, problem.monotone, tuple(contacts))


def _failure(problem: Problem, outcome: Outcome) -> InfeasibleProblem | SolverFailure:
    tried = (
        f"IPOPT said {outcome.status!r} after {outcome.iterations} iterations in {outcome.rounds} rounds of exchange"
    )
    elastic = least_violation(problem.order, problem.terms, monotone=problem.monotone)
    trial = solve(elastic, problem.B)
    if trial.optimum is not None:
        found = certify(problem, elastic, trial.optimum)
        if found.proves_infeasible:
            return InfeasibleProblem(_why(problem), problem=problem, proof=found, tried=_contradiction(found))
        tried += f"; the constraints leave {-trial.optimum.x[-1]:.3e} to spare"
    msg = "no law was found, and none was shown not to exist; try a degree higher or lower by 2, or another B"
    return SolverFailure(msg, problem=problem, tried=tried)


def _contradiction(found: Certificate) -> str:
    places = ", ".join(f"{contact.k:.4g}" for contact in found.contacts if contact.constraint != proof.MIDDLE)
    return f"the constraints contradict each other at k = {places} (error.proof is the certificate)"


def _why(problem: Problem) -> str:
    broken = "0 <= b <= B" if problem.monotone else "b <= B"
    return (
        f"no law of order {problem.order} with Z of degree {problem.basis.degree} has b(1/2) = B = {problem.B:g} "
        f"and {broken} everywhere: with b(1/2) = B its velocity breaks this elsewhere. "
        f"A higher degree of Z or a lower order helps; so does {_possible(problem)}"
    )


def _possible(problem: Problem) -> str:
    """Which B this order and degree can have, to six digits, inward."""
    low, high = (
        solve(extreme_velocity(problem.order, problem.terms, monotone=problem.monotone, greatest=greatest), 0.0).optimum
        for greatest in (False, True)
    )
    least = f"from {ceil(low.x[-1] * 1e6) / 1e6:.7g}" if low is not None else ""
    greatest = f"up to {floor(high.x[-1] * 1e6) / 1e6:.7g}" if high is not None else ""
    return f"a B {' '.join(part for part in (least, greatest) if part) or 'nearer to 2'}"
