"""`fastest` in machine units: what it reads and says, its files, and least times within the torque of a motor."""

import json
from collections.abc import Callable
from dataclasses import replace
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

from optlaws import (
    Cycle,
    Drive,
    Dwell,
    FastestMove,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Motor,
    Pieces,
    Problem,
    Rise,
    Status,
    fastest,
    fastest_moves,
    slider_crank,
    smoothstep,
    synthesize,
)
from optlaws.verification import verify

ORDER_3 = Problem(order=3)
LIMITS = {"velocity": "1 m/s", "acceleration": ("-8 m/s^2", "12 m/s^2"), "jerk": "300 m/s^3"}


@pytest.fixture(scope="module")
def move() -> FastestMove:
    return fastest(ORDER_3, stroke="100 mm", limits=LIMITS)


def test_limits_read_alike_in_any_words(move: FastestMove) -> None:
    words = {"deceleration": "8000 mm/s^2", "acceleration": "12 m/s^2", "jerk": ("-0.3 m/ms/s^2", "300 m/s^3")}
    other = fastest(ORDER_3, stroke="0.1 m", limits={"velocity": "60 m/min", **words})
    assert other.duration == pytest.approx(move.duration, rel=1e-12)
    assert other.binding == move.binding == ("acceleration", "deceleration", "jerk")


def test_an_angle_is_a_stroke(move: FastestMove) -> None:
    limits = {"velocity": "1 rad/s", "acceleration": ("-8 rad/s^2", "12 rad/s^2"), "jerk": "300 rad/s^3"}
    turned = fastest(ORDER_3, stroke="0.1 rad", limits=limits)
    assert turned.duration == pytest.approx(move.duration, rel=1e-12)
    assert turned.summary()[2].unit == "rad/s"


def test_the_snap_is_a_limit() -> None:
    limits = {"jerk": "300 m/s^3", "snap": "20000 m/s^4"}
    smooth = fastest(Problem(order=4), stroke="100 mm", limits=limits)
    assert smooth.law.peak(4).value * 0.1 / smooth.duration**4 == pytest.approx(20000.0, rel=1e-9)
    assert smooth.best_possible is not None
    assert smooth.best_possible >= (384.0 * 0.1 / 20000.0) ** 0.25


def test_a_move_that_never_turns_back() -> None:
    limits = {"velocity": ("0 m/s", "1 m/s"), "jerk": "300 m/s^3"}
    forward = fastest(ORDER_3, stroke="6 mm", limits=limits, start_velocity="200 mm/s")
    back = fastest(ORDER_3, stroke="6 mm", limits=limits | {"velocity": "1 m/s"}, start_velocity="200 mm/s")
    assert np.asarray(forward.law(np.linspace(0.0, 1.0, 1001), 1)).min() >= -1e-9
    assert back.duration <= forward.duration * (1.0 + 1e-9)


def test_too_fast_to_stop_without_turning_back() -> None:
    """From 200 mm/s it stops within 5.2 mm at best."""
    limits = {"velocity": ("0 m/s", "1 m/s"), "jerk": "300 m/s^3"}
    with pytest.raises(InfeasibleProblem, match="velocities at the ends contradict"):
        fastest(ORDER_3, stroke="2 mm", limits=limits, start_velocity="200 mm/s")


def test_many_strokes_are_as_fast_as_one_by_one(move: FastestMove) -> None:
    strokes = ["400 mm", "100 mm", "3 mm", "90 mm"]
    moves = fastest_moves(ORDER_3, strokes=strokes, limits=LIMITS)
    assert [each.stroke for each in moves] == pytest.approx([0.4, 0.1, 0.003, 0.09])
    assert moves[1].duration == pytest.approx(move.duration, rel=1e-9)
    assert moves[2].duration == pytest.approx(fastest(ORDER_3, stroke="3 mm", limits=LIMITS).duration, rel=1e-9)
    assert all(proof.stands(each.least.move) for each in moves for proof in each.least.proofs)


def test_strokes_are_of_one_kind() -> None:
    with pytest.raises(InputError, match="jerk must be an angular jerk"):
        fastest_moves(ORDER_3, strokes=["1 mm", "1 deg"], limits={"jerk": "1 m/s^3"})
    with pytest.raises(InputError, match="strokes"):
        fastest_moves(ORDER_3, strokes="1 mm", limits={"jerk": "1 m/s^3"})


