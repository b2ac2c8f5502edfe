"""Piecewise laws: joints, jumps and infinite peaks, exact values of each kind of segment."""

from math import inf, log, nan, pi, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from optlaws import InputError, Peak, PiecewiseLaw, smoothstep
from tests.internals.laws import (
    FractionalSegment,
    HarmonicSegment,
    PolynomialSegment,
    PowerSegment,
    PowerSum,
    Segment,
    SineSegment,
)
from tests.laws.examples import cut, cut_power, cut_sine

K = np.linspace(0.0, 1.0, 501)
# constant acceleration 4, then deceleration -4
TWO_STEPS = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((4.0,)), PolynomialSegment((-4.0,), 2.0)])
# constant power up and down: b = 1.5 sqrt(2k)
TWO_POWERS = PiecewiseLaw([0, 0.5, 1], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)])


@pytest.mark.parametrize("breaks", [(0.2,), (0.1, 0.5, 0.93), (1e-6,), (1 - 1e-6,)])
@pytest.mark.parametrize("order", [2, 3, 5])
def test_a_law_in_pieces_is_the_law(order: int, breaks: tuple[float, ...]) -> None:
    law = smoothstep(order)
    pieces = cut(law, *breaks)
    for nu in range(3):
        assert np.abs(pieces(K, nu) - law(K, nu)).max() <= 1e-13 * law.peak(nu).value
    mine, whole = pieces.constants, law.constants
    for name in "BCD":
        assert getattr(mine, name).value == pytest.approx(getattr(whole, name).value, rel=1e-12)
    assert mine.rms_c == pytest.approx(whole.rms_c, rel=1e-12)


def test_the_cycloid_has_its_known_constants() -> None:
    for law in (cut_sine(), cut_sine(0.1, 0.7)):
        constants = law.constants
        assert law.a(1.0) == pytest.approx(1.0, abs=1e-14)
        assert constants.B.value == pytest.approx(2.0, rel=1e-14)
        assert constants.C.value == pytest.approx(2 * pi, rel=1e-14)
        assert constants.J.value == pytest.approx(4 * pi**2, rel=1e-14)
        assert constants.D.value == pytest.approx(2 * pi * 1.5 * sqrt(3) / 2, rel=1e-14)
        assert constants.D.k == pytest.approx(1 / 3, abs=1e-12)
        assert constants.rms_c == pytest.approx(2 * pi / sqrt(2), rel=1e-14)


def test_a_fast_sine_is_resolved() -> None:
    law = PiecewiseLaw([0, 1], [SineSegment(1.0, 500.0, 0.3, powers=(0.0, 0.5))])
    k = np.linspace(0.0, 1.0, 1_000_001)
    for nu in range(4):
        sampled = np.abs(law(k, nu)).max()
        assert sampled * (1 - 1e-14) <= law.peak(nu).value <= sampled * (1 + 1e-6)
    sampled = np.abs(law.d(k)).max()
    assert sampled * (1 - 1e-14) <= law.power_peak().value <= sampled * (1 + 1e-6)


def test_values_at_a_break_are_right_hand_values_and_left_hand_at_the_end() -> None:
    assert TWO_STEPS.c([0.0, 0.5 - 1e-12, 0.5, 1.0]).tolist() == [4.0, 4.0, -4.0, -4.0]
    assert TWO_STEPS.b(0.5) == 2.0
    assert TWO_STEPS.d([0.5 - 1e-15, 0.5]) == pytest.approx([8.0, -8.0])


def test_peaks_look_at_both_sides_of_a_break() -> None:
    law = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((1.0, 5.0)), PolynomialSegment((2.0, -1.0), 0.5)])
    assert law.c(0.5) == 3.0
    assert law.peak(2) == Peak(6.0, 0.5)
    assert TWO_STEPS.power_peak() == Peak(8.0, 0.5)
    assert TWO_STEPS.extrema(2) == (Peak(-4.0, 0.5), Peak(4.0, 0.0))


