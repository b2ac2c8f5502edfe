"""Fronts over the time of a move: held against linear programs, against least times, and between their points."""

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Chebyshev,
    Cycle,
    Drive,
    FastestMove,
    InputError,
    Loads,
    Mechanism,
    Motor,
    Problem,
    Return,
    Rise,
    TimeFront,
    at_most,
    belt,
    fastest,
    synthesize,
    time_front,
)
from optlaws.verification import verify
from tests.synthesis.reference import least

LIMITS: dict[str, Any] = {"velocity": "1 m/s", "acceleration": ("-8 m/s^2", "12 m/s^2"), "jerk": "300 m/s^3"}
TABLE = Drive(
    Mechanism("0.8 kg m^2", "20 N m", viscous="0.5 N m s/rad"),
    Motor("3e-4 kg m^2", peak_torque="4 N m", greatest_speed="900 rpm"),
    ratio=20,
)


@pytest.fixture(scope="module")
def move() -> FastestMove:
    return fastest(Problem(order=3), stroke="100 mm", limits=LIMITS)


@pytest.fixture(scope="module")
def front(move: FastestMove) -> TimeFront:
    return time_front(move, "acceleration", points=5)


@pytest.fixture(scope="module")
def turn() -> FastestMove:
    return fastest(Problem(order=3), stroke="45 deg", limits={}, drive=TABLE)


@pytest.mark.sample(3)
@pytest.mark.parametrize(("name", "constant", "nu"), [("acceleration", "C", 2), ("jerk", "J", 3), ("velocity", "B", 1)])
def test_points_are_those_of_a_linear_program(name: str, constant: str, nu: int, move: FastestMove) -> None:
    found = time_front(move, name, longest="0.3 s", points=2)
    assert found.gap < 1e-8
    for point in found:
        unit = point.duration / 0.1
        within = {"C_plus": 12.0 * unit * point.duration, "C_minus": 8.0 * unit * point.duration}
        within |= {"J": 300.0 * unit * point.duration**2}
        bounds = {one: at_most(most) for one, most in within.items()}
        best = least(Problem(order=3, symmetric=False, minimise=constant, B=at_most(unit), bounds=bounds))
        assert best is not None
        assert point.value == pytest.approx(best * 0.1 / point.duration**nu, rel=1e-7)


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", ["torque", "rms torque"])
def test_a_limit_at_a_value_of_the_front_has_its_time_as_the_least(name: str, turn: FastestMove) -> None:
    """Both ways round: what is least in a time, and the least time with that as the limit."""
    point = time_front(turn, name, longest="0.35 s", points=2)[1]
    limited = fastest(Problem(order=3), stroke="45 deg", limits={name: f"{point.value!r} N m"}, drive=TABLE)
    assert limited.duration == pytest.approx(0.35, rel=3e-6)


def test_between_points_laws_keep_the_limits_and_bounds_hold(front: TimeFront, move: FastestMove) -> None:
    for share in (0.1, 0.5, 0.9):
        duration = front.durations[1] + share * (front.durations[2] - front.durations[1])
        between = front(f"{duration!r} s")
        problem = front.objective.problem(move.least.move, duration)
        best = synthesize(problem).objective * 0.1 / duration**2
        assert between.lower_bound <= best <= between.value
        assert between.gap < 0.15
        for limit in move.least.move.limits_in(duration):
            assert limit.constant.value(between.law) <= limit.bound * (1.0 + 1e-9)
    assert front(front.durations[3]) == front[3]


def test_the_torque_of_slower_laws_is_bounded_too(turn: FastestMove) -> None:
    coarse, fine = (time_front(turn, "torque", longest="0.4 s", points=points) for points in (3, 5))
    for duration, point in zip(fine.durations, fine, strict=True):
        between = coarse(min(duration, coarse.durations[-1]))
        assert between.lower_bound <= point.value * (1.0 + 1e-9)
        assert between.value >= point.lower_bound * (1.0 - 1e-9)


