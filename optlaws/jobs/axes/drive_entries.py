"""The drive of an axis in a problem file: constants, a mechanism, or a motor with its gear before one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from optlaws.cams import at_shaft  # noqa: F401 - by which the kind "cam" is known
from optlaws.entries.value_types import Text
from optlaws.errors import InputError, located
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.motor import read_motors
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.mechanisms.linkages.mechanism_kinds import MechanismKind
from optlaws.suggest import unknown_key


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
    given = dict(drive)
    with located("drive"):
        given["motor"] = _motor(given["motor"], given.pop("motors", None), folder)
        return Drive.from_dict({"mechanism": driven, **given})


def _motor(motor: Any, catalogue: Any, folder: Path) -> Any:
    """The table of a motor, or the motor of a catalogue that its name says."""
    if not isinstance(motor, str):
        if catalogue is not None:
            raise InputError("motors: the motor is given as a table: leave the catalogue out, or name a motor of it")
        return motor
    if catalogue is None:
        raise InputError(
            f"motor: {motor!r} is one of a catalogue: give its file, such as motors = 'motors.toml', or give the motor "
            "as a table"
        )
    motors = read_motors(folder / Text().read(catalogue, "motors"))
    if motor not in motors:
        raise InputError(f"motor: {catalogue}: {unknown_key(motor, motors, 'motor')}")
    return motors[motor]
