from collections.abc import Callable
from math import tau
from typing import Any

import numpy as np
import pytest

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
from tests.internals.cams import (
    ArcChain,
    CamFollower,
    Following,
    Outline,
    PlaneCurve,
    PolarSpline,
    arcs,
    polar,
    run_against,
    spline,
    spline_through,
)

FOLLOWERS: list[tuple[CamFollower, str]] = [
    (TranslatingRoller("12 mm", offset="10 mm"), "40 mm"),
    (TranslatingFlat(), "20 mm"),
    (InclinedFlat("-20 deg"), "20 mm"),
    (OscillatingRoller("12 mm", arm="90 mm", pivot_distance="120 mm"), "20 deg"),
    (OscillatingFlat(pivot_distance="120 mm", face_offset="8 mm"), "10 deg"),
]
CURVES: dict[str, Callable[[PlaneCurve], Outline]] = {
    "csv": lambda profile: spline_through(np.round(profile(np.linspace(0.0, tau, 181) % tau), 6)),
    "csv polar": lambda profile: PolarSpline(np.round(polar(profile, 181), 6)),
    "dxf spline": lambda profile: spline(profile, 1e-6),
    "dxf arcs": lambda profile: ArcChain(arcs(profile, 1e-6)),
}
PLACES = np.linspace(0.01, 6.27, 301)


def cam(follower: CamFollower, stroke: str, **others: Any) -> DiscCam:
    moves = [Rise(stroke, "120 deg", law="3-4-5"), Dwell("60 deg"), Return(None, "120 deg", law="cycloidal"), Dwell()]
    return DiscCam(Cycle(moves, speed="200 rpm"), prime_radius="70 mm", follower=follower, **others)


@pytest.mark.parametrize("turning", ["counterclockwise", "clockwise"])
@pytest.mark.parametrize(("follower", "stroke"), FOLLOWERS)
def test_a_follower_does_on_its_profile_what_was_meant(follower: CamFollower, stroke: str, turning: str) -> None:
    disc = cam(follower, stroke, turning=turning, phase="30 deg")
    curves = [(disc.profile, 0.0), (disc.pitch_curve, disc.contact.roller), (disc.cutter_path("25 mm"), 0.025)]
    for curve, outside in curves:
        following = Following(disc.contact, curve, np.radians(30.0), outside)
        for nu in range(4):
            angle, values = following.at(PLACES, nu)
            assert np.abs(np.angle(np.exp(1j * (angle - PLACES)))).max() < 1e-12
            assert values == pytest.approx(disc.displacement(PLACES, nu), abs=1e-11)


@pytest.mark.sample(4)
@pytest.mark.parametrize("form", ["csv", "csv polar", "dxf spline", "dxf arcs"])
@pytest.mark.parametrize(("follower", "stroke"), FOLLOWERS)
def test_peaks_as_made_are_enclosed_and_near(follower: CamFollower, stroke: str, form: str) -> None:
    disc = cam(follower, stroke)
    curve = CURVES[form](disc.profile)
    made, following = run_against(disc, curve, jumps=False), Following(disc.contact, curve)
    edges = np.array(curve.breaks)
    places = (edges[:-1] + np.diff(edges) * np.linspace(1e-9, 1.0 - 1e-9, 101)[:, None]).ravel()
    angle, displacement = following.at(places, 0)
    off = float(np.abs(displacement - disc.displacement(angle)).max())
    assert off * (1.0 - 1e-9) <= made.deviation < 1.01 * off + 1e-14
    for nu, bound in ((2, made.acceleration), (3, made.jerk)):
        seen = float(np.abs(following.at(places, nu)[1]).max())
        assert seen * (1.0 - 1e-9) <= bound < (1.0 + 1e-4) * seen
