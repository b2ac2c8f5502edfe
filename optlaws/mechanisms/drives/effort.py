"""The force or torque of a drive along a cycle, its power, and the energies of motoring and braking."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import sqrt
from typing import Protocol

import numpy as np

from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.branches import corners
from optlaws.formulas.tree import Formula
from optlaws.kept import kept_property
from optlaws.laws.storage import PlainNumbers
from optlaws.motion.piece import Piece, factor
from optlaws.motion.smooth_parts import Greatest, SmoothParts
from optlaws.numbers import Array
from optlaws.tolerances import VALUE_ROUNDING

FORCE, POWER = -1, -3


class TorqueAlong(Protocol):
    """The torque or force of a drive along pieces of a motion, in SI units, above 0 towards greater positions."""

    @property
    def speed_ratio(self) -> float:
        """The ratio of the speed at which it acts to that of the motion."""

    @property
    def regeneration(self) -> float:
        """The share of the braking energy that is fed back."""

    @property
    def copper(self) -> float:
        """The copper heat by the squared torque, W/(N m)²."""

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times at which it has kinks."""

    def along(self, piece: Piece, times: Array) -> Array:
        """The torque or force at times in a piece."""

    def kinks(self, piece: Piece) -> list[Callable[[Array], Array]]:
        """Functions of the time at whose zeros the torque has kinks."""


def bends(loads: Iterable[Formula], piece: Piece) -> list[Callable[[Array], Array]]:
    """Functions of the time at whose zeros loads over the position x and the time t have kinks."""
    return [partial(_along_way, switch, piece) for load in loads for switch in corners(load, "xt")]


def _along_way(formula: Formula, piece: Piece, times: Array) -> Array:
    values = evaluate(formula, {"x": piece.values(times, 0), "t": times}, NUMPY)
    return np.broadcast_to(np.asarray(values, dtype=np.float64), np.shape(times))


@dataclass(frozen=True)
class Effort(PlainNumbers):
    """The force and power of a drive over a cycle, in SI units.

    Attributes
    ----------
    peak_force, peak_force_at
        The greatest magnitude of the force, or of the torque of a table, at the follower, or at the motor; and its
        time.
    rms_force
        Its root mean square over the cycle.
    peak_power
        The greatest magnitude of the power; divided by the master's angular velocity it is the greatest torque that
        the motion requires of the master's shaft.
    mean_power
        What friction takes.
    motoring_power, braking_power
        The greatest power that the drive gives, and that it takes back, both at least 0.
    motoring_energy, braking_energy
        Of a cycle, J, both at least 0.
    energy
        Of a cycle: what is fed back is subtracted.
    """

    peak_force: float
    peak_force_at: float
    rms_force: float
    peak_power: float
    mean_power: float
    motoring_power: float
    braking_power: float
    motoring_energy: float
    braking_energy: float
    energy: float

    def shaft_torque(self, angular_velocity: float) -> float:
        """The greatest torque at a shaft of constant angular velocity, rad/s."""
        return self.peak_power / angular_velocity


@dataclass(frozen=True)
class SegmentEffort:
    """The drive's force, power and energy in a segment of a cycle, in SI units.

    Attributes
    ----------
    name
        Of the segment.
    peak_force, rms_force
        Greatest magnitude and root mean square of the force, or of the torque.
    motoring_power, braking_power
        Greatest, both at least 0.
    motoring_energy, braking_energy
        J, both at least 0.
    """

    name: str
    peak_force: float
    rms_force: float
    motoring_power: float
    braking_power: float
    motoring_energy: float
    braking_energy: float


