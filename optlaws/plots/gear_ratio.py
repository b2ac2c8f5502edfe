"""Pictures of drives: torque over the ratio of the gear."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from optlaws.plots.style import BLUES, GREY, WARM, name_point, new_axes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from optlaws.mechanisms.drives.sheet import BestRatio


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
    axes.legend()
    return artists
