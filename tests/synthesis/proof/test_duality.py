"""Sums of rows are rounded once, whatever cancels in them."""

from fractions import Fraction

import numpy as np
import pytest

from optlaws import BoundaryConditions, Chebyshev, Pieces, Problem, via
from tests.internals.synthesis import _weighted, by_bends, least_violation, model_of, sum_of_rows

Line = tuple[float, np.ndarray, float]


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


def summed(lines: list[Line]) -> list[Fraction]:
    """The weighted rows and right sides, added up exactly."""
    rows = [[Fraction(weight) * Fraction(float(entry)) for entry in (*row, right)] for weight, row, right in lines]
    return [sum(column, Fraction(0)) for column in zip(*rows, strict=True)]


@pytest.mark.parametrize("places", [[0.1 * i for i in range(1, 8)], [0.05, 0.1, 0.15, 0.3, 0.45, 0.5, 0.55, 0.7, 0.9]])
def test_equations_of_bends_have_the_sum_of_those_of_positions(places: list[float]) -> None:
    # neither at rest nor at 0 at the start, and positions off the line between them
    windows = tuple(via("a", 0.3 + 0.3 * k * k, at=k) for k in places)
    ends = BoundaryConditions((0.25, 0.5, 0), (1, 0, 0))
    problem = Problem(
        boundary=ends, symmetric=False, basis=Pieces(breaks=tuple(np.linspace(0, 1, 11))), minimise="J", windows=windows
    )
    model = model_of(problem)
    numbers = np.random.default_rng(3)
    weights = numbers.normal(size=len(model.positions)).tolist()
    equations = zip(weights, model.program.equalities, model.program.right.tolist(), strict=True)
    lines = [(2.0, numbers.normal(size=model.program.size), 0.5), *equations]
    turned = by_bends(model, lines)
    together = summed(turned)
    assert [float(value) for value in together] == pytest.approx([float(value) for value in summed(lines)], abs=1e-13)
    # all but the first position became local
    known = [i for i, position in enumerate(model.positions, 1) if position is not None]
    changed = [i for i, (new, old) in enumerate(zip(turned, lines, strict=True)) if new[1].tolist() != old[1].tolist()]
    assert len(changed) == len(known) - 1 == len(places)
    assert set(changed) < set(known)


def test_few_positions_stay_as_they_are() -> None:
    windows = tuple(via("a", k, at=k) for k in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6))  # with the end one less than is changed
    problem = Problem(order=2, symmetric=False, basis=Pieces(breaks=(0.0, 0.3, 0.5, 0.8, 1.0)), windows=windows)
    model = model_of(problem)
    lines = [(1.0, row, 0.0) for row in model.program.equalities]
    assert by_bends(model, lines) is lines
