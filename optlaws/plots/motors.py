"""Pictures of drives: torque over the speed with the curves of the motor, and torque over the ratio of the gear."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.plots.style import BLUES, GREY, WARM, name_point, new_axes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from optlaws.mechanisms.drives.motor import Motor
    from optlaws.mechanisms.drives.motor_motion import MotorMotion
    from optlaws.mechanisms.drives.sheet import BestRatio

_RPM = 30.0 / np.pi
_SAMPLES = 801


def draw_torque_over_speed(motion: MotorMotion, motor: Motor, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw torque over speed at the motor during a move, within the motor's curves of peak and continuous torque."""
    axes = axes or new_axes()
    k = np.linspace(0.0, 1.0, _SAMPLES)
    artists = draw_motor_curves(motor, axes, float(np.abs(motion.speed(k)).max()))
    artists += axes.plot(_RPM * motion.speed(k), motion.torque(k), **{"color": BLUES[3], "label": "move", **style})
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.set(xlabel="speed of the motor, rpm", ylabel="torque at the motor, N m")
    axes.legend(frameon=False)
    return artists


def draw_motor_curves(motor: Motor, axes: Axes, greatest_speed: float) -> list[Artist]:
    """Draw peak and continuous torque of a motor to both sides, beyond the greatest speed of a motion in rad/s."""
    artists: list[Artist] = []
    fastest = min(motor.greatest_speed, 1.5 * greatest_speed)
    speeds = np.unique([*np.linspace(0.0, fastest, _SAMPLES), *(speed for speed, _ in motor.curve if speed <= fastest)])
    limits = (motor.peak_at(speeds), "peak torque", "-"), (motor.continuous_at(speeds), "continuous torque", "--")
    for values, name, dashes in limits:
        if np.isfinite(values).all():
            for side, label in ((1.0, name), (-1.0, None)):
                line = axes.plot(_RPM * speeds, side * values, color=GREY, linestyle=dashes, linewidth=1.1, label=label)
                artists += line
    return artists


def draw_best_ratio(best: BestRatio, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw root mean square and peak torque over the ratio into axes, new ones unless given; return the artists."""
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
