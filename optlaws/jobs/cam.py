"""The job "cam": a cam with enclosed pressure angles and curvatures, proof of no undercut, least sizes, its curves."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from optlaws.cams.barrel import BarrelCam
from optlaws.cams.report import DIGITS, barrel_coordinates, barrel_differences, barrel_section
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.errors import InfeasibleProblem, located
from optlaws.jobs.cam_entries import BarrelProblemFile, CamProblemFile
from optlaws.jobs.cam_result import BOUNDING, CamResult, laws_section, proven_entries
from optlaws.motion.quantities import MILLI, TURN
from optlaws.plots.cam import animated, barrel_figure
from optlaws.results import Results
from optlaws.sentences import Amount, sentence
from optlaws.shown.report import ReportTable, Section
from optlaws.synthesis.solution import Solution

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def run(results: Results) -> None:
    """Put the cam's page, data, table, pictures and files into results."""
    result = read(results.entries, results.file)
    title = results.title = result.spec.title
    page = (
        results.page("cam")
        .text(result.warning)
        .text(result.spec.text)
        .picture("cam", title, partial(result.drawn, title))
    )
    for section in result.sections:
        page.section(section)
    results.data("cam.json", result.data)
    results.table("cam", *result.table)
    if isinstance(result, CamResult):
        if result.spec.animation:
            results.text("animation.svg", animated(result.cam))
        for name, (each, cam) in result.files.items():
            write = replace(each, about=results.about).write
            results.add(name, partial(write, cam.outline(each.curve, each.cutter_radius)))


def _entries(data: Mapping[str, Any], file: Path) -> CamProblemFile | BarrelProblemFile:
    return (BarrelProblemFile if "barrel" in data else CamProblemFile).read(data, file)


def motion_of(data: Mapping[str, Any], file: Path) -> dict[str, Cycle]:
    """The motion of a file's follower by its name; an error names the file."""
    spec = _entries(data, file)
    with located(str(file)):
        return {spec.motion.name: spec.cycle}


def read(data: Mapping[str, Any], file: Path) -> CamResult | BarrelResult:
    """The result of a file's entries; an error names the file."""
    spec = _entries(data, file)
    with located(str(file)):
        if isinstance(spec, CamProblemFile):
            for each in spec.file:
                each.check_writer()
            return CamResult.of_file(spec).with_proof
        return BarrelResult.of_file(spec)


def stored(data: Mapping[str, Any]) -> CamResult | BarrelResult:
    """The result that `cam.json` holds, computed again from its entries and the solutions of its laws.

    No laws are sought. Of limits that are not linear in the laws, earlier files have the lower bound alone.
    """
    entries = data["cam"]
    spec = (BarrelProblemFile if "barrel" in entries else CamProblemFile).from_dict(entries)
    solutions, bounding = (
        [Solution.from_dict(each) for each in data.get(name, ())] for name in ("solutions", BOUNDING)
    )
    plan = spec.cycle.with_solutions(solutions)
    if isinstance(spec, BarrelProblemFile):
        return BarrelResult.of_file(spec, plan)
    bound = (data.get("best") or {}).get("lower_bound")
    return CamResult(spec, plan, bound, bounding=tuple(bounding), searched=True)


class BarrelResult(NamedTuple):
    """The barrel cam of a problem file, with what `CamResult` has."""

    spec: BarrelProblemFile
    plan: Plan
    sections: tuple[Section, ...]
    data: dict[str, Any]
    table: ReportTable
    drawn: Callable[[str], Figure]
    warning: str = ""  #: a groove leads its roller both ways

    @classmethod
    def of_file(cls, spec: BarrelProblemFile, known: Plan | None = None) -> BarrelResult:
        """The cam of a problem file, or of laws of its motion that are known."""
        plan = known or _within(spec)
        cam = BarrelCam(plan, **spec.barrel.to_dict(), turning=spec.turning)
        sections, table = (
            (barrel_section(cam, spec.limits), laws_section(plan, allowed=_allowed(spec)), barrel_differences(cam)),
            barrel_coordinates(cam, spec.rows, TURN / plan.duration, spec.cutter_radius),
        )
        data = proven_entries(spec, plan) | {name: value for each in sections for name, value in each.data.items()}
        return cls(spec, plan, sections, data, table, partial(barrel_figure, cam))


def _within(spec: BarrelProblemFile) -> Plan:
    """The laws of a barrel cam within its pressure angle; an error without any says what would help."""
    try:
        return spec.cycle.solve()
    except InfeasibleProblem as error:
        if spec.pressure_angle is None:
            raise
        remedy = "make the cylinder larger, the groove shallower or the motion slower, or allow more"
        raise InfeasibleProblem(sentence("{} ({}: {})", error.args[0], _allowed(spec), remedy)) from error


def _allowed(spec: BarrelProblemFile) -> str:
    """The velocity that the pressure angle of a barrel cam allows; blank without a limit of it."""
    if spec.pressure_angle is None:
        return ""
    allowed = Amount(MILLI * spec.allowed_velocity, "mm/s", DIGITS)
    return sentence("the pressure_angle of {} at the bottom of the groove allows {}", spec.pressure_angle, allowed)
