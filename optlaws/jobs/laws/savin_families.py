"""The job "savin families": the constants of Savin's families over alpha, tabled and drawn (his Fig. 2)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
import numpy as np

from optlaws import drawing
from optlaws.files import tables, writing
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.pages.page import Page
from optlaws.laws.savin.family import SavinFamily

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADINGS = ("family", "alpha", "delta", "order of a⁽ⁿ⁾(0)", "a⁽ⁿ⁾(0)", "B", "C", "k of C", "D", "k of D")
BEST = (
    "family", "u", "H", "M", "alpha from", "alpha to", "alpha of least C", "least C", "alpha of least D", "least D",
)  # fmt: skip

Named = Literal["I", "II", "III", "IV"] | Annotated[int, msgspec.Meta(ge=0, le=20)]


class Multiplier(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """What the picture of the multiplier shows: a family, and two or three members."""

    family: Named
    alpha: Annotated[list[float], msgspec.Meta(min_length=1, max_length=3)]


class Study(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    families: Annotated[list[Named], msgspec.Meta(min_length=1, max_length=6)]
    rows: Annotated[int, msgspec.Meta(ge=2, le=1000)]
    points: Annotated[int, msgspec.Meta(ge=2, le=10000)] = 201
    text: str = ""
    multiplier: Multiplier | None = None


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Study, file)
    families = [SavinFamily.of(family) for family in spec.families]
    about = f"{spec.title}; from {file.name}"
    lines = [line for family in families for line in _lines(family, spec.rows)]
    written = [
        writing.write(out / "table.csv", tables.to_csv(HEADINGS, lines, about=about)),
        writing.write(out / "table.md", str(_page(spec, families, lines))),
    ]
    written += drawing.save_picture(draw(spec.title, families, spec.points), out / "figure")
    if spec.multiplier is not None:
        written += drawing.save_picture(draw_multiplier(spec.multiplier), out / "multiplier")
    return written


def _lines(family: SavinFamily, rows: int) -> list[list[tables.Cell]]:
    """Members at equal steps of alpha on either side of the base law, those of least C and of least D."""
    low, high = family.range
    steps = rows // 2
    alphas = {low * i / steps for i in range(steps + 1)} | {high * i / steps for i in range(steps + 1)}
    named = {Fraction(family.least_C[0]), Fraction(family.least_D[0])}
    alphas |= {given for given in named if all(abs(given - other) > 1e-9 for other in alphas)}
    return [_line(family, alpha) for alpha in sorted(alphas)]


def _line(family: SavinFamily, exact: Fraction) -> list[tables.Cell]:
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


def _pair(peak: Any) -> tuple[float, float]:  # noqa: ANN401
    return peak.value, peak.k


def _best(family: SavinFamily) -> list[tables.Cell]:
    low, high = map(float, family.range)
    (at_C, C), (at_D, D) = family.least_C, family.least_D
    name = str(family).removeprefix("family ")
    return [name, family.u, family.H, f"{family.M}", low, high, at_C, C.value, at_D, D.value]


def _page(spec: Study, families: list[SavinFamily], lines: list[list[tables.Cell]]) -> Page:
    page = Page(spec.title).text(spec.text).figure("figure", spec.title)
    page.table(BEST, [_best(family) for family in families], digits=10)
    return page.table(HEADINGS, lines, digits=8)


_NOTE: dict[str, Any] = {"color": drawing.GREY, "fontsize": 8.0, "va": "top", "linespacing": 1.4}
_MARKS: dict[str, Any] = {"marker": "o", "markersize": 4.5, "linestyle": "", "zorder": 4}


def draw(title: str, families: Sequence[SavinFamily], points: int) -> Figure:
    """The start, B, C and D of each family over alpha, with its base law and its best members."""
    with drawing.style():
        figure = drawing.figure(9.2, 6.6)
        panels = figure.subplots(2, 2, sharex=True)
        for family, shade in zip(families, drawing.DISTINCT, strict=False):
            low, high = map(float, family.range)
            alphas = np.linspace(low, high, points).tolist()
            for axes, height in zip(panels.flat, _heights(family), strict=True):
                axes.plot(alphas, [height(alpha) for alpha in alphas], color=shade)
                axes.plot([0.0], [height(0.0)], color=shade, **_MARKS)
            for axes, (alpha, peak) in ((panels[0, 1], family.least_C), (panels[1, 1], family.least_D)):
                axes.plot([alpha], [peak.value], color=shade, markerfacecolor="white", **_MARKS)
            panels[0, 0].plot([], [], color=shade, label=str(family))
        _label(panels, families)
        for label, face in (("base law, alpha = 0", drawing.GREY), ("least of the family", "white")):
            panels[0, 0].plot([], [], color=drawing.GREY, markerfacecolor=face, label=label, **_MARKS)
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


def _label(panels: Any, families: Sequence[SavinFamily]) -> None:  # noqa: ANN401 - an array of axes
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
    with drawing.style():
        figure = drawing.figure(9.2, 3.8)
        left, right = figure.subplots(1, 2)
        for (alpha, law), colour in zip(laws.items(), (drawing.GREY, *_OF_MEMBERS), strict=False):
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


_OF_MEMBERS = (drawing.BLUES[-1], drawing.WARM, drawing.GREEN)
