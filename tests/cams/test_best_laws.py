"""Laws, offsets and sizes that are best for their cam: their limits, bounds from elsewhere, and what is refused."""

from __future__ import annotations

import re
from dataclasses import replace
from math import degrees, sqrt
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import linprog, minimize_scalar

from optlaws import (
    CamForces,
    CamMotion,
    Cycle,
    DiscCam,
    Dwell,
    InfeasibleProblem,
    InputError,
    OscillatingFlat,
    OscillatingRoller,
    Return,
    Rise,
    SolverFailure,
    Status,
    TranslatingFlat,
    TranslatingRoller,
    best_cam,
    best_offset,
    best_prime_circle,
    greatest_roller,
    least_prime_circle,
    smoothstep,
)
from optlaws.verification import verify
from tests.cams.placed import cycle_of
from tests.internals.cams import (
    PRESSURE,
    CamFollower,
    SlidingRoller,
    SwingingRoller,
    curvature_of,
    linear_limits,
)
from tests.internals.formulas import NUMPY, evaluate
from tests.internals.motion import Piece
from tests.internals.numerics import Jet

Array = NDArray[np.float64]
PRESS = Cycle([Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()], period="0.3 s")
VALVE = Cycle([Rise("10 mm", "70 deg"), Return("10 mm", "70 deg"), Dwell()], speed="3000 rpm")
ROCKER = Cycle([Rise("25 deg", "110 deg"), Dwell("60 deg"), Return("25 deg", "130 deg"), Dwell()], speed="120 rpm")
SWING = Cycle([Rise("25 deg", "60 deg"), Return("25 deg", "70 deg"), Dwell()], speed="120 rpm")
ARM = OscillatingRoller("14 mm", "110 mm", "140 mm")


def test_a_limit_of_the_pressure_angle_is_reached_and_proven_optimal() -> None:
    best = best_cam(PRESS, "50 mm", TranslatingRoller("12 mm"), pressure_angle="25 deg")
    assert best.status is Status.OPTIMAL
    assert best.lower_bound == pytest.approx(best.objective, rel=1e-8)
    assert best.objective > PRESS.objective * 1.05
    assert np.degrees(best.cam.extremes.greatest_pressure_angle.value) == pytest.approx(25.0, abs=1e-6)
    wide = best_cam(PRESS, "50 mm", TranslatingRoller("12 mm"), pressure_angle="60 deg")
    assert wide.objective == pytest.approx(PRESS.objective, rel=1e-9)


def test_least_acceleration_under_a_pressure_angle_is_that_of_a_linear_program_on_places() -> None:
    """Polynomials of the same degree at 160 places: an independent program that can only be better, and hardly is."""
    best = best_cam(PRESS, "50 mm", TranslatingRoller("12 mm"), pressure_angle="25 deg")
    stroke, angle, limit = 0.035, np.radians(100.0), np.tan(np.radians(25.0))
    terms, k = 16, 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 161))
    cheb = [np.polynomial.Chebyshev.basis(n, domain=[0.0, 1.0]) for n in range(terms)]
    a, b, c = (np.array([one.deriv(nu)(k) if nu else one(k) for one in cheb]).T for nu in range(3))
    ones, zeros = np.ones((len(k), 1)), np.zeros((len(k), 1))
    upper = np.vstack([
        np.hstack([c, -ones]), np.hstack([-c, -ones]),
        np.hstack([stroke * b / angle + limit * stroke * a, zeros]),
        np.hstack([-stroke * b / angle + limit * stroke * a, zeros]),
        np.hstack([a, zeros]), np.hstack([-a, zeros]),
    ])  # fmt: skip
    most = np.concatenate([np.zeros(2 * len(k)), np.full(2 * len(k), limit * 0.085), np.ones(len(k)), np.zeros(len(k))])
    rows = [[one.deriv(nu)(x) if nu else one(x) for one in cheb] for nu in range(3) for x in (0.0, 1.0)]
    ends = np.hstack([np.array(rows), np.zeros((6, 1))])
    optimum = linprog(np.eye(terms + 1)[-1], upper, most, ends, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0], bounds=(None, None))
    assert optimum.fun is not None
    sized = optimum.fun * stroke / (0.3 * 100.0 / 360.0) ** 2
    assert sized <= best.objective * (1 + 1e-7)
    assert best.objective == pytest.approx(sized, rel=2e-2)


