"""What drives a cycle: inertia, spring, gravity and friction, and the force or torque that they take."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantities import quantity, table
from optlaws.suggest import unknown_key

Array = NDArray[np.float64]

#: entries of a drive with their dimensions, for slides and for tables
ENTRIES = {
    "length": {
        "mass": "mass",
        "stiffness": "stiffness",
        "preload": "force",
        "gravity": "force",
        "viscous": "viscous friction",
        "dry": "force",
    },
    "angle": {
        "inertia": "moment of inertia",
        "stiffness": "torsional stiffness",
        "preload": "torque",
        "gravity": "torque",
        "viscous": "rotary viscous friction",
        "dry": "torque",
    },
}


@dataclass(frozen=True)
class Drive:
    """What a motion y takes: inertia y'' + viscous y' + stiffness y + constant + dry sign(y'), in SI units.

    Examples
    --------
    >>> read_drive({"mass": "2 kg", "dry": "5 N"}, "length").inertia
    2.0
    """

    inertia: float
    viscous: float
    stiffness: float
    constant: float
    dry: float

    def force(self, y: Array, velocity: Array, acceleration: Array) -> Array:
        """The force or torque along a motion; dry friction is 0 at rest."""
        moved = self.inertia * acceleration + self.viscous * velocity + self.stiffness * y
        return moved + self.constant + self.dry * np.sign(velocity)

    def formula(self, stroke: float, duration: float, offset: float, direction: float, unit: float) -> str:
        """The force in a unit, as a formula of a law that moves forth (direction 1), back (-1) or lies still (0)."""
        constant = self.constant + self.stiffness * offset + self.dry * direction
        factors = [factor / unit for factor in self._factors(stroke, duration)]
        terms = [f"({value!r})*{name}" for value, name in zip(factors, "abc", strict=True) if value]
        return " + ".join([*terms, f"({constant / unit!r})"])

    def size(self, stroke: float, duration: float, offset: float) -> float:
        """About how great the force is along a motion: a unit in which it is near 1."""
        spring, damper, inertia = (abs(factor) for factor in self._factors(stroke, duration))
        return 4.0 * inertia + 2.0 * damper + spring + abs(self.constant + self.stiffness * offset) + self.dry

    def _factors(self, stroke: float, duration: float) -> tuple[float, float, float]:
        """What a, b and c of a law count in the force."""
        return (
            self.stiffness * stroke,
            self.viscous * factor(stroke, duration, 1),
            self.inertia * factor(stroke, duration, 2),
        )

    def along(self, piece: Piece, times: Array) -> Array:
        """The force at times in a piece."""
        return self.force(*(piece.values(times, nu) for nu in range(3)))


def read_drive(entries: Mapping[str, Any], axis: str) -> Drive:
    """A drive from its entries, each a quantity with its unit; what is not given is 0.

    Raises
    ------
    InputError
        If an entry is unknown, of another dimension, or negative where that has no meaning.

    Examples
    --------
    >>> read_drive({"inertia": "0.02 kg m^2", "viscous": "0.01 N m s/rad"}, "angle").viscous
    0.01
    """
    known = ENTRIES[axis]
    for key in table(entries, "drive", "{'mass': '2 kg'}"):
        if key not in known:
            raise InputError(f"drive: {unknown_key(key, known)}")
    quantities = {key: quantity(value, known[key], f"drive: {key}") for key, value in entries.items()}
    for key in ("mass", "inertia", "viscous", "dry"):
        if quantities.get(key, 0.0) < 0.0:
            raise InputError(f"drive: {key} must be at least 0, got {entries[key]!r}")
    inertia = quantities.get("mass", 0.0) + quantities.get("inertia", 0.0)
    constant = quantities.get("preload", 0.0) + quantities.get("gravity", 0.0)
    return Drive(
        inertia, quantities.get("viscous", 0.0), quantities.get("stiffness", 0.0), constant, quantities.get("dry", 0.0)
    )
