"""Cycles that drive mechanisms and elastic loads: torques along the cycle, laws of least torque and steady motion."""

from dataclasses import replace
from math import sqrt
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from optlaws import (
    Cycle,
    Drive,
    Dwell,
    Follower,
    InfeasibleProblem,
    InputError,
    Link,
    Loads,
    Machine,
    Mechanism,
    Motor,
    Move,
    Return,
    Rise,
    belt,
    catalogue,
    slider_crank,
)
from tests.internals.cycles import overload_rows

RPM = 30.0 / np.pi
PRESS = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
TABLE = Mechanism("0.8 kg m^2")
LOADED = Mechanism("0.8 kg m^2", load="3*sin(x)", coulomb=0.3)
INDEXED = [Rise("45 deg", "0.25 s"), Dwell()]
EACH: dict[str, Any] = {"period": "0.6 s", "advance": "45 deg"}
STROKES = [Rise("180 deg", "0.3 s"), Dwell("0.1 s"), Return(duration="0.3 s"), Dwell()]


@pytest.fixture(scope="module")
def calm() -> Cycle:
    """A press whose strokes take the least root mean square of the torque."""
    return Cycle(STROKES, period="1 s", minimise="rms torque", drive=PRESS)


def test_least_rms_torque_of_a_crank_and_what_no_law_can_beat(calm: Cycle) -> None:
    """Each stroke of 0.3 s takes 3.989601 N m at degree 9 (another optimiser's), no law less than 3.924086."""
    share = sqrt(0.6)
    assert calm.objective == pytest.approx(share * 3.989601, rel=1e-6)
    assert calm.lower_bound == pytest.approx(share * 3.924086, rel=1e-6)
    assert calm.effort.rms_force == pytest.approx(calm.objective, rel=1e-9)
    assert Cycle.from_json(calm.to_json()) == calm


def test_torques_along_given_laws_are_those_of_the_mechanism() -> None:
    cycle = Cycle([Rise("180 deg", "0.3 s", law="345"), Dwell()], period="0.5 s", advance="180 deg", drive=PRESS)
    k = np.linspace(0.0, 1.0, 4001)
    law = catalogue["345"].law
    a, b, c = (np.pi * law.a(k), np.pi / 0.3 * law.b(k), np.pi / 0.09 * law.c(k))
    torque = PRESS.torque(a, b, c)
    assert cycle.effort.peak_force == pytest.approx(np.abs(torque).max(), rel=1e-6)
    assert cycle.effort.peak_power == pytest.approx(np.abs(torque * b).max(), rel=1e-6)
    assert cycle.effort.rms_force == pytest.approx(7.979021 * sqrt(0.6), rel=1e-6)


def test_a_motor_with_a_gear_needs_less_by_a_law_of_its_own() -> None:
    """A rotary table: proven, for its inertia is the same everywhere."""
    drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=20)
    indexed: dict[str, Any] = {"period": "0.6 s", "advance": "45 deg", "drive": drive}
    sheet = drive.sheet("modified sine", "0 deg", "45 deg", "0.25 s", period="0.6 s")
    best = Cycle([Rise("45 deg", "0.25 s"), Dwell()], minimise="rms torque", **indexed)
    assert best.status.value == "optimal"
    assert best.objective < 0.92 * sheet.rms_torque
    assert Cycle.from_json(best.to_json()).drive == drive