@pytest.mark.long
def test_the_least_prime_circle_of_all_laws_meets_its_bound() -> None:
    roller = TranslatingRoller("12 mm", "6 mm")
    best = best_prime_circle(PRESS, roller, pressure_angle="30 deg")
    assert best.least.proven
    assert best.lower_bound <= best.least.radius
    assert best.least.radius == pytest.approx(best.lower_bound, rel=1e-7)
    assert best.least.radius < 0.6 * 0.0586  # that of the law of least acceleration
    with pytest.raises(InfeasibleProblem, match="make the prime circle larger") as refused:
        best_cam(PRESS, f"{0.999 * best.least.radius!r} m", roller, pressure_angle="30 deg")
    assert refused.value.proof is not None
    assert "Window" not in str(refused.value).splitlines()[0]  # the problem stands below it


def test_a_flat_face_keeps_its_radius_by_a_law_made_for_it() -> None:
    best = best_prime_circle(VALVE, TranslatingFlat(), radius_of_curvature="3 mm")
    assert best.least.radius == pytest.approx(best.lower_bound, rel=1e-7)
    cam = best_cam(VALVE, "20 mm", TranslatingFlat(), radius_of_curvature="3 mm")
    assert cam.status is Status.OPTIMAL
    assert cam.cam.extremes.least_convex_radius.value == pytest.approx(0.003, rel=1e-6)


def test_an_arm_with_a_wide_limit_has_the_laws_without_it() -> None:
    best = best_cam(ROCKER, "65 mm", ARM, pressure_angle="50 deg")
    assert best.status is Status.OPTIMAL
    assert best.objective == pytest.approx(ROCKER.objective, rel=1e-9)


@pytest.mark.long
def test_an_arm_has_laws_and_a_bound_near_them() -> None:
    best = best_cam(ROCKER, "65 mm", ARM, pressure_angle="26 deg")
    assert best.lower_bound <= best.objective <= 1.002 * best.lower_bound
    assert np.degrees(best.cam.extremes.greatest_pressure_angle.high) <= 26.0 + 1e-6
    with pytest.raises(SolverFailure, match=r"no law was found .* make the prime circle larger"):
        best_cam(ROCKER, "65 mm", ARM, pressure_angle="10 deg")


def test_where_the_jerk_is_too_little_for_a_cam_a_jerk_that_will_do_is_said() -> None:
    moves = [Rise("24 deg", "75 deg"), Dwell("190 deg"), Return(duration="80 deg"), Dwell()]
    arm = OscillatingRoller("0.5 in", arm="4.5 in", pivot_distance="5.75 in")
    jerk, refused = "6000 rad/s^3", 0
    while refused < 3:  # the rise, the return, and a rounding
        cycle = Cycle(moves, speed="90 rpm", limits={"jerk": jerk})
        try:
            best = best_cam(cycle, "2.6 in", arm, pressure_angle="35 deg")
            break
        except SolverFailure as error:
            stated = re.search(r"limit of its jerk is (.*), and laws are found from ([\d.]+) rad/s\^3 on", str(error))
            assert stated is not None
            assert stated[1] == jerk
            jerk, refused = f"{np.ceil(float(stated[2]))} rad/s^3".replace(".0 ", " "), refused + 1
    assert refused > 0
    assert best.cam.extremes.greatest_pressure_angle.high <= np.radians(35.0) * (1.0 + 1e-6)


def test_a_curvature_that_no_law_has_at_rest_is_refused_before_any_search(monkeypatch: pytest.MonkeyPatch) -> None:
    sharp = Cycle([Rise("30 mm", "70 deg"), Return("30 mm", "70 deg"), Dwell()], period="1 s")
    assert sharp.solutions
    monkeypatch.setattr("optlaws.cams.best_laws.synthesize", lambda *_, **__: pytest.fail("it was sought"))
    with pytest.raises(InfeasibleProblem, match=r"the profile has 17 mm, whatever the law: make the prime circle"):
        best_cam(sharp, "25 mm", TranslatingRoller("8 mm"), radius_of_curvature="20 mm")


