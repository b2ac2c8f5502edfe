"""The force or torque of a drive along a cycle, its power, and the energies of motoring and braking."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import sqrt
from typing import Any, Protocol

import numpy as np

from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.branches import corners
from optlaws.formulas.tree import Formula, table_places
from optlaws.kept import kept_property
from optlaws.laws.storage import PlainNumbers
from optlaws.mechanisms.drives.motor import Motor
from optlaws.mechanisms.linkages.dimensionless import Train
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantity_kinds import Kind
from optlaws.motion.smooth_parts import Greatest, SmoothParts
from optlaws.numbers import Array
from optlaws.tolerances import VALUE_ROUNDING


class AnyDrive(Protocol):
    """A `Drive`, which knows this module."""

    @property
    def mechanism(self) -> Mechanism:
        """The mechanism whose input moves."""

    @property
    def motor(self) -> Motor:
        """The motor with its limits."""

    @property
    def train(self) -> Train:
        """Motor and gear in numbers."""

    def torque(
        self, position: Any, velocity: Any, acceleration: Any, process: Any = 0.0, *, direction: Any, time: Any
    ) -> Any:
        """The torque at the motor."""


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

    drive: AnyDrive
    piece: Piece
    ends: tuple[float, float] | None = None

    def force(self, times: Array) -> Array:
        """The force or torque."""
        x, v, w = (self.piece.values(times, nu) for nu in range(3))
        direction = self.piece.direction(times)
        return np.asarray(self.drive.torque(x, v, w, direction=direction, time=times), dtype=np.float64)

    def power(self, times: Array) -> Array:
        """Force times velocity: at the motor, torque times its speed."""
        return self.force(times) * self.speed(times)

    def speed(self, times: Array) -> Array:
        """The velocity at which the force acts: at the motor, its speed."""
        return self.drive.train.ratio * self.piece.values(times, 1)

    def _before_gear(self, times: Array) -> Array:
        """The torque at the mechanism's input, which turns where the power through a gear does."""
        x, v, w = (self.piece.values(times, nu) for nu in range(3))
        return np.asarray(self.drive.mechanism.torque(x, v, w, self.piece.direction(times), time=times))

    def _bend(self, switch: Formula, times: Array) -> Array:
        """A formula of the position and the time, at whose zeros the load bends."""
        values = evaluate(switch, {"x": self.piece.values(times, 0), "t": times}, NUMPY)
        return np.broadcast_to(np.asarray(values, dtype=np.float64), np.shape(times))

    @kept_property
    def parts(self) -> SmoothParts:
        """Parts of the piece on which force and power are smooth and of one sign."""
        piece, load = self.piece, self.drive.mechanism.load_formula
        places = (piece.start + piece.duration * place for place in piece.law.breaks)
        breaks = [*places, *piece.turns, *table_places(load, "t")]
        signs: list[Callable[[Array], Array]] = []
        if piece.stroke:
            signs = [partial(self._bend, switch) for switch in corners(load, "xt")]
            signs += [*([self._before_gear] if self.drive.train.loses else []), self.force]
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
        return given - self.drive.train.regeneration * taken

    @property
    def heat(self) -> float:
        """The copper heat and the energy that is taken back and not fed back, J."""
        return self.drive.train.copper * self.square + (1.0 - self.drive.train.regeneration) * self.energies[1]

    @property
    def square(self) -> float:
        """The integral of the square of the force."""
        return self.parts.integral(lambda times: self.force(times) ** 2)


def effort(along: Sequence[PieceEffort], period: float) -> Effort:
    """The force and power of a drive over a cycle, from its values along each piece.

    >>> from optlaws import smoothstep
    >>> from optlaws import Drive, Mechanism, Motor
    >>> drive = Drive(Mechanism("2 kg m^2"), Motor(0.0))
    >>> rise = Piece(0.0, 1.0, 0.0, 1.0, smoothstep(2))
    >>> known = effort([PieceEffort(drive, rise)], 1.0)
    >>> round(known.peak_force, 9), round(known.motoring_energy, 9)
    (12.0, 2.25)
    """
    regeneration = along[0].drive.train.regeneration
    peak = max((each.peak_force for each in along), key=lambda greatest: greatest.value)
    given, taken = (max(powers) for powers in zip(*(each.powers for each in along), strict=True))
    driving, braking = (sum(energies) for energies in zip(*(each.energies for each in along), strict=True))
    power, mean = max(given, taken), (driving - braking) / period
    return Effort(
        *(peak.value, peak.place, sqrt(sum(each.square for each in along) / period)),
        *(power, mean if abs(mean) > VALUE_ROUNDING * power else 0.0),
        *(given, taken, driving, braking, driving - regeneration * braking),
    )


def size_of(piece: Piece, kind: Kind, drive: AnyDrive | None, *, mean: bool = False) -> float:
    """The peak or RMS of a derivative, or of the force or power of a drive, in a piece, in SI units."""
    nu = kind.order
    if nu or drive is None:
        if not piece.stroke:
            return 0.0
        constant = piece.law.rms(nu) if mean else piece.law.peak(nu).value
        return constant * abs(factor(piece.stroke, piece.duration, nu))
    along = PieceEffort(drive, piece)
    if kind is Kind.POWER:
        return max(along.powers)
    return sqrt(along.square / piece.duration) if mean else along.peak_force.value
