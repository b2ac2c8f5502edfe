"""The job "loader table": printed constants of inertial loaders, each recomputed and judged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite, sqrt
from pathlib import Path
from typing import Annotated, Any

import msgspec
import numpy as np

from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.pages import printed
from optlaws.jobs.pages.page import Page
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.loader.loader import Loader, loader
from optlaws.mechanisms.loader.trapezium import TrapeziumSubstitute, closed_form_Y

COLUMNS = ("code", "law", "B", "C", "D")
CONSTANTS = ("B", "C", "D")
HEADINGS = ("law", "Y", "B", "B printed", "C", "at k", "C at turn", "C printed", "D", "D printed")
ENERGY = ("law", "Y", "Y by eq. 25", "a trapezium?", "Y from B printed", "from C", "from D")
EXACT = 1e-3
EXPLAINED = 0.006

_ABOUT_TABLE = (
    "Y, B, C and D of the loader, recomputed. C is the peak over the whole interval; C at turn is what the paper's "
    "formula gives, the acceleration at k = 1/2."
)
_ABOUT_ENERGY = (
    "Y of each law, of the trapezium with its e13 and gamma_w (eq. 25, also where no trapezium has them), and the Y "
    "that each printed number stands for, as the peak or as the greatest value at the grid, whichever is nearer to "
    "the Y of the row's B."
)


class Table(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    printed: Text
    grid: Annotated[int, msgspec.Meta(ge=2)]


@dataclass(frozen=True)
class Row:
    """A printed row, its loader, and the greatest values of the loader's C and D at the paper's grid."""

    code: str
    given: Mapping[str, str]
    one: Loader
    on_grid: Mapping[str, float | None]

    @property
    def exact(self) -> dict[str, float]:
        """The loader's B, C and D."""
        return {"B": self.one.B, "C": self.one.C, "D": self.one.D}

    def implied(self, name: str) -> tuple[float, bool]:
        """The Y with which a printed number would be right, and whether it was then taken at the paper's grid.

        Of the peak and the greatest value at the grid it is the one that gives the Y nearer to that of the row's B.
        """
        size = float(self.given[name])
        from_B = self.one.Y * float(self.given["B"]) / self.one.B
        candidates = []
        for seen, gridded in ((self.exact[name], False), (self.on_grid[name], True)):
            if seen is not None and isfinite(seen):
                ratio = size / seen
                candidates.append((self.one.Y * (sqrt(ratio) if name == "D" else ratio), gridded))
        return min(candidates, key=lambda pair: abs(pair[0] / from_B - 1.0))


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Table, file)
    rows = [recomputed(line, spec.grid) for line in printed.rows(file.parent / spec.printed, COLUMNS)]
    judged = [verdict for row in rows for verdict in _verdicts(row)]
    about = f"{spec.title}; from {file.name}"
    headings = ("row", "quantity", "printed", "exact", "on grid", "verdict", "reason")
    lines = [[getattr(judgement, name.replace(" ", "_")) for name in headings] for judgement in judged]
    return [
        writing.write(out / "table.csv", tables.to_csv(HEADINGS, _table(rows), about=about)),
        writing.write(out / "energy.csv", tables.to_csv(ENERGY, _energy(rows), about=about)),
        writing.write(out / "verdicts.csv", tables.to_csv(headings, lines, about=about)),
        writing.write(out / "table.md", str(_page(spec, rows, judged))),
    ]


def recomputed(given: Mapping[str, str], grid: int) -> Row:
    """A printed row with its loader and what the paper's grid shows of it."""
    for name in CONSTANTS:
        if given[name] != "inf":
            printed.number(given[name], f"row {given['code']}, {name}")
    mechanism = loader(catalogue[given["law"]].law)
    k = np.linspace(0.0, 1.0, grid + 1)
    moving = k[mechanism.law.b(k) != 0.0]  # where the loader turns, the paper's formula for c is 0/0
    on_grid = {
        "B": None,
        "C": float(np.abs(mechanism.law.c(moving)).max()),
        "D": float(np.abs(mechanism.law.d(k)).max()),
    }
    return Row(given["code"], given, mechanism, on_grid)


