"""The least time of a move within limits that change with the time: of the torque at a motor, of vibration left."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp, log, sqrt

from optlaws.synthesis.least_time.fastest_law import law_in_time, unsettled
from optlaws.synthesis.least_time.least_time import LeastTime, limit_of_all_laws
from optlaws.synthesis.least_time.move_limits import TimedMove
from optlaws.synthesis.least_time.time_proof import TimeProof, proof_by
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import FEASIBILITY, LEAST_TIME_GAP, LEAST_TIME_MET

#: of the logarithm of the time: by how much a bracket is widened at once, and how far at most
_WIDER, _WIDEST = 0.1, 20.0
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

    move: TimedMove
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

    def root(self, low: float, high: float) -> float:
        """The least time tried in which a law keeps the limits, once it is bracketed, by logarithms."""
        if low < high:
            from scipy.optimize import brentq

            brentq(self.excess, low, high, xtol=0.1 * LEAST_TIME_MET)
        return min(time for time, solution in self.solutions.items() if solution.objective <= 1.0 + FEASIBILITY)


def least_time_of_motor(move: TimedMove, near: LeastTime | None = None) -> LeastTime:
    """The least time by bracketing between an infeasible and a feasible time, perhaps started near another.

    Where laws that keep the limits keep them in every longer time, a certificate of one time proves the shorter ones.
    """
    if near is None:
        trials, begin = _Trials(move), max(limit_of_all_laws(move) or 0.0, move.least_conceivable()) or 1.0
    else:
        # a torque that accelerates alone takes times as the roots of the strokes
        trials = _Trials(move, first=near.solution)
        begin = near.duration * sqrt(move.stroke / near.move.stroke)
    low, high = _bracket(trials, log(begin))
    duration = trials.root(low, high)
    too_short = duration * (1.0 - LEAST_TIME_GAP)
    proofs: tuple[TimeProof, ...] = ()
    if move.stays_possible and move.shares(duration).convex:
        proof = proof_by(trials.solution(too_short).certificate, move, 0.0, too_short)
        proofs = (proof,) if proof.stands(move) else ()
    return LeastTime(move, duration, trials.solutions[duration], proofs)


def least_time_of_follower(move: TimedMove, without: LeastTime) -> LeastTime:
    """The least time within a limit of the vibration that is left, from the least time without that limit.

    Laws of a longer time may leave more again. The search goes up to a law; boxes of the times before are then proven
    to be too short, and a law that they come upon is a faster one.
    """
    trials = _Trials(move)
    low = high = log(without.duration)
    while trials.excess(high) > log(1.0 + FEASIBILITY):
        low, high = high, high + _UPWARD
        if high - log(without.duration) > _WIDEST:
            raise unsettled(move, exp(high))
    duration = trials.root(low, high)
    proofs = list(without.proofs)
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
            duration = trials.root(log(shortest), log(longest))
        else:
            share *= _LESS
    return duration


def _bracket(trials: _Trials, logarithm: float) -> tuple[float, float]:
    """Logarithms of a time that is too short and of a time that is long enough.

    Raises
    ------
    SolverFailure
        If there are none far and wide.
    """
    excess, last = trials.excess(logarithm), logarithm
    # most limits fall with the time or a power of it, so that the excess is about how far the end is
    step = max(-_WIDER, min(_WIDER, excess)) or -_WIDER
    while abs(last - logarithm) < _WIDEST:
        here = last + step
        if (trials.excess(here) > 0.0) == (step < 0.0):
            return min(last, here), max(last, here)
        last, step = here, 1.5 * step
    raise unsettled(trials.move, exp(last))
