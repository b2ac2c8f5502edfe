"""What drives a cycle: inertia, spring, gravity and friction, and the force or torque and power that they take."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from optlaws.cycles.specification.position_drive import PositionDrive, position_drive
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.storage import PlainNumbers
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantities import quantity, table
from optlaws.numbers import Array
from optlaws.suggest import unknown_key
from optlaws.tolerances import VALUE_ROUNDING

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
    """The force of a motion y: inertia y'' + viscous y' + stiffness y + constant + dry sign(y'), in SI units."""

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

    def at_joint(self, position: float, velocity: float, acceleration: float, direction: float) -> float:
        """The force where a move begins or ends, on its way in a direction."""
        moved = self.inertia * acceleration + self.viscous * velocity
        return moved + self.stiffness * position + self.constant + self.dry * direction

    def size(self, stroke: float, duration: float, offset: float) -> float:
        """About how great the force is along a motion: a unit in which it is near 1."""
        spring, damper, inertia = (abs(factor) for factor in self._factors(stroke, duration))
        return 4.0 * inertia + 2.0 * damper + spring + abs(self.constant + self.stiffness * offset) + self.dry

    def _factors(self, stroke: float, duration: float) -> tuple[float, float, float]:
        """The factors of a, b and c of a law in the force."""
        return (
            self.stiffness * stroke,
            self.viscous * factor(stroke, duration, 1),
            self.inertia * factor(stroke, duration, 2),
        )

    def along(self, piece: Piece, times: Array) -> Array:
        """The force at times in a piece."""
        return self.force(*(piece.values(times, nu) for nu in range(3)))


def read_drive(entries: Mapping[str, Any] | Mechanism | Drive, axis: str) -> CycleDrive | PositionDrive:
    """A drive from its entries, each a quantity with its unit, of which what is not given is 0, or from a mechanism."""
    if isinstance(entries, Mechanism | Drive):
        return position_drive(entries, axis)
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
    return CycleDrive(
        inertia, quantities.get("viscous", 0.0), quantities.get("stiffness", 0.0), constant, quantities.get("dry", 0.0)
    )


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


_EVEN = 400  # stretches of a piece in which extremes and zeros are looked for, before they are polished
_GAUSS = 12


@dataclass(frozen=True)
class Effort(PlainNumbers):
    """The force and power of a drive over a cycle, in SI units.

    Attributes
    ----------
    peak_force, rms_force
        Of the force, or of the torque of a table, at the follower.
    peak_power
        The greatest magnitude of the power; divided by the master's angular velocity it is the greatest torque that
        the motion asks of the master's shaft.
    mean_power
        What friction takes.
    """

    peak_force: float
    rms_force: float
    peak_power: float
    mean_power: float

    def shaft_torque(self, angular_velocity: float) -> float:
        """The greatest torque at a shaft of constant angular velocity, rad/s."""
        return self.peak_power / angular_velocity


def effort(drive: CycleDrive | PositionDrive, pieces: Sequence[Piece], period: float) -> Effort:
    """The force and power of a drive over pieces that make a cycle.

    >>> from optlaws.laws import smoothstep
    >>> drive = CycleDrive(inertia=2.0, viscous=0.0, stiffness=0.0, constant=0.0, dry=0.0)
    >>> rise = Piece(0.0, 1.0, 0.0, 1.0, smoothstep(2))
    >>> round(effort(drive, [rise], 1.0).peak_force, 9)
    12.0
    """
    force = square = power = work = 0.0
    for piece in pieces:
        forces, powers = partial(drive.along, piece), partial(_power, drive, piece)
        force, power = max(force, _peak(piece, forces)), max(power, _peak(piece, powers))
        square += square_of_force(drive, piece)
        work += _integral(piece, powers)
    mean = work / period
    return Effort(force, float(np.sqrt(square / period)), power, mean if abs(mean) > VALUE_ROUNDING * power else 0.0)


def size_of(piece: Piece, nu: int, drive: CycleDrive | PositionDrive | None, *, mean: bool = False) -> float:
    """The peak or RMS of a derivative, or of the force (-1) or power (-3) of a drive, in a piece, in SI units."""
    if nu > 0 or drive is None:
        if not piece.stroke:
            return 0.0
        constant = piece.law.rms(nu) if mean else piece.law.peak(nu).value
        return constant * abs(factor(piece.stroke, piece.duration, nu))
    taken = effort(drive, [piece], piece.duration)
    return taken.peak_power if nu == -3 else taken.rms_force if mean else taken.peak_force


def square_of_force(drive: CycleDrive | PositionDrive, piece: Piece) -> float:
    """The integral of the square of the force over a piece, in SI units."""
    return _integral(piece, partial(_square, drive, piece))


def _power(drive: CycleDrive | PositionDrive, piece: Piece, times: Array) -> Array:
    return drive.along(piece, times) * piece.values(times, 1)


def _square(drive: CycleDrive | PositionDrive, piece: Piece, times: Array) -> Array:
    return drive.along(piece, times) ** 2


def _marks(piece: Piece) -> Array:
    """Places between which everything is smooth: breaks of the law, standstills, and even ones."""
    even = piece.start + piece.duration * np.linspace(0.0, 1.0, _EVEN + 1)
    breaks = piece.start + piece.duration * np.array(piece.law.breaks)
    return np.unique(np.concatenate([even, breaks, _standstills(piece, even)]))


def _standstills(piece: Piece, even: Array) -> Array:
    from scipy.optimize import brentq

    values = piece.values(even, 1)
    leaps = np.flatnonzero(values[:-1] * values[1:] < 0.0)

    def velocity(time: float) -> float:
        return float(piece.values(np.array([time]), 1)[0])

    standstills = [brentq(velocity, even[i], even[i + 1], xtol=1e-15) for i in leaps]
    return np.array(standstills, dtype=np.float64)


def _peak(piece: Piece, values: Callable[[Array], Array]) -> float:
    """The greatest magnitude: at marks, just beside them, and polished inside the best stretches."""
    from scipy.optimize import minimize_scalar

    marks = _marks(piece)
    lengths = np.diff(marks)
    sides = np.concatenate([marks[:-1] + 1e-9 * lengths, marks[1:] - 1e-9 * lengths, marks])
    sizes = np.abs(values(sides))
    best = float(sizes.max())
    near = np.abs(values(0.5 * (marks[:-1] + marks[1:])))
    for i in np.argsort(near)[-3:]:
        low, high = marks[max(i - 1, 0)], marks[min(i + 2, len(marks) - 1)]
        minimum = minimize_scalar(
            lambda t: -float(abs(values(np.array([t]))[0])), bounds=(low, high), method="bounded",
            options={"xatol": 1e-12 * piece.duration},
        )  # fmt: skip
        best = max(best, -float(minimum.fun))
    return best


def _integral(piece: Piece, values: Callable[[Array], Array]) -> float:
    u, weights = np.polynomial.legendre.leggauss(_GAUSS)
    marks = _marks(piece)
    middles, halves = 0.5 * (marks[:-1] + marks[1:]), 0.5 * np.diff(marks)
    at = values((middles[:, None] + halves[:, None] * u).ravel()).reshape(len(halves), -1)
    return float(halves @ (at @ weights))
