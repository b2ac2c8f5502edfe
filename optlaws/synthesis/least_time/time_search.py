"""The search for the least time of a move: steps on the least greatest share of its limits.

In each time the law is sought whose greatest share of the limits is least. Where all limits are of derivatives, its
multipliers say up to which time no law keeps the limits; that time is the next. Elsewhere secants of the share over the
time give it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp, inf, log, sqrt
from typing import Generic

from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.least_time.least_time import LeastTime, Multipliers, TimeProof, covering, proof_by
from optlaws.synthesis.least_time.timed_move import Timed, TimedMove, TimedT
from optlaws.synthesis.problem.constants import meant
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import LawSearch, best_available
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


#: how much slower than all laws those of a space are that is tried first, so that the right limits bind at once
_SLOWER = 1.02
#: of the least time: by how much two searches of one motion differ without multipliers, whose sum is rounded by more
_SECANT_MET = 0.1 * LEAST_TIME_MET
#: by how much a time is changed where nothing says more, and by how much at most from the first
_WIDER, _WIDEST = 1.1, exp(20.0)
#: a slope below it is that of a force that is mostly static
_LEVEL = 0.2
_STEPS = 60
#: by how much a time is longer than the one before where a limit of vibrations is not kept
_UPWARD = 1.01
#: of the times not yet proven to be too short: the first box, the longest, the shortest; how boxes grow and shrink
_FIRST_BOX, _MOST_BOX, _LEAST_BOX = 0.3, 0.9, 0.01
_MORE, _LESS = 1.3, 0.5
_MOST_BOXES = 60
#: of the gap that is allowed, what the last box leaves
_OF_GAP = 0.9


@dataclass
class _Trials(Generic[TimedT]):
    """The laws of the least greatest share of the limits in the times that were tried, and the multipliers that prove.

    The first times are begun from contacts of another move, where there are some.
    """

    move: TimedT
    warm: ActiveSet | None = None
    solutions: dict[float, Solution] = field(default_factory=dict)
    known: list[tuple[float, Multipliers]] = field(default_factory=list)

    def solution(self, time: float) -> Solution:
        if time not in self.solutions:
            # where the problem is convex, the contacts of a time near by lead to the same optimum
            near = self.solutions[min(self.solutions, key=lambda tried: abs(tried - time))] if self.solutions else None
            warm = self.warm if near is None else near.active_set if near.problem.convex else None
            self.solutions[time] = law_in_time(self.move, time, warm)
        return self.solutions[time]

    def excess(self, time: float) -> float:
        """The logarithm of the greatest share in a time: above 0 where a limit is exceeded."""
        return log(self.solution(time).objective)

    def least(self, time: float, low: float = 0.0, high: float = inf) -> float:
        """The least time in which a law keeps the limits, from one time on, perhaps between two others."""
        first, before, proven, by_rates = time, None, low, self.move.of_rates
        settled = LEAST_TIME_MET if by_rates else _SECANT_MET
        for _ in range(_STEPS):
            excess, known = self.excess(time), proven
            proven = self._too_short(time, known) if by_rates else known
            # a law may miss a limit by what the solver leaves where the multipliers prove no more
            keeps = excess <= (BOUND_FEASIBILITY if by_rates and proven == known else settled)
            low, high = (low, time) if keeps else (time, high)
            low = max(low, proven)
            nearest = excess >= -settled or 1.0 - low / high <= settled
            if keeps and nearest and (not by_rates or proven >= time * (1.0 - LEAST_TIME_GAP)):
                return time
            following = proven if proven > known else time
            if abs(following / time - 1.0) <= settled or following >= high:
                # where the multipliers say no more, the law says how long it takes
                following = time * exp(excess / self._steepness(time, before))
                if not low < following < high:
                    following = 0.5 * (low + high) if high < inf else time * _WIDER
            before, time = time, following
            if not 1.0 / _WIDEST < time / first < _WIDEST:
                break
        raise self.unsettled(time)

    def _too_short(self, time: float, known: float) -> float:
        """The time up to which no law keeps the limits, by what is known and the multipliers of a time."""
        multipliers = Multipliers.of(self.move, time, self.solution(time))
        longest = multipliers.longest(time)
        # an inaccurate solution may prove less than one before, or by rounding more than its own law allows
        long_enough = time * exp(max(self.excess(time), 0.0)) * (1.0 + LEAST_TIME_GAP) if self.move.at_rest else inf
        if not known < longest <= long_enough:
            return known
        self.known.append((min(time, longest), multipliers))
        return longest

    def _steepness(self, time: float, before: float | None) -> float:
        """The exponent with which the greatest share falls with the time, from a time before or by the law alone."""
        if self.move.of_rates:
            return 1.0
        if before is not None:
            return max((self.excess(before) - self.excess(time)) / log(time / before), _LEVEL)
        law = self.solution(time).law
        shorter, longer = (
            max(limit.share(law) for limit in self.move.limits_in(time * exp(step)))
            for step in (-DURATION_STEP, DURATION_STEP)
        )
        return max(log(shorter / longer) / (2.0 * DURATION_STEP), _LEVEL)

    def unsettled(self, time: float) -> SolverFailure:
        return SolverFailure(
            f"the steps of the time did not settle, the last at {time:.9g} s; another degree or order helps",
            problem=self.move.problem,
        )

    def proofs(self, duration: float) -> tuple[TimeProof, ...]:
        """That no law keeps the limits in a time that is shorter by more than the gap; empty where none is known."""
        move, too_short = self.move, duration * (1.0 - LEAST_TIME_GAP)
        if move.of_rates:
            return covering(move, self.known, too_short)
        if not (move.stays_possible and move.shares(duration).convex):
            return ()
        # where laws that keep the limits keep them in every longer time, one certificate proves all shorter ones
        proof = proof_by(self.solution(too_short).certificate, move, 0.0, too_short)
        return (proof,) if proof.stands(move) else ()


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
        trials, begin = _beginning(move, near)
        try:
            # with ends that move no step skips a time with a law: the first is too short for any motion
            duration = trials.least(begin, 0.0 if move.at_rest else begin)
        except SolverFailure:
            if isinstance(move, TimedMove) or not (move.of_rates and trials.solutions):
                raise
            # of a span of a cycle, which is not stored: the fastest of the laws, and no proof
            durations = {
                time * max(limit.at(time).share(each.law) ** (1.0 / limit.nu) for limit in move.rates): each
                for time, each in trials.solutions.items()
            }
            return LeastTime(move, min(durations), durations[min(durations)], ())
        return LeastTime(move, duration, trials.solutions[duration], trials.proofs(duration))


def _beginning(move: TimedT, near: LeastTime[TimedT] | None) -> tuple[_Trials[TimedT], float]:
    """The trials and their first time: slightly above that of all laws, or by what another stroke says."""
    if not move.at_rest:
        return _Trials(move), move.least_conceivable()
    begin = _SLOWER * move.begin if move.of_rates else move.begin
    if near is None or not (isinstance(move, TimedMove) and isinstance(near.move, TimedMove)):
        return _Trials(move), begin
    ratio = move.stroke / near.move.stroke
    if not move.of_rates:
        # a torque that accelerates alone takes times as the roots of the strokes
        warm = near.solution.active_set if near.solution.problem.convex else None
        return _Trials(move, warm), near.duration * sqrt(ratio)
    if (near.move.problem, near.move.limits) != (move.problem, move.limits):
        return _Trials(move), begin
    multipliers = Multipliers.of(near.move, near.duration, near.solution).of_stroke(ratio)
    return _Trials(move, near.solution.active_set), multipliers.longest(near.duration)


def _of_vibration(move: TimedT, without: LeastTime[Timed]) -> LeastTime[TimedT]:
    """The least time within a limit of the vibration that is left, from the least time without that limit.

    Laws of a longer time may leave more again. The search goes up to a law; boxes of the times before are then proven
    to be too short, and a law that they come upon is a faster one.
    """
    trials, proofs = _Trials(move), [*without.proofs]
    low = high = without.duration
    while trials.excess(high) > FEASIBILITY:
        low, high = high, high * _UPWARD
        if high > without.duration * _WIDEST:
            raise trials.unsettled(high)
    duration = trials.least(high, low) if low < high else high
    if proofs and low < high and move.stays_possible and move.shares(duration).convex:
        duration = _exclude(trials, proofs, duration)
    return LeastTime(move, duration, trials.solutions[duration], tuple(proofs))


def _exclude(trials: _Trials[TimedT], proofs: list[TimeProof], duration: float) -> float:
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
        elif trials.excess(longest) <= FEASIBILITY:
            duration = trials.least(longest, shortest)
        else:
            share *= _LESS
    return duration
