"""The printed constants of inertial loaders, each recomputed and judged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite, sqrt

import numpy as np

from optlaws import InputError, catalogue
from optlaws.balancing import Loader, TrapeziumSubstitute, closed_form_Y, inertial_loader
from optlaws.results import ON_GRID, REPRODUCED, Cell, Entries, PrintedNumber, Results, compared, rows

COLUMNS = ("code", "law", "B", "C", "D")
CONSTANTS = ("B", "C", "D")
HEADINGS = ("law", "Y", "B", "B printed", "C", "at k", "C at turn", "C printed", "D", "D printed")
ENERGY = ("law", "Y", "Y by eq. 25", "a trapezium?", "Y from B printed", "from C", "from D")
VERDICTS = ("row", "quantity", "printed", "exact", "on grid", "verdict", "reason")
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


class Table(Entries):
    """The problem file: the printed rows, and the number of steps of the paper's grid."""

    printed: str
    grid: int


@dataclass(frozen=True)
class Row:
    """A printed row, its loader, and the greatest values of the loader's C and D at the paper's grid."""

    code: str
    given: Mapping[str, str]
    loader: Loader
    on_grid: Mapping[str, float | None]

    @property
    def exact(self) -> dict[str, float]:
        """The loader's B, C and D."""
        return {"B": self.loader.B, "C": self.loader.C, "D": self.loader.D}

    def implied(self, name: str) -> tuple[float, bool]:
        """The Y with which a printed number would be right, and whether it was then taken at the paper's grid.

        Of the peak and the greatest value at the grid it is the one that gives the Y nearer to that of the row's B.
        """
        size = float(self.given[name])
        from_B = self.loader.Y * float(self.given["B"]) / self.loader.B
        candidates = []
        for seen, gridded in ((self.exact[name], False), (self.on_grid[name], True)):
            if seen is not None and isfinite(seen):
                ratio = size / seen
                candidates.append((self.loader.Y * (sqrt(ratio) if name == "D" else ratio), gridded))
        return min(candidates, key=lambda pair: abs(pair[0] / from_B - 1.0))


def run(results: Results) -> None:
    """Compare every printed constant with the loader's, and tell what energy parameter it stands for."""
    spec = results.read(Table)
    table = [recomputed(line, spec.grid) for line in rows(results.file.parent / spec.printed, COLUMNS)]
    judged = [verdict for row in table for verdict in _verdicts(row)]
    cells: list[list[Cell]] = [[getattr(number, name.replace(" ", "_")) for name in VERDICTS] for number in judged]
    results.table("table", HEADINGS, _table(table))
    results.table("energy", ENERGY, _energy(table))
    results.table("verdicts", VERDICTS, cells)
    good = sum(number.verdict in {REPRODUCED, ON_GRID} for number in judged)
    page = results.page("table").text(_ABOUT_TABLE).table(HEADINGS, _table(table))
    page.heading("The energy parameter").text(_ABOUT_ENERGY).table(ENERGY, _energy(table))
    page.heading("Verdicts").text(f"{good} of {len(judged)} numbers are reproduced to their digits.")
    page.table([*VERDICTS[:4], *VERDICTS[5:]], [[*line[:4], *line[5:]] for line in cells])
    assert [f"{row.loader.Y:.6f}" for row in table[:2]] == ["1.000000", "0.684268"]
    assert (good, len(judged)) == (7, 36)


def recomputed(given: Mapping[str, str], grid: int) -> Row:
    """A printed row with its loader and what the paper's grid shows of it."""
    mechanism = inertial_loader(catalogue[given["law"]].law)
    k = np.linspace(0.0, 1.0, grid + 1)
    moving = k[mechanism.law.b(k) != 0.0]  # where the loader turns, the paper's formula for c is 0/0
    on_grid = {
        "B": None,
        "C": float(np.abs(mechanism.law.c(moving)).max()),
        "D": float(np.abs(mechanism.law.d(k)).max()),
    }
    return Row(given["code"], given, mechanism, on_grid)


def _verdicts(row: Row) -> list[PrintedNumber]:
    verdicts = []
    for name, exact in row.exact.items():
        text = row.given[name]
        if text == "inf":
            reproduced = exact == inf
            verdict = REPRODUCED if reproduced else "off: it is finite"
            verdicts.append(PrintedNumber(row.code, name, text, exact, None, verdict, ""))
            continue
        judgement = compared(row.code, name, text, exact, on_grid=row.on_grid[name], misprint=None)
        off = float(text) / exact - 1.0
        if judgement.verdict not in {REPRODUCED, ON_GRID} and abs(off) >= EXACT:
            judgement = replace(judgement, verdict=f"off by {100.0 * off:+.2g} %", reason=_reason(row, name))
        verdicts.append(judgement)
    return verdicts


def _reason(row: Row, name: str) -> str:
    """What is known of a number that is off: how much of it is the row's wrong Y."""
    from_B = row.implied("B")[0]
    wrong = from_B / row.loader.Y - 1.0
    cause = f"the row's B means Y = {from_B:.5g} instead of {row.loader.Y:.5g} ({100 * wrong:+.2g} %)"
    if name == "B":
        near = closed_form_Y(*_shape(row.loader))
        return f"{cause}; eq. 25 gives {near:.4g}{'' if _is_trapezium(row.loader) else ' outside its domain'}"
    implied, gridded = row.implied(name)
    left = (implied / from_B) ** (2 if name == "D" else 1) - 1.0
    grid = ", taken at the paper's grid" if gridded else ""
    if abs(left) <= EXPLAINED:
        return f"{cause}: {name} follows from it{grid} (to {100 * abs(left):.1g} %)"
    return f"{cause}; {100 * left:+.2g} % remain{grid}, of unknown cause"


def _shape(mechanism: Loader) -> tuple[float, float]:
    B, C = (mechanism.executive.peak(nu).value for nu in (1, 2))
    return 1.0 / B, B / C


def _is_trapezium(mechanism: Loader) -> bool:
    try:
        TrapeziumSubstitute(*_shape(mechanism))
    except InputError:
        return False
    return True


def _table(rows: Sequence[Row]) -> list[list[Cell]]:
    return [
        [
            row.code,
            row.loader.Y,
            row.loader.B,
            row.given["B"],
            row.loader.C,
            round(row.loader.law.peak(2).k, 9),
            row.loader.C_at_turn,
            row.given["C"],
            row.loader.D,
            row.given["D"],
        ]
        for row in rows
    ]


def _energy(rows: Sequence[Row]) -> list[list[Cell]]:
    return [
        [
            row.code,
            row.loader.Y,
            closed_form_Y(*_shape(row.loader)),
            "yes" if _is_trapezium(row.loader) else "no",
            *(row.implied(name)[0] if isfinite(row.exact[name]) else None for name in CONSTANTS),
        ]
        for row in rows
    ]


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
