"""Cams for tests, and where their followers are, by plane trigonometry of its own."""

from __future__ import annotations

from math import acos, asin, sqrt

import numpy as np
from numpy.typing import NDArray

from optlaws import (
    Cycle,
    DiscCam,
    Dwell,
    InclinedFlat,
    OscillatingFlat,
    OscillatingRoller,
    Return,
    Rise,
    TranslatingFlat,
    TranslatingRoller,
)
from tests.internals.cams import CamFollower
from tests.internals.motion import either

Array = NDArray[np.float64]
Points = NDArray[np.complex128]

FOLLOWERS: dict[str, tuple[CamFollower, str, str]] = {
    "translating roller": (TranslatingRoller("12 mm", offset="9 mm"), "30 mm", "70 mm"),
    "translating flat": (TranslatingFlat(), "12 mm", "70 mm"),
    "inclined flat": (InclinedFlat(inclination="10 deg"), "12 mm", "70 mm"),
    "oscillating roller": (OscillatingRoller("12 mm", arm="90 mm", pivot_distance="120 mm"), "20 deg", "60 mm"),
    "oscillating flat": (OscillatingFlat(pivot_distance="150 mm", face_offset="6 mm"), "6 deg", "60 mm"),
}
TURNINGS = {"counterclockwise": 1.0, "clockwise": -1.0}


def cycle_of(stroke: str, law: str = "cycloidal") -> Cycle:
    """Up, rest, down, rest."""
    return Cycle(
        [Rise(stroke, "140 deg", law=law), Dwell("40 deg"), Return(duration="120 deg", law=law), Dwell()], period="1 s"
    )


def cam_of(kind: str, turning: str = "counterclockwise", law: str = "cycloidal") -> DiscCam:
    """A cam of each kind that is free of undercut."""
    follower, stroke, radius = FOLLOWERS[kind]
    return DiscCam(cycle_of(stroke, law), radius, follower, turning=turning)  # type: ignore[arg-type]


def length(value: object) -> float:
    """In metres or radians."""
    return either(value, ("length", "angle"), "value")[1]


def roller_centres(cam: DiscCam, angles: Array) -> Points:
    """Where the roller's centre is, in the cam's coordinates as complex numbers; the motion starts lowest."""
    radius, s = length(cam.prime_radius), np.asarray(cam.displacement(angles))
    if isinstance(cam.follower, TranslatingRoller):
        offset = length(cam.follower.offset)
        beside = offset + 1j * (sqrt(radius**2 - offset**2) + s)
    else:
        assert isinstance(cam.follower, OscillatingRoller)
        arm, distance = length(cam.follower.arm), length(cam.follower.pivot_distance)
        psi = acos((distance**2 + arm**2 - radius**2) / (2 * distance * arm)) + s
        beside = distance - arm * np.exp(-1j * psi)
    centres: Points = beside * np.exp(-1j * TURNINGS[cam.turning] * angles)
    return centres


def face_lines(cam: DiscCam, angles: Array) -> tuple[Points, Array]:
    """Unit normals of the face, away from the cam, in its coordinates, and how far the face is from its centre."""
    radius, s = length(cam.prime_radius), cam.displacement(angles)
    if isinstance(cam.follower, TranslatingFlat):
        normal, far = np.full(len(angles), 1j), radius + s
    elif isinstance(cam.follower, InclinedFlat):
        normal = np.full(len(angles), 1j * np.exp(1j * length(cam.follower.inclination)))
        far = radius + s * normal[0].imag
    else:
        assert isinstance(cam.follower, OscillatingFlat)
        distance, offset = length(cam.follower.pivot_distance), length(cam.follower.face_offset)
        phi = asin((radius - offset) / distance) + s
        normal, far = 1j * np.exp(-1j * phi), distance * np.sin(phi) + offset
    return normal * np.exp(-1j * TURNINGS[cam.turning] * angles), far


def points(curve_values: Array) -> Points:
    """Rows of x and y as complex numbers."""
    return curve_values[..., 0] + 1j * curve_values[..., 1]
