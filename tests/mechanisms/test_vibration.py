"""Free vibration: one formula below, at and above critical damping."""

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.internals.mechanisms import Oscillator

NEAR_ONE = [1.0, 1.0 - 1e-15, 1.0 + 1e-15, 1.0 - 1e-9, 1.0 + 1e-9, 1.0 - 1e-4, 1.0 + 1e-4]
DAMPINGS = st.one_of(st.sampled_from([0.0, *NEAR_ONE]), st.floats(0.0, 1.5))
#: a share of 1e-13 of a state must itself be a normal number
STATES = st.floats(-1.0, 1.0).map(lambda state: state if abs(state) > 1e-280 else 0.0)


def exact(nu: float, damping: float, h0: float, v0: float, s: float) -> tuple[float, float]:
    """Displacement and velocity at s, from the matrix exponential to 60 digits."""
    with mp.workdps(60):
        matrix = mp.matrix([[0, 1], [-(mp.mpf(nu) ** 2), -2 * mp.mpf(damping) * mp.mpf(nu)]])
        found = mp.expm(matrix * mp.mpf(s)) * mp.matrix([h0, v0])
        return float(found[0]), float(found[1])


@given(st.floats(0.1, 60.0), DAMPINGS, STATES, STATES, st.floats(0.0, 1.0))
def test_motion_is_the_matrix_exponential(nu: float, damping: float, h0: float, speed: float, s: float) -> None:
    one, v0 = Oscillator(nu, damping), speed * nu
    found = [float(one.motion(h0, v0, np.array([s]), order)[0]) for order in (0, 1)]
    expected = exact(nu, damping, h0, v0, s)
    size = abs(h0) + abs(speed)
    assert found[0] == pytest.approx(expected[0], abs=1e-13 * size)
    assert found[1] == pytest.approx(expected[1], abs=1e-13 * size * nu)


@given(st.floats(0.5, 30.0), DAMPINGS, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.integers(0, 3))
def test_no_later_value_exceeds_the_peak(nu: float, damping: float, h0: float, speed: float, order: int) -> None:
    one, v0 = Oscillator(nu, damping), speed * nu
    peak = one.peak(h0, v0, order)
    s = np.linspace(0.0, 20.0 / nu, 4001)
    size = np.abs(one.motion(h0, v0, s, order))
    scale = (abs(h0) + abs(speed)) * nu**order
    assert peak.value >= size.max() - 1e-12 * scale
    assert peak.value <= size.max() + 1e-4 * scale
    at_peak = abs(float(one.motion(h0, v0, np.array([peak.k]), order)[0]))
    assert at_peak == pytest.approx(peak.value, abs=1e-12 * scale)


@given(st.floats(0.5, 60.0), st.floats(0.0, 0.99), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_the_envelope_touches_the_motion(nu: float, damping: float, h0: float, speed: float) -> None:
    one, v0 = Oscillator(nu, damping), speed * nu
    s = np.linspace(0.0, 2 * np.pi / one.damped, 2001)
    envelope = one.amplitude(h0, v0) * np.exp(-one.n * s)
    size = np.abs(one.motion(h0, v0, s, 0))
    assert (size <= envelope * (1 + 1e-9) + 1e-15).all()
    assert (size >= envelope * (1 - 1e-5) - 1e-15).any()
