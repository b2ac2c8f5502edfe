"""The closed-form limits against linear programs over piecewise constant accelerations, which approach from above."""

from itertools import pairwise
from math import inf, nan

import numpy as np
import pytest
from scipy.optimize import linprog

from optlaws import Chebyshev, InputError, Problem, acceleration_limit, synthesize


def least_acceleration(B: float, cells: int, *, monotone: bool, order: int) -> float:
    """Least max |c| of laws with constant c on each of `cells` equal cells: exact for those laws.

    Variables are the velocities at the nodes, between which b is linear, and C.
    """
    h = 1.0 / cells
    nodes = cells + 1
    rise = (np.eye(cells, nodes, 1) - np.eye(cells, nodes)) / h
    C = -np.ones((cells, 1))
    rows = np.block([[rise, C], [-rise, C]])
    stroke = np.full(nodes, h)
    stroke[[0, -1]] = h / 2
    middle = np.zeros(nodes)
    middle[cells // 2] = 1.0
    lowest = 0.0 if monotone else -np.inf
    bounds: list[tuple[float | None, float | None]] = [(lowest, B)] * nodes + [(0.0, None)]
    if order > 1:
        bounds[0] = bounds[-2] = (0.0, 0.0)
    answer = linprog(
        np.append(np.zeros(nodes), 1.0),
        A_ub=rows,
        b_ub=np.zeros(2 * cells),
        A_eq=np.column_stack([np.vstack([stroke, middle]), np.zeros(2)]),
        b_eq=[1.0, B],
        bounds=bounds,
        method="highs",
    )
    assert answer.status == 0, answer.message
    assert answer.fun is not None
    return float(answer.fun)


CASES = [
    (1.1, False, 2),
    (1.3, False, 2),
    (1.641, False, 4),
    (1.9, True, 3),
    (2.0, False, 2),
    (2.0, True, 2),
    (2.3, False, 2),
    (3.0, False, 5),
    (2.3, True, 2),
    (3.0, True, 2),
    (1.5, False, 1),
    (1.5, True, 1),
    (2.7, False, 1),
    (2.7, True, 1),
]


@pytest.mark.sample(9)
@pytest.mark.parametrize(("B", "monotone", "order"), CASES)
def test_piecewise_constant_accelerations_approach_the_limit_from_above(
    B: float,
    monotone: bool,  # noqa: FBT001
    order: int,
) -> None:
    limit = acceleration_limit(B, monotone=monotone, order=order)
    found = [least_acceleration(B, cells, monotone=monotone, order=order) for cells in (20, 60, 180, 540)]
    assert all(value >= limit * (1 - 1e-9) for value in found)
    # each grid contains the one before: C cannot rise
    assert all(fine <= coarse * (1 + 1e-9) for coarse, fine in pairwise(found))
    assert found[-1] <= limit * (1 + 3e-4)
    assert found[-1] - limit <= max(0.1 * (found[0] - limit), 1e-9 * limit)


@pytest.mark.parametrize(
    ("B", "monotone", "order", "cells"),
    [
        (1.6, False, 2, 8),
        (1.25, False, 3, 10),
        (2.0, False, 2, 2),
        (2.5, True, 2, 10),
        (2.5, True, 1, 10),
        (1.4, False, 1, 2),
    ],
)
def test_where_the_switches_fall_on_the_grid_the_limit_is_met(
    B: float,
    monotone: bool,  # noqa: FBT001
    order: int,
    cells: int,
) -> None:
    found = least_acceleration(B, cells, monotone=monotone, order=order)
    assert found == pytest.approx(acceleration_limit(B, monotone=monotone, order=order), rel=1e-9)


def test_the_limits_join_where_their_formulas_change() -> None:
    for monotone in (False, True):
        for order in (1, 2):
            below, above = (acceleration_limit(B, monotone=monotone, order=order) for B in (2.0 - 1e-12, 2.0 + 1e-12))
            assert below == pytest.approx(4.0, abs=1e-10)
            assert above == pytest.approx(4.0, abs=1e-10)


def test_the_least_of_all_limits_is_4_at_b_2() -> None:
    values = np.linspace(1.01, 4.0, 300)
    assert min(acceleration_limit(float(B)) for B in values) >= 4.0
    assert acceleration_limit(2) == 4.0


@pytest.mark.sample(5)
@pytest.mark.parametrize("B", [1.2, 1.641, 2.0, 2.3, 3.0])
@pytest.mark.parametrize("monotone", [False, True])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_rich_law_comes_near_the_limit_and_not_below(B: float, order: int, monotone: bool) -> None:  # noqa: FBT001
    solution = synthesize(Problem(B=B, order=order, basis=Chebyshev(51), monotone=monotone))
    assert solution.best_possible == acceleration_limit(B, monotone=monotone, order=order)
    assert solution.best_possible < solution.lower_bound < solution.best_possible * 1.2


@pytest.mark.parametrize("B", [1.0, 0.5, 0.0, -2.0, nan, inf, -inf, "2", None, True, [2.0], 2j])
def test_a_peak_velocity_that_makes_no_sense_is_refused(B: object) -> None:
    with pytest.raises(InputError, match="B must be a finite number above 1"):
        acceleration_limit(B)  # type: ignore[arg-type] # that is what is refused


@pytest.mark.parametrize("order", [0, -1, 1.5, "2", True, None])
def test_an_order_that_makes_no_sense_is_refused(order: object) -> None:
    with pytest.raises(InputError, match="order"):
        acceleration_limit(2.0, order=order)  # type: ignore[arg-type]
