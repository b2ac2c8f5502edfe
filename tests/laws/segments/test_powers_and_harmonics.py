"""Segments of real powers of time and of several sines, against mpmath; roots of sums of powers."""

from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from optlaws import InputError, MotionLaw, PiecewiseLaw
from tests.internals.laws import FractionalSegment, HarmonicSegment, PowerSum, Segment, SineSegment

mpf = mpmath.mpf
CASES: list[tuple[Segment, Any]] = [  # a segment on [0, 1] and its velocity
    (
        FractionalSegment(1.5, 1.0, 0.0, (4.0,), 2.0),
        lambda t: 2 - mpf(4) / mpf(2.5) * (1 - t) ** mpf(2.5),
    ),
    (
        FractionalSegment(-0.5, 0.25, 2.25, (1.0, -0.5, 0.25), 0.75),
        lambda t: mpf(0.75) + ((2 * (q := mpf(0.25) + 2 * t) ** mpf(0.5)) - q ** mpf(1.5) / 3 + q ** mpf(2.5) / 10) / 2,
    ),
    (
        HarmonicSegment((3.0, -1.0), (2.5, 7.0), (0.75, 0.0), 0.125),
        lambda t: (
            mpf(0.125)
            + mpf(6) / 5 * (mpmath.cos(mpf(0.75)) - mpmath.cos(mpf(2.5) * t + mpf(0.75)))
            - (1 - mpmath.cos(7 * t)) / 7
        ),
    ),
]


@pytest.mark.parametrize("nu", range(6))
@pytest.mark.parametrize("k", [0.0, 0.21, 0.4, 0.8])
@pytest.mark.parametrize("case", CASES, ids=["fall", "rise", "sines"])
def test_derivatives_are_those_of_the_formula(case: tuple[Segment, Any], k: float, nu: int) -> None:
    segment, b = case
    with mpmath.workdps(30):
        exact = float(mpmath.quad(b, [0, k]) if nu == 0 else mpmath.diff(b, mpf(k), nu - 1))
    assert PiecewiseLaw([0, 1], [segment])(k, nu) == pytest.approx(exact, rel=1e-13, abs=1e-14)


@pytest.mark.sample(4)
@pytest.mark.parametrize("case", CASES, ids=["fall", "rise", "sines"])
@pytest.mark.parametrize("nu", [1, 2, 3])
def test_mean_squares_are_the_integrals(case: tuple[Segment, Any], nu: int) -> None:
    law = PiecewiseLaw([0, 1], [case[0]])
    exact = mpmath.quad(lambda t: law(float(t), nu) ** 2, [0, 0.5, 1])
    assert law.rms(nu) == pytest.approx(float(exact) ** 0.5, rel=1e-12)


def test_roots_of_a_fall_meet_at_its_end() -> None:
    fall = FractionalSegment(0.5, 1.0, 0.0, (4.0,), 2.0)
    law = PiecewiseLaw([0, 1], [fall])
    assert law.b(1.0) == 2.0
    assert law.c(1.0) == 0.0
    assert law.j(1.0) == -np.inf
    assert law.constants.J.value == np.inf
    assert law.rms(3) == np.inf


@given(
    st.floats(-0.9, 6.0),
    st.lists(st.floats(-2.0, 2.0).filter(lambda q: abs(q) > 1e-3), min_size=1, max_size=4),
    st.tuples(st.just(0.0) | st.floats(1e-6, 2.0), st.floats(0.1, 2.0)).map(lambda pair: (pair[0], pair[0] + pair[1])),
    st.floats(-2.0, 2.0),
)
def test_peaks_are_no_less_than_samples(
    exponent: float, coefficients: list[float], ends: tuple[float, float], steady: float
) -> None:
    first, last = ends if steady > 0.0 else ends[::-1]
    law = PiecewiseLaw([0, 1], [FractionalSegment(exponent, first, last, tuple(coefficients), steady)])
    k = np.linspace(0.0, 1.0, 4001)
    for nu in range(4):
        with np.errstate(invalid="ignore"):
            sampled = np.abs(law(k, nu)).max()
        assert law.peak(nu).value >= sampled * (1 - 1e-13)
    assert law.power_peak().value >= np.abs(law.d(k)).max() * (1 - 1e-13)
    assert MotionLaw.from_json(law.to_json()) == law


@example(amplitude=1.0, frequency=1.0, phase=1.1125369292536007e-308, b0=0.0)
@given(
    amplitude=st.floats(0.5, 8.0) | st.floats(-8.0, -0.5),
    frequency=st.floats(0.5, 60.0),
    phase=st.floats(-20.0, 20.0) | st.just(0.5 * np.pi),
    b0=st.floats(-2.0, 2.0),
)
def test_a_sine_has_the_extremes_that_are_searched_of_a_sum_of_one(
    amplitude: float, frequency: float, phase: float, b0: float
) -> None:
    closed = PiecewiseLaw([0.0, 1.0], [SineSegment(amplitude, frequency, phase, b0)])
    searched = PiecewiseLaw([0.0, 1.0], [HarmonicSegment((amplitude,), (frequency,), (phase,), b0)])
    for nu in range(1, 5):
        for one, other in zip(closed.extrema(nu), searched.extrema(nu), strict=True):
            assert one.value == pytest.approx(other.value, rel=1e-13, abs=1e-13 * searched.peak(nu).value)
    power = searched.power_peak().value
    assert closed.power_peak().value == pytest.approx(power, rel=1e-12)


@given(st.lists(st.floats(0.01, 0.99), min_size=1, max_size=4, unique=True), st.floats(0.2, 3.0))
def test_roots_of_sums_of_powers_are_all_found(roots: list[float], stretch: float) -> None:
    roots = sorted(roots)
    if min(np.diff(roots), default=1.0) < 0.01:
        return
    polynomial = np.polynomial.Polynomial.fromroots(roots)
    powers = {0.5 + stretch * i: float(q) for i, q in enumerate(polynomial.coef)}
    expected = [root ** (1.0 / stretch) for root in roots]
    assert PowerSum(powers).roots(0.0, 1.0) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: FractionalSegment(-1.0, 1.0, 0.0, (1.0,)), "exponent > -1"),
        (lambda: FractionalSegment(0.5, -1.0, 0.0, (1.0,)), "at least 0|>= 0"),
        (lambda: FractionalSegment(0.5, 1.0, 1.0, (1.0,)), "different"),
        (lambda: FractionalSegment(0.5, 1e-300, 1.0, (1.0,)), "sizes that compare"),
        (lambda: HarmonicSegment((1.0,), (0.0,), (0.0,)), "frequencies > 0"),
        (lambda: HarmonicSegment((1.0, 2.0), (1.0,), (0.0,)), "as many amplitudes"),
        (lambda: HarmonicSegment((), (), ()), "as many amplitudes"),
    ],
)
def test_wrong_contents_are_refused(make: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()
