"""The search for the least time of a move: Newton steps on the least greatest share of its limits.

In each time the law is sought whose greatest share of the limits is least. Its multipliers say up to which time no law
keeps the limits; that time is the next. From below the steps end at the first time in which a law keeps them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import copysign, exp, inf, log, sqrt
from operator import itemgetter

from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.least_time.least_time import LeastTime, Multipliers, TimeProof, covering, proof_by
from optlaws.synthesis.least_time.timed_move import Timed, TimedMove, TimedT
from optlaws.synthesis.problem.constants import meant
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.search import LawSearch, best_available
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import (
    BOUND_FEASIBILITY,
    DURATION_STEP,
    FEASIBILITY,
    LEAST_TIME_GAP,
    LEAST_TIME_MET,
    NO_OBJECTIVE,
)

_UNBOUNDED = (
    "the limits leave the time without a least value: laws of order {order} keep {names} in any time. Limit the "
    "velocity, or ask for a higher order"
)


def law_in_time(move: Timed, duration: float, warm: ActiveSet | None, shortest: float | None = None) -> Solution:
    """The law whose greatest share of the limits in a time is least, begun from the contacts of a time near by.

    With a shortest time the limits are those of all times between. It raises what `least_time` does.
    """
    problem = move.shares(duration, shortest=shortest)
    search = LawSearch(model_of(problem), warm=warm)
    solution = best_available(search)
    if solution is None:
        error = search.error()
        if isinstance(error, SolverFailure):
            raise error
        message = f"no time is long enough: {error.args[0]}"
        if not move.at_rest:
            message = (
                f"the limits need more than {duration:.6g} s, but in that time the velocities at the ends contradict "
                f"the problem itself: {error.args[0]}"
            )
        raise InfeasibleProblem(message, problem=move.problem, tried=error.tried, proof=error.proof)
    if not solution.objective > NO_OBJECTIVE:
        names = " and ".join(limit.name for limit in move.limits_in(duration))
        raise InputError(_UNBOUNDED.format(order=problem.order, names=names))
    return solution


def _unsettled(move: Timed, duration: float) -> SolverFailure:
    return SolverFailure(
        f"the steps of the time did not settle, the last at {duration:.9g} s; another degree or order helps",
        problem=move.problem,
    )


#: of the logarithm of the time: by how much a bracket is widened where nothing says more, and how far at most
_WIDER, _WIDEST = 0.1, 20.0
#: of the logarithm of the least time, which two searches of one motion agree in
_MET = 0.1 * LEAST_TIME_MET
#: a slope below it is that of a force that is mostly static
_LEVEL = 0.2
#: by how much the logarithm of the time grows where a limit of vibrations is not kept
_UPWARD = 0.01
#: of the times not yet proven to be too short: the first box, the longest, the shortest; how boxes grow and shrink
_FIRST_BOX, _MOST_BOX, _LEAST_BOX = 0.3, 0.9, 0.01
_MORE, _LESS = 1.3, 0.5
_MOST_BOXES = 60
#: of the gap that is allowed, what the last box leaves
_OF_GAP = 0.9


@dataclass
class _Trials:
    """The laws of the least greatest share of the limits in the times that were tried."""

    move: Timed
    solutions: dict[float, Solution] = field(default_factory=dict)
    first: Solution | None = None  #: of another move near by

    def solution(self, time: float) -> Solution:
        if time not in self.solutions:
            # where the problem is convex, the contacts of a time near by lead to the same optimum
            near = min(self.solutions, key=lambda known: abs(known - time), default=None)
            beside = self.first if near is None else self.solutions[near]
            warm = None if beside is None or not beside.problem.convex else beside.active_set
            self.solutions[time] = law_in_time(self.move, time, warm)
        return self.solutions[time]

    def excess(self, logarithm: float) -> float:
        """The logarithm of the greatest share in a time, by its logarithm: above 0 where a limit is exceeded."""
        return log(self.solution(exp(logarithm)).objective)

    def root(self, logarithm: float, low: float = -inf, high: float = inf) -> float:
        """The least time tried in which a law keeps the limits, by secants from a time, perhaps between two others."""
        begin, before = logarithm, None
        for _ in range(_STEPS):
            excess = self.excess(logarithm)
            low, high = (logarithm, high) if excess > _MET else (low, logarithm)
            if high == logarithm and (excess >= -_MET or high - low <= _MET):
                return min(time for time, solution in self.solutions.items() if log(solution.objective) <= _MET)
            steep = self._slope(logarithm) if before is None else (before[1] - excess) / (logarithm - before[0])
            before, following = (logarithm, excess), logarithm + excess / max(steep, _LEVEL)
            if not low < following < high:
                following = 0.5 * (low + high) if high - low < inf else logarithm + copysign(_WIDER, excess)
            logarithm = following
            if abs(logarithm - begin) > _WIDEST:
                break
        raise _unsettled(self.move, exp(logarithm))

    def _slope(self, logarithm: float) -> float:
        """The exponent with which the greatest share of a law falls with the time, by that law alone."""
        law = self.solution(exp(logarithm)).law
        before, after = (
            max(limit.share(law) for limit in self.move.limits_in(exp(logarithm + step)))
            for step in (-DURATION_STEP, DURATION_STEP)
        )
        return log(before / after) / (2.0 * DURATION_STEP)


def _by_secants(move: TimedT, near: LeastTime[TimedT] | None = None) -> LeastTime[TimedT]:
    """The least time by secants of the greatest share over the time, perhaps started near another.

    Where laws that keep the limits keep them in every longer time, a certificate of one time proves the shorter ones.
    """
    if near is None or not (isinstance(move, TimedMove) and isinstance(near.move, TimedMove)):
        trials, begin = _Trials(move), move.begin
    else:
        # a torque that accelerates alone takes times as the roots of the strokes
        trials = _Trials(move, first=near.solution)
        begin = near.duration * sqrt(move.stroke / near.move.stroke)
    duration = trials.root(log(begin))
    too_short = duration * (1.0 - LEAST_TIME_GAP)
    proofs: tuple[TimeProof, ...] = ()
    if move.stays_possible and move.shares(duration).convex:
        proof = proof_by(trials.solution(too_short).certificate, move, 0.0, too_short)
        proofs = (proof,) if proof.stands(move) else ()
    return LeastTime(move, duration, trials.solutions[duration], proofs)


def _of_vibration(move: TimedT, without: LeastTime[Timed]) -> LeastTime[TimedT]:
    """The least time within a limit of the vibration that is left, from the least time without that limit.

    Laws of a longer time may leave more again. The search goes up to a law; boxes of the times before are then proven
    to be too short, and a law that they come upon is a faster one.
    """
    trials = _Trials(move)
    proofs = [*without.proofs]
    least = low = high = log(without.duration)
    while trials.excess(high) > log(1.0 + FEASIBILITY):
        low, high = high, high + _UPWARD
        if high - least > _WIDEST:
            raise _unsettled(move, exp(high))
    duration = trials.root(high, low) if low < high else exp(high)
    if proofs and low < high and move.stays_possible and move.shares(duration).convex:
        duration = _exclude(trials, proofs, duration)
    return LeastTime(move, duration, trials.solutions[duration], tuple(proofs))


def _exclude(trials: _Trials, proofs: list[TimeProof], duration: float) -> float:
    """Extend proofs by boxes of the times before a duration; the least time, which is less where a box has a law.

    A box that is too long proves nothing: it is halved, and grows again with those that do.
    """
    share = _FIRST_BOX
    while proofs[-1].longest < duration * (1.0 - LEAST_TIME_GAP) and len(proofs) < _MOST_BOXES and share > _LEAST_BOX:
        shortest = proofs[-1].longest
        longest = min(shortest + share * (duration - shortest), duration * (1.0 - _OF_GAP * LEAST_TIME_GAP))
        solution = law_in_time(trials.move, longest, None, shortest)
        proof = proof_by(solution.certificate, trials.move, shortest, longest) if solution.objective > 1.0 else None
        if proof is not None and proof.stands(trials.move):
            proofs.append(proof)
            share = min(_MORE * share, _MOST_BOX)
        elif trials.excess(log(longest)) <= log(1.0 + FEASIBILITY):
            duration = trials.root(log(longest), log(shortest))
        else:
            share *= _LESS
    return duration


#: how much slower than all laws those of a space are that is tried first, so that the right limits bind at once
_SLOWER = 1.02
_STEPS = 60
#: so many steps settle the time but for what rounding leaves
_SETTLING = 12
#: of the gap that is allowed, what a step may go beyond its multipliers
_LITTLE = 0.1


def least_time(move: TimedT, near: LeastTime[TimedT] | None = None) -> LeastTime[TimedT]:
    """The least time in which a law of a move, or of a span of a cycle, keeps its limits, proven to a millionth.

    From rest to rest the search may begin near that of another stroke in the same space: its multipliers say of this
    stroke too which times are too short; its contacts are those to begin with where a torque is limited.

    It is an `InfeasibleProblem` where no law keeps the problem's own windows and bounds, however long it takes, an
    `InputError` where every time satisfies the limits, and a `SolverFailure` where the steps do not settle.
    """
    with meant():
        if move.residual is not None:
            return _of_vibration(move, least_time(move.without_residual))
        if not move.of_rates:
            return _by_secants(move, near)
        duration, solution, known = _from_either_side(move, near) if move.at_rest else _from_below(move)
    proofs = covering(move, known, duration * (1.0 - LEAST_TIME_GAP)) if known or not move.at_rest else ()
    return LeastTime(move, duration, solution, proofs)


_Known = list[tuple[float, Multipliers]]


def _from_either_side(move: TimedT, near: LeastTime[TimedT] | None) -> tuple[float, Solution, _Known]:
    """Steps from rest to rest: the multipliers of any time prove an interval from zero up to the next time."""
    duration, warm = _beside(move, near)
    known: _Known = []
    tried: list[tuple[float, Solution]] = []
    for step in range(_STEPS):
        try:
            solution = law_in_time(move, duration, warm)
        except SolverFailure:
            if not tried:
                raise
            break
        tried.append((duration, solution))
        warm, multipliers = solution.active_set, Multipliers.of(move, duration, solution)
        too_short, proven = multipliers.longest(duration), known[0][0] if known else 0.0
        # an inaccurate solution may prove less than one before, or by rounding more than its own law allows
        long_enough = duration * max(solution.objective, 1.0) * (1.0 + LEAST_TIME_GAP)
        proves_more = proven < too_short <= long_enough
        if proves_more:
            proven, known = too_short, [(too_short, multipliers)]
        gap = 1.0 - proven / duration
        met = LEAST_TIME_MET if step < _SETTLING else 0.5 * LEAST_TIME_GAP
        if solution.objective <= 1.0 + FEASIBILITY and gap <= met:
            return duration, solution, known
        # where the multipliers say no more, the law says how long it takes
        duration = proven if proves_more and abs(gap) > LEAST_TIME_MET else duration * solution.objective
    if isinstance(move, TimedMove):
        raise _unsettled(move, duration)
    # of a span of a cycle, which is not stored: the fastest of the laws, and no proof
    needed = [
        (time * max(limit.at(time).share(each.law) ** (1.0 / limit.nu) for limit in move.rates), each)
        for time, each in tried
    ]
    return (*min(needed, key=itemgetter(0)), [])


def _beside(move: TimedT, near: LeastTime[TimedT] | None) -> tuple[float, ActiveSet | None]:
    """A time slightly above that of all laws, or the one up to which the multipliers of another stroke prove."""
    if not (near and isinstance(move, TimedMove) and isinstance(near.move, TimedMove)):
        return _SLOWER * move.begin, None
    if (near.move.problem, near.move.limits) != (move.problem, move.limits):
        return _SLOWER * move.begin, None
    multipliers = Multipliers.of(near.move, near.duration, near.solution).of_stroke(move.stroke / near.move.stroke)
    return multipliers.longest(near.duration), near.solution.active_set


def _from_below(move: Timed) -> tuple[float, Solution, _Known]:
    """Steps from a time that is too short for any motion: no step skips a time with a law."""
    duration, warm = move.least_conceivable(), None
    known: _Known = []
    for _ in range(_STEPS):
        solution = law_in_time(move, duration, warm)
        if solution.objective <= 1.0 + FEASIBILITY:
            return duration, solution, known
        warm, multipliers = solution.active_set, Multipliers.of(move, duration, solution)
        known.append((duration, multipliers))
        later = multipliers.longest(duration)
        if not later > duration:
            # the law misses a limit by what the solver leaves: within rounding it takes this time, else a little more
            if solution.objective <= 1.0 + BOUND_FEASIBILITY:
                return duration, solution, known
            if solution.objective > 1.0 + _LITTLE * LEAST_TIME_GAP:
                break
            later = duration * solution.objective
        duration = later
    raise _unsettled(move, duration)
