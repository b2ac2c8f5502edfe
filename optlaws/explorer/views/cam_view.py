"""Cams as the page shows them: profile and follower at every angle, what is enclosed, forces, a spring."""

from __future__ import annotations

import json
from functools import lru_cache
from math import degrees
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from optlaws.cams.curves.extremes import EnclosedExtreme
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.follower import CamFollower
from optlaws.cams.forces import CamForces, Surfaces
from optlaws.cams.report import CamReport
from optlaws.cycles.specification.drive import CONSTANTS
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError
from optlaws.explorer.views.cycle_view import SEGMENTS, check_axis
from optlaws.explorer.views.law_view import digits, refusal
from optlaws.explorer.views.panel_data import drawn, panel_data
from optlaws.explorer.views.requests import Question
from optlaws.jobs.cam_entries import CamProblemFile
from optlaws.jobs.cam_findings import FORCE, STIFFNESS, Findings
from optlaws.motion.display_units import DEGREES, MILLI
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array
from optlaws.sentences import Amount, Sentence, joined, sentence
from optlaws.tolerances import FORCE_ROUNDING

_STEPS = 360
_WHERE = Path("the cam")
_TITLES = {"free": ("no undercut", "optimal"), "undercut": ("undercut", "refused"), "undecided": ("undecided", "local")}


class CamRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A cam, as in its problem file."""

    study: dict[str, Any]


def answer(request: CamRequest) -> dict[str, Any]:
    """The view of a cam, or the reason why there is none."""
    try:
        return _view(findings_of(request))
    except OptlawsError as error:
        return {"refused": refusal(error, "no such cam")}


def findings_of(request: CamRequest) -> Findings:
    """The entries of the cam's problem file, and the cams that they describe."""
    return _solved(json.dumps(request.study, sort_keys=True))


@lru_cache(maxsize=32)
def _solved(question: str) -> Findings:
    data = json.loads(question)
    if "barrel" in data:
        raise InputError("the explorer shows disc cams: `optlaws run` computes barrel cams")
    check_axis(CamProblemFile.read(data, _WHERE).motion)
    return Findings.read(data, _WHERE)


def _view(findings: Findings) -> dict[str, Any]:
    spec, cam = findings.spec, findings.cam
    return drawing(cam, spec.cutter_radius) | {
        "dimensions": _dimensions(spec, cam),
        "panels": _panels(spec, cam),
        "across": "angle of the cam, deg",
        "segments": [],
        "trust": _trust(cam) | _broken_limits(spec, cam),
    }


def drawing(cam: DiscCam, cutter: Any = None) -> dict[str, Any]:
    """The curves of a cam in mm, and its follower while the cam turns, degree by degree."""
    angles = np.linspace(0.0, 2.0 * np.pi, _STEPS + 1)
    curves = {"profile": cam.profile, "pitch": cam.pitch_curve}
    if cutter is not None:
        curves["cutter"] = cam.cutter_path(cutter)
    return {
        "curves": {name: _points(np.asarray(curve(angles))) for name, curve in curves.items()},
        "frames": _frames(cam, angles),
        "turning": cam.contact.turning,
        "follower": _follower(cam),
    }


def _points(metres: Array) -> list[list[float | None]]:
    return [drawn(row, 4) for row in MILLI * metres]


def _frames(cam: DiscCam, angles: Array) -> dict[str, Any]:
    """Positions of the follower at each angle of the cam: its roller's centre, its point of contact, its face."""
    return {
        "centre": _points(_as_seen(cam, angles, np.asarray(cam.pitch_curve(angles)))),
        "contact": _points(_as_seen(cam, angles, np.asarray(cam.profile(angles)))),
        "edge": [
            drawn(coordinates, 6) for coordinates in _as_seen(cam, angles, np.asarray(cam.profile.tangent(angles)))
        ],
    }


