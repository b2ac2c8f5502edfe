"""Cams of others: places, angles, forces and sizes, and assignments of universities."""

import json
from math import degrees, pi, radians, sqrt
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from optlaws import (
    CamForces,
    Cycle,
    DiscCam,
    Dwell,
    EnergyFluctuation,
    Follower,
    Move,
    Return,
    Rise,
    TranslatingFlat,
    TranslatingRoller,
    best_offset,
    catalogue,
    energy_fluctuation,
    least_prime_circle,
    least_spring,
)
from tests.documents import ROOT
from tests.external.published import REFERENCE, cases, numbers

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
    segments = [
        Dwell("10 deg"),
        Rise("10 mm", "55 deg", law="3-4-5"),
        Dwell("30 deg"),
        Rise("40 mm", "115 deg", law="3-4-5"),
    ]
    cycle = Cycle([*segments, Return("50 mm", "140 deg", law="3-4-5"), Dwell("10 deg")], speed="120 rpm")
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


# --- assignments ---


DATA = json.loads((ROOT / "tests" / "reference" / "university_cams.json").read_text(encoding="utf-8"))
PRINT, EXAM = DATA["assignment"], DATA["exam"]


def moves(name: str) -> list[Dwell | Move]:
    law = "cycloidal"
    if name == "SV":
        fall: list[Dwell | Move] = [
            Return("20 mm", "50 deg", law=law),
            Dwell("10 deg"),
            Return("20 mm", "85 deg", law=law),
        ]
        return [Rise("40 mm", "100 deg", law=law), *fall, Dwell()]
    return [
        *(Dwell("60 deg"), Rise("30 mm", "120 deg", law=law), Dwell("20 deg")),
        *(Return("30 mm", "80 deg", law=law), Dwell()),
    ]


def process(table: list[list[float]]) -> dict[str, Any]:
    return {"over": "master", "force": [(f"{place} deg", f"{value} N") for place, value in table]}


def cam_of(name: str) -> DiscCam:
    case = DATA["forces"][name]
    roller = TranslatingRoller(f"{case['roller']} mm", offset=f"{case['offset']} mm")
    cycle = Cycle(moves(name), speed=f"{case['rpm']} rpm")
    return DiscCam(cycle, prime_radius=f"{case['prime_circle']} mm", follower=roller)


def forces_of(name: str) -> CamForces:
    case = DATA["forces"][name]
    drive = {"mass": f"{case['mass']} kg", "stiffness": f"{case['stiffness']} N/mm", "preload": f"{case['preload']} N"}
    return CamForces(cam_of(name), drive=drive, process=process(case["process"]))


@pytest.fixture(scope="module")
def assignment() -> CamForces:
    return forces_of("KUL-18a")


@pytest.mark.parametrize("name", DATA["forces"])
def test_contact_forces_under_a_process(name: str) -> None:
    case, forces = DATA["forces"][name], forces_of(name)
    # at a jump the program takes the later value or the earlier one, as its loads were typed
    places = [place for place, _ in case["process"]]
    jumps = [place for place in places if places.count(place) == 2]
    smooth = ~np.isin(case["deg"], jumps)
    ours = np.asarray(forces.contact_force(np.radians(case["deg"])))
    assert_allclose(ours[smooth], np.array(case["normal_force"])[smooth], rtol=1e-11)
    contact = forces.contact
    (least, least_at), (greatest, greatest_at) = case["least"], case["greatest"]
    # 36,000 samples meet neither extreme: a sample is a hundredth of a degree
    assert -1e-9 <= least - contact.low < 0.04
    assert -1e-9 <= contact.high - greatest < 0.04
    assert abs(degrees(contact.least_at) - least_at) < 0.011
    assert abs(degrees(contact.most_at) - greatest_at) < 0.011
    assert not forces.lifts_off


def test_the_best_eccentricity() -> None:
    best = best_offset(Cycle(moves("KUL-18a"), speed="30 rpm"), "61 mm", TranslatingRoller("42 mm"))
    assert best.proven
    assert 1e3 * best.offset == pytest.approx(PRINT["offset"], abs=0.005)
    assert degrees(best.pressure_angle) == pytest.approx(PRINT["pressure_angle"], abs=1e-3)
    rising, falling = (extreme.value for extreme in best.cam.extremes.pressure_angles)
    assert -rising == pytest.approx(falling, rel=1e-9)
    # the printed one is a hundredth of a millimetre off, and so no better
    assert cam_of("KUL-18a").extremes.greatest_pressure_angle.low > best.lower_bound


@pytest.mark.parametrize("rpm", ["30", "60"])
def test_the_spring_of_least_contact_force(rpm: str) -> None:
    """The printed spring is the last of a grid before ours, on the line of springs that give 300 N at 15 mm."""
    cam, table = cam_of("KUL-18a"), process(PRINT["process"])
    moved: dict[str, Any] = {"drive": {"mass": "18 kg"}, "process": table}
    spring = least_spring(cam, speeds=(f"{rpm} rpm",) * 2, greatest="contact", **moved)
    stiffness, preload = PRINT["springs"][rpm]
    assert stiffness + 0.015 * 1e3 / 15 / 10 > 1e-3 * spring.stiffness > stiffness
    assert spring.preload + 0.015 * spring.stiffness == pytest.approx(300.0, abs=1e-6)
    assert preload + 15 * stiffness == pytest.approx(300.0)
    assert spring.margin > -1e-9
    drive = {"mass": "18 kg", "stiffness": f"{stiffness} N/mm", "preload": f"{preload} N"}
    printed = CamForces(cam, speed=f"{rpm} rpm", drive=drive, process=table).contact
    assert printed.most == pytest.approx(spring.greatest, rel=1e-9)
    assert spring.lower_bound <= printed.high * (1 + 1e-9)


