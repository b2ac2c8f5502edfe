"""Printed laws beside laws that are made for their inertial loaders."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws import Chebyshev, InfeasibleProblem, Status, catalogue
from optlaws.balancing import BalancedLaw, Loader, balanced_law, inertial_loader, loader_acceleration_limit
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, empty_figure, plot_style
from optlaws.results import MARK, Cell, Entries, Results, rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLUMNS = ("code", "law", "B", "C", "D")


MIXTURE = "0.5*C/4 + 0.5*C_loader/4"
# of what a general search finds: laws of one peak to twelve digits differ in the fifth
DIGITS = 4
KINDS = ("least C_l", "C no greater", "mixture", "least B_l", "least D_l")

_ABOUT_LEAST = (
    "C and C_l are those of the printed law and of its loader. The least C_l at the same B is that of all laws with "
    "b >= 0 of the order and degree of Z in the heading: {proven}. No law with b >= 0 of any degree is below the "
    "best possible. Better by: the best of them against the printed law."
)
_ABOUT_RIVALS = (
    "Laws of the printed law's own B and order, of the greatest degree: with the least C_l among those whose C is no "
    f"greater than that of the printed law, with the least {MIXTURE}, with the least B_l, and with the least D_l. "
    "Better by: the peak that is minimised, against the printed law; gap: how much better still it could be, at most."
)


class Spec(Entries):
    """The problem file: orders and degrees of Z, and the code of the law that is drawn beside its rival."""

    printed: str
    orders: list[int]
    degrees: list[int]
    shown: str


@dataclass(frozen=True)
class Row:
    """A printed law with its loader, and its rivals."""

    code: str
    loader: Loader
    order: int
    least: Mapping[tuple[int, int], BalancedLaw]
    rivals: Mapping[str, BalancedLaw | None]

    @property
    def B(self) -> float:
        """Peak velocity of the law."""
        return self.loader.executive.constants.B.value

    @property
    def C(self) -> float:
        """Peak acceleration of the law."""
        return self.loader.executive.constants.C.value

    @property
    def best(self) -> BalancedLaw:
        """The law with the least C of the loader."""
        return min(self.least.values(), key=lambda solution: solution.objective)

    def printed(self, kind: str) -> float:
        """What the printed law has of what a rival is best at."""
        values = {"mixture": 0.125 * (self.C + self.loader.C), "least B_l": self.loader.B, "least D_l": self.loader.D}
        return values.get(kind, self.loader.C)


def _stored(rival: BalancedLaw) -> dict[str, Any]:
    """A rival without the proof that stands in no page."""
    return {name: value for name, value in rival.to_dict().items() if name != "solution"}


def run(results: Results) -> None:
    """Make laws for the loaders of all printed laws, with proof, and show them beside these."""
    results.digits = DIGITS
    spec = results.read(Spec)
    table = [_row(entry, spec) for entry in rows(results.file.parent / spec.printed, COLUMNS)]
    least, headings, rivals = _least(table), _headings(table), _rivals(table)
    results.table("table", headings, least)
    results.table("rivals", RIVALS, rivals)
    laws = {row.code: {kind: rival and _stored(rival) for kind, rival in row.rivals.items()} for row in table}
    results.text("laws.json", json.dumps({"about": MARK, "laws": laws}, indent=1) + "\n")
    results.picture("figure", draw(spec.title, table, next(row for row in table if row.code == spec.shown)))
    page = results.page("table").text(_ABOUT_LEAST.format(proven=_said(table))).table(headings, least)
    page.figure("figure", "C of the loader over B, and a printed law beside its rival")
    page.heading("Rivals of the same order").text(_ABOUT_RIVALS).table(RIVALS, rivals, digits=6)
    assert abs(table[0].best.objective - 4.1887661) < 1e-5, "the loader of least C at the B of the harmonic law"
    assert all(row.best.objective >= loader_acceleration_limit(row.B) for row in table)


def _row(given: Mapping[str, str], spec: Spec) -> Row:
    law = catalogue[given["law"]].law
    B, C = law.constants.B.value, law.constants.C.value
    order = 2 if abs(law.c(0.0)) > 1e-9 * C else 3
    least = {
        (order, degree): _proven(B, order=order, basis=Chebyshev(degree))
        for order in spec.orders
        for degree in spec.degrees
    }
    basis = Chebyshev(max(spec.degrees))
    gentlest = least.get((order, basis.degree)) or _proven(B, order=order, basis=basis)
    rivals: dict[str, BalancedLaw | None] = {"least C_l": gentlest, "C no greater": None}
    with suppress(InfeasibleProblem):  # at B = 2 no polynomial has C = 4
        rivals["C no greater"] = _proven(B, order=order, basis=basis, most_C=C)
    for kind, minimise in (("mixture", MIXTURE), ("least B_l", "B_loader"), ("least D_l", "D_loader")):
        rivals[kind] = _proven(B, order=order, basis=basis, minimise=minimise)
    return Row(given["code"], inertial_loader(law), order, least, rivals)


_proven = partial(balanced_law, bound="tight")


def _headings(rows: Sequence[Row]) -> list[str]:
    pairs = [f"l = {order}, degree {degree}" for order, degree in rows[0].least]
    return ["law", "B", "C", "C_l", *pairs, "best possible", "better by, %"]


def _least(rows: Sequence[Row]) -> list[list[Cell]]:
    return [
        [
            row.code,
            row.B,
            row.C,
            _finite(row.loader.C),
            *(solution.objective for solution in row.least.values()),
            loader_acceleration_limit(row.B),
            _better(row.best.objective, row.loader.C),
        ]
        for row in rows
    ]


_PEAKS = ("C", "C_l", "B_l", "D_l")
RIVALS = ("law", "order", "rival", *_PEAKS, *(f"printed {peak}" for peak in _PEAKS), "better by, %", "gap")


def _rivals(rows: Sequence[Row]) -> list[list[Cell]]:
    lines: list[list[Cell]] = []
    for row in rows:
        printed = [row.C, _finite(row.loader.C), row.loader.B, row.loader.D]
        for kind in KINDS:
            rival = row.rivals[kind]
            if rival is None:
                lines.append(
                    [row.code, row.order, f"{kind}: none exists", None, None, None, None, *printed, None, None]
                )
                continue
            peaks = [rival.law.constants.C.value, rival.loader.C, rival.loader.B, rival.loader.D]
            better = _better(rival.objective, row.printed(kind))
            gap = max(0.0, round(rival.gap, 6))
            lines.append([row.code, row.order, kind, *peaks, *printed, better, gap])
    return lines


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None


def _better(least: float, printed: float) -> float | None:
    return round(100.0 * (1.0 - least / printed), 3) if isfinite(printed) else None


def _said(rows: Sequence[Row]) -> str:
    """What is proven of the least C_l."""
    every = [solution for row in rows for solution in row.least.values()]
    open_ones = [solution.gap for solution in every if solution.status is not Status.OPTIMAL]
    if not open_ones:
        return f"proven for all {len(every)}, to 1e-8"
    return f"proven for {len(every) - len(open_ones)} of {len(every)}, the others to {max(open_ones):.1e}"


def draw(title: str, rows: Sequence[Row], shown: Row) -> Figure:
    """C of the loader over B, and one printed law beside its rival."""
    with plot_style():
        figure = empty_figure(10.6, 4.8)
        left, right = figure.subplots(1, 2)
        _over_B(left, rows)
        _pair(right, shown)
        figure.suptitle(f"{title} (all dimensionless)", x=0.01, ha="left", fontsize=11.0)
        return figure


def _over_B(axes: Axes, rows: Sequence[Row]) -> None:
    B = np.linspace(min(row.B for row in rows) - 0.04, max(row.B for row in rows) + 0.04, 121)
    axes.plot(B, [loader_acceleration_limit(velocity) for velocity in B], color=GREY, label="limit for b ≥ 0")
    finite = [row for row in rows if isfinite(row.loader.C)]
    axes.plot([row.B for row in finite], [row.loader.C for row in finite], "o", color=WARM, label="printed laws")
    capped = [(row.B, rival.loader.C) for row in rows if (rival := row.rivals["C no greater"]) is not None]
    axes.plot(*np.transpose(capped), "s", color=BLUES[2], label="least C of the loader, own C no greater")
    best = [(row.B, row.best.loader.C) for row in rows]
    axes.plot(*np.transpose(best), "v", color=GREEN, label="least C of the loader")
    axes.set(xlabel="peak velocity B of the executive law", ylabel="peak acceleration C of the loader")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)


def _pair(axes: Axes, row: Row) -> None:
    k = np.linspace(0.0, 1.0, 801)
    rival = row.rivals["C no greater"] or row.best
    for balanced, colour, name in ((row.loader, WARM, row.code), (rival.loader, BLUES[2], "least C of the loader")):
        axes.plot(k, balanced.executive.c(k), color=colour, label=f"{name}: executive c")
        axes.plot(k, balanced.law.c(k), color=colour, linestyle="--", label=f"{name}: loader c")
    axes.set(xlabel="k (dimensionless time)", ylabel="acceleration")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
