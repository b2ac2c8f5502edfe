"""The one transform, root finder and bisection of the library: against mpmath, scipy and numpy."""

import mpmath  # type: ignore[import-untyped] # ships no types
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.special import j0, j1, jn_zeros

from optlaws import InputError
from tests.internals.numerics import Panels, bisect, chebyshev, of_waves, resolved

Array = NDArray[np.float64]


@pytest.mark.parametrize("count", [1, 2, 17, 64, 201])
def test_nodes_and_transform_are_right_to_the_last_digits(count: int) -> None:
    x = chebyshev.nodes(count)
    with mpmath.workdps(30):
        exact = [mpmath.cos((2 * j + 1) * mpmath.pi / (2 * count)) for j in range(count)]
        assert max(abs(mpmath.mpf(float(a)) - b) for a, b in zip(x, exact, strict=True)) <= 2e-16
    assert np.array_equal(x, -x[::-1])
    series = chebyshev.from_values(np.exp(3.0 * x))
    with mpmath.workdps(30):
        terms = [(2 if n else 1) * mpmath.besseli(n, 3) for n in range(min(count, 20))]
    missing = 0.0 if count >= 64 else 2e-12 if count >= 17 else np.inf  # what aliases
    assert max(abs(a - float(b)) for a, b in zip(series, terms, strict=False)) <= 2e-14 + missing


def test_several_functions_are_transformed_at_once_complex_ones_too() -> None:
    x = chebyshev.nodes(9)
    both = np.stack([x**3, np.cos(x)], axis=1)
    columns = [chebyshev.from_values(np.ascontiguousarray(one)) for one in both.T]
    assert chebyshev.from_values(both) == pytest.approx(np.stack(columns, axis=1), abs=1e-15)
    assert chebyshev.from_values(x + 1j * x).tolist() == pytest.approx([0, 1 + 1j, *[0] * 7], abs=1e-15)


@pytest.mark.parametrize("count", [6, 33, 64])
def test_a_constant_has_no_other_term(count: int) -> None:
    assert chebyshev.from_values(np.full(count, 0.1)).tolist() == [0.1] + [0.0] * (count - 1)


def test_what_cannot_be_resolved_is_said_by_name() -> None:
    with pytest.raises(InputError, match="c of it must be smooth on the whole interval: 1025 points"):
        chebyshev.interpolated(np.abs, "c of it")
    with pytest.raises(InputError, match="c of it must have finite values"):
        chebyshev.interpolated(lambda x: np.where(x > 0.5, np.inf, x), "c of it")


def test_values_that_are_rounded_give_a_short_series_where_that_is_allowed() -> None:
    def rounded(x: Array) -> Array:
        return np.exp(x) + 1e-11 * np.sin(1e6 * x)

    with pytest.raises(InputError, match="must be smooth"):
        chebyshev.interpolated(rounded, "c of it")
    series = chebyshev.interpolated(rounded, "c of it", blur=1e-9)
    assert len(series) < 17
    x = np.linspace(-1.0, 1.0, 101)
    assert np.abs(np.polynomial.chebyshev.chebval(x, series) - np.exp(x)).max() < 1e-10
    # the values are rounded more than is allowed
    with pytest.raises(InputError, match="must be smooth"):
        chebyshev.interpolated(rounded, "c of it", blur=1e-13)


def test_every_root_on_every_panel() -> None:
    zeros = jn_zeros(0, 30)
    roots = Panels(tuple(np.linspace(0.0, 95.0, 13).tolist())).roots(j0, lambda t: -j1(t))
    assert max(np.abs(roots - zero).min() for zero in zeros) <= 3e-14
    assert Panels(()).roots(j0, j1).size == 0
    assert Panels((0.0, 1.0)).roots(np.zeros_like, np.zeros_like).size == 0


def test_roots_are_more_exact_than_the_series_that_finds_them() -> None:
    # seven terms on four radians leave 1e-3
    roots = Panels((0.0, 4.0, 8.0), 7).roots(np.cos, lambda t: -np.sin(t))
    assert max(np.abs(roots - np.pi * (n + 0.5)).min() for n in range(3)) <= 4.0 * np.finfo(float).eps


def test_each_of_the_first_panels_is_halved() -> None:
    halves, series = resolved(np.exp, Panels((0.0, 1.0, 2.0, 4.0), 9), lambda _, length: length <= 1.0)
    assert halves == Panels((0.0, 1.0, 2.0, 3.0, 4.0), 9)
    assert series == pytest.approx(halves.series(np.exp), rel=1e-15)


def test_panels_are_halved_where_the_function_asks_for_it() -> None:
    def spike(t: Array) -> Array:
        return np.asarray(1.0 / (1e-4 + (t - 0.3) ** 2))

    def short(series: Array, length: float) -> bool:
        return bool(np.abs(series[-3:]).max() <= 1e-10 * 1e4) or length < 1e-3

    panels, series = resolved(spike, Panels((0.0, 1.0)), short)
    lengths = np.diff(panels.edges)
    assert lengths.min() < 0.04
    assert lengths.max() > 0.2
    assert series == pytest.approx(panels.series(spike), rel=1e-15)
    whole = panels.integral(spike)(np.array([0.0, 0.3, 1.0]))
    exact = 100.0 * (np.arctan(100.0 * (np.array([0.0, 0.3, 1.0]) - 0.3)) + np.arctan(30.0))
    assert whole == pytest.approx(exact, rel=1e-11, abs=1e-9)


@pytest.mark.parametrize("frequency", [0.1, 9.0, 400.0])
def test_squares_of_waves(frequency: float) -> None:
    square = of_waves(frequency, 2.0).square(lambda u: np.sin(2.0 * frequency * u))
    assert square == pytest.approx(0.5 - np.sin(4.0 * frequency) / (8.0 * frequency), rel=1e-11)


def test_halving_ends_with_neighbours_or_where_it_is_told() -> None:
    inside, outside = bisect(lambda x: x < 1.0 / 3.0, 0.0, 1.0)
    assert inside < 1.0 / 3.0 <= outside == np.nextafter(inside, 1.0)
    assert bisect(lambda x: x > 1.0 / 3.0, 1.0, 0.0, halvings=3) == (0.375, 0.25)
