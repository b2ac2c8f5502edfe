"""The job "optimal table": a printed table of optimal laws, recomputed, proven and extended."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
import numpy as np

from optlaws import drawing
from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import convert
from optlaws.jobs.pages import printed
from optlaws.jobs.pages.page import Page
from optlaws.laws import MotionLaw, PolynomialLaw, smoothstep
from optlaws.laws.savin.savin import alpha_range, savin
from optlaws.suggest import unknown_key
from optlaws.synthesis import (
    BoundaryConditions,
    Chebyshev,
    PolynomialBasis,
    Problem,
    Solution,
    acceleration_limit,
    construct,
    sweep,
)
from optlaws.synthesis.front import values_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Curves = Mapping[int, Sequence[Solution]]

_LEAST, _MOST = 2, 100  # coefficients of Z

COLUMNS = ("B", "C", "D", "base", "z", "note")


Count = Annotated[int, msgspec.Meta(ge=1)]
Number = Annotated[float, msgspec.Meta(ge=-1e100, le=1e100)]
Above1 = Annotated[float, msgspec.Meta(gt=1.0, le=1e100)]


class Base(msgspec.Struct, forbid_unknown_fields=True):
    """The law that k^l (k-1)^l Z(k) is added to, and the degree of Z of the same laws over its own order."""

    order: Count
    z: list[Number] = []
    same: Count | None = None


class Misprint(msgspec.Struct, forbid_unknown_fields=True):
    """A printed number that is wrong, with the reason; what it means, where the printed Z does not tell."""

    row: str
    quantity: str
    printed: Number
    reason: str
    means: Number | None = None


class Shown(msgspec.Struct, forbid_unknown_fields=True, rename={"start": "from", "stop": "to"}):
    """What the figure shows: optima of these degrees over B."""

    degrees: Annotated[list[Count], msgspec.Meta(min_length=1, max_length=5)]
    start: Above1
    stop: Above1
    points: Annotated[int, msgspec.Meta(ge=2)]


class Table(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: str
    printed: str
    order: Count
    monotone: bool
    degrees: Annotated[list[Count], msgspec.Meta(min_length=1)]
    grid: Count
    bases: dict[str, Base]
    figure: Shown
    misprint: list[Misprint] = []


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


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Table, file)
    source = file.parent / spec.printed
    lines = printed.rows(source, COLUMNS)
    _check(spec, lines, str(source))
    rows, curves = _solved(spec, lines)
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


def _check(spec: Table, lines: Sequence[Mapping[str, str]], where: str) -> None:
    for line in lines:
        for name in ("B", "C", "D"):
            printed.number(line[name], f"{where}, {name}")
        if printed.number(line["B"], where) <= 1.0:
            raise InputError(f"{where}: B must be above 1, got {line['B']}")
        if line["base"] not in spec.bases:
            raise InputError(f"{where}: base {line['base']!r} is not among the bases {', '.join(spec.bases)}")
        coefficients = [printed.number(text, f"{where}, z of B = {line['B']}") for text in line["z"].split()]
        if len(coefficients) < _LEAST:
            raise InputError(f"{where}: z of B = {line['B']} needs at least {_LEAST} coefficients")
    rows = {line["B"] for line in lines}
    for misprint in spec.misprint:
        if misprint.row not in rows:
            raise InputError(f"misprint: row {misprint.row!r} is not a B of the printed table")
        known = ["B", "C", "D"] if misprint.means is None else [f"z{i}" for i in range(_MOST)]
        if misprint.quantity not in known:
            raise InputError(
                f"misprint: {unknown_key(misprint.quantity, known, 'quantity')} (B, C, D; a coefficient such as z1 "
                "takes the entry means)"
            )


def _solved(spec: Table, lines: Sequence[Mapping[str, str]]) -> tuple[list[Row], Curves]:
    laws = [printed_law(spec, line) for line in lines]
    values = [float(line["B"]) for line in lines]
    solved = {degree: _by_velocity(spec, degree, values) for degree in {*spec.degrees, *spec.figure.degrees}}
    richer = [{degree: solved[degree][B] for degree in spec.degrees} for B in values]
    same = [_same_shape(spec, line, B, found) for line, B, found in zip(lines, values, richer, strict=True)]
    rows = [Row(*parts) for parts in zip(lines, laws, same, richer, strict=True)]
    return rows, {degree: list(solved[degree].values()) for degree in spec.figure.degrees}


def _by_velocity(spec: Table, degree: int, values: Sequence[float]) -> dict[float, Solution]:
    """Solutions by B, ascending: at the rows' values and, where the figure wants a curve, between them."""
    wanted = set(values)
    if degree in spec.figure.degrees:
        wanted |= set(np.linspace(spec.figure.start, spec.figure.stop, spec.figure.points).tolist())
    basis = Chebyshev(degree)
    ordered = sorted(wanted)
    problems = [Problem(B=B, order=spec.order, basis=basis, monotone=spec.monotone) for B in ordered]
    return dict(zip(ordered, sweep(problems), strict=True))


