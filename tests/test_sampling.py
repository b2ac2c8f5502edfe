"""What `@pytest.mark.sample` leaves to long runs: never a kind, never a value of a parameter."""

from itertools import product
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import settings

from tests import sampling


class Case:
    """As much of a collected case as is asked for."""

    def __init__(self, mark: pytest.Mark, indices: dict[str, int], params: dict[str, Any]) -> None:
        self.mark, self.left = mark, False
        self.callspec = SimpleNamespace(indices=indices, params=params)

    def get_closest_marker(self, _name: str) -> pytest.Mark:
        return self.mark

    def add_marker(self, _mark: object) -> None:
        self.left = True


def stay(cases: list[Case]) -> list[Case]:
    sampling._leave_of_one_test(cases)  # type: ignore[arg-type] # that is as much as it asks
    return [case for case in cases if not case.left]


def alone(each: int, values: list[Any], **arguments: Any) -> list[Any]:
    """What stays of the values of one parameter."""
    mark = pytest.mark.sample(each, **arguments).mark
    return [one.callspec.params["a"] for one in stay([Case(mark, {"a": i}, {"a": v}) for i, v in enumerate(values)])]


def test_every_so_many_stay_and_the_first_of_each_kind() -> None:
    assert alone(3, [*range(7)]) == [0, 3, 6]
    assert alone(3, [0, 1.0, "two", 3, 4.0, "five", 6]) == [0, 1.0, "two", 3, 6]
    assert alone(4, [*range(9)], kind=lambda value: value == 7) == [0, 4, 7, 8]
    assert alone(9, ["only"]) == ["only"]


@pytest.mark.parametrize("each", [2, 3, 5])
def test_of_crossed_parameters_every_value_stays(each: int) -> None:
    mark = pytest.mark.sample(each).mark
    # a and b come from one decorator, c from another
    cases = [Case(mark, {"a": i, "b": i, "c": j}, {}) for i, j in product(range(4), range(6))]
    left = stay(cases)
    assert len(left) <= 24 // each + 5
    for name, count in (("a", 4), ("b", 4), ("c", 6)):
        assert {case.callspec.indices[name] for case in left} == {*range(count)}
    if each == 2:
        # along diagonals: no value of the one goes with a single value of the other
        assert all(
            len({one.callspec.indices["c"] for one in left if one.callspec.indices["a"] == i}) == 3 for i in range(4)
        )


def test_a_share_of_the_examples_runs_each_time() -> None:
    profile = settings().max_examples
    assert profile in {sampling.QUICK, sampling.THOROUGH}
    assert sampling.examples(100).max_examples == profile
    assert sampling.examples(1).max_examples == 1