@pytest.mark.parametrize(
    ("rise", "radius", "reason"), [("40 deg", "24 mm", "so short a turn"), ("60 deg", "12 mm", "")]
)
def test_a_path_that_bends_too_little_for_its_turn_is_refused(rise: str, radius: str, reason: str) -> None:
    cycle = Cycle([Rise("35 mm", rise), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()], speed="200 rpm")
    given: Any = {"radius_of_curvature": radius}
    if reason:
        with pytest.raises(InfeasibleProblem, match=reason):
            best_cam(cycle, "30 mm", TranslatingRoller("5 mm"), **given)
    else:
        assert best_cam(cycle, "30 mm", TranslatingRoller("5 mm"), **given).status is Status.OPTIMAL


@pytest.mark.sample(3)
@pytest.mark.parametrize("turn", [20.0, 45.0, 90.0, 150.0])
def test_an_arc_of_the_least_radius_is_just_in_reach(turn: float) -> None:
    """Between two dwells the arc that touches the outer one ends on a radius; a smaller inner one is out of reach."""
    far, bend = 0.065, 0.045
    centre, angle = far - bend, np.radians(turn)
    least = float(centre * np.cos(angle) + np.sqrt(bend**2 - (centre * np.sin(angle)) ** 2))
    for near, out in ((least * (1.0 + 1e-6), False), (least * (1.0 - 1e-6), True)):
        moves = [Rise(f"{1e3 * (far - near)!r} mm", f"{turn} deg", law="cycloidal"), Dwell("90 deg"), Return(law="345")]
        cycle = Cycle(moves, period="1 s")
        contact = DiscCam(cycle, f"{1e3 * near!r} mm", TranslatingRoller("5 mm")).contact
        limit = curvature_of(cycle.pieces[0], contact, bend - 0.005, cycle.duration)
        assert limit is not None
        assert limit.is_out_of_reach() is out


def test_a_curvature_that_the_laws_have_costs_nothing() -> None:
    kept = best_cam(PRESS, "60 mm", TranslatingRoller("8 mm"), radius_of_curvature="8 mm")
    assert kept.objective == pytest.approx(PRESS.objective, rel=1e-9)


SHORT = Cycle(
    [Rise("35 mm", "160 deg", law="cycloidal"), Dwell("50 deg"), Return("35 mm", "100 deg"), Dwell()],
    period="0.3 s",
    degree=7,
)
BENT = {
    "short": (SHORT, "50 mm", TranslatingRoller("12 mm"), {"radius_of_curvature": "37.5 mm"}),
    "both": (
        PRESS,
        "50 mm",
        TranslatingRoller("12 mm"),
        {"radius_of_curvature": "37.5 mm", "pressure_angle": "27 deg"},
    ),
    "offset": (PRESS, "45 mm", TranslatingRoller("12 mm", "-6 mm"), {"radius_of_curvature": "32.8 mm"}),
    "arm": (SWING, "65 mm", ARM, {"radius_of_curvature": "30 mm"}),
}


@pytest.mark.parametrize(
    "case", ["short", *(pytest.param(name, marks=pytest.mark.long) for name in ("both", "offset", "arm"))]
)
def test_curvature_under_a_roller_is_imposed_and_bounded(case: str) -> None:
    cycle, base, follower, limits = BENT[case]
    best = best_cam(cycle, base, follower, **limits)  # type: ignore[arg-type]
    expected = 1e-3 * float(limits["radius_of_curvature"].split()[0])
    assert best.cam.extremes.least_convex_radius.low == pytest.approx(expected, rel=1e-7)
    if "pressure_angle" in limits:
        assert np.degrees(best.cam.extremes.greatest_pressure_angle.high) <= 27.0 + 1e-6
    assert DiscCam(cycle, base, follower).extremes.least_convex_radius.high < 0.999 * expected
    assert cycle.objective * 1.0001 < best.lower_bound <= best.objective
    assert best.status is Status.OPTIMAL
    assert any(solution.power_certificate for solution in best.solutions)
    assert all(verify(solution.to_dict()).proven for solution in best.solutions)


