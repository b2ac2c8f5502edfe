"""The table of optimal laws of a paper, recomputed, proven and extended."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import zip_longest
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    MotionLaw,
    PolynomialLaw,
    Problem,
    SavinFamily,
    Solution,
    acceleration_limit,
    law_from_z,
    savin,
    smoothstep,
    sweep,
)
from optlaws.plots.style import GREEN, GREY, WARM, empty_figure, name_point, plot_style, shades
from optlaws.results import MARK, MISPRINT, Cell, Entries, PrintedNumber, Results, compared, rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLUMNS = ("B", "C", "D", "base", "z", "note")
VERDICTS = ("row B", "quantity", "printed", "exact", "on grid", "verdict", "reason")
Curves = Mapping[int, Mapping[float, Solution]]
# the paper's C is the greatest c, not the greatest |c|
_LEFT_OUT = "the greater deceleration, which the paper leaves out,"

_POSSIBLE = """
The least C of laws of the printed row's own order and degree of Z with its proven lower bound, then of
laws of order {order} with richer Z, each proven to the gap shown, and the limits that no law from
rest to rest (order 2 or more) can beat at the same B, of whatever degree.
"""


class Base(msgspec.Struct):
    """The law that k^l (k-1)^l Z(k) is added to, and the degree of Z of the same laws over its own order."""

    order: int
    z: list[float] = []
    same: int | None = None


class Misprint(msgspec.Struct):
    """A printed number that is wrong, with the reason; what it means, where the printed Z does not tell."""

    row: str
    quantity: str
    printed: float
    reason: str
    means: float | None = None


class Shown(msgspec.Struct, rename={"start": "from", "stop": "to"}):
    """What the figure shows: optima of these degrees over B."""

    degrees: list[int]
    start: float
    stop: float
    points: int


class Table(Entries):
    """The problem file."""

    printed: str
    order: int
    monotone: bool
    degrees: list[int]
    grid: int
    bases: dict[str, Base]
    figure: Shown
    misprint: list[Misprint]


@dataclass(frozen=True)
class Row:
    """One row: what is printed, the law that the printed Z gives, and the optima by degree of Z."""

    cells: Mapping[str, str]
    law: PolynomialLaw
    same: Solution
    richer: Mapping[int, Solution]

    @property
    def B(self) -> float:
        """The printed peak velocity."""
        return float(self.cells["B"])


def run(results: Results) -> None:
    """Recompute and judge every row, and prove the optima beside it."""
    spec = results.read(Table)
    table, curves = solved(spec, rows(results.file.parent / spec.printed, COLUMNS))
    judged = _verdicts(spec, table)
    headings, cells = _cells(spec, table)
    verdicts = [(v.row, v.quantity, v.printed, v.exact, v.on_grid, v.verdict, v.reason) for v in judged]
    results.table("table", headings, cells)
    results.table("verdicts", VERDICTS, verdicts)
    split = headings.index("order l")
    page = results.page("table").heading("What is printed, and what the printed Z(k) gives")
    page.table(headings[:split], [line[:split] for line in cells])
    page.heading("What is possible").text(_POSSIBLE.format(order=spec.order))
    page.table(["B", *map(_short, headings[split:])], [[line[0], *line[split:]] for line in cells])
    page.heading("Every printed number").table(VERDICTS, verdicts)
    results.text("laws.json", json.dumps(_laws(results.about, table), indent=1) + "\n")
    results.picture("figure", draw(spec, table, curves))
    assert abs(table[0].same.objective - 7.358627) < 1e-6
    assert abs(table[0].richer[41].objective - 4.533512) < 1e-6
    assert all(solution.gap < 1e-8 for row in table for solution in (row.same, *row.richer.values())), "all are proven"


def solved(spec: Table, lines: Sequence[Mapping[str, str]]) -> tuple[list[Row], Curves]:
    """The rows with their optima, and optima over B by degree of Z."""
    laws = [printed_law(spec, line) for line in lines]
    values = [float(line["B"]) for line in lines]
    solved = {degree: _by_velocity(spec, degree, values) for degree in {*spec.degrees, *spec.figure.degrees}}
    richer = [{degree: solved[degree][B] for degree in spec.degrees} for B in values]
    same = [_same_shape(spec, line, B, optima) for line, B, optima in zip(lines, values, richer, strict=True)]
    rows = [Row(*parts) for parts in zip(lines, laws, same, richer, strict=True)]
    return rows, {degree: solved[degree] for degree in spec.figure.degrees}


def _by_velocity(spec: Table, degree: int, values: Sequence[float]) -> dict[float, Solution]:
    """Solutions by B, ascending: at the rows' values and, where the figure wants a curve, between them."""
    velocities = set(values)
    if degree in spec.figure.degrees:
        velocities |= set(np.linspace(spec.figure.start, spec.figure.stop, spec.figure.points).tolist())
    basis = Chebyshev(degree)
    ordered = sorted(velocities)
    problems = [Problem(B=B, order=spec.order, basis=basis, monotone=spec.monotone) for B in ordered]
    return dict(zip(ordered, sweep(problems), strict=True))


