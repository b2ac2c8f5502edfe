"""Bounds of any constant and a given inflexion, verified exactly; what is changed afterwards is found out."""

from typing import Any

import pytest

from optlaws import Chebyshev, Problem, at_most, synthesize
from optlaws.verification import verify

CASES: list[dict[str, Any]] = [
    {"B": 1.8, "symmetric": False, "inflexion": 0.4},
    {"symmetric": False, "inflexion": 0.4, "minimise": "max(C_plus, C_minus/2)"},
    {"B": 1.8, "bounds": {"rms_c": at_most(3.82)}},
    {"B": 1.8, "bounds": {"snap": at_most(900)}},
    {"symmetric": False, "bounds": {"C_minus": at_most(4)}, "minimise": "C_plus"},
]


@pytest.mark.parametrize("given", CASES, ids=str)
def test_optima_are_proven(given: dict[str, Any]) -> None:
    verification = verify(synthesize(Problem(order=4, basis=Chebyshev(9), **given)).to_dict())
    assert verification.proven
    assert verification.gap is not None
    assert abs(verification.gap) < 1e-11


def test_a_tighter_bound_than_the_law_keeps_is_found_out() -> None:
    data = synthesize(Problem(order=4, B=1.8, bounds={"rms_c": at_most(3.82)})).to_dict()
    for part in (data, data["certificate"]):
        part["problem"]["bounds"] = {"rms_c": [0.0, 3.81]}
    assert "rms_c at most" in {claim.name for claim in verify(data).claims if not claim.proven}


def test_another_inflexion_is_found_out() -> None:
    data = synthesize(Problem(order=4, B=1.8, symmetric=False, inflexion=0.4)).to_dict()
    for part in (data, data["certificate"]):
        part["problem"]["inflexion"] = 0.41
    wrong = {claim.name for claim in verify(data).claims if not claim.proven}
    assert {"b <= b(0.41)", "c(0.41) = 0"} <= wrong