@pytest.mark.long
@pytest.mark.parametrize(("name", "unit"), [("residual acceleration", "m/s²"), ("residual displacement", "m")])
def test_the_vibration_left_is_known_at_points_alone(name: str, unit: str, move: FastestMove) -> None:
    elastic = {"frequency": ("15.9 Hz", "17.5 Hz"), "damping": 0.02}
    left = time_front(move, name, points=3, longest="0.3 s", follower=elastic)
    assert left.unit == unit
    assert left.gap < 1e-6
    assert TimeFront.from_json(left.to_json()) == left
    assert left.values[0] > left.values[1] > left.values[2]
    with pytest.raises(InputError, match="may rise with the time"):
        left("0.29 s")
    quiet = fastest(
        Problem(order=3), stroke="100 mm", limits=LIMITS | {name: f"{left.values[1]!r} {unit}"}, follower=elastic
    )
    assert quiet.duration <= left.durations[1] * (1.0 + 1e-6)
    assert not time_front(quiet, "jerk", points=2).falls
    assert time_front(quiet, name, points=2).values[0] == pytest.approx(left.values[1], rel=1e-4)


@pytest.mark.long
def test_energy_is_bounded_by_the_phase_plane(turn: FastestMove) -> None:
    energy = time_front(turn, "energy", drive=TABLE, longest="0.45 s", points=2)[1]
    assert energy.lower_bound <= energy.value
    assert energy.gap < 0.002
    k = np.linspace(0.0, 1.0, 20001)
    stroke, motion = np.pi / 4, [np.asarray(energy.law(k, nu)) for nu in range(3)]
    angle, speed, gain = (motion[nu] * stroke / energy.duration**nu for nu in range(3))
    power = np.asarray(TABLE.torque(angle, speed, gain)) * 20.0 * speed
    assert np.trapezoid(np.maximum(power, 0.0), k) * energy.duration == pytest.approx(energy.value, rel=1e-6)


@pytest.mark.long
@pytest.mark.parametrize("regeneration", [0.0, 0.5, 1.0])
def test_the_energy_of_a_lossy_gear_falls_with_the_time_where_the_load_helps(regeneration: float) -> None:
    lift = belt("30 mm", "8 kg", loads=Loads(gravity="0 deg"))
    motor = Motor("3e-4 kg m^2", peak_torque="30 N m", greatest_speed="9000 rpm")
    drive = Drive(lift, motor, ratio=2.5, regeneration=regeneration, efficiency=0.9)
    least = fastest(Problem(order=3, basis=Chebyshev(5)), stroke="10 rad", limits={}, drive=drive)
    front = time_front(least, "energy", longest=f"{least.duration * 1.5!r} s", points=2, drive=drive)
    for point in front:
        sheet = drive.sheet(point.law, "0 rad", "10 rad", f"{point.duration!r} s")
        assert point.value == pytest.approx(sheet.energy, rel=1e-9)
        assert point.lower_bound <= point.value * (1.0 + 1e-9)


@pytest.mark.parametrize("size", [1e-9, 1e6])
def test_other_units_give_the_same_front(size: float, front: TimeFront) -> None:
    sized = {
        name: tuple(f"{size * float(part.split()[0])!r} {part.split()[1]}" for part in parts)
        if isinstance(parts := limit, tuple)
        else f"{size * float(limit.split()[0])!r} {limit.split()[1]}"
        for name, limit in LIMITS.items()
    }
    other = time_front(fastest(Problem(order=3), stroke=f"{0.1 * size!r} m", limits=sized), "acceleration", points=5)
    assert other.durations == pytest.approx(front.durations, rel=1e-9)
    assert other.values == pytest.approx([size * value for value in front.values], rel=1e-9)


