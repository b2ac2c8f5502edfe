"""The fastest cycle within what its drive gives: closed forms, a bisection over cycles, limits that no speed keeps."""

from typing import Any

import numpy as np
import pytest

from optlaws import (
    Cycle,
    Drive,
    Dwell,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Motor,
    Problem,
    Return,
    Rise,
    fastest,
    slider_crank,
)
from optlaws.verification import verify_all
from tests.cycles.greatest_speed.test_fastest_cycle import NEAR, bisected

TURNING = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "100 deg"), Dwell()]
GIVEN = [
    Rise("35 mm", "120 deg", law="cycloidal"),
    Dwell("60 deg"),
    Return("35 mm", "100 deg", law="cycloidal"),
    Dwell(),
]


def cycle(**given: Any) -> Cycle:
    return Cycle(given.pop("segments", TURNING), **({"speed": "60 rpm"} | given))


def test_the_force_of_a_mass_is_a_limit_of_its_acceleration() -> None:
    force = cycle(drive={"mass": "2 kg"}, limits={"force": "60 N"}).fastest()
    acceleration = cycle(limits={"acceleration": "30 m/s^2"}).fastest()
    assert force.period == pytest.approx(acceleration.period, rel=1e-8)
    assert force.status == acceleration.status == "optimal"
    assert force.binding == ("segment 3 (Return): force 60 N",)


def test_weight_friction_and_spring_are_kept_and_proven() -> None:
    weighed = cycle(drive={"mass": "2 kg", "gravity": "19.6 N", "dry": "5 N"}, limits={"force": "60 N"}).fastest()
    assert weighed.status == "optimal"
    assert weighed.cycle.effort.peak_force == pytest.approx(60.0, rel=1e-9)
    (verified,) = verify_all(weighed.claims()).values()
    assert verified.infeasible
    # down, weight and friction leave so much for speeding up and for braking
    down = {"acceleration": ("-37.3 m/s^2", "22.7 m/s^2")}
    back = cycle(segments=[*TURNING[:2], Return("35 mm", "100 deg", limits=down), Dwell()]).fastest()
    assert back.period == pytest.approx(weighed.period, rel=1e-8)


@pytest.mark.long
@pytest.mark.parametrize(
    ("drive", "ends"),
    [
        ({"mass": "2 kg", "gravity": "19.6 N", "dry": "5 N"}, (0.2, 0.35)),
        ({"mass": "2 kg", "stiffness": "1 N/mm", "preload": "10 N"}, (0.2, 0.35)),
    ],
)
def test_a_bisection_finds_the_same(drive: dict[str, str], ends: tuple[float, float]) -> None:
    given = cycle(drive=drive, limits={"force": "60 N"})
    fastest = given.fastest()
    low, high = bisected(given, *ends)
    assert low * (1.0 - NEAR) <= fastest.period <= high * (1.0 + NEAR)
    assert fastest.status == "optimal"


def test_given_laws_meet_the_force_where_it_is_greatest() -> None:
    """With a weight alone the force is m c h/T² + w, greatest where c is 2 pi."""
    fastest = cycle(segments=GIVEN, drive={"mass": "2 kg", "gravity": "19.6 N"}, limits={"force": "60 N"}).fastest()
    needed = (2.0 * 0.035 * 6.283185307179586 / (60.0 - 19.6)) ** 0.5
    assert fastest.period == pytest.approx(needed * 3.6, rel=1e-9)
    assert fastest.status == "optimal"


