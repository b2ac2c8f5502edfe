"""A problem in a problem file: bases of pieces, bounds of any constant, an inflexion."""

from typing import Any

import pytest

from optlaws import BSplines, InputError, Pieces, Problem, at_most, between
from tests.internals.studies import problem
from tests.internals.synthesis import PROBLEM


def asked(**entries: Any) -> Problem:
    return problem("row 1", PROBLEM.read(entries, "problem"))


def test_every_entry_is_read() -> None:
    found = asked(
        order=3,
        basis="bsplines",
        degree=3,
        breaks=[0, 0.3, 0.7, 1],
        continuity=2,
        bounds={"rms_c": [0, 4], "snap": 900.0},
    )
    assert found == Problem(
        order=3, basis=BSplines((0, 0.3, 0.7, 1), 3, 2), bounds={"rms_c": at_most(4), "snap": 900.0}
    )
    assert asked(order=3, basis="pieces", degree=4, breaks=8, bounds={"rms_c": [3.5, 4]}) == Problem(
        order=3, basis=Pieces(8, 4), bounds={"rms_c": between(3.5, 4)}
    )
    assert asked(order=3, symmetric=False, inflexion=0.4).inflexion == 0.4
    assert asked(order=3, bounds={"rms_c": "free"}) == Problem(order=3)


@pytest.mark.parametrize(
    ("entries", "text"),
    [
        ({"basis": "spline"}, "basis"),
        ({"inflexion": 1.0}, "inflexion"),
        ({"inflexion": 0.4}, "symmetric=False"),
        ({"bounds": {"rmsc": 4}}, "did you mean 'rms_c'"),
        ({"basis": "bsplines", "degree": 3}, "the basis 'bsplines' needs its breaks"),
        (
            {"basis": "powers", "degree": 3, "continuity": 2},
            "has no continuity: leave it out, or take bsplines or periodic or pieces",
        ),
    ],
)
def test_entries_that_make_no_sense_are_refused(entries: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        asked(order=3, **entries)
