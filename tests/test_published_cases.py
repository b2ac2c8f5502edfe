"""Figures that others published or computed by programs of their own, with their sources, against ours."""

import json
from math import pi
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from optlaws import (
    CamForces,
    Chebyshev,
    Cycle,
    DiscCam,
    Dwell,
    Functional,
    InfeasibleProblem,
    Move,
    Pieces,
    Problem,
    Return,
    Rise,
    TranslatingFlat,
    TranslatingRoller,
    at_most,
    catalogue,
    limit,
    drive_torque,
    peak,
    rms,
    least_base_circle,
    synthesize,
    trapezoid,
)

CAMS = json.loads((Path(__file__).parent / "reference" / "published_cams.json").read_text(encoding="utf-8"))
LEUVEN = [name for name in CAMS if name != "about"]


def _cycloids(name: str) -> list[Dwell | Move]:
    law = "cycloidal"
    if name == "SV":
        falls: list[Dwell | Move] = [
            Return("20 mm", "50 deg", law=law),
            Dwell("10 deg"),
            Return("20 mm", "85 deg", law=law),
        ]
        return [Rise("40 mm", "100 deg", law=law), *falls, Dwell()]
    rise, fall = Rise("30 mm", "120 deg", law=law), Return("30 mm", "80 deg", law=law)
    return [Dwell("60 deg"), rise, Dwell("20 deg"), fall, Dwell()]


@pytest.fixture(scope="module", params=LEUVEN)
def leuven(request: pytest.FixtureRequest) -> tuple[dict[str, Any], DiscCam]:
    """A cam of the MATLAB program matcam, and the same of ours."""
    case = CAMS[request.param]
    roller = TranslatingRoller(f"{case['rof']} mm", offset=f"{case['exc']} mm")
    cycle = Cycle(_cycloids(request.param), speed=f"{case['rpm']} rpm")
    return case, DiscCam(cycle, base_radius=f"{case['bcr'] + case['rof']} mm", follower=roller)


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
    cam = DiscCam(Cycle(_cycloids("SV"), speed="600 rpm"), base_radius="70 mm", follower=roller)
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
    extremes = DiscCam(cycle, base_radius="65 mm", follower=TranslatingRoller("15 mm")).extremes
    rising, falling = sorted(extremes.pressure_angles, key=lambda extreme: -extreme.value)
    assert np.degrees(rising.value) == pytest.approx(21.86, abs=5e-3)
    assert np.degrees(rising.angle) == pytest.approx(146.8, abs=0.05)
    assert np.degrees(falling.value) == pytest.approx(-23.83, abs=5e-3)
    assert extremes.least_convex_radius is not None
    assert 1e3 * extremes.least_convex_radius.value + 15.0 == pytest.approx(40.6, abs=0.06)
    least = least_base_circle(cycle, TranslatingRoller("15 mm"), pressure_angle="30 deg")
    assert np.ceil(1e3 * least.radius) == 46.0


@pytest.mark.parametrize(
    ("name", "B", "C", "rms", "J"),
    [
        ("simple harmonic", 1.57, 4.93, 3.49, 15.5),
        ("cycloidal", 2, 6.28, 4.44, 39.5),
        ("3-4-5", 1.87, 5.77, 4.14, 60),
    ],
)
def test_table_of_laws_of_leuven(name: str, B: float, C: float, rms: float, J: float) -> None:
    constants = catalogue[name].law.constants
    assert_allclose([constants.B.value, constants.C.value], [B, C], rtol=4e-3)
    assert constants.rms_c == pytest.approx(rms, abs=6e-3)
    if np.isfinite(constants.J.value):  # their harmonic law leaves out the impulses at its ends
        assert constants.J.value == pytest.approx(J, rel=2e-3)


def _inch(law: str) -> list[Dwell | Move]:
    return [Rise("1 inch", "90 deg", law=law), Dwell("90 deg"), Return("1 inch", "90 deg", law=law), Dwell()]


TWO_RISES = [
    *(Rise("3 inch", "90 deg", law="cycloidal"), Dwell("15 deg"), Return("3 inch", "90 deg", law="cycloidal")),
    *(Dwell("15 deg"), Rise("2 inch", "60 deg", law="cycloidal"), Dwell("15 deg")),
    *(Return("2 inch", "60 deg", law="cycloidal"), Dwell()),
]


