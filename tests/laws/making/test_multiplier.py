"""The multiplier method (1.6): against Savin's families, against quadrature, and what it refuses."""

import itertools
from fractions import Fraction
from math import cos, exp, pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    InputError,
    MotionLaw,
    PiecewiseLaw,
    PolynomialLaw,
    SavinFamily,
    catalogue,
    multiplied_law,
    multiplier_for,
    savin,
    scca,
    smoothstep,
    trapezoid,
    with_end_velocity,
)
from tests.internals.laws import PowerSegment
from tests.laws.examples import cut, random_law
from tests.sampling import examples

K = np.linspace(0.0, 1.0, 201)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)
QUARTIC = [2, -7, 11, -8, 4]  # 2 - 7 p + 4 p², p = k (1 - k)
LAWS: dict[str, MotionLaw] = {
    "S_3": smoothstep(3),
    "S_4 in three pieces": cut(smoothstep(4), 0.2, 0.55),
    "cycloid": catalogue["cycloidal"].law,
    "modified sine": scca(0.25, 0.0, 0.75),
    "sine, coast": scca(0.2, 0.1, 0.3),
    "S-curve": trapezoid(0.1, 0.15, 0.2),
    "fall like x^1.5": trapezoid(0.03, 0.17, exponent=1.5),
    "moving at both ends": with_end_velocity(smoothstep(4), 0.3),
}
MULTIPLIERS: dict[str, Any] = {
    "quadratic": ([Fraction(3, 2), -2, 2], lambda k: 1.5 - 2 * k + 2 * k * k),
    "quartic": (QUARTIC, lambda k: 2 - 7 * k + 11 * k**2 - 8 * k**3 + 4 * k**4),
    "exponential": (lambda k: exp(3 * (k - 0.5) ** 2), lambda k: np.exp(3 * (k - 0.5) ** 2)),
    "cosine": (lambda k: 1 + 0.9 * cos(2 * pi * k), lambda k: 1 + 0.9 * np.cos(2 * np.pi * k)),
}


def stroke(law: MotionLaw, y: Any) -> float:
    """The stroke of c y from rest, by quadrature piece by piece."""
    breaks = law.breaks if isinstance(law, PiecewiseLaw) else (0.0, 1.0)
    total = 0.0
    for low, high in itertools.pairwise(breaks):
        # k = low + (high - low) t² (3 - 2t): a power of time to either end is smooth in t
        t = 0.5 * (NODES + 1.0)
        k = low + (high - low) * t * t * (3.0 - 2.0 * t)
        weights = 0.5 * WEIGHTS * (high - low) * 6.0 * t * (1.0 - t)
        total += float(weights @ ((1.0 - k) * law.c(k) * y(k)))
    return total


@pytest.mark.sample(2)
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
@pytest.mark.parametrize(("y", "values"), MULTIPLIERS.values(), ids=MULTIPLIERS.keys())
def test_acceleration_is_the_product_and_the_stroke_stays(law: MotionLaw, y: Any, values: Any) -> None:
    product = multiplied_law(law, y)
    scale = (1.0 - law.b(0.0)) / stroke(law, values)
    assert product.c(K) == pytest.approx(scale * law.c(K) * values(K), abs=5e-13 * product.peak(2).value)
    assert product.a([0.0, 1.0]) == pytest.approx([0.0, 1.0], abs=1e-13)
    assert product.b([0.0, 1.0]) == pytest.approx(law.b([0.0, 1.0]), abs=1e-13)
    assert isinstance(product, PiecewiseLaw) == isinstance(law, PiecewiseLaw)


@examples(30)
@given(st.integers(0, 6), st.integers(0, 1000))
def test_quadratic_multipliers_give_savin_s_families(u: int, thousandths: int) -> None:
    family = SavinFamily(u)
    low, high = family.range
    alpha = low + Fraction(thousandths, 1000) * (high - low)
    y = [1 + alpha * family.M, -alpha, alpha]
    assert multiplied_law(smoothstep(u + 2), y) == savin(u, alpha)  # type: ignore[arg-type] # a Fraction is a number


def test_only_the_shape_of_y_counts() -> None:
    law = smoothstep(4)
    assert multiplied_law(law, [3, -7, 7]) == multiplied_law(law, [6, -14, 14])
    assert multiplied_law(law, [5]) == law
    assert multiplied_law(law, lambda _: 0.1).a(K) == pytest.approx(law.a(K), abs=1e-15)


def test_pieces_keep_their_kind() -> None:
    y = [2, -7, 7]
    for law, kinds in (
        (trapezoid(0.03, 0.17, exponent=1.5), {"polynomial", "fractional"}),
        (trapezoid(0.1, 0.2), {"polynomial"}),
        (PiecewiseLaw([0, 0.5, 1], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)]), {"fractional"}),
        (scca(0.25, 0.5, 0.25), {"polynomial"}),  # a sine times a polynomial is none
    ):
        product = multiplied_law(law, y)
        assert isinstance(product, PiecewiseLaw)
        assert {segment.kind for segment in product.segments} == kinds


def test_constant_power_times_y_keeps_a_finite_power() -> None:
    law = PiecewiseLaw([0, 0.5, 1], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)])
    product = multiplied_law(law, [1, -1, 1])
    assert product.constants.C.value == np.inf
    k = np.linspace(0.0, 0.499, 1000)
    assert product.constants.D.value == pytest.approx(product.d(k).max(), rel=1e-6)
    assert product.d(0.0) == pytest.approx(product.d(1e-9), rel=1e-6)


