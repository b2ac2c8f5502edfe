"""Synthesis of a single law: the search from all starts, which fallbacks follow where they fail, and the proof."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf, isfinite
from time import perf_counter
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.files.reading import check_names
from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.curved import FormulaFamily
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.method import starts
from optlaws.synthesis.method.exchange import IPOPT, METHODS, ROUNDS, Method, Outcome, solve
from optlaws.synthesis.problem.constants import D, Functional, PeakConstant, warn_of_mixture
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.problem import Problem, differ_in_numbers
from optlaws.synthesis.program.writer import LawEvaluation, Model, evaluate, model_of, shortfalls
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.make import certify
from optlaws.synthesis.proof.no_law import least_of
from optlaws.synthesis.solution import Solution, partly_known
from optlaws.synthesis.spaces.of_basis import space_of
from optlaws.synthesis.status import status_of
from optlaws.tolerances import AGREEMENT, NO_OBJECTIVE, OPTIMALITY_GAP

if TYPE_CHECKING:
    from optlaws.synthesis.limits.drive_limits import DriveLimit

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
        method, and programs on points are solved only where that fails. Where the problem is convex the solution is
        the same.
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


_NEAR_LIMIT = 0.25  # of the limit of a drive: of a law that is so near it no other starts are tried
_SAME_LAW = 1e-6  # share of an objective within which two starts have led to one law: where none is proven not closer
_FIRST_MOVE = 4e-3  # how far the place of a peak is moved at first
_UNDIVIDED_ROUNDING = 1e-13  # an excess that passes unlooked at; a contact at the middle may hide a larger one
_CLEARLY_MET = 1e-11  # of an objective: what doubles leave of it where they show that it is proven
_BEYOND_PROOF = 1e-12  # an objective that is better than what is proven by more belongs to a law that breaks a bound

#: of the gap, what the search over the places of a peak leaves
_LEFT = 0.9
#: how far the place of a peak is moved at first, and how often at most
_MOVES = 4


@dataclass(eq=False)
class Candidate:
    """A law that keeps every constraint, recomputed over the whole interval, and the program's optimum that it is."""

    optimum: ActiveSet
    law: MotionLaw
    objective: float


