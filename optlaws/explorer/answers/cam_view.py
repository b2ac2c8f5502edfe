"""Cams as the page shows them: profile and follower at every angle, pressure angle and curvature, words of proof."""

from __future__ import annotations

import json
from copy import deepcopy
from functools import lru_cache
from math import degrees
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from optlaws.cams.curves.extremes import EnclosedExtreme
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.follower import follower_kinds
from optlaws.cams.least_sizes import least_base_circle
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.explorer.answers.cycle_view import check_axis
from optlaws.explorer.answers.law_view import digits, drawn, refusal
from optlaws.jobs.cam import schema
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array

_MILLI = 1e3
_TURN = 360.0
_STEPS = 360
_WHERE = Path("the cam")
_FAR = 4.0  # a radius of curvature beyond so many base circles is a straight edge
_HEARD = {"free": ("no undercut", "optimal"), "undercut": ("undercut", "refused"), "undecided": ("undecided", "local")}


class AskedCam(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A cam as its problem file says it."""

    study: dict[str, Any]


def answer(asked: AskedCam) -> dict[str, Any]:
    """The view of a cam, or why there is none."""
    try:
        return _view(*cam_of(asked))
    except (InfeasibleProblem, SolverFailure) as error:
        return {"refused": refusal(error)}
    except InputError as error:
        return {"refused": {"word": "no such cam", "reason": str(error), "tried": ""}}


def cam_of(asked: AskedCam) -> tuple[schema.CamProblemFile, DiscCam]:
    """What is wished of the cam, and the cam."""
    spec, cams = cams_of(asked)
    return spec, cams.first


def cams_of(asked: AskedCam) -> tuple[schema.CamProblemFile, schema.Cams]:
    """The same with all that was found for it."""
    return _made(json.dumps(asked.study, sort_keys=True))


@lru_cache(maxsize=32)
def _made(question: str) -> tuple[schema.CamProblemFile, schema.Cams]:
    from optlaws.files.problem_file import convert

    data = json.loads(question)
    if "barrel" in data:
        raise InputError("the explorer shows disc cams: barrel cams are made by the command `optlaws cam`")
    check_axis(convert(data, schema.CamProblemFile, _WHERE).motion)
    return schema.read(data, _WHERE)


def _view(spec: schema.CamProblemFile, cam: DiscCam) -> dict[str, Any]:
    angles = np.linspace(0.0, 2.0 * np.pi, _STEPS + 1)
    curves = {"profile": cam.profile, "pitch": cam.pitch_curve}
    if spec.cutter_radius is not None:
        curves["cutter"] = cam.cutter_path(spec.cutter_radius)
    return {
        "curves": {name: _points(np.asarray(curve(angles))) for name, curve in curves.items()},
        "frames": _frames(cam, angles),
        "turning": cam.contact.turning,
        "follower": _follower(cam),
        "panels": _panels(spec, cam, angles),
        "across": "angle of the cam, deg",
        "segments": [],
        "trust": _trust(cam),
    }


def _points(metres: Array) -> list[list[float | None]]:
    return [drawn(row, 4) for row in _MILLI * metres]


def _frames(cam: DiscCam, angles: Array) -> dict[str, Any]:
    """Where the follower is while the cam has turned by each angle: its roller's centre, where it touches, its face."""
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
        "roller": _MILLI * roller if roller else None,
        "pivot": None if pivot is None else _MILLI * pivot,
    }


def _panels(spec: schema.CamProblemFile, cam: DiscCam, angles: Array) -> list[dict[str, Any]]:
    turns = drawn(np.degrees(angles), 4)
    unit, factor = ("mm", _MILLI) if cam.follower.axis == "length" else ("deg", degrees(1.0))
    pressure = cam.extremes.greatest_pressure_angle
    limit = None if spec.pressure_angle is None else degrees(quantity(spec.pressure_angle, "angle", "pressure_angle"))
    radius = _MILLI * np.asarray(cam.radius_of_curvature(angles))
    far = _FAR * _MILLI * quantity(cam.base_radius, "length", "base_radius")
    bulging = cam.extremes.least_convex_radius
    return [
        panel("displacement", unit, turns, factor * np.asarray(cam.displacement(angles)), []),
        panel(
            "pressure angle", "deg", turns, np.degrees(cam.pressure_angle(angles)), [_mark(pressure, degrees(1.0), cam)]
        )
        | {"limits": [] if limit is None else [{"from": 0.0, "to": _TURN, "value": limit}]}
        | {"beyond": limit is not None and degrees(pressure.value) > limit},
        panel(
            "radius of curvature", "mm", turns, np.where(np.abs(radius) < far, radius, np.nan), [_mark(bulging, _MILLI)]
        ),
    ]


