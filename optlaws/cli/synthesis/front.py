"""The command `optlaws front`: exchanges between two or three constants."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import optlaws
from optlaws.cli.options import AsJson, Whole, check_picture
from optlaws.cli.problem_options import asks_for_a_problem
from optlaws.cli.show import busy, print_json, show, table


@asks_for_a_problem(
    given={"degree": 9, "basis": "chebyshev"}, refused={"minimise": "the last constant of --over is minimised"}
)
def front(
    entries: dict[str, Any],
    *,
    over: str = "B,C",
    points: Whole = 50,
    between: tuple[float, float] | None = None,
    as_json: AsJson = False,
    csv: Path | None = None,
    plot: Path | None = None,
) -> None:
    """Find the laws that exchange constants for one another: each the best of its own problem.

    Parameters
    ----------
    over
        Two or three constants, separated by commas; the last is minimised at given values of the others.
    points
        How many laws.
    between
        Least and greatest value of the first constant; where it pays unless given.
    as_json
        Print one JSON object on stdout and nothing else.
    csv
        Write the constants of all laws to this file.
    plot
        Draw the front into this file, PNG or SVG.
    """
    check_picture(plot)
    problem = optlaws.Problem.from_dict(entries)
    with busy("solving"):
        found = optlaws.pareto_front(problem, tuple(over.split(",")), points=points, between=between)
    if csv is not None:
        _save_table(found, csv)
    if plot is not None:
        _save_picture(found, plot)
    if as_json:
        print_json(found.to_dict())
    else:
        _show(found)


def _show(found: optlaws.Front) -> None:
    from optlaws.synthesis.front import HEADINGS

    rows = table(*HEADINGS)
    for row in found.rows:
        rows.add_row(
            *(_cell(cell, ".0e" if name == "gap" else ".7g") for cell, name in zip(row, HEADINGS, strict=True))
        )
    show(rows)
    if found.failed:
        values = ", ".join(f"{value:.6g}" for value in found.failed)
        show(f"no law was found at {found.over[0]} = {values}")


def _cell(cell: float | str | None, form: str) -> str:
    return "" if cell is None else cell if isinstance(cell, str) else format(cell, form)


def _save_table(found: optlaws.Front, file: Path) -> None:
    from optlaws.files import tables, writing
    from optlaws.synthesis.front import HEADINGS

    about = f"{' and '.join(found.over)} exchanged: {found[0].problem!r}"
    writing.write(file, tables.to_csv(HEADINGS, found.rows, about=about))


def _save_picture(found: optlaws.Front, file: Path) -> None:
    from optlaws import drawing
    from optlaws.files import writing

    with drawing.style():
        figure = drawing.figure()
        drawing.draw_front(found, figure.subplots(), color=drawing.BLUES[3])
        writing.write(file, drawing.rendered(figure, file.suffix[1:]))
