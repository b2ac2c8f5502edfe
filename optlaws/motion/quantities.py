"""Quantities with units, as people write them, converted to floats in SI units (metres, radians, seconds)."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache, lru_cache
from math import isfinite, pi
from typing import TYPE_CHECKING, Any, NamedTuple, Self

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import finite, real
from optlaws.sentences import Amount

if TYPE_CHECKING:
    from pint import UnitRegistry

# an angle has a dimension of its own here, so that 45 deg is no bare number and 200 rpm no frequency in Hz
_DEFINITIONS = """
nano- = 1e-9 = n-
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
inch = 0.0254 * meter = in = inches
foot = 0.3048 * meter = ft = feet
thou = 0.001 * inch = mil
degree = 3.141592653589793 / 180 * radian = deg = °
revolution = 360 * degree = rev = turn = r = U
revolutions_per_minute = revolution / minute = rpm
revolutions_per_second = revolution / second = rps
cycles_per_minute = 1 / minute = cpm
newton = kilogram * meter / second ** 2 = N
newton_meter = newton * meter = Nm
pascal = newton / meter ** 2 = Pa
joule = newton * meter = J
watt = joule / second = W
hertz = 1 / second = Hz
standard_gravity = 9.80665 * meter / second ** 2 = g_n = g_0 = g0 = gn
"""

#: by dimension: the SI unit of computations, and an example for errors
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
    "snap": ("meter / second ** 4", "50000 m/s^4"),
    "angular snap": ("radian / second ** 4", "500000 rad/s^4"),
    "mass": ("kilogram", "2.5 kg"),
    "moment of inertia": ("kilogram * meter ** 2", "0.02 kg m^2"),
    "force": ("newton", "120 N"),
    "torque": ("newton * meter", "0.4 N m"),
    "power": ("watt", "500 W"),
    "energy": ("joule", "12 J"),
    "pressure": ("newton / meter ** 2", "210 GPa"),
    "stiffness": ("newton / meter", "3 N/mm"),
    "torsional stiffness": ("newton * meter / radian", "0.4 N m/deg"),
    "viscous friction": ("newton * second / meter", "5 N s/m"),
    "rotary viscous friction": ("newton * meter * second / radian", "0.01 N m s/rad"),
}

TURN = 2.0 * pi
MOST_SCALE = 1e30
#: the displacement of a motion and its derivatives, as tables and pictures call them
QUANTITIES = ("position", "velocity", "acceleration", "jerk")

#: usual units by what they measure, and how many of SI they are: they are read without pint, which takes long to load
_USUAL: dict[str, dict[str, float]] = {
    "length": {"m": 1.0, "cm": 0.01, "mm": 0.001, "um": 1e-6, "µm": 1e-6, "in": 0.0254},
    "angle": {"rad": 1.0, "deg": pi / 180, "°": pi / 180, "turn": TURN, "rev": TURN},
    "time": {"s": 1.0, "ms": 0.001, "min": 60.0},
    "frequency": {"Hz": 1.0, "1/s": 1.0},
    "velocity": {"m/s": 1.0, "mm/s": 0.001},
    "angular velocity": {"rad/s": 1.0, "deg/s": pi / 180, "rpm": TURN / 60, "rev/s": TURN},
    "acceleration": {"m/s^2": 1.0, "mm/s^2": 0.001},
    "angular acceleration": {"rad/s^2": 1.0, "deg/s^2": pi / 180},
    "jerk": {"m/s^3": 1.0, "mm/s^3": 0.001},
    "angular jerk": {"rad/s^3": 1.0},
    "mass": {"kg": 1.0, "g": 0.001},
    "moment of inertia": {"kg m^2": 1.0},
    "force": {"N": 1.0, "kN": 1000.0},
    "torque": {"N m": 1.0, "Nm": 1.0},
    "power": {"W": 1.0, "kW": 1000.0},
    "pressure": {"MPa": 1e6, "GPa": 1e9},
    "stiffness": {"N/m": 1.0, "N/mm": 1000.0},
    "torsional stiffness": {"N m/rad": 1.0},
    "viscous friction": {"N s/m": 1.0},
    "rotary viscous friction": {"N m s/rad": 1.0},
}
#: further units that errors name
_FURTHER = {
    "length": ("ft", "thou"),
    "frequency": ("1/min", "cpm"),
    "velocity": ("m/min", "in/s", "ft/min"),
    "angular velocity": ("1/min", "cpm"),
    "acceleration": ("in/s^2", "g"),
    "jerk": ("in/s^3", "g/s"),
}
#: dimensions in which g is not a gram but the acceleration of gravity
_OF_GRAVITY = {"acceleration", "jerk", "snap"}
USUAL_UNITS = {unit: (dimension, factor) for dimension, units in _USUAL.items() for unit, factor in units.items()}
#: the dimensions of one unit, between which nothing but what is meant decides
_WORK = {"torque", "energy"}

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)(?:/([1-9]\d{0,8})(?!\d))?\s*(.*)")
_UNIT = re.compile(r"(?:g0|[A-Za-zµ°_]+)(?:\s*(?:\^|\*\*)\s*-?[1-4]|[2-4])?")
#: a power without its sign, as in mm/s2; and g as a unit of its own
_BARE_POWER, _G = re.compile(r"(?<=[A-Za-zµ°])(?=[2-4])"), re.compile(r"(?<![A-Za-zµ_])g(?![A-Za-z_0])")
_LONGEST = 60
#: signs of other keyboards and of print, as the others write them
_SIGNS = str.maketrans({"−": "-", "μ": "µ", "⋅": "·", "²": "^2", "³": "^3", "⁴": "^4", "⁻": "^-", "¹": "1"})
_POWERS = re.compile(r"\^-\^?(?=[1-4])")
_SEPARATED = re.compile(r"\s*[+-]?[\d.]*\d[,_'’]\d[\d.,_'’]*")


class Exact(str):
    """A number of a unit as a quantity, which is known and not read again; as text it is any other one.

    >>> time = Exact(0.1, "s")
    >>> time, quantity(time, "time", "period"), time.number
    ('0.1 s', 0.1, 0.1)
    """

    __slots__ = ("number", "unit")
    number: float
    unit: str

    def __new__(cls, number: float, unit: str) -> Self:
        text = super().__new__(cls, f"{number!r} {unit}")
        text.number, text.unit = number, unit
        return text

    def __getnewargs__(self) -> tuple[float, str]:  # type: ignore[override] # a text has itself alone
        return self.number, self.unit


def quantity(value: Any, dimension: str, name: str) -> float:
    """A quantity such as "616 mm/s" as a float in SI units; errors call it `name`.

    Parameters
    ----------
    value
        Text: a number, with a decimal point, and its unit; or a quantity of pint, of any registry. Angles are no bare
        numbers: 45 deg, 0.5 rad, 1 turn. An angular velocity in 1/min or cpm is one in turns. In an acceleration g is
        that of gravity, elsewhere a gram.
    dimension
        The required dimension, one of `DIMENSIONS`.
    name
        What an error calls it.

    Raises
    ------
    InputError
        If there is no unit, it is not known, or it is one of another dimension; the error names both dimensions, and
        the units that are known.

    Examples
    --------
    >>> quantity("616 mm/s", "velocity", "limit"), round(quantity("200 rpm", "angular velocity", "speed"), 6)
    (0.616, 20.943951)
    >>> quantity("35 mm", "velocity", "limit")
    Traceback (most recent call last):
    optlaws.errors.InputError: limit must be a velocity such as '616 mm/s', but '35 mm' is a length
    """
    value = written(value)
    number, unit = _parts(value, (dimension,), name)
    factor = _si_factor(unit, dimension)
    if factor is None:
        raise InputError(
            f"{_asks((dimension,), name)}, but {shortened(value)} is {_kind(unit)}{_remedy(unit, dimension)}"
        )
    return _measurable(finite(number * factor, name), dimension, name, value)


def _measurable(number: float, dimension: str, name: str, value: Any) -> float:
    """A number; a time is refused whose powers, by which derivatives are divided, would be beyond double precision."""
    if dimension == "time":
        check_scale(number, "s", name, value)
    return number


def check_scale(number: float, unit: str, name: str, value: Any) -> None:
    """Refuse a time or a stroke that is nearer to 0, or greater, than any of a machine; 0 is left to what reads it.

    Raises
    ------
    InputError
        If it is below 1e-30 or above 1e30 of its unit.

    Examples
    --------
    >>> check_scale(1e-300, "s", "period", "1e-300 s")
    Traceback (most recent call last):
    optlaws.errors.InputError: period must be from 1e-30 to 1e+30 s, got '1e-300 s'
    """
    if number and not 1.0 / MOST_SCALE <= abs(number) <= MOST_SCALE:
        ends = f"{1.0 / MOST_SCALE:g} to {MOST_SCALE:g} {unit}".rstrip()
        raise InputError(f"{name} must be from {ends}, got {shortened(value)}")


def positive_quantity(value: Any, dimension: str, name: str) -> float:
    """A quantity above 0 as a float in SI units, as `quantity` reads it.

    Raises
    ------
    InputError
        If it is no such quantity, or not above 0.

    Examples
    --------
    >>> positive_quantity("0 mm", "length", "width")
    Traceback (most recent call last):
    optlaws.errors.InputError: width must be above 0, got '0 mm'
    """
    number = quantity(value, dimension, name)
    if not number > 0.0:
        raise InputError(f"{name} must be above 0, got {shortened(value)}")
    return number


def either(value: Any, dimensions: tuple[str, ...], name: str) -> tuple[str, float]:
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
    number, unit = _parts(value, dimensions, name)
    for dimension in dimensions:
        factor = _si_factor(unit, dimension)
        if factor is not None:
            return dimension, _measurable(finite(number * factor, name), dimension, name, value)
    raise InputError(f"{_asks(dimensions, name)}, but {shortened(value)} is {_kind(unit)}")


def read_stroke(value: Any, back: str = "") -> tuple[str, float]:
    """A stroke above 0: its dimension, and its size in SI units.

    Parameters
    ----------
    value
        A length or an angle.
    back
        The remedy for a stroke below 0.

    Raises
    ------
    InputError
        If it is no length or angle, 0, or below 0.

    Examples
    --------
    >>> read_stroke("0 mm")
    Traceback (most recent call last):
    optlaws.errors.InputError: stroke must be above 0, got '0 mm'; nothing moves: leave it out, or take a Dwell
    """
    dimension, size = either(value, ("length", "angle"), "stroke")
    if not size > 0.0:
        remedy = back if size < 0.0 else "nothing moves: leave it out, or take a Dwell"
        raise InputError(f"stroke must be above 0, got {shortened(value)}{'; ' if remedy else ''}{remedy}")
    return dimension, size


def si_number(value: Any, dimensions: tuple[str, ...], name: str) -> Any:
    """A quantity with one of several dimensions as a float in SI units; bare numbers are not changed.

    Raises
    ------
    InputError
        If it is a text or a quantity of pint and of none of them.

    Examples
    --------
    >>> si_number("60 deg", ("angle",), "swing"), si_number(1.5, ("angle",), "swing")
    (1.047198, 1.5)
    """
    return either(value, dimensions, name)[1] if isinstance(value, str) or hasattr(value, "units") else value


def table(entries: Any, name: str, example: str) -> Mapping[str, Any]:
    """Entries by name, as limits and drives are given.

    Raises
    ------
    InputError
        If they are no table.

    Examples
    --------
    >>> table(["velocity"], "limits", "{'velocity': '2 m/s'}")
    Traceback (most recent call last):
    optlaws.errors.InputError: limits must be a table such as {'velocity': '2 m/s'}, got ['velocity']
    """
    if not isinstance(entries, Mapping) or not all(isinstance(key, str) for key in entries):
        raise InputError(f"{name} must be a table such as {example}, got {shortened(entries)}")
    return entries


def written(value: Any) -> Any:
    """A quantity of pint as equivalent text, in SI units where its own are unknown here; other values unchanged.

    Examples
    --------
    >>> from pint import Quantity
    >>> written(Quantity(35, "mm/s")), written("35 mm")
    ('35.0 mm/s', '35 mm')
    """
    if type(value).__module__.partition(".")[0] != "pint" or not hasattr(value, "units"):
        return value
    from pint.errors import PintError

    try:
        # a gram of pint is one wherever it is given
        read = not re.search(r"\bgram\b", f"{value.units:D}") and _known_unit(f"{value.units:~C}") is not None
        known = value if read else value.to_base_units()
        # a magnitude may be any number, or an array, which has no float that is meant
        return value if getattr(known.magnitude, "ndim", 0) else f"{float(known.magnitude)!r} {known.units:~C}"
    except (PintError, ArithmeticError, TypeError, ValueError):
        return value


def in_small_units(value: float, axis: str, per: str = "") -> Amount:
    """A position in millimetres or degrees; `per` is "/s" of a velocity."""
    if axis == "length":
        return Amount(value * 1e3, f"mm{per}", 9)
    return Amount(value * 360.0 / TURN, f"deg{per}", 9)


def in_degrees(angle: float) -> Amount:
    """An angle in degrees."""
    return Amount(angle * 360.0 / TURN, "deg")


class Given(NamedTuple):
    """A quantity in the very unit in which it was given."""

    dimension: str
    number: float
    unit: str

    def same_unit(self, value: Any, name: str) -> float:
        """Another quantity of the same dimension, as a number of this unit.

        Raises
        ------
        InputError
            If it is wrong, or of another dimension.
        """
        return quantity(value, self.dimension, name) / quantity(f"1 {self.unit}", self.dimension, name)


def given_quantity(value: Any, dimensions: tuple[str, ...], name: str) -> Given:
    """A quantity with one of several dimensions, in its written unit, as tables of machines have it.

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
    match = _NUMBER.fullmatch(_plain(written(value)))
    if match is None:
        raise AssertionError  # it has been read above
    return Given(dimension, _number(match), match[3].strip())


