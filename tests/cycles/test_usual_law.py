"""The usual law beside a result: which cycles have one, and what differs."""

from typing import Any

import pytest

from optlaws import (
    BarrelCam,
    ConstantVelocity,
    Cycle,
    DiscCam,
    Dwell,
    Free,
    Move,
    Problem,
    Return,
    Rise,
    TranslatingRoller,
    catalogue,
    fastest,
)
from tests.internals.cams import barrel_differences
from tests.internals.cycles import USUAL, usual_cycle
from tests.internals.shown import Difference, Differences

RISE, RETURN = Rise("35 mm", "120 deg"), Return("35 mm", "100 deg")


def test_the_usual_cycle_has_modified_sine_in_its_moves_and_else_the_same_segments() -> None:
    cycle = Cycle([RISE, Dwell("90 deg"), RETURN, Dwell()], speed="200 rpm", limits={"velocity": "1 m/s"})
    usual = usual_cycle(cycle)
    assert usual is not None
    assert [each.label for each in usual.segments] == [each.label for each in cycle.segments]
    known = catalogue[USUAL].law.constants.C.value * 0.035 / (cycle.duration * 100.0 / 360.0) ** 2
    assert usual.peak(2) == pytest.approx(known, rel=1e-12)


@pytest.mark.parametrize(
    "segments",
    [
        [Rise("35 mm", "120 deg", law=USUAL), Return(law=USUAL)],
        [Free("30 mm", "120 deg", via=[("60 deg", "10 mm")]), Return("30 mm", "120 deg"), Dwell()],
        [Move("20 mm", "100 deg", end_velocity="0.2 m/s"), ConstantVelocity("0.2 m/s", "40 deg"), Return()],
    ],
)
def test_there_is_none_where_all_moves_have_it_or_one_is_not_from_rest_to_rest(segments: Any) -> None:
    assert usual_cycle(Cycle(segments, speed="200 rpm")) is None


def test_a_difference_is_a_share_of_the_usual_value_and_nothing_of_0() -> None:
    values = [
        Difference("acceleration", "m/s²", 20.0, 19.0),
        Difference("residual", "m/s²", 0.0, 1.0),
        Difference("jerk", "m/s³", float("inf"), 3.0),
        Difference("prime circle", "mm", None, 50.0),
        Difference("stroke", "mm", 40.0, 40.0),
    ]
    assert [each.change for each in values[:4]] == [pytest.approx(-0.05), None, None, None]
    assert [each.text for each in values] == ["-5.0 %", "", "", "", "same"]
    beside = Differences(USUAL, values)
    assert [row.name for row in beside.rows] == ["acceleration", "residual", "jerk", "stroke"]
    assert beside.section().data["usual_law"]["values"][2]["usual"] is None
    assert not Differences(USUAL, []).section().heading


SINE = catalogue[USUAL].law
LIMITS = {"velocity": "1 m/s", "acceleration": ("-8 m/s^2", "12 m/s^2"), "jerk": "300 m/s^3"}


def beside_of(move: Any) -> dict[str, Any]:
    """The values beside modified sine, by their names."""
    return {each.name: each for each in move.beside.values}


@pytest.mark.parametrize("stroke", [0.02, 0.1, 0.6])
def test_a_least_time_stands_beside_the_closed_form_of_modified_sine(stroke: float) -> None:
    values = beside_of(fastest(Problem(order=3), stroke=f"{stroke} m", limits=LIMITS))
    known = SINE.constants
    terms = (known.B.value * stroke, (known.C.value * stroke / 8.0) ** 0.5, (known.J.value * stroke / 300.0) ** (1 / 3))
    assert values["least time"].usual == pytest.approx(max(terms), rel=1e-12)
    assert values["least time"].chosen < values["least time"].usual
    assert values["jerk"].usual == pytest.approx(known.J.value * stroke / max(terms) ** 3, rel=1e-12)


def test_modified_sine_waits_until_a_vibration_is_within_its_limit() -> None:
    follower = {"frequency": ("13 Hz", "15 Hz"), "damping": 0.02}
    given: Any = {"stroke": "100 mm", "follower": follower, "limits": {**LIMITS, "residual acceleration": "2 m/s^2"}}
    values = beside_of(fastest(Problem(order=3), **given))
    assert values["residual acceleration"].usual == pytest.approx(2.0, rel=1e-9)
    without = beside_of(fastest(Problem(order=3), stroke="100 mm", limits=LIMITS))
    assert values["least time"].usual > without["least time"].usual


@pytest.mark.parametrize("more", [{"limits": {"snap": "30000 m/s^4"}}, {"end_velocity": "0.1 m/s"}])
def test_no_time_of_modified_sine_is_known_where_its_snap_jumps_or_an_end_moves(more: dict[str, Any]) -> None:
    assert fastest(Problem(order=4), **{"stroke": "100 mm", "limits": LIMITS, **more}).beside is None


def test_a_greatest_speed_stands_beside_that_of_modified_sine() -> None:
    limits = {"velocity": "1 m/s", "acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}
    cycle = Cycle([RISE, Dwell("60 deg"), RETURN, Dwell()], speed="60 rpm", limits=limits)
    report: Any = cycle.fastest().report()
    values = beside_of(report)
    sine = Cycle([Rise("35 mm", "120 deg", law=USUAL), Dwell("60 deg"), Return("35 mm", "100 deg", law=USUAL), Dwell()],
                 speed="60 rpm", limits=limits)  # fmt: skip
    assert values["greatest speed"].usual == pytest.approx(sine.fastest().rpm, rel=1e-12)
    assert values["greatest speed"].chosen > values["greatest speed"].usual
    assert report.beside is not None
    assert report.beside.table in report.tables
    without: Any = sine.fastest().report()
    assert without.beside is None


def test_cams_stand_beside_those_of_modified_sine() -> None:
    cycle = Cycle([RISE, Dwell("90 deg"), RETURN, Dwell()], speed="200 rpm", drive={"mass": "2 kg"})
    usual = usual_cycle(cycle)
    assert usual is not None
    best, sine = (DiscCam(motion, "80 mm", TranslatingRoller("12 mm")) for motion in (cycle, usual))
    rows = {row.name: row for row in best.summary()}
    share = 100.0 * (cycle.peak(2) / usual.peak(2) - 1.0)
    assert rows["peak acceleration"].note == f"{share:+.1f} %: modified sine has {usual.peak(2):.5g} m/s²"
    assert "modified sine has" in rows["greatest pressure angle"].note
    assert "modified sine has" in rows["greatest contact force"].note
    assert not [row for row in sine.summary() if "modified sine has" in row.note]
    barrels = [BarrelCam(motion, "60 mm", "12 mm", "8 mm") for motion in (cycle, usual)]
    section = barrel_differences(barrels[0])
    steep = {row.name: row for row in section.facts}["greatest pressure angle at the bottom"]
    angle = 57.29577951308232 * max(abs(each.value) for each in barrels[1].pressure_angles)
    assert f"modified sine has {angle:.5g} deg" in steep.note
    assert not barrel_differences(barrels[1]).heading