def test_a_jump_makes_the_next_derivatives_infinite_where_it_is() -> None:
    assert TWO_STEPS.jumps(2) == ((0.5, -8.0),)
    assert [TWO_STEPS.jumps(nu) for nu in (0, 1, 3)] == [()] * 3
    assert TWO_STEPS.peak(3) == TWO_STEPS.peak(4) == Peak(inf, 0.5)
    # an impulse downwards; its derivative goes both ways
    assert TWO_STEPS.extrema(3) == (Peak(-inf, 0.5), Peak(0.0, 0.0))
    assert TWO_STEPS.extrema(4) == (Peak(-inf, 0.5), Peak(inf, 0.5))
    assert TWO_STEPS.constants.rms_c == 4.0


@pytest.mark.parametrize(("height", "continuity"), [(0.25, 1), (1e-12, 1), (1e-14, 9)])
def test_a_jump_is_one_beside_greater_lower_derivatives_unless_rounding_makes_it(
    height: float, continuity: int
) -> None:
    for b in (0.01, 1.0, 100.0):
        law = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((), b), PolynomialSegment((b * height,), b)])
        assert law.jumps(2) == (((0.5, b * height),) if continuity == 1 else ())
        assert law.continuity == continuity


def test_where_velocity_and_acceleration_rest_at_every_break_their_size_is_that_between() -> None:
    assert cut_sine(1 / 3, 2 / 3, turns=3).continuity == 9


def test_a_jump_of_velocity_makes_c_d_and_rms_infinite() -> None:
    law = PiecewiseLaw([0, 0.25, 0.75, 1], [PolynomialSegment((), b) for b in (0.5, 1.5, 0.5)])
    assert law.a(1.0) == 1.0
    assert law.jumps(1) == ((0.25, 1.0), (0.75, -1.0))
    assert law.continuity == 0
    constants = law.constants
    assert (Peak(1.5, 0.25), Peak(inf, 0.25), Peak(inf, 0.25), Peak(inf, 0.25)) == (
        constants.B,
        constants.C,
        constants.D,
        constants.J,
    )
    assert constants.rms_c == inf
    assert law.extrema(2) == (Peak(-inf, 0.75), Peak(inf, 0.25))


def test_constant_power_from_rest() -> None:
    constants = TWO_POWERS.constants
    assert Peak(2.25, 0.0) == constants.D
    assert constants.C == constants.J == Peak(inf, 0.0)
    assert Peak(1.5, 0.5) == constants.B
    assert constants.rms_c == inf
    assert TWO_POWERS.d(K) == pytest.approx([2.25] * 250 + [-2.25] * 251, rel=1e-14)
    assert TWO_POWERS.b(K[:251]) == pytest.approx(1.5 * np.sqrt(2 * K[:251]), abs=1e-15)
    assert TWO_POWERS([0.0, 1.0], 2).tolist() == [inf, -inf]
    assert TWO_POWERS.a([0.0, 0.5, 1.0]).tolist() == [0.0, 0.5, 1.0]
    assert TWO_POWERS.continuity == 1
    assert TWO_POWERS.jumps(2) == ((0.5, -3.0),)
    assert "nan" not in TWO_POWERS._repr_html_()


def test_a_vertical_tangent_inside_is_no_jump() -> None:
    law = PiecewiseLaw([0, 0.5, 1], [PowerSegment(-1.0, 0.0), PowerSegment(0.0, 1.0)])
    assert law.jumps(2) == ()
    assert law.continuity == 1
    assert law.peak(2) == Peak(inf, 0.5)
    assert law.extrema(2)[0] == Peak(1.0, 0.0)
    assert law.d(K) == pytest.approx([-1.0] * 250 + [1.0] * 251, rel=1e-14)
    assert law.d(0.5) == 1.0


def test_rms_of_constant_power() -> None:
    assert cut_power(0.5, 2.0, 0.3).constants.rms_c == pytest.approx(sqrt(1.875 * log(4.0)), rel=1e-14)
    assert PiecewiseLaw([0, 1], [PowerSegment(1.0, 1.0)]).constants.rms_c == 0.0


