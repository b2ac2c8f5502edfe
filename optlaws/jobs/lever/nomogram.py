"""The job "lever nomogram": gamma01 and xi of the torsion lever over its swing and beta."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
import numpy as np

from optlaws import drawing
from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.lever.cases import Length, Lengths, Swings, Twist, levers
from optlaws.jobs.pages.page import Page
from optlaws.mechanisms.lever.lever import TorsionLever

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEADINGS = ("beta", "swing, deg", "chi01, deg", "chi02, deg", "gamma01, deg", "xi", "T", "exact T")


class Nomogram(msgspec.Struct, kw_only=True, forbid_unknown_fields=True, rename={"lam": "lambda"}):
    """The problem file; swings in degrees, `tabled` those of the table, `also` more pre-twists rho for the figure."""

    job: str
    title: Text
    beta: Annotated[Lengths, msgspec.Meta(max_length=12)]
    lam: Length
    rho: Twist
    nu: Twist
    tabled: Swings
    points: Annotated[int, msgspec.Meta(ge=2, le=1000)] = 81
    also: Annotated[list[Twist], msgspec.Meta(max_length=4)] = []
    text: str = ""


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Nomogram, file)
    rows = [
        _row(lever) for beta in spec.beta for swing in spec.tabled for lever in _levers(spec, beta, [swing], spec.rho)
    ]
    if not rows:
        raise InputError("no combination of beta and swing keeps to the limits")
    swings = np.linspace(min(spec.tabled), max(spec.tabled), spec.points).tolist()
    curves = {
        rho: {beta: made for beta in spec.beta if (made := _levers(spec, beta, swings, rho))}
        for rho in (spec.rho, *spec.also)
    }
    about = f"{spec.title}; from {file.name}"
    figure = draw(curves)
    return [
        writing.write(out / "nomogram.csv", tables.to_csv(HEADINGS, rows, about=about)),
        writing.write(out / "nomogram.md", str(_page(spec, rows))),
        *drawing.save_picture(figure, out / "nomogram"),
    ]


def _levers(spec: Nomogram, beta: float, swings: Sequence[float], rho: float) -> list[TorsionLever]:
    return [lever for swing in swings for lever in levers(beta, swing, [spec.lam], [rho], [spec.nu])]


def _row(lever: TorsionLever) -> list[tables.Cell]:
    motion = lever.asymptotic
    angles = (lever.swing, lever.chi01, motion.chi02, lever.gamma01)
    try:
        period = lever.exact.period
    except InputError:  # the exact motion leaves the limits by a little
        period = None
    return [lever.beta, *(round(degrees(angle), 9) for angle in angles), lever.xi, motion.period, period]


def _page(spec: Nomogram, rows: Sequence[Sequence[tables.Cell]]) -> Page:
    held = f"lambda = {spec.lam:g}, rho = {spec.rho:g}, nu = {spec.nu:g}"
    page = Page(spec.title).text(spec.text).figure("nomogram", "gamma01 and xi over swing and beta")
    return page.text(f"{held}; T in units of sqrt(I / c1).").table(HEADINGS, rows)


def draw(curves: Mapping[float, Mapping[float, Sequence[TorsionLever]]]) -> Figure:
    """The figure: a row for each rho, in it for each beta, from the swing up to gamma01 and from there to xi."""
    with drawing.style():
        figure = drawing.figure(9.2, 4.6 * len(curves))
        rows = figure.subplots(len(curves), 2, squeeze=False)
        for (left, right), (rho, of_beta) in zip(rows, curves.items(), strict=True):
            told = f", rho = {rho:g}" if len(curves) > 1 else ""
            _draw_row(left, right, of_beta)
            left.set_title(f"Rocker at its extreme{told}")
            right.set_title(f"Ratio of the stiffnesses{told}")
        return figure


def _draw_row(left: Axes, right: Axes, curves: Mapping[float, Sequence[TorsionLever]]) -> None:
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullLocator

    for beta, made in curves.items():
        colour = drawing.GREY if beta == 1.0 else drawing.BLUES[3] if beta < 1.0 else drawing.WARM
        _curve(left, beta, made, lambda lever: degrees(lever.gamma01), colour)
        _curve(right, beta, made, lambda lever: lever.xi, colour)
    for axes in (left, right):
        _head(axes)
    left.set(ylabel="gamma01 (degrees)")
    right.set(ylabel="xi = c2/c1 (dimensionless)", yscale="log")
    right.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    right.yaxis.set_major_formatter(FormatStrFormatter("%g"))
    right.yaxis.set_minor_locator(NullLocator())
    for axes in (left, right):
        axes.set_xlabel("swing of the driven link (degrees)")
        axes.margins(x=0.12, y=0.09)


def _curve(
    axes: Axes,
    beta: float,
    levers: Sequence[TorsionLever],
    value: Callable[[TorsionLever], float],
    colour: str,
) -> None:
    swing, values = [degrees(lever.swing) for lever in levers], [value(lever) for lever in levers]
    axes.plot(swing, values, color=colour)
    style: dict[str, Any] = {"textcoords": "offset points", "va": "center", "ha": "right", "fontsize": 8.5}
    axes.annotate(f"{beta:g}", (swing[0], values[0]), xytext=(-4, 0), color=colour, **style)


def _head(axes: Axes) -> None:
    """Say above the numbers before the curves what they are."""
    starts = [np.asarray(line.get_data())[:, 0].tolist() for line in axes.lines]
    first = max(starts, key=lambda point: point[1])
    style: dict[str, Any] = {"textcoords": "offset points", "ha": "right", "fontsize": 8.5, "fontweight": "bold"}
    axes.annotate("beta", first, xytext=(-4, 9), color=drawing.GREY, **style)
