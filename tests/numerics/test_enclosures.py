"""Enclosures: narrow bumps, kinks, random functions and polynomials against samples and closed forms."""

from collections.abc import Callable
from fractions import Fraction
from math import comb

import mpmath  # type: ignore[import-untyped] # ships no types
import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import InputError, SolverFailure
from tests.internals.numerics import (
    Interval,
    Jet,
    bearing,
    bernstein,
    between,
    dot,
    exact,
    greatest_difference,
    nodes,
    variable,
)
from tests.internals.numerics import extremes_of_branch_and_bound as extremes
from tests.internals.numerics import integral_of_integral as integral

Array = NDArray[np.float64]
Plain = Callable[[Array], Array]
Enclosed = Callable[[Interval, int], Jet]
EDGES = np.array([0.0, 1.0, 2.5, 6.0])


def bell(centre: float, width: float) -> tuple[Plain, Enclosed]:
    """1/(1 + ((x - centre)/width)²)."""

    def enclosed(x: Interval, order: int) -> Jet:
        away = (variable(x, order) - centre) / width
        bell: Jet = 1.0 / (away * away + 1.0)
        return bell

    return lambda x: 1.0 / (1.0 + ((x - centre) / width) ** 2), enclosed


def waves(weights: Array, frequencies: Array, phases: Array) -> tuple[Plain, Enclosed]:
    def enclosed(x: Interval, order: int) -> Jet:
        place = variable(x, order)
        parts = [(place * f + p).waves()[0] * w for w, f, p in zip(weights, frequencies, phases, strict=True)]
        total: Jet = sum(parts[1:], start=parts[0])
        return total

    return lambda x: np.asarray(np.sin(np.multiply.outer(x, frequencies) + phases) @ weights), enclosed


@pytest.mark.parametrize("width", [1e-1, 1e-3, 1e-6, 1e-9])
def test_no_bump_is_so_narrow_that_it_is_missed(width: float) -> None:
    # a series through thirteen places of [0, 1] sees nothing of it, and said that the greatest value was 0
    enclosure = extremes(bell(0.3137, width)[1], [0.0, 1.0])
    assert enclosure.most == pytest.approx(1.0, rel=1e-9)
    assert enclosure.most <= 1.0 <= enclosure.high <= 1.0 + 2e-9
    assert enclosure.most_at == pytest.approx(0.3137, abs=1e-4 * width)
    low, high = integral(bell(0.3137, width)[1], [0.0, 1.0])
    area = width * (np.arctan(0.3137 / width) + np.arctan(0.6863 / width))
    assert low <= area * (1 + 1e-15)
    assert area * (1 - 1e-15) <= high
    assert high - low < 1e-6 * area


def test_extremes_and_integrals_of_random_functions_are_enclosed() -> None:
    generator = np.random.default_rng(5)
    places = np.linspace(0.0, 6.0, 100_001)
    for order in (2, 2, 2, 2, 4, 5):
        plain, enclosed = waves(*generator.normal(size=(3, 5)) * [[1.0], [4.0], [2.0]])
        sharp, also = bell(generator.uniform(0.0, 6.0), 10.0 ** generator.uniform(-4, 0))
        dense = plain(places) * sharp(places)
        enclosure = extremes(lambda x, n: enclosed(x, n) * also(x, n), EDGES, order=order)  # noqa: B023 - called at once
        assert enclosure.low <= dense.min() + 1e-15
        assert dense.max() - 1e-15 <= enclosure.high
        assert enclosure.high - enclosure.most <= 1.01e-9 * enclosure.peak
        assert enclosure.least - enclosure.low <= 1.01e-9 * enclosure.peak
        for place, value in ((enclosure.least_at, enclosure.least), (enclosure.most_at, enclosure.most)):
            assert plain(np.array(place)) * sharp(np.array(place)) == pytest.approx(value, abs=2e-9 * enclosure.peak)
        low, high = integral(enclosed, EDGES)
        nodes, weights = np.polynomial.legendre.leggauss(200)
        assert low - 1e-13 <= 3.0 * plain(3.0 + 3.0 * nodes) @ weights <= high + 1e-13
        assert high - low < 1e-7


