"""The figure of the optimal-law table: C over B, printed and proven, with Savin's family III and the limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from optlaws import plotting
from optlaws.laws.savin import alpha_range, savin
from optlaws.synthesis import acceleration_limit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from optlaws.studies.optimal_table import Curves, Row, Table


def draw(spec: Table, rows: Sequence[Row], curves: Curves) -> dict[str, bytes]:
    """The figure as svg and png."""
    with plotting.style():
        figure = plotting.figure(8.0, 5.2)
        axes = figure.subplots()
        _limits(axes, spec)
        _optima(axes, curves)
        _family(axes)
        axes.plot(
            [row.B for row in rows],
            [row.law.constants.C.value for row in rows],
            "o",
            color=plotting.WARM,
            markersize=5,
            label="laws of the paper, from their Z(k)",
            zorder=5,
        )
        axes.set(
            xlabel="peak velocity B",
            ylabel="peak acceleration C",
            xlim=(spec.figure.start, spec.figure.stop),
            ylim=(3.6, 12.2),
            title="Least peak acceleration at a given peak velocity",
        )
        axes.legend(loc="upper left", ncols=1)
        return {kind: plotting.rendered(figure, kind) for kind in ("svg", "png")}


def _optima(axes: Axes, curves: Curves) -> None:
    for (degree, found), shade in zip(curves.items(), plotting.BLUES[-len(curves) :], strict=True):
        axes.plot(
            [s.problem.B for s in found],
            [s.objective for s in found],
            color=shade,
            label=f"optimal, Z of degree {degree}",
        )


def _family(axes: Axes) -> None:
    laws = [savin("III", float(alpha)) for alpha in np.linspace(*alpha_range("III"), 61)]
    axes.plot(
        [law.peak(1).value for law in laws],
        [law.peak(2).value for law in laws],
        color=plotting.GREEN,
        linestyle="--",
        label="Savin's family III",
    )


def _limits(axes: Axes, spec: Table) -> None:
    values = np.linspace(spec.figure.start, spec.figure.stop, 200)
    axes.plot(
        values,
        [acceleration_limit(B) for B in values],
        color=plotting.GREY,
        linewidth=1.2,
        label="limit of all laws",
    )
    beyond = values[values >= 2.0]
    axes.plot(
        beyond,
        [acceleration_limit(B, monotone=True) for B in beyond],
        color=plotting.GREY,
        linewidth=1.2,
        linestyle=":",
        label="limit of all laws with b ≥ 0",
    )
