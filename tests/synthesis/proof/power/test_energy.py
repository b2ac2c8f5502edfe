"""Least power over laws given by their energy, and the limit of D where the peak velocity is not in the middle."""

from typing import Any

import clarabel
import numpy as np
import pytest
from scipy.sparse import bmat, csc_array, csr_array, eye_array, lil_array

from optlaws import Chebyshev, Problem, at_most, limit, synthesize
from tests.internals.synthesis import known_limit
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


# --- uneven laws ---


def uneven(B: float, k: float, *, monotone: bool = True, degree: int = 9) -> Problem:
    basis = Chebyshev(degree)
    return Problem(B=B, order=2, basis=basis, minimise="D", symmetric=False, inflexion=k, monotone=monotone)


def least_power(B: float, k: float) -> float:
    """Least D whose least and greatest energies, B²/2 at k and 0 at the ends, have strokes that embrace 1."""
    at = (np.arange(200_000) + 0.5) / 200_000

    def possible(D: float) -> bool:
        most = np.minimum(B * B / 2, D * np.minimum(at, 1 - at))
        fewest = np.maximum(0.0, B * B / 2 - D * np.abs(at - k))
        reached = D * min(k, 1 - k) >= B * B / 2
        return bool(reached and np.sqrt(2 * fewest).mean() <= 1.0 <= np.sqrt(2 * most).mean())

    low, high = 0.1, 200.0
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (low, middle) if possible(middle) else (middle, high)
    return high


@pytest.mark.sample(6)
@pytest.mark.parametrize("k", [0.2, 0.4, 0.55])
@pytest.mark.parametrize("B", [1.2, 1.5, 1.8, 2.5])
def test_the_limit_is_what_energies_allow(B: float, k: float) -> None:
    assert known_limit(uneven(B, k)) == pytest.approx(least_power(B, k), rel=1e-4)


@pytest.mark.parametrize(("B", "k"), sampled([(1.4, 0.4), (1.8, 0.55), (1.5, 0.25)]))
def test_laws_come_down_toward_the_limit_and_stay_above(B: float, k: float) -> None:
    costs = []
    for degree in (7, 17):
        solution = synthesize(uneven(B, k, degree=degree))
        assert solution.best_possible is not None
        assert solution.best_possible == known_limit(uneven(B, k, monotone=False)) or B > 1.5
        assert solution.best_possible <= solution.lower_bound <= solution.objective
        costs.append(solution.objective / solution.best_possible - 1.0)
    assert 0.0 < costs[1] < costs[0] / 1.5


def test_the_place_costs_power_where_the_way_to_it_is_short() -> None:
    near, far = (known_limit(uneven(1.5, k)) for k in (0.45, 0.1))
    assert near is not None
    assert far is not None
    assert limit("D", 1.5) < near < far
    assert far == pytest.approx(1.5**2 / 0.2, rel=1e-12)
