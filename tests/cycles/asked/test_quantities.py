"""Quantities with units: what they are in SI, and what errors say of those that are wrong."""

from math import pi
from typing import Any

import pytest
from pint import UnitRegistry

from optlaws import Cycle, Dwell, InputError, Return, Rise
from optlaws.cycles.asked.quantities import DIMENSIONS, either, quantity


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("35 mm", "length", 0.035),
        ("1 in", "length", 0.0254),
        ("45 deg", "angle", pi / 4),
        ("0.5 turn", "angle", pi),
        ("1/12 turn", "angle", pi / 6),
        ("-3/4 in", "length", -0.01905),
        ("500 W", "power", 500.0),
        ("400 ms", "time", 0.4),
        ("616 mm/s", "velocity", 0.616),
        ("200 rpm", "angular velocity", 200 * 2 * pi / 60),
        ("30deg/s", "angular velocity", pi / 6),
        ("12 m/s^2", "acceleration", 12.0),
        ("12 m/s**2", "acceleration", 12.0),
        ("1 g_n", "acceleration", 9.80665),
        ("2.5 kg cm^2", "moment of inertia", 2.5e-4),
        ("0.4 N m", "torque", 0.4),
        ("0.4 N*m", "torque", 0.4),
        ("3 N/mm", "stiffness", 3000.0),
        ("0.01 N m s/rad", "rotary viscous friction", 0.01),
    ],
)
def test_quantities_in_si_units(text: str, dimension: str, value: float) -> None:
    assert quantity(text, dimension, "it") == pytest.approx(value, rel=1e-14)


def test_every_example_of_an_error_is_of_its_dimension() -> None:
    for dimension, (_, example) in DIMENSIONS.items():
        assert either(example, (dimension,), "it")[0] == dimension


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("35 mm", "speed must be an angular velocity such as '200 rpm', but '35 mm' is a length"),
        ("3 Hz", "speed must be an angular velocity such as '200 rpm', but '3 Hz' is a frequency"),
        ("3 Hz^2", r"speed must be an angular velocity such as '200 rpm', but '3 Hz\^2' is of dimension 1 / \[time\]"),
        (200, "speed must be an angular velocity such as '200 rpm', got 200 without a unit"),
        ("200", "got '200' without a unit"),
        ("200 rmp", "the unit of '200 rmp' is not known"),
        ("9**9**9 rpm", "not known"),
        ("1 rpm*9**9**9", "not known"),
        ("1e400 rpm", "finite"),
        ("nan rpm", "got 'nan rpm'"),
        ("fast", "got 'fast'"),
        (None, "got None"),
        ("1 " + "rpm*" * 50 + "rpm", "speed must be"),
    ],
)
def test_what_is_wrong_is_said(given: object, said: str) -> None:
    with pytest.raises(InputError, match=said):
        quantity(given, "angular velocity", "speed")


def test_of_several_dimensions_the_error_names_all() -> None:
    with pytest.raises(InputError, match=r"duration must be an angle such as '45 deg' or a time such as '0\.3 s', but"):
        either("3 mm", ("angle", "time"), "duration")


def test_quantities_of_pint_are_taken_as_their_texts() -> None:
    units: UnitRegistry[Any] = UnitRegistry()
    for given, dimension, expected in (
        (35 * units.mm, "length", 0.035),
        (2 * units.ft, "length", 0.6096),
        (200 * units.rpm, "angular velocity", 200.0 * pi / 30.0),
        (3 * units.N / units.mm, "stiffness", 3000.0),
        (9 * units.lbf, "force", 9 * 4.4482216152605),
        (0.4 * units.N * units.m, "torque", 0.4),
    ):
        assert quantity(given, dimension, "it") == pytest.approx(expected, rel=1e-12)
    for wrong, told in ((35 * units.mm / units.s, "'35.0 mm/s' is a velocity"), (3 * units.K, "'3.0 K' is not known")):
        with pytest.raises(InputError, match=told):
            quantity(wrong, "length", "it")
    asked = [("35 mm", "0.1 s"), (35 * units.mm, 0.1 * units.s)]
    texts, foreign = (
        Cycle([Rise(by=by, duration=time), Dwell(time), Return(duration=time)], period=3 * time if i else "0.3 s")
        for i, (by, time) in enumerate(asked)
    )
    assert Cycle.from_json(foreign.to_json()) == foreign
    assert foreign.peaks == texts.peaks
