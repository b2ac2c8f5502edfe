"""Eq. 8: whatever Z is, the end conditions hold; known laws come out of it."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import beta

from optlaws import BoundaryConditions, Chebyshev, InputError, law_from_z, smoothstep

K = np.linspace(0.0, 1.0, 101)
values = st.floats(-100.0, 100.0, allow_subnormal=False)


@st.composite
def conditions(draw: st.DrawFn) -> BoundaryConditions:
    order = draw(st.integers(1, 6))
    ends = st.lists(values, min_size=order, max_size=order)
    return BoundaryConditions(tuple(draw(ends)), tuple(draw(ends)))


@given(boundary=conditions(), z=st.lists(values, max_size=8))
def test_the_law_is_eq_8_to_the_last_digit(boundary: BoundaryConditions, z: list[float]) -> None:
    order = boundary.order
    law = law_from_z(boundary, z)
    a0, a1 = boundary.a0(), boundary.a1()
    assert len(a0) <= order
    assert len(a1) <= order
    exact = [Fraction(value) for value in z]
    for k in (Fraction(0), Fraction(1, 7), Fraction(1, 2), Fraction(8, 9), Fraction(1)):
        parts = [sum((v * k**n for n, v in enumerate(p)), Fraction(0)) for p in (a0, a1, exact)]
        expected = parts[0] + k**order * (parts[1] + (k - 1) ** order * parts[2])
        assert law.a(float(k)) == pytest.approx(float(expected), abs=1e-12 * max(1.0, law.peak(2).value))


@given(boundary=conditions())
def test_a0_and_a1_alone_meet_the_conditions_exactly(boundary: BoundaryConditions) -> None:
    order = boundary.order
    derivative = [*boundary.a0(), *[Fraction(0)] * order]
    for n, value in enumerate(boundary.a1()):
        derivative[order + n] += value
    for nu in range(order):
        assert derivative[0] == Fraction(boundary.start[nu])
        assert sum(derivative, Fraction(0)) == Fraction(boundary.end[nu])
        derivative = [n * value for n, value in enumerate(derivative)][1:]


def test_classical_laws_are_z_over_a_lower_order() -> None:
    assert law_from_z(BoundaryConditions.rest(2), [-3, 6]) == smoothstep(3)
    assert law_from_z(BoundaryConditions.rest(2), [-3, -4, 30, -20]) == smoothstep(4)


@pytest.mark.parametrize("order", range(1, 9))
def test_rest_to_rest_without_z_is_the_smoothstep(order: int) -> None:
    law = law_from_z(BoundaryConditions.rest(order))
    assert law == smoothstep(order)
    assert law.b(K) == pytest.approx((K * (1 - K)) ** (order - 1) / beta(order, order), abs=1e-12)


def test_z_in_the_chebyshev_basis_is_the_same_z() -> None:
    # T_1(2k-1) = 2k - 1, T_2 = 8k² - 8k + 1
    boundary = BoundaryConditions.rest(3)
    assert law_from_z(boundary, [1.0, 2.0, 3.0], Chebyshev(2)) == law_from_z(boundary, [2.0, -20.0, 24.0])


@pytest.mark.parametrize(
    ("start", "end"),
    [
        ((), ()),
        ((0,), (1, 0)),
        ((0, float("nan")), (1, 0)),
        ((0, 0), (float("inf"), 0)),
        ((0, "0"), (1, 0)),
        ((None,), (1,)),
    ],
)
def test_ends_that_make_no_sense_are_refused(start: tuple[object, ...], end: tuple[object, ...]) -> None:
    with pytest.raises(InputError):
        BoundaryConditions(start, end)


@pytest.mark.parametrize("order", [0, -1, True, 2.0, "2", None])
def test_an_order_that_makes_no_sense_is_refused(order: object) -> None:
    with pytest.raises(InputError, match="order must be an integer of at least 1"):
        BoundaryConditions.rest(order)  # type: ignore[arg-type]


@pytest.mark.parametrize("z", [[float("nan")], [1.0, float("inf")], ["1"], [None]])
def test_a_z_that_makes_no_sense_is_refused(z: list[object]) -> None:
    with pytest.raises(InputError):
        law_from_z(BoundaryConditions.rest(2), z)


def test_boundary_conditions_are_values() -> None:
    assert BoundaryConditions([0, 0], [1, 0]) == BoundaryConditions.rest(2)  # type: ignore[arg-type]
    assert hash(BoundaryConditions.rest(2)) == hash(BoundaryConditions((0, 0), (1, 0)))
    assert BoundaryConditions.rest(5).order == 5