def test_mean_power_work_above_the_mean_and_flywheel(assignment: CamForces) -> None:
    energy = energy_fluctuation(assignment)
    assert energy.energy == pytest.approx(PRINT["energy"], abs=0.05)
    assert degrees(energy.fastest_at) == pytest.approx(PRINT["fastest_at"], abs=0.05)
    assert degrees(energy.slowest_at) == pytest.approx(PRINT["slowest_at"], abs=0.05)
    assert energy.flywheel(PRINT["irregularity"]) == pytest.approx(PRINT["flywheel"], abs=0.05)
    # the print adds samples, and counts half a sample too much of each jump
    samples = np.radians(np.arange(36000) / 100)
    torque = np.asarray(assignment.shaft_torque(samples))
    torque[24000] = assignment.shaft_torque(radians(240.0) - 1e-9)
    assert torque.mean() == pytest.approx(PRINT["mean_torque"], abs=5e-5)
    assert pi * torque.mean() == pytest.approx(PRINT["mean_power"], abs=7e-5)
    # of exact integrals: what the process takes, by hand, as spring and inertia give back what they took
    low, high = assignment.mean_torque
    assert low <= energy.mean_torque <= high
    rise = np.polynomial.legendre.leggauss(60)
    at = np.radians(90.0 + 30.0 * rise[0])  # 60 to 120 deg, where the pull grows
    pull = 4.0 * (np.degrees(at) - 45.0)
    slope = 0.03 / radians(120.0) * (1 - np.cos(2 * pi * (at - radians(60.0)) / radians(120.0)))
    pulled = float(rise[1] @ (pull * slope)) * radians(30.0)

    def way(first: float, last: float) -> float:
        return float(assignment.cam.displacement(radians(last)) - assignment.cam.displacement(radians(first)))

    taken = 550.0 * way(120, 170) + 300.0 * way(170, 240) - pulled
    assert 2 * pi * energy.mean_torque == pytest.approx(taken, rel=1e-9)


def test_vibration_after_the_return(assignment: CamForces) -> None:
    damping, frequency = PRINT["damping"], 2 * pi * PRINT["periods"]
    law = catalogue["cycloidal"].law
    approximation = (2 * pi) ** 2 / frequency**3 / sqrt(1 - damping**2)
    assert approximation == pytest.approx(PRINT["approximation"], abs=5e-9)
    # the print's input is a sample of 1/8000 late: the tutorial does so too, and has all its digits
    residual = Follower(frequency, damping).response(law).residual_displacement
    assert residual == pytest.approx(PRINT["residual"], rel=1e-3)
    periods = 2.0 / (radians(80.0) / pi / PRINT["periods"])
    steady = Follower(2 * pi * periods / 3, damping).cycle(law, dwell=1 / 6, fall_duration=2 / 3, rest=7 / 6)
    angles = np.radians(np.arange(36000) / 100)
    off = 0.03 * steady(np.mod(np.degrees(angles) - 60.0, 360.0) / 120.0) - assignment.cam.displacement(angles)
    link = PRINT["stiffness_of_link"] * off / np.cos(assignment.cam.pressure_angle(angles))
    assert (assignment.contact_force(angles) + link).min() == pytest.approx(PRINT["least_with_vibration"], abs=2e-3)


def test_exam_notes() -> None:
    """Of a preload for a weight that hangs the print has the weight alone: the first rise asks for 56 N more."""
    law = "3-4-5"
    segments = [Dwell("10 deg"), Rise("10 mm", "55 deg", law=law), Dwell("30 deg"), Rise("40 mm", "115 deg", law=law)]
    cycle = Cycle([*segments, Return("50 mm", "140 deg", law=law), Dwell("10 deg")], speed="120 rpm")
    cam = DiscCam(cycle, prime_radius="50 mm", follower=TranslatingRoller("15 mm"))
    weight, stiffness = EXAM["mass"] * EXAM["gravity"], EXAM["stiffness"]
    assert weight == pytest.approx(EXAM["preload"], abs=0.05)
    times = np.linspace(0.0, 0.5, 200001)
    missing = float((weight - 1e3 * stiffness * cycle(times) - EXAM["mass"] * cycle(times, 2)).max())
    drive = {"mass": f"{EXAM['mass']} kg", "gravity": f"{-weight} N"}
    spring = least_spring(cam, drive=drive, speeds=("120 rpm", "120 rpm"), stiffness=f"{stiffness} N/mm")
    assert spring.preload == pytest.approx(missing, rel=1e-6)
    # friction in the guide makes the contact force another, but not where it ends
    friction = {"guide": EXAM["friction"], "overhang": "60 mm", "length": "80 mm"}
    sprung = drive | {"stiffness": f"{stiffness} N/mm", "preload": f"{spring.preload!r} N"}
    assert abs(CamForces(cam, drive=sprung, friction=friction).contact.least) < 1e-6
    assert missing - weight == pytest.approx(56.2, abs=0.05)
    speed = 4 * pi
    printed = EnergyFluctuation(speed, EXAM["mean_power"], EXAM["mean_torque"], EXAM["energy"], 0.0, 0.0)
    assert printed.mean_torque * speed == pytest.approx(printed.mean_power, abs=0.5)
    assert printed.flywheel(EXAM["irregularity"]) == pytest.approx(EXAM["flywheel"], abs=0.005)
