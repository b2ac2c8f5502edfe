"""Whatever stands in whatever place of a file of ours: it is refused, or what it says is still true."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws.verification import verify_all
from tests.sampling import examples
from tests.verification.tampered_formats import (
    SLOW,
    Format,
    changes,
    changes_by_kind,
    formats,
    outcome,
    places,
    tampered,
)
from tests.verification.tampering import Path, value_at

NAMES = [pytest.param(name, marks=[pytest.mark.long] if name in SLOW else []) for name in formats()]


@pytest.fixture(scope="module", params=NAMES)
def form(request: pytest.FixtureRequest) -> Format:
    return formats()[request.param]()


def test_what_was_not_changed_is_read_and_proven(form: Format) -> None:
    if form.read is not None:
        assert form.wrong(form.data, form.read(form.data)) == []
    if form.verified:
        verifications = verify_all(form.data)
        assert all(one.proven for one in verifications.values())
        assert form.wrong_proven(form.data, verifications) == []


@pytest.mark.parametrize(("name", "place"), [("front", ("points", 0)), ("table", ("rows", 0, "solution"))])
def test_an_objective_of_null_states_nothing_and_a_bound_beside_it_is_checked(name: str, place: Path) -> None:
    form = formats()[name]()
    without = tampered(form.data, (*place, "objective"), None)
    assert outcome(form, without) == ("harmless", [])
    bound = value_at(form.data, (*place, "lower_bound"))
    assert outcome(form, tampered(without, (*place, "lower_bound"), 1.001 * bound)) == ("refused", [])


#: whatever JSON holds, and what no JSON holds
ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=True, allow_infinity=True) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=4,
)


@examples(40)
@given(drawn=st.data())
def test_what_was_changed_is_refused_or_still_true(form: Format, drawn: st.DataObject) -> None:
    path = drawn.draw(st.sampled_from(list(places(form.data))))
    before = value_at(form.data, path)
    near = st.floats(0.5, 2.0).map(lambda share: share * before) if type(before) in {int, float} else st.nothing()
    value = drawn.draw(st.sampled_from(changes(before)) | near | ANYTHING)
    assert outcome(form, tampered(form.data, path, value))[1] == []


#: of few values
SMALL = {"certificate", "relaxed certificate", "no law", "problem", "machine", "cycle"}
SMALL |= {"polynomial law", "piecewise law"}


@pytest.mark.parametrize(
    "name", [pytest.param(one, marks=[pytest.mark.long] * (one not in SMALL)) for one in formats()]
)
def test_every_value_changed_and_each_kind_in_every_way_is_refused_or_still_true(name: str) -> None:
    form = formats()[name]()
    for path, value in changes_by_kind(form.data):
        assert outcome(form, tampered(form.data, path, value))[1] == [], (path, value)