def _parts(value: Any, dimensions: tuple[str, ...], name: str) -> tuple[float, str]:
    """The number of a quantity, and the text of its unit, which is known."""
    if isinstance(value, Exact):
        return value.number, value.unit
    asks = _asks(dimensions, name)
    match = _NUMBER.fullmatch(_plain(value)) if isinstance(value, str) and len(value) <= _LONGEST else None
    if real(value) is not None or (match is not None and not match[3].strip()):
        example = DIMENSIONS[dimensions[0]][1]
        raise InputError(
            f"{asks}, got {shortened(value)} without a unit: write it as text with its unit, as in {example!r}"
        )
    parted = _SEPARATED.match(value) if isinstance(value, str) and len(value) <= _LONGEST else None
    if parted is not None:
        raise InputError(f"{asks}, got {shortened(value)}: {_with_a_point(value, parted.group())}")
    if match is None:
        raise InputError(f"{asks}, got {shortened(value)}")
    number, unit = _number(match), match[3].strip()
    if not isfinite(number):
        raise InputError(f"{name} must be finite, got {shortened(value)}")
    if unit not in USUAL_UNITS and _known_unit(unit) is None:
        known = " or ".join(f"{_article(each)} in {_units_of(each)}" for each in dimensions)
        raise InputError(f"{asks}, but the unit of {shortened(value)} is not known: write {known}")
    return number, unit


