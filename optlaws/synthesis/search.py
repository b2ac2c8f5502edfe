"""The search for the best law of a problem: starts, the best of them, a tight bound, lower bounds, and its proof."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from time import perf_counter

import numpy as np

from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.numerics.tolerances import (
    AGREEMENT,
    BEYOND_PROOF,
    FIRST_MOVE,
    NO_OBJECTIVE,
    OPTIMALITY_GAP,
    UNDIVIDED_ROUNDING,
)
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.method import starts
from optlaws.synthesis.method.exchange import Outcome, solve
from optlaws.synthesis.method.lower_bounds import active_lower_bounds, active_lower_bounds_at
from optlaws.synthesis.method.without_interior import fallbacks_without_interior, on_equations
from optlaws.synthesis.problem.constants import PeakConstant
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.evaluation import Worth, shortfalls, worth
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof import mirroring
from optlaws.synthesis.proof import peak_search as places
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.infeasible import failure
from optlaws.synthesis.proof.make import certify, lower_bound
from optlaws.synthesis.proof.peak_rows import peak_of
from optlaws.synthesis.proof.power.search import tightened
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.status import Status, status_of

#: of the gap, what the search over the places of a peak leaves
_LEFT = 0.9
#: how far the place of a peak is moved at first, and how often at most
_MOVES = 4


@dataclass(eq=False)
class Attempt:
    """One start: how it ended, and the law recomputed over the whole interval; None where that breaks a constraint."""

    outcome: Outcome
    law: MotionLaw | None = None
    objective: float = np.inf


@dataclass(eq=False)
class LawSearch:
    """What is known of the best law of a problem so far."""

    model: Model
    tight: bool = False  #: whether to search for a tight bound where the problem is not convex
    warm: ActiveSet | None = None  #: the optimum of a neighbouring problem
    attempts: list[Attempt] = field(default_factory=list)  #: where the starts led
    power: Certificate | None = None  #: the proof of a tight bound with D
    peaks: Certificate | None = None  #: the proof of a tight bound over the places of a peak bounded from below
    began: float = field(default_factory=perf_counter)

    @property
    def problem(self) -> Problem:
        """What is solved."""
        return self.model.problem

    @property
    def sound(self) -> list[Attempt]:
        """The attempts that led to a law, the best first."""
        laws = (attempt for attempt in self.attempts if attempt.law is not None)
        return sorted(laws, key=lambda attempt: attempt.objective)

    def answer(self) -> Solution | None:
        """The best law that the starts lead to, with its proof; None where they lead to none."""
        self._try_starts()
        if not self.sound:
            return None
        plain = self._tightened(self.sound[0])
        best = self._held_up(plain)
        if best is not plain:
            # where the mirror image is as good, places have been tried on either side
            moved = best if self.problem.mirrored else self._moved(plain, best)
            best = self._placed(plain, moved) if self.tight else moved
        return self.certified(plain, best)

    def least(self) -> float | None:
        """The best objective that the starts lead to, of which nothing is proven; None where they lead to no law."""
        self._try_starts()
        return self.sound[0].objective if self.sound else None

    def error(self) -> InfeasibleProblem | SolverFailure:
        """Why there is no law."""
        return failure(self.problem, self.attempts[0].outcome)

    def _try_starts(self) -> None:
        """The default start or a neighbour's optimum; where several optima may be, others until two agree."""
        self.attempts.append(attempt(self.model, self.warm, None))
        if self.problem.convex or self.warm is not None:
            return
        for point in starts.points(self.model):
            self.attempts.append(attempt(self.model, None, point))
            if _agree(self.attempts[0], self.attempts[-1]):
                return

    def _tightened(self, best: Attempt) -> Attempt:
        """The best law that the search for a tight bound comes upon; notes its proof."""
        if not self.tight or self.problem.convex:
            return best
        better, scales = [best], self.model.variable_scales

        def explore(x: Array) -> bool:
            tried = attempt(self.model, None, x / scales)
            if tried.law is not None and tried.objective < better[-1].objective * (1.0 - OPTIMALITY_GAP):
                better.append(tried)
                return True
            return False

        while True:
            best = better[-1]
            optimum = best.outcome.optimum
            if optimum is not None:
                self.power = tightened(self.problem, best.objective, optimum.x * scales, explore)
            if best is better[-1]:
                return best

    def _held_up(self, plain: Attempt) -> Attempt:
        """The attempt itself, or, where a constant is below its lower bound, the best one in which it is held up."""
        optimum = plain.outcome.optimum
        short = {} if plain.law is None else shortfalls(self.problem, plain.law)
        if not short or plain.law is None:
            return plain
        best = None if optimum is None else self._best_of(plain, active_lower_bounds(self.model, optimum))
        if best is not None:
            return best
        constant, low = next(iter(short.items()))
        raise SolverFailure(
            f"no law with {constant!r} at least {low:g} was found; without that, its {constant!r} is "
            f"{constant.value(plain.law):.7g}",
            problem=self.problem,
            tried="every extremum was held up, step by step, and the peak was asked at one place after the other",
        )

    def _moved(self, plain: Attempt, best: Attempt) -> Attempt:
        """The best law to which steps of the place of a peak lead that is held up, as long as they pay."""
        optimum = plain.outcome.optimum
        if plain.law is None or optimum is None:
            return best
        constant, low = next(iter(shortfalls(self.problem, plain.law).items()))
        alone = all(leaf == constant for _, leaf in leaves(self.problem.objective))
        if alone or not isinstance(constant, PeakConstant):
            return best
        step, side = FIRST_MOVE, 1.0
        for _ in range(_MOVES):
            k = (0.5 if best.law is None else best.law.peak(constant.nu).k) + side * step
            states = active_lower_bounds_at(self.model, optimum, constant, low, k) if 0.0 < k < 1.0 else []
            moved = self._best_of(plain, states)
            if moved is not None and moved.objective < best.objective * (1.0 - OPTIMALITY_GAP):
                best, step = moved, 2.0 * step
            else:
                side, step = -side, step if side > 0.0 else 0.25 * step
        return best

    def _placed(self, plain: Attempt, best: Attempt) -> Attempt:
        """The best law from a search over the places of a peak that is bounded from below; keeps its proof."""
        short = {} if plain.law is None else shortfalls(self.problem, plain.law)
        for constant, low in short.items():
            peak, nothing = peak_of(self.problem, constant.name), NO_OBJECTIVE * self.problem.objective.scale
            while peak is not None and plain.outcome.optimum is not None and best.objective > nothing:
                ended = places.search(self.problem, peak, best.objective * (1.0 - _LEFT * OPTIMALITY_GAP))
                self.peaks = ended.certificate
                if self.peaks is not None:
                    return best
                if ended.better_at is None:
                    break
                states = active_lower_bounds_at(self.model, plain.outcome.optimum, constant, low, ended.better_at)
                better = self._best_of(plain, states)
                if better is None or better.objective >= best.objective * (1.0 - OPTIMALITY_GAP):
                    break
                best = better
        return best

    def _best_of(self, plain: Attempt, states: list[ActiveSet]) -> Attempt | None:
        """The best of the candidates that keep every constraint and every lower bound; None where none does."""
        candidates = (feasible_attempt(self.model, replace(plain.outcome, optimum=state)) for state in states)
        feasible = (candidate for candidate in candidates if candidate is not None)
        return min(feasible, key=lambda candidate: candidate.objective, default=None)

    def certified(self, plain: Attempt, best: Attempt) -> Solution:
        """The best attempt without lower bounds of constants, which bounds the objective, and the one with them."""
        problem, optimum, bounding = self.problem, best.outcome.optimum, plain.outcome.optimum
        if best.law is None or optimum is None or bounding is None:
            raise SolverFailure("no start led to a law", problem=problem)
        limit = known_limit(problem)
        proof = certify(self.model, bounding, best.objective, limit)
        searched = [tight.bound for tight in (self.power, self.peaks) if tight is not None]
        bound = max([lower_bound(proof, limit), *searched])
        held_up = best is not plain and plain.law is not None and bool(shortfalls(problem, plain.law))
        several = not problem.convex and best in self.sound[:1]
        return Solution(
            problem=problem,
            law=best.law,
            z_series=tuple(self.model.space.z_series(self.model.coordinates(optimum.x)).tolist()),
            objective=best.objective,
            certificate=proof,
            lower_bound=bound,
            limit=limit,
            status=status_of(best.objective, bound, problem.objective.scale, proven=problem.convex and not held_up),
            iterations=sum(attempt.outcome.iterations for attempt in self.attempts),
            seconds=perf_counter() - self.began,
            starts=tuple(attempt.objective for attempt in self.sound) if several else (),
            power_certificate=self.power,
            peak_certificate=self.peaks,
            active_set=bounding,
        )