def test_area_wanders_to_where_y_is_large() -> None:
    law = smoothstep(3)
    assert (
        multiplied_law(law, [1, -3, 3]).peak(1).value
        < law.peak(1).value
        < multiplied_law(law, [1, 3, -3]).peak(1).value
    )


@pytest.mark.parametrize(
    ("y", "message"),
    [
        ([1, 1], r"even about k = 1/2, but y\(k\) and y\(1 - k\) differ by up to 1; write it in powers of k \(1 - k\)"),
        (lambda k: 1 + k, "even about k = 1/2"),
        ([0.9, -4, 4], "at least 0 everywhere, but is -0.1 at k = 0.5"),
        (lambda k: cos(2 * pi * k), "at least 0 everywhere"),
        ([0], "zero everywhere"),
        ([], "zero everywhere"),
        (lambda k: abs(k - 0.5), "y must be smooth"),
        (lambda k: 1 / k if k > 0.5 else 1 / (1 - k), "y must be smooth"),
        (lambda k: float("nan") * k, "finite values"),
        (["1"], "y"),
        (3, "y must be a sequence"),
    ],
)
def test_wrong_multipliers_are_refused(y: Any, message: str) -> None:
    for law in (smoothstep(3), scca(0.25, 0.5, 0.25)):
        with pytest.raises(InputError, match=message):
            multiplied_law(law, y)


@pytest.mark.parametrize("law", [random_law(3, 5), cut(random_law(3, 5), 0.4)])
def test_laws_that_the_method_does_not_fit_are_refused(law: MotionLaw) -> None:
    with pytest.raises(InputError, match=r"change the velocity by .* odd about k = 1/2"):
        multiplied_law(law, [2, -1, 1])


@pytest.mark.parametrize("law", [smoothstep(1), cut(smoothstep(1), 0.5)])
def test_uniform_motion_has_no_acceleration_to_multiply(law: MotionLaw) -> None:
    with pytest.raises(InputError, match="no stroke"):
        multiplied_law(law, [2, -1, 1])


def test_high_degrees_stay_exact() -> None:
    law = smoothstep(25)
    product = multiplied_law(law, [2, -1, 1])
    assert isinstance(product, PolynomialLaw)
    assert product.a([0.5, 1.0]) == pytest.approx([0.5, 1.0], abs=1e-14)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("law", "constants"),
    [
        (smoothstep(2), {"c0": 5.0, "B": 1.6}),
        (smoothstep(4), {"B": 1.9, "C": 6.5}),
        (smoothstep(4), {"B": 1.9, "C": 5.6, "J": 70.0}),
        (smoothstep(3), {"D": 6.0}),
        (scca(0.25, 0.0, 0.75), {"B": 1.7}),
        (with_end_velocity(smoothstep(4), 0.3), {"C": 5.0}),
    ],
)
def test_a_multiplier_is_found_that_gives_the_wanted_constants(law: MotionLaw, constants: dict[str, float]) -> None:
    y = multiplier_for(law, **constants)
    made = multiplied_law(law, y)
    given = {name: made.c(0.0) if name == "c0" else getattr(made.constants, name).value for name in constants}
    assert given == pytest.approx(constants, rel=1e-9)
    assert len(y) == 2 * len(constants) + 1
    assert made.a(1.0) - made.a(0.0) == pytest.approx(law.a(1.0) - law.a(0.0), abs=1e-12)
    # a(1) is one of the m conditions: y needs no scale
    at = 0.3
    assert made.c(at) == pytest.approx(law.c(at) * np.polynomial.polynomial.polyval(at, y), rel=1e-9)
    assert np.polynomial.polynomial.polyval(K, y).min() >= -1e-12


def test_a_multiplier_is_found_on_the_other_side_of_the_law() -> None:
    # neither from y = 1 nor from a y that is smaller in the middle
    wanted = {"C": 5.8, "D": 3.7, "J": 30.0}
    made = multiplied_law(smoothstep(2), multiplier_for(smoothstep(2), **wanted)).constants
    assert {name: getattr(made, name).value for name in wanted} == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("stroke", [1e-20, 1e9])
def test_the_multiplier_is_the_same_for_any_stroke(stroke: float) -> None:
    law = smoothstep(4)
    wide = PolynomialLaw([stroke * value for value in law.acceleration])
    assert multiplier_for(wide, B=1.9 * stroke) == pytest.approx(multiplier_for(law, B=1.9), rel=1e-9)


def test_two_coefficients_and_one_condition_are_savins_family() -> None:
    made, family = multiplied_law(smoothstep(4), multiplier_for(smoothstep(4), B=1.9)), savin("III", B=1.9)
    np.testing.assert_allclose(made(K), family(K), atol=1e-12)


@pytest.mark.parametrize(
    ("constants", "complaint"),
    [
        ({"B": 1.9, "C": 5.6}, "no y of 3 even powers was found that gives B = 1.9, C = 5.6; the nearest gives"),
        ({"B": 2.5}, "at least 0 everywhere, but is"),
        ({"c0": 1.0}, "and y = 1 c0 = 0"),
        ({"B": "1.9"}, "B must be a finite real number"),
        ({}, "one or more of B, C, D, J, c0, such as B=1.9"),
    ],
)
def test_what_no_multiplier_gives_is_told(constants: dict[str, Any], complaint: str) -> None:
    with pytest.raises(InputError, match=complaint):
        multiplier_for(smoothstep(4), **constants)
