"""Balls around the constants of piecewise laws hold what mpmath finds with 50 digits, and hardly more."""

from collections.abc import Callable
from itertools import pairwise
from math import inf, pi

import numpy as np
import pytest
from mpmath import mp, mpf  # type: ignore[import-untyped]

from optlaws import BSplines, InputError, Pieces, PiecewiseLaw, Problem, synthesize
from optlaws.verification import enclosures
from tests.internals.laws import (
    FractionalSegment,
    HarmonicSegment,
    PolynomialSegment,
    PowerSegment,
    Segment,
    SineSegment,
)

Function = Callable[[mpf], mpf]


def joined(breaks: list[float], segments: list[Segment]) -> PiecewiseLaw:
    """With velocities such that b does not jump."""
    found: list[Segment] = []
    b0 = 0.0
    for segment, (start, end) in zip(segments, pairwise(breaks), strict=True):
        found.append(Segment.from_dict({**segment.to_dict(), "b0": b0}))
        b0 = float(found[-1].derivative(np.ones(1), end - start, 1)[0])
    return PiecewiseLaw(breaks, found)


CYCLOID = PiecewiseLaw([0.0, 1.0], [SineSegment(amplitude=2.0 * pi, frequency=2.0 * pi)])
MIXED = joined(
    [0.0, 0.25, 0.5, 1.0],
    [
        SineSegment(amplitude=5.0, frequency=4.0, phase=0.25, powers=(0.5, -1.0, 2.0)),
        HarmonicSegment((3.0, -0.5), (6.0, 18.0), (0.125, 0.25)),
        PolynomialSegment((-2.0, -1.5, 0.25)),
    ],
)
CONSTANT_POWER = PiecewiseLaw([0.0, 0.5, 1.0], [PowerSegment(0.25, 1.5), PowerSegment(1.5, 0.25)])
OPTIMAL = [
    synthesize(Problem(B=1.75, order=3, basis=Pieces(4))).law,
    synthesize(Problem(B=1.75, order=4, basis=BSplines(5, 4), symmetric=False)).law,
]


def function(segment: Segment, length: mpf, nu: int) -> Function:
    """The derivative of order nu >= 1 by the time since the start, integrated by mpmath where b is asked."""
    if isinstance(segment, PowerSegment):
        start, end = mpf(segment.b0) ** 2, mpf(segment.b1) ** 2
        return lambda s: mp.diff(lambda t: mp.sqrt(start + (end - start) * t / length), s, nu - 1)
    return lambda s: (
        (segment_b0(segment) + mp.quad(lambda t: c_of(segment, length, t), [0, s]))
        if nu == 1
        else mp.diff(lambda t: c_of(segment, length, t), s, nu - 2)
    )


def segment_b0(segment: Segment) -> mpf:
    return mpf(segment.to_dict()["b0"])


def c_of(segment: Segment, length: mpf, s: mpf) -> mpf:
    if isinstance(segment, PolynomialSegment):
        y = 2 * s / length - 1
        return mp.fsum(mpf(value) * mp.chebyt(n, y) for n, value in enumerate(segment.acceleration))
    if isinstance(segment, SineSegment):
        steady = mp.fsum(mpf(p) * s**i for i, p in enumerate(segment.powers))
        return steady + mpf(segment.amplitude) * mp.sin(mpf(segment.frequency) * s + mpf(segment.phase))
    assert isinstance(segment, HarmonicSegment)
    waves = zip(segment.amplitudes, segment.frequencies, segment.phases, strict=True)
    return mp.fsum(mpf(a) * mp.sin(mpf(w) * s + mpf(phase)) for a, w, phase in waves)


def highest(value: Function, length: mpf) -> mpf:
    """The greatest magnitude on a stretch, by golden section around the good ones of some points.

    Peaks of an optimum are as high as one another but for its last digit: the best point need not be at the highest.
    """
    places = [length * i / 24 for i in range(25)]
    values = [abs(value(s)) for s in places]
    tops = [i for i in range(25) if values[i] >= max(values[max(i - 1, 0)], values[min(i + 1, 24)])]
    return max(*values, *(_risen(value, places, i) for i in tops if values[i] >= mpf("0.97") * max(values)))