def panel(name: str, unit: str, turns: Any, values: Array, peaks: list[dict[str, Any]]) -> dict[str, Any]:  # noqa: ANN401
    """A curve over the turn in degrees, with its marks."""
    return {"name": name, "unit": unit, "at": turns, "values": drawn(values), "limits": [], "peaks": peaks}


def _mark(extreme: EnclosedExtreme, factor: float, signed_by: DiscCam | None = None) -> dict[str, Any]:
    value = extreme.value
    if signed_by is not None:
        value = float(np.copysign(value, signed_by.pressure_angle(extreme.angle)))
    return {"at": round(degrees(extreme.angle), 4), "value": value * factor, "text": digits(value * factor, 6)}


def _trust(cam: DiscCam) -> dict[str, Any]:
    """What is proven of the cam, in words; extremes are enclosed over the whole turn."""
    extremes = cam.extremes
    word, status = _HEARD[extremes.undercut.status]
    facts = [
        f"greatest pressure angle {_told(extremes.greatest_pressure_angle, degrees(1.0), 'deg')}",
        f"least radius of curvature {_told(extremes.least_convex_radius, _MILLI, 'mm')}",
    ]
    if extremes.least_concave_radius is not None:
        facts.append(
            f"hollow with a radius of {_told(extremes.least_concave_radius, _MILLI, 'mm')}: a cutter must be smaller"
        )
    text = str(extremes.undercut)
    return {"status": status, "word": word, "advice": f"{text[0].upper()}{text[1:]}.", "gap": "", "facts": facts}


def _told(extreme: EnclosedExtreme, factor: float, unit: str) -> str:
    return f"{digits(extreme.value * factor)} {unit} at {digits(degrees(extreme.angle), 5)} deg"


def sizes(asked: AskedCam) -> dict[str, Any]:
    """The least base circle that keeps the limits, where some are given: it takes longer than the view.

    Examples
    --------
    >>> sizes(AskedCam(study=example()))["facts"]
    ['least base circle that keeps these limits: 58.60757 mm, by the pressure angle']
    """
    others = {name: value for name, value in asked.study.items() if name not in {"cutter_radius", "title", "text"}}
    return {"facts": list(_least(json.dumps(others | {"title": "a cam"}, sort_keys=True)))}


@lru_cache(maxsize=32)
def _least(question: str) -> tuple[str, ...]:
    spec, cams = _made(question)
    cam = cams.first
    if spec.pressure_angle is None and spec.radius_of_curvature is None:
        return ()
    try:
        least = least_base_circle(cam.motion, cam.follower, **spec.limits)
    except InfeasibleProblem as error:
        return (str(error.args[0]),)
    return (f"least base circle that keeps these limits: {digits(_MILLI * least.radius)} mm, by the {least.limit}",)


#: what the page shows where no cam was given
EXAMPLE: dict[str, Any] = {
    "job": "cam",
    "title": "A slide on a disc cam with a roller",
    "speed": "200 rpm",
    "base_radius": "60 mm",
    "pressure_angle": "30 deg",
    "radius_of_curvature": "15 mm",
    "follower": {"kind": "translating roller", "radius": "12 mm", "offset": "6 mm"},
    "motion": {
        "name": "slide",
        "segment": [
            {"kind": "rise", "by": "35 mm", "duration": "120 deg"},
            {"kind": "dwell", "duration": "90 deg"},
            {"kind": "return", "by": "35 mm", "duration": "100 deg"},
            {"kind": "dwell"},
        ],
    },
}


def example() -> dict[str, Any]:
    """The cam that is shown where none was given.

    Examples
    --------
    >>> answer(AskedCam(study=example()))["trust"]["word"]
    'no undercut'
    """
    return deepcopy(EXAMPLE)


def followers() -> dict[str, dict[str, Any]]:
    """Kinds of followers: whether each slides or swings, and what its entries may be.

    Examples
    --------
    >>> followers()["inclined flat"]
    {'axis': 'length', 'entries': {'inclination': '10 deg'}}
    """
    return {name: {"axis": kind.axis, "entries": kind.examples} for name, kind in follower_kinds().items()}
