"""Sweeps: problems one after the other, and what becomes of those without an answer."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import Chebyshev, InfeasibleProblem, InputError, Problem, Solution, sweep, synthesize
from tests.internals.synthesis import _together

FIRST = Problem(B=1.6, order=4, basis=Chebyshev(5))


def test_errors_are_raised_unless_asked_for() -> None:
    solutions = sweep(replace(FIRST, B=B) for B in (1.6, 1.1, 1.7))
    assert next(solutions).problem.B == 1.6
    with pytest.raises(InfeasibleProblem):
        next(solutions)


def test_errors_are_results_where_that_is_asked() -> None:
    problems = [replace(FIRST, B=B) for B in (1.1, 1.6, 1.2, 1.7)]
    items = list(sweep(problems, errors="return"))
    assert [type(one) for one in items] == [InfeasibleProblem, Solution, InfeasibleProblem, Solution]
    for one, problem in zip(items, problems, strict=True):
        if isinstance(one, Solution):
            assert one.problem == problem
            assert one.objective == pytest.approx(synthesize(problem).objective, rel=1e-11)
        else:
            assert isinstance(one, InfeasibleProblem)
            assert one.problem == problem
            assert one.proof is not None
            assert one.__traceback__ is None


def test_what_is_no_problem_spoils_its_own_place_only() -> None:
    wrong: list[Any] = [FIRST, None, FIRST]
    items = list(sweep(wrong, errors="return"))
    assert [type(one) for one in items] == [Solution, InputError, Solution]
    assert "takes a Problem, got NoneType" in str(items[1])


def test_the_option_is_checked_at_once() -> None:
    with pytest.raises(InputError, match="did you mean 'return'"):
        sweep([], errors="returns")  # type: ignore[call-overload] # the wrong one is the point


def test_problems_are_taken_one_by_one() -> None:
    taken = []

    def problems() -> Iterator[Problem]:
        for B in (1.6, 1.7, 1.8):
            taken.append(B)
            yield replace(FIRST, B=B)

    solutions = sweep(problems())
    next(solutions)
    assert taken == [1.6]


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
