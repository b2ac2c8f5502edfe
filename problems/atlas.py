"""The atlas: a study over objective, order, degree and B, as one table and drawn."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle, pairwise
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws import run_study
from optlaws.plots.style import DISTINCT, GREY, empty_figure, plot_style
from optlaws.results import Cell, Page, Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AXES = ("minimise", "order", "degree", "B")
CONSTANTS = ("B", "C", "D", "J", "rms_c")
COLUMNS = ("minimise", "order", "degree", "B asked", "status", "lower bound", *CONSTANTS)
_ROWS = 8


def run(results: Results) -> None:
    """Put the table of all points, the page and the pictures into results."""
    with TemporaryDirectory() as folder:
        points = list(run_study(results.file, folder))
    results.title = results.entries["title"]
    proven = [point for point in points if point.law is not None and point.inputs["minimise"] != "D"]
    assert {point.status for point in proven} == {"optimal"}
    results.table("atlas", COLUMNS, [_cells(point) for point in points])
    _fill(results.page("atlas"), points)
    for name, figure in draw(points).items():
        results.picture(name, figure)


def _cells(point: Any) -> list[Cell]:
    inputs: list[Cell] = [point.inputs[name] for name in AXES]
    return [*inputs, point.status, point.lower_bound, *(point.constants.get(name) for name in CONSTANTS)]


def _fill(page: Page, points: Sequence[Any]) -> None:
    laws = sum(point.law is not None for point in points)
    summary = (
        f"{len(points)} points, of which {laws} have a law; all of them are in `atlas.csv`. Each order l asks for one "
        "more derivative that vanishes at the ends: below is what that costs at the highest degree of Z; it "
        "pays where the number is below 0, for with the order the degree of the law grows too."
    )
    page.text(summary)
    for constant in ("C", "D"):
        page.heading(f"Least {constant}").figure(f"least-{constant.lower()}", f"Least {constant} over B")
        page.table(*_costs(points, constant))


def _costs(points: Sequence[Any], constant: str) -> tuple[list[str], list[list[Cell]]]:
    """The least constant of each order by B, and the price of each order over the next lower one."""
    degree = max(point.inputs["degree"] for point in points)
    objectives = {
        (point.inputs["B"], point.inputs["order"]): point.constants.get(constant)
        for point in points
        if point.inputs["minimise"] == constant and point.inputs["degree"] == degree
    }
    velocities, orders = (sorted({key[i] for key in objectives}) for i in (0, 1))
    headings = ["B", *(f"l = {order}" for order in orders)]
    headings += [f"l = {order} over {below}, %" for below, order in pairwise(orders)]
    rows: list[list[Cell]] = []
    for B in velocities[:: max(1, len(velocities) // _ROWS)]:
        values = [objectives[B, order] for order in orders]
        steps = [
            None if objective is None or other is None else f"{100.0 * (other / objective - 1.0):.1f}"
            for objective, other in pairwise(values)
        ]
        rows.append([B, *values, *steps])
    return headings, rows


#: by order, so that curves differ without colours too
_STROKES = ((0, (1, 1.2)), (0, (4, 1.5)), "-.", "-")
_ROOM = 2.5


def draw(points: Sequence[Any]) -> dict[str, Figure]:
    """Figures of the atlas by their names."""
    return {
        f"least-{constant.lower()}": _draw_least(
            [point for point in points if point.inputs["minimise"] == constant], constant, word
        )
        for constant, word in (("C", "acceleration"), ("D", "power"))
    }


def _draw_least(points: Sequence[Any], constant: str, word: str) -> Figure:
    """A panel for each degree of Z, in it a curve for each order."""
    degrees = sorted({point.inputs["degree"] for point in points})
    with plot_style():
        figure = empty_figure(1.6 + 3.2 * len(degrees), 4.8)
        panels = figure.subplots(1, len(degrees), sharex=True, sharey=True, squeeze=False)[0]
        for axes, degree in zip(panels, degrees, strict=True):
            _curves(axes, [point for point in points if point.inputs["degree"] == degree])
            axes.set(title=f"degree of Z: {degree}", xlabel="peak velocity B (dimensionless)")
        panels[0].set(ylabel=f"peak {word} {constant} (dimensionless)", ylim=_heights(points))
        figure.suptitle(f"Least {constant} at given B by order l of the end conditions", x=0.01, ha="left", fontsize=11)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
        return figure


def _curves(axes: Axes, points: Sequence[Any]) -> None:
    orders = sorted({point.inputs["order"] for point in points})
    for order, colour, stroke in zip(orders, DISTINCT, cycle(_STROKES), strict=False):
        curve = [point for point in points if point.inputs["order"] == order]
        values = [np.nan if point.objective is None else point.objective for point in curve]
        style: dict[str, Any] = {"color": colour, "linestyle": stroke}
        axes.plot([point.inputs["B"] for point in curve], values, label=f"l = {order}", **style)
    limits = _limits(points)
    if limits:
        axes.plot(list(limits), list(limits.values()), color=GREY, linewidth=1.0, label="best possible")


def _limits(points: Sequence[Any]) -> dict[float, float]:
    return {point.inputs["B"]: point.best_possible for point in points if point.best_possible is not None}


def _heights(points: Sequence[Any]) -> tuple[float, float]:
    objectives = [point.objective for point in points if point.objective is not None]
    low = min([*_limits(points).values(), *objectives])
    return 0.95 * low, min(1.03 * max(objectives), _ROOM * float(np.median(objectives)))
