"""The figure of a table of optimal laws: C over B, printed laws beside optima and limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from optlaws import drawing
from optlaws.jobs.laws.printed_rows import Curves, Row, Table, degree_of
from optlaws.laws.savin.savin import alpha_range, savin
from optlaws.synthesis import Solution, acceleration_limit
from optlaws.synthesis.front import values_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


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
    least = min(degree_of(row.same) for row in rows)
    plain = [row for row in rows if row.same.problem.order == spec.order and degree_of(row.same) == least]
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
        text = f"{degree_of(row.same)}" if row.same.problem.order == spec.order else _shape(row.same)
        drawing.name_point(axes, text, (row.B, row.law.constants.C.value), (6.0, -10.0))


def _shape(solution: Solution) -> str:
    return f"{degree_of(solution)}, l = {solution.problem.order}"


def _optima(axes: Axes, curves: Curves) -> None:
    for (degree, curve), shade in zip(curves.items(), drawing.shades(len(curves)), strict=True):
        line = [s.objective for s in curve]
        label = "optimal, by degree of Z(k)" if degree == max(curves) else None
        velocities = values_of(curve, ("B",))[:, 0].tolist()
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
