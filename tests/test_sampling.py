"""What `@pytest.mark.sample` leaves to long runs: never a kind, never a value of a parameter."""

from itertools import product
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import settings

from tests import sampling

A, B = [0.1, 0.2, 0.3, 0.4], ["w", "x", "y", "z"]


class Case:
    """As much of a collected case as is asked for."""

    def __init__(self, mark: pytest.Mark, params: dict[str, Any], decorators: list[Any]) -> None:
        self.mark, self.decorators, self.left = mark, decorators, False
        self.callspec = SimpleNamespace(params=params)

    def get_closest_marker(self, _name: str) -> pytest.Mark:
        return self.mark

    def iter_markers(self, _name: str) -> list[pytest.Mark]:
        return [pytest.mark.parametrize(names, []).mark for names in self.decorators]

    def add_marker(self, _mark: object) -> None:
        self.left = True


def stay(cases: list[Case]) -> list[Case]:
    sampling._leave_of_one_test(cases)  # type: ignore[arg-type] # that is as much as it asks
    return [case for case in cases if not case.left]


def alone(each: int, values: list[Any], **arguments: Any) -> list[Any]:
    """What stays of the values of one parameter."""
    mark = pytest.mark.sample(each, **arguments).mark
    return [one.callspec.params["a"] for one in stay([Case(mark, {"a": value}, ["a"]) for value in values])]


def test_every_so_many_stay_and_the_first_of_each_kind() -> None:
    assert alone(3, [*range(7)]) == [0, 3, 6]
    assert alone(3, [0, 1.0, "two", 3, 4.0, "five", 6]) == [0, 1.0, "two", 3, 6]
    assert alone(4, [*range(9)], kind=lambda value: value == 7) == [0, 4, 7, 8]
    assert alone(9, ["only"]) == ["only"]


@pytest.mark.parametrize("each", [2, 3, 5, 24])
def test_of_crossed_parameters_every_value_stays(each: int) -> None:
    mark = pytest.mark.sample(each).mark
    together = zip(A, B, strict=True)
    cases = [Case(mark, {"a": a, "b": b, "c": c}, ["c", "a, b"]) for (a, b), c in product(together, range(6))]
    left = stay(cases)
    assert len(left) <= 24 // each + 5
    for name, count in (("a", 4), ("b", 4), ("c", 6)):
        assert len({case.callspec.params[name] for case in left}) == count
    if each == 2:
        # along diagonals: no value of the one goes with a single value of the other
        assert all(
            len({one.callspec.params["c"] for one in left if one.callspec.params["a"] == value}) == 3 for value in A
        )


@pytest.mark.sample(4)
@pytest.mark.parametrize("flag", [False, True])
@pytest.mark.parametrize(("a", "b"), list(zip(A, B, strict=True)))
def test_cases_of_pytest_are_sampled(a: float, b: str, *, flag: bool, request: pytest.FixtureRequest) -> None:
    """As pytest numbers them, which its versions do differently: of those left, each value is there."""
    cases = [item for item in request.session.items if "test_cases_of_pytest_are_sampled" in item.nodeid]
    if len(cases) == 1:
        pytest.skip("a case was chosen by itself")
    left = [case.callspec.params for case in cases if isinstance(case, pytest.Function)]
    assert {"a": a, "b": b, "flag": flag} in [{name: case[name] for name in ("a", "b", "flag")} for case in left]
    assert [{case[name] for case in left} for name in ("a", "b", "flag")] == [set(A), set(B), {False, True}]


def test_a_share_of_the_examples_runs_each_time() -> None:
    profile = settings().max_examples
    assert profile in {sampling.QUICK, sampling.THOROUGH}
    assert sampling.examples(100).max_examples == profile
    assert sampling.examples(1).max_examples == 1
