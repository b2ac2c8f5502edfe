"""The law whose greatest share of the limits of a move in a given time is least."""

from __future__ import annotations

from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.least_time.move_limits import TimedMove
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.search import LawSearch, best_available
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import NO_OBJECTIVE

_UNBOUNDED = (
    "the limits leave the time without a least value: laws of order {order} keep {names} in any time. Limit the "
    "velocity, or ask for a higher order"
)


def law_in_time(move: TimedMove, duration: float, warm: ActiveSet | None, shortest: float | None = None) -> Solution:
    """The law whose greatest share of the limits in a time is least, begun from the contacts of a time near by.

    With a shortest time the limits are those of all times between.

    Raises
    ------
    InfeasibleProblem
        If no law keeps the problem's own windows and bounds.
    InputError
        If every time satisfies the limits.
    SolverFailure
        If the search fails.
    """
    problem = move.shares(duration, shortest=shortest)
    search = LawSearch(model_of(problem), warm=warm)
    solution = best_available(search)
    if solution is None:
        raise _no_law(move, duration, search.error())
    if not solution.objective > NO_OBJECTIVE:
        names = " and ".join(limit.name for limit in move.limits_in(duration))
        raise InputError(_UNBOUNDED.format(order=problem.order, names=names))
    return solution


def _no_law(
    move: TimedMove, duration: float, error: InfeasibleProblem | SolverFailure
) -> InfeasibleProblem | SolverFailure:
    """The error of a space without laws: without any from rest to rest, or in a time that the limits require."""
    if isinstance(error, SolverFailure):
        return error
    message = f"no time is long enough: {error.args[0]}"
    if not move.at_rest:
        message = (
            f"the limits need more than {duration:.6g} s, but in that time the velocities at the ends contradict the "
            f"problem itself: {error.args[0]}"
        )
    return InfeasibleProblem(message, problem=move.problem, tried=error.tried, proof=error.proof)


def unsettled(move: TimedMove, duration: float) -> SolverFailure:
    """The error of a search that ends without a time."""
    return SolverFailure(
        f"the steps of the time did not settle, the last at {duration:.9g} s; another degree or order helps",
        problem=move.problem,
    )
