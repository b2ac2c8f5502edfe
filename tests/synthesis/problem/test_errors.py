"""What is refused, and how: the input is named, the whole problem is printed, and nothing is silent."""

import pickle
import re
from contextlib import suppress
from dataclasses import replace
from math import inf, nan
from typing import Any

import numpy as np
import pytest

import optlaws
from optlaws import (
    Bernstein,
    BoundaryConditions,
    C,
    Certificate,
    Chebyshev,
    D,
    InfeasibleProblem,
    InputError,
    J,
    OptlawsError,
    Pieces,
    Powers,
    Problem,
    SolverFailure,
    Window,
    at_least,
    at_most,
    between,
    law_from_z,
    maximum,
    rms_c,
    sweep,
    synthesize,
    via,
)
from optlaws.synthesis import basis
from tests.internals.synthesis import Answer, Points, Program, exchange, make, search

GOOD: dict[str, Any] = {"B": 1.859, "order": 4}


def problem(**changes: Any) -> Problem:
    return Problem(**{**GOOD, **changes})


#: by entry: values that it cannot have, and what is said of each
WRONG: list[tuple[str, tuple[Any, ...], str]] = [
    (
        "B",
        (1.0, 1, 0.5, 0.0, -1.641, nan, inf, -inf, True, "1.6", 1.6j, {1.6}),
        "B must be a finite number above 1 (the mean velocity is 1), got {!r}",
    ),
    ("B", ([1.6], [1.6, 1.7, 1.8]), "B must be a finite number, a range"),
    ("B", ((1.8, 1.5),), "the lower bound 1.8 must be finite and at most the upper one, 1.5"),
    ("B", ((nan, 1.8), (1.5, nan)), "bounds must be numbers of at least 0, got nan"),
    ("B", ((1.5, "1.8"),), "bounds must be numbers of at least 0, got '1.8'"),
    ("B", ((inf, inf),), "the lower bound inf must be finite"),
    ("B", ((0.2, 1.0),), "B of at most 1.0 excludes every law: it must be above 1"),
    ("B", ((0.0, 0.9),), "B of at most 0.9 excludes every law: it must be above 1"),
    ("B", ((True, 1.8),), "bounds must be numbers of at least 0, got True"),
    *((name, (nan, inf, -inf, True, "5", [5.0], 5j, {5.0}), f"{name} must") for name in "CDJ"),
    *((name, (0.0, (0.0, 0.0)), f"{name} of at most") for name in "CDJ"),
    *((name, (-1.0,), "bounds must be numbers of at least 0, got -1.0") for name in "CDJ"),
    ("order", (0, -1, True, 2.0, None, nan), "must be an integer of at least 1, got {!r}"),
    ("order", ("4",), "must be an integer of at least 1, got the text {!r}"),
    ("basis", (Powers(0), Chebyshev(0)), "degree 0 leaves no freedom"),
    ("basis", (None, 9, "chebyshev", Powers), "basis must be a Basis"),
    (
        "minimise",
        (None, 2, 2.5, [], ["C"], {"C": 1.0}, max, b"C"),
        "minimise must be a constant such as 'C', a sum or an expression, got {!r}",
    ),
    ("minimise", ("c", "Q", "CC", "rms_q", "peek"), "unknown constant {!r}"),
    *((name, (1, 0, "yes", None), f"{name} must be True or False") for name in ("monotone", "symmetric")),
]


