"""The job "cam": a cam with enclosed pressure angles and curvatures, proof of no undercut, least sizes, its curves."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from optlaws.cams.as_manufactured import AsMade
from optlaws.cams.best_laws import BestCam, BestPrimeCircle
from optlaws.cams.best_offset import BestOffset
from optlaws.cams.curves.extremes import UNDERCUT
from optlaws.cams.curves.plane_curve import PlaneCurve
from optlaws.cams.disc import DiscCam
from optlaws.cams.forces import CamForces
from optlaws.cams.least_sizes import LeastPrimeCircle
from optlaws.cams.report import CamReport, plain
from optlaws.cams.sizing.springs import CONTACT, GREATEST
from optlaws.cams.summary import named_forces
from optlaws.cycles.summary import objective_unit
from optlaws.files import tables
from optlaws.jobs.cam_entries import CamProblemFile
from optlaws.jobs.cam_findings import FORCE, STIFFNESS, Findings
from optlaws.motion.display_units import MICRO, MILLI, TURN_DEG, UNITS
from optlaws.numbers import chop
from optlaws.plots.cam import animated, cam_figure, forces_figure, pair_figure
from optlaws.results import Page, Results
from optlaws.tolerances import FORCE_ROUNDING

_SIZE_MET = 1e-7  # of a radius: a size that is proven to so much is the least one

_HEADINGS = ("what", "value", "no laws are below", "unit", "status")
_OF_OFFSET = ("what", "value", "no offset is below", "unit", "status")
#: before the names of the files of the return cam
_RETURN = "return-"


def run(results: Results) -> None:
    """Put the cam's page, data, table, pictures and files into results."""
    if "barrel" in results.entries:
        from optlaws.jobs import barrel_cam

        barrel_cam.run(results)
        return
    findings = Findings.read(results.entries, results.file)
    spec, first, second = findings.spec, findings.cam, findings.second
    results.title = spec.title
    results.text("cam.md", str(page(findings)))
    results.data("cam.json", _to_data(findings))
    results.table("cam", _columns(findings), _rows(findings))
    results.picture("cam", cam_figure(first, spec.title))
    if findings.forces is not None:
        results.picture("forces", forces_figure(findings.forces, spec.title))
    for entry in spec.file:
        results.add(entry.name, partial(entry.write, first, about=results.about))
    if spec.animation:
        results.text("animation.svg", animated(first))
    if second is None:
        return
    results.picture("pair", pair_figure(first, second, spec.title))
    for entry in spec.file:
        results.add(f"{_RETURN}{entry.name}", partial(entry.write, second, about=results.about))


def answer(data: Mapping[str, Any], file: Path) -> dict[str, Any]:
    """The data of the cam for programs, in metres and radians: enclosures as pairs, with the angle of the cam."""
    if "barrel" in data:
        from optlaws.jobs import barrel_cam

        return barrel_cam.answer(data, file)
    return _to_data(Findings.read(data, file))


def _to_data(findings: Findings) -> dict[str, Any]:
    known = CamReport(findings.cam, reached=findings.limits).data
    first = {name: known[name] for name in ("prime_radius", "base_radius")}
    data: dict[str, Any] = {"unit": "SI", **first, **_best_data(findings), **known}
    least, roller = findings.least, findings.roller
    if isinstance(least, LeastPrimeCircle):
        data["least_prime_circle"] = {
            "radius": least.radius, "base_radius": least.cam.base_radius, "too_small": least.too_small,
            "proven": least.proven, "limit": least.limit, "angle": findings.angle(least.angle),
        }  # fmt: skip
    elif least is not None:
        data["least_prime_circle"] = None
    if roller is not None:
        angle = findings.angle(roller.angle)
        data["greatest_roller"] = {"radius": roller.radius, "too_large": roller.too_large, "angle": angle}
    return data | _pair_data(findings.second) | findings.to_data()


def _best_data(findings: Findings) -> dict[str, Any]:
    """The quality of the laws for the cam; nothing where the laws are the cycle's own."""
    best = findings.best
    if best is None:
        return {}
    name, objective = (
        ("prime circle", best.least.radius)
        if isinstance(best, BestPrimeCircle)
        else (findings.cycle.minimise, best.objective)
    )
    bound = {"status": _status(findings), "lower_bound": best.lower_bound}
    return {"best": {"minimise": name, "objective": objective, **bound}}


def _status(findings: Findings) -> str:
    """Whether the best laws, or the least prime circle, are proven optimal."""
    best = findings.best
    assert best is not None  # noqa: S101 - the callers have seen it
    if isinstance(best, BestCam):
        return best.status.value
    return "optimal" if best.least.radius - best.lower_bound <= _SIZE_MET * best.least.radius else "local"


