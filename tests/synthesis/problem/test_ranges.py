"""Fixed, bounded and free constants: what is asked holds, what is not asked costs nothing, and peaks can be held up."""

from math import inf, nan
from typing import Any

import pytest

from optlaws import (
    Certificate,
    Chebyshev,
    InfeasibleProblem,
    InputError,
    Problem,
    Range,
    SolverFailure,
    at_least,
    at_most,
    between,
    synthesize,
)
from tests.synthesis.judge import Judged, judge

pytestmark = pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")


def problem(**given: Any) -> Problem:
    chosen: dict[str, Any] = {"order": 4, "basis": Chebyshev(9), **given}
    return Problem(**chosen)


# --- ranges are values ---


@pytest.mark.parametrize("one", [between(1.5, 1.8), at_most(60), at_least(1.5), Range(2.0, 2.0), Range()])
def test_a_range_prints_as_what_makes_it(one: Range) -> None:
    names = {"between": between, "at_most": at_most, "at_least": at_least}
    assert eval(repr(one), names) == one  # noqa: S307
    assert hash(eval(repr(one), names)) == hash(one)  # noqa: S307


@pytest.mark.parametrize("given", [between(1.5, 1.8), (1.5, 1.8), [1.5, 1.8]])
def test_a_pair_is_a_range(given: Any) -> None:
    assert problem(B=given) == problem(B=between(1.5, 1.8))


def test_a_range_of_one_value_is_that_value() -> None:
    assert problem(B=between(1.7, 1.7)) == problem(B=1.7)
    assert problem(B=1.7, C=(5.0, 5.0)) == problem(B=1.7, C=5.0)


@pytest.mark.parametrize(
    "wrong", [(2, 1), (nan, 1), (1, nan), (-1, 1), (inf, inf), ("1", 2), (None, 2), (True, 2), (1j, 2)]
)
def test_a_range_that_makes_no_sense_is_refused(wrong: tuple[Any, Any]) -> None:
    with pytest.raises(InputError):
        between(*wrong)


# --- a bound that does not bind changes nothing; one that does is met ---


@pytest.mark.sample(2)
@pytest.mark.parametrize("minimise", ["C", "J", "rms_c", "snap"])
def test_a_range_of_b_is_no_worse_than_any_b_in_it(minimise: str) -> None:
    best = synthesize(problem(minimise=minimise, B=between(1.6, 1.8), inflexion=0.5))
    judge(best)
    assert synthesize(problem(minimise=minimise, B=between(1.6, 1.8))).objective <= best.objective * (1 + 1e-11)
    for B in (1.6, 1.65, 1.7, 1.75, 1.8):
        assert best.objective <= synthesize(problem(minimise=minimise, B=B)).objective * (1 + 1e-11)
    B = Judged(best.law).constant("B")
    assert 1.6 * (1 - 1e-10) <= B <= 1.8 * (1 + 1e-10)
    assert synthesize(problem(minimise=minimise, B=min(max(B, 1.6), 1.8))).objective == pytest.approx(
        best.objective, rel=1e-9
    )


@pytest.mark.sample(6)
@pytest.mark.parametrize(("name", "other"), [("C", "J"), ("J", "C"), ("C", "rms_c"), ("J", "rms_j"), ("C", "snap")])
def test_a_tight_bound_binds_and_the_price_falls_with_it(name: str, other: str) -> None:
    least = synthesize(problem(minimise=name, B=1.8)).objective
    at_the_other = Judged(synthesize(problem(minimise=other, B=1.8)).law)
    worths = []
    for share in (0.05, 0.3, 0.7, 1.0):
        bound = least + share * (at_the_other.constant(name) - least)
        solution = synthesize(problem(minimise=other, B=1.8, **{name: at_most(bound)}))
        judge(solution)
        assert solution.status.value == "optimal"
        assert Judged(solution.law).constant(name) == pytest.approx(bound, rel=1e-8)
        worths.append(solution.objective)
    assert worths == sorted(worths, reverse=True)
    assert worths[-1] == pytest.approx(at_the_other.constant(other), rel=1e-9)


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", ["C", "J"])
def test_a_bound_below_the_least_is_infeasible_with_proof_and_one_above_is_not(name: str) -> None:
    least = synthesize(problem(minimise=name, B=1.8)).objective
    with pytest.raises(InfeasibleProblem) as caught:
        synthesize(problem(minimise="rms_c", B=1.8, **{name: at_most(least * (1 - 1e-4))}))
    assert isinstance(caught.value.proof, Certificate)
    assert caught.value.proof.proves_infeasible
    judge(synthesize(problem(minimise="rms_c", B=1.8, **{name: at_most(least * (1 + 1e-4))})))


