"""Laws with an end velocity (1.17), reversed and mirrored laws."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import (
    InputError,
    MotionLaw,
    PiecewiseLaw,
    PolynomialLaw,
    mirrored_law,
    reversed_law,
    scca,
    smoothstep,
    trapezoid,
    with_end_velocity,
)
from tests.internals.laws import PolynomialSegment, PowerSegment, Segment, as_polynomial, law_between, section
from tests.laws.examples import EXAMPLES, cut

Array = NDArray[np.float64]
K = np.linspace(0.0, 1.0, 257)  # 1 - k is exact

every_law = pytest.mark.parametrize("law", EXAMPLES.values(), ids=EXAMPLES.keys())


def size(law: MotionLaw, nu: int) -> float:
    return float(np.abs(law(K, nu)).max()) + 1e-300


def inside(law: MotionLaw) -> Array:
    """Times at which the law has one value on both sides, as has its mirror image."""
    breaks = law.breaks if isinstance(law, PiecewiseLaw) else ()
    near = np.zeros(K.shape, dtype=bool)
    for place in breaks[1:-1]:
        near |= (np.abs(K - place) < 1e-9) | (np.abs(1.0 - K - place) < 1e-9)
    return K[~near]


@pytest.mark.sample(12)
@every_law
@pytest.mark.parametrize("b0", [-0.5, 0.0, 0.25, 1.0, 1.5])
def test_an_end_velocity_is_the_formula(law: MotionLaw, b0: float) -> None:
    changed = with_end_velocity(law, b0)
    assert type(changed) is type(law)
    assert changed.a(K) == pytest.approx((1 - b0) * law.a(K) + b0 * K, abs=1e-14 * (size(law, 0) + abs(b0)))
    assert changed.b(K) == pytest.approx((1 - b0) * law.b(K) + b0, abs=1e-14 * (size(law, 1) + abs(b0)))
    for nu in (2, 3):
        assert changed(K, nu) == pytest.approx((1 - b0) * law(K, nu), abs=2e-14 * size(law, nu))
    assert changed.peak(2).value == pytest.approx(abs(1 - b0) * law.peak(2).value, rel=1e-13, abs=1e-300)


@pytest.mark.parametrize("law", [smoothstep(4), scca(0.25, 0.0, 0.75), trapezoid(0.1, 0.1, exponent=1.5)])
@pytest.mark.parametrize("b0", [0.0, 0.3, 1.0])
def test_a_law_from_rest_then_has_the_velocity_at_both_ends(law: MotionLaw, b0: float) -> None:
    changed = with_end_velocity(law, b0)
    assert changed.b([0.0, 1.0]) == pytest.approx([b0, b0], abs=1e-14)
    assert changed.a([0.0, 1.0]) == pytest.approx([0.0, 1.0], abs=1e-14)
    assert changed.peak(1).value == pytest.approx((1 - b0) * law.peak(1).value + b0, rel=1e-14)


@pytest.mark.sample(2)
@every_law
def test_reversed_and_mirrored_laws_are_the_formulas(law: MotionLaw) -> None:
    turned, mirrored = reversed_law(law), mirrored_law(law)
    assert type(turned) is type(mirrored) is type(law)
    ends = law.a(0.0) + law.a(1.0)
    places = inside(law)
    for nu in range(5):
        scale = 1e-12 if nu > 3 else 2e-13
        back = law(1.0 - places, nu)
        sign = (-1.0) ** nu
        expected = ends - back if nu == 0 else -sign * back
        assert turned(places, nu) == pytest.approx(expected, abs=scale * size(law, nu))
        assert mirrored(places, nu) == pytest.approx(sign * back, abs=scale * size(law, nu))
    for name in "BCDJ":
        peak = getattr(law.constants, name).value
        for changed in (turned, mirrored):
            assert getattr(changed.constants, name).value == pytest.approx(peak, rel=2e-12, abs=1e-300)
    assert turned.constants.rms_c == pytest.approx(law.constants.rms_c, rel=1e-12)


@every_law
def test_twice_reversed_is_the_law(law: MotionLaw) -> None:
    for change in (reversed_law, mirrored_law):
        back = change(change(law))
        assert back.a(K) == pytest.approx(law.a(K), abs=1e-13 * (size(law, 0) + size(law, 1)))


@pytest.mark.parametrize("law", [smoothstep(5), scca(0.2, 0.1, 0.3), trapezoid(0.03, 0.17, exponent=1.5)])
def test_symmetric_laws_are_their_own_reverse(law: MotionLaw) -> None:
    assert reversed_law(law).a(K) == pytest.approx(law.a(K), abs=1e-14)


def test_constant_power_stays_what_it_is_where_it_can() -> None:
    law = PiecewiseLaw([0, 0.5, 1], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)])
    assert reversed_law(law) == law
    faster = with_end_velocity(law, 0.2)
    assert faster.b([0.0, 0.5, 1.0]) == pytest.approx([0.2, 1.4, 0.2], abs=1e-15)
    assert faster.constants.C.value == faster.constants.D.value == np.inf  # c is infinite where b is not 0


@dataclass(frozen=True)
class Exponential(Segment, kind="test exponential"):
    rate: float

    def __post_init__(self) -> None:
        self._check()

    def derivative(self, u: Array, length: float, nu: int) -> Array:
        return np.asarray(self.rate**nu * np.exp(self.rate * u * length) - (nu == 0))

    def candidates(self, length: float, nu: int) -> Array:  # noqa: ARG002
        return np.empty(0)

    def power_candidates(self, length: float) -> Array:  # noqa: ARG002
        return np.empty(0)

    def square(self, length: float, nu: int) -> float:  # noqa: ARG002 - its derivatives are all alike
        return self.rate**3 * float(np.expm1(2 * self.rate * length)) / 2


def test_a_segment_of_another_kind_becomes_a_polynomial() -> None:
    law = PiecewiseLaw([0, 0.5, 1], [Exponential(1.0), PolynomialSegment((), float(np.exp(0.5)))])
    for changed, exact in (
        (with_end_velocity(law, 0.25), 0.75 * law.a(K) + 0.25 * K),
        (mirrored_law(law), law.a(1.0 - K)),
    ):
        assert isinstance(changed, PiecewiseLaw)
        assert {segment.kind for segment in changed.segments} == {"polynomial"}
        assert changed.a(K) == pytest.approx(exact, abs=1e-14)


def test_other_smooth_laws_become_polynomials() -> None:
    law = scca(0.5, 0.0, 0.5)  # the cycloid
    found = as_polynomial(law)
    assert isinstance(found, PolynomialLaw)
    assert found.a(K) == pytest.approx(law.a(K), abs=1e-14)
    with pytest.raises(InputError, match="smooth"):
        as_polynomial(scca(0.25, 0.5, 0.25))


def test_laws_between_laws_in_pieces_are_weighted_means_where_the_breaks_agree() -> None:
    first, last = cut(smoothstep(3), 0.25, 0.5), cut(smoothstep(5), 0.25, 0.5)
    mean = law_between(first, last, 0.25)
    for nu in range(4):
        room = 1e-14 * size(last, nu)
        assert mean(K, nu) == pytest.approx(0.75 * first(K, nu) + 0.25 * last(K, nu), abs=room)
    with pytest.raises(InputError, match="polynomials with the same breaks"):
        law_between(first, cut(smoothstep(5), 0.25, 0.625), 0.25)


def test_a_section_is_a_part_of_the_law_with_stroke_and_duration_1() -> None:
    rise = cut(smoothstep(3), 0.25, 0.5, 0.75)
    for law in (rise, mirrored_law(rise)):
        assert isinstance(law, PiecewiseLaw)
        part = section(law, 1, 3)
        start, stroke = law.a(0.25), law.a(0.75) - law.a(0.25)
        assert part.breaks == (0.0, 0.5, 1.0)
        assert part.a(K) == pytest.approx((law.a(0.25 + 0.5 * K) - start) / stroke, abs=1e-14)


def test_a_section_that_ends_where_it_begins_has_no_stroke() -> None:
    back = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((16.0,), -4.0), PolynomialSegment((-16.0,), 4.0)])
    with pytest.raises(InputError, match=r"from 0 to 0\.5 ends where it begins"):
        section(back, 0, 1)


@pytest.mark.parametrize("b0", [None, "1", float("nan")])
def test_wrong_velocities_are_refused(b0: Any) -> None:
    with pytest.raises(InputError, match="b0"):
        with_end_velocity(smoothstep(3), b0)