@pytest.mark.parametrize(
    ("segments", "drive", "says"),
    [
        ([Rise("35 mm", "0.2 s"), Return()], PRESS, "turns and the motion of the cycle slides"),
        ([Rise("35 mm", "0.2 s"), Return()], belt("30 mm", "8 kg"), "10 mm of the slide are 19.0986 deg of the input"),
        ([Rise("35 mm", "0.2 s"), Return()], 3.0, "drive"),
        (
            [Move(to="200 deg", duration="0.2 s"), Return()],
            slider_crank("0.1 m", "0.4 m", bodies={"slider": "5 kg"}, over=("0 deg", "180 deg")),
            "180 deg",
        ),
    ],
    ids=["axis", "belt", "number", "range"],
)
def test_wrong_drives_are_refused(segments: list[object], drive: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        Cycle(segments, period="0.5 s", drive=drive, minimise="rms torque").objective  # type: ignore[arg-type]  # noqa: B018


@pytest.mark.long
@pytest.mark.parametrize("efficiency", [None, 0.92])
def test_a_peak_along_the_corners_of_a_table_is_that_of_its_lines(efficiency: float | None) -> None:
    force = {"0 deg": "0 N", "90 deg": "-20 N", "150 deg": "-50 N", "360 deg": "0 N"}
    press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2"}, loads=Loads(force, over="input"))
    drive = press if efficiency is None else Drive(press, Motor("3e-4 kg m^2"), ratio=5, efficiency=efficiency)
    # the return, whose law is given, is so slow that the rise decides
    strokes = [Rise("180 deg", "0.5 s"), Return("180 deg", "2.5 s", law="modified sine")]
    best = Cycle(strokes, period="3 s", minimise="torque", drive=drive, degree=5)
    times = np.linspace(0.0, 0.5, 200001)[:-1]
    x, v, a = (best(times, nu) for nu in range(3))
    torque = np.abs(drive.torque(x, v, a)).max()
    assert best.objective >= torque * (1.0 - 1e-12)
    assert best.solutions[0].objective > 0.0
    usual = Cycle([Rise("180 deg", "0.5 s", law="modified sine"), *strokes[1:]], period="3 s", drive=drive)
    assert best.objective < 0.9 * usual.effort.peak_force


def _press(jerk: str) -> Cycle:
    """A press of 35 kg against 4 kN: a turn of its crank in 0.6 s."""
    force = {"0 deg": "0 N", "280 deg": "0 N", "310 deg": "-4 kN", "340 deg": "-4 kN", "360 deg": "0 N"}
    bodies = {"crank": "0.3 kg m^2", "slider": "35 kg"}
    press = slider_crank("60 mm", "250 mm", bodies=bodies, loads=Loads(force, over="input"))
    turn = [Rise("360 deg", "0.6 s"), Dwell()]
    limits = {"jerk": jerk}
    return Cycle(turn, period="0.8 s", advance="360 deg", drive=press, minimise="torque", limits=limits)


@pytest.mark.long
def test_a_press_against_a_table_of_forces_takes_no_more_than_by_a_general_solver() -> None:
    """SLSQP of the same degree, on thousands of points from several starts, ends with 121.148 N m or more."""
    best = _press("2020.7 rad/s^3").solve()
    assert best.objective < 121.148
    x, v, a = (best(np.linspace(0.0, 0.6, 200001)[:-1], nu) for nu in range(3))
    press = best.specification.drive
    assert isinstance(press, Mechanism)
    torque = np.abs(press.torque(x, v, a)).max()
    assert torque <= best.objective * (1.0 + 1e-12)
    assert torque == pytest.approx(best.objective, rel=1e-4)  # of its corner, between samples
    assert best.peak(3) <= 2020.7 * (1.0 + 1e-9)


def test_a_jerk_that_no_law_of_a_press_keeps_is_refused_before_any_start(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("optlaws.synthesis.method.starts.in_phase_plane", lambda *_: pytest.fail("a start"))
    with pytest.raises(InfeasibleProblem, match=r"the least is the jerk 998\.429 rad/s") as caught:
        _press("900 rad/s^3").solve()
    assert caught.value.proof is not None


@pytest.mark.parametrize(("minimise", "offered"), [("acceleration", True), ("torque", True), ("rms torque", False)])
def test_the_limit_of_a_motor_is_offered_unless_the_laws_have_the_least(
    minimise: str, *, offered: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No law has less than 1.293 N m rms; the remark looks for none, which took as long as the cycle itself."""
    drive = Drive(TABLE, Motor("3e-4 kg m^2", rated_torque="1 N m"), ratio=20)
    plan = Cycle(INDEXED, **EACH, drive=drive, minimise=minimise).solve()
    monkeypatch.setattr("optlaws.cycles.optimisation.optimal.synthesize", lambda *_, **__: pytest.fail("a search"))
    (remark,) = overload_rows(plan)
    assert "the motor is overloaded (RMS torque 1" in str(remark.value)
    assert ("look for laws within its limits by motor = true" in str(remark.value)) is offered


def test_an_energy_of_which_nothing_flows_back_is_said_once() -> None:
    motor = Motor("3e-4 kg m^2")
    for regeneration, names in ((0.0, 2), (0.5, 3)):
        drive = Drive(TABLE, motor, ratio=20, regeneration=regeneration)
        rows = Cycle(INDEXED, **EACH, drive=drive).sheet.summary()
        assert sum("energy of a cycle" in row.name for row in rows) == names


def test_peaks_behind_a_gear_with_losses_are_of_two_torques() -> None:
    """Of a constant inertia both sides are convex: driving J c/0.85, braking 0.85 J c, and the motor's inertia."""
    drive = Drive(TABLE, Motor("3e-4 kg m^2"), ratio=20, efficiency=0.85)
    best = Cycle(INDEXED, **EACH, minimise="torque", drive=drive)
    assert best.status.value == "optimal"
    driving, braking = (20 * 3e-4 + 0.8 / 20 * share for share in (1 / 0.85, 0.85))
    law, size = best.solutions[0].law, np.pi / 4 / 0.25**2
    c = law.c(np.linspace(0.0, 1.0, 20001))
    assert best.objective == pytest.approx(size * max(driving * c.max(), -braking * c.min()), rel=1e-7)
    # no law at all is below the one of constant torques
    assert best.objective > size * 2.0 * (driving + braking)


def test_peaks_of_a_lossy_gear_with_a_load_are_kept_and_called_local() -> None:
    """With a load the torque below 0 is counted as that of power back: the bound is that of the drive."""
    drive = Drive(
        Mechanism("0.8 kg m^2", load="3*sin(x)", coulomb=0.3), Motor("3e-4 kg m^2"), ratio=20, efficiency=0.85
    )
    best = Cycle(INDEXED, **EACH, minimise="torque", drive=drive)
    assert "all laws that never turn back" in best.remarks[-1]
    assert best.status.value == "local"
    limit = drive.limit("peak torque", "0 deg", "45 deg", "0.25 s")
    assert best.lower_bound == limit.value
    assert 0.9 * best.objective < limit.value < best.objective
    rms = Cycle(
        INDEXED, **EACH, minimise="rms torque", drive=drive, limits={"torque": f"{1.05 * best.objective!r} N m"}
    )
    assert best.objective < rms.effort.peak_force <= 1.05 * best.objective * (1 + 1e-9)


RUBBING = Drive(
    Mechanism("2 kg m^2", coulomb="6 N m"), Motor("3e-4 kg m^2", constant=0.4, peak_torque="9 N m"), 10, 0.92
)
QUARTER: dict[str, Any] = {"period": "1 s", "advance": "90 deg", "drive": RUBBING}


def test_a_table_with_friction_behind_a_gear_with_losses_has_the_bound_of_two_constant_torques() -> None:
    """The least peak torque takes it all: speeding up to twice the mean velocity, and braking from there."""
    inertia, motor, i, eta, rub, time = 2.0, 3e-4, 10.0, 0.92, 6.0, 0.4
    fastest = 2.0 * (np.pi / 2.0) / time

    def lasts(torque: float) -> float:
        up = (torque - rub / (eta * i)) / (i * motor + inertia / (eta * i))
        down = (torque + rub * eta / i) / (i * motor + inertia * eta / i)
        return fastest / up + fastest / down - time

    best = Cycle([Rise("90 deg", "0.4 s"), Dwell()], **QUARTER, minimise="torque", degree=5)
    assert best.lower_bound == pytest.approx(brentq(lasts, 1.0, 50.0), rel=1e-6)
    assert best.objective > brentq(lasts, 1.0, 50.0)


@pytest.mark.parametrize("minimise", ["torque", "rms torque", "power", "heat"])
def test_no_law_that_never_turns_back_is_below_the_bound_of_a_gear_with_losses(minimise: str) -> None:
    best = Cycle([Rise("90 deg", "0.4 s"), Dwell()], **QUARTER, minimise=minimise, degree=5)
    assert best.status.value == "local"
    assert best.lower_bound is not None
    assert best.lower_bound > 0.5 * best.objective
    for law in ("modified sine", "modified trapezoid", "cycloidal", "3-4-5 polynomial", "modified constant velocity"):
        given = Cycle([Rise("90 deg", "0.4 s", law=law), Dwell()], **QUARTER)
        assert given.value(minimise) >= best.lower_bound


def test_a_bound_of_nothing_is_none() -> None:
    """A load over the master is of no phase plane, and the gear's losses leave the search without a bound."""
    process = {
        "torque": {"0 deg": "0 N m", "72 deg": "5 N m", "144 deg": "0 N m", "360 deg": "0 N m"},
        "over": "master",
    }
    loaded = Cycle(
        [Rise("90 deg", "0.4 s"), Dwell()],
        **{**QUARTER, "drive": replace(RUBBING, mechanism=Mechanism("2 kg m^2"))},
        load=process,
        minimise="torque",
        degree=3,
    )
    assert (loaded.lower_bound, loaded.status.value) == (None, "local")
    (bound,) = (row for row in loaded.summary() if row.name == "proven lower bound")
    why = "bounds are of moves from rest to rest under loads that do not change with the time"
    assert (bound.value, bound.note) == ("none is known", why)


def test_a_bound_that_a_law_does_not_meet_has_its_gap() -> None:
    cycle = Cycle(INDEXED, **EACH, drive=RUBBING, minimise="torque", degree=3)
    assert cycle.status.value == "local"
    assert cycle.lower_bound is not None
    (bound,) = (row for row in cycle.summary() if "lower bound" in row.name)
    assert bound.note == f"gap {100.0 * (1.0 - cycle.lower_bound / cycle.objective):.2g} %"


def degrees_offered(cycle: Cycle) -> list[Any]:
    return [row.value for row in cycle.summary() if row.name == "remark" and "degree" in row.value]


def test_where_a_wide_gap_is_left_a_higher_degree_is_offered(calm: Cycle) -> None:
    usual = replace(calm, minimise="torque")
    assert usual.lower_bound is not None
    assert usual.lower_bound < 0.95 * usual.objective
    assert degrees_offered(usual) == [
        "laws of a higher degree may take less: give degree = 21 in [[axis]], or in [motion] of a cam"
    ]
    assert degrees_offered(calm) == []  # a gap of 1.6 %


@pytest.mark.long
def test_a_higher_degree_that_is_offered_gains(calm: Cycle) -> None:
    usual, richer = (replace(calm, minimise="torque", degree=degree) for degree in (9, 21))
    assert richer.objective < 0.96 * usual.objective
    assert degrees_offered(richer) == []


def test_the_sheet_of_a_cycle_is_that_of_its_move() -> None:
    """One move and a rest: the same as the sheet of the move; and of two moves the sums of both."""
    motor = Motor("3e-4 kg m^2", rated_torque="2 N m", constant=0.4, curve=[("0 rpm", "6 N m"), ("2000 rpm", "4 N m")])
    drive = Drive(LOADED, motor, ratio=20, efficiency=0.85, regeneration=0.3)
    cycle = Cycle([Rise("45 deg", "0.25 s", law="modified sine"), Dwell()], **EACH, drive=drive)
    move = drive.sheet("modified sine", "0 deg", "45 deg", "0.25 s", period="0.6 s")
    same = {name: value for name, value in move.to_dict().items() if value and not name.endswith("_at")}
    assert {name: cycle.sheet.to_dict()[name] for name in same} == pytest.approx(same, rel=1e-9)
    assert cycle.sheet.peak_torque_at == pytest.approx(0.25 * move.peak_torque_at, rel=1e-5)
    assert (cycle.sheet.fits, [margin.name for margin in cycle.sheet.margins]) == (
        True,
        ["peak torque", "torque-speed curve", "RMS torque", "speed"][1:],
    )
    rise, rest = cycle.efforts
    assert rise.motoring_energy == pytest.approx(move.motoring_energy, rel=1e-9)
    assert rest.peak_force == pytest.approx(move.holding_torque, rel=1e-9)
    assert cycle.effort.rms_force**2 * 0.6 == pytest.approx(rise.rms_force**2 * 0.25 + rest.rms_force**2 * 0.35)
    assert "RMS torque, used" in str(cycle.summary())


def test_torque_and_power_over_time_are_of_the_drive() -> None:
    """At a joint those of what follows; later cycles repeat, though an index goes on."""
    drive = Drive(TABLE, Motor("3e-4 kg m^2"), ratio=20)
    cycle = Cycle([Rise("45 deg", "0.25 s", law="modified sine"), Dwell()], **EACH, drive=drive)
    times = np.linspace(0.01, 0.24, 7)
    torque = 20 * 3e-4 * cycle(times, 2) + 0.8 * cycle(times, 2) / 20
    assert cycle.force(times) == pytest.approx(torque, rel=1e-9)
    assert cycle.power(times + 0.6) == pytest.approx(torque * 20 * cycle(times, 1), rel=1e-9)
    assert cycle.force(0.4) == 0.0
    with pytest.raises(InputError, match="no motor"):
        Cycle([Rise("45 deg", "0.25 s", law="modified sine"), Dwell()], **EACH, drive=TABLE).sheet  # noqa: B018


def test_pictures_of_a_cycle_with_a_motor() -> None:
    drive = Drive(TABLE, Motor("3e-4 kg m^2", curve=[(0.0, 3.0), (400.0, 1.0)]), ratio=20)
    cycle = Cycle([Rise("45 deg", "0.25 s", law="modified sine"), Dwell()], **EACH, drive=drive)
    labels = list(dict.fromkeys(artist.axes.get_ylabel() for artist in cycle.plot()))
    assert labels[-2:] == ["torque, N m", "power, W"]
    curve, *_, course, mean, fastest = cycle.plot(over="speed")
    sheet, used = cycle.sheet, {margin.name: f"{100.0 * margin.use:.3g} % used" for margin in cycle.sheet.margins}
    assert (mean.get_xdata()[0], mean.get_ydata()[0]) == pytest.approx((sheet.mean_speed * RPM, sheet.rms_torque))
    assert curve.get_label() == f"peak torque, {used['torque-speed curve']}"
    assert fastest.get_label() == f"greatest speed 3819.7 rpm, {used['speed']}"
    assert not len(fastest.get_xdata())  # too far away to be drawn
    near = replace(drive, motor=Motor("3e-4 kg m^2", greatest_speed=200.0))
    *_, fastest = Cycle(cycle.segments, **EACH, drive=near).plot(over="speed")
    assert list(fastest.get_xdata()) == pytest.approx(2 * [200.0 * RPM])
    assert max(course.get_ydata()) == pytest.approx(cycle.sheet.peak_torque, rel=1e-4)
    assert max(course.get_xdata()) == pytest.approx(cycle.sheet.peak_speed * 30 / np.pi, rel=1e-4)
    assert max(curve.get_ydata()) == 3.0
    assert len(Cycle(cycle.segments, **EACH).plot()) == 4
    with pytest.raises(InputError, match="no motor"):
        Cycle(cycle.segments, **EACH, drive=TABLE).plot(over="speed")
    with pytest.raises(InputError, match="over"):
        cycle.plot(over="tme")  # type: ignore[arg-type]


@pytest.mark.parametrize("limit", ["700 deg/s", "800 deg/s", "1100 deg/s"])
def test_friction_at_the_first_instant_is_that_of_the_way(limit: str) -> None:
    """The acceleration is 0 there, and rounding decides the sign of the velocity."""
    rubbing = Mechanism("0.8 kg m^2", coulomb="0.3 N m")
    cycle = Cycle(STROKES, period="1 s", drive=rubbing, limits={"velocity": limit})
    assert cycle.force(0.0) == pytest.approx(0.3, rel=1e-6)
    assert cycle.force(0.4) == pytest.approx(-0.3, rel=1e-6)
    assert cycle.force(0.35) == 0.0


def test_least_rms_torque_behind_a_gear_with_losses_has_the_bound_of_its_strokes() -> None:
    drive = Drive(PRESS, Motor("0.001 kg m^2"), ratio=3, efficiency=0.9)
    cycle = Cycle(STROKES, period="1 s", minimise="rms torque", drive=drive)
    limits = [
        drive.limit("rms torque", start, stroke, "0.3 s").value
        for start, stroke in (("0 deg", "180 deg"), ("180 deg", "-180 deg"))
    ]
    assert cycle.lower_bound == pytest.approx(sqrt(0.3 * sum(limit**2 for limit in limits)), rel=1e-6)
    assert cycle.lower_bound is not None
    assert 0.98 < cycle.lower_bound / cycle.objective < 1.0


def test_another_motor_of_the_same_torque_has_the_same_laws() -> None:
    moves = [Rise("45 deg", "0.25 s", law="cycloidal"), Dwell()]

    def driven(**limits: Any) -> Cycle:
        return Cycle(moves, **EACH, drive=Drive(TABLE, Motor("3e-4 kg m^2", **limits), ratio=20, efficiency=0.9))

    cycle, other = driven(rated_torque="2 N m"), Motor("3e-4 kg m^2", curve=[("0 rpm", "4 N m"), ("2000 rpm", "3 N m")])
    weak = cycle.with_motor(other)
    anew = driven(curve=other.curve)
    assert (weak.sheet, weak.efforts, weak.effort) == (anew.sheet, anew.efforts, anew.effort)
    with pytest.raises(InputError, match="another inertia, coulomb, viscous or constant"):
        cycle.with_motor(Motor("4e-4 kg m^2"))
    with pytest.raises(InputError, match="no motor"):
        Cycle(moves, **EACH, drive=TABLE).with_motor(other)
    with pytest.raises(InputError, match="keep the limits of the motor"):
        Cycle(INDEXED, **EACH, drive=cycle.drive, limits={"motor": True}).with_motor(other)


def test_limits_that_are_no_table_are_refused() -> None:
    nothing: Any = None
    with pytest.raises(InputError, match="limits"):
        Cycle(INDEXED, period="0.6 s", advance="45 deg", limits=nothing)


# --- elastic loads ---


LOAD: dict[str, Any] = {"period": "40 ms", "damping": 0.05, "mass": "2 kg"}


def strokes(law: str = "optimal") -> list[Any]:
    return [Rise("30 mm", "120 deg", law=law), Dwell("60 deg"), Return("30 mm", "120 deg", law=law), Dwell()]


def cycle(law: str = "optimal", **others: Any) -> Cycle:
    given: dict[str, Any] = {"speed": "300 rpm", "load": LOAD, "degree": 6} | others
    return Cycle(strokes(law), **given)


@pytest.mark.parametrize("law", ["modified sine", "optimal"])
def test_the_steady_motion_is_that_of_the_follower(law: str) -> None:
    driven = cycle(law)
    rise = driven.durations[0]
    follower = Follower(2 * np.pi * rise / 0.04, 0.05)
    laws = driven.pieces[0].law, driven.pieces[2].law
    mass = follower.cycle(*laws, dwell=0.5, fall_duration=1.0, rest=0.5)
    k, motion = np.linspace(0.0, 2.99, 101), driven.load_motion
    size = 0.03 / rise**2
    assert motion["acceleration"](k * rise) == pytest.approx(size * mass(k, 2), abs=1e-9 * size)
    assert motion["deflection"](k * rise) == pytest.approx(0.03 * mass(k) - driven(k * rise), abs=1e-12)
    assert motion.peak("acceleration").value == pytest.approx(size * mass.peak(2).value, rel=1e-9)
    assert motion.rms("acceleration") == pytest.approx(size * mass.rms(2), rel=1e-9)
    assert motion.peak("force").value == pytest.approx(2 * (2 * np.pi / 0.04) ** 2 * motion.peak("deflection").value)


@pytest.fixture(scope="module")
def others() -> dict[str, Any]:
    """The motions of the load under laws that were not made for it."""
    return {law: cycle(law).load_motion for law in ("modified sine", "cycloidal", "345", "optimal")}


@pytest.mark.sample(3)
@pytest.mark.parametrize("minimise", ["load acceleration", "rms load acceleration", "load force"])
def test_least_of_the_load_is_proven_and_less_than_under_any_other_law(minimise: str, others: dict[str, Any]) -> None:
    best = cycle(minimise=minimise, degree=9)
    assert best.status == "optimal"
    assert len(best.solutions) == 1
    assert best.lower_bound == pytest.approx(best.objective, rel=1e-6)
    output = minimise.rpartition(" ")[2]
    for law in ("modified sine", "cycloidal", "345", "optimal"):
        other = others[law]
        assert best.objective < (other.rms(output) if "rms" in minimise else other.peak(output).value)
    assert best([0.0, 0.2 / 3, 0.1, 0.2 / 6 * 5]) == pytest.approx([0.0, 0.03, 0.03, 0.0], abs=1e-11)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("period", "says"), [("0.1 ms", "vibrates 10000 times"), ("0.02 ms", "below 63 us")])
def test_a_load_with_too_many_peaks_is_refused(period: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        cycle(load={"period": period, "damping": 1e-4}, minimise="load acceleration", speed="60 rpm").status  # noqa: B018


def test_a_load_that_is_too_stiff_is_refused_before_it_is_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    stiff = cycle(load={"period": "0.1 ms", "damping": 1e-4}, minimise="load acceleration", speed="60 rpm")
    machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]])
    monkeypatch.setattr(type(machine.dynamics), "moved", None)
    with pytest.raises(InputError, match="vibrates 10000 times"):
        stiff.status  # noqa: B018 - it is refused by its numbers alone