def test_jumps_at_edges_are_seen_from_both_sides() -> None:
    def jumping(x: Interval, order: int) -> Jet:
        place = variable(x, order)
        return place * np.where(x.middle < 1.0, 1.0, -1.0) + np.where(x.middle < 1.0, 1.0, 0.0)

    enclosure = extremes(jumping, np.array([0.0, 1.0, 2.0]))
    assert (enclosure.least, enclosure.most) == pytest.approx((-2.0, 2.0))
    assert enclosure.bound == pytest.approx(2.0)
    assert (enclosure.least_at, enclosure.most_at) == (2.0, 1.0)


def test_kinks_are_enclosed() -> None:
    def function(x: Interval, order: int) -> Jet:
        return (variable(x, order) - 0.3).magnitude().maximum(0.1) + (variable(x, order) * 3.0).waves()[0].clipped(
            -0.5, 0.5
        )

    places = np.linspace(0.0, 2.0, 1_000_001)
    dense = np.maximum(np.abs(places - 0.3), 0.1) + np.clip(np.sin(3.0 * places), -0.5, 0.5)
    enclosure = extremes(function, [0.0, 2.0])
    assert enclosure.low <= dense.min() <= enclosure.low + 1e-6
    assert enclosure.high - 1e-6 <= dense.max() <= enclosure.high


def test_of_extremes_as_high_as_one_another_the_first_is_told() -> None:
    sine = waves(np.ones(1), np.ones(1), np.zeros(1))[1]
    enclosure = extremes(sine, [0.0, 40.0], parts=7)
    assert (enclosure.most_at, enclosure.least_at) == pytest.approx((0.5 * np.pi, 1.5 * np.pi))


def test_what_has_no_bound_gets_none() -> None:
    def pole(x: Interval, order: int) -> Jet:
        reciprocal: Jet = 1.0 / (variable(x, order) - 0.3)
        return reciprocal

    assert extremes(pole, [0.0, 1.0]).high == np.inf
    with pytest.raises(SolverFailure, match="no bound"):
        integral(pole, [0.0, 1.0])
    with pytest.raises(SolverFailure, match="no finite value"):
        extremes(lambda x, order: variable(x, order) / (variable(x, order) * 0.0), [0.0, 1.0])


def test_a_plain_function_gets_no_bounds() -> None:
    with pytest.raises((TypeError, AttributeError)):
        extremes(lambda x, _: np.exp(-(((x - 0.3137) / 1e-3) ** 2)), [0.0, 1.0])  # type: ignore[operator]


def test_intervals_hold_what_mpmath_knows() -> None:
    generator = np.random.default_rng(7)
    first, second = (
        Interval(generator.normal(size=200) * 3.0, 10.0 ** generator.uniform(-20, 0, 200)) for _ in range(2)
    )
    shares = generator.choice([-1.0, 1.0, 0.0, 0.4], size=(2, 200))
    positive = between(np.abs(first.middle), np.abs(first.middle) + first.radius)
    cases: list[tuple[Interval, Callable[..., object], bool]] = [
        (first + second, lambda x, y: x + y, False),
        (first - second, lambda x, y: x - y, False),
        (first * second, lambda x, y: x * y, False),
        (first / second, lambda x, y: x / y, False),
        (first / 3, lambda x, _: x / 3, False),
        (1.0 / first, lambda x, _: 1 / x, False),
        (first * 0.1, lambda x, _: x * mpmath.mpf(0.1), False),
        (np.sin(first), lambda x, _: mpmath.sin(x), False),
        (np.cos(first), lambda x, _: mpmath.cos(x), False),
        (np.arctan(first), lambda x, _: mpmath.atan(x), False),
        (np.sqrt(positive), lambda x, _: mpmath.sqrt(x), True),
        (dot([first, second, first], [second, second, first]), lambda x, y: 2 * x * y - x * y + y * y + x * x, False),
    ]
    with mpmath.workdps(60):
        for enclosure, known, above in cases:
            base = positive if above else first
            for i in range(200):
                x = mpmath.mpf(base.middle[i]) + mpmath.mpf(shares[0, i]) * mpmath.mpf(base.radius[i])
                y = mpmath.mpf(second.middle[i]) + mpmath.mpf(shares[1, i]) * mpmath.mpf(second.radius[i])
                value = known(x, y)
                assert enclosure.low[i] <= value <= enclosure.high[i]
        turned = bearing(second, first)
        for i in np.flatnonzero(np.isfinite(turned.radius)).tolist():
            x = mpmath.mpf(first.middle[i]) + mpmath.mpf(shares[0, i]) * mpmath.mpf(first.radius[i])
            y = mpmath.mpf(second.middle[i]) + mpmath.mpf(shares[1, i]) * mpmath.mpf(second.radius[i])
            away = (
                mpmath.fmod(mpmath.atan2(y, x) - mpmath.mpf(turned.middle[i]) + 3 * mpmath.pi, 2 * mpmath.pi)
                - mpmath.pi
            )
            assert abs(away) <= turned.radius[i]


