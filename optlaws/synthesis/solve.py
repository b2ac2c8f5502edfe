"""synthesize(problem) -> Solution: the best law of a problem, with proof."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from math import isfinite
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.laws import MotionLaw
from optlaws.suggest import unknown_key
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.method import starts
from optlaws.synthesis.method.contacts import VIOLATION
from optlaws.synthesis.method.exchange import Outcome, solve
from optlaws.synthesis.method.lower_bounds import raised
from optlaws.synthesis.method.narrow import narrowed, on_equations
from optlaws.synthesis.problem.fields import differ_in_numbers
from optlaws.synthesis.problem.mixtures import warn_of_mixture
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.evaluation import shortfalls, worth
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof import mirroring
from optlaws.synthesis.proof.infeasible import failure
from optlaws.synthesis.proof.make import certify, lower_bound
from optlaws.synthesis.proof.power.certificate import PowerCertificate
from optlaws.synthesis.proof.power.search import tightened
from optlaws.synthesis.solution import NOTHING, Solution, Status
from optlaws.synthesis.spaces.of_basis import space_of

GAP = 1e-8
_SAME = 1e-9
TIGHT = "tight"
BOUNDS = ("quick", TIGHT)
# what passes without a look at the divided rows, in which a contact pinned to the middle may hide a larger excess
_ROUNDING = 1e-13
# an objective that is better than what is proven by more than this share belongs to a law that breaks a bound
_BEYOND_PROOF = 1e-12

Array = NDArray[np.float64]


def synthesize(problem: Problem, *, start: Solution | None = None, bound: str = "quick") -> Solution:
    """Find the law that minimises the problem's objective and prove it, or bound how much better one could be.

    Parameters
    ----------
    problem
        What to solve.
    start
        A solution of a neighbouring problem (the same but for numbers): its contacts are continued by Newton's
        method and IPOPT is called only where that fails. Where the problem is convex the answer is the same.
    bound
        How to bound a problem with D in it, which is not convex: "quick", or "tight" by a search over all laws, which
        takes from a tenth of a second to some seconds, usually meets the objective and finds better laws if there are
        any. Other problems are proven either way.

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
    _check_types(problem, start, bound)
    warn_of_mixture(problem.objective, problem.order)
    found = model_of(problem)
    warm = start.active_set if start is not None and _neighbours(problem, start.problem) else None
    if warm is not None and len(warm.x) != found.program.size:
        warm = None  # a symmetric law stands for an unsymmetric one
    tries = [_attempt(problem, found, warm, None)]
    if not problem.convex and warm is None:
        for point in starts.points(found):
            tries.append(_attempt(problem, found, None, point))
            if _agree(tries):
                break
    sound = sorted((one for one in tries if one.law is not None), key=lambda one: one.objective)
    if not sound:
        return _otherwise(problem, found, tries[0].outcome, began)
    plain, power = sound[0], None
    if bound == TIGHT and not problem.convex:
        plain, power = _tightened(problem, found, plain)
    best = _raised(problem, found, plain)
    objectives = tuple(one.objective for one in sound) if not problem.convex and best is sound[0] else ()
    iterations = sum(one.outcome.iterations for one in tries)
    solution = _solution(problem, found, (plain, best), _History(objectives, iterations, began, power))
    return _kept(problem, found, solution, began)


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


def _same_space(first: Problem, second: Problem) -> bool:
    return space_of(first.basis, first.conditions, symmetric=first.symmetric) is space_of(
        second.basis, second.conditions, symmetric=second.symmetric
    )


@dataclass(eq=False)
class _Attempt:
    """One start: how it ended, and the law recomputed over the whole interval; None where that breaks a constraint."""

    outcome: Outcome
    law: MotionLaw | None = None
    objective: float = np.inf
    excess: float = np.inf


def _agree(tries: list[_Attempt]) -> bool:
    """Whether the first start and the last led to the same objective."""
    first, last = tries[0].objective, tries[-1].objective
    return tries[0].law is not None and tries[-1].law is not None and abs(first - last) <= _SAME * abs(first)


