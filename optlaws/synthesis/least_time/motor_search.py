"""The least time of a move within limits that change with the time: of the torque at a motor, of vibration left."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp, log, sqrt

from scipy.optimize import brentq

from optlaws.synthesis.least_time.fastest_law import law_in_time, unsettled
from optlaws.synthesis.least_time.least_time import LeastTime, limit_of_all_laws
from optlaws.synthesis.least_time.motor_torque import MotorTorque
from optlaws.synthesis.least_time.move_limits import TimedMove
from optlaws.synthesis.least_time.time_proof import TimeProof, proof_by
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import FEASIBILITY, LEAST_TIME_GAP, LEAST_TIME_MET

#: of the logarithm of the time: by how much a bracket is widened at once, and how far at most
_WIDER, _WIDEST = 0.1, 20.0
#: by how much the logarithm of the time grows where a limit of vibrations is not kept
_UPWARD = 0.01


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


def least_time_of_motor(move: TimedMove, torque: MotorTorque, near: LeastTime | None = None) -> LeastTime:
    """The least time that is found between one that is too short and one that is enough, perhaps begun near another.

    Where laws that keep the limits keep them in every longer time, a certificate of one time proves the shorter ones.
    """
    if near is None:
        trials, begin = _Trials(move), max(limit_of_all_laws(move) or 0.0, move.least_conceivable()) or 1.0
    else:
        # a torque that accelerates alone takes times as the roots of the strokes
        trials = _Trials(move, first=near.solution)
        begin = near.duration * sqrt(move.stroke / near.move.stroke)
    low, high = _bracket(trials, log(begin))
    brentq(trials.excess, low, high, xtol=0.1 * LEAST_TIME_MET)
    enough = (time for time, solution in trials.solutions.items() if solution.objective <= 1.0 + FEASIBILITY)
    duration = min(enough)
    too_short = duration * (1.0 - LEAST_TIME_GAP)
    proofs: tuple[TimeProof, ...] = ()
    if torque.grows_possible and move.shares(duration).convex:
        proof = proof_by(trials.solution(too_short).certificate, move, 0.0, too_short)
        proofs = (proof,) if proof.stands(move) else ()
    return LeastTime(move, duration, trials.solutions[duration], proofs)


def least_time_of_follower(move: TimedMove, without: LeastTime) -> LeastTime:
    """The least time that is found upward from that without a limit of the vibration that is left.

    Laws of a longer time may leave more again. So shorter times are proven to be too short only as far as they are
    without that limit.
    """
    trials = _Trials(move)
    low = high = log(without.duration)
    while trials.excess(high) > log(1.0 + FEASIBILITY):
        low, high = high, high + _UPWARD
        if high - log(without.duration) > _WIDEST:
            raise unsettled(move, exp(high))
    if low < high:
        brentq(trials.excess, low, high, xtol=0.1 * LEAST_TIME_MET)
    enough = (time for time, solution in trials.solutions.items() if solution.objective <= 1.0 + FEASIBILITY)
    duration = min(enough)
    return LeastTime(move, duration, trials.solutions[duration], without.proofs)


def _bracket(trials: _Trials, logarithm: float) -> tuple[float, float]:
    """Logarithms of a time that is too short and of one that is enough.

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
