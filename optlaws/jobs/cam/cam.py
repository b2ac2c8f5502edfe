"""The job "cam": a cam with enclosed pressure angles and curvatures, proof of no undercut, least sizes, its curves."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from optlaws import drawing
from optlaws.cams.disc import DiscCam
from optlaws.cams.extremes.bounding import Extreme
from optlaws.cams.followers.contact import RollerContact
from optlaws.cams.least_sizes import GreatestRoller, LeastBaseCircle, greatest_roller, least_base_circle
from optlaws.errors import InfeasibleProblem
from optlaws.files import tables, writing
from optlaws.jobs.cam.more import Found, add, figures, files
from optlaws.jobs.cam.wishes import Study, read
from optlaws.jobs.pages.page import Page
from optlaws.kept import kept_property

_MILLI = 1e3
_TURN = 360.0
_NOTHING = 1e-100


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec, cam = read(data, file)
    found, sizes = Found(spec, cam), Sizes(spec, cam)
    about = f"{spec.title}; from {file.name}"
    texts = {
        "cam.md": str(page(spec, cam, found, sizes)),
        "cam.json": json.dumps({"about": f"{about}; {writing.MARK}", **answer(spec, cam, found, sizes)}, indent=1)
        + "\n",
        "cam.csv": tables.to_csv(_columns(spec), _rows(spec, cam), about=about),
    }
    return [
        *(writing.write(out / name, text) for name, text in texts.items()),
        *drawing.save_pictures(figures(found, spec.title), out),
        *files(found, out, about),
    ]


def answer(spec: Study, cam: DiscCam, found_beside: Found | None = None, sizes: Sizes | None = None) -> dict[str, Any]:
    """What a program is told of the cam, in metres and radians: enclosures as pairs, with the angle of the cam."""
    found = cam.extremes
    undercut = found.undercut
    told: dict[str, Any] = {
        "unit": "SI",
        "greatest_pressure_angle": _enclosure(found.greatest_pressure_angle),
        "least_pressure_angle": _enclosure(found.pressure_angles[0]),
        "largest_pressure_angle": _enclosure(found.pressure_angles[1]),
        "bulging_radius": _enclosure(found.bulging_radius),
        "hollow_radius": None if found.hollow_radius is None else _enclosure(found.hollow_radius),
        "undercut": {"status": undercut.status, "simple": undercut.simple},
    }
    proven = sizes or Sizes(spec, cam)
    least, roller = proven.least, proven.roller
    if isinstance(least, LeastBaseCircle):
        told["least_base_circle"] = {
            "radius": least.radius, "too_small": least.too_small, "proven": least.proven, "limit": least.limit,
            "angle": least.angle,
        }  # fmt: skip
    elif least is not None:
        told["least_base_circle"] = None
    if roller is not None:
        told["greatest_roller"] = {"radius": roller.radius, "too_large": roller.too_large, "angle": roller.angle}
    return told | (found_beside or Found(spec, cam)).told()


def page(spec: Study, cam: DiscCam, found_beside: Found, sizes: Sizes) -> Page:
    """The page of results."""
    made = Page(spec.title).text(spec.text).figure("cam", spec.title)
    made.text(f"Undercut: {cam.extremes.undercut}.")
    made.table(("what", "at least", "at most", "unit", "at, deg"), _extreme_rows(cam), digits=7)
    rows = _size_rows(sizes)
    if rows:
        made.heading("Sizes").table(("what", "kept with", "broken with", "unit", "at, deg"), rows, digits=7)
    if isinstance(sizes.least, str):
        made.text(f"{sizes.least[0].upper()}{sizes.least[1:]}.")
    return add(made, found_beside)


def _extreme_rows(cam: DiscCam) -> list[list[tables.Cell]]:
    found = cam.extremes
    angles = [
        ("greatest pressure angle", found.greatest_pressure_angle),
        ("pressure angle, least", found.pressure_angles[0]),
        ("pressure angle, greatest", found.pressure_angles[1]),
    ]
    seen = [(name, one) for name, one in angles if found.greatest_pressure_angle.value > _NOTHING]
    rows = [_row(name, one, degrees(1.0), "deg") for name, one in seen]
    rows.append(_row("least radius of curvature, bulging", found.bulging_radius, _MILLI, "mm"))
    if found.hollow_radius is not None:
        rows.append(_row("least radius of curvature, hollow", found.hollow_radius, _MILLI, "mm"))
    return rows


def _row(name: str, one: Extreme, factor: float, unit: str) -> list[tables.Cell]:
    low, high = (_plain(factor * value) for value in (one.low, one.high))
    return [name, low, high if np.isfinite(high) else None, unit, degrees(one.angle)]


def _size_rows(sizes: Sizes) -> list[list[tables.Cell]]:
    least, roller = sizes.least, sizes.roller
    rows: list[list[tables.Cell]] = []
    if isinstance(least, LeastBaseCircle):
        name = f"least base circle, by the {least.limit}"
        rows.append([name, _MILLI * least.radius, _MILLI * least.too_small, "mm", degrees(least.angle)])
    if roller is not None:
        rows.append(["greatest roller", _MILLI * roller.radius, _MILLI * roller.too_large, "mm", degrees(roller.angle)])
    return rows


@dataclass(frozen=True)
class Sizes:
    """Least and greatest sizes of the cam, computed once."""

    spec: Study
    cam: DiscCam

    @kept_property
    def least(self) -> LeastBaseCircle | str | None:
        """The least base circle, why there is none, or None where no limit is given."""
        limits = {"pressure_angle": self.spec.pressure_angle, "radius_of_curvature": self.spec.radius_of_curvature}
        if not any(limits.values()):
            return None
        try:
            return least_base_circle(self.cam.motion, self.cam.follower, turning=self.spec.turning, **limits)
        except InfeasibleProblem as error:
            return str(error)

    @kept_property
    def roller(self) -> GreatestRoller | None:
        """The greatest roller; None under a flat face."""
        if not isinstance(self.cam.contact, RollerContact):
            return None
        return greatest_roller(self.cam, radius_of_curvature=self.spec.radius_of_curvature or "0 mm")


def _enclosure(one: Extreme) -> dict[str, float | None]:
    high = one.high if np.isfinite(one.high) else None
    return {"low": one.low, "high": high, "angle": one.angle}


def _columns(spec: Study) -> list[str]:
    curves = ["pitch", "profile", *(["cutter"] if spec.cutter_radius else [])]
    points = [f"{name} {axis}, mm" for name in curves for axis in "xy"]
    return ["cam, deg", "displacement, m or rad", *points, "pressure angle, deg", "curvature, 1/mm"]


def _rows(spec: Study, cam: DiscCam) -> list[list[tables.Cell]]:
    turns = np.linspace(0.0, _TURN, spec.rows)
    angles = np.radians(turns)
    curves = [cam.pitch_curve, cam.profile, *([cam.cutter_path(spec.cutter_radius)] if spec.cutter_radius else [])]
    columns = [
        turns,
        cam.displacement(angles),
        *(column for curve in curves for column in (_MILLI * curve(angles)).T),
        np.degrees(cam.pressure_angle(angles)),
        cam.profile.curvature(angles) / _MILLI,
    ]
    return [[_plain(value) for value in row] for row in np.array(columns).T.tolist()]


def _plain(value: float) -> float:
    return 0.0 if abs(value) < 1e-12 else value
