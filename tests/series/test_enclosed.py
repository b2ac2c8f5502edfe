from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.series.enclosed import bounds, enclosed

Array = NDArray[np.float64]

EDGES = np.array([0.0, 1.0, 2.5, 6.0])


def test_bounds_hold_the_function_and_are_near_it() -> None:
    starts = np.linspace(0.0, 6.0, 61)
    low, high = bounds(lambda x: np.sin(3 * x) * np.exp(-x), starts[:-1], starts[1:])
    places = np.linspace(starts[:-1], starts[1:], 401)
    values = np.sin(3 * places) * np.exp(-places)
    assert (low <= values.min(axis=0)).all()
    assert (high >= values.max(axis=0)).all()
    assert (values.min(axis=0) - low).max() < 1e-3
    assert (high - values.max(axis=0)).max() < 1e-3


def test_extremes_of_random_functions_are_enclosed() -> None:
    generator = np.random.default_rng(5)
    for _ in range(40):
        function = waves(*generator.normal(size=(3, 5)) * [[1.0], [4.0], [2.0]])
        enclosure = enclosed(function, EDGES)
        dense = function(np.linspace(0.0, 6.0, 20001))
        assert enclosure.low <= dense.min() <= enclosure.least + 1e-5
        assert enclosure.most - 1e-5 <= dense.max() <= enclosure.high
        assert enclosure.high - enclosure.most <= 1.01e-9 * enclosure.peak
        assert function(np.array(enclosure.most_at)) == pytest.approx(enclosure.most, abs=1e-12)


def waves(weights: Array, frequencies: Array, phases: Array) -> Callable[[Array], Array]:
    return lambda x: np.asarray(np.sin(np.multiply.outer(x, frequencies) + phases) @ weights)


def test_leaps_at_edges_are_seen_from_both_sides() -> None:
    enclosure = enclosed(lambda x: np.where(x < 1.0, 1.0 + x, -x), np.array([0.0, 1.0, 2.0]))
    assert (enclosure.least, enclosure.most) == pytest.approx((-2.0, 2.0))
    assert enclosure.bound == pytest.approx(2.0)


def test_what_is_not_smooth_or_not_finite_is_refused() -> None:
    with pytest.raises(InputError, match="not smooth"):
        enclosed(lambda x: np.where(x < 0.3, 0.0, 1.0 + x), np.array([0.0, 1.0]), share=1e-30)
    with pytest.raises(InputError, match="finite"):
        enclosed(lambda x: np.where(x < 0.3, 0.0, np.inf), np.array([0.0, 1.0]))
