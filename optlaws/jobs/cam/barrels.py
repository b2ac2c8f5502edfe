"""The job "cam" for barrel cams: flanks in space, enclosed pressure angles, whether a flank has a cusp."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
import numpy as np

from optlaws.cams.barrel import SIDES, BarrelCam, SpaceCurve
from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.cam.extreme_rows import EXTREMES, enclosure, extreme_row, plain
from optlaws.jobs.cycle_entries import AxisEntries, cycle_of
from optlaws.numbers import Array
from optlaws.plots.style import BLUES, GREY, WARM, new_figure, plot_style, save_pictures, titled
from optlaws.results.page import Page

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_MILLI = 1e3
_TURN = 360.0
_SAMPLES = 721
_SAID = {
    "free": "no flank has a cusp, at any depth",
    "undercut": "a flank has a cusp: make the roller smaller, the cylinder larger or the motion slower",
    "undecided": "whether a flank has a cusp is not decided",
}


class BarrelEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The cylinder, its groove and the roller."""

    outer_radius: str
    depth: str
    roller_radius: str


class BarrelProblemFile(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file of a barrel cam."""

    job: str
    title: Text
    motion: AxisEntries
    barrel: BarrelEntries
    speed: str | None = None
    period: str | None = None
    turning: str = "counterclockwise"
    cutter_radius: str | None = None
    rows: Annotated[int, msgspec.Meta(ge=2, le=100_000)] = 361
    text: str = ""


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec, cam = read(data, file)
    about = f"{spec.title}; from {file.name}"
    texts = {
        "cam.md": str(page(spec, cam)),
        "cam.json": json.dumps({"about": f"{about}; {writing.MARK}", **to_data(cam)}, indent=1) + "\n",
        "cam.csv": tables.to_csv(_columns(spec), _rows(spec, cam), about=about),
    }
    figures = {"cam": draw(cam, spec.title)}
    return [*(writing.write(out / name, text) for name, text in texts.items()), *save_pictures(figures, out)]


def answer(data: Mapping[str, Any], file: Path) -> dict[str, Any]:
    """The data of the cam of a file for programs, in metres and radians."""
    return to_data(read(data, file)[1])


def read(data: Mapping[str, Any], file: Path) -> tuple[BarrelProblemFile, BarrelCam]:
    """The entries of a file, and the cam.

    Raises
    ------
    InputError
        If an entry is unknown or wrong; the error names the file.
    """
    spec = convert(data, BarrelProblemFile, file)
    try:
        cycle = cycle_of(spec.motion, spec.speed, spec.period)
        sizes: dict[str, Any] = {**msgspec.structs.asdict(spec.barrel), "turning": spec.turning}
        cam = BarrelCam(cycle, **sizes)
        if spec.cutter_radius is not None:
            cam.cutter_path(spec.cutter_radius)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None
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


def page(spec: BarrelProblemFile, cam: BarrelCam) -> Page:
    """The page of results."""
    result = Page(spec.title).text(spec.text).figure("cam", spec.title)
    result.text(f"Undercut: {_SAID[cam.undercut]}.")
    rows = [
        extreme_row("pressure angle at the bottom, least", cam.pressure_angles[0], degrees(1.0), "deg"),
        extreme_row("pressure angle at the bottom, greatest", cam.pressure_angles[1], degrees(1.0), "deg"),
        extreme_row("way of a flank a radian, least", cam.margin, _MILLI, "mm"),
    ]
    return result.table(EXTREMES, rows, digits=7)


def draw(cam: BarrelCam, title: str) -> Figure:
    """The groove unrolled at the outer radius, and the pressure angle at the top and at the bottom of the groove."""
    angles = np.linspace(*cam.displacement.interval, _SAMPLES)
    with plot_style():
        figure = new_figure(8.6, 5.6)
        groove, pressure = figure.subplots(2, 1, sharex=True, height_ratios=(1.4, 1.0))
        for side, colour in zip(SIDES, (BLUES[3], WARM), strict=True):
            groove.plot(*_unrolled(cam.flank(side), angles, cam.pitch_curve), color=colour, label=f"{side} flank")
        centre = np.degrees(angles), _MILLI * cam.pitch_curve(angles)[:, 2]
        groove.plot(*centre, color=GREY, linestyle=":", label="axis of the roller")
        for radius, colour in zip(cam.radii, (BLUES[3], WARM), strict=True):
            values = np.degrees(cam.pressure_angle(angles, radius=radius))
            pressure.plot(np.degrees(angles), values, color=colour, label=f"at the radius {_MILLI * radius:g} mm")
        pressure.axhline(0.0, color=GREY, linewidth=0.8)
        groove.set(ylabel="along the shaft, mm")
        pressure.set(xlabel="around the cam, deg", ylabel="pressure angle, deg", xlim=(0.0, _TURN))
        pressure.set_xticks(np.arange(0.0, _TURN + 1.0, 60.0))
        for axes in (groove, pressure):
            axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
        figure.align_ylabels()
        return titled(figure, title)


def _unrolled(curve: SpaceCurve, angles: Array, pitch: SpaceCurve) -> tuple[Array, Array]:
    """A curve's angle around the cam in degrees, near that of the roller, and its place along the shaft in mm."""
    x, y, along = curve(angles).T
    beside = np.angle((y + 1j * x) / (pitch(angles) @ np.array([1j, 1.0, 0.0])))
    return np.degrees(angles + curve.turning * beside), _MILLI * along


def _columns(spec: BarrelProblemFile) -> list[str]:
    return ["cam, deg", *(f"{name} {axis}, mm" for name in _curves_of(spec) for axis in "xyz"), *_PRESSURES]


_PRESSURES = ("pressure angle outside, deg", "pressure angle at the bottom, deg")


def _curves_of(spec: BarrelProblemFile) -> list[str]:
    flanks = [f"{side} flank {where}" for where in ("outside", "at the bottom") for side in SIDES]
    return ["axis of the roller", *flanks, *([f"cutter, {side} flank" for side in SIDES] if spec.cutter_radius else [])]


def _rows(spec: BarrelProblemFile, cam: BarrelCam) -> list[list[tables.Cell]]:
    turns = np.linspace(0.0, _TURN, spec.rows)
    angles = np.radians(turns)
    curves = [cam.pitch_curve, *(cam.flank(side, radius) for radius in cam.radii for side in SIDES)]
    if spec.cutter_radius is not None:
        curves += [cam.cutter_path(spec.cutter_radius, side) for side in SIDES]
    columns = [
        turns,
        *(column for curve in curves for column in (_MILLI * curve(angles)).T),
        *(np.degrees(cam.pressure_angle(angles, radius=radius)) for radius in cam.radii),
    ]
    return [[plain(value) for value in row] for row in np.array(columns).T.tolist()]
