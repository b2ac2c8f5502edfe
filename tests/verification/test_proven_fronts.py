"""Proven fronts in exact arithmetic: what is right is proven, and what was tampered with is not."""

import json
from collections.abc import Callable
from typing import Any

import pytest

from optlaws import InputError, Problem, proven_front
from optlaws.verification import verify, verify_all
from tests.sampling import sampled

REST = Problem(order=4)
MIXED = Problem(order=4, B=1.8, minimise="C/4 + rms_c/3.4641")


def written(problem: Problem, over: Any, between: tuple[float, float], gap: float = 1e-3) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(json.dumps(proven_front(problem, over, between=between, gap=gap).to_dict()))
    return data


@pytest.mark.parametrize(
    ("problem", "over", "between"),
    sampled(
        [
            (REST, ("B", "C"), (1.5, 1.7)),
            (REST, ("J", "C"), (60.0, 90.0)),
            (REST, ("at_most.B", "C"), (1.2, 1.7)),
            (Problem(order=4, B=1.9), ("rms_c", "C"), (3.98, 4.2)),
            (Problem(order=4, minimise="rms_c"), "B", (1.7, 1.8)),
            (MIXED, "weight of rms_c", (0.05, 0.6)),
        ]
    ),
)
def test_a_front_is_proven_between_its_laws(problem: Problem, over: Any, between: tuple[float, float]) -> None:
    data = written(problem, over, between)
    verification = verify(data)
    assert verification.proven
    assert verification.gap is not None
    assert verification.gap <= data["gap"] * (1.0 + 1e-6)
    assert f"from {between[0]!r} to {between[1]!r}" in str(verification)
    assert list(verify_all({"fronts": [data]})) == ["fronts[0]"]


def heaviest(contacts: list[dict[str, Any]]) -> dict[str, Any]:
    return max(contacts, key=lambda contact: float(contact["multiplier"]))


def other_law(data: dict[str, Any]) -> None:
    data["points"][3]["law"]["acceleration"][1] *= 1.0 + 1e-6


def greater_gap(data: dict[str, Any]) -> None:
    data["points"] = data["points"][::4]


def weaker_proofs(data: dict[str, Any]) -> None:
    # of one alone the bounds beside it hold in its place
    for point in data["points"]:
        point["contacts"].remove(heaviest(point["contacts"]))


def negative_multiplier(data: dict[str, Any]) -> None:
    heaviest(data["points"][2]["contacts"])["multiplier"] *= -1.0


def other_problem(data: dict[str, Any]) -> None:
    data["problem"]["order"] = 5


@pytest.mark.parametrize(
    "tamper", sampled([other_law, greater_gap, weaker_proofs, negative_multiplier, other_problem], 2)
)
def test_a_front_that_was_tampered_with_is_not_proven(tamper: Callable[[dict[str, Any]], None]) -> None:
    data = written(REST, ("B", "C"), (1.5, 1.7))
    tamper(data)
    assert not verify(data).proven


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"runs": "D"}, "D is not convex"),
        ({"gap": "small"}, "gap"),
        ({"more": 1}, "unknown field `more`"),
        ({"points": []}, "at least two certified laws"),
        ({"problem": {"order": 4, "J": [50.0, None]}}, "bounded from below"),
    ],
)
def test_what_is_no_proven_front_is_refused(change: dict[str, Any], message: str) -> None:
    data = written(REST, ("B", "C"), (1.5, 1.6)) | change
    with pytest.raises(InputError, match=message):
        verify(data)
