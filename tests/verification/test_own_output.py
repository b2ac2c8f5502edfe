"""What `synthesize` calls optimal, `verify` proves: random problems of every kind, and kinds once refused."""

import json
from dataclasses import replace
from functools import cache

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from optlaws import BoundaryConditions, Chebyshev, Pieces, Problem, Solution, at_least, synthesize
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.verification import exact_bound, verify
from tests.synthesis.random_general import random_problems
from tests.synthesis.random_options import every_option

pytest.importorskip("flint")
pytestmark = pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")


def moving(start: tuple[float, ...], end: tuple[float, ...], minimise: str = "C") -> Problem:
    return Problem(boundary=BoundaryConditions(start, end), minimise=minimise, symmetric=False, basis=Chebyshev(5))


ONCE_REFUSED = {
    "zero": moving((0, 1, 0), (1, 1, 0)),
    "zero jounce": moving((0, -0.467), (1, 0.003), "jounce"),
    "one-sided": moving((0, 2), (1, 0), "max(C_plus, 0.1*C_minus)"),
    "below zero": moving((0, 2, -1), (1, 0, -1), "C_plus"),
    "one-sided peaks in a sum": moving((0, 1, 0), (1, 0, 0), "C_plus + 0.2*C_minus + 0.1*rms_c"),
    "power from below": Problem(order=3, B=1.9, minimise="rms_c", basis=Chebyshev(9), D=at_least(4.0)),
    "rounded breaks": Problem(
        order=3, B=1.7, basis=Pieces([0, 0.1, 0.43, 0.5, 0.5699999999999994, 0.9000000000000005, 1], 5, 2)
    ),
}


def unproven(problem: Problem) -> list[str] | None:
    """Claims of an optimal law that are not proven; None if there is no optimal law."""
    try:
        solution = synthesize(problem)
    except (InfeasibleProblem, SolverFailure):
        return None
    if solution.status.value != "optimal":
        return None
    found = verify(json.loads(json.dumps(solution.to_dict(), allow_nan=False)))
    return [str(claim) for claim in found.claims if not claim.proven]


@pytest.mark.parametrize("name", ONCE_REFUSED)
def test_what_was_refused_is_proven(name: str) -> None:
    assert unproven(ONCE_REFUSED[name]) == []


def test_random_optima_are_proven() -> None:
    left = {repr(problem): unproven(problem) for problem in random_problems(2026, 60)}
    assert {name: claims for name, claims in left.items() if claims} == {}
    assert sum(claims is not None for claims in left.values()) > 25


@pytest.mark.long
@pytest.mark.parametrize("seed", range(8))
def test_more_random_optima_are_proven(seed: int) -> None:
    left = {repr(problem): unproven(problem) for problem in random_problems(seed, 100)}
    assert {name: claims for name, claims in left.items() if claims} == {}


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_random_optima_of_every_option_are_proven_or_refused_by_name(seed: int) -> None:
    left = {}
    for one in every_option(seed, 40):
        text = repr(one.problem)
        try:
            left[text] = unproven(one.problem)
        except InputError as error:
            # constants of cams and residuals have no exact rows
            assert "as optlaws defines them" in str(error)  # noqa: PT017 - most are proven
            assert "cam" in text or "residual" in text
    assert {name: claims for name, claims in left.items() if claims} == {}


@settings(max_examples=60)
@given(st.sampled_from(["one-sided", "below zero", "one-sided peaks in a sum", "power from below"]), st.data())
def test_no_bound_of_constants_that_may_be_negative_exceeds_the_optimum(name: str, drawn: st.DataObject) -> None:
    solution = solved(name)
    factors = st.floats(0.0, 3.0) | st.sampled_from([1.0, 1.0 + 1e-6, 1.0 - 1e-9])
    contacts = tuple(
        replace(one, multiplier=one.multiplier * drawn.draw(factors)) for one in solution.certificate.contacts
    )
    bound = exact_bound(replace(solution.certificate, contacts=contacts))
    assert bound is None or bound <= solution.objective + 1e-12 * max(1.0, abs(solution.objective))


@cache
def solved(name: str) -> Solution:
    return synthesize(ONCE_REFUSED[name])
