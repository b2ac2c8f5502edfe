"""synthesize(problem) -> Solution: the best law of a problem, with proof."""

from __future__ import annotations

from math import isfinite
from typing import Literal, get_args

from optlaws.errors import InfeasibleProblem, InputError, OptlawsError
from optlaws.files.reading import check_names
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.method.exchange import IPOPT, METHODS, Method
from optlaws.synthesis.problem.constants import D, warn_of_mixture
from optlaws.synthesis.problem.problem import Problem, differ_in_numbers
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.no_law import least_of
from optlaws.synthesis.search import LawSearch, best_available, continued_by_contacts
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.spaces.of_basis import space_of

#: how problems that are not convex are bounded
Bound = Literal["quick", "tight"]
TIGHT: Bound = "tight"
BOUNDS = get_args(Bound)


def synthesize(
    problem: Problem, *, start: Solution | None = None, bound: Bound = "quick", method: Method = "auto"
) -> Solution:
    """Find the law that minimises the problem's objective, with a proof of its optimality or a bound of its gap.

    Parameters
    ----------
    problem
        What to solve.
    start
        A solution of a neighbouring problem (the same but for numbers): its contacts are continued by Newton's
        method, and programs on points are solved only where that fails. Where the problem is convex the answer is the
        same.
    bound
        How to bound a problem that is not convex, with D or a loader in it or a peak bounded from below: "quick", or
        "tight" by a search over all laws, or over all places of the peak, which takes from a tenth of a second to some
        seconds, usually meets the objective and finds better laws if there are any. Other problems are proven either
        way.
    method
        How programs are solved: "auto" by what suits their rows, or "ipopt" each as a nonlinear program of CasADi by
        IPOPT, to judge the other by. Contacts, proof and status follow from either in the same way, and so does the
        law in which a peak is raised to its lower bound. Integrals of formulas with kinks need "auto".

    Returns
    -------
    Solution
        The law, its constants, the lower bound and the limit.

    Raises
    ------
    InfeasibleProblem
        If no law of the problem exists; `proof` is a certificate of that, unless the message names the limit that
        exceeds the given bound.
    SolverFailure
        If the search failed and did not prove that no law exists.

    Examples
    --------
    >>> solution = synthesize(Problem(B=1.641, order=4))
    >>> round(solution.objective, 8), solution.gap < 1e-8
    (5.08070242, True)
    """
    _check_types(problem, start, bound)
    check_names([method], METHODS, "method")
    warn_of_mixture(problem.objective, problem.order)
    if problem.windows:
        from optlaws.synthesis.proof.infeasible import beyond_known_value

        excluded = beyond_known_value(problem)
        if excluded is not None:
            raise excluded
    model = model_of(problem)
    if method == IPOPT and any(isinstance(family, KinkedIntegralFamily) for family in model.program.families):
        raise InputError(
            'method "ipopt" needs second derivatives, which the integral of a formula with kinks does not have: '
            'solve this problem by method "auto"'
        )
    search = LawSearch(model, tight=bound == TIGHT, warm=_warm(model, start), method=method)
    solution = best_available(search)
    if solution is not None:
        return solution
    error = search.error()
    raise error if isinstance(error, InfeasibleProblem) else _none_so_small(problem) or error


def continued(problem: Problem, start: Solution) -> Solution | None:
    """The solution of a convex problem by the contacts of a neighbour's alone; None where they do not lead to it."""
    model = model_of(problem)
    warm = _warm(model, start)
    return None if warm is None else continued_by_contacts(LawSearch(model, warm=warm))


def _warm(model: Model, start: Solution | None) -> ActiveSet | None:
    """The optimum of a neighbouring problem; None where the start is not one, or its law was a symmetric one's."""
    if start is None or not _neighbours(model.problem, start.problem):
        return None
    return start.active_set if len(start.active_set.x) == model.program.size else None


def _check_types(problem: object, start: object, bound: object) -> None:
    if not isinstance(problem, Problem):
        raise InputError(f"synthesize takes a Problem, got {type(problem).__name__}")
    if start is not None and not isinstance(start, Solution):
        raise InputError(f"start must be a Solution of a neighbouring problem, got {type(start).__name__}")
    check_bound(bound)


def check_bound(bound: object) -> None:
    """Refuse unknown kinds of bounds."""
    check_names([bound], BOUNDS, "bound")


def _neighbours(first: Problem, second: Problem) -> bool:
    """Whether two problems differ in numbers alone, with the same variables."""
    peaks = [(problem.peak_at, problem.peak_is_variable) for problem in (first, second)]
    if peaks[0] != peaks[1] or not differ_in_numbers(first, second):
        return False
    spaces = [space_of(each.basis, each.conditions, symmetric=each.symmetric) for each in (first, second)]
    return spaces[0] is spaces[1]


def _none_so_small(problem: Problem) -> InfeasibleProblem | None:
    """The error where the least value of a constant that is not convex is proven to exceed the prescribed one."""
    for constant, limits in problem.bounded:
        if constant.convex or not isfinite(limits.high):
            continue
        try:
            least = synthesize(least_of(problem, constant), bound=TIGHT if constant == D else "quick")
        except OptlawsError:
            continue
        if least.lower_bound > limits.high:
            name = constant.title
            return InfeasibleProblem(
                f"no law of this problem has {name} <= {limits.high:g}: {name} is at least {least.lower_bound:.7g}, "
                f"proven by error.proof. A law with {least.objective:.7g} exists; a higher bound of {name} or a higher "
                "degree of Z helps",
                problem=problem,
                proof=least.power_certificate or least.certificate,
                tried=f"the least {name} of the problem was sought, with a lower bound",
            )
    return None