def best_available(search: LawSearch) -> Solution | None:
    """The answer of the problem itself or, where that is none, unproven or too good, that of a way around it."""
    solution, problem = search.answer(), search.problem
    if solution is None:
        unfolded = from_symmetric(search) if problem.mirrored else None
        return unfolded or (solved_without_interior(search) if problem.convex else None)
    if problem.convex and _beyond_proof(solution):
        return solved_without_interior(search) or solution
    if problem.mirrored and solution.status is Status.INACCURATE:
        unfolded = from_symmetric(search)
        # a law that breaks a bound by the little that is allowed may seem nearer its bound
        kept = worth(problem, solution.law).excess <= UNDIVIDED_ROUNDING
        return solution if unfolded is None or (kept and unfolded.gap >= solution.gap) else unfolded
    return solution


def from_symmetric(search: LawSearch) -> Solution | None:
    """The best symmetric law, which is one of the problem's, with what its contacts prove of all laws.

    Among unsymmetric laws the optimum may be flat, so that no active set shows there.
    """
    model, half = search.model, model_of(replace(search.problem, symmetric=True))
    try:
        symmetric = best_available(LawSearch(half))
    except SolverFailure:
        return None
    if symmetric is None:
        return None
    optimum = mirroring.unfolded(model, half, symmetric.active_set)
    at_best = np.append(mirroring.coordinates(model, symmetric.law), optimum.x[model.space.terms :])
    outcome = Outcome(optimum, symmetric.iterations, 0, "from the symmetric law")
    best = feasible_attempt(model, replace(outcome, optimum=optimum.at(at_best)))
    if best is None:
        return None
    plain = _measured(_Laws(model), outcome)
    return LawSearch(model, attempts=[plain], began=search.began).certified(plain, best)


