"""Polynomial laws: known constants, conversions, ties, and what is refused."""

from fractions import Fraction
from math import comb, factorial
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import InputError, MotionLaw, Peak, PolynomialLaw, smoothstep
from tests.internals.numerics import chebyshev_from_powers, powers_from_chebyshev

numbers = st.floats(-1e6, 1e6, allow_subnormal=False)


@pytest.mark.parametrize(
    ("order", "B", "C", "D", "J"),
    [
        (1, 1.0, 0.0, 0.0, 0.0),
        (2, 1.5, 6.0, 2 * 3**0.5, 12.0),
        (3, 1.875, 10 / 3**0.5, 6.694268, 60.0),
        (4, 2.1875, 7.513188, 10.750226, 52.5),
        (5, 2.4609375, 9.371976, 15.435936, 78.75),
    ],
)
def test_smoothsteps_have_the_known_constants(order: int, B: float, C: float, D: float, J: float) -> None:
    constants = smoothstep(order).constants
    assert constants.B.value == pytest.approx(B, rel=1e-15)
    assert constants.C.value == pytest.approx(C, abs=1e-6)
    assert constants.D.value == pytest.approx(D, abs=1e-6)
    assert constants.J.value == pytest.approx(J, rel=1e-14)


def test_places_of_the_peaks_of_s_3() -> None:
    constants = smoothstep(3).constants
    assert constants.B.k == 0.5
    assert constants.C.k == pytest.approx(0.5 - 12**-0.5, abs=1e-15)
    assert constants.J.k == 0.0


@pytest.mark.parametrize("order", [3, 12, 30, 76, 84, 88, 100])
def test_the_power_of_a_smoothstep_is_greatest_where_its_closed_form_is(order: int) -> None:
    # d is (k (1 - k))^(2l - 3) (1 - 2k) but for a factor
    assert smoothstep(order).constants.D.k == pytest.approx(0.5 - 0.5 / (4 * order - 5) ** 0.5, abs=2e-14)


