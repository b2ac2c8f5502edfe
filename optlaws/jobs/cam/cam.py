"""The job "cam": a cam with enclosed pressure angles and curvatures, proof of no undercut, least sizes, its curves."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cams.best_laws import BestBaseCircle, BestCam
from optlaws.cams.curves.plane_curve import PlaneCurve
from optlaws.cams.followers.follower import positive
from optlaws.cams.least_sizes import GreatestRoller, LeastBaseCircle, greatest_roller, least_base_circle
from optlaws.cycles.summary import objective_unit
from optlaws.errors import InfeasibleProblem
from optlaws.files import tables, writing
from optlaws.jobs.cam import barrels
from optlaws.jobs.cam.extreme_rows import EXTREMES, Limits, enclosure, extreme_rows, plain
from optlaws.jobs.cam.forces_and_files import FileEntries, Findings, add, figures, files
from optlaws.jobs.cam.schema import CamProblemFile, Cams, read
from optlaws.kept import kept_property
from optlaws.motion.quantities import quantity
from optlaws.plots.cam import pair_figure
from optlaws.plots.cycle import UNITS
from optlaws.plots.style import save_pictures
from optlaws.results.page import Page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MILLI = 1e3
_DIGITS = 6
_MET = 1e-7  # of a base circle, where bound and size are said to meet
_HEADINGS = ("what", "value", "no laws are below", "unit", "status")


def best_data(cams: Cams) -> dict[str, Any]:
    """The data of the best laws for programs, in SI units; nothing where the laws are those of the cycle."""
    best = cams.best
    if best is None:
        return {}
    if isinstance(best, BestCam):
        entries = {"minimise": cams.cycle.minimise, "objective": best.objective, "status": best.status.value}
        return {"best": entries | {"lower_bound": best.lower_bound}}
    radius = {"minimise": "base circle", "objective": best.least.radius, "status": _status_of_size(cams)}
    return {"best": radius | {"lower_bound": best.lower_bound}}


def limits_of(cams: Cams, spec: CamProblemFile) -> Limits:
    """The limits that the laws were made for; none where they are those of the cycle."""
    if cams.best is None:
        return Limits()
    pressure, radius = spec.pressure_angle, spec.radius_of_curvature
    return Limits(
        None if pressure is None else quantity(pressure, "angle", "pressure_angle"),
        None if radius is None else quantity(radius, "length", "radius_of_curvature"),
    )


def add_best(page: Page, cams: Cams, spec: CamProblemFile) -> None:
    """Put what was found on the page."""
    best = cams.best
    if best is None:
        return
    page.heading("Laws for the cam")
    if isinstance(best, BestCam):
        page.table(_HEADINGS, _law_rows(cams, best), digits=_DIGITS)
        return
    least = best.least
    rows: list[list[tables.Cell]] = [
        [
            "least base circle of all laws",
            _MILLI * least.radius,
            _MILLI * best.lower_bound,
            "mm",
            _status_of_size(cams),
        ]
    ]
    of_cycle = _own(cams, spec)
    if of_cycle is not None:
        rows.append([f"of the laws of least {cams.cycle.minimise}", _MILLI * of_cycle.radius, None, "mm", None])
    page.table(_HEADINGS, rows, digits=_DIGITS)


def _law_rows(cams: Cams, best: BestCam) -> list[list[tables.Cell]]:
    name, unit = cams.cycle.minimise, objective_unit(cams.cycle)
    return [
        [f"least {name} under the limits of the cam", best.objective, best.lower_bound, unit, best.status.value],
        [f"least {name} without them", cams.cycle.objective, cams.cycle.lower_bound, unit, cams.cycle.status.value],
    ]


def _status_of_size(cams: Cams) -> str:
    best = cams.best
    assert best is not None  # noqa: S101 - it was asked for
    if isinstance(best, BestCam):
        return best.status.value
    met = best.least.radius - best.lower_bound <= _MET * best.least.radius
    return "optimal" if met else "local"


def _own(cams: Cams, spec: CamProblemFile) -> LeastBaseCircle | None:
    """The least base circle of the cycle's own laws."""
    try:
        return least_base_circle(cams.cycle, cams.first.follower, **spec.limits)
    except InfeasibleProblem:
        return None


