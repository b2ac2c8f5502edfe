"""The usual law beside a result: which cycles have one, and what differs."""

from typing import Any

import pytest

from optlaws import ConstantVelocity, Cycle, Dwell, Free, Move, Return, Rise, catalogue
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
