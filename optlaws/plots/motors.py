"""Pictures of drives: torque over the speed with the curves of the motor, and torque over the ratio of the gear."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.plots.cycle import samples, samples_of_drive
from optlaws.plots.style import BLUES, GREY, WARM, name_point, new_axes, new_figure, plot_style, titled
from optlaws.tolerances import VALUE_ROUNDING

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from optlaws.cycles.cycle import Cycle
    from optlaws.mechanisms.drives.drive_train import Drive
    from optlaws.mechanisms.drives.effort import PieceEffort
    from optlaws.mechanisms.drives.motor import Motor
    from optlaws.mechanisms.drives.sheet import BestRatio
    from optlaws.numbers import Array

_RPM = 30.0 / np.pi
_SAMPLES = 801


def draw_move(along: PieceEffort, motor: Motor, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw torque over speed at the motor during a move, within the motor's curves of peak and continuous torque."""
    times = np.linspace(along.piece.start, along.piece.stop, _SAMPLES)
    way = np.sign(along.piece.stroke)
    course = way * along.speed(times), way * along.force(times)
    return draw_torque_over_speed(course, motor, axes, **{"label": "move", **style})


def draw_motor_of_cycle(cycle: Cycle, drive: Drive, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw torque over speed at the motor during a cycle, within the motor's curves."""
    _, speeds = samples(cycle, 1, _SAMPLES)
    _, torques = samples_of_drive(cycle, cycle.force, _SAMPLES)
    return draw_torque_over_speed((drive.ratio * speeds, torques), drive.motor, axes, **{"label": "cycle", **style})


def motor_figure(cycle: Cycle, drive: Drive, title: str) -> Figure:
    """Torque over speed at the motor during a cycle, under a title."""
    with plot_style():
        figure = new_figure(7.2, 4.6)
        draw_motor_of_cycle(cycle, drive, figure.add_subplot())
        return titled(figure, title)


def draw_torque_over_speed(
    course: tuple[Array, Array], motor: Motor, axes: Axes | None = None, **style: Any
) -> list[Artist]:
    """Draw torques over speeds within the motor's curves of peak and continuous torque, on either side of rest."""
    axes = axes or new_axes()
    artists: list[Artist] = []
    goes_back = course[0].min() < -VALUE_ROUNDING * np.abs(course[0]).max()
    fastest = min(motor.greatest_speed, 1.5 * float(np.abs(course[0]).max()))
    speeds = np.unique([*np.linspace(0.0, fastest, _SAMPLES), *(speed for speed, _ in motor.curve if speed <= fastest)])
    limits = (motor.peak_at(speeds), "peak torque", "-"), (motor.continuous_at(speeds), "continuous torque", "--")
    for values, name, dashes in limits:
        if np.isfinite(values).all():
            look: dict[str, Any] = {"color": GREY, "linestyle": dashes, "linewidth": 1.1}
            for side, label in ((1.0, name), (-1.0, None)):
                for way in (1.0, -1.0) if goes_back else (1.0,):
                    shown = label if way > 0.0 else None
                    artists += axes.plot(way * _RPM * speeds, side * values, **look, label=shown)
    artists += axes.plot(_RPM * course[0], course[1], **{"color": BLUES[3], **style})
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.set(xlabel="speed of the motor, rpm", ylabel="torque at the motor, N m")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False)
    return artists


def draw_best_ratio(best: BestRatio, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw root mean square and peak torque over the ratio into axes, new ones by default; return the artists."""
    axes = axes or new_axes()
    artists: list[Artist] = []
    for values, name, colour in ((best.rms_torques, "RMS torque", BLUES[3]), (best.peak_torques, "peak torque", GREY)):
        artists += axes.plot(best.ratios, values, **{"color": colour, "label": name, **style})
    artists += axes.plot([best.ratio], [best.rms_torque], "o", color=WARM)
    artists.append(name_point(axes, f"{best.ratio:.4g}", (best.ratio, best.rms_torque)))
    axes.set(xscale="log", xlabel="ratio", ylabel="torque at the motor, N m")
    axes.set_ylim(bottom=0.0)
    axes.legend(frameon=False)
    return artists