def test_the_summary_says_which_limits_bind(move: FastestMove) -> None:
    rows = {row.name: row for row in move.summary()}
    assert rows["least time"].unit == "s"
    assert rows["deceleration"].value == pytest.approx(8.0, rel=1e-9)
    assert rows["deceleration"].note == "binds: 10 % more saves 1.7 % of the time"
    assert rows["velocity"].note == "81.4 % of the limit"
    assert "the least time is 1.6 % above it" in rows["best possible"].note
    assert move.notes[0].startswith("acceleration: 10 % more saves")


def test_what_more_of_a_limit_saves_is_that_of_the_move_within_it(move: FastestMove) -> None:
    gains = move.gains(0.1)
    assert gains["velocity"] == 0.0  # which does not bind
    si = {"velocity": 1.0, "acceleration": 12.0, "deceleration": 8.0, "jerk": 300.0}
    units = {"velocity": "m/s", "acceleration": "m/s^2", "deceleration": "m/s^2", "jerk": "m/s^3"}
    for name in move.binding:
        raised = {each: f"{most * (1.1 if each == name else 1.0)!r} {units[each]}" for each, most in si.items()}
        again = fastest(ORDER_3, stroke="100 mm", limits=raised)
        assert gains[name] == pytest.approx(1.0 - again.duration / move.duration, rel=1e-6)
        assert f"{name}: 10 % more saves {100.0 * gains[name]:.2g} % of the time" in move.notes


def test_the_export_has_the_stroke_and_the_time(move: FastestMove) -> None:
    last = move.export("csv", points=3).text.split()[-1].split(",")
    assert float(last[0]) == pytest.approx(move.duration)
    assert float(last[1]) == pytest.approx(100.0)
    assert "least time" in move.export("codesys-cambuilder", master="120 deg").text


def test_a_move_answers_as_the_plan_of_a_cycle_does(move: FastestMove) -> None:
    rise = Rise("100 mm", f"{move.duration!r} s", law=move.law)
    cycle = Cycle([rise, Dwell()], period="1 s", advance="100 mm")
    times = np.linspace(0.0, move.duration, 41)[:-1]
    for nu in range(4):
        assert move.peak(nu) == pytest.approx(cycle.peak(nu), rel=1e-12)
        assert move(times, nu) == pytest.approx(cycle(times, nu), rel=1e-9, abs=1e-9 * move.peak(nu))
    motion, report = move.motion("90 deg"), move.report()
    assert not motion.repeats
    assert motion.stop == 90.0
    assert motion(45.0) == pytest.approx(1e3 * move(0.5 * move.duration), rel=1e-12)
    assert "least time" in motion.proof[0]
    assert move.summary() == report.facts
    assert len(move.plot()) >= len(report.panels)
    assert move.polynomials(unit="m").coefficients[0][1] == pytest.approx(0.0, abs=1e-12)
    assert move._repr_html_().count("<svg") == 4
    with pytest.raises(InputError, match=r"a move lasts from 0 to 0\.24\d* s, got -0\.1"):
        move(-0.1)


def test_a_longer_time_leaves_room_for_less_heat(move: FastestMove) -> None:
    heat = [
        synthesize(replace(move.within(f"{share * move.duration!r} s"), minimise="rms_c")).objective / share**2
        for share in (1.01, 1.1)
    ]
    assert heat[1] < 0.95 * heat[0]
    with pytest.raises(InputError, match="duration must be at least the least time"):
        move.within("0.2 s")


def test_pieces_between_the_segments_reach_the_limit() -> None:
    """With and without a time at constant velocity, whose ends may be one."""
    for limits in ({"acceleration": "12 m/s^2", "jerk": "300 m/s^3"}, {"velocity": "0.5 m/s", "jerk": "300 m/s^3"}):
        smooth = fastest(ORDER_3, stroke="100 mm", limits=limits)
        pieces = Problem(order=3, basis=Pieces(smooth.limit_breaks, degree=3, continuity=2))
        assert fastest(pieces, stroke="100 mm", limits=limits).price == pytest.approx(0.0, abs=1e-9)


def damaged(change: Callable[[dict[str, Any]], None], move: FastestMove) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(move.to_json())
    change(data)
    return data


