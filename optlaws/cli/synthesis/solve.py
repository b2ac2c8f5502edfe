"""The command `optlaws solve`: one problem, its law and its proof."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import optlaws
from optlaws.cli.options import AsJson, Plot, Written, save, save_picture, takes
from optlaws.cli.problem_options import asks_for_a_problem
from optlaws.cli.show import print_json, show, summary_table, table
from optlaws.cli.timed_move import MOVE, answer, check_move

#: the law that most designers would take, and the followers it is compared for: two to five vibrations in the motion
_USUAL, _FREQUENCIES = "modified sine", (12.0, 32.0)


@asks_for_a_problem(given={"degree": 9, "basis": "chebyshev"})
@takes(move=MOVE)
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
    check_move(move, fastest=fastest)
    if fastest:
        answer(optlaws.Problem.from_dict(entries), move, as_json=as_json, output=output, plot=plot)
        return
    solution = optlaws.synthesize(optlaws.Problem.from_dict(entries), bound=bound)
    save(output, solution.to_dict())
    save_picture(plot, solution)
    if as_json:
        print_json(_summary(solution))
    else:
        _show(solution)


def _summary(solution: optlaws.Solution) -> dict[str, Any]:
    whole = solution.to_dict()
    names = ("status", "objective", "lower_bound", "gap", "limit", "constants", "z", "law", "iterations", "seconds")
    return {name: whole[name] for name in names}


#: how notes stand behind what they are of
_NOTES = {"status": ": {}", "lower bound": " ({})", "Z(k)": "  ({})"}


def _show(solution: optlaws.Solution) -> None:
    facts, notes, constants = table(), [], solution.constants.summary()
    for row in solution.summary():
        if row.name == "note":
            notes.append(f"note: {row.value}")
        elif row not in constants:
            note = _NOTES.get(row.name, ", {}").format(row.note) if row.note else ""
            facts.add_row(row.name, f"{row.text()}{note}")
    show(facts, summary_table(constants, "constant"), *notes, *_remarks(solution))


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
