"""The job "loader nomogram": Y and the peaks of loaders of trapezia over e13 and gamma_w, table and figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
import numpy as np

from optlaws import drawing
from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import Positive, Text, convert
from optlaws.jobs.pages.page import Page
from optlaws.mechanisms.loader.loader import loader
from optlaws.mechanisms.loader.trapezium import TrapeziumSubstitute

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADINGS = ("e13", "gamma_w", "m", "n", "Y by eq. 25", "Y", "B", "C", "D", "B of loader", "C of loader", "D of loader")


class Steps(msgspec.Struct, forbid_unknown_fields=True, rename={"start": "from", "stop": "to"}):
    """A range of values."""

    start: Positive
    stop: Positive
    step: Positive

    def values(self) -> list[float]:
        """The values, without what adding up steps would round."""
        count = round((self.stop - self.start) / self.step)
        return [round(self.start + i * self.step, 9) for i in range(count + 1)]


class Nomogram(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    gamma_w: Annotated[list[Positive], msgspec.Meta(min_length=1)]
    e13: Steps


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Nomogram, file)
    rows = [row for gamma_w in spec.gamma_w for e13 in spec.e13.values() if (row := _row(e13, gamma_w)) is not None]
    if not rows:
        raise InputError(f"{file}: no trapezium has these e13 and gamma_w; try e13 from 0.5 to 0.66, gamma_w from 0.25")
    about = f"{spec.title}; from {file.name}"
    figure = draw(spec.title, HEADINGS, rows)
    return [
        writing.write(out / "nomogram.csv", tables.to_csv(HEADINGS, rows, about=about)),
        writing.write(out / "nomogram.md", str(_page(spec, rows))),
        *drawing.save_picture(figure, out / "nomogram"),
    ]


def _row(e13: float, gamma_w: float) -> list[float] | None:
    try:
        substitute = TrapeziumSubstitute(e13, gamma_w)
    except InputError:
        return None
    exact = loader(substitute.law)
    peaks = substitute.law.constants
    own = [peaks.B.value, peaks.C.value, peaks.D.value]
    return [e13, gamma_w, substitute.m, substitute.n, substitute.Y, exact.Y, *own, exact.B, exact.C, exact.D]


def _page(spec: Nomogram, rows: Sequence[Sequence[float]]) -> Page:
    worst = max(abs(row[4] / row[5] - 1.0) for row in rows)
    page = Page(spec.title).text(f"Y of eq. 25 is within {worst:.1g} of the exact one, relative to it.")
    return page.figure("nomogram", "Y, B, C and D of the loader").table(HEADINGS, rows, digits=6)


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
    with drawing.style():
        figure = drawing.figure(9.0, 6.6)
        for axes, (name, label) in zip(figure.subplots(2, 2).flat, _PANELS, strict=True):
            for gamma_w, shade in zip(shares, shades, strict=True):
                here = column["gamma_w"] == gamma_w
                axes.plot(column["e13"][here], column[name][here], color=shade, label=f"{gamma_w:g}")
            axes.set(xlabel="e13 = 1/B of the executive law", ylabel=label)
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles, labels, title="gamma_w = B/C", loc="outside right upper")
        figure.suptitle(f"{title} (all dimensionless)", x=0.01, ha="left", fontsize=11.0)
        return figure