def test_the_table_the_picture_and_the_file_say_the_same(front: TimeFront) -> None:
    lines = front.to_csv().splitlines()
    assert lines[1] == '"time, s","acceleration, m/s²","lower bound, m/s²",gap,status'
    assert float(lines[-1].split(",")[1]) == pytest.approx(front.values[-1], rel=1e-11)
    line, below, least = front.plot()
    assert line.get_ydata() == pytest.approx(front.values)
    assert np.all(below.get_ydata() <= np.interp(below.get_xdata(), line.get_xdata(), front.values) * (1.0 + 1e-9))
    assert least.get_xdata()[0] == pytest.approx(1e3 * front.fastest.duration)
    assert TimeFront.from_json(front.to_json()) == front
    assert "<svg" in front._repr_html_()


def test_a_front_is_verified(turn: FastestMove) -> None:
    data: dict[str, Any] = json.loads(time_front(turn, "rms torque", points=2).to_json())
    verification = verify(data)
    assert verification.proven
    names = [claim.name for claim in verification.claims]
    assert "the times of the points" in names
    assert sum(name.endswith("no law with less rms torque") for name in names) == 2
    for name, by in (("value", 0.999), ("lower_bound", 1.001), ("duration", 1.001)):
        changed = json.loads(json.dumps(data))
        changed["points"][1][name] *= by
        assert not verify(changed).proven


def put(path: tuple[str | int, ...], value: object) -> Callable[[dict[str, Any]], None]:
    """What changes a leaf of a file; of a function, by what it makes of the leaf."""

    def change(data: dict[str, Any]) -> None:
        *way, last = path
        place: Any = data
        for step in way:
            place = place[step]
        place[last] = value(place[last]) if callable(value) else value

    return change


def more(leaf: float) -> float:
    return leaf * 1.00001


DAMAGE: dict[str, Callable[[dict[str, Any]], None]] = {
    "another objective": put(("minimise", "name"), "jerk"),
    "no objective": put(("minimise", "name"), "acceleraton"),
    "a way": put(("minimise", "way"), 3.0),
    "fed back": put(("minimise", "regeneration"), 0.5),
    "a motor": put(("minimise", "torque"), {"inertia": "1"}),
    "a follower": put(("minimise", "residual"), {"lowest": 1.0, "highest": 1.0, "damping": 0.0, "most": 1.0}),
    "more of an objective": put(("minimise", "more"), 1),
    "the move": put(("fastest", "stroke"), more),
    "a unit": put(("fastest", "unit"), "s"),
    "no points": put(("points",), []),
    "a time": put(("points", 1, "duration"), more),
    "no time": put(("points", 1, "duration"), "0.3 s"),
    "a value": put(("points", 1, "value"), more),
    "no value": put(("points", 1, "value"), None),
    "a bound": put(("points", 1, "lower_bound"), more),
    "no bound": put(("points", 1, "lower_bound"), None),
    "a law": put(("points", 1, "solution", "law", "acceleration", 1), 0.0),
    "more of a point": put(("points", 1, "more"), 1),
    "order of points": lambda data: data["points"].reverse(),
    "more": put(("more",), 1),
}


@pytest.mark.parametrize("name", DAMAGE)
def test_damaged_files_are_refused(name: str, front: TimeFront) -> None:
    data = json.loads(front.to_json())
    data["points"] = data["points"][:2]
    TimeFront.from_dict(data)
    DAMAGE[name](data)
    with pytest.raises(InputError):
        TimeFront.from_dict(data)


