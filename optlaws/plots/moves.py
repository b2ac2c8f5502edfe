"""Pictures of moves: least times within limits, run-ins and run-outs of cams, and executed motions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cycles.moves.fastest_move import AXES
from optlaws.motion.derivative_panel import picture_unit
from optlaws.motion.quantities import MILLI, QUANTITIES, UNITS
from optlaws.plots.front import draw_time_front
from optlaws.plots.law import four
from optlaws.plots.report import draw_panels
from optlaws.plots.style import BLUES, GREY, WARM, empty_figure, new_figure, one_below_the_other, plot_style, titled
from optlaws.synthesis.status import Status
from optlaws.tolerances import INSIDE_PIECE

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from optlaws.cycles.cycle import Cycle
    from optlaws.cycles.moves.fastest_move import FastestMove
    from optlaws.cycles.moves.time_front import TimeFront
    from optlaws.cycles.transitions import TransitionCam
    from optlaws.exports.export import Export
    from optlaws.numbers import Array

_ROOM = 1.08


def draw_move(move: FastestMove, axes: Any = None, **style: Any) -> list[Artist]:
    """Draw position, velocity, acceleration and jerk of a move with their limits into four axes; return the artists."""
    report = move.report()
    panels = four(one_below_the_other(axes, len(QUANTITIES), 8.2))
    return draw_panels(report.panels[: len(panels)], report.segments, panels, **style)


def motion_figure(move: FastestMove, title: str) -> Figure:
    """Position, velocity, acceleration and jerk of the fastest motion over time, with their limits."""
    report = move.report()
    with plot_style():
        figure = empty_figure(7.2, 1.6 * len(report.panels))
        axes = list(figure.subplots(len(report.panels), 1, sharex=True))
        draw_panels(report.panels, report.segments, axes)
        axes[-1].set_xlabel("time, ms; dashed: limits")
        figure.align_ylabels()
        return titled(figure, title)


def strokes_figure(moves: Sequence[FastestMove], title: str) -> Figure:
    """The least times over the stroke, beside the best possible ones, and by which share they are above it."""
    ordered = sorted(moves, key=lambda move: move.stroke)
    unit, factor = UNITS[AXES[ordered[0].unit]][0]
    strokes = np.array([factor * move.stroke for move in ordered])
    times = np.array([MILLI * move.duration for move in ordered])
    limits = np.array([np.nan if move.best_possible is None else MILLI * move.best_possible for move in ordered])
    with plot_style():
        figure = empty_figure(7.2, 4.6)
        axes = figure.subplots()
        proven = all(move.status is Status.OPTIMAL for move in ordered)
        label = "least time, proven" if proven else "least time found, not proven"
        axes.plot(strokes, times, color=BLUES[-1], marker="o", markersize=3.0, label=label)
        if not np.isnan(limits).all():
            axes.plot(strokes, limits, color=GREY, linewidth=1.0, label="best possible")
        axes.set(xlabel=f"stroke, {unit}", ylabel="time, ms")
        axes.set_ylim(bottom=0.0, top=_ROOM * float(times.max()))
        axes.legend(loc="upper left")
        return titled(figure, title)


def fronts_figure(fronts: Sequence[TimeFront], title: str) -> Figure:
    """A figure of least objectives over the time of a move, with a panel for each objective."""
    with plot_style():
        figure = empty_figure(7.2, 0.9 + 2.3 * len(fronts))
        together = len({front.durations[-1] for front in fronts}) == 1
        panels = figure.subplots(len(fronts), 1, sharex=together, squeeze=False)[:, 0]
        for axes, front in zip(panels, fronts, strict=True):
            draw_time_front(front, axes)
            axes.legend(loc="upper right")
            if together and axes is not panels[-1]:
                axes.set_xlabel("")
        return titled(figure, title)


_COUNT = 400
_BESIDE = 0.5  # of a turn of the cycle, and of the cam's own angle at rest, drawn beside
_STILL = 0.2


def draw_transition(
    cam: TransitionCam,
    axes: Any = None,
    *,
    cycle: Cycle | None = None,
    **style: Any,
) -> list[Artist]:
    """Draw position, velocity, acceleration and jerk over the master's angle into four axes; return the artists."""
    panels = four(one_below_the_other(axes, 4, 8.2))
    first, last = cam.master
    breaks = cam.duration * np.array(cam.piece.law.breaks)
    times = np.unique(np.concatenate([np.linspace(0.0, cam.duration, _COUNT), breaks]))
    angles = first + (last - first) * times / cam.duration
    still = [first - _STILL * (last - first), first] if cam.kind == "run-in" else [last, last + _STILL * (last - first)]
    artists: list[Artist] = []
    for nu, panel in enumerate(panels):
        unit, size = picture_unit(cam.axis, nu)
        if cycle is not None:
            artists += panel.plot(*_of_cycle(cam, cycle, nu, size), color=BLUES[3], label="cycle")
        panel.plot(still, [size * cam.rest * (nu == 0)] * 2, color=GREY)
        artists += panel.plot(angles, size * cam.piece.values(times, nu), **{"color": WARM, "label": cam.kind} | style)
        panel.axvline(first, color=GREY, linewidth=0.7, linestyle=":")
        panel.axvline(last, color=GREY, linewidth=0.7, linestyle=":")
        panel.set_ylabel(f"{QUANTITIES[nu]}, {unit}")
    panels[-1].set_xlabel("master of the cycle, deg")
    panels[0].legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False, fontsize=8.0)
    return artists