@pytest.mark.parametrize("turning", [1.0, -1.0])
@pytest.mark.parametrize("kind", ["slide", "arm"])
def test_the_limit_of_a_law_is_reached_where_the_pitch_curve_bends_as_much_as_it_may(kind: str, turning: float) -> None:
    roller = {
        "slide": SlidingRoller(turning, 0.0, 0.05, 0.012, offset=0.006),
        "arm": SwingingRoller(turning, 0.0, 0.5, 0.014, arm=0.11, distance=0.14),
    }[kind]
    stroke = 0.035 if kind == "slide" else 0.4
    piece = Piece(0.0, 0.3, 0.1 * stroke, -0.8 * stroke, smoothstep(3))
    curvature = curvature_of(piece, roller, 0.03, 1.0)
    assert curvature is not None
    rng = np.random.default_rng(5)
    at, rate = rng.uniform(0.0, 1.0, 200), rng.uniform(0.0, 2.0, 200)
    s, slope = piece.offset + piece.stroke * at, piece.stroke * rate / (2 * np.pi * piece.duration)

    def bent(bend: float) -> Array:
        return np.asarray(roller.curvature(Jet((s, slope, 0.5 * bend * np.ones(200)))).terms[0])

    # the curvature is affine in s''
    none, one = bent(0.0), bent(1.0)
    least = (1.0 / (0.03 + roller.roller) - none) / (one - none)
    c = least * (2 * np.pi * piece.duration) ** 2 / piece.stroke
    limit = curvature.window().motion
    assert limit is not None
    assert np.abs(np.asarray(evaluate(limit.formula, {"a": at, "b": rate, "c": c}, NUMPY))).max() < 1e-9


def test_what_has_no_best_law_says_the_remedy() -> None:
    given = Cycle([Rise("35 mm", "120 deg", law="cycloidal"), Return(law="cycloidal")], period="1 s")
    with pytest.raises(InputError, match="leave the law of a move out"):
        best_cam(given, "50 mm", TranslatingRoller("12 mm"), pressure_angle="30 deg")
    with pytest.raises(InfeasibleProblem, match=r"no law from 0\.\S+ s \(210 deg\) on") as refused:
        best_cam(replace(SHORT, limits={}), "20 mm", TranslatingRoller("12 mm"), pressure_angle="12 deg")
    assert refused.value.tried.endswith("k = 0 is at 0.175 s (210 deg), k = 1 at 0.258333 s (310 deg)")
    with pytest.raises(InputError, match="pressure_angle='30 deg'"):
        best_cam(PRESS, "50 mm", TranslatingRoller("12 mm"))
    with pytest.raises(InputError, match=r"takes the limit radius_of_curvature='5 mm'"):
        best_prime_circle(VALVE, TranslatingFlat(), pressure_angle="30 deg")
    with pytest.raises(InputError, match="flat faces on slides"):
        best_prime_circle(ROCKER, OscillatingFlat("150 mm"), radius_of_curvature="3 mm")


@pytest.mark.parametrize("share", [0.4, 0.9, 1.6])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_lines_lie_where_an_arm_keeps_its_limit_or_breaks_it(share: float, sign: float) -> None:
    contact = SwingingRoller(1.0, 0.0, 0.5, 0.014, arm=0.11, distance=0.14)
    piece = Piece(0.0, 0.3, 0.0, 0.4, smoothstep(3))
    angle, a = 2 * np.pi * 0.3, np.linspace(0.0, 1.0, 301)
    psi = 0.5 + 0.4 * a
    allowed = contact.distance / contact.arm * (share * np.sin(psi) + sign * np.cos(psi)) - sign
    for below in (True, False):
        limits = linear_limits(piece, contact, {PRESSURE: share}, 1.0, below=below)
        seen = [limit for limit in limits if limit.factors[1] * sign > 0]
        # the greatest sign s' that each line allows at a place
        lines = np.array([(one.most - one.factors[0] * a) / abs(one.factors[1]) for one in seen]) * 0.4 / angle
        most = lines.min(axis=0)
        assert ((most <= allowed + 1e-12) if below else (most >= allowed - 1e-12)).all()
        assert np.abs(lines - allowed).min(axis=1).max() < 1e-3


