"""Pictures of sweeps and studies: columns of a table over the values of an entry."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.errors import InputError
from optlaws.files.reading import is_number
from optlaws.plots.style import BLUES, DISTINCT, GREEN, GREY, WARM, new_figure, plot_style, titled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from optlaws.files.tables import Cell
    from optlaws.numbers import Array

_COLOURS = (BLUES[3], GREY, WARM, GREEN, BLUES[1])
_HEIGHT = 1.9
#: more points are drawn as pixels
_VECTORS = 2_000
_DRAWN = 20_000


def sweep_figure(headings: Sequence[str], rows: Sequence[Sequence[Cell]], title: str) -> Figure:
    """The numeric columns of a table over its first column, a panel for each unit; missing values are gaps."""
    panels: dict[str, list[int]] = {}
    for i, heading in enumerate(headings[2:], 2):
        if not any(isinstance(row[i], int | float) for row in rows):
            continue
        unit = heading.rpartition(", ")[2] if ", " in heading else ""
        # what has no unit of its own, a bound, is in that of the column before
        panels.setdefault(unit or next(reversed(panels), ""), []).append(i)
    places, names = _places([row[0] for row in rows])
    with plot_style():
        figure = new_figure(7.2, 1.2 + _HEIGHT * max(1, len(panels)))
        axes = figure.subplots(max(1, len(panels)), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (unit, columns) in zip(axes, panels.items(), strict=False):
            for colour, i in zip(_COLOURS, columns, strict=False):
                curve = np.array(
                    [row[i] if isinstance(row[i], int | float) else np.nan for row in rows], dtype=np.float64
                )
                panel.plot(places, curve, marker="o", markersize=4.0, color=colour, label=headings[i].partition(",")[0])
            panel.set_ylabel(unit)
            panel.set_ylim(bottom=min(0.0, panel.get_ylim()[0]))
            panel.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False, fontsize=8.0)
        axes[-1].set_xlabel(headings[0])
        if names is not None:
            axes[-1].set_xticks(range(len(names)), names)
        return titled(figure, title)


def _places(values: Sequence[Any]) -> tuple[Array, list[str] | None]:
    """Numbers as places on an axis; other values by their order, with their names."""
    if all(map(is_number, values)):
        return np.array(values, dtype=np.float64), None
    names = list(dict.fromkeys(map(str, values)))
    return np.array([names.index(str(value)) for value in values], dtype=np.float64), names


def points_figure(study: Iterable[Any], place: str, title: str) -> Figure:
    """The objective and the peaks of a study's points over their entry of most values, coloured by the next entry.

    Drawn are those that have a law; of many, evenly spaced ones.
    """
    solved = [point for point in study if point.objective is not None]
    if not solved:
        raise InputError(f"{place} has no point with a law yet, so there is no picture")
    solved = solved[:: -(-len(solved) // _DRAWN)]
    entries = {entry: [point.inputs[entry] for point in solved] for entry in solved[0].inputs}
    objective, *peaks = (
        np.array([getattr(point, of) for point in solved], dtype=float) for of in ("objective", *"BCDJ")
    )
    along, *others = sorted(entries, key=lambda name: -len(set(map(str, entries[name]))))
    places, names = _places(entries[along])
    colours, named = _places(entries[others[0]]) if others else (np.zeros(len(places)), None)
    kinds = np.unique(colours).tolist() if others else []
    style: dict[str, Any] = {"s": 12.0, "linewidths": 0.0, "rasterized": len(places) > _VECTORS}
    # a peak that is the objective, or the entry along the axis, needs no panel
    known = (places, objective)
    results = {"objective": objective} | {
        name: peak
        for name, peak in zip("BCDJ", peaks, strict=True)
        if np.isfinite(peak).any() and not any(np.allclose(peak, each) for each in known)
    }
    with plot_style():
        figure = new_figure(7.2, 1.2 + _HEIGHT * len(results))
        axes = figure.subplots(len(results), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (name, result) in zip(axes, results.items(), strict=True):
            panel.set_ylabel(name)
            if len(kinds) > len(DISTINCT):
                points = panel.scatter(places, result, c=colours, cmap="viridis", **style)
                continue
            for i, kind in enumerate(kinds or [0.0]):
                chosen = colours == kind
                panel.scatter(places[chosen], result[chosen], color=DISTINCT[i], **style)
        axes[-1].set_xlabel(along)
        if names is not None:
            axes[-1].set_xticks(range(len(names)), names)
        if len(kinds) > len(DISTINCT):
            bar = figure.colorbar(points, ax=axes, label=others[0], aspect=40.0)
            if named is not None:
                bar.set_ticks(range(len(named)), labels=named)
        elif kinds:
            labels = [f"{others[0]} = {value}" for value in named or [f"{kind:g}" for kind in kinds]]
            figure.legend(axes[0].collections, labels, loc="outside lower center", ncols=3, frameon=False)
    return titled(figure, title)
