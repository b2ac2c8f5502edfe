"""Pictures of what drives a cycle: torque, power and motor speed over the time, and torque over speed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.position_drive import PositionDrive
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.numbers import Array
from optlaws.plots.cycle import mark_segments, name_segments, samples
from optlaws.plots.motors import draw_motor_curves
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, new_figure, plot_style, titled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_RPM = 30.0 / np.pi
_EACH = 400
_MILLI = 1e3


def effort_columns(cycle: Cycle) -> list[str]:
    """The names of what `effort_along` gives, with their units."""
    force = "force, N" if cycle.axis == "length" else "torque, N m"
    return [force, "power, W", *(["motor speed, rpm"] if isinstance(cycle.drive, Drive) else [])]


def effort_along(cycle: Cycle, position: Array, velocity: Array, acceleration: Array) -> list[Array]:
    """Torque, power and motor speed of a cycle with a mechanism, along a motion in SI units; the speed in rpm."""
    drive = cycle.drive
    assert isinstance(drive, Mechanism | Drive)  # noqa: S101 - the callers have seen it
    force = PositionDrive(drive).force(position, velocity, acceleration)
    speed = velocity * (drive.ratio if isinstance(drive, Drive) else 1.0)
    values = [force, force * speed]
    return [*values, _RPM * speed] if isinstance(drive, Drive) else values


def effort_figure(cycle: Cycle, title: str) -> Figure:
    """Torque, power and motor speed of a cycle over the time; of a motor torque over speed beside them."""
    names, drive = effort_columns(cycle), cycle.drive
    (times, position), (_, velocity), (_, acceleration) = (samples(cycle, nu, _EACH) for nu in range(3))
    curves = effort_along(cycle, position, velocity, acceleration)
    with plot_style():
        figure = new_figure(10.4 if isinstance(drive, Drive) else 8.6, 1.2 + 1.8 * len(names))
        grid = figure.add_gridspec(len(names), 1 + isinstance(drive, Drive))
        panels = [figure.add_subplot(grid[0, 0])]
        panels += [figure.add_subplot(grid[i, 0], sharex=panels[0]) for i in range(1, len(names))]
        for panel, name, curve, colour in zip(panels, names, curves, (BLUES[3], WARM, GREEN), strict=False):
            panel.plot(_MILLI * times, curve, color=colour)
            panel.axhline(0.0, color=GREY, linewidth=0.8)
            panel.set_ylabel(name)
            panel.tick_params(labelbottom=panel is panels[-1])
            mark_segments(cycle, panel)
        name_segments(cycle, panels[0])
        panels[-1].set(xlabel="time, ms", xlim=(0.0, _MILLI * cycle.duration))
        figure.align_ylabels(panels)
        if isinstance(drive, Drive):
            _draw_over_speed(drive, curves[0], curves[2], figure.add_subplot(grid[:, 1]))
        return titled(figure, title)


def _draw_over_speed(drive: Drive, torque: Array, speed: Array, axes: Axes) -> None:
    """Torque over speed at the motor, both in the direction of the motion, within the motor's curves."""
    draw_motor_curves(drive.motor, axes, float(np.abs(speed).max()) / _RPM)
    axes.plot(np.abs(speed), np.where(speed < 0.0, -torque, torque), color=BLUES[3], label="cycle")
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.set(xlabel="speed of the motor, rpm", ylabel="torque in the direction of the motion, N m")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False, fontsize=8.0)
