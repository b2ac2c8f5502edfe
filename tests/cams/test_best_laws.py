"""Laws that are best for their cam: their limits, bounds from elsewhere, and what has no law."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import linprog

from optlaws import (
    CamForces,
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
    best_prime_circle,
    smoothstep,
)
from tests.internals.cams import PRESSURE, SlidingRoller, SwingingRoller, best_laws, curvature_of, linear_limits
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
def test_curvature_under_a_roller_is_imposed_and_bounded(monkeypatch: pytest.MonkeyPatch, case: str) -> None:
    if case == "short":
        monkeypatch.setattr(best_laws, "_PARTS", 8)
    cycle, base, follower, limits = BENT[case]
    best = best_cam(cycle, base, follower, **limits)  # type: ignore[arg-type]
    expected = 1e-3 * float(limits["radius_of_curvature"].split()[0])
    assert best.cam.extremes.least_convex_radius.low == pytest.approx(expected, rel=1e-7)
    if "pressure_angle" in limits:
        assert np.degrees(best.cam.extremes.greatest_pressure_angle.high) <= 27.0 + 1e-6
    assert DiscCam(cycle, base, follower).extremes.least_convex_radius.high < 0.999 * expected
    assert cycle.objective * 1.0001 < best.lower_bound <= best.objective < 1.02 * best.lower_bound
    assert best.status is Status.LOCAL


@pytest.mark.parametrize("turning", [1.0, -1.0])
@pytest.mark.parametrize("kind", ["slide", "arm"])
def test_planes_are_nowhere_above_what_the_curvature_needs(kind: str, turning: float) -> None:
    """Where the pitch curve bends as much as it may, by the contact's own curvature, every plane says it may."""
    roller = {
        "slide": SlidingRoller(turning, 0.0, 0.05, 0.012, offset=0.006),
        "arm": SwingingRoller(turning, 0.0, 0.5, 0.014, arm=0.11, distance=0.14),
    }[kind]
    stroke = 0.035 if kind == "slide" else 0.4
    piece = Piece(0.0, 0.3, 0.1 * stroke, -0.8 * stroke, smoothstep(3))
    curvature = curvature_of(piece, roller, 0.03, 1.0)
    assert curvature is not None
    k = np.linspace(0.0, 1.0, 9)
    rng = np.random.default_rng(5)
    middles = 0.5 * (k[:-1] + k[1:])
    pairs = [
        [(one - 0.02, one + 0.02) for one in np.asarray(law(middles)).tolist()] for law in (piece.law.a, piece.law.b)
    ]
    planes = curvature.planes(k.tolist(), *pairs)
    assert len(planes) == 8
    for plane, first, second in zip(planes, *pairs, strict=True):
        at, rate = (rng.uniform(low, high, 200) for low, high in (first, second))
        s, slope = piece.offset + piece.stroke * at, piece.stroke * rate / (2 * np.pi * piece.duration)

        def bent(bend: float, s: Array = s, slope: Array = slope) -> Array:
            return np.asarray(roller.curvature(Jet((s, slope, 0.5 * bend * np.ones(200)))).terms[0])

        # the curvature is affine in s''
        none, one = bent(0.0), bent(1.0)
        least = (1.0 / (0.03 + roller.roller) - none) / (one - none)
        c = least * (2 * np.pi * piece.duration) ** 2 / piece.stroke
        assert plane.motion is not None
        values = evaluate(plane.motion.formula, {"a": at, "b": rate, "c": c}, NUMPY)
        limit = curvature.window().motion
        assert limit is not None
        exact = evaluate(limit.formula, {"a": at, "b": rate, "c": c}, NUMPY)
        assert np.abs(exact).max() < 1e-9
        assert (values <= plane.high + 1e-9).all()
        assert values.max() > plane.high - 0.02


def test_what_has_no_best_law_says_the_remedy() -> None:
    given = Cycle([Rise("35 mm", "120 deg", law="cycloidal"), Return(law="cycloidal")], period="1 s")
    with pytest.raises(InputError, match="leave the law of a move out"):
        best_cam(given, "50 mm", TranslatingRoller("12 mm"), pressure_angle="30 deg")
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
