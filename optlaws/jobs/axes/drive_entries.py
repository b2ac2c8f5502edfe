"""The drive of an axis in a problem file: constants, a mechanism, or a motor with its gear before one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec

from optlaws.errors import InputError, located
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.axes import mechanism_entries  # noqa: F401 - by which the kind "cam" is known
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.motor import Motor, read_motors
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.mechanisms.linkages.mechanism_kinds import MechanismKind
from optlaws.suggest import unknown_key


class MotorDriveEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A motor and its gear before a mechanism: the entries of a `Drive`, and the file of the motors."""

    motor: Text | dict[str, Any]
    motors: Text | None = None
    ratio: float = 1.0
    efficiency: float | list[float] = 1.0
    inertia: str | float = 0.0
    regeneration: float = 0.0


def drive_of(
    mechanism: Mapping[str, Any] | None, drive: Mapping[str, Any] | None, folder: Path
) -> Mapping[str, Any] | Mechanism | Drive | None:
    """The drive of a cycle as an argument of `Cycle`: constants of a table, a mechanism, or a motor with one.

    Parameters
    ----------
    mechanism
        The table of a mechanism.
    drive
        The table of a drive: constants, or beside a mechanism its motor and gear.
    folder
        To which the path of the catalogue of motors is relative.

    Raises
    ------
    InputError
        If an entry is unknown, missing or wrong; the error names it.

    Examples
    --------
    >>> table = {"kind": "table", "inertia": "0.8 kg m^2"}
    >>> motor = {"inertia": "3e-4 kg m^2", "peak_torque": "6 N m"}
    >>> drive_of(table, {"motor": motor, "ratio": 20}, Path()).motor.peak_torque
    6.0
    """
    if mechanism is None:
        if drive is not None and {"motor", "motors", "ratio"} & drive.keys():
            raise InputError(
                "drive: a motor drives a mechanism: give the axis its table mechanism too, such as mechanism = "
                "{ kind = 'table', inertia = '0.8 kg m^2' }"
            )
        return drive
    with located("mechanism"):
        driven = MechanismKind.from_dict(mechanism).mechanism
    if drive is None:
        return driven
    if "motor" not in drive:
        raise InputError(
            "drive: beside a mechanism it has a motor, such as motor = { inertia = '3e-4 kg m^2' }; masses, springs "
            "and friction of the load are the mechanism's"
        )
    entries = convert(drive, MotorDriveEntries, Path("drive"))
    with located("drive"):
        given = msgspec.structs.asdict(entries)
        motor = _motor(given.pop("motor"), given.pop("motors"), folder)
        return Drive(driven, motor, **given)


def _motor(motor: str | Mapping[str, Any], catalogue: str | None, folder: Path) -> Motor:
    """The motor from a table of entries, or from a catalogue by its name."""
    if not isinstance(motor, str):
        if catalogue is not None:
            raise InputError("motors: the motor is given as a table: leave the catalogue out, or name a motor of it")
        with located("motor"):
            return Motor.from_dict(motor)
    if catalogue is None:
        raise InputError(
            f"motor: {motor!r} is one of a catalogue: give its file, such as motors = 'motors.toml', or give the motor "
            "as a table"
        )
    motors = read_motors(folder / catalogue)
    if motor not in motors:
        raise InputError(f"motor: {catalogue}: {unknown_key(motor, motors, 'motor')}")
    return motors[motor]
