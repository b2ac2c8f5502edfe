"""Places where functions change their sign, against roots that are known in closed form."""

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.internals.numerics import bracketed_root, bracketed_roots, sign_changes

Array = NDArray[np.float64]


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