def _risen(value: Function, places: list[mpf], best: int) -> mpf:
    low, high = places[max(best - 1, 0)], places[min(best + 1, 24)]
    share = (mp.sqrt(5) - 1) / 2
    inner = [high - share * (high - low), low + share * (high - low)]
    heights = [abs(value(s)) for s in inner]
    for _ in range(110):
        if heights[0] > heights[1]:
            high, inner, heights = inner[1], [mpf(0), inner[0]], [mpf(0), heights[0]]
            inner[0] = high - share * (high - low)
            heights[0] = abs(value(inner[0]))
        else:
            low, inner, heights = inner[0], [inner[1], mpf(0)], [heights[1], mpf(0)]
            inner[1] = low + share * (high - low)
            heights[1] = abs(value(inner[1]))
    return max(heights)


def squared(value: Function, length: mpf) -> mpf:
    return mp.quad(lambda s: value(s) ** 2, [0, length / 2, length])


def stretches(law: PiecewiseLaw) -> list[tuple[Segment, mpf]]:
    return [
        (segment, mpf(end) - mpf(start))
        for segment, (start, end) in zip(law.segments, pairwise(law.breaks), strict=True)
    ]


@pytest.mark.sample(6)
@pytest.mark.parametrize("law", [CYCLOID, MIXED, CONSTANT_POWER, *OPTIMAL], ids=["cycloid", "mixed", "power", "B", "Z"])
def test_they_hold_what_mpmath_finds_and_hardly_more(law: PiecewiseLaw) -> None:
    enclosed_values = enclosures(law)
    with mp.workdps(50):
        orders = {"C": 2} if law is not CYCLOID else {"C": 2, "J": 3}
        for name, nu in orders.items():
            value = max(highest(function(segment, length, nu), length) for segment, length in stretches(law))
            low, high = enclosed_values[name]
            assert mpf(low) - mpf(10) ** -28 <= value <= mpf(high) + mpf(10) ** -28
            assert high - low <= 1e-14 * high
        square = mp.fsum(squared(function(segment, length, 2), length) for segment, length in stretches(law))
        low, high = enclosed_values["rms_c"]
        assert mpf(low) - mpf(10) ** -25 <= mp.sqrt(square) <= mpf(high) + mpf(10) ** -25
        assert high - low <= 1e-14 * high
    constants = law.constants
    for name, peak in (("B", constants.B), ("C", constants.C), ("D", constants.D)):
        assert enclosed_values[name] == pytest.approx((peak.value, peak.value), rel=1e-12)


def test_known_constants_of_the_cycloid_and_of_constant_power() -> None:
    cycloid = enclosures(CYCLOID)
    assert cycloid["B"] == pytest.approx((2.0, 2.0), rel=1e-15)
    assert cycloid["J"][0] <= 4.0 * pi**2 * (1.0 + 1e-15)
    assert cycloid["J"][1] >= 4.0 * pi**2 * (1.0 - 1e-15)
    low, high = cycloid["D"]
    # b c = 2 pi (1 - cos x) sin x is greatest where cos x = -1/2
    assert low <= 1.5 * 3.0**0.5 * pi <= high * (1.0 + 1e-15)
    power = enclosures(CONSTANT_POWER)
    assert power["D"] == (1.5**2 - 0.25**2, 1.5**2 - 0.25**2)
    assert power["B"] == (1.5, 1.5)
    assert power["J"] == (inf, inf)


def test_where_the_velocity_is_zero_constant_power_has_no_peak_of_c() -> None:
    enclosed_values = enclosures(PiecewiseLaw([0.0, 0.5, 1.0], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)]))
    assert enclosed_values["C"] == enclosed_values["rms_c"] == (inf, inf)
    assert enclosed_values["D"] == (2.25, 2.25)


def test_a_jump_makes_what_is_above_it_infinite() -> None:
    halves = [PolynomialSegment((4.0,)), PolynomialSegment((-4.0,), b0=2.0)]
    enclosed_values = enclosures(PiecewiseLaw([0.0, 0.5, 1.0], halves))
    assert (enclosed_values["B"], enclosed_values["C"], enclosed_values["J"]) == ((2.0, 2.0), (4.0, 4.0), (inf, inf))
    kinked = enclosures(PiecewiseLaw([0.0, 0.5, 1.0], [PolynomialSegment((), b0=0.5), PolynomialSegment((), b0=1.5)]))
    assert kinked["C"] == kinked["D"] == (inf, inf)


def test_segments_of_other_kinds_are_refused() -> None:
    law = PiecewiseLaw([0.0, 1.0], [FractionalSegment(1.5, 1.0, 0.0, (4.0,), 2.0)])
    with pytest.raises(InputError, match="no fractional segments"):
        enclosures(law)