BESIDE = [Rise("35 mm", "120 deg"), Return(law="cycloidal")]


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("drive", "limits", "segments"),
    [
        ({"mass": "2 kg", "viscous": "10 N s/m", "gravity": "19.6 N", "dry": "5 N"}, {"force": "60 N"}, TURNING),
        ({"mass": "2 kg"}, {"power": "20 W"}, BESIDE),
        pytest.param({"mass": "2 kg"}, {"power": "20 W", "jerk": "1500 m/s^3"}, TURNING, marks=pytest.mark.long),
    ],
)
def test_viscous_friction_and_the_power_of_a_mass_are_proven(
    drive: dict[str, str], limits: dict[str, str], segments: list[Any]
) -> None:
    fastest = cycle(drive=drive, limits=limits, segments=segments).fastest()
    assert fastest.status == "optimal"
    effort = fastest.cycle.effort
    taken = {"force": effort.peak_force, "power": effort.peak_power}
    name, most = next(iter(limits.items()))
    assert taken[name] == pytest.approx(float(most.split()[0]), rel=1e-8)
    (verified,) = verify_all(fastest.claims()).values()
    assert verified.proven
    if name == "power":
        # D h² m/T³ a millionth faster
        needed = fastest.segments[0].least if segments is BESIDE else fastest.segments[1].least
        assert verified.bound is not None
        assert verified.bound * 2.0 * 0.035**2 / (needed * (1.0 - 1e-6)) ** 3 > 20.0


@pytest.mark.long
def test_what_is_not_convex_or_does_not_scale_is_local() -> None:
    for drive, limits in (
        ({"mass": "2 kg", "viscous": "10 N s/m", "stiffness": "0.1 N/mm"}, {"force": "60 N"}),
        ({"mass": "2 kg", "gravity": "19.6 N"}, {"power": "20 W"}),
    ):
        fastest = cycle(drive=drive, limits=limits, segments=BESIDE).fastest()
        assert (fastest.status.value, fastest.lower_bound) == ("local", None)
        effort = fastest.cycle.effort
        taken = {"force": effort.peak_force, "power": effort.peak_power}
        assert all(taken[name] <= float(text.split()[0]) * (1.0 + 1e-8) for name, text in limits.items())


SWING = [Rise("90 deg", "108 deg"), Dwell("36 deg"), Return("90 deg", "108 deg"), Dwell()]
CURVE = [("0 rpm", "4 N m"), ("500 rpm", "4 N m"), ("900 rpm", "2 N m")]


@pytest.mark.long
def test_a_gear_that_loses_power_has_the_speed_of_accelerations() -> None:
    lossy = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=20, efficiency=(0.9, 0.8))
    fastest = cycle(segments=SWING, drive=lossy, limits={"torque": "4 N m"}).fastest()
    up, down = (4.0 / (3e-4 * 20 + 0.04 * share) for share in (1.0 / 0.9, 0.8))
    limits = {"acceleration": f"{up!r} rad/s^2", "deceleration": f"{down!r} rad/s^2"}
    plain = cycle(segments=SWING, limits=limits).fastest()
    assert fastest.period == pytest.approx(plain.period, rel=1e-8)
    assert fastest.status == "optimal"
    assert all(each.proven for each in verify_all(fastest.claims()).values())


@pytest.mark.long
@pytest.mark.parametrize(
    ("efficiency", "friction", "status"),
    [(1.0, "0.5 N m s/rad", "optimal"), pytest.param(0.85, "0.5 N m s/rad", "local", marks=pytest.mark.long)],
)
def test_a_motors_curve_is_kept(efficiency: float, friction: str, status: str) -> None:
    mechanism = Mechanism("0.8 kg m^2", "20 N m", viscous=friction)
    drive = Drive(mechanism, Motor("3e-4 kg m^2", curve=CURVE), ratio=20, efficiency=efficiency)
    quick = cycle(segments=SWING, drive=drive, limits={"motor": True}).fastest()
    assert quick.status == status
    assert quick.binding == ("segment 1 (Rise): motor's curve, velocity 270 deg/s",)
    (piece, *_) = (piece for piece in quick.cycle.pieces if piece.stroke)
    times = np.linspace(piece.start, piece.start + piece.duration, 2001)[1:-1]
    x, v, w = (piece.values(times, nu) for nu in range(3))
    used = np.abs(drive.torque(x, v, w)) / np.maximum(drive.motor.peak_at(20.0 * v * (1.0 - 1e-9)), 1e-9)
    assert used.max() == pytest.approx(1.0, rel=1e-5)