@dataclass(eq=False)
class LawSearch:
    """The search state of a problem: its best law so far, and its proofs."""

    model: Model
    tight: bool = False  #: whether to search for a tight bound where the problem is not convex
    warm: ActiveSet | None = None  #: the optimum of a neighbouring problem
    method: Method = "auto"  #: how the programs of its starts are solved
    outcomes: list[Outcome] = field(default_factory=list)  #: how each start ended
    candidates: list[Candidate] = field(default_factory=list)  #: the laws that starts led to, the best first
    power: Certificate | None = None  #: the proof of a tight bound with D
    peaks: Certificate | None = None  #: the proof of a tight bound over the places of a peak bounded from below
    began: float = field(default_factory=perf_counter)

    @property
    def problem(self) -> Problem:
        return self.model.problem

    def answer(self) -> Solution | None:
        """The best law from all starts, with its proof; None if no start gives a law."""
        if not self._contradictory():
            self._try_starts()
        if not self.candidates:
            return None
        plain = best = self._tightened(self.candidates[0])
        short = shortfalls(self.problem, plain.law)
        if short:
            best = self._raised(plain, short)
            # where the mirror image is as good, places have been tried on either side; of several constants each step
            # would ask all others at every place again
            settled = self.problem.mirrored or len(short) > 1
            moved = best if settled else self._moved(plain, best, *next(iter(short.items())))
            best = self._placed(plain, moved, short) if self.tight else moved
        return self.certified(plain.optimum, best, raised=bool(short))

    def least(self, known: float) -> float | None:
        """The best objective that starts lead to, of which nothing is proven; None where they lead to no law.

        A law is known already, by its objective: where another start leads to as good a one, the two agree.
        """
        first = self._try(None, next(starts.points(self.model, self.method), None))
        if first is None or abs(first.objective - known) > AGREEMENT * known:
            self._try_starts()
        return self.candidates[0].objective if self.candidates else None

    def error(self) -> InfeasibleProblem | SolverFailure:
        """Why there is no law."""
        from optlaws.synthesis.proof.infeasible import failure

        return failure(self.problem, self.outcomes[0])

    def _contradictory(self) -> bool:
        """Whether bounds beside formulas that are not convex leave no law: known before any of their starts."""
        of_formulas = any(isinstance(family, FormulaFamily) for family in self.model.program.families)
        if self.problem.convex or self.warm is not None or not of_formulas:
            return False
        from optlaws.synthesis.proof.infeasible import failure

        if next(starts.points(self.model, self.method), None) is not None:
            return False
        none = Outcome(None, 0, 0, "the bounds leave no law")
        if isinstance(failure(self.problem, none), SolverFailure):
            return False
        self.outcomes.append(none)
        return True

    def _try_starts(self) -> None:
        """A drive's limit, a neighbour's optimum or the default start; where several may be, others until two agree."""
        first = self._try_drive() if self.warm is None else None
        limit = None if first is None else limit_beside(self.problem)
        if first is not None and limit is not None and first.objective <= limit.value * (1.0 + _NEAR_LIMIT):
            return
        last = self._try(self.warm, None)
        if self.problem.convex or self.warm is not None or _agree(first, last):
            return
        for point in starts.points(self.model, self.method):
            known = next(iter(self.candidates), None)
            if _agree(known, self._try(None, point)):
                return

    def _try_drive(self) -> Candidate | None:
        """Try the motion that attains the limit of a drive as a start."""
        if self.problem.convex:
            return None
        limit = limit_beside(self.problem)
        return None if limit is None else self._try(None, starts.in_phase_plane(self.model, limit))

    def _try(self, warm: ActiveSet | None, point: Array | None) -> Candidate | None:
        known = self.candidates[0].objective if self.candidates else inf
        outcome, candidate = attempt(self.model, warm, point, method=self.method, known=known)
        self.outcomes.append(outcome)
        if candidate is not None:
            self.candidates = sorted([*self.candidates, candidate], key=lambda law: law.objective)
        return candidate

    def _tightened(self, best: Candidate) -> Candidate:
        """The best law from the search for a tight bound; its proof is recorded."""
        if not self.tight or self.problem.convex:
            return best
        from optlaws.synthesis.proof.power.search import tightened

        better, scales = [best], self.model.variable_scales

        def explore(x: Array) -> bool:
            _, tried = attempt(self.model, None, x / scales, method=self.method)
            if tried is not None and tried.objective < better[-1].objective * (1.0 - OPTIMALITY_GAP):
                better.append(tried)
                return True
            return False

        while True:
            best = better[-1]
            self.power = tightened(self.problem, best.objective, best.optimum.x * scales, explore)
            if best is better[-1]:
                return best

    def _raised(self, plain: Candidate, short: Mapping[Functional, float]) -> Candidate:
        """The best law in which constants below their lower bounds are raised to them."""
        from optlaws.synthesis.method.lower_bounds import active_lower_bounds

        best = self._best_of(active_lower_bounds(self.model, plain.optimum))
        if best is not None:
            return best
        constant, low = next(iter(short.items()))
        raise SolverFailure(
            f"no law with {constant!r} at least {low:g} was found; without that, its {constant!r} is "
            f"{constant.value(plain.law):.7g}",
            problem=self.problem,
            tried="every extremum was bounded from below step by step, with its peak at one place after another",
        )

    def _moved(self, plain: Candidate, best: Candidate, constant: Functional, low: float) -> Candidate:
        """The best law from steps of the raised peak's place, while the steps improve it."""
        alone = all(leaf == constant for _, leaf in leaves(self.problem.objective))
        if alone or not isinstance(constant, PeakConstant):
            return best
        from optlaws.synthesis.method.lower_bounds import active_lower_bounds_at

        step, side = _FIRST_MOVE, 1.0
        for _ in range(_MOVES):
            k = best.law.peak(constant.nu).k + side * step
            states = active_lower_bounds_at(self.model, plain.optimum, constant, low, k) if 0.0 < k < 1.0 else []
            moved = self._best_of(states)
            if moved is not None and moved.objective < best.objective * (1.0 - OPTIMALITY_GAP):
                best, step = moved, 2.0 * step
            else:
                side, step = -side, step if side > 0.0 else 0.25 * step
        return best

    def _placed(self, plain: Candidate, best: Candidate, short: Mapping[Functional, float]) -> Candidate:
        """The best law from a search over the places of a peak that is bounded from below; notes its proof."""
        from optlaws.synthesis.method.lower_bounds import active_lower_bounds_at
        from optlaws.synthesis.proof import peak_search as places
        from optlaws.synthesis.proof.peak_rows import peak_of

        for constant, low in short.items():
            peak, nothing = peak_of(self.problem, constant.name), NO_OBJECTIVE * self.problem.objective.scale
            while peak is not None and best.objective > nothing:
                ended = places.search(self.problem, peak, best.objective * (1.0 - _LEFT * OPTIMALITY_GAP))
                self.peaks = ended.certificate
                if self.peaks is not None:
                    return best
                if ended.better_at is None:
                    break
                better = self._best_of(
                    active_lower_bounds_at(self.model, plain.optimum, constant, low, ended.better_at)
                )
                if better is None or better.objective >= best.objective * (1.0 - OPTIMALITY_GAP):
                    break
                best = better
        return best

    def _best_of(self, states: list[ActiveSet]) -> Candidate | None:
        """The best of the laws that keep every constraint and every lower bound; None where none does."""
        laws = (feasible(self.model, state) for state in states)
        return min((law for law in laws if law is not None), key=lambda law: law.objective, default=None)

    def certified(self, bounding: ActiveSet, best: Candidate, *, raised: bool) -> Solution:
        """The best law with its proof: an optimum without lower bounds of constants bounds the objective."""
        problem, limit = self.problem, known_limit(self.problem)
        proof = certify(self.model, bounding, best.objective, limit)
        drive = None if problem.convex else limit_beside(problem)
        proven = [proof, *(tight for tight in (self.power, self.peaks) if tight is not None)]
        known = [limit for limit in (limit, None if drive is None else drive.value) if limit is not None]
        several = not problem.convex and best in self.candidates[:1]
        scale, tight = problem.objective.scale, problem.convex and not raised
        return partly_known(
            {
                "problem": problem,
                "law": best.law,
                "z_series": tuple(self.model.space.z_series(self.model.coordinates(best.optimum.x)).tolist()),
                "objective": best.objective,
                "certificate": proof,
                "best_possible": limit,
                "iterations": sum(outcome.iterations for outcome in self.outcomes),
                "seconds": perf_counter() - self.began,
                "starts": tuple(candidate.objective for candidate in self.candidates) if several else (),
                "power_certificate": self.power,
                "peak_certificate": self.peaks,
                "drive_limit": drive,
                "active_set": bounding,
            },
            {
                "lower_bound": lambda _: max([*(each.bound for each in proven), *known]) + 0.0,
                "status": lambda solution: status_of(best.objective, solution.lower_bound, scale, proven=tight),
            },
        )


