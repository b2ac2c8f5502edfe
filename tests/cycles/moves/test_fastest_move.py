"""`fastest` in machine units: what it reads, what it says, its files and its exports."""

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Cycle,
    Dwell,
    FastestMove,
    InfeasibleProblem,
    InputError,
    Pieces,
    Problem,
    Rise,
    fastest,
    fastest_moves,
    synthesize,
)

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


@pytest.mark.parametrize("stroke", [1e3, 51002.562712464198, pytest.param(3e5, marks=pytest.mark.long)])
def test_pieces_of_a_very_long_move_reach_the_limit(stroke: float) -> None:
    """Ramps that are a hundred-thousandth of the move: 2 sqrt(v/j) + h/v."""
    limits = {"velocity": "1 m/s", "acceleration": "2.718257726 m/s^2", "jerk": "1 m/s^3"}
    smooth = fastest(ORDER_3, stroke=f"{stroke!r} m", limits=limits)
    pieces = Problem(order=3, basis=Pieces(smooth.limit_breaks, degree=3, continuity=2), symmetric=False)
    move = fastest(pieces, stroke=f"{stroke!r} m", limits=limits)
    assert move.duration == pytest.approx(2.0 + stroke, rel=1e-6)
    assert all(proof.stands(move.least.move) for proof in move.least.proofs)