def test_the_least_power_of_a_cam_is_the_least_torque_at_its_shaft() -> None:
    drive = {"mass": "3 kg", "stiffness": "1.95 N/mm", "preload": "25 N"}
    limits = {"acceleration": "27.87 m/s^2", "jerk": "4201.4 m/s^3"}
    moves = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()]
    cycle = Cycle(moves, speed="200 rpm", degree=5, drive=drive, limits=limits)
    roller, rate = TranslatingRoller("12 mm"), 2.0 * np.pi * 200.0 / 60.0
    best = best_cam(replace(cycle, minimise="power"), "58 mm", roller, pressure_angle="28 deg")
    usual = best_cam(cycle, "58 mm", roller, pressure_angle="28 deg")
    torques = [CamForces(each.cam, speed="200 rpm", drive=drive).torque.peak for each in (best, usual)]
    assert torques[0] == pytest.approx(best.objective / rate, rel=1e-6)
    assert best.lower_bound / rate <= torques[0] < 0.98 * torques[1]
    assert np.degrees(best.cam.extremes.greatest_pressure_angle.value) <= 28.0 * (1.0 + 1e-6)
    assert best.status.value == "local"
    # in the dwell above, whatever the laws: these have the least acceleration of those that take no more elsewhere
    slow = replace(cycle, speed="150 rpm", minimise="force")
    pressed = best_cam(slow, "50 mm", roller, pressure_angle="28 deg")
    assert pressed.lower_bound == pytest.approx(pressed.objective, rel=1e-12) == 25.0 + 1.95 * 35.0


def test_the_least_prime_circle_keeps_a_radius_of_curvature_beside_the_pressure_angle() -> None:
    roller = TranslatingRoller("12 mm")
    limits = {"acceleration": "28 m/s^2", "jerk": "4300 m/s^3"}
    cycle = replace(PRESS, limits=limits, degree=5)
    one = best_prime_circle(cycle, roller, pressure_angle="30 deg")
    both, wide = (
        best_prime_circle(cycle, roller, pressure_angle="30 deg", radius_of_curvature=radius)
        for radius in ("5 mm", "45 mm")
    )
    assert both.least.radius == pytest.approx(one.least.radius, rel=1e-7)
    assert both.lower_bound == wide.lower_bound == pytest.approx(one.lower_bound, rel=1e-9)
    assert wide.least.radius > 1.05 * wide.lower_bound
    assert wide.least.cam.extremes.least_convex_radius.value >= 0.045 * (1.0 - 1e-9)


# --- the best offset of a slide ---


ROLLER = TranslatingRoller("12 mm", offset="5 mm")
MOTIONS: dict[str, Cycle | CamMotion] = {
    "up and down": cycle_of("30 mm"),
    "raised": Cycle([Rise("20 mm", "60 deg", law="345"), Return(law="modified sine")], start="7 mm", period="1 s"),
    "a return": CamMotion.of_law("cycloidal", "40 mm", "120 deg", "return"),
    "a rise, parabolic": CamMotion.of_law("parabolic", "40 mm", "90 deg"),
}


@pytest.mark.parametrize("turning", ["counterclockwise", "clockwise"])
@pytest.mark.parametrize("name", MOTIONS)
def test_no_offset_has_a_smaller_greatest_pressure_angle(name: str, turning: str) -> None:
    motion = MOTIONS[name]
    best = best_offset(motion, "60 mm", ROLLER, turning=turning)  # type: ignore[arg-type]
    course = best.cam.displacement
    angles = np.linspace(*course.interval, 40001)
    s, slope = np.asarray(course(angles)) - course.range[0], np.asarray(course(angles, 1))
    sign = 1.0 if turning == "counterclockwise" else -1.0

    def greatest(offset: float) -> float:
        return float(np.abs((slope - sign * offset) / (sqrt(0.06**2 - offset**2) + s)).max())

    brute = minimize_scalar(greatest, bounds=(-0.0599, 0.0599), method="bounded", options={"xatol": 1e-12})
    assert best.proven
    assert best.offset == pytest.approx(brute.x, abs=1e-8)
    assert np.tan(best.pressure_angle) == pytest.approx(brute.fun, rel=1e-7)
    assert np.tan(best.lower_bound) <= brute.fun
    assert best.pressure_angle - best.lower_bound < 3e-8 * best.pressure_angle
    least, most = best.cam.extremes.pressure_angles
    assert most.value == pytest.approx(-least.value, rel=1e-9)
    at = np.degrees(np.abs(best.cam.pressure_angle(np.array(best.angles))))
    assert at == pytest.approx(degrees(best.pressure_angle), rel=1e-8)