def _attempt(problem: Problem, found: Model, warm: ActiveSet | None, point: Array | None) -> _Attempt:
    attempt = _Attempt(Outcome(None, 0, 0, ""))
    claim = found.program.objective * found.unit
    last: list[Array] = []

    def holds(x: Array) -> bool:
        last[:] = [x]
        law = found.space.law(x[: found.space.terms])
        measured = worth(problem, law)
        attempt.law, attempt.objective, attempt.excess = law, measured.objective, measured.excess
        kept = measured.excess <= _ROUNDING and measured.objective <= float(claim @ x) * (1.0 + _ROUNDING)
        # a constant that is minimised is a variable, which may have to be above the law's own
        return kept and not shortfalls(problem, law)

    attempt.outcome = solve(found.program, warm, start=point, holds=holds)
    optimum = attempt.outcome.optimum
    if optimum is not None:
        optimum = optimum.at(on_equations(found.program, optimum.x))
        attempt.outcome = replace(attempt.outcome, optimum=optimum)
        if not (last and last[0] is optimum.x):
            holds(optimum.x)
    if optimum is None or attempt.excess > 10.0 * VIOLATION or not isfinite(attempt.objective):
        attempt.law = None
    return attempt


def _check_types(problem: object, start: object, bound: object) -> None:
    if not isinstance(problem, Problem):
        raise InputError(f"synthesize takes a Problem, got {type(problem).__name__}")
    if start is not None and not isinstance(start, Solution):
        raise InputError(f"start must be a Solution of a neighbouring problem, got {type(start).__name__}")
    if bound not in BOUNDS:
        raise InputError(unknown_key(bound, BOUNDS, "bound"))


def _neighbours(first: Problem, second: Problem) -> bool:
    peaks = [(one.peak_at, one.peak_is_variable) for one in (first, second)]
    return peaks[0] == peaks[1] and differ_in_numbers(first, second) and _same_space(first, second)


def _raised(problem: Problem, found: Model, plain: _Attempt) -> _Attempt:
    """The attempt itself, or, where a constant came out below its lower bound, the best one in which it is held up."""
    if plain.law is None:
        return plain
    short = shortfalls(problem, plain.law)
    if not short:
        return plain
    optimum = plain.outcome.optimum
    tried: list[_Attempt] = []
    for held in raised(found, optimum) if optimum is not None else []:
        law = found.space.law(held.x[: found.space.terms])
        measured = worth(problem, law)
        if measured.excess <= 10.0 * VIOLATION and not shortfalls(problem, law):
            outcome = replace(plain.outcome, optimum=held)
            tried.append(_Attempt(outcome, law, measured.objective, measured.excess))
    if not tried:
        constant, low = next(iter(short.items()))
        raise SolverFailure(
            f"no law with {constant!r} at least {low:g} was found; without that, its {constant!r} is "
            f"{constant.value(plain.law):.7g}",
            problem=problem,
            tried="every extremum was held up, step by step, and the peak was asked at one place after the other",
        )
    return min(tried, key=lambda one: one.objective)


def _tightened(problem: Problem, found: Model, plain: _Attempt) -> tuple[_Attempt, PowerCertificate | None]:
    """The best law that the search for a tight bound comes upon, with its proof."""
    better: list[_Attempt] = [plain]

    def explore(x: Array) -> bool:
        tried = _attempt(problem, found, None, x)
        if tried.law is not None and tried.objective < better[-1].objective * (1.0 - GAP):
            better.append(tried)
            return True
        return False

    while True:
        best = better[-1]
        optimum = best.outcome.optimum
        power = None if optimum is None else tightened(problem, best.objective, optimum.x, explore)
        if best is better[-1]:
            return best, power


def _from_symmetric(problem: Problem, found: Model, began: float) -> Solution | None:
    """The best symmetric law, which is one of the problem's, with what its contacts prove of all laws.

    Among unsymmetric laws the optimum may be flat, so that no active set shows there.
    """
    asked = replace(problem, symmetric=True)
    try:
        symmetric = synthesize(asked)
    except (InfeasibleProblem, SolverFailure):
        return None
    optimum = mirroring.unfolded(found, model_of(asked), symmetric.active_set)
    plain = _measured(problem, found, optimum)
    at_best = optimum.x.copy()
    at_best[: found.space.terms] = mirroring.coordinates(found, symmetric.law)
    best = _measured(problem, found, replace(optimum, x=at_best))
    if best.excess > 10.0 * VIOLATION or (best.law is not None and shortfalls(problem, best.law)):
        return None
    return _solution(problem, found, (plain, best), _History((), symmetric.iterations, began, None))


