"""Problems without a law: which conditions contradict each other, and a proof of it."""

import pickle
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from optlaws import (
    Basis,
    BoundaryConditions,
    BSplines,
    Certificate,
    Chebyshev,
    InfeasibleProblem,
    Pieces,
    Powers,
    Problem,
    SolverFailure,
    Window,
    at_most,
    synthesize,
    via,
)
from optlaws.verification import exact_bound
from tests.internals.synthesis import contradiction, independent
from tests.internals.verification import prove

CONTRADICTIONS = [
    (Problem(order=3, windows=(via("a", 0.3, at=0.3), via("a", 0.4, at=0.3))), ["via('a', 0.3", "via('a', 0.4"]),
    (Problem(order=3, windows=(via("a", 0.5, at=0.0),)), ["via('a', 0.5, at=0.0)", "end conditions"]),
    (Problem(order=3, B=1.8, windows=(via("b", 2.0, at=0.5),)), ["b(1/2) = B = 1.8", "via('b', 2.0"]),
    (Problem(order=3, windows=(via("c", 1.0, at=0.5),)), ["via('c', 1.0, at=0.5)"]),
    (Problem(order=3, windows=(via("a", 0.3, at=0.25), via("a", 0.3, at=0.75))), ["via('a', 0.3, at=0.25)"]),
    (
        Problem(order=3, symmetric=False, inflexion=0.4, windows=(Window("c", low=0.5, start=0.1, stop=0.4),)),
        ["c(0.4) = 0", "Window('c', low=0.5, start=0.1, stop=0.4)"],
    ),
    (Problem(order=4, basis=Pieces(2, 4, 3)), ["c(0.5) = 0", "j(0) = 0", "lower continuity"]),
    (
        Problem(order=5, basis=Pieces(2, 4, 2), symmetric=False, minimise="rms_c"),
        ["a(1) = 1", "a^(4)(1) = 0", "More pieces"],
    ),
    (
        Problem(
            order=3,
            symmetric=False,
            windows=(Window("a", low=0.6, start=0.2, stop=0.4), Window("a", high=0.5, start=0.3, stop=0.5)),
        ),
        ["Window('a', low=0.6", "Window('a', high=0.5"],
    ),
    (
        Problem(
            order=3,
            monotone=True,
            symmetric=False,
            windows=(Window("a", low=0.3, start=0.2, stop=0.2), Window("a", high=0.2, start=0.3, stop=0.5)),
        ),
        ["b >= 0", "Window('a', high=0.2, start=0.3, stop=0.5)"],
    ),
    (
        Problem(
            order=3,
            symmetric=False,
            basis=Chebyshev(2),
            windows=tuple(via("a", value, at=k) for value, k in ((0.1, 0.1), (0.2, 0.3), (0.3, 0.4), (0.3, 0.5))),
        ),
        ["via('a', 0.1", "via('a', 0.3, at=0.5)", "A higher degree of Z may help"],
    ),
    (Problem(order=3, symmetric=False, windows=(Window("b", high=0.9),)), ["Window('b', high=0.9)"]),
    (
        Problem(boundary=BoundaryConditions((0, 0.5), (1, 0.5)), symmetric=False, windows=(via("b", 0.0, at=1.0),)),
        ["via('b', 0.0, at=1.0)"],
    ),
]


@pytest.mark.sample(9)
@pytest.mark.parametrize(("problem", "named"), CONTRADICTIONS, ids=range(len(CONTRADICTIONS)))
def test_contradictory_conditions_are_named_and_proven(problem: Problem, named: list[str]) -> None:
    with pytest.raises(InfeasibleProblem) as caught:
        synthesize(problem)
    message = str(caught.value).partition("\ntried: ")[0]
    assert [text for text in named if text not in message] == []
    proof = caught.value.proof
    assert isinstance(proof, Certificate)
    assert Certificate.from_dict(proof.to_dict()).proves_infeasible
    value = prove(proof).value
    assert value is not None
    assert value > 0
    assert pickle.loads(pickle.dumps(caught.value)).proof == proof  # noqa: S301


def test_the_proof_is_of_the_right_sides_asked() -> None:
    proof = CONTRADICTIONS[0][0], synthesize_fails(CONTRADICTIONS[0][0])
    agreeing = Problem(order=3, windows=(via("a", 0.3, at=0.3), via("a", 0.3, at=0.3)))
    moved = Certificate.of_leaf(agreeing, proof[1].contacts, proof[1].equations, "violation")
    assert proof[1].proves_infeasible
    assert not moved.proves_infeasible
    assert (prove(moved).value or 0) <= 0
    assert synthesize(agreeing).status == "optimal"


def synthesize_fails(problem: Problem) -> Certificate:
    with pytest.raises(InfeasibleProblem) as caught:
        synthesize(problem)
    assert isinstance(caught.value.proof, Certificate)
    return caught.value.proof