def test_a_follower_that_rests_has_none() -> None:
    best = best_offset(Cycle([Rise("1e-9 mm", "90 deg"), Return()], period="1 s"), "60 mm", ROLLER)
    assert abs(best.offset) < 1e-12
    assert best.lower_bound <= best.pressure_angle < 1e-10


@pytest.mark.parametrize("unit", [1e-12, 1e9])
def test_other_units_of_lengths(unit: float) -> None:
    def of(size: float) -> tuple[float, float, bool]:
        moves = [Rise(f"{30 * size!r} mm", "120 deg", law="345"), Dwell("20 deg"), Return(duration="80 deg", law="345")]
        cycle = Cycle([*moves, Dwell()], period="1 s")
        best = best_offset(cycle, f"{61 * size!r} mm", TranslatingRoller(f"{12 * size!r} mm"))
        return best.offset / size, best.pressure_angle, best.proven

    assert of(unit) == pytest.approx(of(1.0), rel=1e-9)


def test_wrong_followers_say_why() -> None:
    with pytest.raises(InputError, match="must be a TranslatingRoller"):
        best_offset(MOTIONS["up and down"], "60 mm", OscillatingRoller("12 mm", arm="90 mm", pivot_distance="120 mm"))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="prime_radius"):
        best_offset(MOTIONS["up and down"], "-60 mm", ROLLER)
    with pytest.raises(InputError, match="not less than that of the prime circle"):
        best_offset(MOTIONS["up and down"], "9 mm", ROLLER)
    assert DiscCam(MOTIONS["up and down"], "60 mm", ROLLER).contact.roller == pytest.approx(0.012)


# --- least prime circles and greatest rollers ---


ANGLES = np.linspace(0.0, 2.0 * np.pi, 2001)
CASES: list[tuple[CamFollower, str, float | None, float | None]] = [
    (TranslatingRoller("12 mm"), "30 mm", 30.0, None),
    (TranslatingRoller("12 mm", offset="9 mm"), "30 mm", 30.0, 5.0),
    (TranslatingRoller("4 mm"), "60 mm", 70.0, 9.0),
    (TranslatingFlat(), "12 mm", None, 5.0),
    (OscillatingRoller("12 mm", "90 mm", "120 mm"), "20 deg", 35.0, 5.0),
    (OscillatingFlat("150 mm", "6 mm"), "8 deg", None, 5.0),
]


def keeps(cam: DiscCam, pressure: float | None, radius: float | None) -> bool:
    """Whether a cam keeps its limits at 2,001 places, by its curves alone."""
    if pressure is not None and np.degrees(np.abs(cam.pressure_angle(ANGLES))).max() > pressure:
        return False
    curvature = cam.pitch_curve.curvature(ANGLES)
    sharpest = 1.0 / curvature[curvature > 0].max() - cam.contact.roller
    return radius is None or bool(1e3 * sharpest >= radius and curvature.min() > -np.inf)


@pytest.mark.sample(3)
@pytest.mark.parametrize(("follower", "stroke", "pressure", "radius"), CASES)
def test_the_least_prime_circle_is_that_of_a_bisection(
    follower: CamFollower, stroke: str, pressure: float | None, radius: float | None
) -> None:
    cycle = cycle_of(stroke)
    limits: dict[str, Any] = {} if pressure is None else {"pressure_angle": f"{pressure} deg"}
    limits |= {} if radius is None else {"radius_of_curvature": f"{radius} mm"}
    least = least_prime_circle(cycle, follower, **limits)
    assert least.proven
    assert least.radius * (1 - 2e-8) < least.too_small < least.radius
    low, high = 0.9 * least.radius, 1.1 * least.radius
    for _ in range(18):
        middle = 0.5 * (low + high)
        fine = keeps(DiscCam(cycle, f"{middle!r} m", follower), pressure, radius)
        low, high = (low, middle) if fine else (middle, high)
    assert high == pytest.approx(least.radius, rel=2e-5)
    smaller = DiscCam(cycle, f"{least.too_small!r} m", follower).extremes
    assert (pressure is not None and np.degrees(smaller.greatest_pressure_angle.low) > pressure) or (
        radius is not None and 1e3 * smaller.least_convex_radius.high < radius
    )
    extremes = least.cam.extremes
    assert pressure is None or np.degrees(extremes.greatest_pressure_angle.high) <= pressure
    assert radius is None or 1e3 * extremes.least_convex_radius.low >= radius


