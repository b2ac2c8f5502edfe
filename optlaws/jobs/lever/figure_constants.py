"""The figure of the job "lever parametric": B and C of the torsion lever over its swing."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from optlaws import drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from optlaws.jobs.lever.parametric import Group

_COOL = ("#08306b", "#2166ac", "#4292c6", "#74add1", "#9ecae1")
_HOT = ("#fdae6b", "#f16913", "#d95f02", "#a63603", "#7f2704")
_PANELS = (
    (0, "run-up", "peak velocity B1", pi / 2),
    (1, "run-out", "peak velocity B3", pi / 2),
    (2, "run-up", "peak acceleration C1", pi**2 / 2),
    (3, "run-out", "peak acceleration |C3|", pi**2 / 2),
)


def draw(betas: Sequence[float], groups: Sequence[Group]) -> dict[str, bytes]:
    """The figure as svg and png: bands between the least and the greatest constant at each swing."""
    colours = _colours(betas)
    with drawing.style():
        figure = drawing.figure(9.6, 6.8)
        rows = figure.subplots(2, 2, sharex=True, sharey="row")
        for axes, (column, half, name, harmonic) in zip(rows.ravel(), _PANELS, strict=True):
            for beta in betas:
                _band(axes, [one for one in groups if one.beta == beta], column, colours[beta])
            axes.axhline(harmonic, color=drawing.GREY, linewidth=1.0, zorder=1)
            axes.set(ylabel=f"{name} (dimensionless)", title=f"{name.split()[-1]}, {half}")
        for axes in rows[1]:
            axes.set_xlabel("swing of the driven link (degrees)")
        handles = [rows[0][0].plot([], [], color=colours[beta], linewidth=5.0)[0] for beta in betas]
        labels = [f"beta = {beta:g}" + (" (harmonic)" if beta == 1.0 else "") for beta in betas]
        figure.legend(handles, labels, loc="outside right upper")
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def _colours(betas: Sequence[float]) -> dict[float, str]:
    """Blue below beta = 1 and orange above it, the darker the farther from it."""
    below = sorted(beta for beta in betas if beta < 1.0)
    above = sorted(beta for beta in betas if beta > 1.0)
    shades = {beta: _COOL[min(i * len(_COOL) // max(len(below), 1), 4)] for i, beta in enumerate(below)}
    shades |= {beta: _HOT[min(i * len(_HOT) // max(len(above), 1), 4)] for i, beta in enumerate(above)}
    return {1.0: drawing.GREY} | shades


def _band(axes: Axes, groups: Sequence[Group], column: int, colour: str) -> None:
    swing = [one.swing for one in groups]
    low, high = (np.array([end(one.values[:, column]) for one in groups]) for end in (np.min, np.max))
    axes.fill_between(swing, low, high, color=colour, alpha=0.35, linewidth=0.0)
    axes.plot(swing, 0.5 * (low + high), color=colour, marker="o", markersize=2.5)
