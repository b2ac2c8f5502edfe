"""Families of rows: derivatives and slopes against differences, cones, kinks and peaks."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws import Chebyshev, Pieces, Problem, at_most, drive_torque, four_bar, slider_crank, synthesize
from tests.contracts.test_families import random_cone
from tests.internals.formulas import NUMPY, Slopes, evaluate, read
from tests.internals.synthesis import (
    CurvedFamily,
    KinkedIntegralFamily,
    model_of,
    peaks,
    stationary_places,
)
from tests.synthesis.judge import judge

Array = NDArray[np.float64]


@given(st.integers(0, 10**6), st.floats(-1.0, 1.0), st.floats(0.0, 6.3))
def test_the_amplitude_is_nowhere_below_its_tangents(seed: int, place: float, angle: float) -> None:
    cone = random_cone(seed)
    x = np.random.default_rng([seed, 1]).normal(size=5)
    row = cone.tangent(place, np.array([np.cos(angle), np.sin(angle)]))
    best = cone.tangent(place, np.array(cone.direction(x, place)))
    point = np.append(x, 1.0)
    size = cone.value(x, np.array([place]))[0]
    assert row @ point <= size + 1e-12
    assert best @ point == pytest.approx(size, rel=1e-12)


def test_an_amplitude_that_is_zero_has_no_stationary_places() -> None:
    assert len(stationary_places(np.zeros(3, dtype=np.complex128))) == 0


@pytest.mark.parametrize(
    "problem",
    [
        Problem(order=4, basis=Chebyshev(5), minimise="residual(frequency=31.59)", symmetric=False),
        Problem(order=4, basis=Chebyshev(5), minimise="residual(frequency=23.92, damping=0.1)", B=2.2803558066964698),
        Problem(order=3, basis=Chebyshev(11), minimise="residual(frequency=23.92)", B=1.9, C=at_most(8.0)),
    ],
)
def test_a_vibration_that_can_vanish_does(problem: Problem) -> None:
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.objective < 1e-11
    assert solution.lower_bound == 0.0
    judge(solution)


# --- jumps ---


@pytest.mark.parametrize(
    ("text", "stop", "formula"),
    [
        ("peak(c^2 + b)", 1.0, lambda k, b, c: c**2 + b + 0.0 * k),
        ("peak(norm(c, b))", 1.0, lambda k, b, c: np.hypot(c, b) + 0.0 * k),
        ("peak(c^2/(1 + k), stop=0.3)", 0.3, lambda k, b, c: c**2 / (1.0 + k) + 0.0 * b),
    ],
)
def test_a_formula_is_looked_at_on_both_sides_of_a_jump(
    text: str, stop: float, formula: Callable[[Array, Array, Array], Array]
) -> None:
    problem = Problem(order=2, basis=Pieces([0.0, 0.3, 0.7, 1.0], 4, 1), minimise=text, symmetric=False)
    model = model_of(problem)
    family = next(one for one in model.program.families if isinstance(one, CurvedFamily) and 1.0 in one.signs)
    beside = np.array([0.3 - 1e-12, 0.3 + 1e-12, 0.7 - 1e-12, 0.7 + 1e-12])
    k = np.sort([*np.linspace(0.0, stop - 1e-12, 4001), *beside[beside < stop]])
    for seed in range(6):
        x = 0.3 * np.random.default_rng(seed).normal(size=len(family.slack))
        law = model.space.law(x[: model.space.terms])
        greatest = (family.extremes(x)[2].max() + family.right_side(x)) * family.unit
        assert greatest == pytest.approx(formula(k, law(k, 1), law(k, 2)).max(), rel=1e-6)


# --- kinks ---


KINDS = ("integral(abs(c - 2*a))", "integral(max((c + 0.5*b)*b, 0))", "integral(max(c, 0.5*b, 0)^2)", "rms(max(c, 0))")


def family_of(text: str, *, symmetric: bool) -> KinkedIntegralFamily:
    problem = Problem(B=1.8, order=4, basis=Chebyshev(5), minimise=text, symmetric=symmetric)
    [family] = [one for one in model_of(problem).program.families if isinstance(one, KinkedIntegralFamily)]
    return family


@pytest.mark.parametrize("text", [KINDS[0], *KINDS[2:]])
def test_tangents_are_nowhere_above(text: str) -> None:
    family, numbers = family_of(text, symmetric=True), np.random.default_rng(3)
    ones = np.ones(1)
    for _ in range(4):
        x, other = numbers.normal(size=(2, len(family.slack))) * 0.3
        row = family.tangent_row(1.0, 1.0, family.touching(x, 1.0))
        assert row is not None
        assert row @ np.append(x, 1.0) == pytest.approx(family.value(x, ones)[0], rel=1e-10)
        assert row @ np.append(other, 1.0) <= family.value(other, ones)[0] * (1.0 + 1e-10)


@pytest.mark.parametrize("text", ["integral(abs(c - 2*a))", "rms(max(c, 0))"])
def test_derivatives_by_the_law_and_its_kinks_are_differences(text: str) -> None:
    family = family_of(text, symmetric=False)
    x = np.random.default_rng(5).normal(size=len(family.slack))
    # of a neighbour, so that the formulas beside a kink differ there
    stretches = family.split(x + 1e-3).stretches
    kinks, step = family.kinks_of(stretches), 1e-5
    at = family.free_kinks(x, stretches)
    assert len(kinks)
    for i, way in enumerate(step * np.eye(len(x))):
        ahead, back = (family.free_kinks(x + sign * way, stretches) for sign in (1.0, -1.0))
        assert (ahead.value - back.value) / (2.0 * step) == pytest.approx(at.slope[i], rel=1e-6, abs=1e-7)
        assert (ahead.slope - back.slope) / (2.0 * step) == pytest.approx(at.bend[i], rel=1e-4, abs=1e-5)
        assert (ahead.rise - back.rise) / (2.0 * step) == pytest.approx(at.across[:, i], rel=1e-5, abs=1e-7)
    for i, way in enumerate(step * np.eye(len(kinks))):
        ahead, back = (family.free_kinks(x, family.with_kinks(stretches, kinks + s * way)) for s in (1.0, -1.0))
        assert (ahead.value - back.value) / (2.0 * step) == pytest.approx(at.share * at.rise[i], rel=1e-4, abs=1e-7)
        assert ((ahead.rise - back.rise) / (2.0 * step))[i] == pytest.approx(at.along[i], rel=1e-4, abs=1e-7)


def test_a_formula_that_touches_0_in_the_middle_has_its_sign_beside() -> None:
    """The jerk of these symmetric laws rises to 0 at k = 1/2, where rounding gives it any sign."""
    family = family_of("integral(abs(j))", symmetric=True)
    middle = family.columns_at(np.array([0.5]))[0, 0]
    places = (np.arange(20000) + 0.5) / 20000
    for seed in range(20):
        x = np.random.default_rng(seed).normal(size=len(family.slack)) * 0.1
        x -= middle[:-1] * (middle @ np.append(x, 1.0)) / (middle[:-1] @ middle[:-1])
        plain = np.abs(family.columns_at(places)[0] @ np.append(x, 1.0)).mean()
        # the objective is in units of its scale, 1/32 of a jerk
        assert family.value(x, np.ones(1))[0] == pytest.approx(plain / 32.0, rel=1e-6)


@pytest.mark.parametrize("text", [*KINDS, "rms(spline(a, 0:1, 0.3:2, 0.6:1, 1:3)*c)"])
def test_each_kink_is_a_simple_root_of_its_switch(text: str) -> None:
    """Even at knots of a spline, where the formulas beside a kink are the same, and where a square begins."""
    family = family_of(text, symmetric=False)
    x = np.random.default_rng(6).normal(size=len(family.slack)) * 0.1
    stretches = family.split(x).stretches
    kinks, step = family.kinks_of(stretches), 1e-6
    switches = family.switches_of(x, stretches)
    at = family.at_kinks(x, stretches, switches)
    assert len(kinks)
    assert np.abs(at.value / at.along) == pytest.approx(np.zeros(len(kinks)), abs=1e-12)
    ways = np.eye(len(x)) * step
    for way, across in zip(ways, at.across.T, strict=True):
        moved = family.kinks_of(family.split(x + way).stretches) - family.kinks_of(family.split(x - way).stretches)
        assert moved / (2.0 * step) == pytest.approx(-across / at.along, rel=1e-5, abs=1e-6)


# --- slopes of a mechanism's torque ---


CRANK = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
LINKAGE = four_bar("0.1 m", "0.3 m", "0.25 m", "0.35 m", bodies={"crank": "0.005 kg m^2", "rocker": "0.05 kg m^2"})
TORQUES = {
    "slider-crank": CRANK.dimensionless("0 deg", "180 deg", "0.3 s").torque,
    "four-bar": LINKAGE.dimensionless("20 deg", "160 deg", "0.3 s").torque,
    "spline": drive_torque(inertia="spline(a, 0:1, 0.3:1.6, 0.7:1.2, 1:2)", load="2*sin(3*a)^2"),
}
NAMES = ("a", "b", "c", "k")


@pytest.mark.parametrize("name", TORQUES)
@pytest.mark.parametrize("wrapped", ["{}", "({})^2", "({})*b + sin(a)*b"])
def test_slopes_are_those_of_differences(name: str, wrapped: str) -> None:
    numbers, step = np.random.default_rng(5), 1e-5
    a = numbers.uniform(size=40)
    at = {"a": a, "b": numbers.normal(size=40), "c": 3.0 * numbers.normal(size=40), "k": numbers.uniform(size=40)}
    formula = read(wrapped.format(TORQUES[name]))
    slopes = Slopes(formula, NAMES)
    value, gradient, hessian = slopes.derivatives(at)
    assert value == pytest.approx(evaluate(formula, at, NUMPY), rel=1e-13)
    assert np.array_equal(slopes.value(at), value)
    assert np.array_equal(slopes.value_and_gradient(at)[1], gradient)
    for i, moved in enumerate(NAMES):
        ahead, behind = (slopes.value_and_gradient({**at, moved: at[moved] + side * step}) for side in (1.0, -1.0))
        size = np.abs(gradient).max()
        assert gradient[i] == pytest.approx((ahead[0] - behind[0]) / (2.0 * step), rel=1e-6, abs=1e-6 * size)
        assert hessian[i] == pytest.approx((ahead[1] - behind[1]) / (2.0 * step), rel=1e-4, abs=1e-4 * size)


# --- peaks of many series ---


@pytest.mark.parametrize("count", [4, 12, 40])
def test_a_peak_beside_an_end_is_found_however_near_it_is(count: int) -> None:
    away = np.concatenate([10.0 ** -np.arange(1.0, 9.0, 0.25), [0.3, 0.5]])
    # 8 - (u - place)² about places near both ends
    places = np.concatenate([1.0 - away, away - 1.0])
    series = np.zeros((len(places), count))
    series[:, :3] = np.array([chebyshev.poly2cheb([8.0 - one**2, 2.0 * one, -1.0]) for one in places.tolist()])
    for sign in (1.0, -1.0):
        np.testing.assert_allclose(peaks(sign * series), 8.0 * np.ones(len(places)), rtol=1e-12)


def test_peaks_of_random_series_are_those_at_their_stationary_points() -> None:
    rng = np.random.default_rng(11)
    series = rng.normal(size=(300, 9)) * 0.7 ** np.arange(9)
    for one, found in zip(series, peaks(series).tolist(), strict=True):
        roots = chebyshev.chebroots(chebyshev.chebder(one))
        inside = roots[np.abs(roots.imag) < 1e-7].real
        places = np.concatenate([[-1.0, 1.0], inside[np.abs(inside) <= 1.0]])
        assert found == pytest.approx(np.abs(chebyshev.chebval(places, one)).max(), rel=1e-10)
