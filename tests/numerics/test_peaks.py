"""Peaks, sign changes, kinks and jumps: against roots and integrals that are known."""

from collections.abc import Callable, Sequence

import mpmath  # type: ignore[import-untyped] # ships no types
import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import Chebyshev, Peak, PolynomialLaw, Problem, synthesize
from optlaws.tolerances import POLISHING_REACH
from tests.internals.motion import SmoothParts
from tests.internals.numerics import bracketed_root, bracketed_roots, highest, peak, polished, sign_changes
from tests.internals.numerics import extremes_of_peaks as extremes

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


# --- changes of the sign ---


@pytest.mark.parametrize("unit", [1e-12, 1.0, 1e9])
def test_roots_of_waves_of_several_functions(unit: float) -> None:
    def waves(x: Array) -> Array:
        return unit * np.array([np.sin(7.0 * np.pi * x), np.cos(3.0 * np.pi * x)])

    known = sorted({*(i / 7 for i in range(1, 7)), 1 / 6, 1 / 2, 5 / 6})
    assert sign_changes(waves, [0.0, 0.4, 1.0], 20) == pytest.approx(known, abs=1e-14)


@pytest.mark.parametrize("apart", [1e-1, 1e-3, 1e-5])
def test_roots_next_to_each_other_are_both_there(apart: float) -> None:
    """Between two places that are looked at: the turning point between the roots shows them."""
    low, high = 0.512 - apart, 0.512 + apart
    places = sign_changes(lambda x: np.array([(x - low) * (x - high) * (2.0 + np.sin(5.0 * x))]), [0.0, 1.0], 16)
    assert places == pytest.approx([low, high], abs=1e-3 * apart)


@pytest.mark.parametrize("apart", [1e-3, 1e-4])
def test_roots_next_to_each_other_are_there_where_no_series_shows_them(apart: float) -> None:
    """Twelve terms leave a tenth of the function: parabolas lead to the turning point between the roots."""
    low, high = 0.512 - apart, 0.512 + apart
    places = sign_changes(lambda x: np.array([(x - low) * (x - high) * (2.0 + np.sin(20.0 * x))]), [0.0, 1.0], 12)
    assert places == pytest.approx([low, high], abs=1e-3 * apart)


@pytest.mark.parametrize("unit", [1e-12, 1.0, 1e9])
def test_no_root_of_a_polynomial_is_missed_in_a_crowd(unit: float) -> None:
    """Two to six roots within less than the spacing of the places that are looked at, and others far away."""
    rng = np.random.default_rng(40)
    for _ in range(50):
        crowd = rng.uniform(0.1, 0.9) + 0.04 * np.arange(rng.integers(2, 7)) * rng.uniform(0.1, 1.0)
        known = np.sort(np.append(crowd, rng.uniform(0.0, 0.1, 2)))
        known = known[known < 1.0]
        places = sign_changes(lambda x, of=known: unit * np.prod(x - of[:, None], axis=0)[None], [0.0, 1.0], 12)  # type: ignore[misc]
        size = np.abs(np.prod(np.linspace(0.0, 1.0, 99) - known[:, None], axis=0)).max()
        between = (known[1:] + known[:-1]) / 2.0
        plain = np.abs(np.prod(between - known[:, None], axis=0)) > 1e-9 * size
        assert not plain.all() or len(places) == len(known), known


def test_a_root_beside_an_edge_is_found() -> None:
    """Nearer to it than the first place that is looked at."""
    assert sign_changes(lambda x: np.array([x - 1e-6, 0.4999 - x]), [0.0, 0.5], 8) == pytest.approx([1e-6, 0.4999])


def test_what_touches_nothing_has_no_roots() -> None:
    assert len(sign_changes(lambda x: np.array([(x - 0.3) ** 2 + 1e-4, 0.0 * x]), [0.0, 1.0], 12)) == 0


def test_roots_many_at_once() -> None:
    """Steep, flat, and with a kink: x^9 = h, exp(30 x) = h, |x| - h."""
    heights = np.array([0.5, 1e3, 0.25])

    def apart(x: Array) -> Array:
        return np.asarray(np.array([x[0] ** 9, np.exp(30.0 * x[1]), abs(x[2])]) - heights)

    low, high = np.zeros(3), np.ones(3)
    roots = bracketed_roots(apart, (low, high), (apart(low), apart(high)))
    assert roots == pytest.approx([0.5 ** (1 / 9), np.log(1e3) / 30.0, 0.25], rel=1e-14)


@pytest.mark.parametrize("unit", [1e-12, 1.0, 1e9])
def test_a_root_takes_few_looks_in_any_unit(unit: float) -> None:
    looks = 0

    def square(x: float) -> float:
        nonlocal looks
        looks += 1
        return (x / unit) ** 2 - 2.0

    assert bracketed_root(square, 0.0, 2.0 * unit) == pytest.approx(2.0**0.5 * unit, rel=1e-15)
    assert looks <= 12


# --- kinks and jumps ---


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