def test_a_bound_on_d_is_kept() -> None:
    free = synthesize(problem(B=1.7))
    least = synthesize(problem(B=1.7, minimise="D"))
    worths = []
    for share in (0.02, 0.3, 0.7):
        bound = least.objective + share * (free.constants.D.value - least.objective)
        solution = synthesize(problem(B=1.7, D=at_most(bound)))
        judge(solution)
        assert solution.constants.D.value == pytest.approx(bound, rel=1e-8)
        worths.append(solution.objective)
    assert worths == sorted(worths, reverse=True)
    assert free.objective <= worths[-1]


# --- lower bounds on peaks: not convex, but the constant has its value ---


@pytest.mark.sample(15)
@pytest.mark.parametrize("symmetric", [True, False], ids=["symmetric", "unsymmetric"])
@pytest.mark.parametrize(
    ("given", "name", "value"),
    [
        ({"minimise": "J", "C": 7.0}, "C", 7.0),
        ({"minimise": "J", "B": 1.8, "C": 6.5}, "C", 6.5),
        ({"minimise": "C", "J": 100.0}, "J", 100.0),
        ({"minimise": "C", "B": 1.7, "J": 80.0}, "J", 80.0),
        ({"minimise": "rms_c", "B": 1.7, "J": 90.0}, "J", 90.0),
        ({"minimise": "C", "B": 1.7, "D": 5.0}, "D", 5.0),
        ({"minimise": "C", "B": 1.7, "D": 7.0}, "D", 7.0),
        ({"minimise": "J", "B": 1.7, "D": 6.0, "order": 3}, "D", 6.0),
        ({"minimise": "J", "C": at_least(7.0)}, "C", 7.0),
        ({"minimise": "C", "C": 7.0}, "C", 7.0),
        ({"minimise": "J", "B": 1.7, "J": at_least(100.0)}, "J", 100.0),
        ({"minimise": "D", "B": 1.6, "D": at_least(6.0)}, "D", 6.0),
        ({"minimise": "C", "J": between(100.0, 120.0)}, "J", 100.0),
    ],
)
def test_a_constant_that_is_given_has_its_value(
    given: dict[str, Any],
    name: str,
    value: float,
    symmetric: bool,  # noqa: FBT001
) -> None:
    asked = problem(**given, symmetric=symmetric)
    solution = synthesize(asked)
    judge(solution)
    found = Judged(solution.law).constant(name)
    free = synthesize(problem(**{**given, name: None}, symmetric=symmetric))
    own = Judged(free.law).constant(name)
    if own < value:
        assert found == pytest.approx(value, rel=1e-9)
    else:
        assert found == pytest.approx(min(max(own, value), asked.range(name).high), rel=1e-9)  # type: ignore[union-attr]
    assert solution.objective >= free.lower_bound * (1 - 1e-11)
    assert solution.lower_bound <= solution.objective * (1 + 1e-12)


def test_a_value_that_no_law_can_have_is_said_so() -> None:
    # with one coefficient nothing is left to give C a value
    asked = problem(B=1.9, C=30.0, basis=Chebyshev(1), minimise="C")
    with pytest.raises((InfeasibleProblem, SolverFailure)):
        synthesize(asked)
