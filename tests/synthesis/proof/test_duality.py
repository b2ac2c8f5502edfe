"""Sums of rows in doubles, with what rounding hides of them."""

from fractions import Fraction

import numpy as np
import pytest

from optlaws import Chebyshev, Problem
from tests.internals.synthesis import least_violation, sum_of_rows, summed


def test_a_sum_is_that_of_the_exact_numbers_but_for_what_it_states() -> None:
    numbers = np.random.default_rng(9)
    weights, rows, cost = numbers.normal(size=(3, 7)) * 1e9, numbers.normal(size=(3, 7, 40)), numbers.normal(size=39)
    # the last row takes away nearly all that the others add
    rows[:, -1] = -np.einsum("lr,lrn->ln", weights[:, :-1], rows[:, :-1]) / weights[:, -1:]
    total = summed(cost[None], weights, rows, np.abs(rows))
    sums = [np.column_stack(pair) for pair in ((total.slope, total.value), (total.blur, total.hidden))]
    for law in range(3):
        for n, begin in enumerate([*cost.tolist(), 0.0]):
            parts = zip(weights[law].tolist(), rows[law, :, n].tolist(), strict=True)
            exact = Fraction(begin) + sum(Fraction(weight) * Fraction(entry) for weight, entry in parts)
            found, hidden = (some[law, n] for some in sums)
            assert abs(Fraction(float(found)) - exact) <= Fraction(float(hidden)) < Fraction(1e-4)


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
