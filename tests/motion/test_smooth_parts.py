"""Integrals and greatest values of functions with kinks and jumps, against closed forms and mpmath."""

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from tests.internals.motion import SmoothParts


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
def test_kinks_where_a_function_changes_its_sign(unit: float) -> None:
    """The integral of |sin(7 t/u) - 0.3| over 2 u is that of mpmath between the zeros."""
    parts = SmoothParts.between(0.0, 2.0 * unit, signs=[lambda t: np.sin(7.0 * t / unit) - 0.3])
    zeros = [float((side + mpmath.pi * turn) / 7) for turn in range(6) for side in [(-1) ** turn * mpmath.asin(0.3)]]
    edges = [0.0, *sorted(zero for zero in zeros if 0.0 < zero < 2.0), 2.0]
    integral = mpmath.quad(lambda t: abs(mpmath.sin(7 * t) - 0.3), edges)
    assert parts.integral(lambda t: np.abs(np.sin(7.0 * t / unit) - 0.3)) == pytest.approx(unit * float(integral))
    greatest = parts.greatest(lambda t: np.abs(np.sin(7.0 * t / unit) - 0.3))
    assert greatest.value == pytest.approx(1.3, rel=1e-12)


def test_jumps_at_breaks_have_both_their_sides() -> None:
    parts = SmoothParts.between(-1.0, 1.0, breaks=[0.123])

    def saw(t: np.ndarray) -> np.ndarray:
        return np.where(t < 0.123, t, t - 5.0)

    assert parts.greatest(saw).value == pytest.approx(0.123, rel=1e-8)
    assert parts.greatest(lambda t: -saw(t)).value == pytest.approx(5.0 - 0.123, rel=1e-12)
    assert parts.integral(saw) == pytest.approx(-5.0 * (1.0 - 0.123), rel=1e-13)