def _same_shape(spec: Table, line: Mapping[str, str], B: float, optima: Mapping[int, Solution]) -> Solution:
    base = spec.bases[line["base"]]
    degree = len(line["z"].split()) - 1 if base.same is None else base.same
    if base.order == spec.order and degree in optima:
        return optima[degree]
    (solution,) = sweep([Problem(B=B, order=base.order, basis=Chebyshev(degree), monotone=spec.monotone)])
    return solution


def printed_law(spec: Table, line: Mapping[str, str]) -> PolynomialLaw:
    """The law that the Z(k) of a printed row gives."""
    base = spec.bases[line["base"]]
    z = [Fraction(text) for text in line["z"].split()]
    powers = law_from_z(BoundaryConditions.rest(base.order), base.z).exact_powers()
    whole = law_from_z(BoundaryConditions.rest(spec.order), z).exact_powers()
    plain = smoothstep(spec.order).exact_powers()
    return PolynomialLaw.from_powers(
        [p + w - s for p, w, s in zip_longest(powers, whole, plain, fillvalue=Fraction(0))]
    )


def degree_of(solution: Solution) -> int:
    """The degree of its Z."""
    basis = solution.problem.basis
    return basis.degree if isinstance(basis, Chebyshev) else 0


def _verdicts(spec: Table, rows: Sequence[Row]) -> list[PrintedNumber]:
    wrong = {(m.row, m.quantity): m for m in spec.misprint}
    verdicts = []
    for row in rows:
        constants, on_grid = row.law.constants, on_paper_grid(spec, row.law)
        for name, peak in (("B", constants.B), ("C", constants.C), ("D", constants.D)):
            misprint = wrong.get((row.cells["B"], name))
            reason = misprint.reason if misprint else None
            missed = {"peak": _LEFT_OUT} if name == "C" and _brakes_harder(row.law) else {}
            printed = row.cells["B"], name, row.cells[name]
            verdicts.append(compared(*printed, peak.value, on_grid=on_grid[name], misprint=reason, **missed))
        verdicts += [
            PrintedNumber(m.row, m.quantity, f"{m.printed:.10g}", m.means, None, MISPRINT, m.reason)
            for m in spec.misprint
            if m.row == row.cells["B"] and m.means is not None
        ]
    return verdicts


def _brakes_harder(law: MotionLaw) -> bool:
    lowest, highest = law.extrema(2)
    return -lowest.value > highest.value * (1.0 + 1e-6)


def on_paper_grid(spec: Table, law: MotionLaw) -> dict[str, float]:
    """B, C and D as the paper has them: the greatest values at the points of its grid, C without the deceleration."""
    grid = np.linspace(0.0, 1.0, spec.grid + 1)
    return {"B": float(law.b(grid).max()), "C": float(law.c(grid).max()), "D": float(np.abs(law.d(grid)).max())}


def _cells(spec: Table, rows: Sequence[Row]) -> tuple[list[str], list[list[Cell]]]:
    headings = ["B", "C printed", "D printed", "B exact", "C exact", "at k", "D exact", "at k", "J exact"]
    headings += ["order l", "degree of Z", "C optimal", "lower bound", "gap <="]
    headings += [f"C optimal, l={spec.order}, degree {degree}" for degree in spec.degrees]
    headings += ["greatest gap <=", "best possible", "best possible, b >= 0"]
    cells: list[list[Cell]] = []
    for row in rows:
        constants, same = row.law.constants, row.same
        line: list[Cell] = [row.cells["B"], row.cells["C"], row.cells["D"]]
        line += [constants.B.value, constants.C.value, round(constants.C.k, 4)]
        line += [constants.D.value, round(constants.D.k, 4), constants.J.value]
        line += [same.problem.order, degree_of(same), same.objective, same.lower_bound, _decade(same.gap)]
        line += [row.richer[degree].objective for degree in spec.degrees]
        line += [_decade(max(s.gap for s in row.richer.values()))]
        line += [acceleration_limit(row.B), acceleration_limit(row.B, monotone=True)]
        cells.append(line)
    return headings, cells


