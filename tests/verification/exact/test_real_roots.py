"""Real roots in balls: none may be missing, whatever the polynomial's symmetry."""

import pytest
from flint import arb, ctx, fmpq, fmpq_poly

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
    found = real_roots(product(*(half * root for root in roots)) * fmpq_poly(factor), fmpq(-1), fmpq(2))
    assert all(any(ball.contains(half * root) for ball in found) for root in roots)
    assert all(any(abs(float(ball.mid()) - root / 2) < 1e-9 for root in roots) for ball in found)


@pytest.mark.parametrize("place", [fmpq(1), fmpq(-1), fmpq(1, 3), fmpq(0)])
@pytest.mark.parametrize("apart", [fmpq(1, 10**20), fmpq(1, 10**60)])
def test_roots_next_to_one_another_and_to_an_end_are_told_apart(place: fmpq, apart: fmpq) -> None:
    """Whichever of them are beyond the end, those inside are in balls narrower than the way to the next."""
    polynomial = product(place - apart, place, place + apart, fmpq(1, 2))
    inside = [root for root in (place - apart, place, place + apart, fmpq(1, 2)) if -1 <= root <= 1]
    with ctx.workprec(600):
        balls = real_roots(polynomial, fmpq(-1), fmpq(1))
        assert len(balls) == len(inside)
        assert all(sum(ball.overlaps(arb(root)) for ball in balls) == 1 for root in inside)


def test_a_polynomial_without_slope_is_its_own_extremes() -> None:
    least, greatest = between(fmpq_poly([5]), fmpq(-1), fmpq(1))
    assert least == greatest == 5
    least, greatest = between(fmpq_poly([1, 0, -2, 0, 1]), fmpq(-2), fmpq(2))
    assert least.contains(0)
    assert greatest.contains(9)
