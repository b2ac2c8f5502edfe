"""Proofs that a problem has no law, including proofs computed for other problems."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import isfinite
from typing import Any, NamedTuple

from optlaws.errors import InputError
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.tolerances import VALUE_ROUNDING


class Ground(NamedTuple):
    """The reason why a problem has no law: the subject of the proof, and the value that its bound must exceed."""

    problem: Problem  #: what the proof is of
    #: a bound that is asked of a constant, which no law keeps whose least value is greater; None where the constraints
    #: themselves contradict each other
    above: float | None


def convex_part(problem: Problem) -> Problem:
    """The problem without the bounds that are not convex: what contradicts itself there does so with them too.

    >>> convex_part(Problem(B=1.7, order=4, D=(0.0, 6.0)))
    Problem(B=1.7, order=4, basis=Chebyshev(degree=9), minimise='C')
    """
    convex_bounds = {constant: limits for constant, limits in problem.bounded if constant.convex}
    if len(convex_bounds) == len(problem.bounded):
        return problem
    return replace(problem, C=None, D=None, J=None, bounds=convex_bounds)


def least_of(problem: Problem, constant: Functional) -> Problem:
    """The problem of the least value of a bounded constant under all other constraints.

    >>> from optlaws import D
    >>> least_of(Problem(B=1.7, order=4, D=(0.0, 2.0)), D)
    Problem(B=1.7, order=4, basis=Chebyshev(degree=9), minimise='D')
    """
    if constant.name in CONSTANTS:
        free: dict[str, Any] = {constant.name: None}
        return replace(problem, minimise=constant.expression(), **free)
    others = {other: limits for other, limits in problem.bounds.items() if other != constant}
    return replace(problem, minimise=constant.expression(), bounds=others)


def ground_of(problem: Problem, proof: Certificate) -> Ground | None:
    """The statement that a proof of this kind must show of a problem; None if it can show nothing."""
    if proof.program == VIOLATION:
        return Ground(convex_part(problem), None)
    return next(
        (ground for ground in _least_values(problem) if ground.problem.objective == proof.problem.objective), None
    )


def _least_values(problem: Problem) -> Iterator[Ground]:
    for constant, limits in problem.bounded:
        if isfinite(limits.high):
            yield Ground(least_of(problem, constant), limits.high)


def proof_of_no_law(problem: Problem, proof: object) -> Certificate | None:
    """The proof for this very problem, if its multipliers prove that the problem has no law; else None.

    Multipliers that prove it of one problem mostly prove it of those beyond: what they prove is affine in the numbers.

    >>> import optlaws
    >>> try:
    ...     optlaws.synthesize(Problem(B=1.05, order=3, basis=optlaws.Chebyshev(3)))
    ... except optlaws.InfeasibleProblem as error:
    ...     proof = error.proof
    >>> further, other = (Problem(B=B, order=3, basis=optlaws.Chebyshev(3)) for B in (1.04, 1.7))
    >>> proof_of_no_law(further, proof).problem.B, proof_of_no_law(other, proof)
    (1.04, None)
    """
    if not isinstance(proof, Certificate):
        return None
    ground = ground_of(problem, proof)
    if ground is None:
        return None
    try:
        moved = proof if proof.problem == ground.problem else replace(proof, problem=ground.problem)
        shown = moved.proves_infeasible if ground.above is None else moved.bound > ground.above
    except (ArithmeticError, IndexError, InputError, ValueError):
        return None
    return moved if shown else None


def beyond_limit(problem: Problem) -> str:
    """The constant whose bound is below the limit of all laws; empty without one.

    >>> beyond_limit(Problem(B=1.7, order=4, C=(0.0, 3.0)))
    'no law of any degree has C <= 3 with the other constraints: of all laws the least is 4.128571 (optlaws.limit). ...'
    """
    another = "" if problem.range("B") is None else ", or another B"
    for constant, limits in problem.bounded:
        least = known_limit(replace(problem, minimise=constant.expression()))
        if least is not None and limits.high < least * (1.0 - VALUE_ROUNDING):
            return (
                f"no law of any degree has {constant!r} <= {limits.high:g} with the other constraints: "
                f"of all laws the least is {least:.7g} (optlaws.limit). A higher bound of {constant!r} helps{another}"
            )
    return ""
