"""The subcommand `optlaws atlas`: a law looked up in the atlas, then solved exactly."""

from __future__ import annotations

import json
from math import isfinite
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.console import Console
from rich.table import Table

from optlaws.errors import InputError
from optlaws.jobs.laws.atlas_lookup import look_up, problem
from optlaws.synthesis import synthesize
from optlaws.synthesis.problem.ranges import read_bounds


def atlas(
    *,
    order: int,
    minimise: str = "C",
    peak_velocity: float | None = None,
    most: list[str] | None = None,
    file: Path = Path("results/atlas/atlas.csv"),
    as_json: Annotated[bool, Parameter(name="--json")] = False,
) -> None:
    """Look a law up in the atlas: the nearest point that keeps what is asked, then the law as asked.

    Parameters
    ----------
    order
        Number l of boundary conditions at each end.
    minimise
        What is least: C, D, J or rms_c.
    peak_velocity
        B; free unless given.
    most
        Any of B, C, D, J and rms_c at most a value, such as D=6; may be repeated.
    file
        The atlas.
    as_json
        Print one JSON object on stdout and nothing else.
    """
    asked = {name: one.high for name, one in read_bounds(most or []).items()}
    if peak_velocity is not None and "B" in asked:
        raise InputError("give --peak-velocity or --most B=..., not both")
    point = look_up(file, minimise=minimise, order=order, B=peak_velocity, most=asked)
    solution = synthesize(problem(point, B=peak_velocity, most=asked))
    found = {name: getattr(solution.constants, name).value for name in ("B", "C", "D", "J")}
    found["rms_c"] = solution.constants.rms_c
    if as_json:
        exact = {name: value if isfinite(value) else None for name, value in found.items()}
        near = {"B": point.B, "degree": point.degree, "constants": dict(point.constants)}
        law = solution.law.to_dict()
        print(json.dumps({"nearest": near, "status": solution.status.value, "constants": exact, "law": law}))  # noqa: T201
        return
    table = Table("constant", "in the atlas", "as asked", box=None, pad_edge=False)
    for name, value in found.items():
        table.add_row(name, f"{point.constants[name]:.8g}" if name in point.constants else "", f"{value:.10g}")
    console = Console()
    console.print(table)
    console.print(f"{solution.status.value}: {solution.problem!r}", markup=False, highlight=False, soft_wrap=True)
