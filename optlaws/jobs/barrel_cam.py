"""The job "cam" for barrel cams: flanks in space, enclosed pressure angles, whether a flank has a cusp."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cams.barrel import SIDES, BarrelCam, SpaceCurve
from optlaws.cams.report import EXTREMES, enclosure, extreme_row, plain
from optlaws.errors import located
from optlaws.files import tables
from optlaws.jobs.cam_entries import BarrelProblemFile
from optlaws.motion.display_units import MILLI, TURN_DEG
from optlaws.numbers import Array
from optlaws.plots.style import BLUES, GREY, WARM, new_figure, plot_style, titled
from optlaws.results import Results

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_SAMPLES = 721
_TITLES = {
    "free": "no flank has a cusp, at any depth",
    "undercut": "a flank has a cusp: make the roller smaller, the cylinder larger or the motion slower",
    "undecided": "whether a flank has a cusp is not decided",
}


def run(results: Results) -> None:
    """Put the cam's page, data, table and picture into results."""
    spec, cam = read(results.entries, results.file)
    results.title = spec.title
    page = results.page("cam").text(spec.text).figure("cam", spec.title)
    page.text(f"Undercut: {_TITLES[cam.undercut]}.")
    rows = [
        extreme_row("pressure angle at the bottom, least", cam.pressure_angles[0], degrees(1.0), "deg"),
        extreme_row("pressure angle at the bottom, greatest", cam.pressure_angles[1], degrees(1.0), "deg"),
        extreme_row("way of a flank a radian, least", cam.margin, MILLI, "mm"),
    ]
    page.table(EXTREMES, rows, digits=7)
    results.data("cam.json", to_data(cam))
    results.table("cam", _columns(spec), _rows(spec, cam))
    results.picture("cam", draw(cam, spec.title))


def answer(data: Mapping[str, Any], file: Path) -> dict[str, Any]:
    """The data of the cam of a file for programs, in metres and radians."""
    return to_data(read(data, file)[1])


def read(data: Mapping[str, Any], file: Path) -> tuple[BarrelProblemFile, BarrelCam]:
    """The entries of a file, and the cam; an error names the file."""
    spec = BarrelProblemFile.read(data, file)
    with located(str(file)):
        cam = BarrelCam(spec.cycle, **spec.barrel.to_dict(), turning=spec.turning)
        if spec.cutter_radius is not None:
            cam.cutter_path(spec.cutter_radius)
    return spec, cam


def to_data(cam: BarrelCam) -> dict[str, Any]:
    """The data of a barrel cam for programs, in metres and radians."""
    return {
        "unit": "SI",
        "least_pressure_angle": enclosure(cam.pressure_angles[0]),
        "largest_pressure_angle": enclosure(cam.pressure_angles[1]),
        "margin": enclosure(cam.margin),
        "undercut": {"status": cam.undercut},
    }


def draw(cam: BarrelCam, title: str) -> Figure:
    """The groove unrolled at the outer radius, and the pressure angle at the top and at the bottom of the groove."""
    angles = np.linspace(*cam.displacement.interval, _SAMPLES)
    with plot_style():
        figure = new_figure(8.6, 5.6)
        groove, pressure = figure.subplots(2, 1, sharex=True, height_ratios=(1.4, 1.0))
        for side, colour in zip(SIDES, (BLUES[3], WARM), strict=True):
            groove.plot(*_unrolled(cam.flank(side), angles, cam.pitch_curve), color=colour, label=f"{side} flank")
        centre = np.degrees(angles), MILLI * cam.pitch_curve(angles)[:, 2]
        groove.plot(*centre, color=GREY, linestyle=":", label="axis of the roller")
        for radius, colour in zip(cam.radii, (BLUES[3], WARM), strict=True):
            values = np.degrees(cam.pressure_angle(angles, radius=radius))
            pressure.plot(np.degrees(angles), values, color=colour, label=f"at the radius {MILLI * radius:g} mm")
        pressure.axhline(0.0, color=GREY, linewidth=0.8)
        groove.set(ylabel="along the shaft, mm")
        pressure.set(xlabel="around the cam, deg", ylabel="pressure angle, deg", xlim=(0.0, TURN_DEG))
        pressure.set_xticks(np.arange(0.0, TURN_DEG + 1.0, 60.0))
        for axes in (groove, pressure):
            axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
        figure.align_ylabels()
        return titled(figure, title)


def _unrolled(curve: SpaceCurve, angles: Array, pitch: SpaceCurve) -> tuple[Array, Array]:
    """A curve's angle around the cam in degrees, near the roller's angle, and its place along the shaft in mm."""
    x, y, along = curve(angles).T
    beside = np.angle((y + 1j * x) / (pitch(angles) @ np.array([1j, 1.0, 0.0])))
    return np.degrees(angles + curve.turning * beside), MILLI * along


def _columns(spec: BarrelProblemFile) -> list[str]:
    flanks = [f"{side} flank {where}" for where in ("outside", "at the bottom") for side in SIDES]
    cutters = [f"cutter, {side} flank" for side in SIDES] if spec.cutter_radius else []
    points = [f"{name} {axis}, mm" for name in ("axis of the roller", *flanks, *cutters) for axis in "xyz"]
    return ["cam, deg", *points, "pressure angle outside, deg", "pressure angle at the bottom, deg"]


def _rows(spec: BarrelProblemFile, cam: BarrelCam) -> list[list[tables.Cell]]:
    turns = np.linspace(0.0, TURN_DEG, spec.rows)
    angles = np.radians(turns)
    curves = [cam.pitch_curve, *(cam.flank(side, radius) for radius in cam.radii for side in SIDES)]
    if spec.cutter_radius is not None:
        curves += [cam.cutter_path(spec.cutter_radius, side) for side in SIDES]
    columns = [
        turns,
        *(column for curve in curves for column in (MILLI * curve(angles)).T),
        *(np.degrees(cam.pressure_angle(angles, radius=radius)) for radius in cam.radii),
    ]
    return [[plain(value) for value in row] for row in np.array(columns).T.tolist()]
