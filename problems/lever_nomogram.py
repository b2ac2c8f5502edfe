"""gamma01 and xi of the torsion lever over its swing, for several beta and pre-twists."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws import InputError, deg
from optlaws.balancing import TorsionLever
from optlaws.plots.style import BLUES, GREY, WARM, empty_figure, plot_style
from optlaws.results import Cell, Entries, Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEADINGS = ("beta", "swing, deg", "chi01, deg", "chi02, deg", "gamma01, deg", "xi", "T", "exact T")
POINTS = 81


class Nomogram(Entries, rename={"lam": "lambda"}):
    """The problem file: swings in degrees, `tabled` those of the table, `also` more pre-twists rho for the figure."""

    beta: list[float]
    lam: float
    rho: float
    nu: float
    tabled: list[float]
    also: list[float]


def run(results: Results) -> None:
    """Table the levers of the swings that keep to the limits, and draw those between them."""
    spec = results.read(Nomogram)
    rows = [_row(lever) for beta in spec.beta for lever in _levers(spec, beta, spec.tabled, spec.rho)]
    swings = np.linspace(min(spec.tabled), max(spec.tabled), POINTS).tolist()
    curves = {
        rho: {beta: levers for beta in spec.beta if (levers := _levers(spec, beta, swings, rho))}
        for rho in (spec.rho, *spec.also)
    }
    results.table("nomogram", HEADINGS, rows)
    results.picture("nomogram", draw(curves))
    page = results.page("nomogram").text(spec.text).figure("nomogram", "gamma01 and xi over swing and beta")
    parameters = f"lambda = {spec.lam:g}, rho = {spec.rho:g}, nu = {spec.nu:g}"
    page.text(f"{parameters}; T in units of sqrt(I / c1).").table(HEADINGS, rows)
    of_lever = {(row[0], row[1]): row[4:6] for row in rows}
    assert [f"{value:.6f}" for value in of_lever[0.25, 20.0]] == ["2.480630", "0.061828"]


def _levers(spec: Nomogram, beta: float, swings: Sequence[float], rho: float) -> list[TorsionLever]:
    """The levers of one beta that keep to the limits."""
    levers = []
    for swing in swings:
        try:
            levers.append(TorsionLever(beta=beta, lam=spec.lam, rho=rho, nu=spec.nu, swing=deg(swing)))
        except InputError:
            continue
    return levers


def _row(lever: TorsionLever) -> list[Cell]:
    motion = lever.asymptotic
    angles = (lever.swing, lever.chi01, motion.chi02, lever.gamma01)
    try:
        period = lever.exact.period
    except InputError:  # the exact motion leaves the limits by a little
        period = None
    return [lever.beta, *(round(degrees(angle), 9) for angle in angles), lever.xi, motion.period, period]


def draw(curves: Mapping[float, Mapping[float, Sequence[TorsionLever]]]) -> Figure:
    """The figure: a row for each rho, in it for each beta, from the swing up to gamma01 and from there to xi."""
    with plot_style():
        figure = empty_figure(9.2, 4.6 * len(curves))
        rows = figure.subplots(len(curves), 2, squeeze=False)
        for (left, right), (rho, of_beta) in zip(rows, curves.items(), strict=True):
            suffix = f", rho = {rho:g}" if len(curves) > 1 else ""
            _draw_row(left, right, of_beta)
            left.set_title(f"Rocker at its extreme{suffix}")
            right.set_title(f"Ratio of the stiffnesses{suffix}")
        return figure


def _draw_row(left: Axes, right: Axes, curves: Mapping[float, Sequence[TorsionLever]]) -> None:
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullLocator

    for beta, levers in curves.items():
        colour = GREY if beta == 1.0 else BLUES[3] if beta < 1.0 else WARM
        _curve(left, beta, levers, lambda lever: degrees(lever.gamma01), colour)
        _curve(right, beta, levers, lambda lever: lever.xi, colour)
    for axes in (left, right):
        _head(axes)
    left.set(ylabel="gamma01, deg")
    right.set(ylabel="xi = c2/c1 (dimensionless)", yscale="log")
    right.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    right.yaxis.set_major_formatter(FormatStrFormatter("%g"))
    right.yaxis.set_minor_locator(NullLocator())
    for axes in (left, right):
        axes.set_xlabel("swing of the driven link, deg")
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
    axes.annotate("beta", first, xytext=(-4, 9), color=GREY, **style)


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
