"""Motors: inertia, ratings and curves of torque over speed, from a user's own catalogue."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf
from pathlib import Path
from typing import Any, NamedTuple, TypedDict, Unpack

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText, toml
from optlaws.motion.quantities import si_number
from optlaws.numbers import Array, NumberOrQuantity, bounded, finite, not_negative, positive
from optlaws.suggest import keywords_of, unknown_key

#: entries of a motor with their dimensions; curves are lists of speeds and torques
ENTRIES = {
    "inertia": "moment of inertia",
    "rated_torque": "torque",
    "peak_torque": "torque",
    "greatest_speed": "angular velocity",
    "coulomb": "torque",
    "viscous": "rotary viscous friction",
}
CURVES = ("curve", "continuous")
#: what a motor's torque depends on; all else limits it
OF_TORQUE = ("inertia", "coulomb", "viscous", "constant")
Curve = tuple[tuple[float, float], ...]


class MotorLosses(TypedDict, total=False):
    """The losses of a motor: its friction, "coulomb" and "viscous", and the motor constant, N m/√W."""

    friction: Mapping[str, NumberOrQuantity] | None
    constant: float | None


@dataclass(frozen=True, init=False)
class Motor(JsonText):
    """A motor, as in its data sheet; omitted entries impose no limit. SI units, speeds in rad/s.

    Parameters
    ----------
    inertia
        Of the rotor, such as "3e-4 kg m^2".
    rated_torque
        That the root mean square of the torque over a cycle must not exceed.
    peak_torque
        That the torque must not exceed at any time.
    greatest_speed
        Such as "3000 rpm".
    curve, continuous
        The peak torque and the continuous one over the speed, pairs such as ("3000 rpm", "6 N m") by rising speed, with
        straight lines between them; beyond the last one there is none.
    friction
        Of the motor itself: "coulomb" and "viscous".
    constant
        The motor constant, N m/√W: torque by the root of the copper heat, which is (torque/constant)². It is the torque
        constant by the root of the winding's resistance.
    name
        What texts call it.

    Raises
    ------
    InputError
        If a quantity is of another dimension or below 0, or the speeds of a curve do not rise.

    Examples
    --------
    >>> motor = Motor("3e-4 kg m^2", rated_torque="2.4 N m", curve=[("0 rpm", "9 N m"), ("3000 rpm", "6 N m")])
    >>> round(float(motor.peak_at(50.0 * np.pi)), 6), motor.greatest_speed
    (7.5, 314.15926535897933)
    """

    _json_name = "a motor"

    inertia: float
    rated_torque: float
    peak_torque: float
    greatest_speed: float
    curve: Curve
    continuous: Curve
    coulomb: float
    viscous: float
    constant: float
    name: str

    @keywords_of(MotorLosses)
    def __init__(
        self,
        inertia: NumberOrQuantity,
        *,
        rated_torque: NumberOrQuantity | None = None,
        peak_torque: NumberOrQuantity | None = None,
        greatest_speed: NumberOrQuantity | None = None,
        curve: Sequence[Any] = (),
        continuous: Sequence[Any] = (),
        name: str = "motor",
        **losses: Unpack[MotorLosses],
    ) -> None:
        limits = {"rated_torque": rated_torque, "peak_torque": peak_torque, "greatest_speed": greatest_speed}
        fields: dict[str, Any] = {"inertia": _entry(inertia, "inertia"), "name": str(name)}
        fields |= {key: inf if value is None else _limit(value, key) for key, value in limits.items()}
        friction, constant = losses.get("friction") or {}, losses.get("constant")
        for key in friction:
            if key not in ("coulomb", "viscous"):
                raise InputError(unknown_key(key, ("coulomb", "viscous"), "friction of a motor"))
        fields |= {key: _entry(friction.get(key, 0.0), key) for key in ("coulomb", "viscous")}
        fields |= {key: _curve(pairs, key) for key, pairs in zip(CURVES, (curve, continuous), strict=True)}
        fields["constant"] = inf if constant is None else positive(constant, "constant")
        ends = [fields[key][-1][0] for key in CURVES[:1] if fields[key]]
        fields["greatest_speed"] = min([fields["greatest_speed"], *ends])
        for key, value in fields.items():
            object.__setattr__(self, key, value)

    def peak_at(self, speed: Any) -> Array:
        """The greatest torque at speeds in rad/s, N m; 0 beyond the greatest speed."""
        return np.minimum(self._along(self.curve, speed), self.peak_torque)

    def continuous_at(self, speed: Any) -> Array:
        """The torque that the motor bears for ever at speeds in rad/s, N m."""
        return np.minimum(self._along(self.continuous, speed), self.rated_torque)

    @property
    def peak_lines(self) -> tuple[tuple[float, float], ...]:
        """Straight lines over the speed that bound the peak torque from above: a torque at rest, and its slope.

        They are those of the concave hull of the curve, and of the peak torque.

        Examples
        --------
        >>> motor = Motor("3e-4 kg m^2", curve=[("0 rad/s", "9 N m"), ("200 rad/s", "9 N m"), ("300 rad/s", "4 N m")])
        >>> motor.peak_lines
        ((9.0, 0.0), (19.0, 0.05))
        """
        lines = [(self.peak_torque, 0.0)] if self.peak_torque < inf else []
        hull: list[tuple[float, float]] = []
        for point in self.curve:
            while len(hull) > 1 and _slope(hull[-2], hull[-1]) <= _slope(hull[-1], point):
                hull.pop()
            hull.append(point)
        if hull:
            lines.append((max(torque for _, torque in hull), 0.0))
        for first, second in pairwise(hull):
            if (fall := -_slope(first, second)) > 0.0:
                lines.append((first[1] + fall * first[0], fall))
        return tuple(lines)

    def _along(self, curve: Curve, speed: Any) -> Array:
        size = np.abs(np.asarray(speed, dtype=np.float64))
        values = np.interp(size, *np.transpose(curve)) if curve else np.full(size.shape, inf)
        last = min(self.greatest_speed, curve[-1][0] if curve else inf)
        return np.where(size > last, 0.0, values)

    def to_dict(self) -> dict[str, Any]:
        """The motor as plain data in SI units."""
        plain = {name: bounded(getattr(self, name)) for name in ("rated_torque", "peak_torque", "greatest_speed")}
        return {
            "name": self.name,
            "inertia": self.inertia,
            **plain,
            **{name: [list(pair) for pair in getattr(self, name)] for name in CURVES},
            "coulomb": self.coulomb,
            "viscous": self.viscous,
            "constant": bounded(self.constant),
        }

    @classmethod
    def from_dict(cls, data: Any) -> Motor:
        """The motor that `to_dict` described, or an entry of a catalogue.

        Raises
        ------
        InputError
            If an entry is unknown or wrong, or there is no inertia.

        Examples
        --------
        >>> Motor.from_dict({"inertia": "3e-4 kg m^2", "greatest_speed": "3000 rpm"}).inertia
        0.0003
        """
        known = (*ENTRIES, *CURVES, "constant", "name")
        if not isinstance(data, Mapping) or data.get("inertia") is None:
            raise InputError(f"a motor is a table with an inertia, got {shortened(data)}")
        for key in data:
            if key not in known:
                raise InputError(unknown_key(key, known, "entry of a motor"))
        plain = {key: value for key, value in data.items() if value is not None and key not in ("coulomb", "viscous")}
        friction = {key: data[key] for key in ("coulomb", "viscous") if data.get(key) is not None}
        return cls(plain.pop("inertia"), friction=friction, **plain)


def read_motors(file: str | Path) -> dict[str, Motor]:
    """The motors of a catalogue, a TOML file with a table for each, by their names.

    Parameters
    ----------
    file
        Whose tables have the entries of a `Motor`: inertia, rated_torque, peak_torque, greatest_speed, curve,
        continuous, coulomb, viscous, constant.

    Raises
    ------
    InputError
        If the file cannot be read, or a motor is wrong; the error names it.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> file = Path(mkdtemp()) / "motors.toml"
    >>> _ = file.write_text('small = {inertia = "3e-4 kg m^2", rated_torque = "2.4 N m"}')
    >>> read_motors(file)["small"].rated_torque
    2.4
    """
    motors = {}
    for name, entries in toml(Path(file)).items():
        try:
            motors[name] = Motor.from_dict({"name": name, **entries} if isinstance(entries, Mapping) else entries)
        except InputError as error:
            raise InputError(f"{Path(file).name}: {name}: {error}") from None
    return motors


def _slope(first: tuple[float, float], second: tuple[float, float]) -> float:
    return (second[1] - first[1]) / (second[0] - first[0])


def _entry(value: Any, name: str) -> float:
    return not_negative(si_number(value, (ENTRIES[name],), name), name)


def _limit(value: Any, name: str) -> float:
    number = _entry(value, name)
    if number == 0.0:
        raise InputError(f"{name} must be above 0, got {shortened(value)}")
    return number


def _curve(pairs: Any, name: str) -> Curve:
    if not isinstance(pairs, list | tuple) or any(
        not isinstance(pair, list | tuple) or len(pair) != 2 for pair in pairs
    ):
        raise InputError(
            f"{name} must be pairs of a speed and a torque such as ('3000 rpm', '6 N m'), got {shortened(pairs)}"
        )
    read = []
    for speed, torque in pairs:
        at = finite(si_number(speed, ("angular velocity",), f"{name}: speed"), f"{name}: speed")
        read.append((at, not_negative(si_number(torque, ("torque",), f"{name}: torque"), f"{name}: torque")))
    if len(read) == 1 or any(speed >= following for (speed, _), (following, _) in pairwise(read)):
        raise InputError(f"{name} needs two speeds at least, which rise, got {shortened(pairs)}")
    return tuple(read)


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