CHANGES: dict[str, tuple[Callable[[FastestMove], Any], str]] = {
    "no such name": (lambda move: time_front(move, "rms acceleraton"), "did you mean 'rms acceleration'"),
    "no drive": (lambda move: time_front(move, "torque"), "that of a motor: give its drive"),
    "a drive too many": (lambda move: time_front(move, "jerk", drive=TABLE), "of no motor: leave it out"),
    "no follower": (lambda move: time_front(move, "residual acceleration"), "give the follower"),
    "a follower too many": (lambda move: time_front(move, "jerk", follower={"frequency": "1 Hz"}), "of no follower"),
    "too short": (lambda move: time_front(move, "jerk", longest="0.2 s"), "above the least time, 0.24399"),
    "no time": (lambda move: time_front(move, "jerk", longest="2 m"), "longest must be a time"),
    "a point": (lambda move: time_front(move, "jerk", points=1), "points"),
    "many points": (lambda move: time_front(move, "jerk", points=10**6), "at most 1000"),
    "no move": (lambda move: time_front(move.least, "jerk"), "that of a FastestMove"),  # type: ignore[arg-type]
    "beyond": (lambda move: time_front(move, "jerk", points=2)(1.0), "the front goes from"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_what_is_wrong_is_refused(name: str, move: FastestMove) -> None:
    make, message = CHANGES[name]
    with pytest.raises(InputError, match=message):
        make(move)


def test_laws_that_may_turn_back_have_no_torque(turn: FastestMove) -> None:
    swing = fastest(Problem(order=3), stroke="45 deg", limits={"velocity": "4 rad/s"})
    with pytest.raises(InputError, match="never turn back"):
        time_front(swing, "torque", drive=TABLE)
    with pytest.raises(InputError, match="another than that of the move"):
        time_front(turn, "torque", drive=TABLE.with_ratio(25.0))


def a_move(minimise: str = "acceleration", period: str = "0.3 s", **entries: Any) -> Cycle:
    return Cycle([Rise("100 mm")], period=period, advance="100 mm", minimise=minimise, limits=LIMITS, **entries)


@pytest.mark.parametrize("minimise", ["jerk", "rms acceleration"])
def test_the_front_of_a_cycle_of_one_move_has_the_objectives_of_cycles_in_its_times(minimise: str) -> None:
    front = a_move().front(minimise, longest="0.35 s", points=3)
    assert front.fastest.duration == pytest.approx(a_move().fastest().period, rel=1e-9)
    assert front.fastest.best_possible == pytest.approx(a_move().fastest().best_possible, rel=1e-12)
    for point in list(front)[1:]:
        plan = a_move(minimise, f"{point.duration!r} s").solve()
        assert point.value == pytest.approx(plan.objective, rel=1e-6)


@pytest.mark.long
def test_the_front_of_a_cycle_with_a_motor_is_within_its_rating() -> None:
    motor = Motor("3e-4 kg m^2", rated_torque="2 N m", peak_torque="4 N m", greatest_speed="900 rpm")
    drive = Drive(Mechanism("0.8 kg m^2", "20 N m"), motor, ratio=20)
    turn = Cycle([Rise("45 deg")], period="0.4 s", advance="45 deg", drive=drive, limits={"motor": True})
    front = turn.front("rms torque", points=2)
    assert front.fastest.duration == pytest.approx(turn.fastest().period, rel=1e-6)
    assert front.values[0] <= 2.0 * (1.0 + 1e-9)


@pytest.mark.parametrize(
    ("cycle", "says"),
    [
        (Cycle([Rise("35 mm", "0.1 s"), Return()], period="0.3 s"), "a cycle of one move"),
        (Cycle([Rise("35 mm", law="cycloidal")], period="0.1 s", advance="35 mm"), "whose law is optimal"),
        (Cycle([Return("35 mm")], period="0.1 s", advance="-35 mm", limits={"jerk": "90 m/s^3"}), "turn the axis"),
        (
            Cycle(
                [Rise("35 mm", limits={"jerk": "9 m/s^3"})], period="1 s", advance="35 mm", limits={"jerk": "99 m/s^3"}
            ),
            "jerk is that of the cycle and of its move",
        ),
    ],
)
def test_a_front_of_a_cycle_that_is_no_single_move_is_refused(cycle: Cycle, says: str) -> None:
    with pytest.raises(InputError, match=says):
        cycle.front("jerk")
