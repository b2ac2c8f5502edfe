"""Limits of a motor for a move: the torque of its drive over the stroke."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite

from optlaws.cycles.optimisation.motion_limits import tightest
from optlaws.cycles.optimisation.motor_limits import curve_lines
from optlaws.errors import InputError
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.quantity_kinds import Kind
from optlaws.numbers import NumberOrQuantity
from optlaws.synthesis.least_time.motor_torque import LossyGear, MotorTorque


def motor_torque(
    drive: Drive, start: NumberOrQuantity, stroke: NumberOrQuantity, limits: Mapping[Kind, tuple[float, float]]
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
    >>> torque = motor_torque(drive, "0 deg", "45 deg", {Kind.RMS_FORCE: (-2.0, 2.0)})
    >>> torque.inertia, torque.friction, torque.load, torque.peak, torque.rms
    ('1.15', 0.0, '0.0', 4.0, 2.0)
    """
    lines = curve_lines(drive.motor)
    greatest = min(drive.motor.peak_torque, max((torque for _, torque in drive.motor.curve), default=inf))
    within = tightest(limits, {Kind.FORCE: (-greatest, greatest)})
    known = (("torque", Kind.FORCE), ("rms torque", Kind.RMS_FORCE))
    most = {name: within[kind][1] for name, kind in known if kind in within and isfinite(within[kind][1])}
    if not most:
        raise InputError('nothing limits the torque: give limits={"torque": "3 N m"}, or a motor with a peak torque')
    moved = drive.dimensionless(start, stroke, 1.0)
    inertia, friction, coulomb = moved.of_motor
    to_load, back = drive.efficiencies
    gear = LossyGear(1.0 / to_load, back, inertia, friction, coulomb) if moved.train.loses else None
    return MotorTorque(
        moved.inertia if gear else _sum(inertia, moved.inertia),
        float(moved.friction) + (0.0 if gear else friction),
        moved.load if gear else _sum(coulomb, moved.load),
        moved.unit,
        most.get("torque"),
        most.get("rms torque"),
        gear,
        tuple((torque, -slope * drive.ratio * abs(moved.stroke)) for torque, slope in lines if slope),
    )


def _sum(number: float, formula: str) -> str:
    """A number and a formula, as one formula."""
    try:
        return repr(number + float(formula))
    except ValueError:
        return f"{number!r} + {formula}" if number else formula
