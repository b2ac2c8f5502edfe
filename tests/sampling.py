"""Which cases and examples run each time, and which where long tests are asked for (`make test-long`)."""

from collections.abc import Callable, Iterable, Sequence
from itertools import groupby
from typing import Any

import pytest
from _pytest.mark.structures import ParameterSet
from hypothesis import settings

#: examples of a property that says nothing of their number, in all and each time
THOROUGH, QUICK = 100, 15


def sampled(cases: Iterable[Any], each: int = 3) -> list[ParameterSet]:
    """Every so many of the cases, from the first on, for each run; the others for `make test-long`."""
    return [
        pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=[pytest.mark.long] if i % each else [])
        for i, case in enumerate(cases)
    ]


def examples(count: int) -> settings:
    """So many examples of a property where long tests are asked for, and each time the share that the profile has."""
    return settings(max_examples=max(1, count * settings().max_examples // THOROUGH))


def leave_to_long_runs(items: Sequence[pytest.Item]) -> None:
    """Mark as long what `@pytest.mark.sample(each)` leaves out: all but every so many of a test's cases.

    Of the others the first of each kind stays too: of each value of each parameter where parameters are crossed, or
    of what `kind` tells of the value of the only one, its type unless given.
    """
    marked = [item for item in items if isinstance(item, pytest.Function) and item.get_closest_marker("sample")]
    for _, cases in groupby(marked, lambda item: item.nodeid.partition("[")[0]):
        _leave_of_one_test(list(cases))


def _leave_of_one_test(cases: list[pytest.Function]) -> None:
    mark = cases[0].get_closest_marker("sample")
    assert mark is not None
    (each,) = mark.args
    # parameters of one decorator count together; where several are crossed, cases are taken along diagonals
    counted = {tuple(case.callspec.indices[name] for case in cases) for name in cases[0].callspec.indices}
    taken = [sum(places) % each == 0 for places in zip(*counted, strict=True)]
    kinds = [_kinds(case, None if len(counted) > 1 else mark.kwargs.get("kind", type)) for case in cases]
    seen = {one for own, is_taken in zip(kinds, taken, strict=True) if is_taken for one in own}
    for case, own, is_taken in zip(cases, kinds, taken, strict=True):
        if not is_taken and own <= seen:
            case.add_marker(pytest.mark.long)
        seen |= own


def _kinds(case: pytest.Function, kind: Callable[[Any], Any] | None) -> set[tuple[str, Any]]:
    if kind is None:
        return set(case.callspec.indices.items())
    return {(name, kind(value)) for name, value in case.callspec.params.items()}
