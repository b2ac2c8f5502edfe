"""A drive along a motion: forces that are affine in it, and over one stroke the formulas of a law with their units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.slopes import added
from optlaws.formulas.tree import Formula, number
from optlaws.mechanisms.linkages.entries import rescaled, times
from optlaws.motion.piece import factor
from optlaws.synthesis.functionals.makers import drive_torque
from optlaws.tolerances import TINY

_LOOKS = 721


class LinearForce(NamedTuple):
    """The force of a motion x: inertia x'' + viscous x' + stiffness x + constant + dry sign(x'), in SI units."""

    inertia: float
    viscous: float
    stiffness: float
    constant: float
    dry: float

    def formula(self, stroke: float, duration: float, offset: float, direction: float, unit: float) -> str:
        """The force in a unit, as a formula of a law that moves forwards (direction 1), backwards (-1) or rests (0).

        >>> LinearForce(2.0, 0.0, 10.0, 3.0, 0.5).formula(0.1, 1.0, 0.2, -1.0, 1.0)
        '(1.0)*a + (0.2)*c + (4.5)'
        """
        still = self.constant + self.stiffness * offset + self.dry * direction
        factors = [size / unit for size in self._factors(stroke, duration)]
        terms = [f"({value!r})*{name}" for value, name in zip(factors, "abc", strict=True) if value]
        return " + ".join([*terms, f"({still / unit!r})"])

    def size(self, stroke: float, duration: float, offset: float) -> float:
        """The order of magnitude of the force along a motion, as its unit."""
        spring, damper, inertia = (abs(size) for size in self._factors(stroke, duration))
        return 4.0 * inertia + 2.0 * damper + spring + abs(self.constant + self.stiffness * offset) + self.dry

    def _factors(self, stroke: float, duration: float) -> tuple[float, float, float]:
        """The factors of a, b and c of a law in the force."""
        damper, inertia = self.viscous * factor(stroke, duration, 1), self.inertia * factor(stroke, duration, 2)
        return self.stiffness * stroke, damper, inertia


class Train(NamedTuple):
    """Motor and gear before a mechanism, in SI units; unless given, the mechanism is driven at its input."""

    inertia: float = 0.0  #: this and friction at the motor's shaft
    viscous: float = 0.0
    coulomb: float = 0.0
    to_load: float = 1.0  #: the gear's efficiency while power flows to the load
    back: float = 1.0
    ratio: float = 1.0  #: turns of the motor with a turn of the mechanism's input
    regeneration: float = 0.0  #: the share of the braking energy that is fed back
    copper: float = 0.0  #: the copper heat by the squared torque, W/(N m)²; 0 without a motor constant

    @property
    def loses(self) -> bool:
        """Whether the gear loses power, so that the torque at the motor is the greater of two."""
        return (self.to_load, self.back) != (1.0, 1.0)


_AT_INPUT = Train()


@dataclass(frozen=True)
class StrokeTorque:
    """A drive over the stroke x = start + stroke a(k), k = t/duration: texts in a, b and c, with the units of numbers.

    The torque in the direction of the stroke is unit times `torque`: above 0 where the motor drives, whichever way x
    goes. That of the mechanism is I(a) c + I'(a) b²/2 + f b + T(a). Friction that does not depend on the speed is in T,
    for laws that never turn back.

    Attributes
    ----------
    inertia, load
        I(a) and T(a) of the mechanism.
    friction
        f, of its viscous friction.
    unit
        Of the torque, N m or N: at the motor, or without one at the mechanism's input.
    start, stroke, duration
        Of the mechanism's input, in rad or m, and s; the stroke is below 0 for motion to smaller x.
    holding
        The load without friction: what holds it at rest.
    train
        Motor and gear.
    """

    inertia: str
    friction: str
    load: str
    unit: float
    start: float
    stroke: float
    duration: float
    holding: str
    train: Train = _AT_INPUT

    @property
    def torque(self) -> str:
        """The torque as a formula of a, b and c, for `peak`, `rms` and `integral`.

        Where a gear loses power, its magnitude is no maximum of smooth formulas: `peak` takes it with side="high", and
        the last branch with side="low", which braking never passes.
        """
        return " + ".join([*self._motor, _greatest(self._through)])

    @property
    def branches(self) -> tuple[str, ...]:
        """The torques of which it is the greatest: where a gear loses power, of power to the load and of power back."""
        return tuple(" + ".join([*self._motor, load]) for load in self._through)

    @property
    def power(self) -> str:
        """The power, above 0 where the motor drives: torque times b."""
        return _greatest(self._powers)

    @property
    def energy(self) -> str:
        """A formula of which the integral is the energy of the move: braking counts by the share that is fed back."""
        return recovering(self._powers, self.train.regeneration)

    @property
    def heat(self) -> str:
        """A formula of which the integral is the copper heat and the braking energy that is not fed back.

        It is empty of a motor without a motor constant.
        """
        if not self.train.copper:
            return ""
        burnt = f"(max({', '.join(self._powers)}, 0) - {self.power})"
        return f"{self.copper!r}*({self.torque})^2 + {1.0 - self.train.regeneration!r}*{burnt}"

    @property
    def copper(self) -> float:
        """What the integral of the squared torque over k is of the copper heat, in the unit of the energy."""
        return self.unit**2 * self.duration * self.train.copper / self.energy_unit

    @property
    def power_unit(self) -> float:
        """The unit of torque times b, W."""
        return self.unit * self.train.ratio * abs(self.stroke) / self.duration

    @property
    def energy_unit(self) -> float:
        """The unit of an integral of torque times b over k, J."""
        return self.unit * self.train.ratio * abs(self.stroke)

    @property
    def of_motor(self) -> tuple[float, float, float]:
        """The torques that motor and gear take themselves in the unit: by c, by b, and always."""
        train, speed = self.train, self.train.ratio * abs(self.stroke) / self.duration
        inertia, viscous = train.inertia * speed / self.duration, train.viscous * speed
        return inertia / self.unit, viscous / self.unit, train.coulomb / self.unit

    @property
    def _motor(self) -> list[str]:
        return [f"{size!r}{name}" for size, name in zip(self.of_motor, ("*c", "*b", ""), strict=True) if size]

    @property
    def _through(self) -> list[str]:
        """The torque of the mechanism at the motor, for each way that power flows through the gear."""
        torque = drive_torque(inertia=self.inertia, friction=self.friction, load=self.load)
        shares = (1.0 / self.train.to_load, self.train.back) if self.train.loses else (1.0,)
        return [f"{share!r}*({torque})" if share != 1.0 else torque for share in shares]

    @property
    def _powers(self) -> list[str]:
        return [f"({branch})*b" for branch in self.branches]


def _greatest(formulas: Sequence[str]) -> str:
    return formulas[0] if len(formulas) == 1 else f"max({', '.join(formulas)})"


def recovering(powers: Sequence[str], share: float) -> str:
    """The greatest of powers, and the share that is fed back of it where it is below 0.

    >>> recovering(["c*b"], 0.5)
    'max(c*b, 0.5*c*b)'
    """
    fed_back = [f"{share!r}*{power}" for power in powers] if share else ["0"]
    return _greatest([*powers, *(fed_back if share != 1.0 else [])])


def dimensionless(
    inertia: Formula, load: Formula, friction: tuple[float, float], stroke: tuple[float, float, float]
) -> StrokeTorque:
    """A mechanism with Coulomb and viscous friction over a stroke, known by its start, its length and its duration."""
    (coulomb, viscous), (start, way, time) = friction, stroke
    x = start + way * np.linspace(0.0, 1.0, _LOOKS)
    accelerating, direction = abs(way) / time**2, float(np.sign(way))
    moved = viscous * abs(way) / time
    places = {"x": x, "k": np.linspace(0.0, 1.0, _LOOKS)}
    greatest = (float(np.max(np.abs(evaluate(formula, places, NUMPY)))) for formula in (inertia, load))
    unit = max(next(greatest) * accelerating, next(greatest), moved, coulomb)
    if unit < TINY:
        raise InputError("the mechanism has neither inertia nor load nor friction on this stroke: nothing drives it")
    resisting = times(rescaled(load, "x", "a", (start, way)), direction / unit)
    return StrokeTorque(
        str(times(rescaled(inertia, "x", "a", (start, way)), accelerating / unit)),
        str(number(moved / unit)),
        str(added([number(coulomb / unit), resisting])),
        unit,
        start,
        way,
        time,
        str(resisting),
    )