@pytest.mark.parametrize(
    ("segments", "follower", "limits", "theirs"),
    [
        (_inch("cycloidal"), TranslatingRoller("0.5 inch"), {"pressure_angle": "30 deg"}, 1.7509140),
        (_inch("cycloidal"), TranslatingFlat(), {"radius_of_curvature": "0.25 inch"}, 1.8926251),
        (_inch("simple harmonic"), TranslatingFlat(), {"radius_of_curvature": "0.25 inch"}, 1.2499421),
        (TWO_RISES, TranslatingRoller("1 inch"), {"pressure_angle": "30 deg"}, 5.6769934),
    ],
)
def test_least_prime_circles_of_mechanism(
    segments: list[Dwell | Move], follower: TranslatingRoller | TranslatingFlat, limits: dict[str, str], theirs: float
) -> None:
    """Of the package mechanism 1.1.10 (gabemorris12/mechanism, b68554a): found on a grid, and so a little too small."""
    least = least_base_circle(Cycle(segments, speed="60 rpm"), follower, **limits)  # type: ignore[arg-type]
    assert least.proven
    assert 0 <= least.radius / 0.0254 - theirs < 1e-4


def test_an_eccentric_prime_circle_of_mechanism_is_too_small() -> None:
    """The package's 6.5238865 inch with an offset of 0.5 inch leave 30.129 deg where 30 deg are the limit."""
    cycle, follower = Cycle(TWO_RISES, speed="60 rpm"), TranslatingRoller("1 inch", "0.5 inch")
    theirs = DiscCam(cycle, base_radius="6.5238865 inch", follower=follower)
    assert np.degrees(theirs.extremes.greatest_pressure_angle.value) == pytest.approx(30.129, abs=5e-4)
    assert least_base_circle(cycle, follower, pressure_angle="30 deg").radius / 0.0254 == pytest.approx(
        6.5621193, abs=1e-6
    )


class Exercise(NamedTuple):
    """Rise, dwell and return by one law, with the peaks of both moves as printed; m/s, m/s²."""

    law: str
    stroke: str
    angles: tuple[str, str]
    speed: str
    accelerations: tuple[float, float]
    velocities: tuple[float, float] | None = None


@pytest.mark.parametrize(
    "exercise",
    [
        Exercise("simple harmonic", "50 mm", ("120 deg", "60 deg"), "100 rpm", (6.17, 24.67), (0.39, 0.78)),
        Exercise("simple harmonic", "40 mm", ("60 deg", "90 deg"), "300 rpm", (177.65, 78.96)),
        Exercise("parabolic", "25 mm", ("120 deg", "90 deg"), "1000 rpm", (250.0, 444.4)),
    ],
    ids=["Khurmi", "Sarkar, harmonic", "Sarkar, parabolic"],
)
def test_exercises_of_textbooks(exercise: Exercise) -> None:
    (rise, fall), law, stroke = exercise.angles, exercise.law, exercise.stroke
    moves = [Rise(stroke, rise, law=law), Dwell("30 deg"), Return(stroke, fall, law=law), Dwell()]
    peaks = Cycle(moves, speed=exercise.speed).peaks
    assert_allclose([peaks[0].peak(2), peaks[2].peak(2)], exercise.accelerations, rtol=1e-3)
    if exercise.velocities is not None:
        assert_allclose([peaks[0].peak(1), peaks[2].peak(1)], exercise.velocities, atol=7e-3)


def _sine(x: np.ndarray) -> np.ndarray:
    early = 0.43990085 * x - 0.0350062 * np.sin(4 * pi * x)
    later = 0.28004957 + 0.43990085 * x - 0.31505577 * np.cos(4 * pi * x / 3 - pi / 6)
    return np.where(x <= 1 / 8, early, later)


def _trapezoid(x: np.ndarray) -> np.ndarray:
    early = 0.38898448 * x - 0.0309544 * np.sin(4 * pi * x)
    plateau = 2.44406184 * x**2 - 0.22203097 * x + 0.00723407
    later = 1.6110154 * x - 0.0309544 * np.sin(4 * pi * x - pi) - 0.3055077
    return np.select([x <= 1 / 8, x <= 3 / 8], [early, plateau], later)


def test_coefficients_of_saltire() -> None:
    """The page "Cam functions" of Saltire, to the eight digits that it prints."""
    for name, theirs, stop in (("modified sine", _sine, 7 / 8), ("modified trapezoid", _trapezoid, 1 / 2)):
        places = np.linspace(0.0, stop, 201)
        assert_allclose(catalogue[name].law(places), theirs(places), atol=2e-8)


