"""Figures of the atlas: the least C and the least D over B, by order and degree."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from optlaws import drawing
from optlaws.studies.point import StudyPoint

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_STROKES = ((0, (1, 1.5)), (0, (4, 1.5)), "-")
_ROOM = 2.5


def draw(points: Sequence[StudyPoint]) -> dict[str, dict[str, bytes]]:
    """The figures as svg and png, by name."""
    drawn = {}
    for constant, word in (("C", "acceleration"), ("D", "power")):
        some = [point for point in points if point.inputs["minimise"] == constant]
        with drawing.style():
            figure = drawing.figure(8.6, 5.0)
            axes = figure.subplots()
            _curves(axes, some)
            axes.set(
                title=f"Least {constant} by order l of the end conditions and degree of Z",
                xlabel="peak velocity B (dimensionless)",
                ylabel=f"peak {word} {constant} (dimensionless)",
            )
            figure.legend(loc="outside right upper")
            drawn[f"least-{constant.lower()}"] = {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}
    return drawn


def _curves(axes: Axes, points: Sequence[StudyPoint]) -> None:
    orders, degrees = (sorted({point.inputs[name] for point in points}) for name in ("order", "degree"))
    for order, shade in zip(orders, drawing.BLUES[-len(orders) :], strict=False):
        for degree, stroke in zip(degrees, _STROKES[-len(degrees) :], strict=False):
            curve = [p for p in points if p.inputs["order"] == order and p.inputs["degree"] == degree]
            B = [point.inputs["B"] for point in curve]
            values = [np.nan if point.objective is None else point.objective for point in curve]
            axes.plot(B, values, color=shade, linestyle=stroke, label=f"l = {order}, degree {degree}")
    limits = {point.inputs["B"]: point.limit for point in points if point.limit is not None}
    if limits:
        axes.plot(list(limits), list(limits.values()), color=drawing.GREY, linewidth=1.2, label="limit of all laws")
    found = [point.objective for point in points if point.objective is not None]
    axes.set_ylim(0.95 * min([*limits.values(), *found]), min(1.03 * max(found), _ROOM * float(np.median(found))))
