"""The constants of Savin's families over alpha, tabled and drawn (his Fig. 2), and a multiplier (his Fig. 1)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from optlaws import Peak, SavinFamily
from optlaws.plots.style import BLUES, DISTINCT, GREEN, GREY, WARM, empty_figure, plot_style
from optlaws.results import Cell, Entries, Results

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADINGS = ("family", "alpha", "delta", "order of a⁽ⁿ⁾(0)", "a⁽ⁿ⁾(0)", "B", "C", "k of C", "D", "k of D")
BEST = (
    "family", "u", "H", "M", "alpha from", "alpha to", "alpha of least C", "least C", "alpha of least D", "least D",
)  # fmt: skip
POINTS = 201  # of a curve


class Multiplier(msgspec.Struct):
    """What the picture of the multiplier shows: a family, and two or three members."""

    family: str
    alpha: list[float]


class Study(Entries):
    """The problem file; a table has so many rows from end to end of a family's range of alpha."""

    families: list[str]
    rows: int
    multiplier: Multiplier


def run(results: Results) -> None:
    """Table and draw the families over alpha."""
    spec = results.read(Study)
    families = [SavinFamily.of(family) for family in spec.families]
    rows = [row for family in families for row in _rows(family, spec.rows)]
    results.table("table", HEADINGS, rows)
    results.picture("figure", draw(spec.title, families, POINTS))
    results.picture("multiplier", draw_multiplier(spec.multiplier))
    page = results.page("table").text(spec.text).figure("figure", spec.title)
    page.table(BEST, [_best(family) for family in families], digits=10).table(HEADINGS, rows, digits=8)
    assert [f"{family.least_C[1].value:.6f}" for family in families] == ["4.647580", "5.611317", "6.735753", "7.910005"]
    assert [f"{family.least_D[1].value:.6f}" for family in families] == ["3.261671", "4.900558", "6.782626", "8.874549"]


def _rows(family: SavinFamily, rows: int) -> list[list[Cell]]:
    """Members at equal steps of alpha on either side of the base law, those of least C and of least D."""
    low, high = family.range
    steps = rows // 2
    alphas = {low * i / steps for i in range(steps + 1)} | {high * i / steps for i in range(steps + 1)}
    named = {Fraction(family.least_C[0]), Fraction(family.least_D[0])}
    alphas |= {given for given in named if all(abs(given - other) > 1e-9 for other in alphas)}
    return [_line(family, alpha) for alpha in sorted(alphas)]


def _line(family: SavinFamily, exact: Fraction) -> list[Cell]:
    alpha = float(exact)
    order, start = family.start(alpha)
    C, D = family.C(alpha), family.D(alpha)
    delta = None if alpha == 0.0 else float(family.M + 1 / exact)
    return [
        str(family).removeprefix("family "),
        alpha,
        delta,
        order,
        start,
        family.B(alpha).value,
        *_pair(C),
        *_pair(D),
    ]


def _pair(peak: Peak) -> tuple[float, float]:
    return peak.value, peak.k


def _best(family: SavinFamily) -> list[Cell]:
    low, high = map(float, family.range)
    (at_C, C), (at_D, D) = family.least_C, family.least_D
    name = str(family).removeprefix("family ")
    return [name, family.u, family.H, f"{family.M}", low, high, at_C, C.value, at_D, D.value]


_NOTE: dict[str, Any] = {"color": GREY, "fontsize": 8.0, "va": "top", "linespacing": 1.4}
_MARKS: dict[str, Any] = {"marker": "o", "markersize": 4.5, "linestyle": "", "zorder": 4}


def draw(title: str, families: Sequence[SavinFamily], points: int) -> Figure:
    """The start, B, C and D of each family over alpha, with its base law and its best members."""
    with plot_style():
        figure = empty_figure(9.2, 6.6)
        panels = figure.subplots(2, 2, sharex=True)
        for family, shade in zip(families, DISTINCT, strict=False):
            low, high = map(float, family.range)
            alphas = np.linspace(low, high, points).tolist()
            for axes, height in zip(panels.flat, _heights(family), strict=True):
                axes.plot(alphas, [height(alpha) for alpha in alphas], color=shade)
                axes.plot([0.0], [height(0.0)], color=shade, **_MARKS)
            for axes, (alpha, peak) in ((panels[0, 1], family.least_C), (panels[1, 1], family.least_D)):
                axes.plot([alpha], [peak.value], color=shade, markerfacecolor="white", **_MARKS)
            panels[0, 0].plot([], [], color=shade, label=str(family))
        _label(panels, families)
        for label, face in (("base law, alpha = 0", GREY), ("least of the family", "white")):
            panels[0, 0].plot([], [], color=GREY, markerfacecolor=face, label=label, **_MARKS)
        figure.suptitle(title, x=0.01, ha="left", fontsize=11.0)
        figure.legend(loc="outside lower center", ncols=3)
        return figure


def _heights(family: SavinFamily) -> list[Callable[[float], float]]:
    """The four curves of a family, panel by panel."""
    base = family.start(0.0)[1]

    def start(alpha: float) -> float:
        order, value = family.start(alpha)
        return value / base if order == family.order else 0.0

    return [
        start,
        lambda alpha: family.C(alpha).value,
        lambda alpha: family.B(alpha).value,
        lambda alpha: family.D(alpha).value,
    ]


def _label(panels: Any, families: Sequence[SavinFamily]) -> None:
    texts = (
        "start derivative over\nbase law's",
        "peak acceleration C",
        "peak velocity B",
        "peak power D",
    )
    for axes, text in zip(panels.flat, texts, strict=True):
        axes.set_ylabel(f"{text} (dimensionless)")
    for axes in panels[1]:
        axes.set_xlabel("alpha (dimensionless)")
    starts = "\n".join(f"{_derivative(family)}(0) = {family.start(0.0)[1]:g}" for family in families)
    panels[0, 0].text(0.03, 0.97, f"base laws:\n{starts}", transform=panels[0, 0].transAxes, **_NOTE)


def _derivative(family: SavinFamily) -> str:
    return {2: "c", 3: "c'", 4: "c''", 5: "c'''"}.get(family.order, f"order {family.order}")


def draw_multiplier(shown: Multiplier) -> Figure:
    """The accelerations of a family's base law and of members, and the multipliers between them (Savin's Fig. 1)."""
    family, k = SavinFamily.of(shown.family), np.linspace(0.0, 1.0, 201)
    laws = {alpha: family.law(alpha) for alpha in (0.0, *shown.alpha)}
    with plot_style():
        figure = empty_figure(9.2, 3.8)
        left, right = figure.subplots(1, 2)
        for (alpha, law), colour in zip(laws.items(), (GREY, *_OF_MEMBERS), strict=False):
            label = "base law" if alpha == 0.0 else f"alpha = {alpha:g}"
            left.plot(k, law.c(k), color=colour, label=label, linestyle="--" if alpha == 0.0 else "-")
            right.plot(
                k, 1.0 + alpha * (k * k - k + float(family.M)), color=colour, linestyle="--" if alpha == 0.0 else "-"
            )
        left.set(ylabel="acceleration c (dimensionless)", title=f"Members of {family}")
        right.set(ylabel="multiplier y (dimensionless)", title="What the base law is multiplied by")
        for axes in (left, right):
            axes.set_xlabel("k (dimensionless time)")
        left.legend(loc="upper right")
        return figure


_OF_MEMBERS = (BLUES[-1], WARM, GREEN)


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