def test_a_flat_face_has_its_closed_form() -> None:
    # rho = r0 + s + s'' >= 5 mm
    cycle = cycle_of("12 mm")
    least = least_prime_circle(cycle, TranslatingFlat(), radius_of_curvature="5 mm")
    motion = least.cam.displacement
    lowest = min(float((motion(x) + motion(x, 2)).min()) for x in (np.linspace(0.0, 2 * np.pi, 400_001),))
    assert least.radius == pytest.approx(0.005 - lowest, rel=1e-9)


def test_a_mechanism_may_be_all_that_bounds_it() -> None:
    least = least_prime_circle(cycle_of("5 mm"), TranslatingRoller("12 mm"), pressure_angle="60 deg")
    assert least.limit == "mechanism"
    assert least.radius == pytest.approx(0.012, rel=1e-8)


@pytest.mark.parametrize("offset", ["0 mm", "9 mm", "-9 mm"])
def test_the_greatest_roller_keeps_the_radius_and_a_greater_one_breaks_it(offset: str) -> None:
    cam = DiscCam(cycle_of("60 mm"), "40 mm", TranslatingRoller("2 mm", offset))
    found = greatest_roller(cam, radius_of_curvature="4 mm")
    assert 0.0 < found.too_large - found.radius < 1e-9
    rollers = [TranslatingRoller(f"{found.radius + step!r} m", offset) for step in (-1e-8, 1e-8)]
    margins = [DiscCam(cycle_of("60 mm"), "40 mm", roller).extremes.least_convex_radius for roller in rollers]
    assert margins[0].low >= 0.004 > margins[1].high


def test_limits_that_are_missing_or_cannot_be_kept_say_the_remedy() -> None:
    cycle, arm = cycle_of("30 mm"), OscillatingRoller("12 mm", "90 mm", "120 mm")
    with pytest.raises(InputError, match="pressure_angle='30 deg'"):
        least_prime_circle(cycle, TranslatingRoller("12 mm"))
    with pytest.raises(InputError, match="below 90 deg"):
        least_prime_circle(cycle, TranslatingRoller("12 mm"), pressure_angle="90 deg")
    with pytest.raises(InputError, match="at least 0"):
        least_prime_circle(cycle, TranslatingFlat(), radius_of_curvature="-1 mm")
    with pytest.raises(InfeasibleProblem, match=r"no prime circle keeps a pressure angle of 5 deg.*spread the motion"):
        least_prime_circle(cycle_of("20 deg"), arm, pressure_angle="5 deg")
    with pytest.raises(InputError, match="a flat face has no roller"):
        greatest_roller(DiscCam(cycle, "60 mm", TranslatingFlat()))
    with pytest.raises(InputError, match="make the prime circle larger"):
        greatest_roller(DiscCam(cycle, "60 mm", TranslatingRoller("2 mm")), radius_of_curvature="90 mm")


def test_a_circle_too_small_for_laws_is_refused_with_one_that_is_enough() -> None:
    moves = [Rise("14 deg", "80 deg"), Dwell("15 deg"), Return("14 deg", "90 deg"), Dwell()]
    cycle = Cycle(moves, speed="600 rpm", limits={"velocity": "1120 deg/s", "jerk": "1.6e6 rad/s^3"})
    face = OscillatingFlat("90 mm", face_offset="4 mm")
    with pytest.raises(SolverFailure, match=r"satisfy them on a prime circle of 60\.7 mm") as caught:
        best_cam(cycle, "47.7 mm", face, radius_of_curvature="3 mm")
    assert "make it as large, or drop a limit" in str(caught.value)
    enough = best_cam(cycle, "60.7 mm", face, radius_of_curvature="3 mm").cam
    assert np.asarray(enough.radius_of_curvature(np.linspace(0.0, 6.28, 721))).min() >= 3e-3