def test_a_static_torque_beyond_the_curve_is_named() -> None:
    drive = Drive(Mechanism("0.8 kg m^2", "90 N m"), Motor("3e-4 kg m^2", curve=CURVE), ratio=20)
    with pytest.raises(InfeasibleProblem, match=r"needs the torque 4\.5 N m, so that no speed keeps the torque 4 N m"):
        cycle(segments=SWING, drive=drive, limits={"motor": True}).fastest()
    hot = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", continuous=[("0 rpm", "2 N m"), ("900 rpm", "1 N m")]))
    with pytest.raises(InputError, match="continuous torque follows the speed"):
        cycle(segments=SWING, drive=hot, limits={"motor": True}).fastest()


@pytest.mark.long
def test_the_torque_of_a_mechanism_is_kept() -> None:
    press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
    strokes = [Rise("180 deg", "108 deg"), Dwell("36 deg"), Return(duration="108 deg"), Dwell()]
    fastest = cycle(segments=strokes, drive=press, limits={"torque": "10 N m"}).fastest()
    assert fastest.status == "local"
    assert fastest.cycle.effort.peak_force == pytest.approx(10.0, rel=1e-6)
    # without a static torque it falls with the square of the speed
    double = cycle(segments=strokes, drive=press, limits={"torque": "40 N m"}).fastest()
    assert fastest.period / double.period == pytest.approx(2.0, rel=1e-4)


def test_a_static_force_beyond_its_limit_is_named() -> None:
    says = (
        r"segment 1 \(Rise\): at 35 mm the static load needs the force 149\.6 N, so that no speed keeps the force 140 N"
    )
    sprung = {"mass": "2 kg", "stiffness": "3 N/mm", "preload": "44.6 N"}
    with pytest.raises(InfeasibleProblem, match=says):
        cycle(segments=GIVEN, drive=sprung, limits={"force": "140 N"}).fastest()


def test_a_static_torque_that_few_positions_take_is_found() -> None:
    # a latch of half a degree
    latch = {"0 deg": "0 N m", "40.1 deg": "0 N m", "40.3 deg": "12 N m", "40.6 deg": "0 N m", "120 deg": "0 N m"}
    says = r"segment 1 \(Rise\): at 40\.3 deg the static load needs the torque 12 N m, so that no speed keeps"
    with pytest.raises(InfeasibleProblem, match=says):
        cycle(segments=TABLE, drive=Mechanism("0.02 kg m^2", latch), limits={"torque": "9 N m"}).fastest()


MOTOR = {"inertia": "0.02 kg m^2", "dry": "0.3 N m"}
TABLE = [
    Rise("90 deg", "72 deg"),
    Dwell("36 deg"),
    Rise("30 deg", "54 deg"),
    Dwell("36 deg"),
    Return(duration="108 deg"),
    Dwell(),
]


def test_the_rms_torque_of_an_inertia_falls_with_the_square_of_the_period() -> None:
    inertia = {"inertia": "0.02 kg m^2"}
    fastest = cycle(segments=TABLE, drive=inertia, limits={"rms torque": "1.75 N m"}).fastest()
    least = cycle(segments=TABLE, drive=inertia, minimise="rms torque")
    assert least.lower_bound is not None
    assert fastest.period == pytest.approx((least.lower_bound / 1.75) ** 0.5, rel=1e-7)
    assert fastest.cycle.effort.rms_force == pytest.approx(1.75, rel=1e-7)
    assert fastest.binding == ("the whole cycle: RMS torque 1.75 N m",)
    assert [str(gain) for gain in fastest.gains] == ["10 % more RMS torque: 64.774 rpm, 4.88 % faster"]