def test_jets_hold_derivatives_that_mpmath_knows() -> None:
    middle = np.array([0.3, 1.1, 2.0])
    x = variable(Interval(middle, np.array([0.0, 1e-3, 1e-2])), 5)
    sine, _ = (x * 2.0).waves()
    jet = (sine * sine + x).root() / (x * x + 1.0) + (x * 0.5).arctangent()
    with mpmath.workdps(40):
        for i, (place, half) in enumerate(zip(middle, (0.0, 1e-3, 1e-2), strict=True)):
            for share in (-1.0, 0.0, 0.7):
                known = mpmath.taylor(
                    lambda t: mpmath.sqrt(mpmath.sin(2 * t) ** 2 + t) / (t * t + 1) + mpmath.atan(t / 2),
                    mpmath.mpf(place) + mpmath.mpf(share) * half,
                    5,
                )
                for term, value in zip(jet.terms, known, strict=True):
                    assert term.low[i] - 1e-20 <= value <= term.high[i] + 1e-20


def test_exact_numbers_are_points() -> None:
    point = exact(np.array([1.0, -2.0]))
    assert (point.radius == 0.0).all()
    assert (point.low < point.high).all()


def test_of_extremes_as_high_as_one_another_the_first_is_named_however_cells_lie() -> None:
    """Both flanks of a symmetric cam are as steep: a report names the first, not the one nearer to a sample."""
    numbers = np.random.default_rng(0)
    for _ in range(40):
        frequency, shift = float(numbers.integers(2, 6)), numbers.random()
        edges = np.sort([0.0, *(2.0 * np.pi * numbers.random(3)), 2.0 * np.pi])
        found = extremes(lambda x, order: ((variable(x, order) + shift) * frequency).waves()[0], edges)  # noqa: B023
        first = (np.pi / 2.0 - shift * frequency) % (2.0 * np.pi) / frequency
        assert found.most_at == pytest.approx(first, abs=1e-6)


# --- polynomials ---


@pytest.mark.parametrize("degree", [0, 1, 5, 9])
def test_bernstein_coefficients_are_those_of_the_definition(degree: int) -> None:
    powers = np.random.default_rng(degree).integers(-9, 9, size=(3, degree + 1)).astype(float)
    exact = [
        [
            float(sum(Fraction(comb(i, n), comb(degree, n)) * int(row[n]) for n in range(i + 1)))
            for i in range(degree + 1)
        ]
        for row in powers
    ]
    assert bernstein.from_powers(powers) == pytest.approx(np.array(exact), rel=1e-14, abs=1e-13)
    u = (nodes(degree + 1) + 1.0) / 2.0
    values = np.array([np.polynomial.polynomial.polyval(u, row) for row in powers])
    assert bernstein.from_values(values) == pytest.approx(np.array(exact), rel=0, abs=1e-10)


def test_a_top_is_enclosed_and_found_where_it_is() -> None:
    for place in (0.1234567, 0.5, 1 / 3, 0.999):
        powers = np.array([[2.0 - place**2, 2.0 * place, -1.0, 0.0], [0.0, 0.0, 0.0, 1.9]])  # 2 - (u - place)²
        highest = bernstein.top(bernstein.from_powers(powers))
        assert highest.row == 0
        assert highest.value == pytest.approx(2.0, rel=0, abs=1e-15)
        assert highest.u == pytest.approx(place, abs=1e-7)


def test_the_greatest_difference_is_that_of_many_digits() -> None:
    value, x = greatest_difference(np.exp, lambda x: 1.0 + x + x * x / 2.0, np.array([-1.0, 0.3, 1.0]))
    with mpmath.workdps(30):
        assert value == pytest.approx(float(mpmath.e - mpmath.mpf(5) / 2), rel=1e-14)
    assert x == 1.0
    with pytest.raises(InputError, match=r"not smooth near x = .*: name its breaks"):
        greatest_difference(np.sign, lambda x: x * 0.0, np.array([-1.0, 0.7]))
    with pytest.raises(InputError, match="finite values"):
        greatest_difference(np.abs, lambda x: x + np.inf, np.array([-1.0, 0.7]))
