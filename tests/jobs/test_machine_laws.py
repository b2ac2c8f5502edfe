"""Machines and their constants in problem files."""

from typing import Any

import pytest

from optlaws import Chebyshev, InfeasibleProblem, InputError, Machine, Problem, at_most, synthesize
from tests.internals.jobs import MachineTable, solution_of_sought
from tests.internals.mechanisms import Measure

PARTS: dict[str, Any] = {"order": 3, "basis": Chebyshev(13), "symmetric": False}


def test_measured_modes_are_a_machine() -> None:
    table = MachineTable(modes=[[8.5, 0.02], [31.0, 0.01, 0.2]], duration=0.4, stroke=0.3, outputs=["deflection"])
    modes = [(8.5, 0.02), (31.0, 0.01, 0.2)]
    assert table.machine() == Machine.from_modes(modes, duration=0.4, stroke=0.3, outputs=["deflection"])
    with pytest.raises(InputError, match="machine: the damping ratio of mode 1"):
        MachineTable(modes=[[8.5, 2.0]]).machine()
    with pytest.raises(InputError, match="or modes, or matrices"):
        MachineTable(modes=[[8.5, 0.02]], masses={"m": 1.0}).machine()


def test_sides_and_loads_are_those_of_the_machine() -> None:
    arm = Machine.from_modes([(8.5, 0.02)], duration=0.4)
    assert Measure(peak="deflection", side="low", offset=2.0).functional(arm) == arm.peak(
        "deflection", side="low", offset=2.0
    )
    assert Measure(rms="velocity", offset=-1.0).functional(arm) == arm.rms("velocity", offset=-1.0)


def test_limits_without_a_law_are_stated_with_those_that_have_one() -> None:
    machine = Machine.from_modes([(5.0, 0.01)], duration=0.5, stroke=0.4)
    sway = machine.residual(1, "deflection", spread=0.15)
    problem = Problem(**PARTS, bounds={sway: at_most(3e-4), "J": at_most(150.0)})
    with pytest.raises(InfeasibleProblem, match="With the other limits unchanged, laws are found from ") as caught:
        solution_of_sought(problem)
    stated = float(str(caught.value.args[0]).split("laws are found from ")[1].split(" on")[0])
    assert "in place of 0.0003" in str(caught.value.args[0])
    assert synthesize(Problem(**PARTS, bounds={sway: at_most(stated), "J": at_most(150.0)})).law.peak(3).value <= 150.01
    with pytest.raises(InfeasibleProblem):
        synthesize(Problem(**PARTS, bounds={sway: at_most(0.99 * stated), "J": at_most(150.0)}))