@pytest.mark.parametrize(
    ("law", "continuity"),
    [
        (PiecewiseLaw([0, 1], [PolynomialSegment((), 1.0)]), 9),
        (cut(smoothstep(4), 0.3), 9),
        (cut_sine(0.4), 9),
        (TWO_STEPS, 1),
        # jerk 32, -32, -32, 32
        (
            PiecewiseLaw(
                [0, 0.25, 0.75, 1],
                [
                    PolynomialSegment((4.0, 4.0)),
                    PolynomialSegment((0.0, -8.0), 1.0),
                    PolynomialSegment((-4.0, 4.0), 1.0),
                ],
            ),
            2,
        ),
    ],
)
def test_continuity(law: PiecewiseLaw, continuity: int) -> None:
    assert law.continuity == continuity
    assert law.a(1.0) == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize(
    "breaks", [[0], [], [0, 0.5], [0.1, 1], [0, 0.5, 0.5, 1], [0, 0.7, 0.3, 1], [0, nan, 1], ["0", 1], None]
)
def test_wrong_breaks_are_refused(breaks: Any) -> None:
    count = len(breaks) - 1 if breaks else 0
    with pytest.raises(InputError, match=r"^breaks(\[\d\])? must"):
        PiecewiseLaw(breaks, [PolynomialSegment(())] * count)


@pytest.mark.parametrize(
    "segments", [[], [PolynomialSegment(())], [PolynomialSegment(())] * 3, [1, 2], None, [PolynomialSegment] * 2]
)
def test_wrong_segments_are_refused(segments: Any) -> None:
    with pytest.raises(InputError, match="segments must be 2 segments"):
        PiecewiseLaw([0, 0.5, 1], segments)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PowerSegment(0.0, 0.0), "power segment"),
        (lambda: PowerSegment(-1.0, 1.0), "power segment"),
        (lambda: PowerSegment(inf, 1.0), "b0"),
        (lambda: SineSegment(1.0, 0.0), "frequency > 0"),
        (lambda: SineSegment(1.0, 1.0, powers=(1.0, 2.0, 3.0, 4.0)), "three powers"),
        (lambda: SineSegment(nan, 1.0), "amplitude"),
        (lambda: PolynomialSegment((1.0, nan)), "acceleration"),
        (lambda: PolynomialSegment("12"), "acceleration"),  # type: ignore[arg-type]
        (lambda: Segment.from_dict({"kind": "spline"}), "kind of segment 'spline' is unknown; known are .*sine"),
        (lambda: Segment.from_dict({"kind": "power", "b0": 1.0, "b2": 1.0}), "'b2' is unknown, 'b1' is missing"),
        (lambda: Segment.from_dict([]), "a segment must be a dict"),  # type: ignore[arg-type]
        (lambda: PiecewiseLaw.from_dict({"format": 1, "kind": "piecewise", "breaks": [0, 1]}), "'segments' is missing"),
        (lambda: PiecewiseLaw.from_dict(TWO_STEPS.to_dict() | {"segments": 1}), "segments must be a list"),
        (lambda: PiecewiseLaw([0, 1], [PowerSegment(1, 1)], nan), "a0"),
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


def test_jumps_of_rounding_size_are_none_in_uniform_motion() -> None:
    segments = [PolynomialSegment((1e-15,), b0=1.0), PolynomialSegment((-1e-15,), b0=1.0)]
    law = PiecewiseLaw([0.0, 0.5, 1.0], segments)
    assert law.jumps(2) == ()
    assert law.constants.J.value < 1e-9
    small = PiecewiseLaw([0.0, 0.5, 1.0], [PolynomialSegment((4e-15,)), PolynomialSegment((-4e-15,), b0=2e-15)])
    assert [k for k, _ in small.jumps(2)] == [0.5]


# --- powers of time and sums of sines ---


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
