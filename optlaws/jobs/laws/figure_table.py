"""The figure of the optimal-law table: C over B, printed and proven, with Savin's family III and the limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from optlaws import drawing
from optlaws.laws.savin.savin import alpha_range, savin
from optlaws.synthesis import acceleration_limit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from optlaws.jobs.laws.optimal_table import Curves, Row, Table


_FEWEST = 5  # coefficients of Z: a cubic, or one of degree 4 that has no more odd ones


def draw(spec: Table, rows: Sequence[Row], curves: Curves) -> dict[str, bytes]:
    """The figure as svg and png."""
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
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def _printed(axes: Axes, spec: Table, rows: Sequence[Row]) -> None:
    plain = [row for row in rows if row.same.problem.order == spec.order and len(row.cells["z"].split()) <= _FEWEST]
    others = [row for row in rows if row not in plain]
    for some, face, label in (
        (plain, drawing.WARM, "laws of the paper with cubic Z(k)"),
        (others, "white", "of higher degree, or (B = 1.75) of order 3"),
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


def _optima(axes: Axes, curves: Curves) -> None:
    for (degree, found), shade in zip(curves.items(), drawing.BLUES[-len(curves) :], strict=True):
        line = [s.objective for s in found]
        label = "optimal, by degree of Z(k)" if degree == max(curves) else None
        axes.plot([s.constants.B.value for s in found], line, color=shade, label=label)
        axes.annotate(
            f"{degree}",
            (found[-1].constants.B.value, line[-1]),
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
