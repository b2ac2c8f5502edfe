"""Least times in exact arithmetic: what is right is proven, and what was tampered with is not."""

import json
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest

from optlaws import InputError, Problem, fastest
from optlaws.verification import verify, verify_all

pytest.importorskip("flint")

LIMITS = {"velocity": "1 m/s", "acceleration": ("-8 m/s^2", "12 m/s^2"), "jerk": "300 m/s^3"}


@pytest.fixture(scope="module", params=[{}, {"start_velocity": "0.4 m/s", "end_velocity": "-0.1 m/s"}])
def data(request: pytest.FixtureRequest) -> dict[str, Any]:
    move = fastest(Problem(order=3), stroke="100 mm", limits=LIMITS, **request.param)
    read: dict[str, Any] = json.loads(move.to_json())
    return read


def test_the_law_and_that_none_is_faster_are_proven(data: dict[str, Any]) -> None:
    verification = verify(data)
    assert verification.proven
    names = [claim.name for claim in verification.claims]
    assert "the limit of the deceleration" in names
    assert any(name.startswith("no law in a time") for name in names)
    assert list(verify_all({"moves": [data]})) == ["moves[0]"]


def longer(data: dict[str, Any]) -> None:
    data["duration"] *= 1.001


def other_stroke(data: dict[str, Any]) -> None:
    data["stroke"] *= 0.999


def weaker_proof(data: dict[str, Any]) -> None:
    contacts = data["proofs"][-1]["certificate"]["contacts"]
    contacts.remove(max(contacts, key=lambda contact: float(contact["multiplier"])))


def further_claim(data: dict[str, Any]) -> None:
    data["torque"] = 3.0


@pytest.mark.parametrize("change", [longer, other_stroke, weaker_proof, further_claim])
def test_what_was_changed_is_not_proven(data: dict[str, Any], change: Callable[[dict[str, Any]], None]) -> None:
    changed = json.loads(json.dumps(data))
    change(changed)
    with suppress(InputError):
        assert not verify(changed).proven
