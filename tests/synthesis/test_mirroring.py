"""Where a law and its mirror image are as good, the best symmetric law is an optimum among all, with a proof of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import BSplines, Chebyshev, Pieces, Problem, at_most, between, synthesize
from optlaws.verification import verify
from tests.synthesis.judge import judge

SHAPES = [(1.859, 4, 3), (1.641, 4, 9), (2.3, 2, 7), (1.9, 6, 15), (2.7, 3, 15), (1.5, 1, 5), (1.859, 5, 11)]
#: b stays at B about the middle: undivided, b <= B is ill posed there
FLAT_TOPS = [(1.2, 3, 9), (1.5, 3, 9), (1.641, 4, 9), (1.53, 5, 13), (1.4, 2, 15), (1.9, 6, 15), (2.3, 2, 9)]
EVEN = ["C", "J", "rms_c", "rms_j", "snap", "max(C/4, J/32)", "C/8 + J/64"]
RANGES = (None, 1.6, 1.641, 2.3, at_most(1.6), at_most(1.75), between(1.5, 1.6))
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
    *({"B": B, "order": order, "basis": Chebyshev(degree)} for B, order, degree in SHAPES),
    *(
        {"B": B, "order": order, "basis": Chebyshev(degree), "minimise": minimise}
        for B, order, degree in FLAT_TOPS
        for minimise in ("C", "J")
    ),
    *({"B": B, "order": 4, "minimise": minimise} for B in RANGES for minimise in EVEN),
    *({"order": order, "minimise": minimise} for order in (2, 3, 5) for minimise in EVEN),
]


@pytest.mark.sample(6)
@pytest.mark.parametrize("kind", KINDS, ids=str)
def test_no_unsymmetric_law_is_better_than_the_best_symmetric_one(kind: dict[str, Any]) -> None:
    problem = Problem(**{"order": 3, "basis": Chebyshev(9), **kind}, symmetric=False)
    solution, even = synthesize(problem), synthesize(replace(problem, symmetric=True))
    assert solution.problem == problem
    assert (solution.status, even.status) == ("optimal", "optimal")
    assert solution.objective == pytest.approx(even.objective, rel=1e-10)
    assert solution.lower_bound == pytest.approx(even.lower_bound, rel=1e-9)
    for each in (solution, even):
        judge(each)
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
