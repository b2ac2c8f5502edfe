"""Optima without isolated contacts: where the jerk is constant every k is one, and the bound must meet the law."""

from dataclasses import replace

import pytest

from optlaws import BoundaryConditions, Chebyshev, Problem, at_most, synthesize
from tests.internals.synthesis import first_points, model_of, vertex_on_points
from tests.internals.verification import prove
from tests.synthesis.judge import judge

pytestmark = pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")


@pytest.mark.sample(2)
@pytest.mark.parametrize("B", [1.05, 1.2, 1.5, 2.0, 2.5])
@pytest.mark.parametrize("symmetric", [True, False], ids=["symmetric", "unsymmetric"])
def test_with_free_end_velocities_the_least_jerk_is_that_of_a_parabola(B: float, symmetric: bool) -> None:  # noqa: FBT001
    # b = B - 12 (B-1) (k - 1/2)² has the mean 1
    solution = synthesize(Problem(B=B, order=1, minimise="J", symmetric=symmetric))
    judge(solution)
    assert solution.objective == pytest.approx(24 * (B - 1), rel=1e-11)
    assert solution.status.value == "optimal"
    assert solution.certificate.bound == pytest.approx(24 * (B - 1), rel=1e-11)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("start", "end"), [(0.5, -0.25), (0.228, -0.358), (0.0, 0.0), (-0.3, 0.7)])
@pytest.mark.parametrize("degree", [7, 14])
def test_between_given_velocities_the_least_jerk_is_constant(start: float, end: float, degree: int) -> None:
    ends = BoundaryConditions((0, start), (1, end))
    solution = synthesize(Problem(boundary=ends, symmetric=False, basis=Chebyshev(degree), minimise="J"))
    judge(solution)
    # b is a parabola with the mean 1
    assert solution.objective == pytest.approx(12 * (1 - (start + end) / 2), rel=1e-11)


@pytest.mark.sample(3)
@pytest.mark.parametrize("degree", [9, 15, 41])
@pytest.mark.parametrize("B", [None, 1.5, at_most(1.8)], ids=repr)
def test_a_degree_however_high_leaves_the_proof_sharp(degree: int, B: object) -> None:
    solution = synthesize(Problem(B=B, order=2, basis=Chebyshev(degree), minimise="J"))  # type: ignore[arg-type]
    assert solution.objective == pytest.approx(12.0, rel=1e-12)
    assert solution.gap <= 1e-12


def test_the_proof_of_a_flat_optimum_holds_in_exact_arithmetic() -> None:
    solution = synthesize(Problem(order=2, minimise="J"))
    value = prove(solution.certificate).value
    assert value is not None
    assert float(value) == pytest.approx(12.0, rel=1e-12)


@pytest.mark.parametrize("minimise", ["J/32 + rms_c", "max(J/32, rms_c/3.5)"])
@pytest.mark.parametrize("symmetric", [True, False], ids=["symmetric", "unsymmetric"])
def test_flat_and_with_an_rms(minimise: str, symmetric: bool) -> None:  # noqa: FBT001
    solution = synthesize(Problem(order=2, minimise=minimise, symmetric=symmetric))
    judge(solution)
    # the law 3k² - 2k³ has both the least J and the least RMS
    one, other = 12 / 32, 12**0.5
    assert solution.objective == pytest.approx(one + other if "+" in minimise else max(one, other / 3.5), rel=1e-10)


def test_newton_does_not_take_standing_still_for_an_optimum() -> None:
    # x is right at once, for it is that of constant jerk, but a few multipliers cannot balance there
    ends = BoundaryConditions((0, 0.5), (1, -0.25))
    solution = synthesize(Problem(boundary=ends, symmetric=False, basis=Chebyshev(7), minimise="J"))
    assert solution.gap <= 1e-12
    assert solution.iterations < 30


@pytest.mark.long
def test_where_an_interior_point_hides_the_optimum_a_vertex_shows_it() -> None:
    # just after k = 0 the velocity comes near 0: the rest of the law hardly matters, and multipliers differ by 1e9
    ends = BoundaryConditions(start=(0.0, 0.016, -2.896), end=(1.0, 0.284, 2.906))
    given = {"minimise": "max(C/4, J/32)", "monotone": True, "symmetric": False, "boundary": ends}
    solution = synthesize(Problem(B=at_most(2.1356), basis=Chebyshev(15), **given))  # type: ignore[arg-type]
    judge(solution)
    assert solution.status.value == "optimal"


def test_a_program_without_vertices_has_no_answer() -> None:
    # the objective has no bound
    program = model_of(Problem(order=2, minimise="J")).program
    families = tuple(replace(family, bound=1e9) for family in program.families)
    upward = replace(program, families=families, objective=-program.objective)
    assert vertex_on_points(upward, first_points(upward)) is None
