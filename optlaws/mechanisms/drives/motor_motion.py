"""Motion of a motor during a move: speed, torque and power at places k of the law, and integrals of them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.branches import corners
from optlaws.formulas.tree import Formula
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.direction import direction_of
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.smooth_parts import SmoothParts
from optlaws.numbers import Array


class Train(NamedTuple):
    """The transmission between motor and mechanism, in SI units.

    Attributes
    ----------
    inertia, viscous, coulomb
        At the motor's shaft.
    to_load, back
        Efficiencies of the gear while power flows to the load and back.
    """

    inertia: float
    viscous: float
    coulomb: float
    to_load: float
    back: float

    def through_gear(self, torque: Array) -> Array:
        """The torque at the mechanism's input, in the direction of motion, as the gear's other side feels it."""
        return np.maximum(torque / self.to_load, torque * self.back)


@dataclass(frozen=True, eq=False)
class MotorMotion:
    """A move of a mechanism by a law, seen from the motor. Torques are above 0 in the direction of the stroke."""

    mechanism: Mechanism
    train: Train
    ratio: float
    law: MotionLaw
    start: float
    stroke: float
    duration: float

    def with_ratio(self, ratio: float) -> MotorMotion:
        """The same move with another gear ratio."""
        return replace(self, ratio=ratio)

    def speed(self, k: Array) -> Array:
        """The motor's speed, rad/s, above 0 in the direction of the stroke."""
        return self.ratio * abs(self.stroke) / self.duration * self.law(k, 1)

    def acceleration(self, k: Array) -> Array:
        """The motor's angular acceleration, rad/s²."""
        return self.ratio * abs(self.stroke) / self.duration**2 * self.law(k, 2)

    @property
    def reach(self) -> tuple[float, float]:
        """The least and the greatest position of the mechanism's input."""
        ends = (self.start + self.stroke * extreme.value for extreme in self.law.extrema(0))
        low, high = sorted(np.clip(list(ends), *self.mechanism.over).tolist())
        return low, high

    def load(self, k: Array) -> Array:
        """The torque at the mechanism's input, N m."""
        speed, side = self.speed(k), np.sign(self.stroke)
        position = np.clip(self.start + self.stroke * self.law(k), *self.mechanism.over)
        v, w = side * speed / self.ratio, side * self.acceleration(k) / self.ratio
        return np.asarray(side * self.mechanism.torque(position, v, w, side * self.direction(k)))

    def through_gear(self, k: Array) -> Array:
        """The load's torque times the ratio as the motor feels it."""
        direction, load = self.direction(k), self.load(k)
        return np.where(direction == 0.0, load, self.train.through_gear(load * direction) * direction)

    def motor_torque(self, k: Array) -> Array:
        """The torque that moves the motor and the gear's first shaft alone."""
        speed, train = self.speed(k), self.train
        return train.inertia * self.acceleration(k) + train.viscous * speed + train.coulomb * self.direction(k)

    def torque(self, k: Array) -> Array:
        """The motor's torque, N m."""
        return self.motor_torque(k) + self.through_gear(k) / self.ratio

    def power(self, k: Array) -> Array:
        """Power of the motor at places k, W."""
        return self.torque(k) * self.speed(k)

    def direction(self, k: Array) -> Array:
        """The direction of the motion: 1 that of the stroke, -1 against it, 0 at rest."""
        return direction_of(self.law)(k)

    @property
    def holding_torque(self) -> float:
        """The torque that holds the load after the move, N m, above 0 in the direction of the stroke."""
        at_end = float(np.clip(self.start + self.stroke, *self.mechanism.over))
        return float(np.sign(self.stroke) * self.mechanism.load(at_end)) / self.ratio

    @kept_property
    def parts(self) -> SmoothParts:
        """Parts of the move on which speed, load and torque are smooth, between breaks and changes of sign."""
        breaks = [*self.law.breaks, *direction_of(self.law).turns]
        bends = [partial(self._over_way, switch) for switch in corners(self.mechanism.load_formula, "x")]
        return SmoothParts.between(0.0, 1.0, breaks=breaks, signs=(*bends, self.load, self.torque))

    def _over_way(self, formula: Formula, k: Array) -> Array:
        """A formula of the position at places of the law."""
        values = evaluate(formula, {"x": self.start + self.stroke * np.asarray(self.law.a(k))}, NUMPY)
        return np.broadcast_to(np.asarray(values, dtype=np.float64), np.shape(k))
