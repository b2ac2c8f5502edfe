"""Machines and their constants in problem files."""

import pytest

from optlaws import InputError, Machine
from tests.internals.jobs import MachineTable
from tests.internals.mechanisms import Measure


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
