"""Nomograms of balancing mechanisms: criteria a and b of types I, II and III over the dwell."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from optlaws import drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    from optlaws.jobs.dwell.cases import Types

COLOURS = {"I": drawing.GREY, "II": drawing.BLUES[3], "III": drawing.GREEN}
_POINTS = 49


def draw_first(spec: Types) -> dict[str, bytes]:
    """Criterion a of type I over the dwell, a curve for each swing and scenario, as svg and png."""
    dwells = np.linspace(1.0, max(spec.dwells), _POINTS)
    strokes = ("-", "--", "-.", ":")
    with drawing.style():
        figure = drawing.figure()
        axes = figure.subplots()
        for scenario, stroke in zip(spec.scenario, strokes, strict=False):
            for swing, shade in zip(spec.swings, drawing.BLUES[-len(spec.swings) :], strict=False):
                found = [spec.types(scenario, swing, 0.0, dwell)["I"].a for dwell in dwells.tolist()]
                label = f"swing {swing:g}°, {scenario.name}"
                axes.plot(dwells, found, color=shade, linestyle=stroke, label=label)
        axes.set(xlabel="dwell (degrees)", ylabel="a: greatest radius over that of the executive cam")
        axes.set(title=f"Cam of the loader of type I, law {spec.law}", ylim=(1.0, None))
        axes.legend(loc="upper left")
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def draw_all(spec: Types) -> dict[str, bytes]:
    """Criteria a and b of the types in the first scenario, a panel for each swing and clutch angle, as svg and png."""
    with drawing.style():
        rows, columns = len(spec.swings), len(spec.clutch_angles)
        figure = drawing.figure(3.5 * columns + 1.0, 2.7 * rows + 0.9)
        panels = figure.subplots(rows, columns, squeeze=False, sharex=True)
        handles: dict[str, Line2D] = {}
        for i, swing in enumerate(spec.swings):
            for j, clutch in enumerate(spec.clutch_angles):
                axes = panels[i, j]
                handles |= _panel(axes, spec, swing, clutch, last=j == columns - 1)
                axes.set(title=f"swing {swing:g}°, clutch angle {clutch:g}°")
                if j == 0:
                    axes.set_ylabel("a: size of the cam")
                if i == rows - 1:
                    axes.set_xlabel("dwell (degrees)")
        figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}


def _panel(axes: Axes, spec: Types, swing: float, clutch: float, *, last: bool) -> dict[str, Line2D]:
    least, most = min(spec.dwells), max(spec.dwells)
    dwells = np.linspace(max(least, 2.0 * clutch + 2.0), most, _POINTS)
    cases = [spec.types(spec.scenario[0], swing, clutch, dwell) for dwell in dwells.tolist()]
    handles: dict[str, Line2D] = {}
    for kind in ("I", "II", "III"):
        (handles[f"a, type {kind}"],) = axes.plot(dwells, [one[kind].a for one in cases], color=COLOURS[kind])
    axes.set(xlim=(least, most), ylim=(0.9, 4.0))
    torque = axes.twinx()
    torque.spines["right"].set_visible(True)
    torque.grid(visible=False)
    for kind in ("II", "III"):
        values = [one[kind].b for one in cases]
        (handles[f"b, type {kind}"],) = torque.semilogy(dwells, values, color=COLOURS[kind], linestyle="--")
    torque.set_ylim(0.02, 200.0)
    if last:
        torque.set_ylabel("b: residual torque")
    else:
        torque.set_yticklabels([])
    return handles
