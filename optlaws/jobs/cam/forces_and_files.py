"""What the job "cam" says beside the geometry: forces, a spring, peaks as made, and the files that cut the cam."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec

from optlaws.cams.as_manufactured import AsMade, UnreachedProfileError, as_made, with_profile_error
from optlaws.cams.curves.extremes import UNDERCUT
from optlaws.cams.cutting.cam_files import format_of
from optlaws.cams.cutting.file_options import Cutting
from optlaws.cams.disc import DiscCam
from optlaws.cams.forces import CamForces
from optlaws.cams.springs import Spring, least_spring
from optlaws.cams.summary import named_forces
from optlaws.cycles.cycle import Cycle
from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import Text
from optlaws.jobs.cam.animation import animated
from optlaws.kept import kept_property
from optlaws.motion.quantities import TURN
from optlaws.plots.cam import cam_figure, forces_figure
from optlaws.results.page import Page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Several = Annotated[tuple[int, ...], msgspec.Meta(max_length=10)]

_MICRO = 1e6
_FORCE = {"length": "N", "angle": "N m"}
_STIFFNESS = {"length": "N/m", "angle": "N m/rad"}


class ForcesEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Forces of the cam under the drive of its motion."""

    friction: dict[str, float | str] = {}
    width: str | None = None
    materials: tuple[str, str] = ("steel", "steel")


class SpringEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A spring that keeps the follower on the cam over a range of speeds."""

    speeds: tuple[str, str]
    force: str | None = None
    stiffness: str | None = None
    preload: str | None = None


class AsManufacturedEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The files that are run against the follower: tables of so many points and decimals, and errors of the profile."""

    points: Several = (361, 721)
    decimals: Several = (3, 4, 6)
    curve: str = "profile"
    error: str | None = None
    waves: Several = (3, 12)


class FileEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A file that cuts the cam; what is not given is as in `DiscCam.export`."""

    name: Text
    format: str | None = None
    curve: str | None = None
    cutter_radius: str | None = None
    tolerance: str | None = None
    decimals: int | None = None
    points: int | None = None
    degree: int | None = None
    feed: str | None = None

    def options(self) -> dict[str, Any]:
        """Entries of the export."""
        given = msgspec.structs.asdict(self)
        return {key: value for key, value in given.items() if key not in {"name", "format"} and value is not None}

    def cut(self, cam: DiscCam, folder: Path, about: str, *, prefix: str = "") -> Path:
        """The file of a cam, written into a folder."""
        form: Any = self.format
        return cam.export(folder / f"{prefix}{self.name}", form, about=about, **self.options())


class ForcesAndFiles(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Entries of the problem file beside the geometry's."""

    forces: ForcesEntries | None = None
    spring: SpringEntries | None = None
    as_made: AsManufacturedEntries | None = None
    file: Annotated[list[FileEntries], msgspec.Meta(max_length=50)] = []
    animation: bool = False


def check(spec: ForcesAndFiles, cam: DiscCam, cycle: Cycle) -> None:
    """Refuse what would be refused only after the work was done.

    Raises
    ------
    InputError
        If an entry of a file is wrong, or forces have no drive.
    """
    for entry in spec.file:
        if Path(entry.name).name != entry.name:
            raise InputError(f"file: name must be that of a file in the folder of results, got {entry.name!r}")
        writing.check_name(Path(entry.name))
        format_of(Path(entry.name), entry.format)
        entries = entry.options()
        cam.outline(entries.pop("curve", None), entries.pop("cutter_radius", None))
        Cutting(**entries)
    forces_of(spec, cam, cycle)


def forces_of(spec: ForcesAndFiles, cam: DiscCam, cycle: Cycle) -> CamForces | None:
    """The cam's forces at the speed of its cycle, if they were asked for."""
    options = spec.forces
    if options is None:
        return None
    # laws that were found for a cam are no cycle, but go as fast
    beside: dict[str, Any] = (
        {} if cam.motion is cycle else {"speed": f"{TURN / cycle.duration!r} rad/s", "drive": cycle.drive}
    )
    return CamForces(cam, friction=options.friction, width=options.width, materials=options.materials, **beside)


