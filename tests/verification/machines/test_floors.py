"""What peaks of one side are at least: the output where the law begins, exactly."""

from fractions import Fraction
from itertools import product
from math import inf

import pytest

from optlaws import BoundaryConditions, C, Link, Machine, law_from_z
from optlaws.typing import PeakSide
from tests.internals.verification import floor

AXIS = Machine.from_masses(
    {"motor": 0.5, "carriage": 0.25},
    [Link("motor", "carriage", 9.0, 0.5)],
    drive="motor",
    outputs={"force": "drive force", "sway": "deflection motor-carriage", "place": "position carriage"},
    duration=1.0,
    stroke=2.0,
)
DIRECT = Machine(
    [[-1.0, 2.0], [0.0, -3.0]],
    [[1.0, 0.5, 0.0], [0.0, 0.0, 2.0]],
    [[1.0, -1.0], [0.5, 0.25]],
    [[0.5, 0.25, 2.0], [4.0, 0.0, 0.0]],
    inputs="abc",
    outputs=["all", "level"],
)
DRIFTING = Machine([[0.0]], [[1.0]], [[2.0]], inputs="a", outputs=["sum"])
STARTS = [(0.0, 0.0, 0.0), (0.0, 0.5, 0.0), (0.0, 0.0, 3.0), (0.25, 0.0, 0.0), (0.25, -0.5, 3.0), (-0.5, 1.5, -2.0)]


def conditions(start: tuple[float, ...]) -> BoundaryConditions:
    return BoundaryConditions(start, (1.0, *(0.0 for _ in start[1:])))


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize(
    ("machine", "output"),
    [(AXIS, "force"), (AXIS, "sway"), (AXIS, "place"), (DIRECT, "all"), (DIRECT, "level")],
    ids=["force", "sway", "place", "all", "level"],
)
def test_it_is_the_output_where_the_law_begins(machine: Machine, output: str, start: tuple[float, ...]) -> None:
    law = law_from_z(conditions(start), [1.0])
    sides: tuple[PeakSide, PeakSide] = ("high", "low")
    for side, offset in product(sides, (0.0, 0.75)):
        constant = machine.peak(output, side=side, offset=offset)
        least = floor(constant, conditions(start))
        assert isinstance(least, Fraction)
        begun = float(constant.curve(law)(0.0))
        assert float(least) == pytest.approx(begun if side == "high" else -begun, rel=1e-12, abs=1e-12)
        assert least <= Fraction(constant.value(law)) + Fraction(1, 10**9)


def test_nothing_is_known_where_the_beginning_does_not_count() -> None:
    start = conditions((0.0, 0.0, 0.0))
    assert floor(AXIS.peak("sway", side="high", within=(0.1, 1.0)), start) == -inf
    assert floor(AXIS.peak("sway", side="high", cycle=(0.2, 0.3)), start) == -inf
    # the force has c in it, which two conditions do not give
    assert floor(AXIS.peak("force", side="high"), conditions((0.0, 0.0))) == -inf
    assert floor(AXIS.peak("sway", side="high"), conditions((0.0, 0.0))) == 0
    assert floor(DRIFTING.peak("sum", side="high"), conditions((0.0, 0.0))) == 0
    assert floor(DRIFTING.peak("sum", side="high"), conditions((0.5, 0.0))) == -inf


def test_magnitudes_are_at_least_0() -> None:
    assert floor(AXIS.peak("sway", offset=-3.0), conditions((0.25, 0.0, 0.0))) == 0.0
    assert floor(C, conditions((0.0, 0.0))) == C.floor(conditions((0.0, 0.0)))