def test_a_load_may_have_its_frequency_in_place_of_its_period() -> None:
    known = {"damping": 0.05, "mass": "2 kg"}
    standard = [Rise("30 mm", "120 deg", law="modified sine"), Dwell("60 deg"), Return("30 mm", law="modified sine")]
    by_period, by_frequency = (
        Cycle(standard, speed="300 rpm", load=known | given) for given in ({"period": "20 ms"}, {"frequency": "50 Hz"})
    )
    for output in ("acceleration", "deflection", "force"):
        expected = by_period.load_motion.peak(output).value
        assert by_frequency.load_motion.peak(output).value == pytest.approx(expected, rel=1e-12)
    assert by_frequency.to_dict()["load"] == known | {"frequency": "50 Hz"}
    assert Cycle.from_dict(by_frequency.to_dict()) == by_frequency


def test_limits_of_the_load_are_kept() -> None:
    loose = cycle(minimise="rms acceleration")
    most = 0.9 * loose.load_motion.peak("acceleration").value
    kept = cycle(minimise="rms acceleration", limits={"load acceleration": f"{most!r} m/s^2"}, degree=9)
    assert kept.load_motion.peak("acceleration").value <= most * (1 + 1e-9)
    assert kept.status == "optimal"


@pytest.mark.long
def test_any_machine_in_seconds_is_a_load() -> None:
    axis = Machine.from_masses(
        {"motor": 0.0, "head": 2.0},
        [Link("motor", "head", stiffness=5e4, damping=20.0)],
        drive="motor",
        outputs={"belt": "force motor-head"},
    )
    best = cycle(load=axis, minimise="load belt", start="10 mm")
    assert best.status == "optimal"
    assert best.objective < cycle("modified sine", load=axis, start="10 mm").load_motion.peak("belt").value
    assert best(0.0) == pytest.approx(0.01)