@dataclass(frozen=True)
class Findings:
    """The results beside the geometry, each computed once."""

    spec: ForcesAndFiles
    cam: DiscCam
    cycle: Cycle

    @kept_property
    def forces(self) -> CamForces | None:
        """The forces of the cam, if asked for."""
        return forces_of(self.spec, self.cam, self.cycle)

    @kept_property
    def spring(self) -> Spring | None:
        """The least spring; mass, gravity and friction are those of the motion's drive."""
        if self.spec.spring is None:
            return None
        given = self.cycle.drive or {}
        load = {key: value for key, value in given.items() if key not in {"stiffness", "preload"}}
        return least_spring(self.cam, drive=load, **msgspec.structs.asdict(self.spec.spring))

    @kept_property
    def as_made(self) -> dict[str, AsMade | None]:
        """Peaks of the cam as made; None where its follower does not reach all of it."""
        options, cam = self.spec.as_made, self.cam
        if options is None:
            return {}
        peaks_by_name: dict[str, AsMade | None] = {}
        for points in options.points:
            for decimals in options.decimals:
                table: dict[str, Any] = {"curve": options.curve, "points": points, "decimals": decimals}
                name = f"{points} points of the {options.curve}, {decimals} decimals of a mm"
                peaks_by_name[name] = _tried(partial(as_made, cam, "csv", **table))
        error = options.error or ""
        for waves in options.waves if error else ():
            peaks_by_name[f"error of {error}, {waves} waves a turn"] = _tried(
                partial(with_profile_error, cam, error, waves)
            )
        return peaks_by_name

    def to_data(self) -> dict[str, Any]:
        """The results as data for programs, in SI units."""
        data: dict[str, Any] = {}
        if self.forces is not None:
            data["forces"] = self.forces.results()
        if self.spring is not None:
            data["spring"] = self.spring.to_dict()
        if self.as_made:
            data["as_made"] = {name: None if peaks is None else peaks.to_dict() for name, peaks in self.as_made.items()}
        return data


def _tried(run: Callable[[], AsMade]) -> AsMade | None:
    try:
        return run()
    except UnreachedProfileError:
        return None


def add(page: Page, findings: Findings) -> Page:
    """The page with what was asked beside the geometry."""
    forces, spring, cam = findings.forces, findings.spring, findings.cam
    if forces is not None:
        page.heading("Forces").figure("forces", "Forces over the turn")
        page.table(("what", "least", "at, deg", "greatest", "at, deg", "unit"), _force_rows(forces), digits=6)
        page.text(
            f"Torque at the shaft: root mean square {forces.rms_torque[1]:.6g} N m, mean "
            f"{_rounded(0.5 * sum(forces.mean_torque), forces.torque.peak):.6g} N m. "
            + ("The follower lifts off." if forces.lifts_off else "The follower stays on the cam.")
        )
        if cam.extremes.undercut.status == UNDERCUT:
            page.text("That is so if the follower moves as asked, which it cannot on a cam that is undercut.")
    if spring is not None:
        page.heading("Spring").table(("what", "value", "unit"), _spring_rows(spring, cam), digits=6)
    if findings.as_made:
        unit = "um" if cam.displacement.axis == "length" else "urad"
        headings = ("what", f"deviation, {unit}", "peak acceleration, ratio", "peak jerk, ratio")
        page.heading("As made").table(headings, [_made_row(*item) for item in findings.as_made.items()], digits=5)
        if None in findings.as_made.values():
            page.text("Where nothing stands the follower does not reach all of the cam: it has hollows.")
    if findings.spec.animation:
        page.heading("Turning").figure("animation", "The cam turns under its follower")
    if findings.spec.file:
        page.heading("Files").text("\n".join(f"- [{entry.name}]({entry.name})" for entry in findings.spec.file))
    return page


def figures(findings: Findings, title: str) -> dict[str, Figure]:
    """Pictures by their names."""
    drawn = {"cam": cam_figure(findings.cam, title)}
    return drawn if findings.forces is None else drawn | {"forces": forces_figure(findings.forces, title)}


def files(findings: Findings, out: Path, about: str) -> list[Path]:
    """Write the files that cut the cam, and the one that shows it turn."""
    cut = [entry.cut(findings.cam, out, about) for entry in findings.spec.file]
    return [*cut, *([writing.write(out / "animation.svg", animated(findings.cam))] if findings.spec.animation else [])]


def _force_rows(forces: CamForces) -> list[list[tables.Cell]]:
    rows: list[list[tables.Cell]] = []
    for name, curve, unit, factor in named_forces(forces):
        low, high = (_rounded(value * factor, curve.peak * factor) for value in (curve.least, curve.most))
        first, last = (_rounded(degrees(at), 360.0) for at in (curve.least_at, curve.most_at))
        rows.append([name, low, first, high, last, unit])
    return rows


def _spring_rows(spring: Spring, cam: DiscCam) -> list[list[tables.Cell]]:
    force, stiffness = _FORCE[cam.displacement.axis], _STIFFNESS[cam.displacement.axis]
    bound = stiffness if spring.objective == "stiffness" else force
    sought = {"greatest": "greatest force on the follower"}.get(spring.objective, spring.objective)
    return [
        ["stiffness", spring.stiffness, stiffness],
        ["preload", _rounded(spring.preload, spring.greatest), force],
        ["greatest force on the follower, any speed", spring.greatest, force],
        [f"lower bound of the {sought}", _rounded(spring.lower_bound, spring.greatest), bound],
        ["least force left along the follower's way", _rounded(spring.margin, spring.greatest), force],
        ["it is left at", _rounded(spring.critical[0], 360.0), "deg"],
    ]


def _made_row(name: str, peaks: AsMade | None) -> list[tables.Cell]:
    if peaks is None:
        return [name, None, None, None]
    return [name, _MICRO * peaks.deviation, peaks.acceleration_ratio, peaks.jerk_ratio]


def _rounded(value: float, size: float) -> float:
    """The value, or 0 where it is next to nothing beside a size."""
    return 0.0 if abs(value) <= 1e-7 * abs(size) else value
