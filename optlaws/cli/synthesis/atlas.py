"""The command `optlaws atlas`: a law looked up in the atlas, then solved exactly."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import optlaws
from optlaws.cli.options import AsJson, Plot, check_files, save_picture
from optlaws.cli.problem_options import asks_for_a_problem
from optlaws.cli.show import print_json, show, table
from optlaws.errors import InputError
from optlaws.synthesis.problem.fields import CONSTANTS, ENTRIES

_KNOWN = ("minimise", "order", *CONSTANTS, "bounds")
_ELSEWHERE = "the atlas holds symmetric laws from rest to rest by B, order and degree; optlaws solve takes it"


@asks_for_a_problem(given={"order": ...}, refused={name: _ELSEWHERE for name in ENTRIES if name not in _KNOWN})
def atlas(
    entries: dict[str, Any],
    *,
    file: Path = Path("results/atlas/atlas.csv"),
    plot: Plot = None,
    as_json: AsJson = False,
) -> None:
    """Look up a law in the atlas: the nearest point that satisfies the request, then the law for the exact request.

    Parameters
    ----------
    file
        The atlas; where it is not there the one that comes with optlaws.
    plot
        Draw the law into this file, PNG or SVG.
    as_json
        Print one JSON object on stdout and nothing else.
    """
    from optlaws.files.packaged import or_packaged
    from optlaws.jobs.atlas import best_law, look_up

    check_files(plot=plot)
    query: dict[str, Any] = {name: entries[name] for name in ("minimise", "order")}
    query |= {"B": entries.get("B"), "most": _greatest(entries)}
    table_of_laws = or_packaged(file)
    point = look_up(table_of_laws, **query)
    solution = best_law(table_of_laws, **query)
    exact = {name: getattr(solution.constants, name).value for name in ("B", "C", "D", "J")}
    exact["rms_c"] = solution.constants.rms_c
    if plot is not None:
        save_picture(plot, solution)
    if as_json:
        near = {"minimise": point.minimise, "B": point.B, "degree": point.degree, "constants": dict(point.constants)}
        law = solution.law.to_dict()
        print_json({"nearest": near, "status": solution.status.value, "constants": exact, "law": law})
        return
    nearest = {name: f"{value:.8g}" for name, value in point.constants.items()}
    rows = ([name, nearest.get(name, ""), f"{value:.10g}"] for name, value in exact.items())
    show(table("constant", "in the atlas", "as asked", rows=rows), f"{solution.status.value}: {solution.problem!r}")


def _greatest(entries: Mapping[str, Any]) -> dict[str, float]:
    """Greatest values that the options allow, by constant."""
    bounds: Mapping[str, optlaws.Range] = entries.get("bounds", {})
    greatest = {name: entries[name].high for name in CONSTANTS if name in entries and name != "B"}
    for name, bound in bounds.items():
        if name in greatest or (name == "B" and "B" in entries):
            raise InputError(f"{name} is given twice: by its own option and by --most {name}=...")
        if bound.low > 0.0:
            raise InputError("--least is not for this command: the atlas is searched by greatest values")
    return greatest | {name: bound.high for name, bound in bounds.items()}