@pytest.mark.parametrize("order", [2, 4, 9, 17, 30])
def test_smoothsteps_are_rounded_once(order: int) -> None:
    factor = factorial(2 * order - 1) // factorial(order - 1) ** 2
    powers = [0] * order + [(-1) ** i * factor * comb(order - 1, i) // (order + i) for i in range(order)]
    law = PolynomialLaw.from_powers(powers)
    assert law == smoothstep(order)
    assert sum(powers) == 1


def test_powers_of_simple_laws_come_back_as_integers() -> None:
    assert smoothstep(4).to_powers() == (0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0)
    assert smoothstep(1).to_powers() == (0.0, 1.0)
    assert PolynomialLaw([]).to_powers() == (0.0,)


def test_integers_beyond_the_precision_of_floats_stay_exact() -> None:
    near = PolynomialLaw.from_powers([0, 0, 10**20 + 1, -(10**20)])
    assert near.c(1.0) == pytest.approx(2 - 4 * 10**20, rel=1e-15)
    assert near.exact_powers()[3] == -(10**20)
    assert chebyshev_from_powers([10**30 + 2, -(10**30)])[0] == 2 + 10**30 / 2


@given(st.lists(numbers, min_size=1, max_size=30))
def test_series_and_powers_are_inverse(series: list[float]) -> None:
    exact = PolynomialLaw(series).exact_powers()
    assert PolynomialLaw.from_powers(exact) == PolynomialLaw(series)


@given(st.lists(st.integers(-1000, 1000), min_size=1, max_size=8))
def test_small_integers_survive_both_conversions(powers: list[int]) -> None:
    assert powers_from_chebyshev(chebyshev_from_powers(powers)) == tuple(map(float, powers))


@given(st.lists(numbers, min_size=1, max_size=40))
def test_displacement_series_gives_the_same_displacement(series: list[float]) -> None:
    law = PolynomialLaw.from_chebyshev(series)
    k = np.linspace(0.0, 1.0, 31)
    expected = np.polynomial.chebyshev.chebval(2.0 * k - 1.0, series)
    assert np.allclose(law(k), expected, rtol=0, atol=1e-12 * (1 + np.abs(series).sum() + law.peak(2).value))


def test_powers_may_be_fractions_and_numbers_of_numpy() -> None:
    expected = PolynomialLaw.from_powers([0, 0.5, 0.25])
    assert PolynomialLaw.from_powers([0, Fraction(1, 2), np.float32(0.25)]) == expected
    assert PolynomialLaw.from_powers(np.array([0, 0.5, 0.25])) == expected
    assert PolynomialLaw.from_powers([np.int64(0), 0.5, 0.25]) == expected


def test_zeros_at_the_end_do_not_make_another_law() -> None:
    assert PolynomialLaw([1, 2, 0.0, -0.0]) == PolynomialLaw([1.0, 2.0])
    assert hash(PolynomialLaw([0.0])) == hash(PolynomialLaw([]))
    assert PolynomialLaw(np.array([1.0, 2.0])) == PolynomialLaw((1, 2))
    assert PolynomialLaw([1.0]) != PolynomialLaw([1.0], a0=0.5)


def test_the_law_does_not_follow_the_array_it_was_made_of() -> None:
    series = np.array([0.0, -6.0])
    law = PolynomialLaw(series)
    series[:] = 0.0
    assert law == smoothstep(2)


@pytest.mark.parametrize(
    ("law", "degree"), [(PolynomialLaw([]), 0), (PolynomialLaw([], b0=2.0), 1), (PolynomialLaw([3.0]), 2)]
)
def test_degree_of_the_displacement(law: PolynomialLaw, degree: int) -> None:
    assert law.degree == degree


def test_functions_that_are_zero_peak_at_zero() -> None:
    constants = smoothstep(1).constants
    assert constants.C == constants.D == constants.J == Peak(0.0, 0.0)
    assert smoothstep(1).extrema(2) == (Peak(0.0, 0.0), Peak(0.0, 0.0))
    assert smoothstep(3).peak(40) == Peak(0.0, 0.0)


def test_of_several_equal_peaks_the_first_is_reported() -> None:
    equal = PolynomialLaw([0.0] * 20 + [1.0])  # c = T_20: 21 peaks of magnitude 1
    assert equal.peak(2).k == 0.0
    low, high = equal.extrema(2)
    assert (low.value, high.value, high.k) == pytest.approx((-1.0, 1.0, 0.0), abs=1e-14)
    assert low.k == pytest.approx((1 - np.cos(np.pi / 20)) / 2, abs=1e-14)
    for order in range(3, 31):
        assert smoothstep(order).constants.C.k < 0.5
        assert smoothstep(order).constants.D.k < 0.5


def test_peaks_that_nearly_tie_are_told_apart() -> None:
    tilt = 1e-8
    law = PolynomialLaw([0.0, tilt, 0.0, 0.0, 1.0])  # c = T_4 + tilt x: the peak at x = 1 is the higher
    assert law.peak(2).value == pytest.approx(1 + tilt, rel=1e-15)
    assert law.peak(2).k == 1.0


def test_a_flat_top_keeps_its_value() -> None:
    flat = PolynomialLaw([1 - 35 / 128, 0, -56 / 128, 0, -28 / 128, 0, -8 / 128, 0, -1 / 128])
    x = 2.0 * np.linspace(0, 1, 101) - 1.0
    assert flat.extrema(2)[1].value >= flat.c((x + 1) / 2).max()


@pytest.mark.parametrize("bad", [[np.nan], [np.inf], ["1"], [None], [1j], [[1.0]], "12", 5, None, [1e200]])
def test_numbers_that_are_not_real_and_finite_are_refused(bad: Any) -> None:
    for make in (PolynomialLaw, PolynomialLaw.from_powers, PolynomialLaw.from_chebyshev):
        with pytest.raises(InputError, match=r"must (be|not exceed)"):
            make(bad)


@pytest.mark.parametrize("bad", [np.nan, -np.inf, "1", None, 1j, [1.0], np.ones(2), 1e200])
def test_start_values_that_are_not_real_and_finite_are_refused(bad: Any) -> None:
    with pytest.raises(InputError, match="a0"):
        PolynomialLaw([1.0], a0=bad)
    with pytest.raises(InputError, match="b0"):
        PolynomialLaw([1.0], b0=bad)


@pytest.mark.parametrize("order", [0, -1, 2.0, "2", None, True, [3]])
def test_order_of_a_smoothstep_is_an_integer_from_1(order: Any) -> None:
    with pytest.raises(InputError, match="order must be an integer of at least 1"):
        smoothstep(order)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kind": ["polynomial"]}, "is unknown"),
        ({"a0": float("nan")}, r"a0\[0\] must be a finite real number"),
        ({"acceleration": [float("inf")]}, r"acceleration\[0\] must be a finite real number"),
        ({"acceleration": "abc"}, "acceleration"),
    ],
)
def test_a_wrong_dict_is_refused_with_what_is_wrong(change: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        MotionLaw.from_dict({**smoothstep(3).to_dict(), **change})


def test_a_smoothstep_is_built_once() -> None:
    assert smoothstep(6) is smoothstep(order=6)