def _units_of(dimension: str) -> str:
    """The usual units of a dimension, in words."""
    units = [*_USUAL.get(dimension, ()), *_FURTHER.get(dimension, ())]
    units = [unit for unit in units if unit not in {"°", "µm"}] or [DIMENSIONS[dimension][1].partition(" ")[2]]
    return units[0] if len(units) == 1 else f"{', '.join(units[:-1])} or {units[-1]}"


def _plain(text: str) -> str:
    """A text with the signs of print as keyboards have them."""
    return _POWERS.sub("^-", text.translate(_SIGNS))


def _with_a_point(text: str, number: str) -> str:
    """How a number with a comma or another sign in it is to be written; whether it parts thousands is not guessed."""
    whole, _, rest = number.partition(",")
    if not rest.isdigit() or "." in whole or len(rest) == 3:
        return "write thousands with no sign between them, and decimals behind a point"
    return f"decimals are behind a point, not a comma: write {text.replace(number, f'{whole}.{rest}').strip()!r}"


def _number(match: re.Match[str]) -> float:
    """A number, or a share such as 1/12."""
    return float(match[1]) / int(match[2] or 1)


@lru_cache(maxsize=256)
def _si_factor(unit: str, dimension: str) -> float | None:
    """How many units of SI a known unit is, None where it is of another dimension; 1/min of a speed counts turns."""
    if unit in USUAL_UNITS and (dimension not in _OF_GRAVITY or not _G.search(unit)):
        of, factor = USUAL_UNITS[unit]
        return factor if of == dimension or {of, dimension} == _WORK else None
    si, meant = _registry().parse_units(DIMENSIONS[dimension][0]), _known_unit(unit)
    if dimension == "angular velocity" and str(meant) in {"1 / minute", "cycles_per_minute"}:
        meant *= _registry().parse_units("turn")
    if meant.dimensionality != si.dimensionality and dimension in _OF_GRAVITY:
        meant = _known_unit(_G.sub("g_n", unit))
    if meant.dimensionality != si.dimensionality:
        return None
    return float(_registry().Quantity(1.0, meant).to(si).magnitude)


