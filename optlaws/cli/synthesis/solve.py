"""The command `optlaws solve`: one problem, its law and its proof; or the least time of a move within limits."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, Literal

import optlaws
from optlaws.cli.law_options import LIMITS
from optlaws.cli.options import Written, given, options, takes
from optlaws.cli.problem_options import problem_options
from optlaws.cli.show import Answer, save
from optlaws.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: the law that most designers would take, and the followers it is compared for: two to five vibrations in the motion
_USUAL, _FREQUENCIES = "modified sine", (12.0, 32.0)
_KEYS = ("status", "objective", "lower_bound", "gap", "best_possible", "constants", "z", "law", "iterations", "seconds")
_MOVE_KEYS = ("unit", "stroke", "limits", "duration", "best_possible")
_MOVE = options(
    "optlaws.cycles.moves.timed_moves:fastest",
    *("stroke", "start_velocity", "end_velocity"),
    group="The move of --fastest",
    limits=LIMITS,
)


@takes(
    "Draw the law with its bounds, or the fastest move with its limits, into this file, PNG or SVG.",
    entries=problem_options({"degree": 9, "basis": "chebyshev"}),
    move=_MOVE,
)
def solve(
    entries: dict[str, Any],
    *,
    bound: Literal["quick", "tight"] = "quick",
    method: Literal["auto", "ipopt"] = "auto",
    fastest: bool = False,
    move: Mapping[str, Any],
    output: Written = None,
) -> Answer:
    """Find the law with the least peak constant or mixture of constants, or the least time of a move, and prove it.

    Parameters
    ----------
    bound
        Where D is in the problem: tight searches all laws, for a bound that usually meets the objective.
    method
        How programs are solved: auto by what suits their rows, ipopt each as a nonlinear program of CasADi.
    fastest
        Find the least time of a move within limits, and the law that takes it; with --stroke and --limit.
    output
        Write the whole solution, with its problem and certificate, to this JSON file.
    """
    if fastest and (move["stroke"] is None or not move["limits"]):
        raise InputError('--fastest needs --stroke, such as "100 mm", and --limit, such as "jerk=300 m/s^3"')
    for name in () if fastest else given(move):
        raise InputError(f"{_MOVE[name].name} goes with --fastest")
    if fastest and method != "auto":
        raise InputError("--method is of a single problem: --fastest finds its least time in its own way")
    problem = optlaws.Problem.from_dict(entries)
    result = optlaws.fastest(problem, **move) if fastest else optlaws.synthesize(problem, bound=bound, method=method)
    whole = cache(result.to_dict)  # with proofs, which takes a tenth of a second
    if output is not None:
        save(output, whole())
    if isinstance(result, optlaws.Solution):
        solution = result
        return Answer(
            lambda: [solution.summary(), *_remarks(solution)],
            lambda: {name: whole()[name] for name in _KEYS},
            solution.plot,
        )
    timed = result

    def data() -> dict[str, Any]:
        rest = {"none_below": timed.none_below, "binding": list(timed.binding), "gains": timed.gains()}
        beside = {} if timed.beside is None else timed.beside.data
        return {name: whole()[name] for name in _MOVE_KEYS} | rest | beside

    def drawn() -> Figure:
        from optlaws.plots.moves import motion_figure

        return motion_figure(timed, f"{move['stroke']} in {timed.duration:.6g} s")

    return Answer(lambda: [timed.report()], data, drawn)


def _remarks(solution: optlaws.Solution) -> list[str]:
    """Remarks on a law of least C without other bounds, whose jerk is far above that of modified sine."""
    problem = solution.problem
    if str(problem.minimise) != "C" or problem.bounded or problem.boundary is not None:
        return []
    from optlaws.cycles.law_comparison import costs

    usual = optlaws.catalogue[_USUAL].law
    prices = costs(solution.law, usual, _USUAL, frequency=_FREQUENCIES)
    low, high = _FREQUENCIES
    return [
        f"note: the least C alone has {text}"
        + (f" (worst of frequencies {low:g} to {high:g})" if "residual" in text else "")
        for text in prices
    ] + (["bound what matters, for example by --most-jerk"] if prices else [])
