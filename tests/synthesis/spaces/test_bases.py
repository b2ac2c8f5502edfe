"""One law whatever the basis, the start or the symmetry asked for; z reproduces it through eq. 8."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from optlaws import (
    Basis,
    BoundaryConditions,
    Chebyshev,
    Powers,
    Problem,
    law_from_z,
    smoothstep,
    sweep,
    synthesize,
)
from optlaws.synthesis import PolynomialBasis
from tests.synthesis.independent import check_solution, z_of, z_powers_of

K = np.linspace(0.0, 1.0, 201)
SHAPES = [(1.859, 4, 3), (1.641, 4, 9), (2.3, 2, 7), (1.9, 6, 15), (2.7, 3, 15), (1.5, 1, 5), (1.859, 5, 11)]
every_shape = pytest.mark.parametrize(("B", "order", "degree"), SHAPES)


@every_shape
def test_powers_and_chebyshev_give_the_same_law(B: float, order: int, degree: int) -> None:
    one, other = (synthesize(Problem(B=B, order=order, basis=kind(degree))) for kind in (Powers, Chebyshev))
    assert one.objective == pytest.approx(other.objective, rel=1e-12)
    assert one.law(K, 2) == pytest.approx(other.law(K, 2), abs=1e-10 * one.objective)
    assert one.lower_bound == pytest.approx(other.lower_bound, rel=1e-12)
    assert one.z_powers == pytest.approx(other.z_powers, rel=1e-9)


def test_a_new_basis_is_one_class() -> None:
    class Odd(PolynomialBasis):
        name = "odd powers of 2k - 1"

        def coefficients(self, series: np.ndarray) -> tuple[float, ...]:
            powers = np.polynomial.chebyshev.cheb2poly(series[: self.size])
            return tuple(float(value) for value in np.pad(powers, (0, self.size - len(powers))))

        def series(self, z: object) -> np.ndarray:
            return np.polynomial.chebyshev.poly2cheb(np.asarray(z, dtype=float))

    try:
        problem = Problem(B=1.859, order=4, basis=Odd(9))
        solution = synthesize(problem)
        check_solution(solution)
        assert solution.objective == synthesize(replace(problem, basis=Chebyshev(9))).objective
        law = law_from_z(BoundaryConditions.rest(4), z_of(solution), Odd(9))
        assert law.peak(2).value == pytest.approx(solution.objective, rel=1e-11)
        assert Problem.from_dict(problem.to_dict()) == problem
    finally:
        del Basis.kinds[Odd.name]


# --- starts ---


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("order", "degree", "monotone", "minimise"),
    [
        *((4, 3, False, "C"), (4, 9, False, "C"), (2, 15, False, "C"), (3, 9, True, "C"), (4, 19, False, "C")),
        *((4, 9, False, "J"), (4, 9, False, "rms_c"), (4, 9, False, "snap"), (4, 9, False, "C/8 + J/64")),
    ],
)
def test_a_sweep_gives_what_each_problem_gives_alone(order: int, degree: int, monotone: bool, minimise: str) -> None:  # noqa: FBT001
    first = Problem(B=1.6, order=order, basis=Chebyshev(degree), monotone=monotone, minimise=minimise)
    problems = [replace(first, B=float(B)) for B in np.linspace(1.5 if minimise != "C" else 1.6, 2.4, 17)]
    for warm, problem in zip(sweep(problems), problems, strict=True):
        cold = synthesize(problem)
        assert warm.problem == problem
        assert warm.objective == pytest.approx(cold.objective, rel=1e-11 if minimise == "C" else 1e-10)
        if minimise == "C":
            assert warm.lower_bound == pytest.approx(cold.lower_bound, rel=1e-11)
            check_solution(cold)
            check_solution(warm, of_array=True)


# --- symmetry and degree ---


@pytest.mark.parametrize("degree", [4, 8, 12])
@pytest.mark.parametrize("order", [2, 4])
def test_an_even_degree_adds_nothing(order: int, degree: int) -> None:
    even, odd = (synthesize(Problem(B=1.859, order=order, basis=Chebyshev(n))) for n in (degree, degree - 1))
    assert even.objective == pytest.approx(odd.objective, rel=1e-13)
    assert even.z is not None
    assert odd.z is not None
    assert even.z[-1] == 0.0
    assert even.z[:-1] == pytest.approx(odd.z, rel=1e-10, abs=1e-10)
    assert even.certificate.problem.basis == Chebyshev(degree)
    assert even.gap <= 1e-8


@pytest.mark.sample(2)
@pytest.mark.parametrize("order", range(2, 7))
@pytest.mark.parametrize("B", [1.53, 1.859, 2.4])
def test_degree_41_is_solved_and_proven(order: int, B: float) -> None:
    check_solution(synthesize(Problem(B=B, order=order, basis=Chebyshev(41))))


@pytest.mark.parametrize("order", range(1, 7))
@pytest.mark.parametrize("kind", [Powers, Chebyshev])
def test_degree_1_leaves_one_law(order: int, kind: Callable[[int], PolynomialBasis]) -> None:
    # Z = z (k - 1/2): b(1/2) = B(S_l) + (-1/4)^l z
    base = smoothstep(order).peak(1).value
    B = base * 1.02
    solution = synthesize(Problem(B=B, order=order, basis=kind(1)))
    z = (B - base) * (-4.0) ** order
    law = law_from_z(BoundaryConditions.rest(order), [-z / 2, z])
    assert solution.law.c(K) == pytest.approx(law.c(K), abs=1e-11 * solution.objective)
    assert z_powers_of(solution) == pytest.approx((-z / 2, z), rel=1e-10)
    assert solution.gap <= 1e-8


def test_the_velocity_of_s_l_itself_is_met_with_z_as_small_as_it_can_be() -> None:
    # with one coefficient and B of S_4, nothing is left but S_4
    solution = synthesize(Problem(B=2.1875, order=4, basis=Powers(1)))
    assert z_of(solution) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert solution.objective == pytest.approx(smoothstep(4).peak(2).value, rel=1e-12)
