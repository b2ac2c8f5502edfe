"""Loaders of printed laws and of laws made for their loaders: C over B, and the accelerations of one pair."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from optlaws import drawing
from optlaws.mechanisms.loader.limits import loader_acceleration_limit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from optlaws.jobs.loader.optimal import Row


def draw(title: str, rows: Sequence[Row], shown: Row) -> dict[str, bytes]:
    """The figure as svg and png."""
    with drawing.style():
        figure = drawing.figure(10.6, 4.8)
        left, right = figure.subplots(1, 2)
        _over_B(left, rows)
        _pair(right, shown)
        figure.suptitle(f"{title} (all dimensionless)", x=0.01, ha="left", fontsize=11.0)
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def _over_B(axes: Axes, rows: Sequence[Row]) -> None:
    B = np.linspace(min(row.B for row in rows) - 0.04, max(row.B for row in rows) + 0.04, 121)
    axes.plot(B, [loader_acceleration_limit(one) for one in B], color=drawing.GREY, label="limit for b ≥ 0")
    finite = [row for row in rows if isfinite(row.one.C)]
    axes.plot([row.B for row in finite], [row.one.C for row in finite], "o", color=drawing.WARM, label="printed laws")
    capped = [(row.B, one.loader.C) for row in rows if (one := row.rivals["C no greater"]) is not None]
    axes.plot(*np.transpose(capped), "s", color=drawing.BLUES[2], label="least C of the loader, own C no greater")
    best = [(row.B, row.best.loader.C) for row in rows]
    axes.plot(*np.transpose(best), "v", color=drawing.GREEN, label="least C of the loader")
    axes.set(xlabel="peak velocity B of the executive law", ylabel="peak acceleration C of the loader")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)


def _pair(axes: Axes, row: Row) -> None:
    k = np.linspace(0.0, 1.0, 801)
    rival = row.rivals["C no greater"] or row.best
    for one, colour, name in ((row.one, drawing.WARM, row.code), (rival.loader, drawing.BLUES[2], "rival")):
        axes.plot(k, one.executive.c(k), color=colour, label=f"{name}: executive c")
        axes.plot(k, one.law.c(k), color=colour, linestyle="--", label=f"{name}: loader c")
    axes.set(xlabel="k (dimensionless time)", ylabel="acceleration")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)