@pytest.mark.long
def test_a_rating_with_friction_is_met_and_proven() -> None:
    fastest = cycle(segments=TABLE, drive=MOTOR, limits={"rms torque": "1.75 N m", "torque": "9 N m"}).fastest()
    assert fastest.status == "optimal"
    assert fastest.cycle.effort.rms_force == pytest.approx(1.75, rel=1e-7)
    # the bounds that the certificates prove sum to more than the rating, a little faster
    assert len(fastest.proofs) == 3
    for entry in verify_all(fastest.claims()).values():
        assert entry.bound is not None
        assert entry.bound > 0.0
    for share, says in ((1.0 - 1e-5, InfeasibleProblem), (1.0 + 1e-5, None)):
        near = cycle(segments=TABLE, drive=MOTOR, limits={"rms torque": "1.75 N m", "torque": "9 N m"}, speed=None,
                     period=f"{fastest.period * share!r} s", minimise="rms torque")  # fmt: skip
        if says is None:
            assert near.status == "optimal"
        else:
            with pytest.raises(says, match=r"RMS torque over the cycle is to be at most 1\.75"):
                near.status  # noqa: B018 - laws are looked for when they are asked for


@pytest.mark.long
def test_a_rating_beside_another_limit_that_binds_is_kept() -> None:
    fastest = cycle(segments=TABLE, drive=MOTOR, limits={"rms torque": "1.75 N m", "torque": "3 N m"}).fastest()
    assert fastest.binding == ("segment 1 (Rise): torque 3 N m",)
    assert fastest.cycle.effort.rms_force < 1.75
    assert fastest.cycle.effort.peak_force == pytest.approx(3.0, rel=1e-9)


def test_a_rating_of_given_laws_and_one_below_the_weight() -> None:
    given = [
        Rise("90 deg", "72 deg", law="modified sine"),
        Dwell("36 deg"),
        Return(duration="108 deg", law="cycloidal"),
        Dwell(),
    ]
    fastest = cycle(segments=given, drive=MOTOR, limits={"rms torque": "1.75 N m"}).fastest()
    assert fastest.status == "optimal"
    assert fastest.cycle.effort.rms_force == pytest.approx(1.75, rel=1e-7)
    with pytest.raises(
        InfeasibleProblem, match=r"no speed keeps the RMS torque of 1\.75: the static load alone needs more"
    ):
        cycle(segments=given, drive=MOTOR | {"gravity": "2 N m"}, limits={"rms torque": "1.75 N m"}).fastest()
    free = [Rise("90 deg"), Dwell("40 ms"), Return(), Dwell("90 deg")]
    with pytest.raises(InputError, match="give all durations as angles"):
        cycle(segments=free, drive=MOTOR, limits={"rms torque": "1.75 N m", "torque": "9 N m"}).fastest()


@pytest.mark.parametrize("rated", [False, True])
def test_a_cycle_and_a_move_have_one_least_time(*, rated: bool) -> None:
    """The same motion by `Cycle.fastest` and by `fastest`: within rates, and within a motor with friction and load."""
    drive: Drive | None = None
    limits: dict[str, Any] = {"velocity": "1.2 m/s", "acceleration": "25 m/s^2", "jerk": "2500 m/s^3"}
    of_move, stroke, known = limits, "60 mm", 0.11067408296762
    if rated:
        motor = Motor("3e-4 kg m^2", peak_torque="4 N m", greatest_speed="900 rpm")
        drive = Drive(Mechanism("0.8 kg m^2", "20 N m", viscous="0.5 N m s/rad"), motor, ratio=20)
        limits, of_move, stroke, known = {"motor": True}, {}, "45 deg", 0.23176085010
    move = fastest(Problem(order=3), stroke=stroke, limits=of_move, drive=drive)
    whole = cycle(segments=[Rise(stroke, "180 deg"), Return()], drive=drive, limits=limits, order=3, degree=9).fastest()
    assert whole.segments[0].least == pytest.approx(move.duration, rel=1e-11)
    assert move.duration == pytest.approx(known, rel=1e-10)
