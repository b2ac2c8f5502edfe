"""The figure of Savin's families: start acceleration, C, B and D over alpha."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws import drawing
from optlaws.laws.savin.family import SavinFamily

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MARKS: dict[str, Any] = {"marker": "o", "markersize": 4.5, "linestyle": "", "zorder": 4}


def draw(title: str, families: Sequence[SavinFamily], points: int) -> dict[str, bytes]:
    """The figure as svg and png."""
    with drawing.style():
        figure = drawing.figure(9.2, 6.6)
        panels = figure.subplots(2, 2, sharex=True)
        shades = drawing.BLUES[-len(families) :] if len(families) <= len(drawing.BLUES) else drawing.BLUES * 2
        for family, shade in zip(families, shades, strict=False):
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
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


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
        "start derivative / base law's",
        "peak acceleration C",
        "peak velocity B",
        "peak power D",
    )
    for axes, text in zip(panels.flat, texts, strict=True):
        axes.set_ylabel(text)
    for axes in panels[1]:
        axes.set_xlabel("alpha")
    starts = ", ".join(f"{family.start(0.0)[1]:g} ({_derivative(family)})" for family in families)
    place: dict[str, Any] = {"transform": panels[0, 0].transAxes, "fontsize": 8.0, "va": "top"}
    _note(panels[0, 0], f"base laws: {starts}", place)


def _derivative(family: SavinFamily) -> str:
    return {2: "c", 3: "c'", 4: "c''", 5: "c'''"}.get(family.order, f"order {family.order}")


def _note(axes: Axes, text: str, place: dict[str, Any]) -> None:
    axes.text(0.02, 1.06, text, color=drawing.GREY, **place)
