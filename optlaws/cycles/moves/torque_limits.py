"""Limits of a motor for a move: the torque of its drive over the stroke."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite
from typing import Any

from optlaws.cycles.optimisation.motor_limits import curve_lines
from optlaws.errors import InputError
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.quantities import positive_quantity, quantity
from optlaws.numbers import NumberOrQuantity
from optlaws.synthesis.least_time.motor_torque import LossyGear, MotorTorque

#: limits at the motor
TORQUES = ("torque", "rms torque")


def without_torques(drive: Drive, limits: Mapping[str, Any]) -> dict[str, Any]:
    """The limits of the input's motion, with the velocity that the motor's greatest speed leaves it.

    Raises
    ------
    InputError
        If the velocity is no quantity.

    Examples
    --------
    >>> from optlaws import Mechanism, Motor
    >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", greatest_speed="40 rad/s"), ratio=20)
    >>> without_torques(drive, {"torque": "3 N m", "velocity": "5 rad/s"})
    {'velocity': '2.0 rad/s'}
    """
    rest = {name: limit for name, limit in limits.items() if name not in TORQUES}
    fastest = drive.motor.greatest_speed / drive.ratio
    given = rest.get("velocity")
    if not isfinite(fastest):
        return rest
    if given is not None:
        last = given[-1] if isinstance(given, list | tuple) and given else given
        fastest = min(fastest, quantity(last, "angular velocity", "limits: velocity"))
    return rest | {"velocity": f"{fastest!r} rad/s"}


def motor_torque(
    drive: Drive, start: NumberOrQuantity, stroke: NumberOrQuantity, limits: Mapping[str, Any]
) -> MotorTorque:
    """The torque at the motor over a stroke of the mechanism's input, and its limit.

    Raises
    ------
    InputError
        If the stroke leaves the range of the mechanism, the motor's curve is not concave, nothing limits the torque, or
        the load alone is above the limit.

    Examples
    --------
    >>> from optlaws import Mechanism, Motor
    >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", peak_torque="4 N m"), ratio=20)
    >>> torque = motor_torque(drive, "0 deg", "45 deg", {"rms torque": "2 N m"})
    >>> torque.inertia, torque.friction, torque.load, torque.peak, torque.rms
    ('1.15', 0.0, '0.0', 4.0, 2.0)
    """
    most = {name: positive_quantity(limits[name], "torque", f"limits: {name}") for name in TORQUES if name in limits}
    if isfinite(drive.motor.peak_torque):
        most["torque"] = min(most.get("torque", drive.motor.peak_torque), drive.motor.peak_torque)
    lines = curve_lines(drive.motor)
    if lines:
        most["torque"] = min(most.get("torque", inf), max(torque for _, torque in drive.motor.curve))
    if not most:
        raise InputError('nothing limits the torque: give limits={"torque": "3 N m"}, or a motor with a peak torque')
    moved, train, i = drive.mechanism.dimensionless(start, stroke, 1.0), drive.train, drive.ratio
    unit, way = moved.unit / i, abs(moved.stroke)
    inertia, friction, coulomb = train.inertia * i * way / unit, train.viscous * i * way / unit, train.coulomb / unit
    to_load, back = drive.efficiencies
    gear = None if to_load == back == 1.0 else LossyGear(1.0 / to_load, back, inertia, friction, coulomb)
    return MotorTorque(
        moved.inertia if gear else _sum(inertia, moved.inertia),
        float(moved.friction) + (0.0 if gear else friction),
        moved.load if gear else _sum(coulomb, moved.load),
        unit,
        most.get("torque"),
        most.get("rms torque"),
        gear,
        tuple((torque, -slope * i * way) for torque, slope in lines if slope),
    )


def _sum(number: float, formula: str) -> str:
    """A number and a formula, as one formula."""
    try:
        return repr(number + float(formula))
    except ValueError:
        return f"{number!r} + {formula}" if number else formula
