"""The sheet that sizes the motor of a cycle: the load of all its motions and rests, with margins to the limits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import inf
from typing import ClassVar

import numpy as np

from optlaws.cycles.specification.drive import CycleDrive
from optlaws.cycles.specification.effort import Effort, PieceEffort
from optlaws.errors import InputError
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.motor import Motor
from optlaws.mechanisms.drives.sheet import DriveSheet, share_used
from optlaws.motion.piece import Piece
from optlaws.motion.smooth_parts import Greatest
from optlaws.numbers import Array
from optlaws.tolerances import VALUE_ROUNDING


@dataclass(frozen=True)
class CycleSheet(DriveSheet):
    """The motor's duty in a cycle, in SI units: a `DriveSheet` of all its motions, with places as times.

    Torques are above 0 towards greater positions; the holding torque is the greatest of all rests.

    Examples
    --------
    >>> from optlaws import Cycle, Drive, Dwell, Mechanism, Motor, Rise
    >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", rated_torque="2 N m"), ratio=20)
    >>> moves = [Rise("45 deg", "0.25 s", law="modified sine"), Dwell()]
    >>> sheet = Cycle(moves, period="0.6 s", advance="45 deg", drive=drive).sheet
    >>> round(sheet.rms_torque, 6), sheet.fits, {margin.name: round(margin.use, 6) for margin in sheet.margins}
    (1.458518, True, {'RMS torque': 0.729259})
    """

    _of: ClassVar[str] = "cycle"
    _at: ClassVar[str] = "s"


def cycle_sheet(drive: CycleDrive, along: Sequence[PieceEffort], effort: Effort, period: float) -> CycleSheet:
    """The sheet of a motor, from its values along each piece of a cycle and its effort over all pieces.

    Raises
    ------
    InputError
        If the drive has no motor.
    """
    source = drive.source
    if not isinstance(source, Drive):
        raise InputError("the cycle has no motor: give one, as drive=Drive(mechanism, Motor(...), ratio=20)")
    motor = source.motor
    speed = _greatest(along, _speed)
    use = _greatest(along, partial(_use, motor))
    mean_speed = sum(each.parts.integral(partial(_speed, each)) for each in along) / period
    rounding = VALUE_ROUNDING * effort.peak_force
    rests = [_holding(each) for each in along if not each.piece.stroke]
    holding = max(rests, key=abs, default=0.0)
    rated = float(motor.continuous_at(mean_speed))
    inertia = source.train.inertia
    return CycleSheet(
        *(effort.peak_force, effort.peak_force_at, effort.rms_force, holding if abs(holding) > rounding else 0.0),
        *(speed.value, mean_speed, effort.motoring_power, effort.braking_power),
        *(effort.motoring_energy, effort.braking_energy, effort.energy),
        *((1.0 - source.regeneration) * effort.braking_energy / period, effort.rms_force**2 * drive.copper),
        _greatest_inertia(drive, [each.piece for each in along]) / source.ratio**2 / inertia if inertia else inf,
        *((use.value, use.place) if motor.curve else (0.0, 0.0)),
        float(share_used(np.array(effort.rms_force), np.array(rated))),
        *(motor.peak_torque, rated, motor.greatest_speed),
    )


def _greatest(along: Sequence[PieceEffort], function: Callable[[PieceEffort, Array], Array]) -> Greatest:
    return max((each.parts.greatest(partial(function, each)) for each in along), key=lambda peak: peak.value)


def _holding(along: PieceEffort) -> float:
    """The torque of the greatest magnitude in a rest."""
    place = along.peak_force.place
    return float(along.force(np.array([place]))[0])


def _speed(along: PieceEffort, times: Array) -> Array:
    return np.abs(along.speed(times))


def _use(motor: Motor, along: PieceEffort, times: Array) -> Array:
    """The share of the motor's peak torque at its speed."""
    return share_used(np.abs(along.force(times)), motor.peak_at(along.speed(times)))


def _greatest_inertia(drive: CycleDrive, pieces: Sequence[Piece]) -> float:
    """The greatest inertia of the mechanism at the positions of a cycle."""
    reached = [value for piece in pieces for value, _ in piece.extremes(0, piece.start, piece.stop)]
    low, high = np.clip([min(reached), max(reached)], *drive.mechanism.over).tolist()
    return drive.mechanism.greatest_inertia(low, high)
