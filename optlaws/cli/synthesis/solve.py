"""The command `optlaws solve`: one problem, its law and its proof; or the least time of a move within limits."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import optlaws
from optlaws.cli.law_options import LIMITS
from optlaws.cli.options import (
    AsJson,
    Plot,
    Written,
    given,
    options,
    save,
    save_figure,
    save_picture,
    takes,
    without_body,
)
from optlaws.cli.problem_options import asks_for_a_problem
from optlaws.cli.show import print_json, show, summary_table, table
from optlaws.errors import InputError

#: the law that most designers would take, and the followers it is compared for: two to five vibrations in the motion
_USUAL, _FREQUENCIES = "modified sine", (12.0, 32.0)
_KEYS = ("status", "objective", "lower_bound", "gap", "limit", "constants", "z", "law", "iterations", "seconds")
_MOVE_KEYS = ("unit", "stroke", "limits", "duration", "limit")
_MOVE = options(
    without_body("optlaws.cycles.moves.timed_moves:fastest"),
    "stroke",
    "start_velocity",
    "end_velocity",
    group="The move of --fastest",
    limits=LIMITS,
)


@asks_for_a_problem(given={"degree": 9, "basis": "chebyshev"})
@takes(move=_MOVE)
def solve(
    entries: dict[str, Any],
    *,
    bound: Literal["quick", "tight"] = "quick",
    fastest: bool = False,
    move: Mapping[str, Any],
    plot: Plot = None,
    as_json: AsJson = False,
    output: Written = None,
) -> None:
    """Find the law with the least peak constant or mixture of constants, or the least time of a move, and prove it.

    Parameters
    ----------
    bound
        Where D is in the problem: tight searches all laws, for a bound that usually meets the objective.
    fastest
        Find the least time of a move within limits, and the law that takes it; with --stroke and --limit.
    plot
        Draw the law with its bounds, or the fastest move with its limits, into this file, PNG or SVG.
    output
        Write the whole solution, with its problem and certificate, to this JSON file.
    """
    if fastest and (move["stroke"] is None or not move["limits"]):
        raise InputError('--fastest needs --stroke, such as "100 mm", and --limit, such as "jerk=300 m/s^3"')
    for name in () if fastest else given(move):
        raise InputError(f"{_MOVE[name].name} goes with --fastest")
    problem = optlaws.Problem.from_dict(entries)
    if fastest:
        timed = optlaws.fastest(problem, **move)
        if plot is not None:
            from optlaws.plots.moves import motion_figure

            save_figure(plot, motion_figure(timed, f"{move['stroke']} in {timed.duration:.6g} s"))
        _answer(timed, output, as_json=as_json)
    else:
        solution = optlaws.synthesize(problem, bound=bound)
        save_picture(plot, solution)
        _answer(solution, output, as_json=as_json)


def _answer(result: optlaws.Solution | optlaws.FastestMove, output: Path | None, *, as_json: bool) -> None:
    """Write a result to a file, and print it; its plain data, with their proofs, take a tenth of a second."""
    if as_json or output is not None:
        whole = result.to_dict()
        save(output, whole)
    if not as_json:
        show(*(_shown(result) if isinstance(result, optlaws.Solution) else [result.summary()]))
    elif isinstance(result, optlaws.Solution):
        print_json({name: whole[name] for name in _KEYS})
    else:
        rest = {"none_below": result.none_below, "binding": list(result.binding), "gains": result.gains()}
        print_json({name: whole[name] for name in _MOVE_KEYS} | rest)


#: how notes stand behind what they are of
_NOTES = {"status": ": {}", "lower bound": " ({})", "Z(k)": "  ({})"}


def _shown(solution: optlaws.Solution) -> list[Any]:
    facts, notes, constants = table(), [], solution.constants.summary()
    for row in solution.summary():
        if row.name == "note":
            notes.append(f"note: {row.value}")
        elif row not in constants:
            note = _NOTES.get(row.name, ", {}").format(row.note) if row.note else ""
            facts.add_row(row.name, f"{row.text()}{note}")
    return [facts, summary_table(constants, "constant"), *notes, *_remarks(solution)]


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
