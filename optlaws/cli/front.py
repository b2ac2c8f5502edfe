"""The subcommand `optlaws front`: exchanges between two or three constants."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter, Token
from rich.console import Console
from rich.table import Table

from optlaws.errors import InputError
from optlaws.synthesis import Problem, basis
from optlaws.synthesis.front import HEADINGS, Front

_PICTURES = (".png", ".svg")


def _whole(_: object, tokens: Sequence[Token]) -> int:
    # the parser itself would cut 2.5 to 2
    return int(tokens[0].value)


Whole = Annotated[int, Parameter(converter=_whole)]


def front(
    *,
    over: str = "B,C",
    order: Whole,
    degree: Whole = 9,
    points: Whole = 50,
    between: tuple[float, float] | None = None,
    peak_velocity: float | None = None,
    basis_name: Annotated[Literal["powers", "chebyshev"], Parameter(name="--basis")] = "chebyshev",
    monotone: bool = False,
    as_json: Annotated[bool, Parameter(name="--json")] = False,
    csv: Path | None = None,
    plot: Path | None = None,
) -> None:
    """Find the laws that exchange constants for one another: each the best of its own problem.

    Parameters
    ----------
    over
        Two or three constants, separated by commas; the last is minimised at given values of the others.
    order
        Number l of boundary conditions at each end.
    degree
        Degree of Z(k).
    points
        How many laws.
    between
        Least and greatest value of the first constant; where it pays unless given.
    peak_velocity
        B, where it is not exchanged; free unless given.
    basis_name
        Basis of Z(k).
    monotone
        Ask b >= 0 too: no return within the motion.
    as_json
        Print one JSON object on stdout and nothing else.
    csv
        Write the constants of all laws to this file.
    plot
        Draw the front into this file, PNG or SVG.
    """
    from optlaws.synthesis.pareto import pareto_front

    if plot is not None and plot.suffix not in _PICTURES:
        raise InputError(f"--plot takes a file name that ends in {' or '.join(_PICTURES)}, got {plot}")
    problem = Problem(B=peak_velocity, order=order, basis=basis(basis_name, degree), monotone=monotone)
    progress = Console(stderr=True)
    with progress.status("solving") if progress.is_terminal else nullcontext():
        found = pareto_front(problem, tuple(over.split(",")), points=points, between=between)
    if csv is not None:
        _save_table(found, csv)
    if plot is not None:
        _save_picture(found, plot)
    if as_json:
        print(json.dumps(found.to_dict()))  # noqa: T201
    else:
        _show(found)


def _show(found: Front) -> None:
    table = Table(*HEADINGS, box=None, pad_edge=False)
    for row in found.rows:
        table.add_row(
            *(_cell(cell, ".0e" if name == "gap" else ".7g") for cell, name in zip(row, HEADINGS, strict=True))
        )
    console = Console()
    console.print(table)
    if found.failed:
        values = ", ".join(f"{value:.6g}" for value in found.failed)
        console.print(f"no law was found at {found.over[0]} = {values}", highlight=False)


def _cell(cell: float | str | None, form: str) -> str:
    return "" if cell is None else cell if isinstance(cell, str) else format(cell, form)


def _save_table(found: Front, file: Path) -> None:
    from optlaws.files import tables, writing

    about = f"{' and '.join(found.over)} exchanged: {found[0].problem!r}"
    writing.write(file, tables.to_csv(HEADINGS, found.rows, about=about))


def _save_picture(found: Front, file: Path) -> None:
    from optlaws import drawing
    from optlaws.files import writing as files

    with drawing.style():
        figure = drawing.figure()
        drawing.draw_front(found, figure.subplots(), color=drawing.BLUES[3])
        files.write(file, drawing.rendered(figure, file.suffix[1:]))
