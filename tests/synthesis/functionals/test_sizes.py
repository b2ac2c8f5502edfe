"""Integrals of convex formulas bound the laws in which they are small, and are optimal with nothing beside them."""

import numpy as np
import pytest

from optlaws import BoundaryConditions, Chebyshev, Problem, integral, law_from_z, peak, rms, synthesize
from tests.internals.synthesis import space_of
from tests.sampling import sampled

CONSTANTS = [
    integral("c^2 + (1 + k)*b^2"),
    rms("norm(b, c)"),
    integral("exp(c/5)"),
    integral("c^4"),
    rms("exp(c/5)"),
    integral("abs(c - b)"),
    peak("c + 3*b", side="low"),
    peak("norm(b, c)"),
]


@pytest.mark.parametrize("constant", sampled(CONSTANTS, each=2), ids=repr)
def test_no_law_is_larger_than_the_bound_says(constant: object) -> None:
    rest = BoundaryConditions.rest(3)
    [(order, factor, offset)] = constant.sizes(space_of(Chebyshev(7), rest, symmetric=False))  # type: ignore[attr-defined]
    rng, k = np.random.default_rng(1), np.linspace(0.0, 1.0, 2001)
    for size in (1.0, 10.0, 100.0) * 5:
        law = law_from_z(rest, size * rng.normal(size=2))
        mean = float(np.mean(np.abs(law(k, order))))
        assert mean <= factor * constant.value(law) + offset  # type: ignore[attr-defined]


@pytest.mark.parametrize("constant", CONSTANTS[:5:2], ids=repr)
def test_an_integral_alone_is_optimal(constant: object) -> None:
    solution = synthesize(Problem(order=3, basis=Chebyshev(7), minimise=constant))  # type: ignore[arg-type]
    assert solution.status.value == "optimal"
    assert solution.gap < 1e-10