def _as_seen(cam: DiscCam, angles: Array, vectors: Array) -> Array:
    """Vectors of the cam, turned with it."""
    turned = cam.contact.turning * angles
    cosine, sine = np.cos(turned), np.sin(turned)
    x, y = vectors.T
    return np.column_stack([cosine * x - sine * y, sine * x + cosine * y])


def _follower(cam: DiscCam) -> dict[str, Any]:
    roller, pivot = cam.contact.roller, cam.contact.pivot
    return {
        "kind": cam.follower.kind,
        "roller": MILLI * roller if roller else None,
        "pivot": None if pivot is None else MILLI * pivot,
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


def _panels(spec: CamProblemFile, cam: DiscCam) -> list[dict[str, Any]]:
    limit = spec.steepest
    displacement, pressure, _, radius = (panel_data(panel, DEGREES) for panel in CamReport(cam, limit).panels)
    pressure["beyond"] = limit is not None and not cam.extremes.keeps_pressure_angle(limit)
    return [displacement, pressure, radius]


def _trust(cam: DiscCam) -> dict[str, Any]:
    """Proven properties of the cam in words; extremes are enclosed over the whole turn."""
    extremes = cam.extremes
    word, status = _TITLES[extremes.undercut.status]
    facts = [
        sentence("greatest pressure angle {}", _located(extremes.greatest_pressure_angle, degrees(1.0), "deg")),
        sentence("least radius of curvature {}", _located(extremes.least_convex_radius, MILLI, "mm")),
    ]
    if extremes.least_concave_radius is not None:
        hollow = _located(extremes.least_concave_radius, MILLI, "mm")
        facts.append(sentence("hollow with a radius of {}: a cutter must be smaller", hollow))
    facts += [sentence("{} {}", size.name, _located(size.extreme, MILLI, "mm")) for size in extremes.sizes]
    first, *rest = sentence("{}.", extremes.undercut).parts
    advice = Sentence(first[0].upper() + first[1:], *rest)
    return {"status": status, "word": word, "advice": advice, "gap": "", "facts": facts}


def _broken_limits(spec: CamProblemFile, cam: DiscCam) -> dict[str, str]:
    """A verdict on limits that the cam does not keep; nothing where it keeps all."""
    extremes, broken = cam.extremes, [sentence("{}", size) for size in cam.extremes.beyond]
    if spec.steepest is not None and not extremes.keeps_pressure_angle(spec.steepest):
        taken = Amount(degrees(extremes.greatest_pressure_angle.value), "deg", 5)
        broken.append(sentence("the pressure angle, {} of {}", taken, spec.pressure_angle))
    if spec.least_radius is not None and not extremes.keeps_radius(spec.least_radius):
        taken = Amount(MILLI * extremes.least_convex_radius.value, "mm", 5)
        broken.append(sentence("the radius of curvature, {} of {}", taken, spec.radius_of_curvature))
    if not broken or extremes.undercut.status == "undercut":
        return {}
    advice = sentence("Beyond what is allowed: {}.", joined("; ", broken))
    return {"status": "refused", "word": "beyond a limit", "advice": advice}


def _located(extreme: EnclosedExtreme, factor: float, unit: str) -> Sentence:
    return sentence("{} at {}", Amount(extreme.value * factor, unit, 7), _at(extreme.angle))


def _at(angle: float) -> Amount:
    """An angle in degrees, to a millionth."""
    return Amount(round(degrees(angle), 6) + 0.0, "deg", 5)


def sizes(request: CamRequest) -> dict[str, Any]:
    """The least prime circle that keeps the limits, where some are given: it takes longer than the view.

    Examples
    --------
    >>> sizes(CamRequest(study=example()))["facts"]
    ['least prime circle that keeps these limits: 58.60757 mm (base circle 46.60757 mm), by the pressure angle']
    """
    others = {name: value for name, value in request.study.items() if name not in {"cutter_radius", "title", "text"}}
    return {"facts": list(_least(json.dumps(others | {"title": "a cam"}, sort_keys=True)))}


@lru_cache(maxsize=32)
def _least(question: str) -> tuple[Sentence, ...]:
    least = _solved(question).least
    if least is None or isinstance(least, str):
        return () if least is None else (sentence("{}", least),)
    radius, base = (Amount(MILLI * length, "mm", 7) for length in (least.radius, least.cam.base_radius))
    inner = sentence(" (base circle {})", base) if least.cam.contact.roller else ""
    return (sentence("least prime circle that keeps these limits: {}{}, by the {}", radius, inner, least.limit),)


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
    """The entries of a cam as a form shows them, whether each kind of follower slides or swings, and what these move.

    Examples
    --------
    >>> form()["axes"]["inclined flat"], form()["drive"]["length"][0]["placeholder"]
    ('length', 'none, or 2.5 kg')
    """
    return {
        **CamProblemFile.form(),
        "axes": {name: kind.axis for name, kind in CamFollower.kinds().items()},
        "drive": {axis: table.form()["entries"] for axis, table in CONSTANTS.items()},
    }


_PER_MEGAPASCAL = 1e6


def loads(request: CamRequest) -> dict[str, Any]:
    """Panels and words of a cam whose motion has a drive; none where it has none."""
    try:
        return _loads(json.dumps(request.study, sort_keys=True))
    except OptlawsError as error:
        return {"panels": [], "facts": [sentence("{}", error.args[0])]}


@lru_cache(maxsize=32)
def _loads(question: str) -> dict[str, Any]:
    findings = _solved(question)
    if findings.spec.motion.drive is None:
        return {"panels": [], "facts": []}
    forces = findings.forces_with(findings.spec.forces or Surfaces())
    return {"panels": _load_panels(forces), "facts": [*_load_facts(forces), *_spring(findings)]}


def _load_panels(forces: CamForces) -> list[dict[str, Any]]:
    panels = [panel_data(panel, DEGREES) for panel in CamReport(forces.cam).loads(forces)]
    for pressed in panels[2:]:
        pressed["peaks"] = pressed["peaks"][-1:]
    return panels


def _load_facts(forces: CamForces) -> list[str]:
    """Enclosed contact forces and torques over the whole turn, in words."""
    contact, torque = forces.contact, forces.torque
    lifted = sentence("the follower lifts off at {}: ", _at(contact.least_at)) if forces.lifts_off else ""
    turned = f"torque at the shaft {digits(torque.least, 6)} to {digits(torque.most, 6)} N m"
    facts = [
        sentence("{}contact force {} to {} N", lifted, digits(contact.least, 6), digits(contact.most, 6)),
        f"{turned}, root mean square {digits(forces.rms_torque[1], 6)} N m",
    ]
    if forces.width is not None:
        facts.append(f"Hertz's pressure up to {digits(forces.pressure.most / _PER_MEGAPASCAL, 6)} MPa")
    return facts


def _spring(findings: Findings) -> list[str]:
    """The least spring for the requested range of speeds; or the reason why there is none."""
    try:
        spring = findings.spring
    except (InfeasibleProblem, InputError) as error:
        return [sentence("no spring: {}", error.args[0])]
    if spring is None:
        return []
    axis = findings.cam.displacement.axis
    preload = 0.0 if abs(spring.preload) <= FORCE_ROUNDING * spring.greatest else spring.preload
    sizes = f"{digits(spring.stiffness, 6)} {STIFFNESS[axis]}, preload {digits(preload, 6)} {FORCE[axis]}"
    pressed = findings.spec.spring is not None and findings.spec.spring.greatest == "contact"
    greatest = f"{digits(spring.greatest, 6)} {'N of contact' if pressed else f'{FORCE[axis]} on the follower'}"
    remark = [spring.remark] if spring.remark else []
    return [f"least spring without lift-off: {sizes}, up to {greatest}", *remark]


QUESTIONS: dict[str, Question] = {
    "cam": (CamRequest, answer),
    "cam-loads": (CamRequest, loads),
    "cam-sizes": (CamRequest, sizes),
}
