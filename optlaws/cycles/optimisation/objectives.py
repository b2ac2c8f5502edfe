"""The objective of a cycle, the limits of the whole, of its segments and of its motor, and the degree of its laws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, isfinite
from typing import TYPE_CHECKING, Any

from optlaws.cycles.specification.limits import MOTOR, Limits, LoadOutput, load_output, read_limits, tightest
from optlaws.cycles.specification.load import Load
from optlaws.cycles.specification.programme import Programme
from optlaws.echo import unknown_key
from optlaws.errors import InputError
from optlaws.motion.quantities import Kind
from optlaws.tolerances import AGREEMENT

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.drive_train import Drive
    from optlaws.mechanisms.drives.motor import Motor

#: what is summed over the motions of a cycle as it is
SUMS = (Kind.ENERGY, Kind.HEAT)
#: what may be least over a cycle, and whether it is its root mean square
OBJECTIVES = {
    "velocity": (Kind.VELOCITY, False),
    "acceleration": (Kind.ACCELERATION, False),
    "jerk": (Kind.JERK, False),
    "rms acceleration": (Kind.ACCELERATION, True),
    "rms jerk": (Kind.JERK, True),
    "rms snap": (Kind.SNAP, True),
    "force": (Kind.FORCE, False),
    "torque": (Kind.FORCE, False),
    "power": (Kind.POWER, False),
    "rms force": (Kind.FORCE, True),
    "rms torque": (Kind.FORCE, True),
    "energy": (Kind.ENERGY, False),
    "heat": (Kind.HEAT, False),
}


@dataclass(frozen=True)
class CycleObjective:
    """The objective of a cycle, from `OBJECTIVES`, the limits of the whole in SI units, and the degree of its laws.

    Of the limits the root mean square of the force, the energy and those of the load are of the whole cycle, the others
    of each segment.
    """

    minimise: str
    limits: Limits
    order: int
    degree: int
    drive: Drive | None
    axis: str
    load: Load | None

    @property
    def kind(self) -> Kind:
        return kind_of(self.minimise)[0]

    @property
    def mean(self) -> bool:
        return kind_of(self.minimise)[1]

    @property
    def mean_force(self) -> float | None:
        """The limit of the root mean square of the force over the whole cycle."""
        return self.limits.get(Kind.RMS_FORCE, (None, None))[1]

    @property
    def energy(self) -> float | None:
        """The limit of the energy over the whole cycle."""
        return self.limits.get(Kind.ENERGY, (None, None))[1]

    @property
    def shares(self) -> bool:
        """Whether a limit is of the whole cycle, so that its motions share it."""
        return self.mean_force is not None or self.energy is not None

    @property
    def loaded(self) -> dict[LoadOutput, float]:
        return {output: most for output, (_, most) in self.limits.items() if isinstance(output, LoadOutput)}

    @property
    def of_load(self) -> bool:
        """Whether the load is spoken of, so that the cycle is one problem."""
        return bool(self.loaded) or self.kind is Kind.LOAD


def kind_of(minimise: str) -> tuple[Kind, bool]:
    """The kind of the minimised quantity, and whether its root mean square is minimised.

    >>> kind_of("rms jerk"), kind_of("load acceleration")
    ((<Kind.JERK: 3>, True), (<Kind.LOAD: -2>, False))
    """
    return OBJECTIVES.get(minimise, (Kind.LOAD, minimise.startswith("rms ")))


def check_objective(minimise: Any, load: Load | None) -> None:
    """Refuse objectives that cannot be minimised."""
    if not isinstance(minimise, str) or (minimise not in OBJECTIVES and load_output(minimise, load) is None):
        raise InputError(f"minimise: {unknown_key(minimise, (*OBJECTIVES, 'load acceleration'), 'objective')}")


def limits_of_cycle(entries: Mapping[str, Any], programme: Programme, drive: Drive | None, load: Load | None) -> Limits:
    """The limits of a cycle, and those of its motor if the cycle is required to keep them.

    The continuous torque is that at the mean speed, which no law that never turns back changes.

    Raises
    ------
    InputError
        If a limit is wrong, there is no motor, or its curve of torque over speed is not concave.
    """
    limits = read_limits(entries, programme.axis, "limits", load)
    if not entries.get(MOTOR):
        return limits
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
    return tightest(limits, {kind: (-most, most) for kind, most in known.items() if isfinite(most)})


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
