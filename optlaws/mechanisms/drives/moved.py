"""Moves of mechanisms and drives without dimensions, whose limits are computed in the phase plane."""

from __future__ import annotations

from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import DIMENSIONS, Mechanism, duration_of
from optlaws.mechanisms.linkages.move_limit import MOVED, LimitedMove, MovedKind, PhaseMove


def phase_move_of(move: LimitedMove) -> PhaseMove:
    """A move of a mechanism or a drive without dimensions, within what a motor allows."""
    drive = move.driven if isinstance(move.driven, Drive) else None
    if drive is None:
        assert isinstance(move.driven, Mechanism)  # noqa: S101 - no other moves
        drive = Drive.of_input(move.driven, move.recovered)
    moved = drive.dimensionless(move.start, move.stroke, duration_of(move.minimise, move.duration))
    dimensions = DIMENSIONS[drive.mechanism.axis]
    lines = [] if move.minimise == "peak torque" else drive.motor.peak_lines
    speed, torques = drive.motor.greatest_speed / drive.ratio, [(top, fall * drive.ratio) for top, fall in lines]
    return PhaseMove.within(moved, move, dimensions, speed, torques)


MOVED["mechanism"] = MovedKind(Mechanism, phase_move_of)
MOVED["drive"] = MovedKind(Drive, phase_move_of)
