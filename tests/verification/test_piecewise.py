"""Laws of pieces and of Z in splines are proven as polynomials are."""

import copy
from collections.abc import Callable
from fractions import Fraction

import pytest

from optlaws import BoundaryConditions, BSplines, Pieces, Problem, Window, at_most, synthesize, via
from optlaws.verification import exact_bound, verify
from tests.verification.tampering import Data, data_of

MOVING = BoundaryConditions((0, 0.3), (1, 0.1))
PROBLEMS = [
    Problem(B=1.75, order=4, basis=Pieces(4)),
    Problem(B=1.75, order=2, basis=Pieces(8, 3, 2)),
    Problem(B=1.75, order=2, basis=Pieces((0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0), 3, 1)),
    Problem(B=1.75, order=3, basis=Pieces(8), minimise="rms_c"),
    Problem(B=1.75, order=3, basis=Pieces(6), minimise="max(C/4, J/40)", monotone=True),
    Problem(B=1.75, order=3, basis=Pieces(5), symmetric=False),
    Problem(B=2.3, order=4, basis=Pieces.around((0.0, 0.3, 0.7, 1.0), 0.02)),
    Problem(B=at_most(1.6), order=4, basis=Pieces(8, 6, 4), bounds={"rms_j": at_most(60)}),
    Problem(order=3, basis=Pieces(6), symmetric=False, windows=(via("a", 0.3, at=0.4),)),
    Problem(order=2, basis=Pieces(6), symmetric=False, inflexion=0.4, B=1.7),
    Problem(order=2, basis=Pieces(4), symmetric=False, boundary=MOVING, minimise="rms_c"),
    Problem(B=1.75, order=3, basis=Pieces(6), minimise="0.5*C/4 + 0.5*D/2.25"),
    Problem(B=1.75, order=4, basis=BSplines(6, 3)),
    Problem(B=1.75, order=4, basis=BSplines(5, 3), symmetric=False, minimise="J"),
    Problem(B=2.5, order=4, basis=BSplines(6, 4, 2), monotone=True),
    Problem(B=1.75, order=3, basis=BSplines((0.0, 0.1, 0.4, 0.6, 0.9, 1.0), 3, 1)),
    Problem(order=3, basis=BSplines(6, 4), windows=(Window("c", -6.0, 2.0, 0.3, 0.6),)),
]
FIRST = PROBLEMS[0]


def test_a_root_mean_square_that_can_be_0_is_no_sum_of_roundings() -> None:
    """A cubic law keeps all that is asked, and has no snap; the sum of rows that are great said 6e-9."""
    through = (via("c", 1.3, at=0.4),)
    solution = synthesize(
        Problem(B=at_most(2.5), order=1, basis=BSplines(4, 5), minimise="rms_snap", symmetric=False, windows=through)
    )
    assert solution.status == "optimal"
    assert solution.lower_bound == 0.0 <= solution.objective < 1e-8
    assert verify(solution.to_dict()).proven


@pytest.mark.sample(5)
@pytest.mark.parametrize("problem", PROBLEMS, ids=repr)
def test_an_optimum_is_proven(problem: Problem) -> None:
    data = data_of(problem)
    verification = verify(data)
    assert verification.proven, str(verification)
    assert verification.bound is not None
    assert verification.objective is not None
    assert verification.gap is not None
    assert verification.bound <= verification.objective[1] * (1.0 + 1e-11)
    assert verification.bound >= data["certificate"]["bound"] * (1.0 - 1e-9)
    if problem.convex:
        assert abs(verification.gap) < 1e-10


def test_with_d_the_relaxed_program_bounds_more_than_the_limit() -> None:
    data = data_of(PROBLEMS[11])
    verification = verify(data)
    assert verification.bound is not None
    assert verification.bound > data["best_possible"] * (1.0 + 1e-3)


@pytest.mark.sample(2)
@pytest.mark.parametrize("basis", [Pieces(6), BSplines(6, 4)], ids=repr)
@pytest.mark.parametrize("symmetric", [True, False])
def test_power_alone_is_bounded_too(basis: Pieces | BSplines, symmetric: bool) -> None:  # noqa: FBT001
    """D >= B² by the relaxation: b(1/2) = B and b² <= 2 D k."""
    solution = synthesize(Problem(B=1.75, order=2, basis=basis, minimise="D", symmetric=symmetric))
    assert solution.certificate.bound >= 1.75**2 * (1.0 - 1e-9)
    exact = exact_bound(solution.certificate)
    assert exact is not None
    assert solution.certificate.bound * (1.0 - 1e-9) <= exact <= Fraction(solution.objective)


def _break(data: Data) -> None:
    data["law"]["breaks"][1] += 1e-9


def _jump(data: Data) -> None:
    data["law"]["segments"][1]["b0"] += 1e-9


def _one_segment(data: Data) -> None:
    data["law"]["segments"][2]["acceleration"][1] += 1e-8


def _other_breaks(data: Data) -> None:
    for one in (data["problem"], data["certificate"]["problem"]):
        one["breaks"][1] -= 0.01
        one["breaks"][3] += 0.01


def _smoother(data: Data) -> None:
    for one in (data["problem"], data["certificate"]["problem"]):
        one["continuity"] = 4


def _lower_degree(data: Data) -> None:
    for one in (data["problem"], data["certificate"]["problem"]):
        one["degree"] = 4


def _fewer_pieces(data: Data) -> None:
    for one in (data["problem"], data["certificate"]["problem"]):
        one["breaks"] = [0.0, 0.5, 1.0]


TAMPER: dict[Callable[[Data], None], str] = {
    _break: "breaks",
    _jump: "continuity of derivative 1",
    _one_segment: "continuity of derivative 2",
    _other_breaks: "breaks",
    _smoother: "continuity of derivative 4",
    _lower_degree: "terms above the degree",
    _fewer_pieces: "4 pieces instead of 2",
}


@pytest.mark.parametrize("change", TAMPER, ids=lambda one: one.__name__)
def test_a_law_of_another_shape_fails(change: Callable[[Data], None]) -> None:
    data = copy.deepcopy(data_of(FIRST))
    change(data)
    verification = verify(data)
    assert TAMPER[change] in {claim.name for claim in verification.claims if not claim.proven}
