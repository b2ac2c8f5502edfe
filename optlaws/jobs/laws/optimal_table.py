"""The job "optimal table": a printed table of optimal laws, recomputed, proven and extended."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from optlaws import drawing
from optlaws.files import tables, writing
from optlaws.files.problem_file import convert
from optlaws.jobs.laws.printed_rows import COLUMNS, Row, Table, check, degree_of, solved
from optlaws.jobs.laws.table_figure import draw
from optlaws.jobs.pages import printed
from optlaws.jobs.pages.page import Page
from optlaws.laws import MotionLaw
from optlaws.synthesis import Solution, acceleration_limit


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Table, file)
    source = file.parent / spec.printed
    lines = printed.rows(source, COLUMNS)
    check(spec, lines, str(source))
    rows, curves = solved(spec, lines)
    verdicts = _verdicts(spec, rows)
    about = f"{spec.title}; from {file.name}"
    headings, cells = _cells(spec, rows)
    judged = [(v.row, v.quantity, v.printed, v.exact, v.on_grid, v.verdict, v.reason) for v in verdicts]
    verdict_headings = ("row B", "quantity", "printed", "exact", "on grid", "verdict", "reason")
    figure = draw(spec, rows, curves)
    return [
        writing.write(out / "table.csv", tables.to_csv(headings, cells, about=about)),
        writing.write(out / "verdicts.csv", tables.to_csv(verdict_headings, judged, about=about)),
        writing.write(out / "table.md", str(_page(spec, headings, cells, verdict_headings, judged))),
        writing.write(out / "laws.json", _laws(about, rows)),
        *drawing.save_picture(figure, out / "figure"),
    ]


def _verdicts(spec: Table, rows: Sequence[Row]) -> list[printed.Verdict]:
    wrong = {(m.row, m.quantity): m for m in spec.misprint}
    verdicts = []
    for row in rows:
        constants, on_grid = row.law.constants, on_paper_grid(spec, row.law)
        for name, peak in (("B", constants.B), ("C", constants.C), ("D", constants.D)):
            text = row.cells[name]
            misprint = wrong.get((row.cells["B"], name))
            reason = misprint.reason if misprint else None
            verdicts.append(
                printed.judge(row.cells["B"], name, text, peak.value, on_grid=on_grid[name], misprint=reason)
            )
        verdicts += [
            printed.Verdict(m.row, m.quantity, f"{m.printed:.10g}", m.means, None, printed.MISPRINT, m.reason)
            for m in spec.misprint
            if m.row == row.cells["B"] and m.means is not None
        ]
    return verdicts


def on_paper_grid(spec: Table, law: MotionLaw) -> dict[str, float]:
    """B, C and D as the paper has them: the greatest values at the points of its grid, C without the deceleration."""
    grid = np.linspace(0.0, 1.0, spec.grid + 1)
    return {"B": float(law.b(grid).max()), "C": float(law.c(grid).max()), "D": float(np.abs(law.d(grid)).max())}


def _cells(spec: Table, rows: Sequence[Row]) -> tuple[list[str], list[list[tables.Cell]]]:
    headings = ["B", "C printed", "D printed", "B exact", "C exact", "at k", "D exact", "at k", "J exact"]
    headings += ["order l", "degree of Z", "C optimal", "lower bound", "gap <="]
    headings += [f"C optimal, l={spec.order}, degree {degree}" for degree in spec.degrees]
    headings += ["greatest gap <=", "limit", "limit, b >= 0"]
    cells: list[list[tables.Cell]] = []
    for row in rows:
        constants, same = row.law.constants, row.same
        line: list[tables.Cell] = [row.cells["B"], row.cells["C"], row.cells["D"]]
        line += [constants.B.value, constants.C.value, round(constants.C.k, 4)]
        line += [constants.D.value, round(constants.D.k, 4), constants.J.value]
        line += [
            same.problem.order,
            degree_of(same),
            same.objective,
            same.lower_bound,
            _decade(same.gap),
        ]
        line += [row.richer[degree].objective for degree in spec.degrees]
        line += [_decade(max(s.gap for s in row.richer.values()))]
        line += [acceleration_limit(row.B), acceleration_limit(row.B, monotone=True)]
        cells.append(line)
    return headings, cells


def _decade(gap: float) -> str:
    # the power of ten above it, 1e-10 at least: what lies below is rounding, and differs between machines
    return f"1e{int(np.ceil(np.log10(max(gap, 1e-10))))}"


def _page(
    spec: Table,
    headings: Sequence[str],
    cells: Sequence[Sequence[tables.Cell]],
    verdict_headings: Sequence[str],
    verdicts: Sequence[Sequence[tables.Cell]],
) -> Page:
    split = headings.index("order l")
    page = Page(spec.title).heading("What is printed, and what the printed Z(k) gives")
    page.table(headings[:split], [line[:split] for line in cells])
    page.heading("What is possible").text(
        "The least C of laws of the printed row's own order and degree of Z with its proven lower bound, then of\n"
        f"laws of order {spec.order} with richer Z, each proven to the gap shown, and the limits that no law of\n"
        "any degree can beat."
    )
    tail = [[line[0], *line[split:]] for line in cells]
    page.table(["B", *(_short(heading) for heading in headings[split:])], tail)
    return page.heading("Every printed number").table(verdict_headings, verdicts)


def _short(heading: str) -> str:
    return heading.rpartition(", ")[2] if heading.startswith("C optimal, ") else heading


def _laws(about: str, rows: Sequence[Row]) -> str:
    content = {
        "about": f"{about}; {writing.MARK}",
        "rows": [
            {
                "B": row.cells["B"],
                "printed": _law(row.law),
                "same shape": _solution(row.same),
                "richer": {str(degree): _solution(solution) for degree, solution in row.richer.items()},
            }
            for row in rows
        ],
    }
    return json.dumps(content, indent=1) + "\n"


def _solution(solution: Solution) -> dict[str, Any]:
    kept = ("status", "objective", "lower_bound", "limit", "constants", "z", "law", "problem", "certificate")
    whole = solution.to_dict()
    return {name: whole[name] for name in kept}


def _law(law: MotionLaw) -> dict[str, Any]:
    return {"law": law.to_dict(), "constants": law.constants.to_dict()}