def limit_beside(problem: Problem) -> DriveLimit | None:
    """The limit of a drive; what finds it is imported for problems that are not convex."""
    from optlaws.synthesis.limits import drive_limits

    return drive_limits.limit_beside(problem)


def best_available(search: LawSearch) -> Solution | None:
    """The best law of a problem, with its proof; None where none exists or the objective is unbounded."""
    solution, problem = _of_any_way(search), search.problem
    # a law of which nothing is proven may be one of many that are less and less
    if solution is None or not problem.convex or _is_met(solution) or solution.lower_bound > -inf:
        return solution
    from optlaws.synthesis.proof.infeasible import falls_for_ever

    return None if falls_for_ever(problem) else solution


def _of_any_way(search: LawSearch) -> Solution | None:
    """The problem's own answer or, where it is missing, unproven or too good, the answer of an alternative strategy."""
    solution, problem = search.answer(), search.problem
    if search.method == IPOPT or not problem.convex:
        return solution
    if solution is None or search.outcomes[0].optimum is None:
        known = [answer for answer in (solution, solved_without_interior(search)) if answer is not None]
        return min(known, key=lambda answer: abs(answer.gap), default=None)
    if not _is_met(solution) and _beyond_proof(solution):
        return solved_without_interior(search) or solution
    return solution