@pytest.mark.parametrize(("entry", "value", "message"), [(e, v, m.format(v)) for e, values, m in WRONG for v in values])
def test_a_wrong_entry_is_named(entry: str, value: Any, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        problem(**{entry: value})


@pytest.mark.parametrize("kind", [Powers, Chebyshev])
@pytest.mark.parametrize(
    ("degree", "said"), [*((wrong, repr(wrong)) for wrong in (-1, True, 3.0, None, nan)), ("3", "the text '3'")]
)
def test_a_wrong_degree_is_named(kind: type, degree: object, said: str) -> None:
    with pytest.raises(InputError, match=re.escape(f"degree of Z must be an integer of at least 0, got {said}")):
        kind(degree)


def test_an_unknown_basis_is_named_with_the_known_ones() -> None:
    with pytest.raises(
        InputError, match="'splines' is unknown; known are bernstein, bsplines, chebyshev, periodic, pieces, powers"
    ):
        basis("splines", 3)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"B": 1.859, "ordr": 4}, "did you mean 'order'"),
        ({"B": 1.859, "order": 4, "monoton": True}, "did you mean 'monotone'"),
        ({"B": 1.859}, "lacks order"),
        ({}, "lacks order"),
        ({"B": 1.859, "order": 4, "minimize": "D"}, "did you mean 'minimise'"),
        ({"B": 1.859, "order": 4, "C": "5"}, "C must be"),
        ({"B": 1.859, "order": 4, "start": [0, 0]}, "boundary conditions need as many"),
        ({"B": 1.859, "order": 3, "start": [0, 0], "end": [1, 0]}, "order 3 does not fit 2 boundary conditions"),
        ({"B": 1.859, "order": 4, "basis": ["chebyshev"]}, "basis"),
        ({"B": 1.859, "order": 4, "windows": 3}, "windows"),
        ({"B": 1.859, "order": 4, "start": 3, "end": 4}, "boundary conditions|start"),
        ({"B": nan, "order": 4}, "B must be"),
        ({"B": 1.859, "order": 4, "degree": 1.5}, "degree"),
        ({"B": 1.859, "order": 4, "basis": "splines"}, "splines"),
    ],
)
def test_a_problem_from_wrong_data_is_refused(data: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Problem.from_dict(data)


@pytest.mark.parametrize("wrong", [None, 1.641, {"B": 1.641, "order": 4}, "Problem(B=1.641, order=4)", Problem])
def test_what_is_no_problem_is_refused(wrong: Any) -> None:
    with pytest.raises(InputError, match="synthesize takes a Problem"):
        synthesize(wrong)
    with pytest.raises(InputError, match="synthesize takes a Problem"):
        list(sweep([wrong]))


@pytest.mark.parametrize("wrong", [1.641, {}, "a solution", problem()])
def test_a_start_that_is_no_solution_is_refused(wrong: Any) -> None:
    with pytest.raises(InputError, match="start"):
        synthesize(problem(), start=wrong)


def test_entries_have_names() -> None:
    with pytest.raises(TypeError, match="positional argument"):
        Problem(1.5, 4)  # type: ignore[arg-type, call-arg]


# --- a problem is a value that can be printed and run again ---

PROBLEMS = [
    problem(),
    problem(B=2, basis=Powers(3)),
    problem(B=2.123456789012345, order=2, basis=Chebyshev(41), monotone=True, symmetric=False),
    problem(B=None, J=60),
    problem(B=at_most(1.7), J=at_most(60), windows=(Window("c + 2*b", high=7.0, start=0.1, stop=0.9),)),
    problem(B=between(1.5, 1.8), C=at_most(60), J=at_least(40.5), D=3),
    problem(B=at_least(1.5), minimise="0.6*C/4 + 0.4*D/2.25"),
    problem(minimise=maximum(C / 4, D / 2.25 + J / 64) + 0.1 * rms_c),
    problem(order=2, symmetric=False, boundary=BoundaryConditions((0, 0.5), (1, -0.25))),
    problem(basis=Bernstein(7), windows=(via("a", 0.3, at=0.4), Window("b", high=1.2, start=0.2, stop=0.3))),
    problem(basis=Pieces(4, 5, 3)),
]


@pytest.mark.parametrize("one", PROBLEMS)
def test_the_repr_of_a_problem_makes_an_equal_one(one: Problem) -> None:
    again = eval(repr(one), vars(optlaws))  # noqa: S307
    assert again == one
    assert hash(again) == hash(one)


def test_numpy_numbers_are_numbers() -> None:
    assert problem(B=np.float64(1.859)) == problem()
    assert problem(B=np.float64(1.859)).to_dict() == problem().to_dict()


# --- infeasible and failed problems ---


def test_one_coefficient_cannot_give_b_1_53_at_order_4_but_more_can() -> None:
    asked = problem(B=1.53, basis=Powers(1))
    with pytest.raises(InfeasibleProblem) as caught:
        synthesize(asked)
    error = caught.value
    assert isinstance(error, OptlawsError)
    assert isinstance(error.proof, Certificate)
    assert error.proof.proves_infeasible
    assert error.tried
    message = str(error)
    for part in ("order 4", "degree 1", "1.53", "b <= B", "higher degree", "lower order"):
        assert part in message
    assert eval(message.rpartition("problem: ")[2], vars(optlaws)) == asked  # noqa: S307
    again = pickle.loads(pickle.dumps(error))  # noqa: S301
    assert str(again) == message
    assert again.proof == error.proof
    for degree in (3, 9):
        assert synthesize(replace(asked, basis=Powers(degree))).gap <= 1e-8
    assert synthesize(replace(asked, order=2)).gap <= 1e-8


def test_the_law_that_one_coefficient_gives_does_break_b() -> None:
    law = law_from_z(BoundaryConditions.rest(4), [0.5 * 4**4 * (2.1875 - 1.53), -(4**4) * (2.1875 - 1.53)])
    assert law.b(0.5) == pytest.approx(1.53, abs=1e-12)
    assert law.peak(1).value > 1.53 + 1e-3


def test_a_solver_that_fails_is_never_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    def failed(program: Program, points: list[Points], *_: object) -> Answer:
        return Answer.missing(program, points, "InsufficientProgress", 7)

    monkeypatch.setattr(exchange, "optimum_on_points", failed)
    asked = problem(B=1.7001)
    # where Clarabel fails the simplex method solves a linear program
    assert synthesize(asked).status == "optimal"
    monkeypatch.setattr(exchange, "vertex_on_points", lambda *_: None)
    with pytest.raises(SolverFailure, match="no law was found") as caught:
        synthesize(asked)
    assert caught.value.problem == asked
    assert "InsufficientProgress" in str(caught.value)
    assert eval(str(caught.value).rpartition("problem: ")[2], vars(optlaws)) == asked  # noqa: S307


@pytest.mark.parametrize("shift", [1e-6, -1e-3, 1.0])
def test_multipliers_that_are_wrong_give_no_false_claim(monkeypatch: pytest.MonkeyPatch, shift: float) -> None:
    asked = problem(B=1.7002)
    true = synthesize(asked).objective
    honest = exchange.answer_on_points

    def lying(*args: Any) -> Answer:
        answer = honest(*args)
        wrong = [weights * (1.0 + shift) for weights in answer.multipliers]
        return replace(answer, x=answer.x + shift, multipliers=wrong)

    monkeypatch.setattr(exchange, "answer_on_points", lying)
    try:
        solution = synthesize(asked)
    except SolverFailure:
        return
    assert solution.objective == pytest.approx(true, rel=1e-10)
    assert solution.lower_bound <= true * (1 + 1e-12)


def test_a_law_without_a_meeting_bound_is_not_called_optimal(monkeypatch: pytest.MonkeyPatch) -> None:
    honest = make.certify

    def poor(*args: Any) -> Certificate:
        found = honest(*args)
        return found.with_leaf(contacts=found.contacts[:-1])

    monkeypatch.setattr(search, "certify", poor)
    solution = synthesize(problem())
    assert solution.status.value == "inaccurate"
    assert solution.gap > 1e-8
    assert "bound does not meet it" in solution.status.advice


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "one",
    [problem(B=1.7003), problem(B=1.53, basis=Powers(1)), problem(B=2.9, order=2, basis=Powers(3), monotone=True)],
)
def test_nothing_is_printed(one: Problem, capfd: pytest.CaptureFixture[str]) -> None:
    with suppress(InfeasibleProblem):
        synthesize(one)
    assert capfd.readouterr() == ("", "")