CHANGES: dict[str, Callable[[dict[str, Any]], None]] = {
    "unit": lambda data: data.update(unit="s"),
    "stroke": lambda data: data.update(stroke=0.0999),
    "limit of the jerk": lambda data: data["limits"].update(jerk=299.0),
    "another limit": lambda data: data["limits"].update(snap=9e9),
    "duration": lambda data: data.update(duration=data["duration"] * 0.9999),
    "best possible": lambda data: data.update(best_possible=data["best_possible"] * 1.001),
    "space": lambda data: data["space"].update(order=4),
    "start velocity": lambda data: data.update(start_velocity=0.1),
    "law": lambda data: data["solution"]["law"]["acceleration"].__setitem__(1, 0.0),
    "no proof": lambda data: data.update(proofs=[]),
    "times of a proof": lambda data: data["proofs"][0].update(longest=data["proofs"][0]["longest"] * 1.00001),
    "a contact": lambda data: data["proofs"][0]["certificate"]["contacts"].pop(0),
    "further": lambda data: data.update(more=1),
}


@pytest.mark.parametrize("name", CHANGES)
def test_damaged_files_are_refused(name: str, move: FastestMove) -> None:
    with pytest.raises(InputError):
        FastestMove.from_dict(damaged(CHANGES[name], move))


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"stroke": "-100 mm"}, "stroke must be above 0, got '-100 mm': turn the axis"),
        ({"stroke": "0 mm"}, "stroke must be above 0, got '0 mm': give how far it moves"),
        ({"stroke": "1 s"}, "stroke must be a length"),
        ({"limits": {"speed": "1 m/s"}}, "unknown limit 'speed'"),
        ({"limits": {"acceleraton": "1 m/s^2"}}, "did you mean 'acceleration'"),
        ({"limits": {}}, "limits must name one at least"),
        ({"limits": {"velocity": "1 rad/s"}}, "limits: velocity must be a velocity"),
        ({"limits": {"velocity": "0 m/s"}}, "limits: velocity must be above 0"),
        ({"limits": {"velocity": ("-1 m/s", "2 m/s")}}, "must be opposite or begin with 0"),
        ({"limits": {"jerk": ("-1 m/s^3", "2 m/s^3")}}, "limits: jerk: its two values must be opposite"),
        ({"limits": {"acceleration": ("2 m/s^2", "3 m/s^2")}}, "limits: acceleration: the least must be below 0"),
        ({"limits": {"acceleration": ("-2 m/s^2", "3 m/s^2"), "deceleration": "1 m/s^2"}}, "given twice"),
        ({"start_velocity": "2 m/s"}, "start_velocity is beyond the limit"),
    ],
)
def test_wrong_inputs_are_named(changes: dict[str, Any], named: str) -> None:
    with pytest.raises(InputError, match=named):
        fastest(ORDER_3, **({"stroke": "100 mm", "limits": LIMITS} | changes))


@pytest.mark.parametrize("stroke", [1e3, 51002.562712464198, 70656.8, pytest.param(3e6, marks=pytest.mark.long)])
def test_pieces_of_a_very_long_move_reach_the_limit(stroke: float) -> None:
    """Ramps that are a millionth of the move: 2 sqrt(v/j) + h/v."""
    limits = {"velocity": "1 m/s", "acceleration": "2.718257726 m/s^2", "jerk": "1 m/s^3"}
    smooth = fastest(ORDER_3, stroke=f"{stroke!r} m", limits=limits)
    pieces = Problem(order=3, basis=Pieces(smooth.limit_breaks, degree=3, continuity=2), symmetric=False)
    move = fastest(pieces, stroke=f"{stroke!r} m", limits=limits)
    assert move.duration == pytest.approx(2.0 + stroke, rel=1e-6)
    assert all(proof.stands(move.least.move) for proof in move.least.proofs)


# --- within the torque of a motor ---


#: inertia at the motor: 3e-4 kg m^2 with the ratio squared, seen from the table
TABLE = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=20)
SEEN = 0.8 + 3e-4 * 20**2


def test_a_torque_of_inertia_alone_is_a_limit_of_the_acceleration() -> None:
    by_torque = fastest(ORDER_3, stroke="45 deg", limits={"torque": "4 N m"}, drive=TABLE)
    limits = {"velocity": ("0 rad/s", "1e6 rad/s"), "acceleration": f"{4 * 20 / SEEN!r} rad/s^2"}
    by_acceleration = fastest(ORDER_3, stroke="45 deg", limits=limits)
    assert by_torque.duration == pytest.approx(by_acceleration.duration, rel=1e-8)
    assert by_torque.best_possible == pytest.approx(by_acceleration.best_possible, rel=1e-6)
    assert by_torque.status is Status.OPTIMAL
    assert by_torque.binding == ("torque",)
    names = [panel.name for panel in by_torque.report().panels]  # no limit of the motion itself
    assert names == ["position", "velocity", "acceleration", "jerk"]


