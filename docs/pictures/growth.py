"""The picture of the page on growth: seconds over sizes, kind by kind, from the figures stored beside the page."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from optlaws.files.writing import forced
from optlaws.plots.style import DISTINCT, GREY, empty_figure, plot_style, save_picture

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FIGURES = Path(__file__).parents[1] / "reference" / "growth.csv"
#: title, what is counted, kinds with their labels, and the powers of the slopes drawn
PANELS = (
    ("One law", "degree of Z", {"law, l = 4, 0 <= b": "l = 4, b ≥ 0", "law, l = 3": "l = 3"}, (2,)),
    (
        "One law of pieces",
        "pieces",
        {
            "free pieces, J": "least J",
            "free pieces, C": "least C",
            "Z in B-splines, C": "Z in B-splines, least C",
            "free pieces, rms c": "least RMS of c",
        },
        (1, 2),
    ),
    (
        "A cycle of moves from rest to rest",
        "segments",
        {
            "greatest speed of moves": "greatest speed",
            "moves, velocity limit": "velocity limit",
            "optimal moves": "least acceleration",
            "given laws": "given laws",
        },
        (1,),
    ),
    (
        "A cycle of free motions, one law",
        "segments",
        {
            "free motions, velocity limit": "velocity limit",
            "free motions, jerk": "least jerk",
            "free motions, acceleration": "least acceleration",
            "free motions, rms acceleration": "least RMS acceleration",
            "free motions, rms jerk": "least RMS jerk",
        },
        (1,),
    ),
    ("Many laws at once", "laws, points", {"array": "an array of laws", "front": "a front of B and C"}, (1,)),
    ("An exported table", "points", {"exported table": "CSV with its report"}, (1,)),
)


def series() -> dict[str, list[tuple[int, float, str]]]:
    """Sizes, seconds and statuses by the names of kinds."""
    kinds: dict[str, list[tuple[int, float, str]]] = {}
    with FIGURES.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            kinds.setdefault(row["kind"], []).append((int(row["size"]), float(row["seconds"]), row["status"]))
    return kinds


def slopes(axes: Axes, powers: tuple[int, ...]) -> None:
    """Thin lines of slopes through the lower part of a panel."""
    low, high = axes.get_xlim()
    bottom, top = axes.get_ylim()
    size = np.geomspace(high / 20.0, high / 1.6, 2)
    for power in powers:
        line = bottom * 1.8 * (size / size[0]) ** power
        axes.plot(size, line, color=GREY, linewidth=0.9, linestyle=":")
        axes.annotate(
            f"n{'' if power == 1 else '²³'[power - 2]}",
            (size[1], line[1]),
            xytext=(3, -2),
            textcoords="offset points",
            color=GREY,
            fontsize=8.0,
        )
    axes.set_xlim(low, high)
    axes.set_ylim(bottom, max(top, bottom * 10.0))


def draw(folder: Path) -> Path:
    """Write growth.svg into a folder."""
    kinds = series()
    with plot_style():
        figure = empty_figure(9.2, 9.6)
        panels = figure.subplots(3, 2)
        for axes, (title, counted, shown, powers) in zip(panels.flat, PANELS, strict=True):
            for (kind, label), colour in zip(shown.items(), DISTINCT, strict=False):
                size, seconds, status = zip(*kinds[kind], strict=True)
                axes.loglog(size, seconds, "o-", color=colour, markersize=3.5, label=label)
                open_ended = [place for place, one in enumerate(status) if one == "inaccurate"]
                axes.plot(
                    [size[i] for i in open_ended],
                    [seconds[i] for i in open_ended],
                    "o",
                    color=colour,
                    markerfacecolor="white",
                    markersize=7.0,
                )
            axes.set_title(title)
            axes.set_xlabel(counted)
            axes.set_ylabel("processor time (s)")
            slopes(axes, powers)
            axes.legend(loc="upper left", fontsize=8.0)
            bottom, top = axes.get_ylim()
            # room for the legend
            axes.set_ylim(bottom, top * (top / bottom) ** (0.08 * len(shown)))
        return save_picture(figure, folder / "growth")


if __name__ == "__main__":
    with forced():
        draw(Path(__file__).parent)
