"""Where a law and its mirror image are as good, the best symmetric law is an optimum among all, with a proof of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import BSplines, Chebyshev, Pieces, Problem, at_most, between, synthesize
from optlaws.verification import verify

KINDS: list[dict[str, Any]] = [
    {"B": 1.8},
    {"minimise": "J", "B": at_most(1.7)},
    {"minimise": "J", "B": 2.2},
    {"minimise": "rms_c", "C": at_most(5.2)},
    {"B": 2.4, "monotone": True},
    {"order": 1, "B": 1.6},
    {"minimise": "C + 0.1*snap", "B": 6.0},
    {"minimise": "max(0.25*C, 0.03*J)", "basis": Pieces(6), "B": 1.8},
    {"basis": BSplines(6, 3), "B": between(1.5, 1.7)},
]


@pytest.mark.sample(4)
@pytest.mark.parametrize("kind", KINDS, ids=str)
def test_no_unsymmetric_law_is_better_than_the_best_symmetric_one(kind: dict[str, Any]) -> None:
    problem = Problem(**{"order": 3, "basis": Chebyshev(9), **kind}, symmetric=False)
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.objective == pytest.approx(synthesize(replace(problem, symmetric=True)).objective, rel=1e-10)
    proof = verify(solution.to_dict())
    assert proof.proven, [str(claim) for claim in proof.claims if not claim.proven]


def test_a_problem_on_uneven_pieces_is_answered_by_its_own_proof() -> None:
    first = (0.0, 0.004523395561311, 0.353949185521268, 0.358472581082579)
    breaks = (*first, 0.5, *(1.0 - np.array(first[::-1])).tolist())
    problem = Problem(
        B=at_most(1.5533036736142576),
        order=3,
        basis=Pieces(breaks=breaks, degree=5, continuity=2),
        minimise="max(0.25*C, 0.03125*J)",
        symmetric=False,
    )
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.certificate.problem == problem
    assert verify(solution.to_dict()).proven
