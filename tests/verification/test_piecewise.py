"""Laws of pieces and of Z in splines are proven as polynomials are."""

from fractions import Fraction

import pytest

from optlaws import BSplines, Pieces, Problem, at_most, synthesize, via
from optlaws.verification import exact_bound, verify
from tests.verification.problems import PIECES
from tests.verification.tampering import data_of


def test_a_root_mean_square_that_can_be_0_is_no_sum_of_roundings() -> None:
    """A cubic law keeps all that is asked, and has no snap; the sum of rows that are great said 6e-9."""
    through = (via("c", 1.3, at=0.4),)
    solution = synthesize(
        Problem(B=at_most(2.5), order=1, basis=BSplines(4, 5), minimise="rms_snap", symmetric=False, windows=through)
    )
    assert solution.status == "optimal"
    assert solution.lower_bound == 0.0 <= solution.objective < 1e-8
    assert verify(solution.to_dict()).proven


def test_with_d_the_relaxed_program_bounds_more_than_the_limit() -> None:
    data = data_of(PIECES[11])
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