def solved_without_interior(search: LawSearch) -> Solution | None:
    """The best of the laws that keep bounds which leave hardly any room, and what is proven of them."""
    best: Solution | None = None
    for optimum, coordinates in fallbacks_without_interior(search.model):
        x = np.append(coordinates, optimum.x[len(coordinates) :])
        moved = feasible_attempt(search.model, Outcome(optimum.at(x), 0, 0, "with bounds loosened"))
        if moved is not None:
            plain = replace(moved, outcome=replace(moved.outcome, optimum=optimum))
            solution = LawSearch(search.model, began=search.began).certified(plain, moved)
            if best is None or _beyond_proof(best) or (not _beyond_proof(solution) and solution.gap < best.gap):
                best = solution
    return best


class _Laws:
    """The laws of a model, measured; the last one is remembered, for the optimum often is the one seen last."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._last: tuple[Array, MotionLaw, Worth] | None = None

    def at(self, x: Array) -> tuple[MotionLaw, Worth]:
        """The law of some variables, and what it is worth."""
        if self._last is None or self._last[0] is not x:
            law = self._model.law(x)
            self._last = (x, law, worth(self._model.problem, law))
        return self._last[1:]


def attempt(model: Model, warm: ActiveSet | None, point: Array | None) -> Attempt:
    """Where a neighbour's optimum or a start leads."""
    claim, laws = model.program.objective * model.unit, _Laws(model)

    def holds(x: Array) -> bool:
        law, value = laws.at(x)
        kept = value.excess <= UNDIVIDED_ROUNDING and value.objective <= float(claim @ x) * (1.0 + UNDIVIDED_ROUNDING)
        # a constant that is minimised is a variable, which may have to be above the law's own
        return kept and not shortfalls(model.problem, law)

    outcome = solve(model.program, warm, start=point, holds=holds)
    optimum = outcome.optimum
    if optimum is not None:
        outcome = replace(outcome, optimum=optimum.at(on_equations(model.program, optimum.x)))
    return _measured(laws, outcome)


def _measured(laws: _Laws, outcome: Outcome) -> Attempt:
    """What a program ended with as an attempt: its law, if it has one that keeps every constraint."""
    if outcome.optimum is None:
        return Attempt(outcome)
    law, value = laws.at(outcome.optimum.x)
    return Attempt(outcome, law if value.sound else None, value.objective)


def feasible_attempt(model: Model, outcome: Outcome) -> Attempt | None:
    """The attempt; None where the law breaks a constraint or a lower bound."""
    measured = _measured(_Laws(model), outcome)
    return None if measured.law is None or shortfalls(model.problem, measured.law) else measured


def _beyond_proof(solution: Solution) -> bool:
    """Whether the law is better than any law is, so that it breaks a bound by more than rounding."""
    return solution.objective < solution.lower_bound - BEYOND_PROOF * abs(solution.lower_bound)


def _agree(first: Attempt, last: Attempt) -> bool:
    """Whether two starts led to the same objective."""
    same = abs(first.objective - last.objective) <= AGREEMENT * abs(first.objective)
    return first.law is not None and last.law is not None and same
