"""Least times in exact arithmetic: what is right is proven, and what was tampered with is not."""

import json
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import Drive, InputError, Mechanism, Motor, Problem, fastest
from optlaws.verification import Claim, verify, verify_all
from tests.internals.synthesis import MoveLimits, TimedMove
from tests.internals.verification import least_time_of_any_law

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
    assert "the best possible time" in names
    assert verification.unchecked == ()
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


def random_moves(numbers: np.random.Generator, count: int) -> list[TimedMove]:
    """Moves of every order in units of any size, some limits left out, some with velocities at their ends."""
    moves: list[TimedMove] = []
    while len(moves) < count:
        order, unit = int(numbers.integers(1, 5)), 10.0 ** numbers.uniform(-9.0, 9.0)
        names = ("velocity", "acceleration", "deceleration", "jerk", "snap")
        most = {name: unit * 10.0 ** numbers.uniform(-2.0, 2.0) for name in names if numbers.random() < 0.6}
        ends = unit * numbers.uniform(-1.0, 1.0, 2) * (order > 1) * (numbers.random() < 0.5)
        with suppress(InputError):
            stroke = unit * 10.0 ** numbers.uniform(-2.0, 2.0)
            moves.append(TimedMove(Problem(order=order), stroke, MoveLimits(**most), *ends.tolist()))
    return moves


def test_the_limit_of_all_laws_is_proven_in_every_unit_and_with_every_limit() -> None:
    for move in random_moves(np.random.default_rng(3), 120):
        known, proven = move.best_possible, least_time_of_any_law(move)
        assert (known is None) == (proven is None), move
        assert known is None or float(proven or 0) == pytest.approx(known, rel=1e-13, abs=0.0), move


@pytest.fixture(scope="module")
def table() -> Drive:
    motor = Motor("3e-4 kg m^2", peak_torque="4 N m", greatest_speed="900 rpm")
    return Drive(Mechanism("0.8 kg m^2", "20 N m"), motor, ratio=20)


def limit_of_all_laws(data: dict[str, Any]) -> Claim:
    known = verify(data)
    (claim,) = (claim for claim in (*known.claims, *known.unchecked) if claim.name == "the best possible time")
    return claim


@pytest.mark.parametrize(
    ("limits", "how"), [({}, "phase plane"), ({"velocity": "0.5 rad/s", "jerk": "20 rad/s^3"}, "segments")]
)
def test_a_limit_within_a_torque_is_proven_by_the_phase_plane_where_the_torque_binds(
    table: Drive, limits: dict[str, str], how: str
) -> None:
    turn = fastest(Problem(order=3), stroke="45 deg", limits=limits, drive=table)
    claim = limit_of_all_laws(json.loads(turn.to_json()))
    assert claim.proven
    assert claim.detail.endswith(how)


def test_a_limit_above_what_the_potential_proves_is_not_proven(table: Drive) -> None:
    data = json.loads(fastest(Problem(order=3), stroke="45 deg", limits={}, drive=table).to_json())
    data["best_possible"] *= 1.0 + 5e-6
    claim = limit_of_all_laws(data)
    assert (claim.proven, claim.checked) == (False, False)
    assert "conic program" in claim.detail


def test_the_phase_plane_proves_no_more_than_the_motion_of_the_closed_form(table: Drive) -> None:
    """Where inertia and load are constant, the fastest motion has the greatest torque one way, then the other."""
    quick = replace(table, motor=replace(table.motor, greatest_speed="9000 rpm"))
    turn = fastest(Problem(order=3), stroke="45 deg", limits={}, drive=quick)
    inertia, up, down = 0.8 + 3e-4 * 400.0, 80.0 - 20.0, 80.0 + 20.0
    far, (speeding, braking) = np.pi / 4.0, (up / inertia, down / inertia)
    shortest = np.sqrt(2.0 * far * (1.0 / speeding + 1.0 / braking))
    proven = float(limit_of_all_laws(json.loads(turn.to_json())).detail.split(" stated, ")[1].split()[0])
    assert proven == pytest.approx(shortest, rel=1e-5)
    assert proven <= shortest * (1.0 + 1e-12)
