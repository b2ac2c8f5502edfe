"""The job "cam": a cam with enclosed pressure angles and curvatures, proof of no undercut, least sizes, its curves."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from optlaws.cams.best_laws import BestBaseCircle
from optlaws.cams.curves.plane_curve import PlaneCurve
from optlaws.cams.least_sizes import GreatestRoller, LeastBaseCircle, greatest_roller, least_base_circle
from optlaws.errors import InfeasibleProblem
from optlaws.files import tables, writing
from optlaws.jobs.cam import barrels, best, pair
from optlaws.jobs.cam.extreme_rows import EXTREMES, Limits, enclosure, extreme_rows, plain
from optlaws.jobs.cam.forces_and_files import Findings, add, figures, files
from optlaws.jobs.cam.schema import CamProblemFile, Cams, read
from optlaws.kept import kept_property
from optlaws.plots.cycle import UNITS
from optlaws.plots.style import save_pictures
from optlaws.results.page import Page

_MILLI = 1e3
_TURN = 360.0


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    if "barrel" in data:
        return barrels.run(data, file, out)
    spec, cams = read(data, file)
    cam, about = cams.first, f"{spec.title}; from {file.name}"
    findings, sizes = Findings(spec, cam, cams.cycle), Sizes(spec, cams)
    stored = {"about": f"{about}; {writing.MARK}", **_to_data(cams, findings, sizes)}
    texts = {
        "cam.md": str(page(spec, cams, findings, sizes)),
        "cam.json": json.dumps(stored, indent=1) + "\n",
        "cam.csv": tables.to_csv(_columns(spec, cams), _rows(spec, cams), about=about),
    }
    drawn = figures(findings, spec.title) | pair.figures(cams, spec.title)
    return [
        *(writing.write(out / name, text) for name, text in texts.items()),
        *save_pictures(drawn, out),
        *files(findings, out, about),
        *pair.files(cams, spec.file, out, about),
    ]


def answer(data: Mapping[str, Any], file: Path) -> dict[str, Any]:
    """The data of the cam for programs, in metres and radians: enclosures as pairs, with the angle of the cam.

    Raises
    ------
    InputError
        If an entry of the file is unknown or wrong.
    """
    if "barrel" in data:
        return barrels.answer(data, file)
    spec, cams = read(data, file)
    return _to_data(cams, Findings(spec, cams.first, cams.cycle), Sizes(spec, cams))


def _to_data(cams: Cams, findings: Findings, sizes: Sizes) -> dict[str, Any]:
    extremes = cams.first.extremes
    undercut, limits = extremes.undercut, sizes.limits
    data: dict[str, Any] = {
        "unit": "SI",
        **best.to_data(cams),
        "greatest_pressure_angle": enclosure(extremes.greatest_pressure_angle, limits.pressure),
        "least_pressure_angle": enclosure(extremes.pressure_angles[0], limits.pressure),
        "largest_pressure_angle": enclosure(extremes.pressure_angles[1], limits.pressure),
        "bulging_radius": enclosure(extremes.least_convex_radius, limits.radius),
        "hollow_radius": None if extremes.least_concave_radius is None else enclosure(extremes.least_concave_radius),
        "undercut": {"status": undercut.status, "simple": undercut.simple},
    }
    least, roller = sizes.least, sizes.roller
    if isinstance(least, LeastBaseCircle):
        data["least_base_circle"] = {
            "radius": least.radius, "too_small": least.too_small, "proven": least.proven, "limit": least.limit,
            "angle": sizes.angle(least.angle),
        }  # fmt: skip
    elif least is not None:
        data["least_base_circle"] = None
    if roller is not None:
        data["greatest_roller"] = {
            "radius": roller.radius,
            "too_large": roller.too_large,
            "angle": sizes.angle(roller.angle),
        }
    return data | pair.to_data(cams) | findings.to_data()


def page(spec: CamProblemFile, cams: Cams, findings: Findings, sizes: Sizes) -> Page:
    """The page of results."""
    result = Page(spec.title).text(spec.text).figure("cam", spec.title)
    best.add(result, cams, spec)
    result.text(f"Undercut: {cams.first.extremes.undercut}.")
    result.table(EXTREMES, extreme_rows(cams.first, sizes.limits), digits=7)
    rows = _size_rows(sizes)
    if rows:
        result.heading("Sizes").table(("what", "kept with", "broken with", "unit", "at, deg"), rows, digits=7)
    if isinstance(sizes.least, str):
        result.text(f"{sizes.least[0].upper()}{sizes.least[1:]}.")
    return add(pair.add(result, cams, spec.file), findings)


def _size_rows(sizes: Sizes) -> list[list[tables.Cell]]:
    least, roller = sizes.least, sizes.roller
    rows: list[list[tables.Cell]] = []
    if isinstance(least, LeastBaseCircle):
        name = f"least base circle, by the {least.limit}"
        rows.append([name, _MILLI * least.radius, _MILLI * least.too_small, "mm", sizes.angle(degrees(least.angle))])
    if roller is not None:
        at = sizes.angle(degrees(roller.angle))
        rows.append(["greatest roller", _MILLI * roller.radius, _MILLI * roller.too_large, "mm", at])
    return rows


@dataclass(frozen=True)
class Sizes:
    """Least and greatest sizes of the cam, computed once."""

    spec: CamProblemFile
    cams: Cams

    @property
    def limits(self) -> Limits:
        """The limits that the laws were made for."""
        return best.limits_of(self.cams, self.spec)

    def angle(self, angle: float) -> float | None:
        """An angle where a size is told by a limit: laws that were made for it touch it at several."""
        return angle if self.cams.best is None else None

    @kept_property
    def least(self) -> LeastBaseCircle | str | None:
        """The least base circle, why there is none, or None where no limit is given."""
        if not (self.spec.pressure_angle or self.spec.radius_of_curvature):
            return None
        if isinstance(self.cams.best, BestBaseCircle):
            return self.cams.best.least
        cam = self.cams.first
        try:
            return least_base_circle(cam.motion, cam.follower, **self.spec.limits)
        except InfeasibleProblem as error:
            return str(error)

    @kept_property
    def roller(self) -> GreatestRoller | None:
        """The greatest roller; None under a flat face."""
        if not self.cams.first.contact.roller:
            return None
        return greatest_roller(self.cams.first, radius_of_curvature=self.spec.radius_of_curvature or "0 mm")


def _columns(spec: CamProblemFile, cams: Cams) -> list[str]:
    curves = ["pitch", "profile", *(["cutter"] if spec.cutter_radius else [])]
    if cams.second is not None:
        curves += [f"return {name}" for name in curves]
    points = [f"{name} {axis}, mm" for name in curves for axis in "xy"]
    displacement = f"displacement, {UNITS[cams.first.displacement.axis][0][0]}"
    return ["cam, deg", displacement, *points, "pressure angle, deg", "curvature, 1/mm"]


def _rows(spec: CamProblemFile, cams: Cams) -> list[list[tables.Cell]]:
    cam, turns = cams.first, np.linspace(0.0, _TURN, spec.rows)
    angles = np.radians(turns)
    curves: list[PlaneCurve] = []
    for disc in (cam, cams.second):
        if disc is not None:
            curves += [disc.pitch_curve, disc.profile]
            curves += [disc.cutter_path(spec.cutter_radius)] if spec.cutter_radius else []
    columns = [
        turns,
        UNITS[cam.displacement.axis][0][1] * cam.displacement(angles),
        *(column for curve in curves for column in (_MILLI * curve(angles)).T),
        np.degrees(cam.pressure_angle(angles)),
        cam.profile.curvature(angles) / _MILLI,
    ]
    return [[plain(value) for value in row] for row in np.array(columns).T.tolist()]
