"""The method "ipopt": every program as a nonlinear program of CasADi, and the same laws and bounds as by "auto"."""

import warnings
from typing import Any

import pytest

from optlaws import (
    BSplines,
    Chebyshev,
    InputError,
    NotNormalised,
    OptlawsError,
    Pieces,
    Problem,
    Solution,
    Window,
    at_least,
    at_most,
    synthesize,
)
from tests.internals.synthesis import Answer, RootMeanSquare, exchange, ipopt
from tests.synthesis.random_options import every_option

#: the rows of the table of "Synthesis of optimal laws of periodic motion"
PAPER = [Problem(B=B, order=4, basis=Chebyshev(degree)) for degree in (3, 9, 21) for B in (1.53, 1.641, 1.859, 2.0)]
OTHERS = [
    Problem(B=1.859, order=4, minimise="J"),
    Problem(B=1.859, order=4, minimise="D"),
    Problem(B=1.859, order=4, minimise="rms_c"),
    Problem(order=4, minimise="max(C/4, J/32)"),
    Problem(order=3, D=5.2),
    Problem(B=1.8, order=3, basis=Chebyshev(13), symmetric=False),
    Problem(B=250.0, order=3, inflexion=0.5),
    Problem(B=1.8, order=4, C=at_least(6.0), minimise="J"),
    Problem(order=3, basis=Pieces(12)),
    Problem(order=3, basis=BSplines(8)),
    Problem(order=3, windows=(Window("b", high=1.7),), minimise="J"),
    Problem(order=3, minimise="peak(c^2 + 0.1*j*b)"),
    Problem(order=3, minimise="integral(c^4)"),
    Problem(order=3, minimise="J", bounds={"residual(frequency=20)": 0.01}),
    Problem(order=3, basis=Chebyshev(7), minimise="rms_snap"),
]


def same(problem: Problem) -> None:
    usual, other = synthesize(problem), synthesize(problem, method="ipopt")
    assert other.objective == pytest.approx(usual.objective, rel=1e-9)
    assert other.lower_bound == pytest.approx(usual.lower_bound, rel=1e-9)
    assert other.status == usual.status


@pytest.mark.parametrize("problem", [*PAPER, *OTHERS], ids=repr)
def test_laws_and_bounds_are_those_of_the_other_method(problem: Problem) -> None:
    same(problem)


def test_ipopt_alone_solves_the_programs_on_points(monkeypatch: pytest.MonkeyPatch) -> None:
    solved, honest = [], ipopt.solve_on_points

    def counted(*args: Any, **options: Any) -> Answer:
        solved.append(args)
        return honest(*args, **options)

    def refused(*_: object, **__: object) -> None:
        pytest.fail("another solver was called")

    monkeypatch.setattr(ipopt, "solve_on_points", counted)
    monkeypatch.setattr(exchange, "answer_on_points", refused)
    for problem in (
        PAPER[0],
        Problem(B=1.9, order=3, minimise="rms_c"),
        Problem(order=3, minimise="residual(frequency=20)", J=at_most(40.0)),
    ):
        before = len(solved)
        assert synthesize(problem, method="ipopt").iterations > 0
        assert len(solved) > before


def test_a_neighbour_is_where_ipopt_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    begun, honest = [], ipopt.solve_on_points

    def noted(program: Any, points: Any, start: Any, **options: Any) -> Any:
        begun.append(start)
        return honest(program, points, start, **options)

    monkeypatch.setattr(ipopt, "solve_on_points", noted)
    problem, near = PAPER[1], synthesize(Problem(B=1.65, order=4, basis=Chebyshev(3)))
    found = synthesize(problem, start=near, method="ipopt")
    assert [start.tolist() for start in begun] == [near.active_set.x.tolist()]
    assert found.objective == pytest.approx(synthesize(problem).objective, rel=1e-9)


def test_a_tight_bound_proves_the_law_of_ipopt() -> None:
    problem = Problem(B=1.641, order=4, basis=Chebyshev(3), minimise="D")
    proven = synthesize(problem, bound="tight", method="ipopt")
    assert proven.status == "optimal"
    assert proven.objective == pytest.approx(synthesize(problem, bound="tight").objective, rel=1e-9)


def test_kinks_are_refused_and_so_is_an_unknown_method() -> None:
    with pytest.raises(InputError, match=r"formula with kinks .* method \"auto\""):
        synthesize(Problem(order=3, minimise="integral(abs(c))"), method="ipopt")
    with pytest.raises(InputError, match="unknown method 'highs'"):
        synthesize(PAPER[0], method="highs")  # type: ignore[arg-type] # which is what is refused


def some_norm_vanishes(solution: Solution) -> bool:
    """Whether the best law has an RMS of 0, where a norm has no slope that IPOPT could follow."""
    norms = [constant for constant in solution.problem.constants if isinstance(constant, RootMeanSquare)]
    return any(norm.value(solution.law) < 1e-6 * norm.scale for norm in norms)


@pytest.mark.long
def test_random_problems_have_the_same_laws() -> None:
    warnings.simplefilter("ignore", NotNormalised)
    judged = 0
    for drawn in every_option(5, 100):
        try:
            usual, other = synthesize(drawn.problem), synthesize(drawn.problem, method="ipopt")
        except OptlawsError:
            continue
        if drawn.problem.convex and usual.status == "optimal" and not some_norm_vanishes(usual):
            judged += 1
            assert other.objective == pytest.approx(usual.objective, rel=1e-9, abs=1e-9 * drawn.problem.objective.scale)
    assert judged > 30
