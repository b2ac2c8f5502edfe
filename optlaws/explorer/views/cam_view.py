"""Cams as the page shows them: profile and follower at every angle, what is enclosed, forces, a spring."""

from __future__ import annotations

import json
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from optlaws.cams.curves.extremes import UNDERCUT
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.contact import PRESSURE
from optlaws.cams.followers.follower import CamFollower
from optlaws.cams.forces import CamForces, Surfaces
from optlaws.cams.report import DIGITS, CamReport, forces_section, leaves
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, located
from optlaws.explorer.views.cycle_view import SEGMENTS, CycleRequest
from optlaws.explorer.views.law_view import refusing
from optlaws.explorer.views.opened_results import OPENED
from optlaws.explorer.views.panel_data import drawn, fact_sentences, panel_data, table_data
from optlaws.explorer.views.requests import check_size, without_files
from optlaws.jobs.cam_entries import CamProblemFile
from optlaws.jobs.cam_result import CamResult
from optlaws.motion.quantities import MILLI, quantity
from optlaws.sentences import Sentence, capital, joined, sentence
from optlaws.shown.report import ReportTable

_STEPS = 360
_WHERE = Path("the cam")
_BEYOND = "beyond a limit", "refused"
_TITLES = {"free": ("no undercut", "optimal"), "undercut": ("undercut", "refused"), "undecided": ("undecided", "local")}


@refusing("no such cam")
def answer(request: CycleRequest) -> dict[str, Any]:
    """The view of a cam, or the reason why there is none."""
    result = result_of(request)
    spec, cam, report = result.spec, result.cam, result.report
    *motion, _, radius = (panel_data(panel) for panel in report.panels)
    for pressure in motion[1:]:
        pressure["beyond"] = PRESSURE in spec.limits.broken(cam.extremes)
    return drawing(cam, spec.cutter_radius) | {
        "dimensions": _dimensions(spec, cam),
        "panels": [*motion, radius],
        "across": "angle of the cam",
        "unit": "deg",
        "segments": [],
        "trust": _trust(report),
    }


def result_of(request: CycleRequest) -> CamResult:
    """The result of the cam's problem file, which is computed once."""
    return _solved(json.dumps(request.study, sort_keys=True))


@lru_cache(maxsize=32)
def _solved(question: str) -> CamResult:
    data = json.loads(question)
    without_files(data)
    if "barrel" in data:
        raise InputError("the explorer shows disc cams: `optlaws run` computes barrel cams")
    spec = CamProblemFile.read(data, _WHERE)
    check_size(spec.motion.order, spec.motion.degree)
    with located(str(_WHERE)):
        return OPENED.cam_of(spec) or CamResult.of_file(spec)


def drawing(cam: DiscCam, cutter: Any = None) -> dict[str, Any]:
    """The curves of a cam in mm and the directions of its profile, degree by degree, and what its follower is."""
    angles = np.linspace(0.0, 2.0 * np.pi, _STEPS + 1)
    curves = {"profile": cam.profile, "pitch": cam.pitch_curve}
    if cutter is not None:
        curves["cutter"] = cam.cutter_path(cutter)
    roller, pivot = cam.contact.roller, cam.contact.pivot
    return {
        "curves": {
            name: [drawn(row, 4) for row in MILLI * np.asarray(curve(angles))] for name, curve in curves.items()
        },
        "tangents": [drawn(row, 6) for row in np.asarray(cam.profile.tangent(angles))],
        "turning": cam.contact.turning,
        "follower": {
            "kind": cam.follower.kind,
            "roller": MILLI * roller if roller else None,
            "pivot": None if pivot is None else MILLI * pivot,
        },
    }


def _dimensions(spec: CamProblemFile, cam: DiscCam) -> list[dict[str, Any]]:
    """Circles of the drawing and lengths of the follower, mm."""
    prime = quantity(cam.prime_radius, "length", "prime_radius")
    lengths = {"prime circle": prime, "base circle": cam.base_radius} if cam.contact.roller else {"base circle": prime}
    lengths |= {"roller": cam.contact.roller} if cam.contact.roller else {}
    if spec.cutter_radius is not None:
        lengths["cutter"] = quantity(spec.cutter_radius, "length", "cutter_radius")
    if cam.contact.pivot is not None:
        lengths["pivot"] = cam.contact.pivot
    for name in ("offset", "arm", "face_offset"):
        given = getattr(cam.follower, name, None)
        if given is not None and quantity(given, "length", name):
            lengths[name.replace("_", " ")] = quantity(given, "length", name)
    return [{"name": name, "value": MILLI * length} for name, length in lengths.items()]


