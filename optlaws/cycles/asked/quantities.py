"""Quantities with units, as people write them: one door, which gives floats in SI units (metres, radians, seconds)."""

from __future__ import annotations

import re
from functools import cache
from math import isfinite
from typing import TYPE_CHECKING, Any, NamedTuple

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import finite, real

if TYPE_CHECKING:
    from pint import UnitRegistry

# an angle has a dimension of its own here, so that 45 deg is no bare number and 200 rpm no frequency in Hz
_DEFINITIONS = """
micro- = 1e-6 = µ- = u-
milli- = 1e-3 = m-
centi- = 1e-2 = c-
kilo- = 1e3 = k-
mega- = 1e6 = M-
giga- = 1e9 = G-
meter = [length] = m = metre
gram = [mass] = g
second = [time] = s = sec
radian = [angle] = rad
minute = 60 * second = min
hour = 60 * minute = h
inch = 0.0254 * meter = in
degree = 3.141592653589793 / 180 * radian = deg = °
revolution = 360 * degree = rev = turn
revolutions_per_minute = revolution / minute = rpm
newton = kilogram * meter / second ** 2 = N
pascal = newton / meter ** 2 = Pa
joule = newton * meter = J
watt = joule / second = W
hertz = 1 / second = Hz
standard_gravity = 9.80665 * meter / second ** 2 = g_n
"""

#: what is asked: the unit of SI in which it is computed, and how an error shows one
DIMENSIONS = {
    "length": ("meter", "35 mm"),
    "angle": ("radian", "45 deg"),
    "time": ("second", "0.3 s"),
    "frequency": ("1 / second", "16.7 Hz"),
    "velocity": ("meter / second", "616 mm/s"),
    "angular velocity": ("radian / second", "200 rpm"),
    "acceleration": ("meter / second ** 2", "12 m/s^2"),
    "angular acceleration": ("radian / second ** 2", "900 rad/s^2"),
    "jerk": ("meter / second ** 3", "900 m/s^3"),
    "angular jerk": ("radian / second ** 3", "9000 rad/s^3"),
    "mass": ("kilogram", "2.5 kg"),
    "moment of inertia": ("kilogram * meter ** 2", "0.02 kg m^2"),
    "force": ("newton", "120 N"),
    "torque": ("newton * meter", "0.4 N m"),
    "power": ("watt", "500 W"),
    "pressure": ("newton / meter ** 2", "210 GPa"),
    "stiffness": ("newton / meter", "3 N/mm"),
    "torsional stiffness": ("newton * meter / radian", "0.4 N m/deg"),
    "viscous friction": ("newton * second / meter", "5 N s/m"),
    "rotary viscous friction": ("newton * meter * second / radian", "0.01 N m s/rad"),
}

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)(?:/([1-9]\d{0,8})(?!\d))?\s*(.*)")
_UNIT = re.compile(r"[A-Za-zµ°_]+(?:\s*(?:\^|\*\*)\s*-?[1-4])?")
_LONGEST = 60


def quantity(value: Any, dimension: str, name: str) -> float:  # noqa: ANN401 - it is checked here
    """A quantity such as "616 mm/s" as a float in SI units; `name` is what an error calls it.

    Parameters
    ----------
    value
        Text: a number and its unit; or a quantity of pint, of any registry. Angles are no bare numbers: 45 deg,
        0.5 rad, 1 turn.
    dimension
        What is asked, one of `DIMENSIONS`.
    name
        What an error calls it.

    Raises
    ------
    InputError
        If there is no unit, it is not known, or it is one of another dimension; the error names both dimensions.

    Examples
    --------
    >>> quantity("616 mm/s", "velocity", "limit"), round(quantity("200 rpm", "angular velocity", "speed"), 6)
    (0.616, 20.943951)
    >>> quantity("35 mm", "velocity", "limit")
    Traceback (most recent call last):
    optlaws.errors.InputError: limit must be a velocity such as '616 mm/s', but '35 mm' is a length
    """
    value = written(value)
    number, unit = _parts(value, dimension, name)
    asked = _registry().parse_units(DIMENSIONS[dimension][0])
    if unit.dimensionality != asked.dimensionality:
        raise InputError(f"{_asks(dimension, name)}, but {shortened(value)} is {_kind(unit)}")
    return finite(float(_registry().Quantity(number, unit).to(asked).magnitude), name)


def either(value: Any, dimensions: tuple[str, ...], name: str) -> tuple[str, float]:  # noqa: ANN401
    """A quantity that may be of several dimensions: which it is, and its value in SI units.

    Raises
    ------
    InputError
        If it is of none of them.

    Examples
    --------
    >>> either("0.1 s", ("angle", "time"), "duration")
    ('time', 0.1)
    """
    value = written(value)
    _, unit = _parts(value, dimensions[0], name)
    for dimension in dimensions:
        if unit.dimensionality == _registry().parse_units(DIMENSIONS[dimension][0]).dimensionality:
            return dimension, quantity(value, dimension, name)
    kinds = " or ".join(f"{_article(kind)} such as {DIMENSIONS[kind][1]!r}" for kind in dimensions)
    raise InputError(f"{name} must be {kinds}, but {shortened(value)} is {_kind(unit)}")


