"""A lower bound of what is minimised, for all laws of any degree, by the closed forms that synthesis states."""

from __future__ import annotations

from fractions import Fraction

from optlaws.synthesis.limits.of_problem import limit_of_sum
from optlaws.synthesis.problem.combined import Combined
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.verification.exact.law import known
from optlaws.verification.machines.floors import floor


def exact_limit(problem: Problem) -> Fraction | None:
    """A lower bound of the objective for all laws of the problem; None where no closed form exists.

    Only C, D, J and the RMS of c count, and C and D of its cam; every other constant is to be at least 0.

    >>> exact_limit(Problem(B=1.5, order=4, minimise="D"))
    Fraction(9, 4)
    """
    constants = [leaf for _, leaf in leaves(problem.objective) if isinstance(leaf, Functional)]
    if problem.boundary is not None or any(floor(constant, problem.conditions) < 0 for constant in constants):
        return None
    for constant in constants:
        if isinstance(constant, Combined):
            known(constant)
    return limit_of_sum(problem, problem.objective, exact=True) or None
