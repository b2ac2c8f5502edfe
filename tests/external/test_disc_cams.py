"""Cams of others: places, angles, curvature, contact forces and least prime circles, against ours."""

import json
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from optlaws import (
    CamForces,
    Cycle,
    DiscCam,
    Dwell,
    Move,
    Return,
    Rise,
    TranslatingFlat,
    TranslatingRoller,
    least_prime_circle,
)
from tests.external.published import REFERENCE, cases, numbers
from tests.external.test_university_cams import moves

CAMS = json.loads((REFERENCE / "published_cams.json").read_text(encoding="utf-8"))
LEUVEN = [name for name in CAMS if name != "about"]


@pytest.fixture(scope="module", params=LEUVEN)
def leuven(request: pytest.FixtureRequest) -> tuple[dict[str, Any], DiscCam]:
    """A cam of the MATLAB program matcam, and the same of ours."""
    case = CAMS[request.param]
    roller = TranslatingRoller(f"{case['rof']} mm", offset=f"{case['exc']} mm")
    cycle = Cycle(moves(request.param), speed=f"{case['rpm']} rpm")
    return case, DiscCam(cycle, prime_radius=f"{case['bcr'] + case['rof']} mm", follower=roller)


def test_cams_of_matcam(leuven: tuple[dict[str, Any], DiscCam]) -> None:
    case, cam = leuven
    angles = np.radians(case["thetadegree"])
    assert_allclose(1e3 * cam.displacement(angles), case["S"], atol=1e-12)
    assert_allclose(1e3 * cam.displacement(angles, nu=1), case["V"], atol=1e-11)
    assert_allclose(1e3 * cam.displacement(angles, nu=2), case["A"], atol=1e-10)
    assert_allclose(cam.pressure_angle(angles), case["pressure_angle"], atol=1e-14)
    assert_allclose(1e3 * cam.profile(angles), np.transpose([case["xcam"], case["ycam"]]), atol=1e-10)


def test_extremes_of_matcam_lie_within_a_sample_of_ours(leuven: tuple[dict[str, Any], DiscCam]) -> None:
    case, cam = leuven
    extremes = cam.extremes
    least, least_at, greatest, greatest_at = case["extremes"]["pressure_angle"]
    steepest = max(-least, greatest)
    worst = extremes.greatest_pressure_angle
    assert steepest <= worst.high
    assert worst.low - steepest < 1e-7
    assert abs(np.degrees(worst.angle) - (least_at if steepest == -least else greatest_at)) < 0.011
    assert extremes.least_convex_radius is not None
    assert extremes.least_concave_radius is not None
    # radii of the pitch curve there, of the profile here; on 36,000 places theirs is the greater, or the smaller hollow
    bulging, hollow = case["roc_pitch_least_positive"] - case["rof"], case["rof"] - case["roc_pitch_least_hollow"]
    assert 0 <= bulging - 1e3 * extremes.least_convex_radius.low < 1e-4
    assert abs(1e3 * extremes.least_concave_radius.value - hollow) < 1e-4


def test_contact_forces_of_matcam(leuven: tuple[dict[str, Any], DiscCam]) -> None:
    case, cam = leuven
    drive = {
        "mass": f"{case['mass']} kg",
        "stiffness": f"{case['springconstant']} N/mm",
        "preload": f"{case['springpreload']} N",
    }
    theirs = np.array(case["normalforce_spring"]) + case["normalforce_acc"]
    assert_allclose(CamForces(cam, drive=drive).contact_force(np.radians(case["thetadegree"])), theirs, rtol=1e-11)


def test_a_contact_force_below_zero_is_reported() -> None:
    roller = TranslatingRoller("40 mm", offset="2.8 mm")
    cam = DiscCam(Cycle(moves("SV"), speed="600 rpm"), prime_radius="70 mm", follower=roller)
    forces = CamForces(cam, drive={"mass": "1.8 kg", "stiffness": "18.5 N/mm", "preload": "319.16 N"})
    assert forces.lifts_off
    assert forces.contact.least == pytest.approx(-153.1844, abs=1e-4)
    assert forces.contact.most == pytest.approx(1983.9778, abs=2e-4)


