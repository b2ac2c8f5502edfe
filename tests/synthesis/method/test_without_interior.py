"""Bounds at a constant's own least value leave hardly any room: the law must keep them all the same."""

from unittest.mock import Mock

import pytest

from optlaws import Basis, BSplines, Chebyshev, InfeasibleProblem, Pieces, Problem, at_most, rms, synthesize
from tests.internals.numerics import conic_optimum
from tests.internals.synthesis import evaluate
from tests.sampling import sampled

UNSYMMETRIC = [Chebyshev(5), Pieces(8, 5, 3), BSplines(4, 4, 3)]


@pytest.mark.sample(3)
@pytest.mark.parametrize("basis", UNSYMMETRIC, ids=lambda basis: basis.name)
@pytest.mark.parametrize(("bounded", "minimise"), sampled([("rms_c", "C"), ("rms_c", "rms_j"), ("rms_j", "C")]))
@pytest.mark.parametrize("room", [0.0, 1e-12])
def test_a_bound_at_the_least_value_is_kept(basis: Basis, bounded: str, minimise: str, room: float) -> None:
    least = synthesize(Problem(order=3, basis=basis, symmetric=False, minimise=bounded))
    asked = at_most(least.objective * (1.0 + room))
    problem = Problem(order=3, basis=basis, symmetric=False, minimise=minimise, bounds={bounded: asked})
    solution = synthesize(problem)
    assert solution.lower_bound <= solution.objective
    assert solution.gap < 1e-4
    assert evaluate(problem, solution.law).excess <= 1e-13
    # the norm has one least law, and those with a little room lie within its square root
    there = Problem(order=3, basis=basis, symmetric=False, minimise=minimise)
    assert solution.objective == pytest.approx(evaluate(there, least.law).objective, rel=30.0 * (room + 1e-13) ** 0.5)


def test_a_search_ends_where_no_step_keeps_more_of_the_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    """From every start some quadratic programs show it; all rounds of them took minutes, for nothing."""
    counted = Mock(wraps=conic_optimum)
    monkeypatch.setattr("optlaws.synthesis.method.discretised.quadratic_steps.conic_optimum", counted)
    kinked = rms("max(1.1*c + 0.5, 0.9*c + 0.5)")
    assert synthesize(Problem(order=3, minimise=kinked, C=at_most(4.8), monotone=True)).objective < 4.0
    with pytest.raises(InfeasibleProblem, match=r"C = 4\.3 everywhere"):
        synthesize(Problem(order=3, minimise=kinked, C=at_most(4.3), monotone=True))
    assert 0 < counted.call_count < 300


@pytest.mark.long
def test_a_peak_at_its_least_value_beside_another() -> None:
    basis = Chebyshev(5)
    least = synthesize(Problem(order=3, B=1.8, basis=basis, minimise="C"))
    problem = Problem(order=3, B=1.8, basis=basis, minimise="J", symmetric=False, C=at_most(least.objective))
    solution = synthesize(problem)
    assert solution.lower_bound <= solution.objective
    assert solution.constants.C.value <= least.objective * (1.0 + 1e-13)


def test_the_ends_are_met_where_hardly_any_room_is_left() -> None:
    basis = Pieces(8, 5, 3)
    least = synthesize(Problem(order=3, basis=basis, symmetric=False, minimise="rms_c"))
    problem = Problem(
        order=3, basis=basis, symmetric=False, minimise="rms_j", bounds={"rms_c": at_most(least.objective)}
    )
    law = synthesize(problem).law
    assert law.a(1.0) == pytest.approx(1.0, abs=1e-13)
    assert law.b(1.0) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("minimise", ["J", "snap", "J + C"])
def test_uniform_motion_of_pieces_has_no_jumps(minimise: str) -> None:
    solution = synthesize(Problem(order=1, basis=Pieces(8, 5, 3), minimise=minimise))
    assert 0.0 <= solution.lower_bound <= solution.objective < 1e-9