def continued_by_contacts(search: LawSearch) -> Solution | None:
    """The best law by a neighbour's contacts alone; None where they lead to none, or lower bounds ask for more."""
    outcome, best = attempt(search.model, search.warm, None, rounds=0)
    if outcome.optimum is None or best is None or shortfalls(search.problem, best.law):
        return None
    search.outcomes.append(outcome)
    return search.certified(outcome.optimum, best, raised=False)


def solved_without_interior(search: LawSearch) -> Solution | None:
    """The best law under bounds with hardly any interior, and its proof."""
    best: Solution | None = None
    for optimum, coordinates in starts.fallbacks_without_interior(search.model):
        law = feasible(search.model, optimum.at(np.append(coordinates, optimum.x[len(coordinates) :])))
        if law is not None:
            solution = LawSearch(search.model, began=search.began).certified(optimum, law, raised=False)
            if best is None or _beyond_proof(best) or (not _beyond_proof(solution) and solution.gap < best.gap):
                best = solution
    return best


class _Laws:
    """The laws of a model, evaluated; the last one is cached, as the optimum is often the last."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._last: tuple[Array, MotionLaw, LawEvaluation] | None = None

    def at(self, x: Array) -> tuple[MotionLaw, LawEvaluation]:
        """The law of given variables, and its value."""
        if self._last is None or self._last[0] is not x:
            law = self._model.law(x)
            self._last = (x, law, evaluate(self._model.problem, law))
        return self._last[1:]

    def candidate(self, optimum: ActiveSet) -> Candidate | None:
        """The law of an optimum; None where it breaks a constraint."""
        law, value = self.at(optimum.x)
        return Candidate(optimum, law, value.objective) if value.sound else None


def _agree(first: Candidate | None, last: Candidate | None) -> bool:
    """Whether two starts gave laws with the same objective, as exactly as the search knows it."""
    if first is None or last is None:
        return False
    return abs(first.objective - last.objective) <= _SAME_LAW * abs(first.objective)


def attempt(
    model: Model,
    warm: ActiveSet | None,
    point: Array | None,
    *,
    rounds: int = ROUNDS,
    method: Method = "auto",
    known: float = inf,
) -> tuple[Outcome, Candidate | None]:
    """The local optimum reached from a neighbour's optimum or a start; none where a known objective is less."""
    claim, laws = model.program.objective * model.unit, _Laws(model)

    def holds(x: Array) -> bool:
        law, value = laws.at(x)
        exact = value.excess <= _UNDIVIDED_ROUNDING and value.objective <= float(claim @ x) * (
            1.0 + _UNDIVIDED_ROUNDING
        )
        # a constant that is minimised is a variable, which may have to be above the law's own
        return exact and not shortfalls(model.problem, law)

    def worse(x: Array) -> bool:
        return float(claim @ x) > known * (1.0 + AGREEMENT)

    if method == IPOPT and warm is not None:
        point, warm = warm.x, None
    outcome = solve(model.program, warm, start=point, holds=holds, rounds=rounds, method=method, worse=worse)
    led = outcome.tried if outcome.optimum is None else (outcome.optimum,)
    candidates = (laws.candidate(state.at(starts.on_equations(model.program, state.x))) for state in led)
    return outcome, min((law for law in candidates if law is not None), key=lambda law: law.objective, default=None)


def feasible(model: Model, optimum: ActiveSet) -> Candidate | None:
    """The law of an optimum; None where it breaks a constraint or a lower bound."""
    law = _Laws(model).candidate(optimum)
    return None if law is None or shortfalls(model.problem, law.law) else law


def _is_met(solution: Solution) -> bool:
    """Whether doubles show already that the bound meets the objective."""
    left = solution.objective - solution.certificate.estimate
    return -_BEYOND_PROOF * abs(solution.objective) <= left <= _CLEARLY_MET * abs(solution.objective)


def _beyond_proof(solution: Solution) -> bool:
    """Whether the law is better than any law is, so that it breaks a bound by more than rounding."""
    return solution.objective < solution.lower_bound - _BEYOND_PROOF * abs(solution.lower_bound)
