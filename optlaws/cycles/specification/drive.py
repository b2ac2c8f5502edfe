"""The drive of a cycle: inertia, spring, gravity and friction, or a mechanism with or without its motor."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from optlaws.cycles.specification.position_drive import PositionDrive, position_drive
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantities import quantity, table
from optlaws.numbers import Array, finite
from optlaws.suggest import unknown_key

REGENERATION = "regeneration"
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
class CycleDrive:
    """The force of a motion y: inertia y'' + viscous y' + stiffness y + constant + dry sign(y'), in SI units.

    `regeneration` is the share of the braking energy that is fed back.
    """

    inertia: float
    viscous: float
    stiffness: float
    constant: float
    dry: float
    regeneration: float = 0.0

    def force(self, y: Array, velocity: Array, acceleration: Array) -> Array:
        """The force or torque along a motion; dry friction is 0 at rest."""
        moved = self.inertia * acceleration + self.viscous * velocity + self.stiffness * y
        return moved + self.constant + self.dry * np.sign(velocity)

    def formula(self, stroke: float, duration: float, offset: float, direction: float, unit: float) -> str:
        """The force in a unit, as a formula of a law that moves forwards (direction 1), backwards (-1) or rests (0)."""
        constant = self.constant + self.stiffness * offset + self.dry * direction
        factors = [factor / unit for factor in self._factors(stroke, duration)]
        terms = [f"({value!r})*{name}" for value, name in zip(factors, "abc", strict=True) if value]
        return " + ".join([*terms, f"({constant / unit!r})"])

    def at_joint(self, motion: tuple[float, float, float], direction: float, time: float) -> float:  # noqa: ARG002 - as of other drives
        """The force where a move begins or ends, on its way in a direction."""
        position, velocity, acceleration = motion
        moved = self.inertia * acceleration + self.viscous * velocity
        return moved + self.stiffness * position + self.constant + self.dry * direction

    def size(self, stroke: float, span: tuple[float, float], offset: float) -> float:
        """The order of magnitude of the force along a motion, as its unit."""
        spring, damper, inertia = (abs(factor) for factor in self._factors(stroke, span[1]))
        return 4.0 * inertia + 2.0 * damper + spring + abs(self.constant + self.stiffness * offset) + self.dry

    def _factors(self, stroke: float, duration: float) -> tuple[float, float, float]:
        """The factors of a, b and c of a law in the force."""
        return (
            self.stiffness * stroke,
            self.viscous * factor(stroke, duration, 1),
            self.inertia * factor(stroke, duration, 2),
        )

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times at which the force has kinks: an empty tuple."""
        return ()

    @property
    def copper(self) -> float:
        """The copper heat by the squared force: of no motor here."""
        return 0.0

    @property
    def speed_ratio(self) -> float:
        """The ratio of the velocity at which the force acts to the velocity of the motion."""
        return 1.0

    def kinks(self, piece: Piece) -> list[Callable[[Array], Array]]:  # noqa: ARG002 - as of other drives
        """Functions of the time at whose zeros the force has kinks, in addition to zeros of the velocity."""
        return []

    def along(self, piece: Piece, times: Array) -> Array:
        """The force at times in a piece."""
        return self.force(*(piece.values(times, nu) for nu in range(3)))


def read_drive(entries: Mapping[str, Any] | Mechanism | Drive, axis: str) -> CycleDrive | PositionDrive:
    """A drive from its entries, each a quantity with its unit, of which what is not given is 0, or from a mechanism."""
    if isinstance(entries, Mechanism | Drive):
        return position_drive(entries, axis)
    known = ENTRIES[axis]
    for key in table(entries, "drive", "{'mass': '2 kg'}"):
        if key not in (*known, REGENERATION):
            raise InputError(f"drive: {unknown_key(key, (*known, REGENERATION))}")
    regeneration = finite(entries.get(REGENERATION, 0.0), f"drive: {REGENERATION}")
    if not 0.0 <= regeneration <= 1.0:
        raise InputError(f"drive: {REGENERATION} must be from 0 to 1, got {shortened(entries[REGENERATION])}")
    quantities = {
        key: quantity(value, known[key], f"drive: {key}") for key, value in entries.items() if key != REGENERATION
    }
    for key in ("mass", "inertia", "viscous", "dry"):
        if quantities.get(key, 0.0) < 0.0:
            raise InputError(f"drive: {key} must be at least 0, got {entries[key]!r}")
    inertia = quantities.get("mass", 0.0) + quantities.get("inertia", 0.0)
    constant = quantities.get("preload", 0.0) + quantities.get("gravity", 0.0)
    viscous, stiffness, dry = (quantities.get(key, 0.0) for key in ("viscous", "stiffness", "dry"))
    return CycleDrive(inertia, viscous, stiffness, constant, dry, regeneration)


def read_constant_drive(entries: Mapping[str, Any] | Mechanism | Drive, axis: str) -> CycleDrive:
    """A drive of constants, as of a cam's follower.

    Raises
    ------
    InputError
        If it is a mechanism or a motor with one.
    """
    drive = read_drive(entries, axis)
    if isinstance(drive, PositionDrive):
        raise InputError(
            f"drive: forces of a cam's follower are of constants such as {{'mass': '2 kg'}}, got {shortened(entries)}; "
            "what a cam and its follower are to the cam's shaft is `cam_mechanism`"
        )
    return drive
