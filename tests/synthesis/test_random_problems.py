"""Random problems: each is solved and proven, or shown to have no solution; HiGHS agrees."""

import re

import pytest

from optlaws import Certificate, Chebyshev, InfeasibleProblem, Problem, synthesize
from tests.sampling import sampled
from tests.synthesis.independent import check_solution, polynomial, random_problems
from tests.synthesis.reference import least

PROBLEMS = random_problems(2, 200)
SCARCE = [
    Problem(B=B, order=order, basis=Chebyshev(degree), monotone=monotone)
    for B, order, degree, monotone in [
        (1.12, 4, 3, False),
        (1.15, 6, 5, False),
        (1.3, 5, 3, True),
        (1.53, 4, 1, False),
        (2.9, 2, 3, True),
        (3.0, 3, 3, True),
        (1.2, 6, 7, True),
        (1.1, 2, 3, False),
    ]
]


def shape(problem: Problem) -> str:
    kind = "monotone" if problem.monotone else "free"
    return f"l{problem.order}-n{polynomial(problem).degree}-B{problem.B:g}-{kind}"


def refused(error: InfeasibleProblem, problem: Problem) -> bool:
    proof = error.proof
    assert isinstance(proof, Certificate)
    assert error.problem is problem
    assert proof.proves_infeasible
    assert proof.problem == problem
    return False


def solved(problem: Problem) -> bool:
    try:
        solution = synthesize(problem)
    except InfeasibleProblem as error:
        return refused(error, problem)
    check_solution(solution)
    return True


@pytest.mark.sample(2)
@pytest.mark.parametrize("first", sampled(range(0, 200, 25), 4))
def test_200_random_problems_are_each_solved_or_shown_to_be_infeasible(first: int) -> None:
    outcomes = [solved(problem) for problem in PROBLEMS[first : first + 25]]
    assert sum(outcomes) >= 20  # most have a solution: the infeasible are no way out


@pytest.mark.long
@pytest.mark.parametrize("seed", range(15))
def test_1500_random_problems_of_high_degree(seed: int) -> None:
    outcomes = [solved(problem) for problem in random_problems(100 + seed, 100, (3, 61))]
    assert sum(outcomes) >= 85


@pytest.mark.parametrize("problem", sampled([*SCARCE, *PROBLEMS], 60), ids=shape)
def test_highs_finds_the_same_optimum_among_all_laws_of_eq_8(problem: Problem) -> None:
    independent = least(problem, of_unsymmetric_laws=True)
    try:
        solution = synthesize(problem)
    except InfeasibleProblem:
        assert independent is None
        return
    assert independent is not None
    assert solution.objective == pytest.approx(independent, rel=1e-8)
    assert solution.lower_bound <= independent * (1 + 1e-8)


@pytest.mark.long
def test_the_scarce_problems_are_both_feasible_and_not() -> None:
    outcomes = [solved(problem) for problem in SCARCE]
    assert set(outcomes) == {True, False}


def test_an_infeasible_problem_names_itself_and_can_be_run_again() -> None:
    problem = Problem(B=1.53, order=4, basis=Chebyshev(1))
    with pytest.raises(InfeasibleProblem, match=re.escape("b(1/2) = B = 1.53")) as caught:
        synthesize(problem)
    printed = str(caught.value).rpartition("problem: ")[2]
    assert eval(printed, {"Problem": Problem, "Chebyshev": Chebyshev}) == problem  # noqa: S307
    assert "degree" in str(caught.value)
