"""The job "lever moments": the moment of the torsion lever over its deviation, for several lengths and pre-twists."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
import numpy as np

from optlaws import drawing
from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import Degrees, Text, convert
from optlaws.jobs.lever.cases import Length, Twist
from optlaws.jobs.pages.page import Page
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.lever.lever import TorsionLever

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEADINGS = (
    "panel", "curve", "swing, deg", "chi01, deg", "chi02, deg", "M_R at chi01", "M_R at chi02", "off the tangent, %",
)  # fmt: skip
_POINTS = 121


class Curve(msgspec.Struct, kw_only=True, forbid_unknown_fields=True, rename={"lam": "lambda"}):
    """Lengths and pre-twists of one curve."""

    lam: Length
    rho: Twist
    nu: Twist
    beta: Length | None = None


class Panel(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """One panel: its beta, which a curve may have otherwise, and its swing in degrees."""

    beta: Length
    swing: Degrees
    curve: Annotated[list[Curve], msgspec.Meta(min_length=1, max_length=6)]


class Moments(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    panel: Annotated[list[Panel], msgspec.Meta(min_length=1, max_length=3)]
    text: str = ""


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
        own = f"beta {lever.beta:g}, " if lever.beta != self.beta else ""
        return f"{self.number}: {own}lambda {lever.lam:g}, rho {lever.rho:g}, nu {lever.nu:g}"

    @property
    def chi(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Deviations from one extreme to the other, radians."""
        motion = self.lever.asymptotic
        return np.linspace(motion.chi02, motion.chi01, _POINTS)

    def departure(self) -> float:
        """The greatest departure of the moment from its tangent at rest at the extremes, as a share of the tangent."""
        ends = self.chi[[0, -1]]
        return float(np.abs(self.lever.moment(ends) / (self.lever.n * ends) - 1.0).max())


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Moments, file)
    drawn = [_drawn(panel, i, curve) for panel in spec.panel for i, curve in enumerate(panel.curve, 1)]
    rows = [_row(case) for case in drawn]
    about = f"{spec.title}; from {file.name}"
    page = Page(spec.title).text(spec.text).figure("moments", "Moment of the bars over the deviation")
    return [
        writing.write(out / "moments.csv", tables.to_csv(HEADINGS, rows, about=about)),
        writing.write(out / "moments.md", str(page.table(HEADINGS, rows))),
        *drawing.save_picture(draw(drawn), out / "moments"),
    ]


def _drawn(panel: Panel, number: int, curve: Curve) -> Drawn:
    beta = panel.beta if curve.beta is None else curve.beta
    try:
        lever = TorsionLever(beta=beta, lam=curve.lam, rho=curve.rho, nu=curve.nu, swing=deg(panel.swing))
    except InputError as error:
        raise InputError(f"curve {number} of the panel beta = {panel.beta:g}: {error}") from None
    return Drawn(panel.beta, number, lever)


def _row(case: Drawn) -> list[tables.Cell]:
    motion = case.lever.asymptotic
    angles = [round(degrees(angle), 9) for angle in (case.lever.swing, motion.chi01, motion.chi02)]
    moments = [float(case.lever.moment(chi)) for chi in (motion.chi01, motion.chi02)]
    # a lever without any departure has one of rounding size
    return [f"beta = {case.beta:g}", case.name, *angles, *moments, round(100.0 * case.departure(), 9) + 0.0]


def draw(drawn: Sequence[Drawn]) -> Figure:
    """The figure: a panel a beta, each curve with its tangent at rest."""
    betas = list(dict.fromkeys(case.beta for case in drawn))
    with drawing.style():
        figure = drawing.figure(4.8 * len(betas), 4.4)
        for axes, beta in zip(np.atleast_1d(figure.subplots(1, len(betas))), betas, strict=True):
            _panel(axes, beta, [case for case in drawn if case.beta == beta])
        return figure


_STYLES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (1, 1)))


def _panel(axes: Axes, beta: float, drawn: Sequence[Drawn]) -> None:
    shades = (*drawing.BLUES[::-1][: len(drawn) - 1], drawing.WARM) if len(drawn) > 1 else (drawing.BLUES[-1],)
    for case, colour, dashes in zip(drawn, shades, _STYLES, strict=False):
        chi = case.chi
        axes.plot(np.degrees(chi), case.lever.moment(chi), color=colour, linestyle=dashes, label=case.name)
    axes.axhline(0.0, color=drawing.GREY, linewidth=0.8)
    axes.axvline(0.0, color=drawing.GREY, linewidth=0.8)
    axes.set(xlabel="deviation of the driven link (degrees)", ylabel="moment M_R / c1 (radians)")
    axes.set_title(f"beta = {beta:g}")
    axes.legend(loc="upper left", fontsize=8.0)
