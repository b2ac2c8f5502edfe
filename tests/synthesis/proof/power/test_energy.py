"""Least power over laws given by their energy E = b²/2, a cone program: E' = d, and the stroke is concave in E."""

from typing import Any

import clarabel
import numpy as np
import pytest
from scipy.sparse import bmat, csc_array, csr_array, eye_array, lil_array

from optlaws import Chebyshev, Problem, at_most, limit, synthesize
from tests.sampling import sampled

CELLS = 400


def least_by_energy(B: float | None) -> float:
    """Least D of laws that move forth with E linear on equal cells and b <= B.

    The trapezoids under the roots of E are less than their integral, so the law found covers a stroke of 1 at least.
    """
    n = CELLS + 1
    power = 2 * n
    size = power + 1
    slopes = csr_array((np.tile([-1.0, 1.0], CELLS), (np.repeat(range(CELLS), 2), _pairs())), shape=(CELLS, n)) * CELLS
    ones = csr_array(-np.ones((CELLS, 1)))
    stroke = np.zeros(size)
    stroke[n:power] = -1.0 / CELLS
    stroke[[n, power - 1]] /= 2.0
    ends = lil_array((2, size))
    ends[0, 0] = ends[1, n - 1] = 1.0
    rows: list[Any] = [ends, bmat([[slopes, None, ones]]), bmat([[-slopes, None, ones]]), stroke[None]]
    rows[1:3] = [_wide(one, n, size) for one in rows[1:3]]
    right: list[np.ndarray] = [np.zeros(2), np.zeros(2 * CELLS), -np.ones(1)]
    if B is not None:
        rows.append(bmat([[eye_array(n), csr_array((n, size - n))]]))
        right.append(np.full(n, B * B / 2.0))
    flat = 2 * CELLS + 1 + (n if B is not None else 0)
    # (E + 1/2)² >= (E - 1/2)² + b²
    cone = lil_array((3 * n, size))
    for i in range(n):
        cone[3 * i, i] = cone[3 * i + 1, i] = cone[3 * i + 2, n + i] = -1.0
    rows.append(cone)
    right.append(np.tile([0.5, -0.5, 0.0], n))
    cones = [clarabel.ZeroConeT(2), clarabel.NonnegativeConeT(flat), *[clarabel.SecondOrderConeT(3)] * n]
    goal = np.zeros(size)
    goal[power] = 1.0
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    matrix = csc_array(bmat([[one] for one in rows]))
    answer = clarabel.DefaultSolver(
        csc_array((size, size)), goal, matrix, np.concatenate(right), cones, settings
    ).solve()
    assert str(answer.status) == "Solved"
    return float(answer.obj_val)


def _pairs() -> np.ndarray:
    return np.column_stack([np.arange(CELLS), np.arange(1, CELLS + 1)]).ravel()


def _wide(block: Any, n: int, size: int) -> Any:
    parts = block.tocsc()
    return bmat([[parts[:, :n], csr_array((CELLS, size - n - 1)), parts[:, n:]]])


@pytest.mark.sample(2)
@pytest.mark.parametrize("B", [1.2, 1.4, 1.5, None])
def test_the_least_power_of_energies_is_the_limit(B: float | None) -> None:
    found = least_by_energy(B)
    assert limit("D", B) * (1 - 1e-7) <= found <= limit("D", B) * 1.003


@pytest.mark.long
@pytest.mark.parametrize("B", sampled([1.4, None]))
def test_polynomials_of_any_degree_cost_more_power_than_energies(B: float | None) -> None:
    least = limit("D", B)
    costs = []
    for degree in (5, 9, 15):
        asked = Problem(
            B=None if B is None else at_most(B), order=2, basis=Chebyshev(degree), minimise="D", monotone=True
        )
        solution = synthesize(asked, bound="tight")
        assert solution.status.value == "optimal"
        assert solution.lower_bound > least
        costs.append(solution.objective / least - 1.0)
    assert costs == sorted(costs, reverse=True)
    assert costs[-1] < costs[0] / 2.0 < 0.25
