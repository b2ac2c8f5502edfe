"""Enclosures in balls of laws, pieces and cams: none of what they hold may be missing."""

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from math import inf, perm, pi

import flint
import mpmath  # type: ignore[import-untyped] # ships no types
import numpy as np
import pytest
from flint import arb, ctx, fmpq, fmpq_poly, fmpz_poly
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf

from optlaws import (
    BSplines,
    Certificate,
    Chebyshev,
    Contact,
    Functional,
    InputError,
    Pieces,
    PiecewiseLaw,
    PolynomialLaw,
    Problem,
    cam_constant,
    maximum,
    smoothstep,
    synthesize,
)
from optlaws.verification import enclosures, exact_bound
from tests.internals.formulas import of_text
from tests.internals.laws import (
    FractionalSegment,
    HarmonicSegment,
    PolynomialSegment,
    PowerSegment,
    Segment,
    SineSegment,
)
from tests.internals.synthesis import rounded_down, rounded_up
from tests.internals.verification import (
    ExactLaw,
    between,
    enclosed,
    integrals,
    lower,
    near,
    real_roots,
    series_of,
    upper,
)
from tests.laws.many_digits import DENSE, Exact, highest, stretches


@pytest.mark.parametrize(("order", "degree", "B"), [(2, 5, 1.6), (4, 9, 1.859), (5, 13, 1.6)])
def test_they_hold_what_mpmath_finds_and_hardly_more(order: int, degree: int, B: float) -> None:
    law = synthesize(Problem(B=B, order=order, basis=Chebyshev(degree))).law
    assert isinstance(law, PolynomialLaw)
    enclosed_values = enclosures(law)
    with mp.workdps(60):
        exact = Exact(law)
        known = {name: exact.peak(nu, law(DENSE, nu)) for nu, name in enumerate("BCJ", 1)}
        for name, value in (known | {"D": exact.power_peak(law.d(DENSE))}).items():
            low, high = enclosed_values[name]
            assert mpf(low) <= value <= mpf(high)
            assert high - low <= 1e-15 * high


@pytest.mark.parametrize(("order", "degree"), [(4, 25), (6, 59)])
def test_they_are_narrow_at_high_degrees(order: int, degree: int) -> None:
    law = synthesize(Problem(B=1.7, order=order, basis=Chebyshev(degree))).law
    constants = law.constants
    for name, (low, high) in enclosures(law).items():
        stated = constants.rms_c if name == "rms_c" else getattr(constants, name).value
        assert high - low <= 1e-14 * high
        assert stated == pytest.approx(low, rel=1e-12)


def test_exact_values_are_exact() -> None:
    enclosed_values = enclosures(smoothstep(2))
    assert {name: enclosed_values[name] for name in "BCJ"} == {"B": (1.5, 1.5), "C": (6.0, 6.0), "J": (12.0, 12.0)}
    assert enclosed_values["rms_c"][0] ** 2 == pytest.approx(12.0)
    assert enclosures(PolynomialLaw([], b0=1.0))["D"] == (0.0, 0.0)


