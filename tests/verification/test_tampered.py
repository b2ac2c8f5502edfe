"""Every value of a file is changed in turn: nothing stronger than what is proven is ever accepted."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import BSplines, Chebyshev, InputError, Pieces, Problem, Window, between
from optlaws.verification import verify
from tests.sampling import examples
from tests.verification.tampering import changed, data_of, numbers, overstated, places, value_at

pytest.importorskip("flint")

PLAIN = Problem(B=1.859, order=3, basis=Chebyshev(5))
OF_PIECES = Problem(B=1.75, order=2, basis=Pieces(4, 4, 2), minimise="max(C/4, J/40)")
FILES = [
    (PLAIN, "quick"),
    (OF_PIECES, "quick"),
    (Problem(B=1.75, order=2, basis=BSplines(4, 3)), "quick"),
    (Problem(B=1.8, order=3, basis=Chebyshev(7), minimise="rms_c", symmetric=False), "quick"),
    (
        Problem(B=between(1.2, 1.9), order=3, basis=Chebyshev(7), J=80, windows=(Window("c", -6.0, 2.0, 0.3, 0.6),)),
        "quick",
    ),
    (Problem(B=1.6, order=2, basis=Chebyshev(3), minimise="D"), "tight"),
]
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=True, allow_infinity=True) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=4,
)


@pytest.mark.parametrize("problem", [PLAIN, OF_PIECES], ids=repr)
def test_no_changed_number_is_believed(problem: Problem) -> None:
    data = data_of(problem)
    true = verify(data)
    assert true.proven
    for path in numbers(data):
        value = value_at(data, path)
        for new in (value * (1.0 + 1e-6), value - 1.0):
            try:
                assert overstated(changed(data, path, new), true) == [], (path, value, new)
            except InputError:
                continue


@pytest.mark.long
@pytest.mark.parametrize(("problem", "bound"), FILES, ids=repr)
def test_no_changed_number_is_believed_in_any_kind_of_file(problem: Problem, bound: str) -> None:
    data = data_of(problem, bound)
    true = verify(data)
    assert true.proven
    for path in numbers(data):
        value = value_at(data, path)
        for new in (value * (1.0 + 1e-6), value * (1.0 - 1e-6), value + 1e-3, -value, 0, 2 * value, value + 1):
            try:
                assert overstated(changed(data, path, new), true) == [], (path, value, new)
            except InputError:
                continue


@examples(25)
@given(st.sampled_from(FILES), st.data())
def test_whatever_stands_anywhere_ends_in_an_answer_or_an_error(
    file: tuple[Problem, str], drawn: st.DataObject
) -> None:
    data = data_of(*file)
    true = verify(data)
    path = drawn.draw(st.sampled_from(list(places(data))))
    near = st.floats(0.5, 2.0).map(lambda factor: factor * value_at(data, path)) if path in numbers(data) else JSON
    try:
        assert overstated(changed(data, path, drawn.draw(near | JSON)), true) == []
    except InputError as error:
        assert str(error)  # noqa: PT017 - there may be none


@examples(30)
@given(st.sampled_from(FILES), st.data())
def test_whatever_is_missing_ends_in_an_answer_or_an_error(file: tuple[Problem, str], drawn: st.DataObject) -> None:
    data = data_of(*file)
    path = drawn.draw(st.sampled_from(list(places(data))))
    less = changed(data, path, None)
    parent: Any = value_at(less, path[:-1])
    del parent[path[-1]]
    try:
        verification = verify(less)
    except InputError:
        return
    true = verify(data)
    assert not verification.proven or verification.problem == true.problem
    assert true.objective is not None
    assert (
        verification.bound is None
        or verification.problem != true.problem
        or verification.bound <= true.objective[1] * (1.0 + 1e-11)
    )
