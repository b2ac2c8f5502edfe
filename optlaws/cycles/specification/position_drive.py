"""Mechanisms whose inertia and load vary with the position, and motors with gears before them, as drives of a cycle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from optlaws.cycles.specification.process import ProcessForce
from optlaws.errors import InputError
from optlaws.formulas.tree import Number
from optlaws.mechanisms.drives.drive_train import DimensionlessDrive, Drive
from optlaws.mechanisms.linkages.dimensionless import DimensionlessMechanism
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.piece import Piece
from optlaws.numbers import Array
from optlaws.tolerances import TINY, VALUE_ROUNDING


@dataclass(frozen=True)
class PositionDrive:
    """The torque or force at the input of a mechanism, or at the motor that drives it, in SI units.

    The motion of the cycle is that of the mechanism's input.
    """

    source: Mechanism | Drive
    process: ProcessForce | None = None

    @property
    def mechanism(self) -> Mechanism:
        """The mechanism whose input moves."""
        return self.source.mechanism if isinstance(self.source, Drive) else self.source

    @property
    def dry(self) -> float:
        """The greatest friction that changes sign with the velocity; 0 without friction."""
        motor = self.source.train.coulomb if isinstance(self.source, Drive) else 0.0
        return self.mechanism.coulomb + motor

    @property
    def loses(self) -> bool:
        """Whether a gear loses power, so that the torque at the motor is the greater of two."""
        return isinstance(self.source, Drive) and self.source.efficiencies != (1.0, 1.0)

    @property
    def regeneration(self) -> float:
        """The share of the braking energy that is fed back; none without a motor."""
        return self.source.regeneration if isinstance(self.source, Drive) else 0.0

    @property
    def copper(self) -> float:
        """The copper heat of the motor by its squared torque, W/(N m)²; 0 without a motor constant."""
        return self.source.motor.constant**-2 if isinstance(self.source, Drive) else 0.0

    @property
    def speed_ratio(self) -> float:
        """The ratio of the motor's speed to the speed of the mechanism's input; 1 without a motor."""
        return self.source.ratio if isinstance(self.source, Drive) else 1.0

    def kinks(self, piece: Piece) -> list[Callable[[Array], Array]]:
        """Functions of the time at whose zeros the torque has kinks: where the power through a gear turns."""
        return [lambda times: self._before_gear(piece, times)] if self.loses else []

    def _before_gear(self, piece: Piece, times: Array) -> Array:
        """The torque at the mechanism's input."""
        x, v, w = (piece.values(times, nu) for nu in range(3))
        return np.asarray(self.mechanism.torque(x, v, w), dtype=np.float64) + self._process(x, times)

    def _process(self, x: Array, times: Array) -> Array | float:
        """The load of the process at positions and times."""
        return 0.0 if self.process is None else self.process.values(x, times)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times at which the load has kinks."""
        return () if self.process is None else self.process.breaks

    def _torque(self, y: Array, velocity: Array, acceleration: Array, times: Array) -> Array:
        process = self._process(y, times)
        if isinstance(self.source, Drive):
            return np.asarray(self.source.torque(y, velocity, acceleration, process), dtype=np.float64)
        return np.asarray(self.source.torque(y, velocity, acceleration), dtype=np.float64) + process

    def along(self, piece: Piece, times: Array) -> Array:
        """The torque or force at times in a piece; in a near standstill, the value with the direction of the move."""
        y, velocity, acceleration = (piece.values(times, nu) for nu in range(3))
        still = np.abs(velocity) <= VALUE_ROUNDING * abs(piece.stroke) / piece.duration
        moving = np.where(still, TINY * np.sign(piece.stroke), velocity)
        return self._torque(y, moving, acceleration, times)

    def at_joint(self, motion: tuple[float, float, float], direction: float, time: float) -> float:
        """The torque or force where a move begins or ends, on its way in a direction."""
        y, velocity, acceleration = (np.array([value]) for value in motion)
        moving = np.where(velocity == 0.0, TINY * direction, velocity)
        return float(self._torque(y, moving, acceleration, np.array([time]))[0])

    def moved(
        self, stroke: float, span: tuple[float, float], offset: float
    ) -> DimensionlessMechanism | DimensionlessDrive:
        """Torque, power and energy over a stroke as formulas of a law that never turns back.

        A span is its start and its duration.
        """
        process = None if self.process is None else self.process.over_span(*span)
        return self.source.dimensionless(offset, stroke, span[1], process=process)

    def formula(self, stroke: float, span: tuple[float, float], offset: float, unit: float) -> str:
        """The torque in a unit, counted in the direction of the stroke, of a law that never turns back."""
        moved = self.moved(stroke, span, offset)
        return f"{moved.unit / unit!r}*({moved.torque})"

    @property
    def brakes_as_it_drives(self) -> bool:
        """Whether motor and load are braked together: the torque of power back is then never greater than the torque.

        So it is where nothing but constant inertia is moved, and where motor and gear take no torque themselves.
        """
        if not isinstance(self.source, Drive):
            return True
        mechanism, train = self.mechanism, self.source.train
        if self.process is not None and (train.inertia or train.viscous or train.coulomb):
            return False
        if not (train.inertia or train.viscous or train.coulomb):
            return True
        rubs = mechanism.viscous or mechanism.coulomb or train.viscous or train.coulomb
        return not rubs and isinstance(mechanism.inertia_formula, Number) and mechanism.load_formula == Number(0.0)

    def size(self, stroke: float, span: tuple[float, float], offset: float) -> float:
        """The order of magnitude of the torque along a motion, as its unit."""
        return 4.0 * self.moved(stroke, span, offset).unit


def position_drive(source: Mechanism | Drive, axis: str) -> PositionDrive:
    """A mechanism or a motor with its mechanism as the drive of a cycle along an axis.

    Raises
    ------
    InputError
        If the input of the mechanism turns and the cycle slides, or the other way round.
    """
    drive = PositionDrive(source)
    moved_by = drive.mechanism.axis
    if moved_by != axis:
        moves = {"angle": "turns", "length": "slides"}
        raise InputError(
            f"drive: the input of the {drive.mechanism.name} {moves[moved_by]} and the motion of the cycle "
            f"{moves[axis]}: "
            f"give the cycle the positions of that input, {'angles' if moved_by == 'angle' else 'lengths'}"
        )
    return drive