def test_a_constant_load_makes_the_acceleration_one_sided() -> None:
    table = Drive(
        Mechanism("0.8 kg m^2", "20 N m", coulomb="4 N m"), Motor("3e-4 kg m^2", peak_torque="4 N m"), ratio=20
    )
    by_torque = fastest(ORDER_3, stroke="45 deg", limits={"jerk": "4000 rad/s^3"}, drive=table)
    pair = (f"{-(80 + 24) / SEEN!r} rad/s^2", f"{(80 - 24) / SEEN!r} rad/s^2")
    limits = {"velocity": ("0 rad/s", "1e6 rad/s"), "acceleration": pair, "jerk": "4000 rad/s^3"}
    by_acceleration = fastest(ORDER_3, stroke="45 deg", limits=limits)
    assert by_torque.duration == pytest.approx(by_acceleration.duration, rel=1e-8)


def test_the_root_mean_square_is_that_of_the_acceleration() -> None:
    by_torque = fastest(ORDER_3, stroke="45 deg", limits={"rms torque": "2 N m"}, drive=TABLE)
    least = synthesize(Problem(order=3, monotone=True, minimise="rms_c", symmetric=False))
    assert by_torque.duration == pytest.approx(sqrt(SEEN / 20 * (pi / 4) * least.objective / 2.0), rel=1e-7)
    assert by_torque.gap <= 1.1e-6


def test_many_strokes_are_as_fast_as_one_by_one_and_begin_near_each_other() -> None:
    strokes = ["60 deg", "44 deg", "45 deg", "46 deg"]
    moves = fastest_moves(ORDER_3, strokes=strokes, limits={"rms torque": "2 N m", "torque": "4 N m"}, drive=TABLE)
    alone = fastest(ORDER_3, stroke="45 deg", limits={"rms torque": "2 N m", "torque": "4 N m"}, drive=TABLE)
    assert moves[2].duration == pytest.approx(alone.duration, rel=1e-8)
    assert [move.status for move in moves] == [Status.OPTIMAL] * 4
    # inertia alone: times are as the roots of the strokes
    assert [move.duration for move in moves] == pytest.approx(
        [alone.duration * sqrt(move.stroke / alone.stroke) for move in moves], rel=2e-6
    )
    for move in moves:
        assert all(proof.stands(move.least.move) for proof in move.least.proofs)


@pytest.fixture(scope="module")
def sticky() -> FastestMove:
    """With viscous friction and a greatest speed of the motor that binds."""
    motor = Motor("3e-4 kg m^2", peak_torque="4 N m", greatest_speed="900 rpm")
    drive = Drive(Mechanism("0.8 kg m^2", "20 N m", viscous="0.5 N m s/rad"), motor, ratio=20)
    return fastest(ORDER_3, stroke="45 deg", limits={}, drive=drive)


def test_viscous_friction_and_the_greatest_speed(sticky: FastestMove) -> None:
    k, turn = np.linspace(0.0, 1.0, 4001), pi / 4
    b, c = (turn * np.asarray(sticky.law(k, nu)) / sticky.duration**nu for nu in (1, 2))
    torque = (SEEN * c + 0.5 * b + 20.0) / 20.0
    assert np.abs(torque).max() == pytest.approx(4.0, rel=1e-6)
    assert b.max() * 20 * 30 / pi == pytest.approx(900.0, rel=1e-6)
    assert b.min() >= -1e-9
    assert sticky.binding == ("velocity", "torque")
    assert sticky.status is Status.OPTIMAL


def test_law_and_proof_of_a_drive_are_one_file(sticky: FastestMove) -> None:
    assert FastestMove.from_json(sticky.to_json()) == sticky
    assert verify(sticky.to_dict()).proven
    data: dict[str, Any] = sticky.to_dict()
    data["torque"] = data["torque"] | {"peak": 3.9}
    with pytest.raises(InputError):
        FastestMove.from_dict(data)


