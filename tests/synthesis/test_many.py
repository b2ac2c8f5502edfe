"""Many problems: one after the other, at once and in threads; each solution is what its problem alone gives."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Chebyshev,
    InfeasibleProblem,
    InputError,
    Problem,
    ProblemArray,
    Solution,
    at_most,
    sweep,
    synthesize,
    synthesize_many,
)
from tests.internals.synthesis import _together

FIRST = Problem(B=1.6, order=4, basis=Chebyshev(5))
KINDS = [
    FIRST,
    replace(FIRST, B=1.1),
    replace(FIRST, basis=Chebyshev(9), J=at_most(150.0)),
    replace(FIRST, minimise="rms_c"),
    replace(FIRST, B=None, minimise="J"),
    replace(FIRST, B=1.75),
    replace(FIRST, minimise="D"),
]


def same(found: object, alone: Solution) -> None:
    assert isinstance(found, Solution)
    assert found.problem == alone.problem
    assert found.status == alone.status
    assert found.objective == pytest.approx(alone.objective, rel=1e-11)
    k = np.linspace(0.0, 1.0, 21)
    assert found.law.b(k) == pytest.approx(alone.law.b(k), abs=1e-7)
    assert found.lower_bound <= found.objective * (1.0 + 1e-12)
    assert found.certificate.bound <= found.objective * (1.0 + 1e-12)


each_way = pytest.mark.parametrize("solve", [synthesize_many, sweep])


@each_way
def test_each_is_what_its_problem_gives_alone_and_errors_are_results_where_asked(solve: Any) -> None:
    items = list(solve(iter(KINDS), errors="return"))
    assert len(items) == len(KINDS)
    error = items[1]
    assert isinstance(error, InfeasibleProblem)
    assert error.problem == KINDS[1]
    assert error.proof is not None
    assert error.__traceback__ is None
    for one, problem in zip(items, KINDS, strict=True):
        if problem is not KINDS[1]:
            same(one, synthesize(problem))


@each_way
def test_an_error_is_raised_in_its_turn_unless_asked_for(solve: Any) -> None:
    solutions = solve(KINDS)
    assert next(solutions).problem == KINDS[0]
    with pytest.raises(InfeasibleProblem):
        next(solutions)


@each_way
def test_what_is_no_problem_spoils_its_own_place_only(solve: Any) -> None:
    items = list(solve([FIRST, 1.6, None, FIRST], errors="return"))
    assert [type(one) for one in items] == [Solution, InputError, InputError, Solution]
    assert "takes a Problem, got float" in str(items[1])


@each_way
def test_wrong_options_are_refused_at_once(solve: Any) -> None:
    with pytest.raises(InputError, match="did you mean 'return'"):
        solve([], errors="returns")
    with pytest.raises(InputError, match="bound"):
        solve([], bound="tigt")
    assert list(solve([])) == []


@pytest.mark.parametrize(("solve", "first"), [(synthesize_many, 64), (sweep, 1)])
def test_problems_are_taken_as_they_are_needed(solve: Any, first: int) -> None:
    taken = 0

    def problems() -> Iterator[Problem]:
        nonlocal taken
        while True:
            taken += 1
            yield FIRST

    next(solve(problems()))
    assert taken == first


def test_a_wrong_number_of_an_array_spoils_its_own_place_only() -> None:
    array = ProblemArray(B=np.array([1.6, np.nan, 1.7]), order=4)
    items = list(synthesize_many(array, errors="return"))
    assert [type(one) for one in items] == [Solution, InputError, Solution]


def test_results_depend_neither_on_the_order_nor_on_the_batch() -> None:
    problems = [replace(FIRST, B=float(B), basis=Chebyshev(9)) for B in np.linspace(1.42, 2.6, 90)]
    shuffled = np.random.default_rng(4).permutation(len(problems)).tolist()
    inorder = list(synthesize_many(problems))
    mixed = dict(zip(shuffled, synthesize_many(problems[i] for i in shuffled), strict=True))
    for i in range(0, len(problems), 9):
        same(mixed[i], inorder[i])
        same(next(synthesize_many([problems[i]])), inorder[i])


def test_a_sweep_over_a_list_is_the_same_as_one_by_one() -> None:
    problems = [replace(FIRST, B=B) for B in (1.6, 1.1, 1.65, 1.7)]
    for one, other in zip(sweep(problems, errors="return"), sweep(iter(problems), errors="return"), strict=True):
        if isinstance(other, Solution):
            same(one, other)
        else:
            assert type(one) is type(other)


def test_laws_of_least_power_on_a_line_are_found_together() -> None:
    problems = [replace(FIRST, B=B, minimise="D") for B in np.linspace(1.5, 2.0, 30).tolist()]
    assert _together(problems)
    assert not _together(problems[:3])
    assert not _together([*problems, replace(FIRST, B=1.6, minimise="0.5*C/4 + 0.5*D/2.25")])
    items = list(sweep(problems))
    assert [one.problem for one in items] == problems
    for place in (0, 17):
        alone = synthesize(problems[place])
        assert items[place].objective == pytest.approx(alone.objective, rel=1e-9)
        assert items[place].status is alone.status
        assert items[place].lower_bound == pytest.approx(alone.lower_bound, rel=1e-9)


@pytest.mark.sample(2)
@pytest.mark.parametrize("degree", [3, 9, 19, 39])
@pytest.mark.parametrize("B", [1.53, 1.641, 2.203])
def test_the_last_digit_does_not_depend_on_the_start(degree: int, B: float) -> None:
    problem = Problem(B=B, order=4, basis=Chebyshev(degree))
    first = synthesize(problem)
    for near in (0.999, 1.0004):
        again = synthesize(problem, start=synthesize(replace(problem, B=near * B)))
        assert again.iterations == 0
        assert again.law == first.law
        assert again.certificate == first.certificate
