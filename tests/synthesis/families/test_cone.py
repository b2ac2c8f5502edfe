"""Magnitudes of complex affine functions: derivatives against differences, extrema against a grid."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import Chebyshev, Problem, at_most, synthesize
from optlaws.synthesis.families.cone import ConeFamily, stationary_places
from tests.synthesis.judge import judge

GRID = np.linspace(-1.0, 1.0, 2001)


def family(seed: int, terms: int = 4, degree: int = 6) -> tuple[ConeFamily, np.ndarray]:
    """A random family over some coordinates and one variable that bounds it, and a point."""
    numbers = np.random.default_rng(seed)
    series = numbers.normal(size=(degree + 1, terms + 2)) + 1j * numbers.normal(size=(degree + 1, terms + 2))
    series[:, terms] = 0.0
    slack = np.zeros(terms + 1)
    slack[terms] = 1.0
    return ConeFamily("cone", slack, 0.5, series=series), numbers.normal(size=terms + 1)


@given(st.integers(0, 10**6))
def test_derivatives_are_those_of_differences(seed: int) -> None:
    cone, x = family(seed)
    u, s, step = np.array([-0.7, 0.1, 0.4]), np.ones(3), 1e-5
    jet = cone.jet(x, u, s)
    assert jet.value == pytest.approx(cone.value(x, u) - x[-1] - 0.5, rel=1e-12)
    left, right = (cone.jet(x, u + one, s) for one in (-step, step))
    # near a zero of the amplitude its derivatives are steep
    loose = 1e-5 * (1.0 + 1.0 / float(cone.value(x, u).min()) ** 3)
    assert jet.slope == pytest.approx((right.value - left.value) / (2 * step), abs=loose, rel=1e-5)
    assert jet.curvature == pytest.approx((right.slope - left.slope) / (2 * step), abs=loose, rel=1e-4)
    weights = np.array([0.3, 1.0, 0.2])
    hessian = cone.hessian(x, u, weights)
    assert hessian is not None
    for i in range(len(x)):
        unit = np.eye(len(x))[i] * step
        before, after = (cone.jet(x + one, u, s) for one in (-unit, unit))
        assert jet.gradient[:, i] == pytest.approx((after.value - before.value) / (2 * step), abs=loose, rel=1e-5)
        assert jet.slope_gradient[:, i] == pytest.approx((after.slope - before.slope) / (2 * step), abs=loose, rel=1e-4)
        assert hessian[i] == pytest.approx(weights @ (after.gradient - before.gradient) / (2 * step), abs=loose)


@given(st.integers(0, 10**6))
def test_no_point_of_a_grid_is_above_the_extrema(seed: int) -> None:
    cone, x = family(seed)
    _, _, residual = cone.extremes(x)
    grid = cone.value(x, GRID) - cone.room(x)
    assert grid.max() <= residual.max() + 1e-12
    assert grid.max() == pytest.approx(residual.max(), abs=1e-3 * (1.0 + abs(grid).max()))


@given(st.integers(0, 10**6), st.floats(-1.0, 1.0), st.floats(0.0, 6.3))
def test_the_amplitude_is_nowhere_below_its_tangents(seed: int, place: float, angle: float) -> None:
    cone, x = family(seed)
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
        Problem(order=4, basis=Chebyshev(5), minimise="residual(nu=31.59)", symmetric=False),
        Problem(order=4, basis=Chebyshev(5), minimise="residual(nu=23.92, damping=0.1)", B=2.2803558066964698),
        Problem(order=3, basis=Chebyshev(11), minimise="residual(nu=23.92)", B=1.9, C=at_most(8.0)),
    ],
)
def test_a_vibration_that_can_vanish_does(problem: Problem) -> None:
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.objective < 1e-11
    assert solution.lower_bound == 0.0
    judge(solution)
