"""The laws that attain the limits have the constants that the limits state."""

from typing import Any

import numpy as np
import pytest

from optlaws import InputError, limit, limit_law
from tests.internals.laws import PowerSegment
from tests.internals.synthesis import jerk_limit

K = np.linspace(0.0, 1.0, 401)


@pytest.mark.parametrize("ulps", [1, 2, 5, 40, 1000, 10**6])
def test_a_law_of_constant_power_loses_no_stretch_in_rounding(ulps: int) -> None:
    B = 1.5 + ulps * np.spacing(1.5)
    law = limit_law("D", B)
    assert law.constants.D.value == pytest.approx(limit("D", B), rel=1e-12)
    assert [law.b(0.5), law.constants.B.value] == pytest.approx([B, B], rel=1e-12)
    assert np.abs(law.a(K) + law.a(1.0 - K) - 1.0).max() <= 1e-13


@pytest.mark.parametrize("B", [1.2, 1.6, 2.5])
def test_at_the_least_jerk_the_trapezoid_is_the_law_of_steps(B: float) -> None:
    steps, trapezoid = limit_law("J", B), limit_law("C", B, J=jerk_limit(B))
    assert trapezoid.b(K) == pytest.approx(steps.b(K), abs=1e-6)


@pytest.mark.parametrize(
    ("constant", "order", "continuity"),
    [("C", 1, 1), ("C", 3, 1), ("D", 3, 1), ("J", 2, 2), ("J", 3, 2), ("RMS", 3, 1)],
)
@pytest.mark.parametrize("monotone", [False, True])
@pytest.mark.parametrize("B", [1.6, 2.4, 3.5])
def test_continuity_is_that_of_the_optimal_control(
    constant: str, order: int, continuity: int, B: float, *, monotone: bool
) -> None:
    law = limit_law(constant, B, order=order, monotone=monotone)
    assert law.continuity == continuity
    assert np.abs(law.c([0.0, 1.0])).max() <= 1e-9 or (constant, order) != ("J", 3)


@pytest.mark.parametrize(
    ("constant", "order", "B"), [("C", 3, 2.0), ("D", 3, 1.5), ("J", 2, 1.5), ("J", 3, 2.0), ("RMS", 2, 1.5)]
)
def test_without_b_the_law_is_the_best_of_all(constant: str, order: int, B: float) -> None:
    assert limit_law(constant, order=order) == limit_law(constant, B, order=order)


def test_known_laws() -> None:
    parabola = limit_law("J", 1.5, order=2)
    assert parabola.a(K) == pytest.approx(3 * K**2 - 2 * K**3, abs=1e-15)
    assert limit_law("RMS").a(K) == pytest.approx(3 * K**2 - 2 * K**3, abs=1e-15)
    power = limit_law("D")
    assert power.b(K[:201]) == pytest.approx(1.5 * np.sqrt(2 * K[:201]), abs=1e-15)
    assert limit_law("C", 2.0).a(K[:201]) == pytest.approx(2 * K[:201] ** 2, abs=1e-15)
    back = limit_law("D", 2.5)
    assert [type(segment) for segment in back.segments] == [PowerSegment] * 6
    assert [round(one.C.value, 9) for one in (limit_law("J").constants,)] == [8.0]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"constant": "B"}, "constant 'B' is unknown"),
        ({"constant": "C", "B": 1.0}, "B must be a finite number above 1"),
        ({"constant": "C", "order": 1}, "B must be given"),
        ({"constant": "J", "B": 2.0, "order": 1}, "order must be an integer of at least 2"),
        ({"constant": "C", "B": 2.0, "J": 10.0}, "J must be a finite number of at least 32"),
    ],
)
def test_a_law_that_makes_no_sense_is_refused(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        limit_law(**arguments)
