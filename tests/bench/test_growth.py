"""What the section on greatest sizes promises: the greatest degrees, pieces and segments have laws and proofs."""

import numpy as np
import pytest

from optlaws import Chebyshev, Cycle, InputError, Pieces, Problem, Solution, synthesize
from optlaws.verification import verify
from tests.bench.growth import free_motions, moves

GAP = 1e-8


def is_proven(solution: Solution) -> bool:
    """Whether the status is optimal and the gap is what that means."""
    return solution.status.value == "optimal" and solution.gap <= GAP


def test_a_hundred_free_motions_are_proven() -> None:
    (solution,) = free_motions(100, minimise="rms jerk").solutions
    assert is_proven(solution)


def test_a_dozen_free_motions_are_proven_exactly() -> None:
    (solution,) = free_motions(12, minimise="rms jerk").solutions
    proven = verify(solution.certificate.to_dict()).bound
    assert proven is not None
    # the objective is rounded, the bound is exact
    assert solution.lower_bound <= float(proven) <= solution.objective * (1.0 + 1e-13)


def test_more_free_motions_than_one_law_has_pieces_for_are_refused() -> None:
    with pytest.raises(InputError, match=r"399 motions .* one law, of at most 1000 pieces: put a dwell"):
        free_motions(400).status  # noqa: B018 - laws are looked for where they are needed


@pytest.mark.long
@pytest.mark.parametrize("order", [3, 4])
def test_degree_200(order: int) -> None:
    solution = synthesize(Problem(B=1.641, order=order, basis=Chebyshev(200), monotone=True))
    assert is_proven(solution)
    k = np.linspace(0.0, 1.0, 100_001)
    for nu, peak in enumerate((solution.law.constants.B, solution.law.constants.C), 1):
        seen = float(np.abs(solution.law(k, nu)).max())
        assert seen <= peak.value * (1.0 + 1e-12)
        assert seen == pytest.approx(peak.value, rel=1e-6)
    assert solution.law.constants.C.value == solution.objective
    assert float(solution.law(k, 1).min()) >= -1e-12
    assert [float(solution.law(end, nu)) for end in (0.0, 1.0) for nu in range(order)] == pytest.approx(
        [0.0] * order + [1.0] + [0.0] * (order - 1), abs=1e-7
    )


@pytest.mark.long
@pytest.mark.parametrize("minimise", ["C", "J", "rms_c"])
def test_200_pieces(minimise: str) -> None:
    assert is_proven(synthesize(Problem(order=3, B=1.8, basis=Pieces(200), minimise=minimise)))


@pytest.mark.long
@pytest.mark.parametrize(
    "whole",
    [
        moves(200, limits={"velocity": "1.6 m/s"}),
        free_motions(200),
        free_motions(200, minimise="rms acceleration"),
        free_motions(200, minimise="rms jerk"),
        free_motions(200, limits={"velocity": "2 m/s"}),
    ],
    ids=["moves", "acceleration", "rms acceleration", "rms jerk", "velocity limit"],
)
def test_200_segments(whole: Cycle) -> None:
    assert all(map(is_proven, whole.solutions))
    assert whole.status.value == "optimal"
    joints = np.array([joint["velocity"] for joint in whole.joints])
    assert np.abs(joints).max() < 1e-9
