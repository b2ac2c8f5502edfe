"""The command `optlaws follower`: the motion of an elastic follower's mass on a cam."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cyclopts import Parameter

import optlaws
from optlaws.cli.options import (
    AsJson,
    Duration,
    FollowerFrequency,
    Plot,
    Signed,
    check_files,
    read_law,
    save_figure,
    save_picture,
)
from optlaws.cli.show import print_json, show, table
from optlaws.errors import InputError
from optlaws.motion.quantities import quantity, read_stroke

_POINTS = 2001


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class FollowerOptions:
    """The follower, by its dimensionless frequency or by data of its machine.

    Parameters
    ----------
    frequency
        Frequency nu of the follower: radians of its undamped free vibration in the rise.
    natural_frequency
        In place of --frequency: frequency of the undamped free vibration with its unit, such as "16.7 Hz".
    natural_period
        In place of --natural-frequency: period of the undamped free vibration with its unit, such as "60 ms".
    speed
        With --natural-frequency or --natural-period: speed of the cam with its unit, such as "105 rpm".
    rise
        With --speed: angle of the cam during the rise with its unit, such as "120 deg".
    duration
        In place of --speed and --rise: duration of the rise with its unit, such as "0.1 s".
    stroke
        Stroke of the cam with its unit, such as "35 mm" or "20 deg": peaks and vibration in these units are shown too.
    damping
        Damping ratio of the follower.
    """

    frequency: FollowerFrequency | None = None
    natural_frequency: str | None = None
    natural_period: str | None = None
    speed: str | None = None
    rise: str | None = None
    duration: Duration = None
    stroke: Signed = None
    damping: float = 0.0

    @property
    def times(self) -> dict[str, str | None]:
        """What says how long the rise takes."""
        return {"duration": self.duration, "speed": self.speed, "rise": self.rise}


_NO_FOLLOWER = FollowerOptions()


def follower(
    law: str,
    /,
    *,
    alpha: float | None = None,
    options: FollowerOptions = _NO_FOLLOWER,
    design_frequency: float | None = None,
    design_damping: float | None = None,
    spectrum: tuple[float, float] | None = None,
    plot: Plot = None,
    as_json: AsJson = False,
) -> None:
    """Response of an elastic follower's mass: peaks, dynamic factor, residual vibration, and the same off design.

    Parameters
    ----------
    law
        Law meant for the mass: a name of the catalogue, a member such as III(7.2), a JSON file of a law or of
        `optlaws solve --output`, or a CSV file with a table of points.
    alpha
        Member of the family, where the law is I, II, III or IV.
    design_frequency
        Cut the cam so that the mass moves by the law at this frequency; without it the law itself is cut.
    design_damping
        Damping ratio for which the cam is cut; that of the follower unless given.
    spectrum
        Range of frequencies: --plot draws the response spectrum over it.
    plot
        Draw the motion of the mass, or with --spectrum the response spectrum, into this file, PNG or SVG.
    as_json
        Print one JSON object on stdout and nothing else.
    """
    check_files(plot=plot)
    if plot is None and spectrum is not None:
        raise InputError("--spectrum LOW HIGH gives the range of frequencies for --plot FILE: name the file too")
    mass = _follower(options)
    reference = read_law(law, alpha, by="--alpha")
    if design_frequency is None and design_damping is not None:
        raise InputError("--design-damping needs --design-frequency")
    cam = reference
    if design_frequency is not None:
        cam = optlaws.polydyne(reference, design_frequency, mass.damping if design_damping is None else design_damping)
    response = mass.response(cam)
    if plot is not None and spectrum is None:
        save_picture(plot, response)
    elif plot is not None and spectrum is not None:
        _draw(cam, reference, mass.damping, spectrum, plot)
    summary = _summary(mass, cam, reference, response)
    if options.stroke is not None:
        units = response.in_units(options.stroke, **options.times)
        summary["machine"] = units | {"dynamic factor": summary["dynamic_factor"]}
    if as_json:
        print_json(summary)
    else:
        _show(summary)


def _follower(options: FollowerOptions) -> optlaws.Follower:
    frequency, natural, period = options.frequency, options.natural_frequency, options.natural_period
    united = any(quantity is not None for quantity in (natural, period, *options.times.values()))
    if frequency is not None and not united:
        if options.stroke is not None:
            raise InputError(
                "--stroke needs the time of the rise: give --natural-frequency with --speed and --rise, or --duration"
            )
        return optlaws.Follower(frequency, options.damping)
    if frequency is not None:
        raise InputError(
            "--natural-frequency, --natural-period, --speed, --rise and --duration are of a machine: give no "
            "--frequency beside"
        )
    if not united:
        raise InputError(
            "give either --frequency or, with units, --natural-frequency or --natural-period with --duration or with "
            "--speed and --rise"
        )
    if (natural is None) == (period is None):
        raise InputError(
            "give --natural-frequency, such as '16.7 Hz', or --natural-period, such as '60 ms', and not both"
        )
    if options.stroke is not None:
        read_stroke(options.stroke)
    name, dimension = ("--natural-frequency", "frequency") if natural else ("--natural-period", "time")
    quantity(natural or period, dimension, name)
    return optlaws.Follower.from_vibration(natural or period or "", **options.times, damping=options.damping)


def _summary(
    mass: optlaws.Follower, cam: optlaws.MotionLaw, reference: optlaws.MotionLaw, response: optlaws.Response
) -> dict[str, Any]:
    return {
        "frequency": mass.frequency,
        "damping": mass.damping,
        "dynamic_factor": response.dynamic_factor(reference),
        "peak_acceleration": response.peak(2).to_dict(),
        "dwell_acceleration": response.dwell_peak(2).to_dict(),
        "residual_displacement": response.residual_displacement,
        "residual_acceleration": response.residual_acceleration,
        "off_design": [
            {
                "percent": deviation.percent,
                "frequency": deviation.response.frequency,
                "dynamic_factor": deviation.dynamic_factor,
                "residual_acceleration": deviation.response.residual_acceleration,
            }
            for deviation in optlaws.off_design(cam, reference, mass)
        ],
        "cam": {"constants": cam.constants.to_dict(rms=False), "law": cam.to_dict()},
    }


def _show(summary: dict[str, Any]) -> None:
    facts = table()
    facts.add_row("follower", f"frequency {summary['frequency']:.8g}, damping ratio {summary['damping']:g}")
    facts.add_row("dynamic factor", f"{summary['dynamic_factor']:.8g}")
    for key, text in (("peak_acceleration", "in the rise"), ("dwell_acceleration", "in the dwell")):
        peak = summary[key]
        facts.add_row(f"acceleration {text}", f"{peak['value']:.8g} at k = {peak['k']:.6g}")
    facts.add_row("residual acceleration", f"{summary['residual_acceleration']:.8g}")
    facts.add_row("residual displacement", f"{summary['residual_displacement']:.8g}")
    cam = summary["cam"]["constants"]
    facts.add_row("cam", ", ".join(f"{name} {_number(cam[name]['value'])}" for name in "BCDJ"))
    off = table("frequency off by", "frequency", "dynamic factor", "residual acceleration")
    for deviation in summary["off_design"]:
        cells = (f"{deviation[key]:.6g}" for key in ("frequency", "dynamic_factor", "residual_acceleration"))
        off.add_row(f"{deviation['percent']:+g} %" if deviation["percent"] else "0 %", *cells)
    for name, value in summary.get("machine", {}).items():
        if name != "dynamic factor":
            facts.add_row(name, f"{value:.6g}")
    show(facts, off)


def _number(value: float | None) -> str:
    return "inf" if value is None else f"{value:.7g}"


def _draw(
    cam: optlaws.MotionLaw, reference: optlaws.MotionLaw, damping: float, span: tuple[float, float], file: Path
) -> None:
    import numpy as np

    from optlaws.plots.machine import draw_spectrum
    from optlaws.plots.style import BLUES, WARM, empty_figure, plot_style

    if not 0.0 < span[0] < span[1]:
        raise InputError(
            f"--spectrum takes a range of frequencies, two rising numbers above 0, got {span[0]:g} {span[1]:g}"
        )
    spectrum = optlaws.response_spectrum(cam, np.linspace(*span, _POINTS), damping)
    C = reference.constants.C.value
    with plot_style():
        figure = empty_figure()
        axes = figure.subplots()
        draw_spectrum(spectrum, axes, what="peak", over=C, color=BLUES[3], label="in the rise")
        draw_spectrum(spectrum, axes, over=C, color=WARM, linestyle="--", label="free vibration after it")
        axes.set(xlim=span, ylim=(0.0, None), ylabel="acceleration of the mass / C")
        axes.legend()
        save_figure(file, figure)