@pytest.mark.long
def test_a_crank_is_bounded_by_the_phase_plane() -> None:
    press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
    drive = Drive(press, Motor("3e-4 kg m^2"), ratio=5)
    space = Problem(order=2)
    move = fastest(space, stroke="180 deg", limits={"torque": "4 N m"}, drive=drive)
    assert move.best_possible is not None
    assert move.status is Status.LOCAL
    assert 0.0 < move.duration / move.best_possible - 1.0 < 0.2
    assert move.none_below == move.best_possible
    assert drive.sheet(move.law, "0 deg", "180 deg", move.duration).peak_torque == pytest.approx(4.0, rel=1e-6)
    assert drive.sheet(smoothstep(3), "0 deg", "180 deg", move.duration).peak_torque > 4.0


@pytest.mark.long
def test_a_gear_that_loses_power_makes_the_acceleration_one_sided() -> None:
    """The load costs more before the gear while it is driven, and gives back less while it is braked."""
    lossy = Drive(Mechanism("0.8 kg m^2", "20 N m"), Motor("3e-4 kg m^2"), ratio=20, efficiency=(0.9, 0.8))
    by_torque = fastest(ORDER_3, stroke="45 deg", limits={"torque": "4 N m", "jerk": "4000 rad/s^3"}, drive=lossy)
    up = (4.0 - 1.0 / 0.9) / (3e-4 * 20 + 0.04 / 0.9)
    down = (-4.0 - 1.0 * 0.8) / (3e-4 * 20 + 0.04 * 0.8)
    pair = (f"{down!r} rad/s^2", f"{up!r} rad/s^2")
    limits = {"velocity": ("0 rad/s", "1e6 rad/s"), "acceleration": pair, "jerk": "4000 rad/s^3"}
    by_acceleration = fastest(ORDER_3, stroke="45 deg", limits=limits)
    assert by_torque.duration == pytest.approx(by_acceleration.duration, rel=1e-8)
    assert by_torque.status is Status.OPTIMAL


CURVE = [("0 rpm", "4 N m"), ("500 rpm", "4 N m"), ("900 rpm", "2 N m")]
FRICTION = {"coulomb": "0.1 N m", "viscous": "1e-3 N m s/rad"}


@pytest.fixture(scope="module", params=[pytest.param(1.0, marks=pytest.mark.long), (0.85, 0.7)])
def curved(request: pytest.FixtureRequest) -> tuple[Drive, FastestMove]:
    """Below a curve of torque over speed, with viscous friction on both sides of a gear."""
    motor = Motor("3e-4 kg m^2", curve=CURVE, friction=FRICTION)
    mechanism = Mechanism("0.8 kg m^2", "20 N m", viscous="0.5 N m s/rad")
    drive = Drive(mechanism, motor, ratio=20, efficiency=request.param)
    return drive, fastest(ORDER_3, stroke="45 deg", limits={}, drive=drive)


def feasible(drive: Drive, duration: float, terms: int) -> bool:
    """Whether a linear program of places alone finds a law below the curve in a time."""
    x = np.linspace(-1.0, 1.0, 301)
    series = [np.polynomial.Chebyshev(row) for row in np.eye(terms)]
    c, b = (np.array([f(x) for f in functions]).T for functions in (series, [f.integ(lbnd=-1) / 2 for f in series]))
    turn, i, (to_load, back) = pi / 4, drive.ratio, drive.efficiencies
    v, w = turn * b / duration, turn * c / duration**2
    behind, motor = 0.8 * w + 0.5 * v, 3e-4 * i * w + 1e-3 * i * v
    rows, most = [-b, i * v], [0.0, 900 * pi / 30]
    for at_rest, fall in ((4.0, 0.0), (6.5, 2.0 / (400 * pi / 30))):
        for sign, share in ((1.0, 1.0 / to_load), (1.0, back), (-1.0, back)):
            rows.append(sign * (motor + share * behind / i) + fall * i * v)
            most.append(at_rest - sign * (0.1 + share * 20.0 / i))
    ends = np.array([[f(-1.0), f(1.0), f.integ(lbnd=-1)(1.0), (f.integ(2, lbnd=-1) / 4)(1.0)] for f in series]).T
    right = np.repeat(most, len(x))
    return linprog(np.zeros(terms), np.vstack(rows), right, ends, [0.0, 0.0, 0.0, 1.0], bounds=(None, None)).status == 0


