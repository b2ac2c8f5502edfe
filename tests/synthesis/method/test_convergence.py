"""As the degree of Z grows, C falls toward the limit of all laws, at a rate that can be understood.

A law of order l with Z of degree n is a polynomial of degree N = n + 2l; a jump of its acceleration is smoothed over
a width of 1/N inside the interval and of 1/N² at its ends.

- B < 2: the limit jumps between C and 0 (constant acceleration, then constant speed). Smoothed evenly about the switch,
  the velocity gained stays the same to first order: the loss is of the order of the width squared, N^-2.
- B >= 2, and order 1: the limit jumps from C to -C at k = 1/2, where b has its peak, which a smooth c cuts off: the
  loss is of the order of the width, N^-1.
"""

import numpy as np
import pytest

from optlaws import Chebyshev, Problem, synthesize
from tests.sampling import sampled

DEGREES = np.arange(9, 62, 4)


def excesses(order: int, B: float, *, monotone: bool = False) -> np.ndarray:
    found = []
    for degree in DEGREES:
        problem = Problem(B=B, order=order, basis=Chebyshev(int(degree)), monotone=monotone)
        solution = synthesize(problem)
        assert solution.gap <= 1e-8
        assert solution.best_possible is not None
        found.append(solution.objective - solution.best_possible)
    return np.array(found)


def exponent(order: int, excess: np.ndarray) -> float:
    slope, _ = np.polyfit(np.log(DEGREES + 2 * order), np.log(excess), 1)
    return float(slope)


def falls(excess: np.ndarray) -> bool:
    return bool(np.all(excess > 0.0) and np.all(np.diff(excess) < 0.0))


@pytest.mark.long
@pytest.mark.parametrize(("order", "B"), sampled([(2, 1.3), (3, 1.4), (4, 1.53), (4, 1.641), (2, 1.641)]))
def test_below_2_the_excess_falls_with_the_square_of_the_degree(order: int, B: float) -> None:
    excess = excesses(order, B)
    assert falls(excess)
    assert -2.25 <= exponent(order, excess) <= -1.85


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("order", "B", "monotone"),
    sampled(
        [
            (2, 2.3, False),
            (4, 2.3, False),
            (2, 2.3, True),
            (4, 2.3, True),
            (3, 2.7, False),
            (2, 2.0, False),
            (4, 2.0, False),
        ],
        4,
    ),
)
def test_from_2_on_the_excess_falls_with_the_degree(order: int, B: float, monotone: bool) -> None:  # noqa: FBT001
    excess = excesses(order, B, monotone=monotone)
    assert falls(excess)
    assert -1.13 <= exponent(order, excess) <= -0.92


@pytest.mark.long
@pytest.mark.sample(3)
@pytest.mark.parametrize("B", [1.3, 1.859, 2.7])
def test_with_free_end_velocities_the_excess_falls_with_the_degree(B: float) -> None:
    excess = excesses(1, B)
    assert falls(excess)
    assert -1.05 <= exponent(1, excess) <= -0.95
    # without another constraint that binds, the problem is homogeneous in B - 1
    assert excess == pytest.approx((B - 1.0) * excesses(1, 2.0), rel=1e-9)


def test_asking_b_at_least_0_costs_nothing_where_it_does_not_bind() -> None:
    free, asked = (
        synthesize(Problem(B=1.859, order=4, basis=Chebyshev(9), monotone=monotone)) for monotone in (False, True)
    )
    assert asked.objective == pytest.approx(free.objective, rel=1e-12)


@pytest.mark.parametrize("B", [2.2, 2.6, 3.0])
def test_a_free_sign_of_b_lowers_c(B: float) -> None:
    free, asked = (
        synthesize(Problem(B=B, order=3, basis=Chebyshev(21), monotone=monotone)) for monotone in (False, True)
    )
    assert free.objective < asked.objective
    assert free.law.extrema(1)[0].value < -1e-3
    assert free.best_possible is not None
    assert asked.best_possible is not None
    assert free.best_possible < asked.best_possible