@given(st.lists(st.floats(-10.0, 10.0), min_size=1, max_size=8), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_no_value_is_outside_the_extremes(series: list[float], first: float, last: float) -> None:
    law = PolynomialLaw(series, b0=0.5)
    start, stop = sorted((first, last))
    least, greatest = ExactLaw(law).extremes(2, Fraction(start), Fraction(stop))
    values = np.atleast_1d(law.c(np.linspace(start, stop, 33)))
    size = 1e-13 * (1.0 + sum(map(abs, series)))
    assert rounded_down(lower(least)) <= values.min() + size
    assert rounded_up(upper(greatest)) >= values.max() - size
    inside = law.extrema(2, within=(start, stop))
    assert enclosed(least)[0] == pytest.approx(inside[0].value, abs=100.0 * size)
    assert enclosed(greatest)[1] == pytest.approx(inside[1].value, abs=100.0 * size)


def test_rounding_goes_outward() -> None:
    third = flint.arb(1) / 3
    assert lower(third) < Fraction(1, 3) < upper(third)
    assert rounded_down(Fraction(1, 3)) < Fraction(1, 3) < rounded_up(Fraction(1, 3))
    assert rounded_down(Fraction(1, 4)) == rounded_up(Fraction(1, 4)) == 0.25


# --- pieces ---


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


@pytest.mark.sample(6)
@pytest.mark.parametrize("law", [CYCLOID, MIXED, CONSTANT_POWER, *OPTIMAL], ids=["cycloid", "mixed", "power", "B", "Z"])
def test_of_pieces_they_hold_what_mpmath_finds(law: PiecewiseLaw) -> None:
    enclosed_values = enclosures(law)
    with mp.workdps(50):
        orders = {"C": 2} if law is not CYCLOID else {"C": 2, "J": 3}
        for name, nu in orders.items():
            value = highest(stretches(law, nu), 110)
            low, high = enclosed_values[name]
            assert mpf(low) - mpf(10) ** -28 <= value <= mpf(high) + mpf(10) ** -28
            assert high - low <= 1e-14 * high
        square = mp.fsum(mp.quad(lambda s, f=f: f(s) ** 2, [0, end / 2, end]) for f, _, end in stretches(law, 2))
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


# --- cams ---


NU, DAMPING = 12.0, 0.25


def cam(k: mpmath.mpf | float, order: int) -> mpmath.mpf | float:
    """A derivative of the cam of 35 k^4 - 84 k^5 + 70 k^6 - 20 k^7, by hand, in the arithmetic of k."""
    mass = [0, 0, 0, 0, 35, -84, 70, -20]

    def derivative(nu: int) -> mpmath.mpf | float:
        return sum(a * perm(i, nu) * k ** (i - nu) for i, a in enumerate(mass) if i >= nu)

    return derivative(order) + (2 * DAMPING * NU * derivative(order + 1) + derivative(order + 2)) / NU**2


def greatest(order: int, sign: int) -> mpmath.mpf:
    """By Newton's method from the highest of a thousand points, to 30 digits."""
    k = mpmath.mpf(max(range(1001), key=lambda i: sign * cam(i / 1000, order))) / 1000
    if 0 < k < 1:
        k = mpmath.findroot(lambda k: cam(k, order + 1), k)
    return sign * cam(k, order)


@pytest.mark.parametrize(
    ("name", "order", "signs"),
    [("B", 1, (1, -1)), ("C", 2, (1, -1)), ("C_plus", 2, (1,)), ("C_minus", 2, (-1,)), ("J", 3, (1, -1))],
)
def test_peaks_of_cams_are_those_by_hand(name: str, order: int, signs: tuple[int, ...]) -> None:
    with mpmath.workdps(40):
        expected = max(greatest(order, sign) for sign in signs)
        low, high = enclosed(ExactLaw(smoothstep(4)).term(cam_constant(name, frequency=NU, damping=DAMPING)))
        assert low <= expected <= high
        assert high - low < 1e-14 * high


def test_the_power_of_a_cam_is_that_by_hand() -> None:
    with mpmath.workdps(40):
        peak = mpmath.mpf(max(range(1001), key=lambda i: abs(cam(i / 1000, 1) * cam(i / 1000, 2)))) / 1000
        k = mpmath.findroot(lambda k: cam(k, 2) ** 2 + cam(k, 1) * cam(k, 3), peak)
        low, high = enclosed(ExactLaw(smoothstep(4)).term(cam_constant("D", frequency=NU, damping=DAMPING)))
        assert low <= abs(cam(k, 1) * cam(k, 2)) <= high


def test_a_cam_that_is_not_smooth_enough_has_no_rows() -> None:
    constant = cam_constant("C", frequency=NU)
    asked = Certificate.of_leaf(
        Problem(order=3, minimise=constant, basis=Chebyshev(7)), (Contact(constant.name, 1.0, 0.2, 1.0),)
    )
    with pytest.raises(InputError, match="needs mass laws of order 4 at least"):
        exact_bound(asked)


def test_a_constant_that_only_looks_like_a_cams_is_refused() -> None:
    constant = cam_constant("C", frequency=NU)
    other: Functional = replace(constant, weights=(Fraction(1),))  # type: ignore[call-arg]
    with pytest.raises(InputError, match="as optlaws defines them, not C_cam"):
        ExactLaw(smoothstep(4)).sum(maximum(other, other).expression())


# --- real roots ---


def with_roots(*roots: fmpq | int) -> fmpq_poly:
    polynomial = fmpq_poly([3])
    for root in roots:
        polynomial *= fmpq_poly([-root, 1])
    return polynomial


@pytest.mark.parametrize(
    "roots",
    [(), (0,), (0, 0), (1,), (-1, 1), (-1, 0, 1), (-2, -1, 1, 2), (-2, -1, 0, 0, 0, 1, 2), (1, 2, 3), (0, 1, 2)],
)
@pytest.mark.parametrize("factor", [[1], [1, 0, 1], [2, 0, 0, 0, 1], [1, 1, 1]])
def test_every_real_root_is_in_a_ball(roots: tuple[int, ...], factor: list[int]) -> None:
    half = fmpq(1, 2)
    found = real_roots(with_roots(*(half * root for root in roots)) * fmpq_poly(factor), fmpq(-1), fmpq(2))
    assert all(any(ball.contains(half * root) for ball in found) for root in roots)
    assert all(any(abs(float(ball.mid()) - root / 2) < 1e-9 for root in roots) for ball in found)


@pytest.mark.parametrize("place", [fmpq(1), fmpq(-1), fmpq(1, 3), fmpq(0)])
@pytest.mark.parametrize("apart", [fmpq(1, 10**20), fmpq(1, 10**60)])
def test_roots_next_to_one_another_and_to_an_end_are_told_apart(place: fmpq, apart: fmpq) -> None:
    """Whichever of them are beyond the end, those inside are in balls narrower than the way to the next."""
    polynomial = with_roots(place - apart, place, place + apart, fmpq(1, 2))
    inside = [root for root in (place - apart, place, place + apart, fmpq(1, 2)) if -1 <= root <= 1]
    with ctx.workprec(600):
        balls = real_roots(polynomial, fmpq(-1), fmpq(1))
        assert len(balls) == len(inside)
        assert all(sum(ball.overlaps(arb(root)) for ball in balls) == 1 for root in inside)


@pytest.mark.parametrize("bits", [53, 113, 128, 256])
def test_a_root_next_to_an_end_and_to_a_turn_of_the_slope_is_enclosed(bits: int) -> None:
    """In a narrower ball than one in which the slope has a sign it had none: the jerk at the end of an optimal law."""
    chebyshev = [-1.680059301997406, 2.4049935593187253, -0.7778447938436768, 0.020026138328819082, 0.0328843981935381]
    terms = [fmpq(*value.as_integer_ratio()) * fmpq_poly(fmpz_poly.chebyshev_t(n)) for n, value in enumerate(chebyshev)]
    with ctx.workprec(bits):
        (root,) = real_roots(sum(terms, fmpq_poly([0])).derivative(), fmpq(-1), fmpq(1))
        assert root.is_finite()
        assert root.rad() < 1e-7


def test_an_infinite_enclosure_proves_no_number() -> None:
    assert near("C", 8.0, (8.0 - 1e-15, 8.0)).proven
    assert near("C", inf, (inf, inf)).proven
    assert not near("C", 8.0, (-inf, inf)).proven
    assert not near("C", 8.0, (7.9, 8.1)).proven


def test_a_polynomial_without_slope_is_its_own_extremes() -> None:
    least, greatest = between(fmpq_poly([5]), fmpq(-1), fmpq(1))
    assert least == greatest == 5
    least, greatest = between(fmpq_poly([1, 0, -2, 0, 1]), fmpq(-2), fmpq(2))
    assert least.contains(0)
    assert greatest.contains(9)


def test_a_kink_is_searched_for_with_a_few_terms() -> None:
    """A cell with a kink has no more; the whole series there made torques with losses slow to verify."""
    lengths = list[int]()

    def bent(k: flint.arb_series) -> list[flint.arb_series]:
        lengths.append(ctx.cap)
        return [series_of(of_text("abs(k - 0.3)").formula, {"k": k})]

    [area] = integrals(bent, [[fmpq_poly([1])]], (Fraction(0), Fraction(1)), 60)
    assert area.contains(arb(fmpq(29, 100)))
    assert float(area.rad()) < 1e-15
    assert sum(lengths) < 0.6 * max(lengths) * len(lengths)


def test_where_cells_run_out_an_integral_is_known_as_well_on_both_sides() -> None:
    """Torques of drives that coast touch 0 at many places: of the last ones nothing was known."""
    text = f"abs(cos({20.0 * pi!r}*k))"
    [area] = integrals(
        lambda k: [series_of(of_text(text).formula, {"k": k})], [[fmpq_poly([1])]], (Fraction(0), Fraction(1)), 60
    )
    assert abs(area - 2 / arb.pi()) < 1e-10
