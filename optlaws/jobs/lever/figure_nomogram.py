"""The figure of the job "lever nomogram"."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import degrees
from typing import TYPE_CHECKING, Any

from optlaws import drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from optlaws.mechanisms.lever.lever import TorsionLever


def draw(curves: Mapping[float, Sequence[TorsionLever]]) -> dict[str, bytes]:
    """The figure as svg and png: for each beta, from the swing up to gamma01 and from there to xi."""
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullLocator

    with drawing.style():
        figure = drawing.figure(9.2, 4.6)
        left, right = figure.subplots(1, 2)
        for beta, levers in curves.items():
            colour = drawing.GREY if beta == 1.0 else drawing.BLUES[3] if beta < 1.0 else drawing.WARM
            _curve(left, beta, levers, lambda one: degrees(one.gamma01), colour)
            _curve(right, beta, levers, lambda one: one.xi, colour)
        left.set(ylabel="gamma01 (degrees)", title="Rocker at its extreme")
        right.set(ylabel="xi = c2/c1 (dimensionless)", yscale="log", title="Ratio of the stiffnesses")
        right.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        right.yaxis.set_major_formatter(FormatStrFormatter("%g"))
        right.yaxis.set_minor_locator(NullLocator())
        for axes in (left, right):
            axes.set_xlabel("swing of the driven link (degrees)")
            axes.margins(x=0.12, y=0.09)
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def _curve(
    axes: Axes,
    beta: float,
    levers: Sequence[TorsionLever],
    value: Callable[[TorsionLever], float],
    colour: str,
) -> None:
    swing, values = [degrees(one.swing) for one in levers], [value(one) for one in levers]
    axes.plot(swing, values, color=colour)
    style: dict[str, Any] = {"textcoords": "offset points", "va": "center", "ha": "right", "fontsize": 8.5}
    axes.annotate(f"{beta:g}", (swing[0], values[0]), xytext=(-4, 0), color=colour, **style)
