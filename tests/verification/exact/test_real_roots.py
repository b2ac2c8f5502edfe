"""Real roots in balls: none may be missing, whatever the polynomial's symmetry."""

from math import inf

import pytest
from flint import arb, ctx, fmpq, fmpq_poly, fmpz_poly

from tests.internals.verification import between, near, real_roots


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


@pytest.mark.parametrize("bits", [53, 113, 128, 256])
def test_a_root_next_to_an_end_and_to_a_turn_of_the_slope_is_enclosed(bits: int) -> None:
    """In a narrower ball than one in which the slope has a sign it had none: the jerk at the end of an optimal law."""
    chebyshev = [-1.680059301997406, 2.4049935593187253, -0.7778447938436768, 0.020026138328819082, 0.0328843981935381]
    terms = [fmpq(*value.as_integer_ratio()) * fmpq_poly(fmpz_poly.chebyshev_t(n)) for n, value in enumerate(chebyshev)]
    with ctx.workprec(bits):
        (root,) = real_roots(sum(terms, fmpq_poly([0])).derivative(), fmpq(-1), fmpq(1))
        assert root.is_finite()
        assert root.rad() < 1e-7


def test_an_infinite_enclosure_proves_no_number() -> None:
    assert near("C", 8.0, (8.0 - 1e-15, 8.0)).proven
    assert near("C", inf, (inf, inf)).proven
    assert not near("C", 8.0, (-inf, inf)).proven
    assert not near("C", 8.0, (7.9, 8.1)).proven


def test_a_polynomial_without_slope_is_its_own_extremes() -> None:
    least, greatest = between(fmpq_poly([5]), fmpq(-1), fmpq(1))
    assert least == greatest == 5
    least, greatest = between(fmpq_poly([1, 0, -2, 0, 1]), fmpq(-2), fmpq(2))
    assert least.contains(0)
    assert greatest.contains(9)
