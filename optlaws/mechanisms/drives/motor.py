"""Motors: inertia, ratings and curves of torque over speed, from a user's own catalogue."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, InitVar
from itertools import pairwise
from math import inf
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import InSI, Kept, Listed, Number, SILimit, SINumber, Text, Together
from optlaws.errors import InputError, located
from optlaws.files.reading import check_names, toml
from optlaws.numbers import Array, NumberOrQuantity

#: what a motor's torque depends on; all else limits it
OF_TORQUE = ("inertia", "coulomb", "viscous", "constant")
CurveOfTorque: TypeAlias = Kept[tuple[tuple[float, float], ...], "Sequence[Any]"]
Constant: TypeAlias = Kept[float, "float | None"]
_TORQUE = InSI("torque", above=0.0, absent=inf)
_CURVE = Listed(Together(InSI("angular velocity"), InSI("torque", least=0.0), names=("speed", "torque")))


@declared
class Motor(Declared, title="a motor"):
    """A motor, as in its data sheet; omitted entries impose no limit. SI units, speeds in rad/s.

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

    writes_defaults = True

    name: str = entry(Text(), "What texts call it.", default="motor", kw_only=True, shown=False)
    inertia: SINumber = entry(InSI("moment of inertia", least=0.0), "Of the rotor.", example="3e-4 kg m^2")
    _: KW_ONLY
    rated_torque: SILimit = entry(
        _TORQUE, "The greatest root mean square of the torque over a cycle.", default=None, example="2 N m"
    )
    peak_torque: SILimit = entry(_TORQUE, "The greatest torque at any time.", default=None, example="6 N m")
    greatest_speed: SILimit = entry(
        InSI("angular velocity", above=0.0, absent=inf), "Of the rotor.", default=None, example="3000 rpm"
    )
    curve: CurveOfTorque = entry(
        _CURVE,
        "The peak torque over the speed, straight between pairs by rising speed; above the last speed it is 0.",
        default=(),
        example=[["0 rpm", "6 N m"], ["3000 rpm", "4 N m"]],
    )
    continuous: CurveOfTorque = entry(
        _CURVE,
        "The continuous torque over the speed, likewise.",
        default=(),
        example=[["0 rpm", "2.4 N m"], ["3000 rpm", "2 N m"]],
    )
    coulomb: SINumber = entry(
        InSI("torque", least=0.0), "Friction of the motor itself.", default=0.0, example="0.1 N m"
    )
    viscous: SINumber = entry(
        InSI("rotary viscous friction", least=0.0),
        "Its friction in proportion to the speed.",
        default=0.0,
        example="1e-4 N m s/rad",
    )
    constant: Constant = entry(
        Number(above=0.0, absent=inf),
        "The motor constant, N m/√W: torque by the root of the copper heat, which is (torque/constant)²; the torque "
        "constant by the root of the winding's resistance.",
        default=None,
        example=0.4,
    )
    #: coulomb and viscous friction in one table, as they were given earlier
    friction: InitVar[Mapping[str, NumberOrQuantity] | None] = None

    def __post_init__(self, friction: Mapping[str, NumberOrQuantity] | None) -> None:
        check_names(friction or {}, ("coulomb", "viscous"), "friction of a motor")
        for name, value in (friction or {}).items():
            object.__setattr__(self, name, value)
        super().__post_init__()

    def _check(self) -> None:
        for name, pairs in (("curve", self.curve), ("continuous", self.continuous)):
            if len(pairs) == 1 or any(speed >= following for (speed, _), (following, _) in pairwise(pairs)):
                raise InputError(f"{name} needs two speeds at least, which rise, got {shortened(pairs)}")
        if self.curve:
            object.__setattr__(self, "greatest_speed", min(self.greatest_speed, self.curve[-1][0]))

    def peak_at(self, speed: Any) -> Array:
        """The greatest torque at speeds in rad/s, N m; 0 beyond the greatest speed."""
        return np.minimum(self._along(self.curve, speed), self.peak_torque)

    def continuous_at(self, speed: Any) -> Array:
        """The torque that the motor bears for ever at speeds in rad/s, N m."""
        return np.minimum(self._along(self.continuous, speed), self.rated_torque)

    def limits_up_to(self, speed: float, count: int) -> tuple[Array, dict[str, Array]]:
        """Speeds up to one, in rad/s, and the torques that are allowed there: "peak torque", "continuous torque"."""
        end = min(self.greatest_speed, speed)
        speeds = np.unique([*np.linspace(0.0, end, count), *(corner for corner, _ in self.curve if corner <= end)])
        known = {"peak torque": self.peak_at(speeds), "continuous torque": self.continuous_at(speeds)}
        return speeds, {name: values for name, values in known.items() if np.isfinite(values).all()}

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
        tops = (self.peak_torque, max((torque for _, torque in self.curve), default=inf))
        flat = tuple((torque, 0.0) for torque in tops if torque < inf)
        return (*flat, *((rest, fall) for rest, fall in self.curve_lines if fall > 0.0))

    @property
    def curve_lines(self) -> tuple[tuple[float, float], ...]:
        """Lines of the concave hull of the curve, level before it: a torque at rest, and by how much it falls."""
        before = [(0.0, torque) for speed, torque in self.curve[:1] if speed > 0.0]
        hull: list[tuple[float, float]] = []
        for point in (*before, *self.curve):
            while len(hull) > 1 and _slope(hull[-2], hull[-1]) <= _slope(hull[-1], point):
                hull.pop()
            hull.append(point)
        falls = [(first, -_slope(first, second)) for first, second in pairwise(hull)]
        return tuple((torque + fall * speed, fall) for (speed, torque), fall in falls)

    def _along(self, curve: tuple[tuple[float, float], ...], speed: Any) -> Array:
        size = np.abs(np.asarray(speed, dtype=np.float64))
        values = np.interp(size, *np.transpose(curve)) if curve else np.full(size.shape, inf)
        last = min(self.greatest_speed, curve[-1][0] if curve else inf)
        return np.where(size > last, 0.0, values)


def read_motors(file: str | Path) -> dict[str, Motor]:
    """The motors of a catalogue, a TOML file with a table for each, by their names.

    Parameters
    ----------
    file
        Whose tables have the entries of a `Motor`.

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
        with located(f"{Path(file).name}: {name}"):
            motors[name] = Motor.from_dict({"name": name, **entries} if isinstance(entries, Mapping) else entries)
    return motors


def _slope(first: tuple[float, float], second: tuple[float, float]) -> float:
    return (second[1] - first[1]) / (second[0] - first[0])


#: a mechanism that is driven at its input, without a motor
NO_MOTOR = Motor(0.0, name="no motor")
