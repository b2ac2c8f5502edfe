"""End conditions other than rest: velocities, accelerations and more at either end."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    InputError,
    Problem,
    at_most,
    synthesize,
)
from tests.synthesis.judge import broken, judge
from tests.synthesis.reference import least, rms_by_a_linear_system

pytestmark = pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")
ENDS = [
    BoundaryConditions((0, 0.5), (1, -0.25)),
    BoundaryConditions((0, 1), (1, 1)),
    BoundaryConditions((0, 0.5, 1), (1, 0.25, 0)),
    BoundaryConditions((0, 0.2, 3, -10), (1, 0.0, -2, 5)),
    BoundaryConditions((0, 0, 0), (0, 0, 0.5)),
    BoundaryConditions((0, 0, 0), (2, 1, 0)),
    BoundaryConditions((0,), (1,)),
]
every_end = pytest.mark.parametrize("ends", ENDS, ids=lambda b: f"{b.start}-{b.end}")


def problem(ends: BoundaryConditions, **given: Any) -> Problem:
    chosen: dict[str, Any] = {"boundary": ends, "symmetric": False, "basis": Chebyshev(7), **given}
    return Problem(**chosen)


@pytest.mark.sample(12)
@every_end
@pytest.mark.parametrize(
    "given",
    [
        *({"minimise": name} for name in ("C", "J", "rms_c", "rms_j", "C_plus + C_minus", "max(C/4, J/32)")),
        {"B": at_most(2.6)},
        {"B": at_most(2.6), "minimise": "J"},
        {"C": at_most(14.0), "minimise": "J"},
        {"C": at_most(14.0), "minimise": "rms_c"},
    ],
    ids=str,
)
def test_the_optimum_is_that_of_highs_or_clarabel(ends: BoundaryConditions, given: dict[str, Any]) -> None:
    asked = problem(ends, **given)
    solution = synthesize(asked)
    assert broken(asked, solution.law) == []
    if solution.objective < 1e-9:
        return  # uniform motion has no acceleration at all
    judge(solution)
    assert solution.status.value == "optimal"
    assert solution.best_possible is None
    assert solution.objective == pytest.approx(least(asked), rel=3e-8, abs=1e-9)


@every_end
@pytest.mark.parametrize(("name", "nu"), [("rms_c", 2), ("rms_j", 3)])
def test_the_least_rms_between_other_ends_solves_a_linear_system(ends: BoundaryConditions, name: str, nu: int) -> None:
    expected, _ = rms_by_a_linear_system(problem(ends, minimise=name), nu)
    solution = synthesize(problem(ends, minimise=name))
    assert solution.objective == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_between_given_velocities_the_least_rms_is_a_cubic() -> None:
    # order 2 with any Z of degree 1 and more: c is linear, c = s + m (k - 1/2), with s = b1 - b0, m = 6 (b0 + b1 - 2 h)
    ends = BoundaryConditions((0, 0.5), (1, 2.0))
    solution = synthesize(problem(ends, minimise="rms_c"))
    s, m = 1.5, 6 * (2.5 - 2.0)
    assert solution.objective == pytest.approx(np.sqrt(s * s + m * m / 12), rel=1e-12)


@pytest.mark.parametrize("minimise", ["D", "D/2.25 + C/4"])
def test_power_between_other_ends_is_bounded(minimise: str) -> None:
    solution = synthesize(problem(ENDS[2], minimise=minimise))
    judge(solution)
    assert 0.0 <= solution.lower_bound <= solution.objective


def test_rest_written_out_is_rest() -> None:
    plain = Problem(B=1.7, order=3)
    assert Problem(B=1.7, boundary=BoundaryConditions((0, 0, 0), (1, 0, 0))) == plain
    assert Problem(B=1.7, order=3, boundary=BoundaryConditions.rest(3)) == plain
    assert Problem(B=1.7, boundary=BoundaryConditions((0.0, 0, Fraction(0)), (1.0, 0, 0))) == plain


def test_the_mirror_image_of_the_ends_gives_the_mirror_image_of_the_law() -> None:
    ends = BoundaryConditions((0, 0.5, 1), (1, 0.25, 2))
    mirror = BoundaryConditions((0, 0.25, -2), (1, 0.5, -1))
    k = np.linspace(0.0, 1.0, 101)
    for minimise in ("C", "J", "rms_c"):
        one, other = (synthesize(problem(b, minimise=minimise)) for b in (ends, mirror))
        assert one.objective == pytest.approx(other.objective, rel=1e-10)
    one, other = (synthesize(problem(b, minimise="rms_c")) for b in (ends, mirror))
    assert other.law.b(k) == pytest.approx(one.law.b(1.0 - k), abs=1e-9)


def test_other_ends_are_not_symmetric() -> None:
    with pytest.raises(InputError, match="symmetric=False"):
        Problem(boundary=ENDS[0])


@pytest.mark.parametrize(
    "given",
    [
        {"boundary": ENDS[0], "order": 3},
        {"boundary": "rest"},
        {"boundary": ((0, 0), (1, 0))},
        {"boundary": ENDS[0], "B": 0.5},
    ],
    ids=str,
)
def test_ends_that_do_not_fit_are_refused(given: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        Problem(**given, symmetric=False)
