"""Files of limits of moves: each number, with its unit, is that of the drive and the move that they hold."""

from __future__ import annotations

from copy import deepcopy
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


@cache
def limits() -> dict[str, MoveLimit]:
    table = Mechanism("0.8 kg m^2")
    drive = Drive(table, MOTOR, ratio=20, efficiency=0.85)
    press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
    window = [("10 deg", "20 deg", "4 rad/s")]
    lifting = Mechanism("0.8 kg m^2", load="5 N m")
    return {
        "peak torque of a drive": drive.limit("peak torque", *MOVE),
        "energy of a drive": drive.limit("energy", *MOVE, limits={"acceleration": "80 rad/s^2"}),
        "time of a drive": drive.limit("time", *MOVE[:2]),
        "rms torque within a window": table.limit("rms torque", *MOVE, limits={"velocity": window}),
        "rms torque of a press": press.limit("rms torque", "0 deg", "180 deg", "0.3 s"),
        "energy with heat": table.limit("energy", *MOVE, limits={"torque": "60 N m"}, recovered=0.5, heat=0.1),
        "peak force of a slide": rack("20 mm", "5 kg").limit("peak torque", "0 rad", "1 rad", "0.5 s"),
        "proof that the time is short": proof_of(table, "rms torque", *MOVE, limits={"torque": "30 N m"}),
        "proof that the load is beyond": proof_of(lifting, "time", *MOVE[:2], limits={"torque": "4 N m"}),
    }


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


def test_each_limit_is_verified_and_read_again() -> None:
    for name, limit in limits().items():
        data = limit.to_dict()
        again = verify(data)
        assert again.proven, (name, *map(str, again.claims))
        assert again.bound == pytest.approx(limit.value, rel=1e-12), name
        assert MoveLimit.from_json(limit.to_json()) == limit, name


def test_each_statement_of_a_file_is_that_of_its_move() -> None:
    for name, limit in limits().items():
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
    one, other = (limits()[name].to_dict() for name in ("peak torque of a drive", "energy of a drive"))
    assert not verify({**one, "move": other["move"]}).proven