def _verdicts(row: Row) -> list[printed.Verdict]:
    verdicts = []
    for name, exact in row.exact.items():
        text = row.given[name]
        if text == "inf":
            reproduced = exact == inf
            verdict = printed.REPRODUCED if reproduced else "off: it is finite"
            verdicts.append(printed.Verdict(row.code, name, text, exact, None, verdict, ""))
            continue
        judgement = printed.judge(row.code, name, text, exact, on_grid=row.on_grid[name], misprint=None)
        off = float(text) / exact - 1.0
        if judgement.verdict not in {printed.REPRODUCED, printed.ON_GRID} and abs(off) >= EXACT:
            judgement = replace(judgement, verdict=f"off by {100.0 * off:+.2g} %", reason=_reason(row, name))
        verdicts.append(judgement)
    return verdicts


def _reason(row: Row, name: str) -> str:
    """What is known of a number that is off: how much of it is the row's wrong Y."""
    from_B = row.implied("B")[0]
    wrong = from_B / row.one.Y - 1.0
    said = f"the row's B means Y = {from_B:.5g} instead of {row.one.Y:.5g} ({100 * wrong:+.2g} %)"
    if name == "B":
        near = closed_form_Y(*_shape(row.one))
        return f"{said}; eq. 25 gives {near:.4g}{'' if _is_trapezium(row.one) else ' outside its domain'}"
    own, gridded = row.implied(name)
    left = (own / from_B) ** (2 if name == "D" else 1) - 1.0
    grid = ", taken at the paper's grid" if gridded else ""
    if abs(left) <= EXPLAINED:
        return f"{said}: {name} follows from it{grid} (to {100 * abs(left):.1g} %)"
    return f"{said}; {100 * left:+.2g} % remain{grid}, of unknown cause"


def _shape(mechanism: Loader) -> tuple[float, float]:
    B, C = (mechanism.executive.peak(nu).value for nu in (1, 2))
    return 1.0 / B, B / C


def _is_trapezium(mechanism: Loader) -> bool:
    try:
        TrapeziumSubstitute(*_shape(mechanism))
    except InputError:
        return False
    return True


def _table(rows: Sequence[Row]) -> list[list[tables.Cell]]:
    return [
        [
            row.code,
            row.one.Y,
            row.one.B,
            row.given["B"],
            row.one.C,
            round(row.one.law.peak(2).k, 9),
            row.one.C_at_turn,
            row.given["C"],
            row.one.D,
            row.given["D"],
        ]
        for row in rows
    ]


def _energy(rows: Sequence[Row]) -> list[list[tables.Cell]]:
    return [
        [
            row.code,
            row.one.Y,
            closed_form_Y(*_shape(row.one)),
            "yes" if _is_trapezium(row.one) else "no",
            *(row.implied(name)[0] if isfinite(row.exact[name]) else None for name in CONSTANTS),
        ]
        for row in rows
    ]


def _page(spec: Table, rows: Sequence[Row], judged: Sequence[printed.Verdict]) -> Page:
    good = sum(judgement.verdict in {printed.REPRODUCED, printed.ON_GRID} for judgement in judged)
    lines = [
        [judgement.row, judgement.quantity, judgement.printed, judgement.exact, judgement.verdict, judgement.reason]
        for judgement in judged
    ]
    headings = ("row", "quantity", "printed", "exact", "verdict", "reason")
    page = Page(spec.title).text(_ABOUT_TABLE).table(HEADINGS, _table(rows))
    page.heading("The energy parameter").text(_ABOUT_ENERGY).table(ENERGY, _energy(rows))
    page.heading("Verdicts").text(f"{good} of {len(judged)} numbers are reproduced to their digits.")
    return page.table(headings, lines)
