"""Figures of fronts, with known laws and limits beside them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws import drawing
from optlaws.jobs.laws.beside_fronts import draw_beside
from optlaws.synthesis import Problem
from optlaws.synthesis.front import Front
from optlaws.synthesis.limits.of_problem import known_limit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from optlaws.jobs.laws.fronts import Picture

Pair = tuple[float, float]

_MARGIN = 0.06


def draw(picture: Picture, fronts: Sequence[Front]) -> dict[str, bytes]:
    """The figure as svg and png."""
    x, y = (_window(picture, fronts, axis) for axis in (0, 1))
    with drawing.style():
        figure = drawing.figure(8.6, 5.0)
        axes = figure.subplots()
        shades = drawing.BLUES[-len(fronts) :]
        for curve, front, shade in zip(picture.front, fronts, shades, strict=True):
            drawing.draw_front(front, axes, color=shade, label=curve.label, marker="o", markersize=2.2, zorder=4)
        draw_beside(axes, picture, x, y)
        if picture.limits and picture.over[0] == "B":
            _limit_curves(axes, picture, fronts, x)
        elif picture.limits:
            _corners(axes, picture, fronts, shades)
        axes.set(xlim=x, ylim=y, title=picture.title)
        figure.legend(loc="outside right upper")
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def _window(picture: Picture, fronts: Sequence[Front], axis: int) -> Pair:
    given = (picture.x, picture.y)[axis]
    if given is not None:
        return given[0], given[1]
    values = np.concatenate([front.values[:, axis] for front in fronts])
    low, high = float(values.min()), float(values.max())
    return low - _MARGIN * (high - low), high + _MARGIN * (high - low)


def _limit_curves(axes: Axes, picture: Picture, fronts: Sequence[Front], x: Pair) -> None:
    """What no law can beat at each B; fronts of different orders mostly share it."""
    values = np.linspace(max(x[0], 1.0 + 1e-3), x[1], 200)
    drawn: list[list[float | None]] = []
    for front in fronts:
        asked = front[0].problem
        found = [known_limit(replace(asked, B=float(B), minimise=picture.over[1])) for B in values]
        if None in found or found in drawn:
            continue
        label = "limit of all laws" if not drawn else f"the same of order {asked.order}"
        stroke = ("-", "-.")[min(len(drawn), 1)]
        axes.plot(
            values, np.array(found, dtype=float), label=label, color=drawing.GREY, linewidth=1.2, linestyle=stroke
        )
        drawn.append(found)


def _corners(axes: Axes, picture: Picture, fronts: Sequence[Front], shades: Sequence[str]) -> None:
    """What no law can beat in either constant, which no one law need reach in both."""
    axes.plot([], [], color=drawing.GREY, linestyle=(0, (1, 2)), label="limit of each constant alone")
    for front, shade in zip(fronts, shades, strict=True):
        asked = _freed(front[0].problem, picture.over[0])
        limits = [known_limit(replace(asked, minimise=name)) for name in picture.over]
        for line, value in zip((axes.axvline, axes.axhline), limits, strict=True):
            if value is not None:
                style: dict[str, Any] = {"color": shade, "linewidth": 1.1, "linestyle": (0, (1, 2)), "zorder": 2}
                draw_line: Callable[..., Any] = line
                draw_line(value, **style)


def _freed(problem: Problem, name: str) -> Problem:
    changed: dict[str, Any] = {name: None}
    return replace(problem, **changed)
