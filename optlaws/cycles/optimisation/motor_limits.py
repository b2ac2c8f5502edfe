"""The limits of a motor as limits of a cycle: its torques, its speed, and its curve of torque over speed."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite
from typing import TYPE_CHECKING, Any

from optlaws.cycles.optimisation.drive_formulas import Driven, branches_of, known_drive, may_turn
from optlaws.cycles.optimisation.motion_limits import Limits
from optlaws.cycles.specification.joints import LawSpan
from optlaws.cycles.specification.programme import Programme
from optlaws.errors import InputError
from optlaws.motion.piece import factor
from optlaws.motion.quantity_kinds import Kind
from optlaws.synthesis.functionals.makers import peak
from optlaws.synthesis.problem.constants import Functional
from optlaws.tolerances import AGREEMENT

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.drive_train import Drive
    from optlaws.mechanisms.drives.motor import Motor

MOTOR = "motor"


def motor_limits(entries: Mapping[str, Any], drive: Drive | None, programme: Programme) -> Limits:
    """The limits of the motor, if the cycle is required to keep them.

    The continuous torque is that at the mean speed, which no law that never turns back changes.

    Raises
    ------
    InputError
        If there is no motor, or its curve of torque over speed is not concave.
    """
    if not entries.get(MOTOR):
        return {}
    if drive is None or not drive.has_motor:
        raise InputError("limits, motor: there is no motor: give one, as drive=Drive(mechanism, Motor(...), ratio=20)")
    motor, ratio = drive.motor, drive.ratio
    way = sum(abs(stretch.displacement) for stretch in programme.stretches)
    known = {
        Kind.FORCE: motor.peak_torque,
        Kind.VELOCITY: motor.greatest_speed / ratio,
        Kind.CURVE: 1.0 if curve_lines(motor) else inf,
        Kind.RMS_FORCE: float(motor.continuous_at(ratio * way / programme.period)),
    }
    return {kind: (-most, most) for kind, most in known.items() if isfinite(most)}


def check_rating(entries: Mapping[str, Any], drive: Drive | None) -> None:
    """Refuse a continuous torque over the speed where the time, and with it the mean speed, is looked for."""
    if entries.get(MOTOR) is True and drive is not None and drive.motor.continuous:
        raise InputError(
            "limits, motor: its continuous torque follows the speed, which is unknown: give a rated torque in place of "
            'that curve, or limits={"rms torque": "2 N m"} beside a motor without it'
        )


def curve_lines(motor: Motor) -> list[tuple[float, float]]:
    """The lines below which the curve of peak torque is: the torque at rest, and its slope over the speed."""
    lines = motor.curve_lines
    reached = AGREEMENT * max((torque for _, torque in motor.curve), default=0.0)
    if any(torque < min(rest - fall * speed for rest, fall in lines) - reached for speed, torque in motor.curve):
        raise InputError(
            "limits, motor: its curve of torque over speed bends upwards, and what is below it is not convex: give a "
            "curve below it that does not, or limits of torque and velocity"
        )
    return [(rest, 0.0 - fall) for rest, fall in lines]


def torque_at_rest(drive: Drive) -> float:
    """The torque that the curve of a drive's motor allows at rest; infinite without a curve."""
    return min((torque for torque, _ in curve_lines(drive.motor)), default=inf)


def driven_curve(span: LawSpan, drive: Drive | None, stroke: float) -> Driven:
    """The share of the motor's curve that a span's law uses: at most 1 where the motor can."""
    known = known_drive(drive)
    speed = known.ratio * abs(factor(stroke, span.duration, 1))
    torque, back, unit = branches_of(span, known, stroke)
    constants: list[Functional] = []
    for at_rest, slope in curve_lines(known.motor):
        share, falls = unit / at_rest, slope * speed / at_rest
        if not falls and not known.train.loses:
            constants.append(peak(f"{share!r}*({torque})"))
            continue
        for fall in (falls, -falls) if may_turn(span) else (falls,):
            constants.append(peak(f"{share!r}*({torque}) + {-fall!r}*b", side="high"))
            constants.append(peak(f"{share!r}*({back}) + {fall!r}*b", side="low"))
    return Driven(tuple(constants), 1.0, exact=not known.train.loses or known.brakes_as_it_drives)