@pytest.mark.parametrize(
    "windows",
    [
        (via("a", 0.0, at=0.0), via("b", 0.0, at=1.0)),
        (via("a", 0.5, at=0.5), via("c", 0.0, at=0.5)),
        (via("a", 0.25, at=0.25), via("a", 0.75, at=0.75), via("a", 0.25, at=0.25)),
    ],
)
def test_conditions_said_twice_change_nothing(windows: tuple[Window, ...]) -> None:
    once = Problem(B=1.9, order=3, windows=windows[-1:])
    twice = Problem(B=1.9, order=3, windows=windows)
    solution = synthesize(twice)
    assert solution.status == "optimal"
    assert solution.objective == pytest.approx(synthesize(once).objective, rel=1e-10)


def test_multipliers_of_equations_that_contradict_each_other() -> None:
    numbers = np.random.default_rng(3)
    for count in (3, 5, 8):
        rows = numbers.normal(size=(count, 3)) * 10.0 ** numbers.uniform(-2, 2, size=(count, 1))
        x = numbers.normal(size=3)
        assert contradiction(rows, rows @ x) is None
        if count > 3:
            wrong = rows @ x + np.eye(count)[1]
            proof = contradiction(rows, wrong)
            assert proof is not None
            assert np.abs(proof @ rows).max() < 1e-12 * np.abs(rows).max()
            assert proof @ wrong < 0.0
    assert independent(np.vstack([rows, rows])).sum() == 3
    assert independent(np.zeros((2, 3))).sum() == 0


@pytest.mark.long
def test_nothing_is_printed_by_the_solver_whatever_comes_of_it() -> None:
    code = """
from optlaws import *
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.program.writer import model_of
import numpy as np
problems = [
    Problem(order=5, basis=Pieces(2, 4, 2), symmetric=False, minimise="rms_c"),
    Problem(order=3, windows=(via("a", 0.3, at=0.3), via("a", 0.4, at=0.3))),
    Problem(B=1.53, order=4, basis=Powers(1)),
    Problem(B=1.7, order=3, minimise="D", D=at_most(1.0)),
    Problem(B=1.7, order=3, minimise="rms_j"),
]
for problem in problems:
    try:
        synthesize(problem)
    except OptlawsError as error:
        assert "iterations" not in error.tried or "after -" not in error.tried
found = model_of(Problem(B=1.7, order=3, minimise="D"))
outcome = solve(found.program, start=np.full(found.program.size, np.nan))
assert outcome.optimum is None and outcome.iterations == 0, outcome
"""
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=100)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")


@pytest.mark.sample(3)
@pytest.mark.parametrize("minimise", ["C_plus", "C_minus", "0.001*C_plus + 0.0005*C_plus"])
def test_an_objective_without_a_least_value_is_said_to_have_none(minimise: str) -> None:
    problem = Problem(order=1, basis=Powers(6), minimise=minimise, symmetric=False)
    with pytest.raises(SolverFailure, match="has no least value: there are laws with -100000 and less"):
        synthesize(problem)
    least = synthesize(replace(problem, C=at_most(4.0))).objective
    assert least == pytest.approx(-4.0 if "+" not in minimise else -0.006)


# --- values that all laws have ---


WINDOWS = [
    Window("a", low=0.3, high=0.3),
    Window("a", low=-20.0, high=0.0, start=0.5),
    Window("a", high=0.9, start=0.5),
    Window("b", low=0.1),
    Window("c", high=-1.0, stop=0.2),
]


@pytest.mark.parametrize("basis", [Chebyshev(9), Chebyshev(1), Powers(3), Pieces(4, 7, 3), BSplines(4, 5)], ids=repr)
@pytest.mark.parametrize("window", WINDOWS, ids=repr)
def test_a_window_without_the_value_of_all_laws_is_refused_with_a_proof(window: Window, basis: Basis) -> None:
    with pytest.raises(InfeasibleProblem) as raised:
        synthesize(Problem(order=3, basis=basis, windows=(window,)))
    assert isinstance(raised.value.proof, Certificate)
    assert (exact_bound(raised.value.proof) or 0) > 0


@pytest.mark.parametrize(("start", "stop", "at"), [(0.0, 0.1, "0"), (0.9, 1.0, "1")])
def test_the_place_is_in_the_window_also_of_symmetric_laws(start: float, stop: float, at: str) -> None:
    window = Window("a", low=0.3, high=0.6, start=start, stop=stop)
    with pytest.raises(InfeasibleProblem, match=rf"the value that every law of the problem has at k = {at}\. "):
        synthesize(Problem(order=4, windows=(window,)))


def test_a_formula_that_is_not_convex_is_proven_to_exceed_its_bound() -> None:
    asked = Problem(order=4, B=1.8, bounds={"peak(j^2 + b, stop=0.3)": at_most(100)})
    with pytest.raises(InfeasibleProblem, match=r"at least 257\.7895, proven by error\.proof") as caught:
        synthesize(asked)
    assert isinstance(caught.value.proof, Certificate)
    proven = exact_bound(caught.value.proof)
    assert proven is not None
    assert 257.789 < proven < 257.7895