@pytest.mark.long
def test_it_runs_along_the_motors_curve_and_no_faster(curved: tuple[Drive, FastestMove]) -> None:
    drive, move = curved
    k, turn = np.linspace(0.0, 1.0, 4001), pi / 4
    a, b, c = (turn * np.asarray(move.law(k, nu)) / move.duration**nu for nu in range(3))
    used = np.abs(drive.torque(a, b, c)) / drive.motor.peak_at(20.0 * b)
    assert used.max() == pytest.approx(1.0, rel=1e-5)
    assert "motor's curve" in move.binding
    assert move.status is Status.OPTIMAL
    assert move.best_possible is not None
    assert 0.85 * move.duration < move.best_possible < move.duration
    law: Any = move.law
    terms = len(law.acceleration)
    assert feasible(drive, 1.0001 * move.duration, terms)
    assert not feasible(drive, 0.999 * move.duration, terms)


@pytest.mark.long
def test_a_curve_and_a_gear_are_in_the_file(curved: tuple[Drive, FastestMove]) -> None:
    _, move = curved
    assert FastestMove.from_json(move.to_json()) == move
    assert verify(move.to_dict()).proven
    data = move.to_dict()
    lines = data["torque"]["curve"]
    changes: list[dict[str, Any]] = [{"curve": []}, {"curve": [[1.0]]}, {"curve": [[0.9 * lines[0][0], lines[0][1]]]}]
    changes += [{"gear": {}}, {"gear": {"to_load": 0.9, "back": 0.9, "inertia": 0.0, "friction": 0.0, "load": 0.0}}]
    for change in changes:
        with pytest.raises(InputError):
            FastestMove.from_dict(data | {"torque": data["torque"] | change})


def test_a_motor_that_brakes_itself_against_friction_is_not_proven() -> None:
    """Where the motor's own inertia is braked while the load still rubs, the limit that is kept is the tighter one."""
    heavy = Drive(Mechanism("0.01 kg m^2", "30 N m"), Motor("3e-3 kg m^2"), ratio=20, efficiency=0.9)
    move = fastest(Problem(order=2), stroke="45 deg", limits={"torque": "4 N m"}, drive=heavy)
    assert move.status is Status.LOCAL
    assert move.best_possible is not None
    assert move.none_below == move.best_possible < move.duration
    assert heavy.sheet(move.law, "0 deg", "45 deg", move.duration).peak_torque <= 4.0 * (1.0 + 1e-9)


@pytest.mark.long
def test_a_root_mean_square_behind_a_lossy_gear_is_kept() -> None:
    lossy = Drive(Mechanism("0.8 kg m^2", "20 N m"), Motor("3e-4 kg m^2"), ratio=20, efficiency=0.85)
    move = fastest(ORDER_3, stroke="45 deg", limits={"rms torque": "2 N m"}, drive=lossy)
    assert lossy.sheet(move.law, "0 deg", "45 deg", move.duration).rms_torque == pytest.approx(2.0, rel=1e-6)
    assert move.status is Status.LOCAL
    assert move.best_possible is None or move.best_possible < move.duration


@pytest.mark.parametrize(
    ("drive", "limits", "named"),
    [
        (TABLE, {}, "nothing limits the torque"),
        (TABLE, {"torque": "3 kg"}, "limits: torque must be a torque"),
        (Drive(Mechanism("1 kg m^2", "90 N m"), Motor(0.0), ratio=20), {"rms torque": "4.5 N m"}, "no time keeps it"),
        (Drive(Mechanism("1 kg m^2", "72 N m"), Motor(0.0), ratio=20, efficiency=0.9), {"torque": "4 N m"}, "no time"),
        (Drive(Mechanism("1 kg m^2"), Motor(0.0, curve=[(0, 4), (50, 1), (90, 0)])), {}, "bends upwards"),
        (Drive(Mechanism("1 kg m^2", "90 N m"), Motor(0.0), ratio=20), {"torque": "4 N m"}, "no time keeps it"),
        (None, {"torque": "3 N m"}, "give its drive"),
    ],
)
def test_limits_that_no_time_keeps_are_named(drive: Drive | None, limits: dict[str, str], named: str) -> None:
    with pytest.raises(InputError, match=named):
        fastest(ORDER_3, stroke="45 deg", limits=limits, drive=drive)


def test_a_drive_moves_from_rest_to_rest() -> None:
    with pytest.raises(InputError, match="from rest to rest"):
        fastest(ORDER_3, stroke="45 deg", limits={"torque": "3 N m"}, drive=TABLE, start_velocity="1 rad/s")