def test_exercise_of_leuven() -> None:
    """The prime circle of the print is 50 mm; its angles and radius are those of 65 mm: the roller was added twice."""
    moves = [
        Dwell("10 deg"),
        Rise("10 mm", "55 deg", law="3-4-5"),
        Dwell("30 deg"),
        Rise("40 mm", "115 deg", law="3-4-5"),
    ]
    cycle = Cycle([*moves, Return("50 mm", "140 deg", law="3-4-5"), Dwell("10 deg")], speed="120 rpm")
    assert cycle.peak(1) == pytest.approx(0.482, abs=5e-4)
    assert cycle.peak(2) == pytest.approx(9.89, abs=5e-3)
    extremes = DiscCam(cycle, prime_radius="65 mm", follower=TranslatingRoller("15 mm")).extremes
    rising, falling = sorted(extremes.pressure_angles, key=lambda extreme: -extreme.value)
    assert np.degrees(rising.value) == pytest.approx(21.86, abs=5e-3)
    assert np.degrees(rising.angle) == pytest.approx(146.8, abs=0.05)
    assert np.degrees(falling.value) == pytest.approx(-23.83, abs=5e-3)
    assert extremes.least_convex_radius is not None
    assert 1e3 * extremes.least_convex_radius.value + 15.0 == pytest.approx(40.6, abs=0.06)
    least = least_prime_circle(cycle, TranslatingRoller("15 mm"), pressure_angle="30 deg")
    assert np.ceil(1e3 * least.radius) == 46.0


def inch_moves(cam: str, law: str) -> list[Dwell | Move]:
    """The cams of the package mechanism, rises and returns by one law."""
    if cam == "one rise":
        return [Rise("1 inch", "90 deg", law=law), Dwell("90 deg"), Return("1 inch", "90 deg", law=law), Dwell()]
    return [
        *(Rise("3 inch", "90 deg", law=law), Dwell("15 deg"), Return("3 inch", "90 deg", law=law), Dwell("15 deg")),
        *(Rise("2 inch", "60 deg", law=law), Dwell("15 deg"), Return("2 inch", "60 deg", law=law), Dwell()),
    ]


@pytest.mark.parametrize("case", cases("least_circle"))
def test_least_prime_circles_of_mechanism(case: dict[str, Any]) -> None:
    follower = TranslatingRoller(f"{case['roller']} inch") if "roller" in case else TranslatingFlat()
    units = {"pressure_angle": "deg", "radius_of_curvature": "inch"}
    limits: dict[str, Any] = {name: f"{case[name]} {unit}" for name, unit in units.items() if name in case}
    least = least_prime_circle(Cycle(inch_moves(case["cam"], case["law"]), speed="60 rpm"), follower, **limits)
    assert least.proven
    assert 0 <= least.radius / 0.0254 - case["radius"] < 1e-4


def test_an_eccentric_prime_circle_of_mechanism_is_too_small() -> None:
    """At the package's radius the angle is above the limit for which it was sought."""
    case = numbers()["least_circle"][0]["eccentric"]
    cycle = Cycle(inch_moves("two rises", "cycloidal"), speed="60 rpm")
    follower = TranslatingRoller(f"{case['roller']} inch", f"{case['offset']} inch")
    theirs = DiscCam(cycle, prime_radius=f"{case['radius']} inch", follower=follower)
    steepest = np.degrees(theirs.extremes.greatest_pressure_angle.value)
    assert steepest == pytest.approx(case["true_angle"], abs=5e-4)
    least = least_prime_circle(cycle, follower, pressure_angle=f"{case['pressure_angle']} deg")
    assert least.radius / 0.0254 == pytest.approx(case["true_radius"], abs=1e-6)
