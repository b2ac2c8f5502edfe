"""Which cases and examples run each time, and which where long tests are asked for (`make test-long`)."""

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import Any

import pytest
from _pytest.mark.structures import ParameterSet
from hypothesis import settings

#: examples of a property that says nothing of their number, in all and each time
THOROUGH, QUICK = 100, 10


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

    Of the others those stay that show a kind that no other one has: a value of a parameter where parameters are
    crossed, or what `kind` tells of the value of the only one, its type unless given. The case of most new kinds
    comes first, so that few cases show all.
    """
    marked = [item for item in items if isinstance(item, pytest.Function) and item.get_closest_marker("sample")]
    for _, cases in groupby(marked, lambda item: item.nodeid.partition("[")[0]):
        _leave_of_one_test(list(cases))


def _leave_of_one_test(cases: list[pytest.Function]) -> None:
    mark = cases[0].get_closest_marker("sample")
    assert mark is not None
    (each,) = mark.args
    # where several parameters are crossed, cases are taken along diagonals
    counted = [_places(cases, names) for names in _together(cases[0])]
    taken = [sum(places) % each == 0 for places in zip(*counted, strict=True)]
    kind = mark.kwargs.get("kind", type)
    kinds: list[set[tuple[Any, Any]]] = [
        set(enumerate(places))
        if len(counted) > 1
        else {(name, kind(value)) for name, value in case.callspec.params.items()}
        for case, places in zip(cases, zip(*counted, strict=True), strict=True)
    ]
    unseen = set().union(*kinds).difference(*(own for own, is_taken in zip(kinds, taken, strict=True) if is_taken))
    while unseen:
        best = max(range(len(cases)), key=lambda i: len(kinds[i] & unseen))
        taken[best] = True
        unseen -= kinds[best]
    for case, is_taken in zip(cases, taken, strict=True):
        if not is_taken:
            case.add_marker(pytest.mark.long)


def _together(case: pytest.Function) -> list[tuple[str, ...]]:
    """The names of a case's parameters, those of one decorator together."""
    named = [mark.args[0] for mark in case.iter_markers("parametrize")]
    return [tuple(part.strip() for part in one.split(",")) if isinstance(one, str) else tuple(one) for one in named]


def _places(cases: list[pytest.Function], names: tuple[str, ...]) -> list[int]:
    """The place of each case's values among those of a decorator, which are the same objects in all cases."""
    known: dict[tuple[int, ...], int] = {}
    return [known.setdefault(tuple(id(case.callspec.params[name]) for name in names), len(known)) for case in cases]
