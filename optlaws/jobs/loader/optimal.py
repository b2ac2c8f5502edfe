"""The job "loader optimal": printed laws beside laws that are made for their inertial loaders."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
import numpy as np

from optlaws import drawing
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.loader.table import COLUMNS
from optlaws.jobs.pages import printed
from optlaws.jobs.pages.page import Page
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.loader.limits import loader_acceleration_limit
from optlaws.mechanisms.loader.loader import Loader, loader
from optlaws.mechanisms.loader.optimal import BalancedLaw, balanced_law
from optlaws.numbers import bounded
from optlaws.suggest import unknown_key
from optlaws.synthesis.solution import Status
from optlaws.synthesis.spaces.bases import Chebyshev

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MIXTURE = "0.5*C/4 + 0.5*C_loader/4"
# of what a general search finds: laws of one peak to twelve digits differ in the fifth
DIGITS = 4
KINDS = ("least C_l", "C no greater", "mixture", "least B_l", "least D_l")

_ABOUT_LEAST = (
    "C and C_l are those of the printed law and of its loader. The least C_l at the same B is that of all laws with "
    "b >= 0 of the order and degree of Z in the heading: {proven}. No law with b >= 0 of any degree is below the "
    "limit. Better by: the best of them against the printed law."
)
_ABOUT_RIVALS = (
    "Laws of the printed law's own B and order, of the greatest degree: with the least C_l among those whose C is no "
    f"greater than that of the printed law, with the least {MIXTURE}, with the least B_l, and with the least D_l. "
    "Better by: the peak that is minimised, against the printed law; gap: how much better still it could be, at most."
)

Orders = Annotated[list[Annotated[int, msgspec.Meta(ge=2)]], msgspec.Meta(min_length=1)]
Degrees = Annotated[list[Annotated[int, msgspec.Meta(ge=3)]], msgspec.Meta(min_length=1)]


class Spec(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    printed: Text
    orders: Orders
    degrees: Degrees
    shown: Text


@dataclass(frozen=True)
class Row:
    """A printed law with its loader, and its rivals."""

    code: str
    one: Loader
    order: int
    least: Mapping[tuple[int, int], BalancedLaw]
    rivals: Mapping[str, BalancedLaw | None]

    @property
    def B(self) -> float:
        """Peak velocity of the law."""
        return self.one.executive.constants.B.value

    @property
    def C(self) -> float:
        """Peak acceleration of the law."""
        return self.one.executive.constants.C.value

    @property
    def best(self) -> BalancedLaw:
        """The law with the least C of the loader."""
        return min(self.least.values(), key=lambda solution: solution.objective)

    def printed(self, kind: str) -> float:
        """What the printed law has of what a rival is best at."""
        own = {"mixture": 0.125 * (self.C + self.one.C), "least B_l": self.one.B, "least D_l": self.one.D}
        return own.get(kind, self.one.C)


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Spec, file)
    given = printed.rows(file.parent / spec.printed, COLUMNS)
    codes = [entry["code"] for entry in given]
    if spec.shown not in codes:
        raise InputError(f"{file}: {unknown_key(spec.shown, codes, 'law')}")
    rows = [_row(entry, spec) for entry in given]
    about = f"{spec.title}; from {file.name}"
    least, headings = _least(rows), _headings(rows)
    rivals = _rivals(rows)
    page = _page(spec, rows, (headings, least), rivals)
    kept = {
        row.code: {kind: None if rival is None else rival.to_dict() for kind, rival in row.rivals.items()}
        for row in rows
    }
    figure = draw(spec.title, rows, next(row for row in rows if row.code == spec.shown))
    return [
        writing.write(out / "table.csv", tables.to_csv(headings, least, about=about), digits=DIGITS),
        writing.write(out / "rivals.csv", tables.to_csv(RIVALS, rivals, about=about), digits=DIGITS),
        writing.write(
            out / "laws.json", json.dumps({"about": writing.MARK, "laws": kept}, indent=1) + "\n", digits=DIGITS
        ),
        writing.write(out / "table.md", str(page), digits=DIGITS),
        *drawing.save_picture(figure, out / "figure"),
    ]


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
    own = least.get((order, basis.degree)) or _proven(B, order=order, basis=basis)
    rivals: dict[str, BalancedLaw | None] = {"least C_l": own, "C no greater": None}
    with suppress(InfeasibleProblem):  # at B = 2 no polynomial has C = 4
        rivals["C no greater"] = _proven(B, order=order, basis=basis, most_C=C)
    for kind, minimise in (("mixture", MIXTURE), ("least B_l", "B_loader"), ("least D_l", "D_loader")):
        rivals[kind] = _proven(B, order=order, basis=basis, minimise=minimise)
    return Row(given["code"], loader(law), order, least, rivals)


_proven = partial(balanced_law, bound="tight")


def _headings(rows: Sequence[Row]) -> list[str]:
    pairs = [f"l = {order}, degree {degree}" for order, degree in rows[0].least]
    return ["law", "B", "C", "C_l", *pairs, "limit", "better by, %"]


def _least(rows: Sequence[Row]) -> list[list[tables.Cell]]:
    return [
        [
            row.code,
            row.B,
            row.C,
            bounded(row.one.C),
            *(solution.objective for solution in row.least.values()),
            loader_acceleration_limit(row.B),
            _better(row.best.objective, row.one.C),
        ]
        for row in rows
    ]


_PEAKS = ("C", "C_l", "B_l", "D_l")
RIVALS = ("law", "order", "rival", *_PEAKS, *(f"printed {peak}" for peak in _PEAKS), "better by, %", "gap")


def _rivals(rows: Sequence[Row]) -> list[list[tables.Cell]]:
    lines: list[list[tables.Cell]] = []
    for row in rows:
        own = [row.C, bounded(row.one.C), row.one.B, row.one.D]
        for kind in KINDS:
            rival = row.rivals[kind]
            if rival is None:
                lines.append([row.code, row.order, f"{kind}: none exists", None, None, None, None, *own, None, None])
                continue
            peaks = [rival.law.constants.C.value, rival.loader.C, rival.loader.B, rival.loader.D]
            better = _better(rival.objective, row.printed(kind))
            gap = max(0.0, round(rival.gap, 6))
            lines.append([row.code, row.order, kind, *peaks, *own, better, gap])
    return lines


def _better(least: float, own: float) -> float | None:
    return round(100.0 * (1.0 - least / own), 3) if isfinite(own) else None


def _page(
    spec: Spec,
    rows: Sequence[Row],
    least: tuple[Sequence[str], Sequence[Sequence[tables.Cell]]],
    rivals: Sequence[Sequence[tables.Cell]],
) -> Page:
    page = Page(spec.title).text(_ABOUT_LEAST.format(proven=_said(rows))).table(*least)
    page.figure("figure", "C of the loader over B, and a printed law beside its rival")
    return page.heading("Rivals of the same order").text(_ABOUT_RIVALS).table(RIVALS, rivals, digits=6)


def _said(rows: Sequence[Row]) -> str:
    """What is proven of the least C_l."""
    every = [solution for row in rows for solution in row.least.values()]
    open_ones = [solution.gap for solution in every if solution.status is not Status.OPTIMAL]
    if not open_ones:
        return f"proven for all {len(every)}, to 1e-8"
    return f"proven for {len(every) - len(open_ones)} of {len(every)}, the others to {max(open_ones):.1e}"


def draw(title: str, rows: Sequence[Row], shown: Row) -> Figure:
    """C of the loader over B, and one printed law beside its rival."""
    with drawing.style():
        figure = drawing.figure(10.6, 4.8)
        left, right = figure.subplots(1, 2)
        _over_B(left, rows)
        _pair(right, shown)
        figure.suptitle(f"{title} (all dimensionless)", x=0.01, ha="left", fontsize=11.0)
        return figure


def _over_B(axes: Axes, rows: Sequence[Row]) -> None:
    B = np.linspace(min(row.B for row in rows) - 0.04, max(row.B for row in rows) + 0.04, 121)
    axes.plot(B, [loader_acceleration_limit(velocity) for velocity in B], color=drawing.GREY, label="limit for b ≥ 0")
    finite = [row for row in rows if isfinite(row.one.C)]
    axes.plot([row.B for row in finite], [row.one.C for row in finite], "o", color=drawing.WARM, label="printed laws")
    capped = [(row.B, rival.loader.C) for row in rows if (rival := row.rivals["C no greater"]) is not None]
    axes.plot(*np.transpose(capped), "s", color=drawing.BLUES[2], label="least C of the loader, own C no greater")
    best = [(row.B, row.best.loader.C) for row in rows]
    axes.plot(*np.transpose(best), "v", color=drawing.GREEN, label="least C of the loader")
    axes.set(xlabel="peak velocity B of the executive law", ylabel="peak acceleration C of the loader")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)


def _pair(axes: Axes, row: Row) -> None:
    k = np.linspace(0.0, 1.0, 801)
    rival = row.rivals["C no greater"] or row.best
    for balanced, colour, name in ((row.one, drawing.WARM, row.code), (rival.loader, drawing.BLUES[2], "rival")):
        axes.plot(k, balanced.executive.c(k), color=colour, label=f"{name}: executive c")
        axes.plot(k, balanced.law.c(k), color=colour, linestyle="--", label=f"{name}: loader c")
    axes.set(xlabel="k (dimensionless time)", ylabel="acceleration")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)
