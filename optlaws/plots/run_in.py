"""Pictures of run-ins and run-outs: a cam from rest into a cycle, or out of it, beside the cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.motion.quantities import QUANTITIES
from optlaws.plots.cycle import UNITS
from optlaws.plots.law import four
from optlaws.plots.style import BLUES, GREY, WARM, new_figure, plot_style, titled

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

    from optlaws.cycles.cycle import Cycle
    from optlaws.cycles.moves.transition_cam import TransitionCam

_COUNT = 400
_BESIDE = 0.5  # of a turn of the cycle, and of the cam's own angle at rest, drawn beside
_STILL = 0.2


def transition_figure(cam: TransitionCam, cycle: Cycle, title: str) -> Figure:
    """A run-in or run-out beside its cycle, as a figure."""
    artists = draw_transition(cam, cycle=cycle)
    figure: Figure = artists[0].axes.figure  # type: ignore[union-attr, assignment] # of our own
    with plot_style():
        figure.align_ylabels()
        return titled(figure, title)


def draw_transition(
    cam: TransitionCam,
    axes: Any = None,  # noqa: ANN401 - matplotlib's
    *,
    cycle: Cycle | None = None,
    **style: Any,
) -> list[Artist]:
    """Draw position, velocity, acceleration and jerk over the master's angle into four axes; return the artists."""
    if axes is None:
        with plot_style():
            axes = list(new_figure(8.6, 8.2).subplots(4, 1, sharex=True))
    panels = four(list(np.ravel(np.asarray(axes, dtype=object))))
    first, last = cam.master
    breaks = cam.duration * np.array(cam.piece.law.breaks)
    times = np.unique(np.concatenate([np.linspace(0.0, cam.duration, _COUNT), breaks]))
    angles = first + (last - first) * times / cam.duration
    still = [first - _STILL * (last - first), first] if cam.kind == "run-in" else [last, last + _STILL * (last - first)]
    artists: list[Artist] = []
    for nu, panel in enumerate(panels):
        unit, size = UNITS[cam.axis][nu]
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
    angles[0], angles[-1] = ends[0] + 1e-9 * 360.0, ends[1] - 1e-9 * 360.0
    return angles, size * np.asarray(cycle.at_angle(angles, nu))