def _trust(report: CamReport) -> dict[str, Any]:
    """Whether the cam can be cut and keeps its limits, in words; extremes are enclosed over the whole turn."""
    undercut, beyond = report.cam.extremes.undercut, report.beyond
    (word, status), advice = _TITLES[undercut.status], sentence("{}.", undercut)
    if beyond and undercut.status != UNDERCUT:
        (word, status), advice = _BEYOND, sentence("limits exceeded: {}.", joined("; ", beyond))
    facts = fact_sentences(report.extremes, DIGITS)
    return {"status": status, "word": word, "advice": capital(advice), "facts": facts}


def sizes(request: CycleRequest) -> dict[str, Any]:
    """The cam beside the one with the usual law, its laws, the least prime circle of limits, and the greatest roller.

    They take longer than the view.
    """
    others = {name: value for name, value in request.study.items() if name not in {"cutter_radius", "title", "text"}}
    result = result_of(CycleRequest(study=others | {"title": "a cam"}))
    facts = [each for part in (result.laws, result.sizes) for each in fact_sentences(part.facts, part.digits)]
    notes = [part.note for part in (result.differences, result.sizes) if part.note]
    beside = result.differences.table
    return {"beside": None if beside is None else table_data(beside), "facts": [*facts, *notes]}


def values_of(request: CycleRequest) -> ReportTable:
    """The cam degree by degree, with its forces where the motion has a drive."""
    result = result_of(request)
    return result.table_of(_STEPS + 1, _forces(result))


def _forces(result: CamResult) -> CamForces | None:
    """The forces of a cam whose motion has a drive, whether its file has a table of them or not."""
    return None if result.spec.motion.drive is None else result.forces or result.forces_of(Surfaces())


def example() -> dict[str, Any]:
    """The cam that the page shows where none was given."""
    return {
        "job": "cam",
        "title": "A slide on a disc cam with a roller",
        "speed": "200 rpm",
        "prime_radius": "60 mm",
        "pressure_angle": "30 deg",
        "radius_of_curvature": "15 mm",
        "follower": {"kind": "translating roller", "radius": "12 mm", "offset": "6 mm"},
        "motion": {"name": "slide", "segment": SEGMENTS},
    }


def form() -> dict[str, Any]:
    """The entries of a cam as a form shows them, whether a kind of follower slides or swings, and what these move."""
    return {
        **CamProblemFile.form(),
        "axes": {name: kind.axis for name, kind in CamFollower.kinds().items()},
    }


def loads(request: CycleRequest) -> dict[str, Any]:
    """Panels and words of a cam whose motion has a drive, and whether its follower leaves it; none without a drive."""
    try:
        result = result_of(request)
        forces = _forces(result)
        if forces is None:
            return {"panels": [], "facts": []}
        panels, section = [panel_data(panel) for panel in result.report.loads(forces)], forces_section(forces)
        for pressed in panels[2:]:
            pressed["peaks"] = pressed["peaks"][-1:]
        return {
            "panels": panels,
            "facts": [*fact_sentences(section.facts, section.digits), *_spring(result)],
            "leaves": leaves(forces),
        }
    except OptlawsError as error:
        return {"panels": [], "facts": [sentence("{}", error.args[0])]}


def _spring(result: CamResult) -> list[Sentence]:
    """The least spring for the range of speeds; or the reason why there is none."""
    try:
        spring = result.spring
    except (InfeasibleProblem, InputError) as error:
        return [sentence("no spring: {}", error.args[0])]
    sizes = joined(", ", fact_sentences(spring.facts, spring.digits))
    return [sentence("least spring without lift-off: {}. {}", sizes, spring.note)] if spring.facts else []
