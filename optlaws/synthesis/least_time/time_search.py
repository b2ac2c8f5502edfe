"""The search for the least time of a move: Newton steps on the least greatest share of its limits.

In each time the law is sought whose greatest share of the limits is least. Its multipliers say up to which time no law
keeps the limits; that time is the next. From below the steps end at the first time in which a law keeps them.
"""

from __future__ import annotations

from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.least_time.fastest_law import law_in_time, unsettled
from optlaws.synthesis.least_time.least_time import LeastTime
from optlaws.synthesis.least_time.motor_search import least_time_of_follower, least_time_of_motor
from optlaws.synthesis.least_time.move_limits import TimedMove
from optlaws.synthesis.least_time.segment_times import time_of_any_law
from optlaws.synthesis.least_time.time_proof import Multipliers, covering
from optlaws.synthesis.problem.constants import meant
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import BOUND_FEASIBILITY, FEASIBILITY, LEAST_TIME_GAP, LEAST_TIME_MET

#: how much slower than all laws those of a space are that is tried first, so that the right limits bind at once
_SLOWER = 1.02
_STEPS = 60
#: so many steps settle the time but for what rounding leaves
_SETTLING = 12
#: of the gap that is allowed, what a step may go beyond its multipliers
_LITTLE = 0.1


def least_time(move: TimedMove, near: LeastTime | None = None) -> LeastTime:
    """The least time in which a law of the move's space keeps its limits, proven to a millionth.

    From rest to rest the search may begin near that of another stroke in the same space: its multipliers say of this
    stroke too which times are too short; its contacts are those to begin with where a torque is limited.

    Raises
    ------
    InfeasibleProblem
        If no law keeps the problem's own windows and bounds, however long it takes.
    InputError
        If every time satisfies the limits.
    SolverFailure
        If the steps do not settle.
    """
    with meant():
        if move.residual is not None:
            return least_time_of_follower(move, least_time(move.without_residual))
        if move.torque is not None:
            return least_time_of_motor(move, near)
        duration, solution, known = _from_either_side(move, near) if move.at_rest else _from_below(move)
    return LeastTime(move, duration, solution, covering(move, known, duration * (1.0 - LEAST_TIME_GAP)))


_Known = list[tuple[float, Multipliers]]


def _from_either_side(move: TimedMove, near: LeastTime | None) -> tuple[float, Solution, _Known]:
    """Steps from rest to rest: the multipliers of any time prove an interval from zero up to the next time."""
    duration, warm = _first(move) if near is None else _beside(move, near)
    known: _Known = []
    for step in range(_STEPS):
        solution = law_in_time(move, duration, warm)
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
    raise unsettled(move, duration)


def _first(move: TimedMove) -> tuple[float, ActiveSet | None]:
    """An initial time slightly above the least time of all laws."""
    known = time_of_any_law(move.stroke, move.limits, move.problem.order)
    return _SLOWER * max(known or 0.0, move.least_conceivable()), None


def _beside(move: TimedMove, near: LeastTime) -> tuple[float, ActiveSet | None]:
    """The time up to which the multipliers of another stroke prove that no law keeps the limits, and its contacts."""
    if near.move.problem != move.problem or near.move.limits != move.limits:
        return _first(move)
    multipliers = Multipliers.of(near.move, near.duration, near.solution).of_stroke(move.stroke / near.move.stroke)
    return multipliers.longest(near.duration), near.solution.active_set


def _from_below(move: TimedMove) -> tuple[float, Solution, _Known]:
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
    raise unsettled(move, duration)
