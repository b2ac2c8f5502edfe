"""Bounds over parts of the stroke: greatest velocities from both ends in closed form, and between other limits."""

from collections.abc import Callable
from itertools import pairwise
from math import sqrt

import numpy as np
import pytest
from scipy.integrate import quad

from optlaws import InputError, Mechanism
from optlaws.typing import PhasePlane
from tests.internals.synthesis import TorqueLimit, VelocityLimit, limit_of_plane, phase_torque

FREE, LOADED = phase_torque("c"), phase_torque("0.5*c + 0.5*a")


def time_of(square: Callable[[float], float], *breaks: float) -> float:
    """The time of a motion whose squared velocity is known over the position."""
    total, ends = 0.0, [0.0, *breaks, 1.0]
    for low, high in pairwise(ends):
        # a = low + (high - low) sin² x takes the roots away
        def pace(x: float, low: float = low, high: float = high) -> float:
            a = low + (high - low) * np.sin(x) ** 2
            return float((high - low) * np.sin(2.0 * x) / sqrt(square(a)))

        total += quad(pace, 0.0, np.pi / 2, epsabs=1e-10, epsrel=1e-10)[0]
    return total


def test_a_slow_part_takes_the_time_that_it_takes() -> None:
    C, B, low, high = 9.0, 0.8, 0.35, 0.6

    def square(a: float) -> float:
        away = max(low - a, a - high, 0.0)
        return min(2.0 * C * a, 2.0 * C * (1.0 - a), B**2 + 2.0 * C * away)

    rise, fall = (B**2 / (2.0 * C) + low) / 2.0, 1.0 - (B**2 / (2.0 * C) + 1.0 - high) / 2.0
    limit = limit_of_plane(PhasePlane(C=C, velocities=(VelocityLimit(low, high, B),)), "time")
    known = time_of(square, rise, low, high, fall)
    assert known * (1.0 - 1e-4) <= limit.value <= known * (1.0 + 1e-9)
    assert limit.from_json(limit.to_json()) == limit


def test_a_part_of_little_torque_costs_what_the_passes_say() -> None:
    P, weak, low, high = 9.0, 2.0, 0.1, 0.3

    def square(a: float) -> float:
        rising = 2.0 * (P * min(a, low) + weak * min(max(a - low, 0.0), high - low) + P * max(a - high, 0.0))
        return min(rising, 2.0 * P * (1.0 - a))

    meet = 0.5 * (1.0 - (low * P + (high - low) * weak - high * P) / P)
    plane = PhasePlane(limits=(TorqueLimit(FREE, P), TorqueLimit(FREE, weak, start=low, stop=high)))
    limit = limit_of_plane(plane, "time")
    known = time_of(square, low, high, meet)
    assert known * (1.0 - 2e-6) <= limit.value <= known * (1.0 + 1e-9)


@pytest.mark.long
@pytest.mark.parametrize("kind", ["rms torque", pytest.param("peak torque", marks=pytest.mark.long)])
def test_a_bound_over_a_part_is_between_none_and_one_everywhere(kind: str) -> None:
    objective = {"squared": LOADED} if kind == "rms torque" else {"peak": LOADED}
    planes = [
        PhasePlane(**objective, C=9.0, **bounds)  # type: ignore[arg-type]
        for bounds in ({}, {"velocities": (VelocityLimit(0.4, 0.7, 1.3),)}, {"B": 1.3})
    ]
    limits = [limit_of_plane(plane, kind) for plane in planes]  # type: ignore[arg-type]
    assert limits[0].value < 0.999 * limits[1].value
    assert limits[1].value < 0.999 * limits[2].value
    assert max(limit.gap for limit in limits) < 5e-4
    everywhere = PhasePlane(**objective, C=9.0, velocities=(VelocityLimit(0.0, 1.0, 1.3),))  # type: ignore[arg-type]
    known = limits[2].value
    assert 0.999 * known < limit_of_plane(everywhere, kind).value < 1.0001 * known  # type: ignore[arg-type]


@pytest.mark.long
def test_parts_of_the_way_of_a_mechanism_are_positions_of_its_input() -> None:
    table = Mechanism("0.8 kg m^2")
    slow = {"velocity": [("20 deg", "30 deg", "2 rad/s")], "acceleration": "150 rad/s^2"}
    forth = table.limit("rms torque", "0 deg", "45 deg", "0.25 s", limits=slow)
    back = table.limit("rms torque", "50 deg", "-45 deg", "0.25 s", limits=slow)
    assert forth.value == pytest.approx(back.value, rel=1e-5)
    assert forth.value > table.limit("rms torque", "0 deg", "45 deg", "0.25 s").value * 1.1
    with pytest.raises(InputError, match="within the stroke"):
        table.limit("rms torque", "0 deg", "25 deg", "0.25 s", limits=slow)
    with pytest.raises(InputError, match="velocity 1 must be a list of an angle, an angle and an angular"):
        table.limit("rms torque", "0 deg", "45 deg", "0.25 s", limits={"velocity": [("20 deg", "2 rad/s")]})
    with pytest.raises(InputError, match="ascend"):
        VelocityLimit(0.4, 0.2, 1.0)
