"""Y and the peaks of the inertial loaders of trapezia over e13 and gamma_w."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from optlaws import InputError
from optlaws.balancing import TrapeziumSubstitute, inertial_loader
from optlaws.plots.style import empty_figure, plot_style
from optlaws.results import Entries, Results

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADINGS = ("e13", "gamma_w", "m", "n", "Y by eq. 25", "Y", "B", "C", "D", "B of loader", "C of loader", "D of loader")


class Steps(msgspec.Struct, rename={"start": "from", "stop": "to"}):
    """A range of values."""

    start: float
    stop: float
    step: float

    def values(self) -> list[float]:
        """The values, without what adding up steps would round."""
        count = round((self.stop - self.start) / self.step)
        return [round(self.start + i * self.step, 9) for i in range(count + 1)]


class Nomogram(Entries):
    """The problem file."""

    gamma_w: list[float]
    e13: Steps


def run(results: Results) -> None:
    """Table and draw the loaders of all trapezia that there are."""
    spec = results.read(Nomogram)
    rows = [row for gamma_w in spec.gamma_w for e13 in spec.e13.values() if (row := _row(e13, gamma_w)) is not None]
    results.table("nomogram", HEADINGS, rows)
    results.picture("nomogram", draw(spec.title, HEADINGS, rows))
    worst = max(abs(row[4] / row[5] - 1.0) for row in rows)
    page = results.page("nomogram").text(f"Y of eq. 25 is within {worst:.1g} of the exact one, relative to it.")
    page.figure("nomogram", "Y, B, C and D of the loader").table(HEADINGS, rows, digits=6)
    assert worst < 1e-5
    assert [f"{value:.6f}" for value in rows[0][5:]] == [
        "0.693792", "2.000000", "8.000000", "8.709297", "1.387584", "5.550336", "4.192196",
    ]  # fmt: skip


def _row(e13: float, gamma_w: float) -> list[float] | None:
    try:
        substitute = TrapeziumSubstitute(e13, gamma_w)
    except InputError:
        return None
    exact = inertial_loader(substitute.law)
    peaks = substitute.law.constants
    executive = [peaks.B.value, peaks.C.value, peaks.D.value]
    return [e13, gamma_w, substitute.m, substitute.n, substitute.Y, exact.Y, *executive, exact.B, exact.C, exact.D]


_PANELS = (
    ("Y", "energy parameter Y"),
    ("B of loader", "peak velocity B of the loader"),
    ("C of loader", "peak acceleration C of the loader"),
    ("D of loader", "peak power D of the loader"),
)


def draw(title: str, headings: Sequence[str], rows: Sequence[Sequence[float]]) -> Figure:
    """Y and the peaks of the loader over e13, a curve for each gamma_w."""
    values = np.array(rows)
    column = {name: values[:, i] for i, name in enumerate(headings)}
    from matplotlib import colormaps

    shares = np.unique(column["gamma_w"])
    shades = colormaps["viridis"](np.linspace(0.0, 0.85, len(shares)))
    with plot_style():
        figure = empty_figure(9.0, 6.6)
        for axes, (name, label) in zip(figure.subplots(2, 2).flat, _PANELS, strict=True):
            for gamma_w, shade in zip(shares, shades, strict=True):
                here = column["gamma_w"] == gamma_w
                axes.plot(column["e13"][here], column[name][here], color=shade, label=f"{gamma_w:g}")
            axes.set(xlabel="e13 = 1/B of the executive law", ylabel=label)
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles, labels, title="gamma_w = B/C", loc="outside right upper")
        figure.suptitle(f"{title} (all dimensionless)", x=0.01, ha="left", fontsize=11.0)
        return figure


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