@lru_cache(maxsize=256)
def _known_unit(text: str) -> Any:
    """The unit that a text means; only names, their powers, products and quotients are read, so nothing runs away."""
    from pint.errors import PintError

    words = re.sub(r"(?<=[\w°])[\s·](?=[A-Za-zµ°])", "*", f"1{text}" if text.startswith("/") else text)
    if re.fullmatch(rf"(?:1\s*/\s*)?{_UNIT.pattern}(?:\s*[*/]\s*{_UNIT.pattern})*", words) is not None:
        try:
            return _registry().parse_units(_BARE_POWER.sub("**", words.replace("^", "**")))
        except (PintError, ValueError, TypeError):
            pass
    return None


def _remedy(unit: str, dimension: str) -> str:
    """The remedy for a frequency that may count turns or radians."""
    frequency = _si_factor(unit, "frequency") is not None
    return ": write rev/s or rad/s" if dimension == "angular velocity" and frequency else ""


def _asks(dimensions: tuple[str, ...], name: str) -> str:
    kinds = " or ".join(f"{_article(kind)} such as {DIMENSIONS[kind][1]!r}" for kind in dimensions)
    return f"{name} must be {kinds}"


def _article(dimension: str) -> str:
    return f"{'an' if dimension[0] in 'aeiou' else 'a'} {dimension}"


def _kind(unit: str) -> str:
    """The kind of quantity that a unit measures, in words."""
    known = _known_unit(unit)
    for dimension, (si, _) in DIMENSIONS.items():
        if _registry().parse_units(si).dimensionality == known.dimensionality:
            return _article(dimension)
    return f"of dimension {known.dimensionality}"


@cache
def _registry() -> UnitRegistry[Any]:
    from pint import UnitRegistry

    registry: UnitRegistry[Any] = UnitRegistry(None, cache_folder=None)
    registry.load_definitions(_DEFINITIONS.strip().splitlines())
    return registry
