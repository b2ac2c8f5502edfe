"""Pictures of least times: the motion within its limits, the time over the stroke, and fronts over the time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from optlaws.cycles.moves.fastest_move import AXES
from optlaws.plots.cycle import UNITS
from optlaws.plots.front import draw_time_front
from optlaws.plots.style import BLUES, GREY, WARM, empty_figure, plot_style, titled
from optlaws.synthesis.status import Status

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from optlaws.cycles.moves.fastest_move import FastestMove
    from optlaws.cycles.moves.time_front import TimeFront

_POINTS = 601
_MS = 1e3
_NAMES = ("position", "velocity", "acceleration", "jerk")
_ROOM = 1.08
#: a limit is drawn up to so many times what is used of it
_NEAR = 2.0


def motion_figure(move: FastestMove, title: str) -> Figure:
    """Position, velocity, acceleration and jerk of the fastest motion over time, with their limits."""
    k = np.linspace(0.0, 1.0, _POINTS)
    limits = move.least.move.limits
    bounds = (
        (None, None),
        (limits.velocity, limits.velocity),
        (limits.deceleration, limits.acceleration),
        (limits.jerk, limits.jerk),
    )
    with plot_style():
        figure = empty_figure(7.2, 6.4)
        panels = figure.subplots(len(_NAMES), 1, sharex=True)
        for nu, (axes, name, (low, high)) in enumerate(zip(panels, _NAMES, bounds, strict=True)):
            unit, factor = UNITS[AXES[move.unit]][nu]
            values = factor * move.stroke / move.duration**nu * np.asarray(move.law(k, nu))
            axes.plot(_MS * move.duration * k, values, color=BLUES[-1], linewidth=1.5)
            for side, bound in ((-1.0, low), (1.0, high)):
                # a limit far from what is used would flatten the curve
                if bound is not None and factor * bound <= _NEAR * float((side * values).max()):
                    axes.axhline(side * factor * bound, color=WARM, linewidth=1.0, linestyle="--")
            axes.set_ylabel(f"{name}, {unit}")
        panels[-1].set_xlabel("time in ms; dashed: limits")
        return titled(figure, title)


def strokes_figure(moves: Sequence[FastestMove], title: str) -> Figure:
    """The least times over the stroke, beside the limit of all laws, and by which share they are above it."""
    ordered = sorted(moves, key=lambda move: move.stroke)
    unit, factor = UNITS[AXES[ordered[0].unit]][0]
    strokes = np.array([factor * move.stroke for move in ordered])
    times = np.array([_MS * move.duration for move in ordered])
    limits = np.array([np.nan if move.limit is None else _MS * move.limit for move in ordered])
    with plot_style():
        figure = empty_figure(7.2, 4.6)
        axes = figure.subplots()
        proven = all(move.status is Status.OPTIMAL for move in ordered)
        label = "least time, proven" if proven else "least time that was found"
        axes.plot(strokes, times, color=BLUES[-1], marker="o", markersize=3.0, label=label)
        if not np.isnan(limits).all():
            axes.plot(strokes, limits, color=GREY, linewidth=1.0, label="limit of all laws")
        axes.set(xlabel=f"stroke in {unit}", ylabel="time in ms")
        axes.set_ylim(bottom=0.0, top=_ROOM * float(times.max()))
        axes.legend(loc="upper left")
        return titled(figure, title)


def fronts_figure(fronts: Sequence[TimeFront], title: str) -> Figure:
    """What is least over the time of a move, a panel for each objective."""
    with plot_style():
        figure = empty_figure(7.2, 0.9 + 2.3 * len(fronts))
        panels = figure.subplots(len(fronts), 1, sharex=True, squeeze=False)[:, 0]
        for axes, front in zip(panels, fronts, strict=True):
            draw_time_front(front, axes)
            axes.legend(loc="upper right")
            if axes is not panels[-1]:
                axes.set_xlabel("")
        return titled(figure, title)