_PREFIX = "return-"


def pair_data(cams: Cams) -> dict[str, Any]:
    """The data of the second cam for programs, in metres and radians; nothing where there is none."""
    if cams.second is None:
        return {}
    extremes = cams.second.extremes
    return {
        "return_cam": {
            "base_radius": positive(cams.second.base_radius, "base_radius"),
            "greatest_pressure_angle": enclosure(extremes.greatest_pressure_angle),
            "bulging_radius": enclosure(extremes.least_convex_radius),
            "undercut": {"status": extremes.undercut.status, "simple": extremes.undercut.simple},
        }
    }


def add_pair(page: Page, cams: Cams, entries: Sequence[FileEntries]) -> Page:
    """The page with the second cam."""
    if cams.second is None:
        return page
    page.heading("Return cam").figure("pair", "Both cams on one shaft, with their followers at the start")
    page.text(f"Undercut: {cams.second.extremes.undercut}.")
    page.table(EXTREMES, extreme_rows(cams.second, Limits()), digits=7)
    return page.text("\n".join(f"- [{name_of(entry)}]({name_of(entry)})" for entry in entries))


def pair_figures(cams: Cams, title: str) -> dict[str, Figure]:
    """The picture of both."""
    return {} if cams.second is None else {"pair": pair_figure(cams.first, cams.second, title)}


def pair_files(cams: Cams, entries: Sequence[FileEntries], out: Path, about: str) -> list[Path]:
    """Write the files that cut the second cam: as those of the first."""
    second = cams.second
    if second is None:
        return []
    return [entry.cut(second, out, about, prefix=_PREFIX) for entry in entries]


def name_of(entries: FileEntries) -> str:
    """The name of the second cam's file beside that of the first.

    Examples
    --------
    >>> name_of(FileEntries(name="cam.dxf"))
    'return-cam.dxf'
    """
    return f"{_PREFIX}{entries.name}"


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
    drawn = figures(findings, spec.title) | pair_figures(cams, spec.title)
    return [
        *(writing.write(out / name, text) for name, text in texts.items()),
        *save_pictures(drawn, out),
        *files(findings, out, about),
        *pair_files(cams, spec.file, out, about),
    ]


def answer(data: Mapping[str, Any], file: Path) -> dict[str, Any]:
    """The data of the cam for programs, in metres and radians: enclosures as pairs, with the angle of the cam."""
    if "barrel" in data:
        return barrels.answer(data, file)
    spec, cams = read(data, file)
    return _to_data(cams, Findings(spec, cams.first, cams.cycle), Sizes(spec, cams))


def _to_data(cams: Cams, findings: Findings, sizes: Sizes) -> dict[str, Any]:
    extremes = cams.first.extremes
    undercut, limits = extremes.undercut, sizes.limits
    data: dict[str, Any] = {
        "unit": "SI",
        **best_data(cams),
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
    return data | pair_data(cams) | findings.to_data()


def page(spec: CamProblemFile, cams: Cams, findings: Findings, sizes: Sizes) -> Page:
    """The page of results."""
    result = Page(spec.title).text(spec.text).figure("cam", spec.title)
    add_best(result, cams, spec)
    result.text(f"Undercut: {cams.first.extremes.undercut}.")
    result.table(EXTREMES, extreme_rows(cams.first, sizes.limits), digits=7)
    rows = _size_rows(sizes)
    if rows:
        result.heading("Sizes").table(("what", "kept with", "broken with", "unit", "at, deg"), rows, digits=7)
    if isinstance(sizes.least, str):
        result.text(f"{sizes.least[0].upper()}{sizes.least[1:]}.")
    return add(add_pair(result, cams, spec.file), findings)


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
        return limits_of(self.cams, self.spec)

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
