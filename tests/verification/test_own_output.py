"""What `synthesize` calls optimal, `verify` proves: random problems of every kind, and kinds once refused."""

import json
from dataclasses import replace
from functools import cache

import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    InfeasibleProblem,
    Pieces,
    Problem,
    Solution,
    SolverFailure,
    at_least,
    at_most,
    cam_constant,
    synthesize,
)
from optlaws.verification import exact_bound, verify
from tests.sampling import examples
from tests.synthesis.random_general import random_problems
from tests.synthesis.random_options import every_option

pytestmark = pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")


def moving(start: tuple[float, ...], end: tuple[float, ...], minimise: str = "C") -> Problem:
    return Problem(boundary=BoundaryConditions(start, end), minimise=minimise, symmetric=False, basis=Chebyshev(5))


ONCE_REFUSED = {
    "zero": moving((0, 1, 0), (1, 1, 0)),
    "zero snap": moving((0, -0.467), (1, 0.003), "snap"),
    "zero maximum": Problem(order=1, minimise="max(0.00038*rms_snap, 9.8e-05*snap)", monotone=True, basis=Chebyshev(8)),
    "one-sided": moving((0, 2), (1, 0), "max(C_plus, 0.1*C_minus)"),
    "below zero": moving((0, 2, -1), (1, 0, -1), "C_plus"),
    "one-sided peaks in a sum": moving((0, 1, 0), (1, 0, 0), "C_plus + 0.2*C_minus + 0.1*rms_c"),
    "power from below": Problem(order=3, B=1.9, minimise="rms_c", basis=Chebyshev(9), D=at_least(4.0)),
    "rounded breaks": Problem(
        order=3, B=1.7, basis=Pieces([0, 0.1, 0.43, 0.5, 0.5699999999999994, 0.9000000000000005, 1], 5, 2)
    ),
}

OF_CAMS = {
    "acceleration": Problem(order=4, minimise=cam_constant("C", frequency=20), basis=Chebyshev(7)),
    "damped": Problem(order=4, minimise=cam_constant("C", frequency=20, damping=0.1), basis=Chebyshev(7)),
    "one-sided": Problem(
        order=4, minimise=cam_constant("C_plus", frequency=15, damping=0.1), symmetric=False, basis=Chebyshev(6)
    ),
    "pieces": Problem(order=4, minimise=cam_constant("C_minus", frequency=20, damping=0.1), basis=Pieces(4, 6, 3)),
    "sum": Problem(order=5, minimise="0.5*C + 0.1*J_cam(frequency=12, damping=0.05)", basis=Chebyshev(7)),
    "bounded": Problem(order=4, minimise="C", bounds={"C_cam(frequency=10)": at_most(7.0)}, basis=Chebyshev(9)),
    "velocity": Problem(order=4, minimise="C", bounds={"B_cam(frequency=9)": at_most(1.7)}, basis=Chebyshev(9)),
    "power": Problem(order=4, minimise=cam_constant("D", frequency=20, damping=0.1), basis=Chebyshev(7)),
    "power, not symmetric": Problem(
        order=4, minimise=cam_constant("D", frequency=20, damping=0.1), symmetric=False, basis=Chebyshev(4)
    ),
    "both powers": Problem(order=4, minimise="D + D_cam(frequency=20)", basis=Chebyshev(7)),
}

RESIDUALS = {
    "one frequency": Problem(order=4, minimise="residual(frequency=18) + 0.1*C", C=at_most(7), basis=Chebyshev(7)),
    "nothing left": Problem(order=4, minimise="residual(frequency=18)", C=at_most(7), basis=Chebyshev(7)),
    "interval": Problem(
        order=4, minimise="residual(frequency=(9, 12), damping=0.03)", B=1.8, C=at_most(7), basis=Chebyshev(7)
    ),
    "bounded": Problem(
        order=4, minimise="C", bounds={"residual(frequency=(18, 22))": at_most(0.5)}, basis=Chebyshev(9)
    ),
    "with a design": Problem(
        order=4,
        minimise="C",
        symmetric=False,
        bounds={"residual(frequency=(18, 22), damping=0.02, design=20)": at_most(0.5)},
        basis=Pieces(4, 6, 3),
    ),
    "symmetric pieces": Problem(order=4, minimise="0.2*C + residual(frequency=(12, 14))", basis=Pieces(4, 6, 3)),
}


def unproven(problem: Problem, status: str = "optimal") -> list[str] | None:
    """Claims of an optimal law, or of one with this status, that are not proven; None if there is no such law."""
    try:
        solution = synthesize(problem)
    except (InfeasibleProblem, SolverFailure):
        return None
    if solution.status.value not in {"optimal", status}:
        return None
    verification = verify(json.loads(json.dumps(solution.to_dict(), allow_nan=False)))
    return [str(claim) for claim in verification.claims if not claim.proven]


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ONCE_REFUSED)
def test_what_was_refused_is_proven(name: str) -> None:
    assert unproven(ONCE_REFUSED[name]) == []


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", OF_CAMS)
def test_constants_of_cams_are_proven(name: str) -> None:
    assert unproven(OF_CAMS[name], "local" if "power" in name else "optimal") == []


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", RESIDUALS)
def test_residuals_are_proven(name: str) -> None:
    assert unproven(RESIDUALS[name]) == []


def test_random_optima_are_proven() -> None:
    left = {repr(problem): unproven(problem) for problem in random_problems(2026, 12)}
    assert {name: claims for name, claims in left.items() if claims} == {}
    assert sum(claims is not None for claims in left.values()) > 4


@pytest.mark.long
@pytest.mark.parametrize("seed", range(8))
def test_more_random_optima_are_proven(seed: int) -> None:
    left = {repr(problem): unproven(problem) for problem in random_problems(seed, 100)}
    assert {name: claims for name, claims in left.items() if claims} == {}


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_random_optima_of_every_option_are_proven(seed: int) -> None:
    left = {repr(one.problem): unproven(one.problem) for one in every_option(seed, 40)}
    assert {name: claims for name, claims in left.items() if claims} == {}


@examples(60)
@given(st.sampled_from(["one-sided", "below zero", "one-sided peaks in a sum", "power from below"]), st.data())
def test_no_bound_of_constants_that_may_be_negative_exceeds_the_optimum(name: str, drawn: st.DataObject) -> None:
    solution = solved(name)
    factors = st.floats(0.0, 3.0) | st.sampled_from([1.0, 1.0 + 1e-6, 1.0 - 1e-9])
    contacts = tuple(
        replace(contact, multiplier=contact.multiplier * drawn.draw(factors))
        for contact in solution.certificate.contacts
    )
    bound = exact_bound(solution.certificate.with_leaf(contacts=contacts))
    assert bound is None or bound <= solution.objective + 1e-12 * max(1.0, abs(solution.objective))


@cache
def solved(name: str) -> Solution:
    return synthesize(ONCE_REFUSED[name])