def _of_cycle(cam: TransitionCam, cycle: Cycle, nu: int, size: float) -> tuple[Any, Any]:
    """The cycle where the cam has joined it, or has not left it yet: angles and values."""
    at = 360.0 * cam.at / cam.period
    ends = (at, at + 360.0 * _BESIDE) if cam.kind == "run-in" else (at - 360.0 * _BESIDE, at)
    angles = np.linspace(*ends, _COUNT)
    # at the joint the value of its own side
    angles[0], angles[-1] = ends[0] + 360.0 * INSIDE_PIECE, ends[1] - 360.0 * INSIDE_PIECE
    return angles, size * np.asarray(cycle.at_angle(angles, nu))


_INSIDE_RUN = 25
_ROUNDED, _SHOWN = 1e-9, 1e-6  # of a peak: what is no difference, and the scale on which it is none
_DESIGNED = {"color": GREY, "linewidth": 4.0, "alpha": 0.5, "label": "as designed"}  # wide, to be seen below the run


def draw_export(export: Export, axes: Any = None, **style: Any) -> list[Artist]:
    """Draw the exported motion over the master into four axes, and beside it in four what the run differs by.

    Eight new axes unless there are given ones, four for the motions alone; return the artists.
    """
    if axes is None:
        with plot_style():
            figure = new_figure(11.0, 8.2)
            axes = figure.subplots(4, 2, sharex=True)
            titled(figure, f"{export.format.name}: as designed, as run, and the difference")
            figure.align_ylabels()
    both = np.asarray(axes, dtype=object)
    beside = list(both[:, 1]) if both.shape == (4, 2) else []
    panels = list(both[:, 0]) if beside else four(axes)
    motion, run, units = export.motion, export.run, export.motion.units
    rate, by = (1.0, units.master) if units.rate is None else (units.rate, "s")
    joints = np.unique(np.clip([*run.breaks, *motion.breaks], motion.start, motion.stop))
    # a piece with its ends as seen from inside, so that a jump is upright
    shares = np.linspace(INSIDE_PIECE, 1.0 - INSIDE_PIECE, _INSIDE_RUN)
    places = (joints[:-1, None] + np.diff(joints)[:, None] * shares).ravel()
    looks: Any = (_DESIGNED, {"color": BLUES[3], "label": "as executed"} | style)
    artists: list[Artist] = []
    for nu, panel in enumerate(panels):
        curves = [rate**nu * np.asarray(each(places, nu)) for each in (motion, run)]
        for values, look in zip(curves, looks, strict=True):
            artists += panel.plot(places, values, **look)
        unit = units.slave + (f"/{by}{('', '²', '³')[nu - 1]}" if nu else "")
        panel.set_ylabel(f"{QUANTITIES[nu]}, {unit}")
        if beside:
            artists += _difference(beside[nu], places, curves, unit)
    for column in (panels, beside):
        for panel in column:
            panel.ticklabel_format(axis="y", style="sci", scilimits=(-3, 5), useMathText=True)
        if column:
            column[-1].set_xlabel(f"master, {units.master}")
    panels[0].legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False, fontsize=8.0)
    return artists


def _difference(axes: Axes, places: Array, curves: Sequence[Array], unit: str) -> list[Artist]:
    """What a run differs by from the motion as designed, with the greatest difference and its share of the peak."""
    motion, run = curves
    off, peak = run - motion, float(np.abs(motion).max())
    most = float(np.abs(off).max())
    share = f", {100.0 * most / peak:.2g} % of the peak" if peak else ""
    axes.set_title(f"run less design: at most {most:.3g} {unit}{share}", fontsize=8.5)
    if most <= _ROUNDED * peak:
        axes.set_ylim(-_SHOWN * peak, _SHOWN * peak)
    return list(axes.plot(places, off, color=WARM))
