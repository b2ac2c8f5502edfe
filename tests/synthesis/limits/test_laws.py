"""The laws that attain the limits have the constants that the limits state."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import InputError, MotionLaw, PiecewiseLaw, limit, limit_law
from tests.internals.laws import PowerSegment
from tests.internals.synthesis import jerk_limit
from tests.sampling import examples

K = np.linspace(0.0, 1.0, 401)
KINDS = [("C", 1), ("C", 3), ("D", 3), ("J", 2), ("J", 3), ("RMS", 3)]

velocities = st.one_of(
    st.floats(1.01, 12.0), st.sampled_from([1.5, 2.0, 3.0]), st.floats(-1e-6, 1e-6).map(lambda e: 1.5 + e)
)


def own(law: PiecewiseLaw, constant: str) -> float:
    constants = law.constants
    return {"C": constants.C.value, "D": constants.D.value, "J": constants.J.value, "RMS": constants.rms_c}[constant]


def check_motion(law: PiecewiseLaw, B: float, *, monotone: bool, rest: bool = True) -> None:
    """Stroke 1, peak velocity B at the middle, symmetry, rest at both ends."""
    constants = law.constants
    # rounded breaks move b by C and a by B times an ulp of 1
    room = 1e-14 * (1.0 + B + max((p.value for p in (constants.C, constants.J) if np.isfinite(p.value)), default=0.0))
    assert law(1.0) == pytest.approx(1.0, abs=room)
    assert law.b(0.5) == pytest.approx(B, rel=1e-12)
    assert constants.B.value == pytest.approx(B, rel=1e-12)
    assert np.abs(law.a(K) + law.a(1.0 - K) - 1.0).max() <= room
    if rest:
        assert np.abs(law.b([0.0, 1.0])).max() <= room
    if monotone:
        assert law.extrema(1)[0].value >= -room


@pytest.mark.sample(6)
@pytest.mark.parametrize("monotone", [False, True])
@pytest.mark.parametrize(("constant", "order"), KINDS)
@examples(60)
@given(B=velocities)
def test_a_limit_law_has_the_limit_for_its_constant(constant: str, order: int, B: float, *, monotone: bool) -> None:
    law = limit_law(constant, B, order=order, monotone=monotone)
    assert own(law, constant) == pytest.approx(limit(constant, B, order=order, monotone=monotone), rel=1e-12)
    check_motion(law, B, monotone=monotone, rest=order > 1)


@pytest.mark.parametrize("ulps", [1, 2, 5, 40, 1000, 10**6])
def test_a_law_of_constant_power_loses_no_stretch_in_rounding(ulps: int) -> None:
    B = 1.5 + ulps * np.spacing(1.5)
    law = limit_law("D", B)
    assert own(law, "D") == pytest.approx(limit("D", B), rel=1e-12)
    check_motion(law, B, monotone=False)


@pytest.mark.sample(2)
@pytest.mark.parametrize("monotone", [False, True])
@examples(80)
@given(B=st.floats(1.05, 6.0), share=st.one_of(st.just(1.0), st.floats(1.0, 1.5), st.floats(1.0, 100.0)))
def test_a_trapezoid_law_has_the_least_acceleration_and_the_jerk_allowed(
    B: float, share: float, *, monotone: bool
) -> None:
    J = share * jerk_limit(B, monotone=monotone)
    law = limit_law("C", B, monotone=monotone, J=J)
    assert own(law, "C") == pytest.approx(limit("C", B, monotone=monotone, J=J), rel=1e-12)
    # of ramps, time is rounded
    assert law.constants.J.value == pytest.approx(J, rel=1e-9)
    assert law.continuity == 2
    assert np.abs(law.c([0.0, 1.0])).max() <= 1e-9 * law.constants.C.value
    check_motion(law, B, monotone=monotone)


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
    law = limit_law(constant, order=order)
    assert law == limit_law(constant, B, order=order)
    assert own(law, constant) == pytest.approx(limit(constant, order=order), rel=1e-14)


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


def test_laws_are_stored_like_all_others() -> None:
    for constant in ("C", "D", "J", "RMS"):
        law = limit_law(constant, 2.3)
        assert MotionLaw.from_json(law.to_json()) == law


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