@dataclass(frozen=True, eq=False)
class PieceEffort:
    """The drive's force, power and energy along a piece, or between two times in it, in SI units."""

    drive: TorqueAlong
    piece: Piece
    ends: tuple[float, float] | None = None

    def of_drive(self, drive: TorqueAlong) -> PieceEffort:
        """The same effort by a drive whose torque is the same, with what is known of it."""
        other = replace(self, drive=drive)
        vars(other).update({**vars(self), "drive": drive})
        return other

    def force(self, times: Array) -> Array:
        """The force or torque."""
        return self.drive.along(self.piece, times)

    def power(self, times: Array) -> Array:
        """Force times velocity: at the motor, torque times its speed."""
        return self.force(times) * self.speed(times)

    def speed(self, times: Array) -> Array:
        """The velocity at which the force acts: at the motor, its speed."""
        return self.drive.speed_ratio * self.piece.values(times, 1)

    @kept_property
    def parts(self) -> SmoothParts:
        """Parts of the piece on which force and power are smooth and of one sign."""
        piece = self.piece
        places = (piece.start + piece.duration * place for place in piece.law.breaks)
        breaks = [*places, *piece.turns, *self.drive.breaks]
        signs: list[Callable[[Array], Array]] = []
        if piece.stroke:
            signs = [*self.drive.kinks(piece), self.force]
        start, stop = self.ends or (piece.start, piece.stop)
        inside = [time for time in breaks if start < time < stop]
        return SmoothParts.between(start, stop, breaks=inside, signs=signs)

    def of_segment(self, name: str) -> SegmentEffort:
        """Peaks, the root mean square and the energies, of a segment of this name."""
        start, stop = self.ends or (self.piece.start, self.piece.stop)
        rms = sqrt(self.square / (stop - start))
        return SegmentEffort(name, self.peak_force.value, rms, *self.powers, *self.energies)

    @kept_property
    def peak_force(self) -> Greatest:
        """The greatest magnitude of the force, and its time."""
        return self.parts.greatest(lambda times: np.abs(self.force(times)))

    @kept_property
    def powers(self) -> tuple[float, float]:
        """The greatest power that is given, and that is taken back, both at least 0."""
        given, taken = self.parts.greatest(self.power), self.parts.greatest(lambda times: -self.power(times))
        return max(0.0, given.value), max(0.0, taken.value)

    @kept_property
    def energies(self) -> tuple[float, float]:
        """The energy that is given, and that is taken back, both at least 0, J."""
        times, weights = self.parts.places
        powers = self.power(times)
        return float(weights @ np.maximum(powers, 0.0)), float(weights @ np.maximum(-powers, 0.0))

    @property
    def energy(self) -> float:
        """The energy that is given less the share of it that is fed back, J."""
        given, taken = self.energies
        return given - self.drive.regeneration * taken

    @property
    def heat(self) -> float:
        """The copper heat and the energy that is taken back and not fed back, J."""
        return self.drive.copper * self.square + (1.0 - self.drive.regeneration) * self.energies[1]

    @property
    def square(self) -> float:
        """The integral of the square of the force."""
        return self.parts.integral(lambda times: self.force(times) ** 2)


def effort(along: Sequence[PieceEffort], period: float) -> Effort:
    """The force and power of a drive over a cycle, from its values along each piece.

    >>> from optlaws import smoothstep
    >>> from optlaws import Mechanism, Motor
    >>> from optlaws.mechanisms.drives.drive_train import Drive, MotorTorque
    >>> drive = MotorTorque(Drive(Mechanism("2 kg m^2"), Motor(0.0)))
    >>> rise = Piece(0.0, 1.0, 0.0, 1.0, smoothstep(2))
    >>> known = effort([PieceEffort(drive, rise)], 1.0)
    >>> round(known.peak_force, 9), round(known.motoring_energy, 9)
    (12.0, 2.25)
    """
    regeneration = along[0].drive.regeneration
    peak = max((each.peak_force for each in along), key=lambda greatest: greatest.value)
    given, taken = (max(powers) for powers in zip(*(each.powers for each in along), strict=True))
    driving, braking = (sum(energies) for energies in zip(*(each.energies for each in along), strict=True))
    power, mean = max(given, taken), (driving - braking) / period
    return Effort(
        *(peak.value, peak.place, sqrt(sum(each.square for each in along) / period)),
        *(power, mean if abs(mean) > VALUE_ROUNDING * power else 0.0),
        *(given, taken, driving, braking, driving - regeneration * braking),
    )


def size_of(piece: Piece, nu: int, drive: TorqueAlong | None, *, mean: bool = False) -> float:
    """The peak or RMS of a derivative, or of the force (-1) or power (-3) of a drive, in a piece, in SI units."""
    if nu > 0 or drive is None:
        if not piece.stroke:
            return 0.0
        constant = piece.law.rms(nu) if mean else piece.law.peak(nu).value
        return constant * abs(factor(piece.stroke, piece.duration, nu))
    along = PieceEffort(drive, piece)
    if nu == POWER:
        return max(along.powers)
    return sqrt(along.square / piece.duration) if mean else along.peak_force.value
