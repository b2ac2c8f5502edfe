"""Many problems at once: each solution is what its problem alone gives, in order, whatever is beside it."""

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


def test_each_is_what_its_problem_gives_alone() -> None:
    items = list(synthesize_many(iter(KINDS), errors="return"))
    assert len(items) == len(KINDS)
    assert isinstance(items[1], InfeasibleProblem)
    assert items[1].problem == KINDS[1]
    for one, problem in zip(items, KINDS, strict=True):
        if problem is not KINDS[1]:
            same(one, synthesize(problem))


def test_results_depend_neither_on_the_order_nor_on_the_batch() -> None:
    problems = [replace(FIRST, B=float(B), basis=Chebyshev(9)) for B in np.linspace(1.42, 2.6, 90)]
    shuffled = np.random.default_rng(4).permutation(len(problems)).tolist()
    inorder = list(synthesize_many(problems))
    mixed = dict(zip(shuffled, synthesize_many(problems[i] for i in shuffled), strict=True))
    for i in range(0, len(problems), 9):
        same(mixed[i], inorder[i])
        same(next(synthesize_many([problems[i]])), inorder[i])


def test_an_error_is_raised_in_its_turn() -> None:
    solutions = synthesize_many(KINDS)
    assert next(solutions).problem == KINDS[0]
    with pytest.raises(InfeasibleProblem):
        next(solutions)


def test_what_is_no_problem_spoils_its_own_place_only() -> None:
    wrong: list[Any] = [FIRST, 1.6, None, FIRST]
    items = list(synthesize_many(wrong, errors="return"))
    assert [type(one) for one in items] == [Solution, InputError, InputError, Solution]
    assert "takes a Problem, got float" in str(items[1])
    array = ProblemArray(B=np.array([1.6, np.nan, 1.7]), order=4)
    items = list(synthesize_many(array, errors="return"))
    assert [type(one) for one in items] == [Solution, InputError, Solution]


def test_wrong_options_are_refused_at_once() -> None:
    with pytest.raises(InputError, match="did you mean 'return'"):
        synthesize_many([], errors="returns")  # type: ignore[call-overload] # the wrong one is the point
    with pytest.raises(InputError, match="bound"):
        synthesize_many([], bound="tigt")  # type: ignore[call-overload] # the wrong one is the point
    assert list(synthesize_many([])) == []


def test_problems_are_taken_as_they_are_needed() -> None:
    taken = 0

    def problems() -> Iterator[Problem]:
        nonlocal taken
        while True:
            taken += 1
            yield FIRST

    solutions = synthesize_many(problems())
    for _ in range(3):
        next(solutions)
    assert taken == 64


def test_a_sweep_over_a_list_is_the_same_as_one_by_one() -> None:
    problems = [replace(FIRST, B=B) for B in (1.6, 1.1, 1.65, 1.7)]
    for one, other in zip(sweep(problems, errors="return"), sweep(iter(problems), errors="return"), strict=True):
        if isinstance(other, Solution):
            same(one, other)
        else:
            assert type(one) is type(other)
