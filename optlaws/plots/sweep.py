"""Pictures of sweeps: columns of a table over the values that an entry takes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from optlaws.plots.style import BLUES, GREEN, GREY, WARM, new_figure, plot_style, titled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from optlaws.files.tables import Cell

_COLOURS = (BLUES[3], GREY, WARM, GREEN, BLUES[1])
_HEIGHT = 1.9


def sweep_figure(headings: Sequence[str], rows: Sequence[Sequence[Cell]], title: str) -> Figure:
    """The numeric columns of a table over its first column, a panel for each unit; missing values are gaps."""
    panels: dict[str, list[int]] = {}
    for i, heading in enumerate(headings[2:], 2):
        unit = heading.rpartition(", ")[2] if ", " in heading else ""
        # what has no unit of its own, a bound, is in that of the column before
        panels.setdefault(unit or next(reversed(panels), ""), []).append(i)
    values = [row[0] for row in rows]
    numeric = all(isinstance(value, int | float) for value in values)
    places = np.array(values if numeric else range(len(values)), dtype=np.float64)
    with plot_style():
        figure = new_figure(7.2, 1.2 + _HEIGHT * max(1, len(panels)))
        axes = figure.subplots(max(1, len(panels)), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (unit, columns) in zip(axes, panels.items(), strict=False):
            for colour, i in zip(_COLOURS, columns, strict=False):
                curve = np.array(
                    [row[i] if isinstance(row[i], int | float) else np.nan for row in rows], dtype=np.float64
                )
                if np.isnan(curve).all():
                    continue
                panel.plot(places, curve, marker="o", markersize=4.0, color=colour, label=headings[i].partition(",")[0])
            panel.set_ylabel(unit)
            panel.set_ylim(bottom=min(0.0, panel.get_ylim()[0]))
            panel.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False, fontsize=8.0)
        axes[-1].set_xlabel(headings[0])
        if not numeric:
            axes[-1].set_xticks(places, [str(value) for value in values])
        return titled(figure, title)
