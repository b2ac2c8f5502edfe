"""Magnitudes of complex affine functions: their tangents, and vibrations that vanish."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import Chebyshev, Problem, at_most, synthesize
from tests.contracts.test_families import random_cone
from tests.internals.synthesis import stationary_places
from tests.synthesis.judge import judge


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