@pytest.mark.parametrize(
    ("name", "B", "C"), [("cycloidal", 2, 6.2832), ("modified sine", 1.7596, 5.5280), ("3-4-5", 1.875, 5.7735)]
)
def test_constants_of_plcopen(name: str, B: float, C: float) -> None:
    """Of lusipad/plcopen, core/test/cam_tests.cpp."""
    constants = catalogue[name].law.constants
    assert_allclose([constants.B.value, constants.C.value], [B, C], rtol=3e-5)


class LeastTime(NamedTuple):
    """A motion from rest to rest under limits, its least time, and where its jerk switches, as shares of the time."""

    stroke: float
    velocity: float
    acceleration: float
    jerk: float
    time: float
    switches: tuple[float, ...]

    def limits(self, time: float) -> dict[str, float]:
        """Limits of velocity, acceleration and jerk over a stroke in a time as limits of B, C and J."""
        shares = self.velocity * time, self.acceleration * time**2, self.jerk * time**3
        return dict(zip("BCJ", np.array(shares) / self.stroke, strict=True))

    def problem(self, time: float) -> Problem:
        B, C, J = (at_most(value) for value in self.limits(time).values())
        breaks = tuple(sorted({0.0, *np.cumsum(self.switches).round(15).tolist(), 0.5}))
        return Problem(order=3, basis=Pieces(breaks, degree=3, continuity=2), minimise="C", B=B, C=C, J=J)


@pytest.mark.parametrize(
    "motion",
    [
        LeastTime(1.0, 1.0, 1.0, 1.0, 3.1748021039, (1 / 4,) * 4),
        LeastTime(2.0, 1.0, 1.0, 1.0, 4.0, (1 / 4,) * 4),
        LeastTime(10.0, 5.0, 10.0, 30.0, 17 / 6, (2 / 17, 1 / 17, 2 / 17, 7 / 17, 2 / 17, 1 / 17, 2 / 17)),
    ],
)
def test_least_times_of_ruckig(motion: LeastTime) -> None:
    """Of pantor/ruckig, test/test_target.cpp: in its time a law keeps all limits, in a thousandth less no law does."""
    constants = synthesize(motion.problem(motion.time * (1 + 1e-9))).law.constants
    for name, value in motion.limits(motion.time).items():
        assert getattr(constants, name).value <= value * (1 + 1e-7)
    with pytest.raises(InfeasibleProblem):
        synthesize(motion.problem(0.999 * motion.time))
    # and no law of any breaks: by the limits over all laws
    quicker = motion.limits(0.999 * motion.time)
    assert quicker["J"] < limit("J") or limit("C", quicker["B"], J=quicker["J"]) > quicker["C"]


@pytest.mark.parametrize(
    ("velocity", "acceleration", "start", "stop", "duration"),
    [(2.0, 1.0, 2.0, 10.0, 6.0), (1.0, 0.25, 2.0, 10.0, 12.0), (4.0, 2.0, 2.0, 10.0, 4.0), (4.0, 2.0, 13.0, 29.0, 6.0)],
)
def test_trapezoids_of_kdl(velocity: float, acceleration: float, start: float, stop: float, duration: float) -> None:
    """Of orocos/orocos_kinematics_dynamics c73370f, velocityprofiletest.cpp."""
    stroke = stop - start
    B = min(velocity * duration / stroke, 2.0)
    law = trapezoid(0.0, 1 - 1 / B, 0.0)
    assert law.constants.C.value == pytest.approx(acceleration * duration**2 / stroke, rel=1e-12)
    assert limit("C", B) == pytest.approx(law.constants.C.value, rel=1e-12)
    places = {(2.0, 6.0): [4.0, 6.0, 8.0, 9.5], (1.0, 12.0): [3.25 + 0.75, 6.0, 8.0, 9.5]}.get((velocity, duration))
    if places is not None:
        times = np.array([2.0, 3.0, 4.0, 5.0]) * duration / 6.0
        assert_allclose(start + stroke * law(times / duration), places, rtol=1e-12)


@pytest.mark.parametrize(
    ("functional", "least"),
    [
        (peak(drive_torque(inertia="1", load="3*a")), 3.3332),
        (rms(drive_torque(inertia="1", load="3*a")), 2.8412),
    ],
)
def test_torque_under_a_load_is_above_its_infimum(functional: Functional, least: float) -> None:
    """The least over all monotone laws with B <= 2.2 and C <= 9 is convex in b² over a, and was computed so."""
    B, C = at_most(2.2), at_most(9.0)
    problem = Problem(order=3, basis=Chebyshev(11), symmetric=False, monotone=True, minimise=functional, B=B, C=C)
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert least <= solution.objective < 1.06 * least
