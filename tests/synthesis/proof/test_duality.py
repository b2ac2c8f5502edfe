"""Sums of rows are rounded once, whatever cancels in them."""

from fractions import Fraction

import numpy as np
import pytest

from optlaws import Chebyshev, Problem
from tests.internals.synthesis import _weighted, least_violation, sum_of_rows


@pytest.mark.parametrize("seed", range(4))
def test_a_product_and_its_rounded_value_leave_what_rounding_hid(seed: int) -> None:
    numbers = np.random.default_rng(seed)
    weight, entries = float(numbers.normal()), numbers.normal(size=500)
    rounded = weight * entries
    left = _weighted(np.array([weight, -1.0]), np.vstack([entries, rounded]), np.zeros(500))
    hidden = [
        Fraction(weight) * Fraction(entry) - Fraction(product) for entry, product in zip(entries, rounded, strict=False)
    ]
    assert any(hidden)
    assert left.tolist() == [float(part) for part in hidden]


def test_a_sum_is_that_of_the_exact_numbers() -> None:
    numbers = np.random.default_rng(9)
    weights, rows, start = numbers.normal(size=7) * 1e9, numbers.normal(size=(7, 40)), numbers.normal(size=40)
    exact = [
        Fraction(begin)
        + sum(Fraction(weight) * Fraction(entry) for weight, entry in zip(weights, column, strict=False))
        for begin, column in zip(start, rows.T, strict=False)
    ]
    assert _weighted(weights, rows, start).tolist() == [float(value) for value in exact]


def test_what_overflows_is_no_number() -> None:
    with np.errstate(over="ignore", invalid="ignore"):
        assert np.isnan(_weighted(np.array([1e308]), np.array([[1e10, 1.0]]), np.zeros(2))).all()


def test_where_nothing_bounds_the_law_a_sum_that_depends_on_it_proves_nothing() -> None:
    model = least_violation(Problem(order=2, basis=Chebyshev(1)))
    program = model.program
    on_law, on_none = np.zeros(program.size), np.zeros(program.size)
    on_law[0] = 1.0
    assert sum_of_rows(model, []) == 0.0
    assert sum_of_rows(model, [(2.0, on_none, -3.0)]) == pytest.approx(6.0, rel=1e-14)
    assert sum_of_rows(model, [(1.0, on_law, -3.0)]) == -np.inf
    # rows that cancel may leave what rounding hides
    assert sum_of_rows(model, [(1.0, on_law, -3.0), (1.0, -on_law, 0.0)]) == -np.inf
