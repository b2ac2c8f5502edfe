"""Files of limits of moves: each number, with its unit, is that of the drive and the move that they hold."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from functools import cache
from typing import Any

import pytest

from optlaws import Drive, InfeasibleProblem, InputError, Mechanism, Motor, MoveLimit, rack, slider_crank
from optlaws.verification import verify

MOVE = ("0 deg", "45 deg", "0.25 s")
MOTOR = Motor("3e-4 kg m^2", peak_torque="6 N m", greatest_speed="3000 rpm")


def proof_of(drive: Drive | Mechanism, *move: Any, **options: Any) -> MoveLimit:
    with pytest.raises(InfeasibleProblem) as caught:
        drive.limit(*move, **options)
    assert isinstance(caught.value.proof, MoveLimit)
    return caught.value.proof


TABLE = Mechanism("0.8 kg m^2")
DRIVE = Drive(TABLE, MOTOR, ratio=20, efficiency=0.85)
PRESS = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
WINDOW: dict[str, Any] = {"velocity": [("10 deg", "20 deg", "4 rad/s")]}
LIFTING = Mechanism("0.8 kg m^2", load="5 N m")
HEATED: dict[str, Any] = {"limits": {"torque": "60 N m"}, "recovered": 0.5, "heat": 0.1}

MADE: dict[str, Callable[[], MoveLimit]] = {
    "peak torque of a drive": lambda: DRIVE.limit("peak torque", *MOVE),
    "energy of a drive": lambda: DRIVE.limit("energy", *MOVE, limits={"acceleration": "80 rad/s^2"}),
    "time of a drive": lambda: DRIVE.limit("time", *MOVE[:2]),
    "rms torque within a window": lambda: TABLE.limit("rms torque", *MOVE, limits=WINDOW),
    "rms torque of a press": lambda: PRESS.limit("rms torque", "0 deg", "180 deg", "0.3 s"),
    "energy with heat": lambda: TABLE.limit("energy", *MOVE, **HEATED),
    "peak force of a slide": lambda: rack("20 mm", "5 kg").limit("peak torque", "0 rad", "1 rad", "0.5 s"),
    "proof that the time is short": lambda: proof_of(TABLE, "rms torque", *MOVE, limits={"torque": "30 N m"}),
    "proof that the load is beyond": lambda: proof_of(LIFTING, "time", *MOVE[:2], limits={"torque": "4 N m"}),
}


@cache
def limit_of(name: str) -> MoveLimit:
    return MADE[name]()


def changed(data: dict[str, Any], path: tuple[Any, ...], value: object) -> dict[str, Any]:
    other = deepcopy(data)
    inside: Any = other
    for key in path[:-1]:
        inside = inside[key]
    inside[path[-1]] = value
    return other


def noticed(data: dict[str, Any]) -> bool:
    try:
        return not verify(data).proven
    except InputError:
        return True


@pytest.mark.sample(9)
@pytest.mark.parametrize("name", MADE)
def test_each_limit_is_verified_and_read_again(name: str) -> None:
    limit = limit_of(name)
    data = limit.to_dict()
    again = verify(data)
    assert again.proven, (name, *map(str, again.claims))
    assert again.bound == pytest.approx(limit.value, rel=1e-12), name
    assert MoveLimit.from_json(limit.to_json()) == limit, name


@pytest.mark.sample(9)
@pytest.mark.parametrize("name", MADE)
def test_each_statement_of_a_file_is_that_of_its_move(name: str) -> None:
    limit = limit_of(name)
    data = limit.to_dict()
    wrong = {"unit": data["unit"] * 1.001, "dimension": "banana", "move": {}}
    for key, value in wrong.items():
        assert noticed(changed(data, (key,), value)), (name, key)
    move = data["move"]
    for key in ("stroke", "duration"):
        if move[key] is not None:
            assert noticed(changed(data, ("move", key), move[key] * 1.001)), (name, key)
    drive = ("drive", "mechanism") if "drive" in move else ("mechanism",)
    moved = move[drive[0]]["mechanism"] if len(drive) == 2 else move[drive[0]]
    assert noticed(changed(data, ("move", *drive, "inertia"), f"1.001*({moved['inertia']})")), name
    for key, other in (("value", 1.001), ("attained", 0.999)):
        if data["drive_limit"][key] is not None:
            assert noticed(changed(data, ("drive_limit", key), data["drive_limit"][key] * other)), (name, key)


def test_a_limit_of_another_drive_is_not_proven() -> None:
    one, other = (limit_of(name).to_dict() for name in ("peak torque of a drive", "energy of a drive"))
    assert not verify({**one, "move": other["move"]}).proven


def test_what_a_limit_does_not_use_is_not_in_its_file() -> None:
    for name, limit in zip(MADE, map(limit_of, MADE), strict=True):
        data = limit.to_dict()
        beside = {"heat", "recovered"} & data["move"].keys()
        of_drive = "drive" in data["move"]
        assert beside == (set() if data["move"]["minimise"] != "energy" else {"heat"} if of_drive else beside), name
        for key in {"heat", "recovered"} - beside:
            with pytest.raises(InputError, match=key):
                verify(changed(data, ("move", key), 0.1))
    with pytest.raises(InputError, match="recovered is a part of the energy that is minimised"):
        TABLE.limit("rms torque", *MOVE, recovered=0.5)
    with pytest.raises(InputError, match="recovered of a drive is its regeneration"):
        replace(limit_of("energy of a drive").move, recovered=0.5)


@pytest.mark.parametrize("name", ["peak torque of a drive", "energy with heat", "time of a drive"])
def test_no_number_stands_beside_a_certificate_that_proves_nothing(name: str) -> None:
    data = limit_of(name).to_dict()
    for key in ("level", "price", "near"):
        for value in (1e-3, 7.0):
            wrong = changed(data, ("drive_limit", key), data["drive_limit"][key] + value)
            assert noticed(wrong) or (verify(wrong).bound or 0.0) <= limit_of(name).attained, (name, key)
    pieces = len(data["drive_limit"]["edges"]) - 1
    broken = changed(data, ("drive_limit", "potential"), [[0.0] * 5] * pieces)
    assert noticed(broken), name
    assert noticed(changed(broken, ("drive_limit", "attained"), None)), name


def test_a_file_without_its_move_is_refused_with_a_remedy() -> None:
    for name, limit in zip(MADE, map(limit_of, MADE), strict=True):
        data = {key: value for key, value in limit.to_dict().items() if key != "move"}
        for read in (verify, MoveLimit.from_dict):
            with pytest.raises(
                InputError, match=r"did not store its mechanism and its move.*compute it again"
            ) as caught:
                read(data)
            assert len(str(caught.value)) < 300, name
