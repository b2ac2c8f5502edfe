"""The command `optlaws atlas`: a law looked up in the atlas, then solved exactly."""

from __future__ import annotations

from pathlib import Path

import optlaws
from optlaws.cli.options import AsJson, Whole
from optlaws.cli.show import print_json, show, table
from optlaws.errors import InputError


def atlas(
    *,
    order: Whole,
    minimise: str = "C",
    peak_velocity: float | None = None,
    most: list[str] | None = None,
    file: Path = Path("results/atlas/atlas.csv"),
    as_json: AsJson = False,
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
    from optlaws.jobs.laws.atlas_lookup import look_up, problem
    from optlaws.synthesis.problem.ranges import read_bounds

    asked = {name: one.high for name, one in read_bounds(most or []).items()}
    if peak_velocity is not None and "B" in asked:
        raise InputError("give --peak-velocity or --most B=..., not both")
    point = look_up(file, minimise=minimise, order=order, B=peak_velocity, most=asked)
    solution = optlaws.synthesize(problem(point, B=peak_velocity, most=asked))
    exact = {name: getattr(solution.constants, name).value for name in ("B", "C", "D", "J")}
    exact["rms_c"] = solution.constants.rms_c
    if as_json:
        near = {"B": point.B, "degree": point.degree, "constants": dict(point.constants)}
        law = solution.law.to_dict()
        print_json({"nearest": near, "status": solution.status.value, "constants": exact, "law": law})
        return
    rows = table("constant", "in the atlas", "as asked")
    for name, value in exact.items():
        rows.add_row(name, f"{point.constants[name]:.8g}" if name in point.constants else "", f"{value:.10g}")
    show(rows, f"{solution.status.value}: {solution.problem!r}")
