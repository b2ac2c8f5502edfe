"""Random problems of every kind: each is solved and judged, or refused with a proof where HiGHS finds no law either."""

import re

import pytest

from optlaws import Certificate, Chebyshev, InfeasibleProblem, Problem, synthesize
from tests.sampling import sampled
from tests.synthesis.count_statuses import outcome
from tests.synthesis.independent import check_solution, polynomial
from tests.synthesis.random_options import every_option
from tests.synthesis.reference import least

pytestmark = pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")
SCARCE = [
    Problem(B=B, order=order, basis=Chebyshev(degree), monotone=monotone)
    for B, order, degree, monotone in [
        (1.12, 4, 3, False),
        (1.53, 4, 1, False),
        (1.15, 6, 5, False),
        (1.3, 5, 3, True),
        (2.9, 2, 3, True),
        (3.0, 3, 3, True),
        (1.2, 6, 7, True),
        (1.1, 2, 3, False),
    ]
]


@pytest.mark.parametrize(("seed", "allowed"), sampled([(7, 0), *((seed, 1) for seed in range(8, 37))], 30))
def test_random_problems_are_solved_and_judged(seed: int, allowed: int) -> None:
    """A judge in doubles may take rounding of a constant that nearly vanishes for a wrong value, seldom."""
    outcomes = [outcome(one) for one in every_option(seed, 10)]
    troubled = [(one.status, one.why) for one in outcomes if one.trouble]
    assert len(troubled) <= allowed, troubled
    assert sum(one.status in {"optimal", "local"} for one in outcomes) > 5  # the infeasible are no way out


def shape(problem: Problem) -> str:
    kind = "monotone" if problem.monotone else "free"
    return f"l{problem.order}-n{polynomial(problem).degree}-B{problem.B:g}-{kind}"


@pytest.mark.parametrize("problem", sampled(SCARCE, 4), ids=shape)
def test_highs_finds_the_same_optimum_among_all_laws_of_eq_8(problem: Problem) -> None:
    independent = least(problem, of_unsymmetric_laws=True)
    if independent is None:
        with pytest.raises(InfeasibleProblem) as refused:
            synthesize(problem)
        assert refused.value.problem is problem
        assert isinstance(refused.value.proof, Certificate)
        assert refused.value.proof.proves_infeasible
        assert refused.value.proof.problem == problem
        return
    solution = synthesize(problem)
    check_solution(solution)
    assert solution.objective == pytest.approx(independent, rel=1e-8)
    assert solution.lower_bound <= independent * (1 + 1e-8)


def test_an_infeasible_problem_names_itself_and_can_be_run_again() -> None:
    with pytest.raises(InfeasibleProblem, match=re.escape("b(1/2) = B = 1.53")) as caught:
        synthesize(SCARCE[1])
    printed = str(caught.value).rpartition("problem: ")[2]
    assert eval(printed, {"Problem": Problem, "Chebyshev": Chebyshev}) == SCARCE[1]  # noqa: S307
    assert "degree" in str(caught.value)
