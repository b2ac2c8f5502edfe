"""Balls around the constants hold what mpmath finds with many digits, and hardly more."""

from fractions import Fraction

import flint
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf  # type: ignore[import-untyped]

from optlaws import Chebyshev, PolynomialLaw, Problem, smoothstep, synthesize
from optlaws.verification import enclosures
from tests.internals.synthesis import (
    rounded_down,
    rounded_up,
)
from tests.internals.verification import (
    ExactLaw,
    enclosed,
    lower,
    upper,
)


def peaks(law: PolynomialLaw) -> dict[str, float]:
    """With 60 digits, at the law's own stationary points after Newton's method."""
    with mp.workdps(60):
        a = [mpf(p.numerator) / p.denominator for p in law.exact_powers()]
        b, c, j = derived(a), derived(derived(a)), derived(derived(derived(a)))
        starts = {"B": law._candidates(1), "C": law._candidates(2), "J": law._candidates(3)}
        starts["D"] = law._power_candidates()
        functions = {"B": b, "C": c, "J": j, "D": product(b, c)}
        return {name: peak(p, [mpf(k) for k in starts[name]]) for name, p in functions.items()}


def derived(p: list[mpf]) -> list[mpf]:
    return [i * value for i, value in enumerate(p)][1:]


def product(p: list[mpf], q: list[mpf]) -> list[mpf]:
    found = [mpf(0)] * (len(p) + len(q) - 1)
    for i, x in enumerate(p):
        for k, y in enumerate(q):
            found[i + k] += x * y
    return found


def value_of(p: list[mpf], x: mpf) -> mpf:
    total = mpf(0)
    for value in reversed(p):
        total = total * x + value
    return total


def peak(p: list[mpf], places: list[mpf]) -> mpf:
    slope, curvature = derived(p), derived(derived(p))
    values = []
    for start in places:
        x = start
        for _ in range(6 if 0 < start < 1 else 0):
            x -= value_of(slope, x) / (value_of(curvature, x) or 1)
        values.append(abs(value_of(p, x if 0 <= x <= 1 and abs(x - start) < 1e-6 else start)))
    return max(values)


@pytest.mark.parametrize(("order", "degree", "B"), [(2, 5, 1.6), (4, 9, 1.859), (5, 13, 1.6)])
def test_they_hold_what_mpmath_finds_and_hardly_more(order: int, degree: int, B: float) -> None:
    law = synthesize(Problem(B=B, order=order, basis=Chebyshev(degree))).law
    assert isinstance(law, PolynomialLaw)
    enclosed_values = enclosures(law)
    for name, value in peaks(law).items():
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
