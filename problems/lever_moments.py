"""The moment of the torsion lever over its deviation, for several lengths and pre-twists."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from numpy.typing import NDArray

from optlaws import deg
from optlaws.balancing import TorsionLever
from optlaws.plots.style import BLUES, GREY, WARM, empty_figure, plot_style
from optlaws.results import Cell, Entries, Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEADINGS = (
    "panel", "curve", "swing, deg", "chi01, deg", "chi02, deg", "M_R at chi01", "M_R at chi02", "off the tangent, %",
)  # fmt: skip


class Curve(msgspec.Struct, rename={"lam": "lambda"}):
    """Lengths and pre-twists of one curve."""

    lam: float
    rho: float
    nu: float
    beta: float | None = None


class Panel(msgspec.Struct):
    """One panel: its beta, which a curve may have otherwise, and its swing in degrees."""

    beta: float
    swing: float
    curve: list[Curve]


class Moments(Entries):
    """The problem file."""

    panel: list[Panel]


@dataclass(frozen=True)
class Drawn:
    """A lever with its place: the panel's beta, and the number of its curve from 1."""

    beta: float
    number: int
    lever: TorsionLever

    @property
    def name(self) -> str:
        """What the legend calls it."""
        lever = self.lever
        beta = f"beta {lever.beta:g}, " if lever.beta != self.beta else ""
        return f"{self.number}: {beta}lambda {lever.lam:g}, rho {lever.rho:g}, nu {lever.nu:g}"

    @property
    def chi(self) -> NDArray[np.float64]:
        """Deviations from one extreme to the other, radians."""
        motion = self.lever.asymptotic
        return np.linspace(motion.chi02, motion.chi01, 121)

    def departure(self) -> float:
        """The greatest departure of the moment from its tangent at rest at the extremes, as a share of the tangent."""
        ends = self.chi[[0, -1]]
        return float(np.abs(self.lever.moment(ends) / (self.lever.n * ends) - 1.0).max())


def run(results: Results) -> None:
    """Table the moments at the extremes, and draw them between."""
    spec = results.read(Moments)
    drawn = [_drawn(panel, i, curve) for panel in spec.panel for i, curve in enumerate(panel.curve, 1)]
    rows = [_row(case) for case in drawn]
    results.table("moments", HEADINGS, rows)
    results.picture("moments", draw(drawn))
    page = results.page("moments").text(spec.text).figure("moments", "Moment of the bars over the deviation")
    page.table(HEADINGS, rows)
    first = drawn[0].lever
    assert abs(first.moment(first.asymptotic.chi01) - 1.665344) < 1e-6
    assert all(case.departure() < 1e-9 for case in drawn if case.lever.beta == 1.0), "a parallelogram is linear"


def _drawn(panel: Panel, number: int, curve: Curve) -> Drawn:
    beta = panel.beta if curve.beta is None else curve.beta
    lever = TorsionLever(beta=beta, lam=curve.lam, rho=curve.rho, nu=curve.nu, swing=deg(panel.swing))
    return Drawn(panel.beta, number, lever)


def _row(case: Drawn) -> list[Cell]:
    motion = case.lever.asymptotic
    angles = [round(degrees(angle), 9) for angle in (case.lever.swing, motion.chi01, motion.chi02)]
    moments = [float(case.lever.moment(chi)) for chi in (motion.chi01, motion.chi02)]
    # a lever without any departure has one of rounding size
    return [f"beta = {case.beta:g}", case.name, *angles, *moments, round(100.0 * case.departure(), 9) + 0.0]


def draw(drawn: Sequence[Drawn]) -> Figure:
    """The figure: a panel a beta, each curve with its tangent at rest."""
    betas = list(dict.fromkeys(case.beta for case in drawn))
    with plot_style():
        figure = empty_figure(4.8 * len(betas), 4.4)
        for axes, beta in zip(np.atleast_1d(figure.subplots(1, len(betas))), betas, strict=True):
            _panel(axes, beta, [case for case in drawn if case.beta == beta])
        return figure


_STYLES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (1, 1)))


def _panel(axes: Axes, beta: float, drawn: Sequence[Drawn]) -> None:
    shades = (*BLUES[::-1][: len(drawn) - 1], WARM) if len(drawn) > 1 else (BLUES[-1],)
    for case, colour, dashes in zip(drawn, shades, _STYLES, strict=False):
        chi = case.chi
        axes.plot(np.degrees(chi), case.lever.moment(chi), color=colour, linestyle=dashes, label=case.name)
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.axvline(0.0, color=GREY, linewidth=0.8)
    axes.set(xlabel="deviation of the driven link, deg", ylabel="moment M_R / c1, radians")
    axes.set_title(f"beta = {beta:g}")
    axes.legend(loc="upper left", fontsize=8.0)


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