def written(value: Any) -> Any:  # noqa: ANN401 - whatever is given
    """A quantity of pint as the text that says the same, in SI units where its own are not known here; else the value.

    Examples
    --------
    >>> from pint import Quantity
    >>> written(Quantity(35, "mm/s")), written("35 mm")
    ('35.0 mm/s', '35 mm')
    """
    if type(value).__module__.partition(".")[0] != "pint" or not hasattr(value, "units"):
        return value
    unit = f"{value.units:~C}"
    if _known_unit(unit) is None:
        value = value.to_base_units()
        unit = f"{value.units:~C}"
    return f"{float(value.magnitude)!r} {unit}"


class Given(NamedTuple):
    """A quantity in the very unit in which it was given."""

    dimension: str
    number: float
    unit: str

    def same_unit(self, value: Any, name: str) -> float:  # noqa: ANN401 - a quantity
        """Another quantity of the same dimension, as a number of this unit.

        Raises
        ------
        InputError
            If it is wrong, or of another dimension.
        """
        return quantity(value, self.dimension, name) / quantity(f"1 {self.unit}", self.dimension, name)


def given_quantity(value: Any, dimensions: tuple[str, ...], name: str) -> Given:  # noqa: ANN401 - it is checked here
    """A quantity of one of several dimensions, in the unit in which it is written: tables of machines are in such.

    Raises
    ------
    InputError
        If it is of none of them.

    Examples
    --------
    >>> given_quantity("35 mm", ("length", "angle"), "stroke")
    Given(dimension='length', number=35.0, unit='mm')
    """
    dimension, _ = either(value, dimensions, name)
    match = _NUMBER.fullmatch(written(value))
    if match is None:
        raise AssertionError  # it has been read above
    return Given(dimension, _number(match), match[3].strip())


def _parts(value: Any, dimension: str, name: str) -> tuple[float, Any]:  # noqa: ANN401
    if real(value) is not None:
        raise InputError(f"{_asks(dimension, name)}, got {shortened(value)} without a unit")
    match = _NUMBER.fullmatch(value) if isinstance(value, str) and len(value) <= _LONGEST else None
    if match is None:
        raise InputError(f"{_asks(dimension, name)}, got {shortened(value)}")
    number, unit = _number(match), match[3].strip()
    if not unit:
        raise InputError(f"{_asks(dimension, name)}, got {shortened(value)} without a unit")
    if not isfinite(number):
        raise InputError(f"{name} must be finite, got {shortened(value)}")
    return number, _unit(unit, value, dimension, name)


def _number(match: re.Match[str]) -> float:
    """A number, or a share such as 1/12."""
    return float(match[1]) / int(match[2] or 1)


def _unit(text: str, value: str, dimension: str, name: str) -> Any:  # noqa: ANN401 - pint's
    unit = _known_unit(text)
    if unit is None:
        raise InputError(f"{_asks(dimension, name)}, but the unit of {shortened(value)} is not known")
    return unit


def _known_unit(text: str) -> Any:  # noqa: ANN401 - pint's, or None
    """The unit that a text means; only names, their powers, products and quotients are read, so nothing runs away."""
    from pint.errors import PintError

    words = re.sub(r"(?<=[\w°])[\s·](?=[A-Za-zµ°])", "*", text)
    if re.fullmatch(rf"(?:1\s*/\s*)?{_UNIT.pattern}(?:\s*[*/]\s*{_UNIT.pattern})*", words) is not None:
        try:
            return _registry().parse_units(words.replace("^", "**"))
        except (PintError, ValueError, TypeError):
            pass
    return None


def _asks(dimension: str, name: str) -> str:
    return f"{name} must be {_article(dimension)} such as {DIMENSIONS[dimension][1]!r}"


def _article(dimension: str) -> str:
    return f"{'an' if dimension[0] in 'aeiou' else 'a'} {dimension}"


def _kind(unit: Any) -> str:  # noqa: ANN401 - pint's
    """What a unit measures, in words."""
    for dimension, (known, _) in DIMENSIONS.items():
        if _registry().parse_units(known).dimensionality == unit.dimensionality:
            return _article(dimension)
    return f"of dimension {unit.dimensionality}"


@cache
def _registry() -> UnitRegistry[Any]:
    from pint import UnitRegistry

    registry: UnitRegistry[Any] = UnitRegistry(None, cache_folder=None)
    registry.load_definitions(_DEFINITIONS.strip().splitlines())
    return registry