def _pair_data(cam: DiscCam | None) -> dict[str, Any]:
    """The data of the return cam; nothing without a return cam."""
    if cam is None:
        return {}
    data = CamReport(cam).data
    names = ("prime_radius", "base_radius", "greatest_pressure_angle", "bulging_radius", "undercut")
    return {"return_cam": {name: data[name] for name in names}}


def page(findings: Findings) -> Page:
    """The page of the cam's results."""
    spec, least = findings.spec, findings.least
    result = Page(spec.title).text(spec.text).figure("cam", spec.title)
    if findings.best is not None:
        result.heading("Laws for the cam").table(_HEADINGS, _best_rows(findings), digits=6)
    result.text(f"{_circles(findings.cam)}\n\nUndercut: {findings.cam.extremes.undercut}.")
    result.table(*CamReport(findings.cam, reached=findings.limits).tables[0])
    result.text("\n".join(f"Beyond what is allowed: {size}." for size in findings.cam.extremes.beyond))
    if findings.offset is not None:
        result.heading("Offset").table(_OF_OFFSET, _offset_rows(findings.offset), digits=6)
    if rows := _size_rows(findings):
        result.heading("Sizes").table(("what", "kept with", "broken with", "unit", "at, deg"), rows, digits=7)
    if isinstance(least, str):
        result.text(_sentence(least))
    if findings.second is not None:
        result.heading("Return cam").figure("pair", "Both cams on one shaft, with their followers at the start")
        result.text(f"{_circles(findings.second)}\n\nUndercut: {findings.second.extremes.undercut}.")
        result.table(*CamReport(findings.second).tables[0])
        result.text(_links(spec, _RETURN))
    _add_forces(result, findings)
    if findings.spring is not None:
        result.heading("Spring")
        result.table(("what", "value", "unit"), _spring_rows(findings), digits=6)
        result.text(_sentence(findings.spring.remark))
    if findings.as_made:
        unit = "um" if findings.cam.displacement.axis == "length" else "urad"
        headings = ("what", f"deviation, {unit}", "peak acceleration, ratio", "peak jerk, ratio")
        result.heading("As made").table(
            headings, [_manufactured_row(*item) for item in findings.as_made.items()], digits=5
        )
        if None in findings.as_made.values():
            result.text("Where nothing stands the follower does not reach all of the cam: it has hollows.")
    if spec.animation:
        result.heading("Turning").figure("animation", "The cam turns under its follower")
    return result.heading("Files").text(_links(spec)) if spec.file else result


def _circles(cam: DiscCam) -> str:
    """The radii of the prime circle and of the base circle as a sentence."""
    base, roller = MILLI * cam.base_radius, MILLI * cam.contact.roller
    return f"The radius of the prime circle is {base + roller:.7g} mm, that of the base circle {base:.7g} mm."


def _links(spec: CamProblemFile, prefix: str = "") -> str:
    return "\n".join(f"- [{prefix}{entry.name}]({prefix}{entry.name})" for entry in spec.file)


def _best_rows(findings: Findings) -> list[list[tables.Cell]]:
    best, cycle = findings.best, findings.cycle
    name, unit = cycle.minimise, objective_unit(cycle)
    if isinstance(best, BestCam):
        return [
            [f"least {name} under the limits of the cam", best.objective, best.lower_bound, unit, best.status.value],
            [f"least {name} without them", cycle.objective, cycle.lower_bound, unit, cycle.status.value],
        ]
    assert best is not None  # noqa: S101 - the caller has seen it
    sizes: list[tables.Cell] = [MILLI * best.least.radius, MILLI * best.lower_bound, "mm", _status(findings)]
    rows: list[list[tables.Cell]] = [["least prime circle of all laws", *sizes]]
    of_cycle = findings.least_of_cycle
    if of_cycle is not None:
        rows.append([f"of the laws of least {name}", MILLI * of_cycle.radius, None, "mm", None])
    return rows


def _size_rows(findings: Findings) -> list[list[tables.Cell]]:
    least, roller = findings.least, findings.roller
    rows: list[list[tables.Cell]] = []
    if isinstance(least, LeastPrimeCircle):
        name, at = f"least prime circle, by the {least.limit}", findings.angle(degrees(least.angle))
        rows.append([name, MILLI * least.radius, MILLI * least.too_small, "mm", at])
    if roller is not None:
        at = findings.angle(degrees(roller.angle))
        rows.append(["greatest roller", MILLI * roller.radius, MILLI * roller.too_large, "mm", at])
    return rows