def _same_shape(spec: Table, line: Mapping[str, str], B: float, found: Mapping[int, Solution]) -> Solution:
    base = spec.bases[line["base"]]
    degree = len(line["z"].split()) - 1 if base.same is None else base.same
    if base.order == spec.order and degree in found:
        return found[degree]
    (solution,) = sweep([Problem(B=B, order=base.order, basis=Chebyshev(degree), monotone=spec.monotone)])
    return solution


def printed_law(spec: Table, line: Mapping[str, str]) -> PolynomialLaw:
    """The law that the Z(k) of a printed row gives."""
    base = spec.bases[line["base"]]
    z = [Fraction(text) for text in line["z"].split()]
    powers = construct(BoundaryConditions.rest(base.order), base.z).exact_powers()
    whole = construct(BoundaryConditions.rest(spec.order), z).exact_powers()
    plain = smoothstep(spec.order).exact_powers()
    size = max(len(powers), len(whole), len(plain))
    return PolynomialLaw.from_powers(
        [p + w - s for p, w, s in zip(*(_filled(part, size) for part in (powers, whole, plain)), strict=True)]
    )


def _filled(powers: Sequence[Fraction], size: int) -> list[Fraction]:
    return [*powers, *[Fraction(0)] * (size - len(powers))]


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
            _degree(same),
            same.objective,
            same.lower_bound,
            _decade(same.gap),
        ]
        line += [row.richer[degree].objective for degree in spec.degrees]
        line += [_decade(max(s.gap for s in row.richer.values()))]
        line += [acceleration_limit(row.B), acceleration_limit(row.B, monotone=True)]
        cells.append(line)
    return headings, cells


def _degree(solution: Solution) -> int:
    basis = solution.problem.basis
    return basis.degree if isinstance(basis, PolynomialBasis) else 0


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


def draw(spec: Table, rows: Sequence[Row], curves: Curves) -> Figure:
    """C over B: optima by degree of Z, the printed laws, and what no law is below."""
    with drawing.style():
        figure = drawing.figure(8.0, 5.2)
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
    least = min(_degree(row.same) for row in rows)
    plain = [row for row in rows if row.same.problem.order == spec.order and _degree(row.same) == least]
    others = [row for row in rows if row not in plain]
    for some, face, label in (
        (plain, drawing.WARM, f"laws of the paper with Z(k) of degree {least}"),
        (others, "white", "other laws of the paper, with degree of Z(k)"),
    ):
        axes.plot(
            [row.B for row in some],
            [row.law.constants.C.value for row in some],
            "o",
            color=drawing.WARM,
            markerfacecolor=face,
            markersize=5.5,
            label=label,
            zorder=5,
        )
    for row in others:
        text = f"{_degree(row.same)}" if row.same.problem.order == spec.order else _shape(row.same)
        drawing.name_point(axes, text, (row.B, row.law.constants.C.value), (6.0, -10.0))


def _shape(solution: Solution) -> str:
    return f"{_degree(solution)}, l = {solution.problem.order}"


def _optima(axes: Axes, curves: Curves) -> None:
    for (degree, found), shade in zip(curves.items(), drawing.shades(len(curves)), strict=True):
        line = [s.objective for s in found]
        label = "optimal, by degree of Z(k)" if degree == max(curves) else None
        velocities = values_of(found, ("B",))[:, 0].tolist()
        axes.plot(velocities, line, color=shade, label=label)
        axes.annotate(
            f"{degree}",
            (velocities[-1], line[-1]),
            xytext=(5, 0),
            textcoords="offset points",
            color=shade,
            va="center",
            annotation_clip=False,
        )


def _family(axes: Axes) -> None:
    laws = [savin("III", float(alpha)) for alpha in np.linspace(*alpha_range("III"), 61)]
    axes.plot(
        [law.peak(1).value for law in laws],
        [law.peak(2).value for law in laws],
        color=drawing.GREEN,
        linestyle="--",
        label="Savin's family III",
    )


def _limits(axes: Axes, spec: Table) -> None:
    values = np.linspace(spec.figure.start, spec.figure.stop, 200)
    axes.plot(
        values,
        [acceleration_limit(B) for B in values],
        color=drawing.GREY,
        linewidth=1.2,
        label="limit of all laws",
    )
    beyond = values[values >= 2.0]
    axes.plot(
        beyond,
        [acceleration_limit(B, monotone=True) for B in beyond],
        color=drawing.GREY,
        linewidth=1.2,
        linestyle="-.",
        label="limit of all laws with b ≥ 0",
    )
