"""How the constants of the torsion lever vary with its lengths, pre-twists and swing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from math import pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from optlaws import InputError, deg
from optlaws.balancing import LeverMotion, TorsionLever
from optlaws.plots.style import GREY, empty_figure, plot_style
from optlaws.results import Cell, Entries, Page, Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
CONSTANTS = ("B1", "B3", "C1", "C3")


class Study(Entries, rename={"lam": "lambda"}):
    """The problem file; swings in degrees, `drawn` the beta of the figure."""

    beta: list[float]
    lam: list[float]
    rho: list[float]
    nu: list[float]
    swing: list[float]
    drawn: list[float]


@dataclass(frozen=True)
class Group:
    """The levers of one beta and one swing: their number, the constants of each, and how far the formulas are off.

    Attributes
    ----------
    values
        B1, B3, C1, |C3| and T/T0 of the asymptotic motion, shape (number, 5).
    exact
        The same of the exact motion, of those levers whose exact motion keeps to the limits.
    truncated
        Greatest difference of eq. (4) from the exact moment, as a share of the greatest moment.
    off
        Greatest relative error of T, B1, B3, C1 and C3, and greatest |da|.
    """

    beta: float
    swing: float
    values: Array
    exact: Array
    truncated: float
    off: Array


def run(results: Results) -> None:
    """Table the least and the greatest constants of all levers that keep to the limits, by beta and swing."""
    spec = results.read(Study)
    groups = [
        _group(beta, swing, levers)
        for beta in spec.beta
        for swing in spec.swing
        if (levers := _levers(spec, beta, swing))
    ]
    results.table("parametric", *_cells(groups))
    results.picture("constants", draw(spec.drawn, groups))
    _fill(results.page("parametric").text(spec.text).figure("constants", "B and C over the swing"), groups)
    assert sum(len(group.values) for group in groups) == 3942
    first = groups[0]
    assert abs(first.values[:, 0].min() - 1.5713217) < 1e-6
    assert abs(first.exact[:, 0].max() - 1.5716737) < 1e-6


def _levers(spec: Study, beta: float, swing: float) -> list[TorsionLever]:
    """The levers of one beta and one swing that keep to the limits."""
    levers = []
    for lam, rho, nu in product(spec.lam, spec.rho, spec.nu):
        try:
            levers.append(TorsionLever(beta=beta, lam=lam, rho=rho, nu=nu, swing=deg(swing)))
        except InputError:
            continue
    return levers


def _group(beta: float, swing: float, levers: Sequence[TorsionLever]) -> Group:
    values = [_values(lever, lever.asymptotic) for lever in levers]
    exact, off = [], []
    for lever in levers:
        try:
            exact.append(_values(lever, lever.exact))
        except InputError:  # the exact motion leaves the limits by a little
            continue
        off.append([abs(lever.errors[name]) for name in ("T", *CONSTANTS, "max |da|")])
    return Group(
        beta,
        swing,
        np.array(values),
        np.array(exact).reshape(-1, 5),
        max(_truncated(lever) for lever in levers),
        np.array(off).reshape(-1, 6).max(axis=0, initial=0.0),
    )


def _values(lever: TorsionLever, motion: LeverMotion) -> list[float]:
    return [*(abs(getattr(motion, name)) for name in CONSTANTS), motion.period / lever.T0]


def _truncated(lever: TorsionLever) -> float:
    chi = np.linspace(lever.asymptotic.chi02, lever.chi01, 201)
    moment = lever.moment(chi)
    return float(np.abs(lever.taylor_moment(chi) - moment).max() / np.abs(moment).max())


def _cells(groups: Sequence[Group]) -> tuple[list[str], list[list[Cell]]]:
    names = ("B1", "B3", "C1", "|C3|", "T/T0")
    headings = ["beta", "swing, deg", "levers", "within the limits in the exact motion"]
    headings += [f"{name} {end}{kind}" for kind in ("", ", exact") for name in names for end in ("least", "greatest")]
    headings += [f"spread of {name}, %" for name in names[:4]]
    headings += ["Taylor error of the moment, %", *(f"{name} off by, %" for name in ("T", *CONSTANTS)), "max |da|"]
    rows: list[list[Cell]] = []
    for group in groups:
        spread = 100 * np.ptp(group.values[:, :4], axis=0) / group.values[:, :4].min(axis=0)
        rows.append(
            [
                group.beta,
                group.swing,
                len(group.values),
                len(group.exact),
                *_ends(group.values),
                *_ends(group.exact),
                *np.round(spread, 6).tolist(),
                round(100 * group.truncated, 6),
                *np.round(100 * group.off[:5], 6).tolist(),
                round(float(group.off[5]), 8),
            ]
        )
    return headings, rows


def _ends(values: Array) -> list[float]:
    # a parallelogram has no spread but rounding
    return np.round(np.stack([values.min(axis=0), values.max(axis=0)], axis=1), 9).ravel().tolist()


def _fill(page: Page, groups: Sequence[Group]) -> None:
    headings = ["beta", "swing, deg", "levers", "B1", "B3", "C1", "abs C3", "T/T0"]
    rows: list[list[Cell]] = [
        [group.beta, group.swing, len(group.values), *(_span(column) for column in group.values.T)] for group in groups
    ]
    page.heading("Asymptotic constants").table(headings, rows)
    headings = ["beta", "swing, deg", "moment, %", "T, %", "B1, %", "B3, %", "C1, %", "C3, %", "max da"]
    rows = [
        [
            group.beta,
            group.swing,
            *(f"{100 * value:.3f}" for value in (group.truncated, *group.off[:5])),
            f"{group.off[5]:.5f}",
        ]
        for group in groups
    ]
    page.heading("What they are off by, at most").table(headings, rows)


def _span(column: Array) -> str:
    low, high = (f"{end:.4f}" for end in (column.min(), column.max()))
    return low if low == high else f"{low} to {high}"


_COOL = ("#08306b", "#2166ac", "#4292c6", "#74add1", "#9ecae1")
_HOT = ("#fdae6b", "#f16913", "#d95f02", "#a63603", "#7f2704")
_PANELS = (
    (0, "run-up", "peak velocity B1", pi / 2),
    (1, "run-out", "peak velocity B3", pi / 2),
    (2, "run-up", "peak acceleration C1", pi**2 / 2),
    (3, "run-out", "peak acceleration |C3|", pi**2 / 2),
)


def draw(betas: Sequence[float], groups: Sequence[Group]) -> Figure:
    """The figure: bands between the least and the greatest constant at each swing."""
    colours = _colours(betas)
    with plot_style():
        figure = empty_figure(9.6, 6.8)
        rows = figure.subplots(2, 2, sharex=True, sharey="row")
        for axes, (column, half, name, harmonic) in zip(rows.ravel(), _PANELS, strict=True):
            for beta in betas:
                _band(axes, [group for group in groups if group.beta == beta], column, colours[beta])
            axes.axhline(harmonic, color=GREY, linewidth=1.0, zorder=1)
            axes.set(ylabel=f"{name} (dimensionless)", title=f"{name.split()[-1]}, {half}")
        for axes in rows[1]:
            axes.set_xlabel("swing of the driven link, deg")
        handles = [rows[0][0].plot([], [], color=colours[beta], linewidth=5.0)[0] for beta in betas]
        labels = [f"beta = {beta:g}" + (" (harmonic)" if beta == 1.0 else "") for beta in betas]
        figure.legend(handles, labels, loc="outside right upper")
        return figure


def _colours(betas: Sequence[float]) -> dict[float, str]:
    """Blue below beta = 1 and orange above it, the darker the farther from it."""
    below = sorted(beta for beta in betas if beta < 1.0)
    above = sorted(beta for beta in betas if beta > 1.0)
    shades = {beta: _COOL[min(i * len(_COOL) // max(len(below), 1), 4)] for i, beta in enumerate(below)}
    shades |= {beta: _HOT[min(i * len(_HOT) // max(len(above), 1), 4)] for i, beta in enumerate(above)}
    return {1.0: GREY} | shades


def _band(axes: Axes, groups: Sequence[Group], column: int, colour: str) -> None:
    swing = [group.swing for group in groups]
    low, high = (np.array([end(group.values[:, column]) for group in groups]) for end in (np.min, np.max))
    axes.fill_between(swing, low, high, color=colour, alpha=0.35, linewidth=0.0)
    axes.plot(swing, 0.5 * (low + high), color=colour, marker="o", markersize=2.5)


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
