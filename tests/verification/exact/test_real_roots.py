"""Real roots in balls: none may be missing, whatever the polynomial's symmetry."""

import pytest
from flint import fmpq, fmpq_poly

from tests.internals.verification import between, real_roots


def product(*roots: fmpq | int) -> fmpq_poly:
    polynomial = fmpq_poly([3])
    for root in roots:
        polynomial *= fmpq_poly([-root, 1])
    return polynomial


@pytest.mark.parametrize(
    "roots",
    [(), (0,), (0, 0), (1,), (-1, 1), (-1, 0, 1), (-2, -1, 1, 2), (-2, -1, 0, 0, 0, 1, 2), (1, 2, 3), (0, 1, 2)],
)
@pytest.mark.parametrize("factor", [[1], [1, 0, 1], [2, 0, 0, 0, 1], [1, 1, 1]])
def test_every_real_root_is_in_a_ball(roots: tuple[int, ...], factor: list[int]) -> None:
    half = fmpq(1, 2)
    found = real_roots(product(*(half * root for root in roots)) * fmpq_poly(factor))
    assert all(any(ball.contains(half * root) for ball in found) for root in roots)
    assert all(any(abs(float(ball.mid()) - root / 2) < 1e-9 for root in roots) for ball in found)


def test_a_polynomial_without_slope_is_its_own_extremes() -> None:
    least, greatest = between(fmpq_poly([5]), fmpq(-1), fmpq(1))
    assert least == greatest == 5
    least, greatest = between(fmpq_poly([1, 0, -2, 0, 1]), fmpq(-2), fmpq(2))
    assert least.contains(0)
    assert greatest.contains(9)
