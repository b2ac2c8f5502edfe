"""Problems with one more bound: a bound of a constant, or of their own objective near its least value."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from optlaws.errors import InputError
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.expression import Maximum, leaves
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.solution import Solution


def with_most(problem: Problem, constant: Functional, most: float) -> Problem:
    """The problem with an upper bound of a constant; a fixed constant stays unchanged.

    Examples
    --------
    >>> from optlaws import Problem, at_most
    >>> from optlaws.synthesis import J
    >>> with_most(Problem(order=3, J=at_most(80)), J, 60.0).J, with_most(Problem(order=3, J=50), J, 60.0).J
    (at_most(60.0), 50.0)
    """
    known = problem.range(constant.name)
    if known is not None and (known.fixed or known.high <= most):
        return problem
    limits = Range(0.0 if known is None else known.low, most)
    symmetric = problem.symmetric and constant.even
    if constant.name in CONSTANTS:
        entries: dict[str, Any] = {constant.name: limits}
        return replace(problem, symmetric=symmetric, **entries)
    return replace(problem, symmetric=symmetric, bounds={**problem.bounds, constant: limits})


def least_near(solution: Solution, minimise: Functional, share: float) -> Problem:
    """The problem of the best law in another constant, among laws within a share of a solution's objective.

    Raises
    ------
    InputError
        If a solution minimises a sum of constants.

    Examples
    --------
    >>> from optlaws import Problem, synthesize
    >>> from optlaws.synthesis import J
    >>> least = synthesize(Problem(order=3))
    >>> near = synthesize(least_near(least, J, 0.01))
    >>> round(near.constants.C.value / least.objective, 6), near.objective < 0.9 * least.constants.J.value
    (1.01, True)
    """
    problem = solution.problem
    terms = problem.objective.terms
    several = len(terms) > 1
    inside = [part for _, term in terms if isinstance(term, Maximum) for part in term.parts]
    if several or any(len(part.terms) > 1 for part in inside):
        raise InputError(f"{problem.minimise} is a sum of constants, and no single one is near its least value")
    for weight, constant in leaves(problem.objective):
        if isinstance(constant, Functional):
            problem = with_most(problem, constant, (1.0 + share) * solution.objective / weight)
    return replace(problem, minimise=minimise, symmetric=problem.symmetric and minimise.even)
