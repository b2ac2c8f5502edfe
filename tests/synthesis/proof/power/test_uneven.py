"""The limit of D where the peak velocity is not in the middle."""

import numpy as np
import pytest

from optlaws import Chebyshev, Problem, limit, synthesize
from tests.internals.synthesis import known_limit
from tests.sampling import sampled


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