def _otherwise(problem: Problem, found: Model, outcome: Outcome, began: float) -> Solution:
    """The answer where no start led to a law; the error that says why there is none."""
    unfolded = _from_symmetric(problem, found, began) if problem.mirrored else None
    if unfolded is not None:
        return unfolded
    narrow = _with_hardly_any_room(problem, found, began) if problem.convex else None
    if narrow is not None:
        return narrow
    error = failure(problem, outcome)
    raise error if isinstance(error, InfeasibleProblem) else _no_power_so_small(problem) or error


def _kept(problem: Problem, found: Model, solution: Solution, began: float) -> Solution:
    """The solution, or another where its law is better than what is proven or its bound misses it."""
    if problem.convex and _beyond_proof(solution):
        return _with_hardly_any_room(problem, found, began) or solution
    if problem.mirrored and solution.status is Status.INACCURATE:
        unfolded = _from_symmetric(problem, found, began)
        return solution if unfolded is None or unfolded.gap >= solution.gap else unfolded
    return solution


def _with_hardly_any_room(problem: Problem, found: Model, began: float) -> Solution | None:
    """The best of the laws that keep bounds which leave hardly any room, and what is proven of them."""
    best: Solution | None = None
    for optimum, kept in narrowed(problem, found):
        moved = _measured(problem, found, optimum.at(np.concatenate([kept, optimum.x[len(kept) :]])))
        if moved.law is not None and not shortfalls(problem, moved.law):
            plain = replace(moved, outcome=replace(moved.outcome, optimum=optimum))
            solution = _solution(problem, found, (plain, moved), _History((), 0, began, None))
            if best is None or _beyond_proof(best) or (not _beyond_proof(solution) and solution.gap < best.gap):
                best = solution
    return best


def _beyond_proof(solution: Solution) -> bool:
    """Whether the law is better than any law is, so that it breaks a bound by more than rounding."""
    return solution.objective < solution.lower_bound - _BEYOND_PROOF * abs(solution.lower_bound)


def _measured(problem: Problem, found: Model, optimum: ActiveSet) -> _Attempt:
    law = found.space.law(optimum.x[: found.space.terms])
    measured = worth(problem, law)
    return _Attempt(Outcome(optimum, 0, 0, "from the symmetric law"), law, measured.objective, measured.excess)


def _no_power_so_small(problem: Problem) -> InfeasibleProblem | None:
    """The error to raise where the least D of the problem is proven to be above what is asked."""
    asked = problem.range("D")
    if asked is None or not isfinite(asked.high):
        return None
    try:
        least = synthesize(replace(problem, minimise="D", D=None), bound=TIGHT)
    except OptlawsError:
        return None
    if least.lower_bound <= asked.high:
        return None
    return InfeasibleProblem(
        f"no law of this problem has D <= {asked.high:g}: D is at least {least.lower_bound:.7g}, proven by error.proof."
        f" A law with {least.objective:.7g} exists; a higher bound of D or a higher degree of Z helps",
        problem=problem,
        proof=least.power_certificate or least.certificate,
        tried="the least D of the problem was sought, with a tight bound",
    )


@dataclass(frozen=True, eq=False)
class _History:
    """Where the starts led, IPOPT's iterations, when it began, and the proof of a tight bound."""

    objectives: tuple[float, ...]
    iterations: int
    began: float
    power: PowerCertificate | None


def _solution(problem: Problem, found: Model, attempts: tuple[_Attempt, _Attempt], history: _History) -> Solution:
    """From the best attempt without lower bounds of constants, which bounds the objective, and the one with them."""
    plain, best = attempts
    optimum, bounding = best.outcome.optimum, plain.outcome.optimum
    if best.law is None or optimum is None or bounding is None:
        raise SolverFailure("no start led to a law", problem=problem)
    limit = known_limit(problem)
    proof = certify(found, bounding, best.objective, limit)
    bound = max(lower_bound(proof, limit), -np.inf if history.power is None else history.power.bound)
    if abs(best.objective - bound) <= GAP * (best.objective if best.objective > NOTHING else 1.0):
        status = Status.OPTIMAL
    else:
        held_up = best is not plain and plain.law is not None and bool(shortfalls(problem, plain.law))
        status = Status.INACCURATE if problem.convex and not held_up else Status.LOCAL
    return Solution(
        problem=problem,
        law=best.law,
        z_series=tuple(found.space.z_series(optimum.x[: found.space.terms]).tolist()),
        objective=best.objective,
        certificate=proof,
        lower_bound=bound,
        limit=limit,
        status=status,
        iterations=history.iterations,
        seconds=perf_counter() - history.began,
        starts=history.objectives,
        power_certificate=history.power,
        active_set=bounding,
    )
