"""The sheet of a motor over a whole cycle: the greatest of its moves, sums of their energies, margins to its limits."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from optlaws.cycles.cycle import Cycle
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.motor_motion import MotorMotion
from optlaws.mechanisms.drives.sheet import DriveSheet, drive_sheet
from optlaws.motion.piece import Piece


def motor_sheet(cycle: Cycle, drive: Drive) -> DriveSheet:
    """What a cycle asks of its motor; places are shares of the cycle.

    Examples
    --------
    >>> from optlaws import Dwell, Mechanism, Motor, Rise
    >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", rated_torque="2 N m"), ratio=20, efficiency=0.85)
    >>> index = Cycle(
    ...     [Rise("45 deg", "0.25 s", law="modified sine"), Dwell()], period="0.6 s", advance="45 deg", drive=drive
    ... )
    >>> sheet = motor_sheet(index, drive)
    >>> round(sheet.rms_torque, 6), round(sheet.rated_use, 6)
    (1.489759, 0.744879)
    """
    period = cycle.duration
    moves = [
        (piece, drive_sheet(_motion(piece, drive), drive.motor, period, drive.regeneration)) for piece in _moves(cycle)
    ]
    rests = [abs(float(drive.torque(piece.offset, 0.0, 0.0))) for piece in cycle.pieces if piece.stroke == 0.0]

    def greatest(name: str) -> float:
        return max((getattr(sheet, name) for _, sheet in moves), default=0.0)

    def place(of: Callable[[DriveSheet], tuple[float, float]]) -> float:
        """The share of the cycle at which the greatest of all moves is."""
        if not moves:
            return 0.0
        piece, sheet = max(moves, key=lambda move: of(move[1])[0])
        return (piece.start + of(sheet)[1] * piece.duration) / period

    driving, braking = (
        sum(getattr(sheet, name) for _, sheet in moves) for name in ("motoring_energy", "braking_energy")
    )
    mean_speed = sum(sheet.mean_speed for _, sheet in moves)
    effort = cycle.effort
    rated = float(drive.motor.continuous_at(mean_speed))
    return DriveSheet(
        peak_torque=effort.peak_force,
        peak_torque_at=place(lambda sheet: (sheet.peak_torque, sheet.peak_torque_at)),
        rms_torque=effort.rms_force,
        holding_torque=max(rests, default=0.0),
        peak_speed=greatest("peak_speed"),
        mean_speed=mean_speed,
        motoring_power=greatest("motoring_power"),
        braking_power=greatest("braking_power"),
        motoring_energy=driving,
        braking_energy=braking,
        energy=driving - drive.regeneration * braking,
        braking_heat=(1.0 - drive.regeneration) * braking / period,
        inertia_match=greatest("inertia_match"),
        curve_use=greatest("curve_use"),
        curve_use_at=place(lambda sheet: (sheet.curve_use, sheet.curve_use_at)),
        rated_use=effort.rms_force / rated if rated else float(np.inf) if effort.rms_force else 0.0,
        peak_limit=drive.motor.peak_torque,
        rated_limit=rated,
        speed_limit=drive.motor.greatest_speed,
    )


def _moves(cycle: Cycle) -> list[Piece]:
    return [piece for piece in cycle.pieces if piece.stroke != 0.0]


def _motion(piece: Piece, drive: Drive) -> MotorMotion:
    start = piece.offset - piece.stroke * float(piece.law.a(0.0))
    return MotorMotion(drive.mechanism, drive.train, drive.ratio, piece.law, start, piece.stroke, piece.duration)
