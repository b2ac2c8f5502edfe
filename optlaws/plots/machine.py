"""Plots of what machines and followers answer: outputs over time, peaks and residual vibration over speed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from optlaws.plots.style import DISTINCT, GREY, new_axes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from optlaws.mechanisms.machine.over_time import OutputCurve
    from optlaws.mechanisms.machine.parameters import MachineSpectrum
    from optlaws.mechanisms.spectrum import ResponseSpectrum


def draw_spectrum(
    spectrum: ResponseSpectrum,
    axes: Axes | None = None,
    *,
    what: Literal["residual", "peak"] = "residual",
    over: float = 1.0,
    **style: Any,
) -> list[Artist]:
    """Draw residual or peak acceleration over the frequency into axes, new ones by default; return the artists.

    `over` divides the acceleration, for example by C of the law meant for the mass.
    """
    axes = axes or new_axes()
    values = spectrum.residual_acceleration if what == "residual" else spectrum.peak_acceleration
    axes.set(xlabel="frequency, radians of the free vibration in the rise", ylabel=f"{what} acceleration")
    return list(axes.plot(spectrum.frequency, values / over, **style))


def draw_output(
    curve: OutputCurve,
    axes: Axes | None = None,
    *,
    count: int = 801,
    **style: Any,
) -> list[Artist]:
    """Draw an output of a machine over time into axes, new ones by default."""
    axes = axes or new_axes()
    axes.set(xlabel="time, durations of the rise", ylabel=curve.name)
    return list(axes.plot(*curve.samples(count), **{"color": DISTINCT[0], **style}))


def draw_machine_spectrum(
    spectrum: MachineSpectrum,
    axes: Axes | None = None,
    **style: Any,
) -> list[Artist]:
    """Draw an output's peak and each mode's residual in it into axes, new ones by default."""
    axes = axes or new_axes()
    axes.set(xlabel=spectrum.parameter, ylabel=spectrum.output)
    lines = axes.plot(spectrum.values, spectrum.peaks[spectrum.output], **{"color": GREY, "label": "peak", **style})
    for i, left in enumerate(spectrum.residuals.T):
        named = {"color": DISTINCT[i % len(DISTINCT)], "label": f"mode {i + 1} left", **style}
        lines += axes.plot(spectrum.values, left, **named)
    axes.set_ylim(bottom=0.0)
    axes.legend(frameon=False)
    return list(lines)