def test_limits_of_the_force_are_kept_between_dwells() -> None:
    drive = {"mass": "2 kg", "gravity": "19.6 N", "dry": "5 N"}
    free = cycle(load=None, drive=drive, minimise="jerk", degree=9)
    most = 0.98 * free.effort.peak_force
    kept = cycle(load=None, drive=drive, minimise="jerk", limits={"force": f"{most!r} N"}, degree=9)
    assert kept.effort.peak_force <= most * (1 + 1e-9)
    assert kept.status == "optimal"
    assert kept.objective > free.objective


@pytest.mark.parametrize(
    ("others", "says"),
    [
        ({"load": None, "minimise": "load acceleration"}, "is of a load: give one, such as load="),
        ({"minimise": "load speed"}, "speed.*acceleration"),
        ({"load": {"period": "2 mm"}}, "load: period must be a time"),
        ({"load": {"priod": "2 ms"}}, "load: unknown entry of a load 'priod'; did you mean 'period'"),
        ({"load": {"period": "2 ms", "inertia": "2 kg m^2"}}, "give its mass, not its inertia"),
        ({"load": {"damping": 0.1}}, "load: a load needs its period or its frequency, such as period = "),
        ({"load": {"period": "20 ms", "frequency": "50 Hz"}}, "a load needs its period or its frequency, not both"),
        ({"load": {"frequency": "20 ms"}}, "load: frequency must be a frequency"),
        ({"load": 3}, "load: a load must be a table of period, damping"),
        ({"limits": {"load acceleration": "3 m"}}, "limits, load acceleration must be an acceleration"),
        ({"limits": {"force": "3 m"}}, "limits: force must be a force"),
        ({"load": None, "limits": {"force": "3 N"}}, "are of a drive: give one"),
    ],
)
def test_what_is_wrong_is_said(others: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        cycle(**others).status  # noqa: B018 - laws are looked for when they are asked for