def _add_forces(result: Page, findings: Findings) -> None:
    forces = findings.forces
    if forces is None:
        return
    result.heading("Forces").figure("forces", "Forces over the turn")
    result.table(("what", "least", "at, deg", "greatest", "at, deg", "unit"), _force_rows(forces), digits=6)
    result.text(
        f"Torque at the shaft: root mean square {forces.rms_torque[1]:.6g} N m, mean "
        f"{chop(0.5 * sum(forces.mean_torque), forces.torque.peak, FORCE_ROUNDING):.6g} N m. "
        + ("The follower lifts off." if forces.lifts_off else "The follower stays on the cam.")
    )
    if rows := _energy_rows(findings):
        result.heading("Energy").table(("what", "value", "unit"), rows, digits=6)
    if findings.cam.extremes.undercut.status == UNDERCUT:
        result.text("That is so if the follower moves as asked, which it cannot on a cam that is undercut.")


def _energy_rows(findings: Findings) -> list[list[tables.Cell]]:
    """Mean power and the flywheel; none where no irregularity is given."""
    energy, entries = findings.fluctuation, findings.spec.forces
    if energy is None or entries is None or entries.irregularity is None:
        return []
    return [
        ["mean power", energy.mean_power, "W"],
        ["mean torque", energy.mean_torque, "N m"],
        ["work above the mean torque", energy.energy, "J"],
        ["the shaft is fastest at", degrees(energy.fastest_at), "deg"],
        ["the shaft is slowest at", degrees(energy.slowest_at), "deg"],
        [f"flywheel for an irregularity of {entries.irregularity:g}", energy.flywheel(entries.irregularity), "kg m²"],
    ]


def _offset_rows(best: BestOffset) -> list[list[tables.Cell]]:
    angles = [degrees(best.pressure_angle), degrees(best.lower_bound)]
    status = "optimal" if best.proven else "local"
    return [
        ["best offset", MILLI * best.offset, None, "mm", status],
        ["greatest pressure angle with it", *angles, "deg", status],
    ]


def _force_rows(forces: CamForces) -> list[list[tables.Cell]]:
    rows: list[list[tables.Cell]] = []
    for name, curve, unit, factor in named_forces(forces):
        low, high = (chop(value * factor, curve.peak * factor, FORCE_ROUNDING) for value in (curve.least, curve.most))
        first, last = (chop(degrees(at), TURN_DEG, FORCE_ROUNDING) for at in (curve.least_at, curve.most_at))
        rows.append([name, low, first, high, last, unit])
    return rows


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}." if text else ""


def _spring_rows(findings: Findings) -> list[list[tables.Cell]]:
    spring, entries, axis = findings.spring, findings.spec.spring, findings.cam.displacement.axis
    if spring is None or entries is None:
        return []
    force, stiffness, contact = FORCE[axis], STIFFNESS[axis], entries.greatest == CONTACT
    bound = stiffness if spring.objective == "stiffness" else force
    greatest = "greatest contact force" if contact else "greatest force on the follower"
    sought = greatest if spring.objective in GREATEST.values() else spring.objective
    return [
        ["stiffness", spring.stiffness, stiffness],
        ["preload", chop(spring.preload, spring.greatest, FORCE_ROUNDING), force],
        [f"{greatest}, any speed", spring.greatest, FORCE["length"] if contact else force],
        [f"lower bound of the {sought}", chop(spring.lower_bound, spring.greatest, FORCE_ROUNDING), bound],
        ["least force left along the follower's way", chop(spring.margin, spring.greatest, FORCE_ROUNDING), force],
        ["it is left at", chop(spring.critical[0], TURN_DEG, FORCE_ROUNDING), "deg"],
    ]


def _manufactured_row(name: str, peaks: AsMade | None) -> list[tables.Cell]:
    if peaks is None:
        return [name, None, None, None]
    return [name, MICRO * peaks.deviation, peaks.acceleration_ratio, peaks.jerk_ratio]


def _columns(findings: Findings) -> list[str]:
    curves = ["pitch", "profile", *(["cutter"] if findings.spec.cutter_radius else [])]
    if findings.second is not None:
        curves += [f"return {name}" for name in curves]
    points = [f"{name} {axis}, mm" for name in curves for axis in "xy"]
    displacement = f"displacement, {UNITS[findings.cam.displacement.axis][0][0]}"
    return ["cam, deg", displacement, *points, "pressure angle, deg", "curvature, 1/mm"]


def _rows(findings: Findings) -> list[list[tables.Cell]]:
    spec, cam = findings.spec, findings.cam
    turns = np.linspace(0.0, TURN_DEG, spec.rows)
    angles = np.radians(turns)
    curves: list[PlaneCurve] = []
    for disc in (cam, findings.second):
        if disc is not None:
            curves += [disc.pitch_curve, disc.profile]
            curves += [disc.cutter_path(spec.cutter_radius)] if spec.cutter_radius else []
    columns = [
        turns,
        UNITS[cam.displacement.axis][0][1] * cam.displacement(angles),
        *(column for curve in curves for column in (MILLI * curve(angles)).T),
        np.degrees(cam.pressure_angle(angles)),
        cam.profile.curvature(angles) / MILLI,
    ]
    return [[plain(value) for value in row] for row in np.array(columns).T.tolist()]
