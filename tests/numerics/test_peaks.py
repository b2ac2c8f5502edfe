"""Peaks that lie between all nodes: polished by Newton steps, compared with mpmath."""

from collections.abc import Callable, Sequence

import mpmath  # type: ignore[import-untyped] # ships no types
import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import Chebyshev, Peak, PolynomialLaw, Problem, synthesize
from optlaws.tolerances import POLISHING_REACH
from tests.internals.numerics import extremes_of_peaks as extremes
from tests.internals.numerics import highest, peak, polished

Array = NDArray[np.float64]
Residual = Callable[[Array], tuple[Array, Array]]


class Counted:
    """A residual that counts its calls."""

    def __init__(self, residual: Residual) -> None:
        self.residual, self.calls = residual, 0

    def __call__(self, x: Array) -> tuple[Array, Array]:
        self.calls += 1
        return self.residual(x)


def square(x: Array) -> tuple[Array, Array]:
    return x * x - 0.25, 2.0 * x


def test_three_newton_steps_find_a_near_root_to_the_last_digit() -> None:
    # one step leaves 4e-9, two 2e-17
    values = polished(np.array([0.49994, -0.50006, 0.49999]), square)
    assert np.abs(np.abs(values) - 0.5).max() <= 2e-16
    # one step leaves 2.5e-7, two 6e-14, which is near enough
    counted = Counted(square)
    assert polished(np.array([0.4995]), counted) == pytest.approx([0.5], abs=1e-13)
    assert counted.calls == 3


def test_a_root_is_left_alone() -> None:
    counted = Counted(square)
    assert polished(np.array([0.5]), counted).tolist() == [0.5]
    assert counted.calls == 1
    assert polished(np.empty(0), square).size == 0


def test_a_step_is_short() -> None:
    line: Residual = lambda x: (x - 0.5, np.ones_like(x))  # noqa: E731
    far = np.array([0.5 + 10.0 * POLISHING_REACH, 0.5 - 10.0 * POLISHING_REACH, 0.5 + 2.5 * POLISHING_REACH])
    values = polished(far, line)
    assert values[:2] == pytest.approx([0.5 + 7.0 * POLISHING_REACH, 0.5 - 7.0 * POLISHING_REACH], abs=1e-15)
    assert values[2] == pytest.approx(0.5, abs=1e-15)


def test_a_candidate_stays_where_a_step_makes_it_worse() -> None:
    # the slope has the wrong sign, so that every step leads away; the second candidate is free to move
    def residual(x: Array) -> tuple[Array, Array]:
        return x - 0.2, np.array([-1.0, 1.0])

    assert polished(np.array([0.2005, 0.2005]), residual) == pytest.approx([0.2005, 0.2], abs=1e-15)


def test_a_step_that_changes_nothing_is_not_taken() -> None:
    def flat(x: Array) -> tuple[Array, Array]:
        return np.full_like(x, 1e-3), np.ones_like(x)

    assert polished(np.array([0.3]), flat).tolist() == [0.3]


def test_without_a_slope_there_is_no_step() -> None:
    def level(x: Array) -> tuple[Array, Array]:
        return np.array([1e-4, 3e-4]), np.array([0.0, 1.0]) + 0.0 * x

    assert polished(np.array([0.3, 0.3]), level)[0] == 0.3


def test_no_candidate_leaves_the_interval() -> None:
    def beyond(x: Array) -> tuple[Array, Array]:
        return x - np.sign(x) * 1.01, np.ones_like(x)

    assert polished(np.array([0.9999, -0.9999]), beyond).tolist() == [1.0, -1.0]


def test_small_steps_count() -> None:
    # a candidate that is off by 1e-9 only: the peak's place is known to the last digit
    assert polished(np.array([0.5 + 1e-9]), square).tolist() == [0.5]
    assert polished(np.array([0.5 + 4e-12]), square) == pytest.approx([0.5], abs=2e-16)


def test_ties_go_to_the_smallest_k() -> None:
    k = np.array([0.8, 0.2, 0.5])
    assert highest(k, np.array([2.0, 2.0 - 1e-11, 1.0]), 1e-10) == Peak(2.0, 0.2)
    assert highest(k, np.array([2.0, 2.0 - 1e-9, 1.0]), 1e-10) == Peak(2.0, 0.8)
    assert highest(k, np.array([2.0, 1.5, 1.0]), 0.5) == Peak(2.0, 0.2)


def test_a_tie_is_relative_to_the_size() -> None:
    k = np.array([0.0, 0.5, 1.0])
    values = np.array([-1000.0 + 5e-8, 1000.0 - 5e-8, 1000.0])
    assert peak(k, values) == Peak(1000.0, 0.0)
    assert extremes(k, values) == (Peak(-1000.0 + 5e-8, 0.0), Peak(1000.0, 0.5))
    assert peak(k, values / 1e6).k == 0.0
    assert peak(k, np.array([-1000.0 + 5e-7, 0.0, 1000.0])) == Peak(1000.0, 1.0)


def test_beside_an_infinite_value_ties_are_of_the_finite_ones() -> None:
    k = np.array([0.2, 0.5, 0.8])
    # 5e-11 apart: a tie beside 1, none beside 1e-3
    for size, place in ((1.0, 0.2), (1e-3, 0.5)):
        assert extremes(k, np.array([5e-11 - size, -size, np.inf])) == (Peak(-size, place), Peak(np.inf, 0.8))
    assert peak(k, np.array([1.0, -np.inf, np.inf])) == Peak(np.inf, 0.5)


def test_extremes_of_nothing_are_plain_zeros() -> None:
    lowest, top = extremes(np.array([0.0, 1.0]), np.zeros(2))
    assert (str(lowest.value), str(top.value)) == ("0.0", "0.0")
    assert extremes(np.array([0.0, 1.0]), np.array([2.0, 3.0])) == (Peak(2.0, 0.0), Peak(3.0, 1.0))


def derivative(law: PolynomialLaw, nu: int) -> Callable[[mpmath.mpf], mpmath.mpf]:
    """Of a law, from the acceleration on."""
    exact = powers(law.acceleration)
    for _ in range(nu - 2):
        exact = [2 * i * one for i, one in enumerate(exact)][1:]
    return lambda k: mpmath.polyval(exact, 2 * k - 1, asc=True)


def powers(series: Sequence[float]) -> list[mpmath.mpf]:
    """Ascending powers of a Chebyshev series."""
    before, now = [mpmath.mpf(1)], [mpmath.mpf(0), mpmath.mpf(1)]
    total = [mpmath.mpf(0)] * max(len(series), 2)
    for weight in series:
        for i, one in enumerate(before):
            total[i] += mpmath.mpf(weight) * one
        after = [mpmath.mpf(0), *(2 * one for one in now)]
        before, now = now, [one - (before[i] if i < len(before) else 0) for i, one in enumerate(after)]
    return total


@pytest.mark.parametrize("degree", [9, 21, 41])
@pytest.mark.parametrize("nu", [2, 3])
def test_peaks_stand_where_mpmath_finds_them(degree: int, nu: int) -> None:
    law = synthesize(Problem(B=1.7, order=4, basis=Chebyshev(degree))).law
    assert isinstance(law, PolynomialLaw)
    with mpmath.workdps(60):
        f, slope = derivative(law, nu), derivative(law, nu + 1)
        for one in law.extrema(nu):
            if not 0.0 < one.k < 1.0:
                continue
            place = mpmath.findroot(slope, mpmath.mpf(one.k))
            assert abs(place - one.k) < 1e-13
            assert abs(f(place) - one.value) < 1e-12 * abs(one.value)