def _decade(gap: float) -> str:
    # the power of ten above it, 1e-10 at least: what lies below is rounding, and differs between machines
    return f"1e{int(np.ceil(np.log10(max(gap, 1e-10))))}"


def _short(heading: str) -> str:
    return heading.rpartition(", ")[2] if heading.startswith("C optimal, ") else heading


def _laws(about: str, rows: Sequence[Row]) -> dict[str, Any]:
    return {
        "about": f"{about}; {MARK}",
        "rows": [
            {
                "B": row.cells["B"],
                "printed": {"law": row.law.to_dict(), "constants": row.law.constants.to_dict(rms=False)},
                "same shape": _solution(row.same),
                "richer": {str(degree): _solution(solution) for degree, solution in row.richer.items()},
            }
            for row in rows
        ],
    }


def _solution(solution: Solution) -> dict[str, Any]:
    names = ("status", "objective", "lower_bound", "best_possible", "constants", "z", "law", "problem", "certificate")
    whole = solution.to_dict()
    return {name: whole[name] for name in names}


def draw(spec: Table, rows: Sequence[Row], curves: Curves) -> Figure:
    """C over B: optima by degree of Z, the printed laws, and what no law is below."""
    with plot_style():
        figure = empty_figure(8.0, 5.2)
        axes = figure.subplots()
        _limits(axes, spec)
        _optima(axes, curves)
        _family(axes)
        _printed(axes, spec, rows)
        axes.set(
            xlabel="peak velocity B (dimensionless)",
            ylabel="peak acceleration C (dimensionless)",
            xlim=(spec.figure.start, spec.figure.stop),
            ylim=(3.6, 12.2),
            title=f"Least peak acceleration at a given peak velocity, order l = {spec.order}",
        )
        axes.legend(loc="upper left")
        return figure


def _printed(axes: Axes, spec: Table, rows: Sequence[Row]) -> None:
    least = min(degree_of(row.same) for row in rows)
    plain = [row for row in rows if row.same.problem.order == spec.order and degree_of(row.same) == least]
    others = [row for row in rows if row not in plain]
    for some, face, label in (
        (plain, WARM, f"laws of the paper with Z(k) of degree {least}"),
        (others, "white", "other laws of the paper, with degree of Z(k)"),
    ):
        style: dict[str, Any] = {"color": WARM, "markerfacecolor": face, "markersize": 5.5, "zorder": 5}
        axes.plot([row.B for row in some], [row.law.constants.C.value for row in some], "o", label=label, **style)
    for row in others:
        order = row.same.problem.order
        text = f"{degree_of(row.same)}" + (f", l = {order}" if order != spec.order else "")
        name_point(axes, text, (row.B, row.law.constants.C.value), (6.0, -10.0))


def _optima(axes: Axes, curves: Curves) -> None:
    for (degree, curve), shade in zip(curves.items(), shades(len(curves)), strict=True):
        line = [solution.objective for solution in curve.values()]
        label = "optimal, by degree of Z(k)" if degree == max(curves) else None
        velocities = list(curve)
        axes.plot(velocities, line, color=shade, label=label)
        style: dict[str, Any] = {"xytext": (5, 0), "textcoords": "offset points", "va": "center"}
        axes.annotate(f"{degree}", (velocities[-1], line[-1]), color=shade, annotation_clip=False, **style)


def _family(axes: Axes) -> None:
    low, high = map(float, SavinFamily.of("III").range)
    laws = [savin("III", alpha) for alpha in np.linspace(low, high, 61).tolist()]
    B, C = ([law.peak(nu).value for law in laws] for nu in (1, 2))
    axes.plot(B, C, color=GREEN, linestyle="--", label="Savin's family III")


def _limits(axes: Axes, spec: Table) -> None:
    values = np.linspace(spec.figure.start, spec.figure.stop, 200)
    beyond = values[values >= 2.0]
    labels = "best possible from rest to rest", "the same with b ≥ 0"
    for B, monotone, stroke, label in ((values, False, "-", labels[0]), (beyond, True, "-.", labels[1])):
        limits = [acceleration_limit(velocity, monotone=monotone) for velocity in B]
        style: dict[str, Any] = {"color": GREY, "linewidth": 1.2, "linestyle": stroke}
        axes.plot(B, limits, label=label, **style)


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
