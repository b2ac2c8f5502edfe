"""The command `optlaws follower`: the motion of an elastic follower's mass on a cam."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import optlaws
from optlaws.cli.law_options import FollowerFrequency, read_law
from optlaws.cli.options import AsJson, Plot, given, options, save_figure, save_picture, takes
from optlaws.cli.show import print_json, show, table
from optlaws.cycles.specification.load import ElasticFollower
from optlaws.errors import InputError
from optlaws.motion.quantities import quantity, read_stroke
from optlaws.shown.summary import Row, Summary

_POINTS = 2001
_UNITS = "A follower with units"


@takes(
    times=options(optlaws.Follower.from_vibration, "duration", "speed", "rise", group=_UNITS),
    machine={
        **options(optlaws.Response.in_units, "stroke", group=_UNITS),
        **options(ElasticFollower, "damping"),
    },
)
def follower(
    law: str,
    /,
    *,
    alpha: float | None = None,
    frequency: FollowerFrequency | None = None,
    natural_frequency: str | None = None,
    natural_period: str | None = None,
    times: Mapping[str, str | None],
    machine: Mapping[str, Any],
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
    frequency
        Frequency nu of the follower: radians of its undamped free vibration in the rise.
    natural_frequency
        In place of --frequency: frequency of the undamped free vibration with its unit, such as "16.7 Hz".
    natural_period
        In place of --natural-frequency: period of the undamped free vibration with its unit, such as "60 ms".
    design_frequency
        Cut the cam so that the mass moves by the law at this frequency; without it the law itself is cut.
    design_damping
        Damping ratio for which the cam is cut; that of the follower unless given.
    spectrum
        Range of frequencies: --plot draws the response spectrum over it.
    plot
        Draw the motion of the mass, or with --spectrum the response spectrum, into this file, PNG or SVG.
    """
    if plot is None and spectrum is not None:
        raise InputError("--spectrum LOW HIGH gives the range of frequencies for --plot FILE: name the file too")
    stroke, damping, times = machine["stroke"], machine["damping"], given(times)
    if stroke is not None and not times:
        raise InputError(
            "--stroke needs the time of the rise: give --natural-frequency with --speed and --rise, or --duration"
        )
    vibration = {"--natural-frequency": natural_frequency, "--natural-period": natural_period}
    mass = _follower(frequency, given(vibration), times, damping)
    if stroke is not None:
        read_stroke(stroke)
    reference = cam = read_law(law, alpha, by="--alpha")
    if design_frequency is None and design_damping is not None:
        raise InputError("--design-damping needs --design-frequency")
    if design_frequency is not None:
        cam = optlaws.polydyne(reference, design_frequency, damping if design_damping is None else design_damping)
    response = mass.response(cam)
    if plot is not None and spectrum is not None:
        _draw(cam, reference, damping, spectrum, plot)
    else:
        save_picture(plot, response)
    results = _results(mass, cam, reference, response)
    if stroke is not None:
        units = response.in_units(stroke, **times)
        results["machine"] = units | {"dynamic factor": results["dynamic_factor"]}
    if as_json:
        print_json(results)
    else:
        _show(results)


def _follower(
    frequency: float | None, vibration: Mapping[str, str], times: Mapping[str, str], damping: float
) -> optlaws.Follower:
    if frequency is not None:
        if vibration or times:
            raise InputError(
                "--natural-frequency, --natural-period, --speed, --rise and --duration are of a machine: give no "
                "--frequency beside"
            )
        return optlaws.Follower(frequency, damping)
    if not vibration and not times:
        raise InputError(
            "give either --frequency or, with units, --natural-frequency or --natural-period with --duration or with "
            "--speed and --rise"
        )
    if len(vibration) != 1:
        raise InputError(
            "give --natural-frequency, such as '16.7 Hz', or --natural-period, such as '60 ms', and not both"
        )
    ((name, text),) = vibration.items()
    quantity(text, "frequency" if name == "--natural-frequency" else "time", name)
    return optlaws.Follower.from_vibration(text, **times, damping=damping)


def _results(
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


def _show(results: Mapping[str, Any]) -> None:
    peaks = {"acceleration in the rise": "peak_acceleration", "acceleration in the dwell": "dwell_acceleration"}
    machine = results.get("machine", {})
    facts = [
        Row("frequency", results["frequency"]),
        Row("damping ratio", results["damping"]),
        Row("dynamic factor", results["dynamic_factor"]),
        *(Row(name, results[key]["value"], place=results[key]["k"]) for name, key in peaks.items()),
        *(Row(f"residual {name}", results[f"residual_{name}"]) for name in ("acceleration", "displacement")),
        *(Row(name, value) for name, value in machine.items() if name != "dynamic factor"),
        *(
            Row(f"{name} of the cam", "inf" if (value := peak["value"]) is None else value, place=peak["k"])
            for name, peak in results["cam"]["constants"].items()
        ),
    ]
    names = ("frequency", "dynamic_factor", "residual_acceleration")
    rows = (
        [f"{each['percent']:+g} %" if each["percent"] else "0 %", *map(each.get, names)]
        for each in results["off_design"]
    )
    headings = (name.replace("_", " ") for name in names)
    show(Summary(facts, at="k"), table("frequency off by", *headings, rows=rows, digits=6))


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
