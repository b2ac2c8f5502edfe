"""Quantities: the kinds that are limited, what people write as floats in SI units, and the units that tables show.

SI units are metres, radians and seconds. A number without a unit is in SI units, and refused where it could be of
several dimensions, as a displacement in m or rad.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import Enum
from fractions import Fraction
from functools import lru_cache
from math import inf, isfinite, pi
from typing import Any, ClassVar, NamedTuple, Self

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import finite, real
from optlaws.sentences import Amount

# an angle has a dimension of its own here, so that 45 deg is no bare number and 200 rpm no frequency in Hz
_BASES = {"angle": "rad radian", "length": "m meter metre", "mass": "g gram", "time": "s sec second"}
#: other units by their names, each a number of others
_DERIVED: dict[str, tuple[int | str | Fraction, str]] = {
    "min minute": (60, "s"),
    "h hour": (60, "min"),
    "in inch inches": ("0.0254", "m"),
    "ft foot feet": ("0.3048", "m"),
    "mil thou": ("0.001", "in"),
    "dm decimeter decimetre": ("0.1", "m"),
    "deg degree °": (Fraction(pi) / 180, "rad"),
    "gon gradian": ("0.9", "deg"),
    "rev revolution turn r U": (360, "deg"),
    "rpm revolutions_per_minute": (1, "rev/min"),
    "rps revolutions_per_second": (1, "rev/s"),
    "cpm cycles_per_minute": (1, "1/min"),
    "lb lbm pound": ("0.45359237", "kg"),
    "oz ounce": (Fraction(1, 16), "lb"),
    "N newton": (1, "kg m/s^2"),
    "lbf": (1, "lb g0"),
    "Nm newton_meter": (1, "N m"),
    "Pa pascal": (1, "N/m^2"),
    "J joule": (1, "N m"),
    "W watt": (1, "J/s"),
    "Hz hertz": (1, "1/s"),
    "g0 g_0 gn g_n standard_gravity": ("9.80665", "m/s^2"),
}
_NAMES = {name: names for names in (*_BASES.values(), *_DERIVED) for name in names.split()}
_PREFIXES = {"nano": -9, "micro": -6, "milli": -3, "centi": -2, "kilo": 3, "mega": 6, "giga": 9}
_PREFIXES |= {"n": -9, "µ": -6, "u": -6, "m": -3, "c": -2, "k": 3, "M": 6, "G": 9}
#: powers of ten from which on lengths, angles and times of machines have no prefix: Mm is a slip of the hand for mm
_NO_PREFIX = 6

#: by dimension: units that errors name, that of SI first, and an example
DIMENSIONS = {
    "length": ("m, cm, mm, um, in, ft or thou", "35 mm"),
    "angle": ("rad, deg, turn or rev", "45 deg"),
    "time": ("s, ms or min", "0.3 s"),
    "frequency": ("Hz, 1/s, 1/min or cpm", "16.7 Hz"),
    "velocity": ("m/s, mm/s, m/min, in/s or ft/min", "616 mm/s"),
    "angular velocity": ("rad/s, deg/s, rpm, rev/s, 1/min or cpm", "200 rpm"),
    "acceleration": ("m/s^2, mm/s^2, in/s^2 or g", "12 m/s^2"),
    "angular acceleration": ("rad/s^2 or deg/s^2", "900 rad/s^2"),
    "jerk": ("m/s^3, mm/s^3, in/s^3 or g/s", "900 m/s^3"),
    "angular jerk": ("rad/s^3", "9000 rad/s^3"),
    "snap": ("m/s^4", "50000 m/s^4"),
    "angular snap": ("rad/s^4", "500000 rad/s^4"),
    "mass": ("kg, g or lb", "2.5 kg"),
    "moment of inertia": ("kg m^2 or lb in^2", "0.02 kg m^2"),
    "force": ("N, kN or lbf", "120 N"),
    "torque": ("N m, Nm or lbf in", "0.4 N m"),
    "power": ("W or kW", "500 W"),
    "energy": ("J", "12 J"),
    "pressure": ("Pa, MPa or GPa", "210 GPa"),
    "stiffness": ("N/m, N/mm or lbf/in", "3 N/mm"),
    "torsional stiffness": ("N m/rad", "0.4 N m/deg"),
    "viscous friction": ("N s/m", "5 N s/m"),
    "rotary viscous friction": ("N m s/rad", "0.01 N m s/rad"),
}
#: dimensions in which g is not a gram but the acceleration of gravity
_OF_GRAVITY = {"acceleration", "jerk", "snap"}

TURN = 2.0 * pi
MOST_SCALE = 1e30
#: the displacement of a motion and its derivatives, as tables and pictures call them
QUANTITIES = ("position", "velocity", "acceleration", "jerk")

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)(?:/([1-9]\d{0,8})(?!\d))?\s*(.*)")
_POWER = r"(g0|[A-Za-zµ°_]+)(?:\s*(?:\^|\*\*)\s*(-?[1-4])|([2-4]))?"
_FACTORS = re.compile(rf"([*/]?)\s*{_POWER}")
_UNIT = re.compile(rf"(?:1\s*/\s*)?{_POWER}(?:\s*[*/]\s*{_POWER})*")
_PRODUCT = re.compile(r"(?<=[\w°])[\s·](?=[A-Za-zµ°])")
#: g as a unit of its own
_G = re.compile(r"(?<![A-Za-zµ_])g(?![A-Za-z_0])")
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
    digits: ClassVar[str] = ""

    def __new__(cls, number: float, unit: str) -> Self:
        text = super().__new__(cls, f"{number:{cls.digits}} {unit}")
        text.number, text.unit = number, unit
        return text

    def __getnewargs__(self) -> tuple[float, str]:  # type: ignore[override] # a text has itself alone
        return self.number, self.unit


class Derived(Exact):
    """A quantity that follows from another entry of the same value, and gives way to it where that is replaced.

    >>> period = Derived(0.1 + 0.2, "s")
    >>> period, period.number
    ('0.3 s', 0.30000000000000004)
    """

    __slots__ = ()
    digits = ".12g"


def quantity(
    value: Any, dimension: str | tuple[str, ...], name: str, *, above: float = -inf, bare: bool = False
) -> float:
    """A quantity such as "616 mm/s" as a float in SI units; errors call it `name`.

    Parameters
    ----------
    value
        Text: a number, with a decimal point, and its unit; or a quantity of pint, of any registry. An angular velocity
        in 1/min or cpm is one in turns. In an acceleration g is that of gravity, elsewhere a gram. A number is one in
        SI units, if there is one dimension.
    dimension
        The required dimension, one of `DIMENSIONS`, or several of which it may have any.
    name
        What an error calls it.
    above
        What it must be above, in SI units.
    bare
        Whether what has no unit is taken as it is: an array of numbers, or a number of a dimension that is known
        elsewhere, in SI units.

    Raises
    ------
    InputError
        If a text has no unit, or a number could be of several dimensions; if a unit is not known, or one of another
        dimension: the error names both, and the units that are known. If it is not above what it must be.

    Examples
    --------
    >>> quantity("616 mm/s", "velocity", "limit"), round(quantity("200 rpm", "angular velocity", "speed"), 6)
    (0.616, 20.943951)
    >>> quantity(0.3, "time", "period"), quantity(1.5, ("length", "angle"), "free", bare=True)
    (0.3, 1.5)
    >>> quantity("35 mm", "velocity", "limit")
    Traceback (most recent call last):
    optlaws.errors.InputError: limit must be a velocity such as '616 mm/s', but '35 mm' is a length
    """
    if bare and not isinstance(value, str) and not hasattr(value, "units"):
        return value  # type: ignore[no-any-return] # as it is
    number = given_quantity(value, (dimension,) if isinstance(dimension, str) else dimension, name).size
    if not number > above:
        raise InputError(f"{name} must be above {above:g}, got {shortened(value)}")
    return number


def check_scale(number: float, unit: str, name: str, value: Any) -> None:
    """Refuse a time or a stroke that is nearer to 0, or greater, than any of a machine; 0 is left to what reads it."""
    if number and not 1.0 / MOST_SCALE <= abs(number) <= MOST_SCALE:
        ends = f"{1.0 / MOST_SCALE:g} to {MOST_SCALE:g} {unit}".rstrip()
        raise InputError(f"{name} must be from {ends}, got {shortened(value)}")


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
    return given_quantity(value, dimensions, name)[:2]


def read_stroke(value: Any, back: str = "") -> tuple[str, float]:
    """A stroke above 0, a length or an angle: its dimension, and its size in SI units; `back` is the remedy below 0."""
    dimension, size = either(value, ("length", "angle"), "stroke")
    if not size > 0.0:
        remedy = back if size < 0.0 else "nothing moves: leave it out, or take a Dwell"
        raise InputError(f"stroke must be above 0, got {shortened(value)}{'; ' if remedy else ''}{remedy}")
    return dimension, size


def table(entries: Any, name: str, example: str) -> Mapping[str, Any]:
    """Entries by name, as limits and drives are given; `example` is one for the error."""
    if not isinstance(entries, Mapping) or not all(isinstance(key, str) for key in entries):
        raise InputError(f"{name} must be a table such as {example}, got {shortened(entries)}")
    return entries


def written(value: Any, dimensions: tuple[str, ...] = ()) -> Any:
    """A quantity of pint as equivalent text, in SI units where its own are unknown here; other values unchanged.

    A number of one dimension is one in SI units.

    >>> from pint import Quantity
    >>> written(Quantity(35, "mm/s")), written("35 mm"), written(0.3, ("time",)), written(0.3, ("time", "angle"))
    ('35.0 mm/s', '35 mm', '0.3 s', 0.3)
    """
    number = real(value)
    if number is not None:
        return Exact(number, _units_of(dimensions[0])[0]) if len(dimensions) == 1 else value
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
    size, unit = (value * MILLI, "mm") if axis == "length" else (value * 360.0 / TURN, "deg")
    return Amount(size, f"{unit}{per}", 9)


def in_degrees(angle: float) -> Amount:
    """An angle in degrees."""
    return Amount(angle * 360.0 / TURN, "deg")


class Given(NamedTuple):
    """A quantity as it was given: its dimension, its size in SI units, and its number in the unit of its text."""

    dimension: str
    size: float
    number: float
    unit: str

    def same_unit(self, value: Any, name: str) -> float:
        """Another quantity of the same dimension, as a number of this unit."""
        return quantity(value, self.dimension, name) / quantity(f"1 {self.unit}", self.dimension, name)


def given_quantity(value: Any, dimensions: tuple[str, ...], name: str) -> Given:
    """A quantity with one of several dimensions, in its written unit too, as tables of machines have it.

    >>> given_quantity("35 mm", ("length", "angle"), "stroke")
    Given(dimension='length', size=0.035, number=35.0, unit='mm')
    """
    value = written(value, dimensions)
    number, unit = _parts(value, dimensions, name)
    for dimension in dimensions:
        factor = _si_factor(unit, dimension)
        if factor is not None:
            size = finite(number * factor, name)
            if dimension == "time":  # derivatives are divided by its powers
                check_scale(size, "s", name, value)
            return Given(dimension, size, number, unit)
    turns_or_radians = dimensions == ("angular velocity",) and _si_factor(unit, "frequency") is not None
    remedy = ": write rev/s or rad/s" if turns_or_radians else ""
    raise InputError(f"{_asks(dimensions, name)}, but {shortened(value)} is {_kind(unit)}{remedy}")


def _parts(value: Any, dimensions: tuple[str, ...], name: str) -> tuple[float, str]:
    """The number of a quantity, and the text of its unit, which is known."""
    if isinstance(value, Exact):
        return finite(value.number, name), value.unit
    text = value if isinstance(value, str) and len(value) <= _LONGEST else ""
    # with the signs of print as keyboards have them
    match = _NUMBER.fullmatch(_POWERS.sub("^-", text.translate(_SIGNS)))
    number, unit = (float(match[1]) / int(match[2] or 1), match[3].strip()) if match else (0.0, "")  # or a share: 1/12
    if unit and isfinite(number) and _known_unit(unit) is not None:
        return number, unit
    asks = _asks(dimensions, name)
    if real(value) is not None or (match is not None and not unit):
        example = DIMENSIONS[dimensions[0]][1]
        raise InputError(
            f"{asks}, got {shortened(value)} without a unit: write it as text with its unit, as in {example!r}"
        )
    parted = _SEPARATED.match(text)
    if parted is not None:
        raise InputError(f"{asks}, got {shortened(value)}: {_with_a_point(value, parted.group())}")
    if match is None:
        raise InputError(f"{asks}, got {shortened(value)}")
    if not isfinite(number):
        raise InputError(f"{name} must be finite, got {shortened(value)}")
    near = unit.lower()
    if _known_unit(near) is not None and any(_si_factor(near, each) is not None for each in dimensions):
        raise InputError(f"{asks}, but the unit of {shortened(value)} is not known; did you mean {near}?")
    known = " or ".join(f"{_article(each)} in {DIMENSIONS[each][0]}" for each in dimensions)
    raise InputError(f"{asks}, but the unit of {shortened(value)} is not known: write {known}")


def _with_a_point(text: str, number: str) -> str:
    """How a number with a comma or another sign in it is to be written; whether it parts thousands is not guessed."""
    whole, _, rest = number.partition(",")
    if not rest.isdigit() or "." in whole or len(rest) == 3:
        return "write thousands with no sign between them, and decimals behind a point"
    return f"decimals are behind a point, not a comma: write {text.replace(number, f'{whole}.{rest}').strip()!r}"


class _Unit(NamedTuple):
    """A unit: how many of SI it is, and the powers of `_BASES` in it."""

    size: Fraction
    powers: tuple[int, ...]

    def times(self, other: _Unit, power: int = 1) -> _Unit:
        powers = zip(self.powers, other.powers, strict=True)
        return _Unit(self.size * other.size**power, tuple(a + power * b for a, b in powers))


_BARE = _Unit(Fraction(1), (0,) * len(_BASES))
#: the powers of lengths, angles, times and turns in a time
_MOTIONS = {
    tuple(powers.get(base, 0) for base in _BASES)
    for powers in ({"length": 1}, {"angle": 1}, {"time": 1}, {"angle": 1, "time": -1})
}


@lru_cache(maxsize=256)
def _known_unit(text: str) -> _Unit | None:
    """The unit that a text means: names, their powers, products and quotients; None where one is not known."""
    words = _PRODUCT.sub("*", f"1{text}" if text.startswith("/") else text)
    if _UNIT.fullmatch(words) is None:
        return None
    product = _BARE
    for sign, name, power, bare_power in _FACTORS.findall(words):
        unit = _of_name(name)
        if unit is None:
            return None
        product = product.times(unit, int(power or bare_power or 1) * (-1 if sign == "/" else 1))
    return product


def _of_name(name: str) -> _Unit | None:
    """The unit of a name, which may have a prefix, and an s of several behind more than one letter."""
    for singular in (name, *([name[:-1]] if name.endswith("s") else [])):
        for prefix, power in (("", 0), *_PREFIXES.items()):
            rest = singular.removeprefix(prefix)
            if singular.startswith(prefix) and rest in _NAMES and (singular == name or len(rest) > 1):
                unit = _defined(_NAMES[rest])
                if power < _NO_PREFIX or unit.powers not in _MOTIONS:
                    return unit.times(_Unit(Fraction(10) ** power, _BARE.powers))
    return None


def _defined(names: str) -> _Unit:
    if names in _DERIVED:
        number, other = _DERIVED[names]
        unit = _known_unit(other)
        assert unit is not None  # noqa: S101 - the table is closed
        return unit._replace(size=Fraction(number) * unit.size)
    size = Fraction(1, 1000) if names == _BASES["mass"] else Fraction(1)
    return _Unit(size, tuple(int(names == base) for base in _BASES.values()))


@lru_cache(maxsize=256)
def _si_factor(unit: str, dimension: str) -> float | None:
    """How many units of SI a known unit is, None where it is of another dimension; 1/min of a speed counts turns."""
    meant, powers = _known_unit(unit), _powers(dimension)
    if dimension == "angular velocity" and meant == _known_unit("cpm"):
        meant = _known_unit("rpm")
    if dimension in _OF_GRAVITY and meant is not None and meant.powers != powers:
        meant = _known_unit(_G.sub("g_n", unit))
    return float(meant.size) if meant is not None and meant.powers == powers else None


def _units_of(dimension: str) -> list[str]:
    return re.split(", | or ", DIMENSIONS[dimension][0])


def _powers(dimension: str) -> tuple[int, ...]:
    unit = _known_unit(_units_of(dimension)[0])
    return unit.powers if unit else ()


def _asks(dimensions: tuple[str, ...], name: str) -> str:
    kinds = " or ".join(f"{_article(kind)} such as {DIMENSIONS[kind][1]!r}" for kind in dimensions)
    return f"{name} must be {kinds}"


def _article(dimension: str) -> str:
    return f"{'an' if dimension[0] in 'aeiou' else 'a'} {dimension}"


def _kind(unit: str) -> str:
    """The kind of quantity that a known unit measures, in words."""
    powers = (_known_unit(unit) or _BARE).powers
    for dimension in DIMENSIONS:
        if _powers(dimension) == powers:
            return _article(dimension)
    above, below = (
        [
            f"[{base}]{f' ** {n * sign}' if n * sign > 1 else ''}"
            for base, n in zip(_BASES, powers, strict=True)
            if n * sign > 0
        ]
        for sign in (1, -1)
    )
    return f"of dimension {' / '.join([' * '.join(above) or ('1' if below else 'dimensionless'), *below])}"


class Kind(Enum):
    """What is limited or minimised; values are the numbers that `Cycle.limits_of_segments` has for them."""

    VELOCITY = 1
    ACCELERATION = 2
    JERK = 3
    SNAP = 4
    FORCE = -1
    LOAD = -2
    POWER = -3
    ENERGY = -4
    HEAT = -5
    CURVE = -6  #: the share of a motor's curve of torque over speed
    RMS_FORCE = -7  #: over the whole cycle
    RESIDUAL = -10  #: acceleration of what vibrates on after a move
    RESIDUAL_DISPLACEMENT = -11  #: amplitude of what vibrates on after a move
    VELOCITY_ALONG = -8  #: in the direction of the motion
    ACCELERATION_ALONG = -9  #: likewise: above 0 where it speeds up

    @property
    def order(self) -> int:
        """The order of the derivative; 0 of what is no derivative."""
        along = {Kind.VELOCITY_ALONG: 1, Kind.ACCELERATION_ALONG: 2}
        return along.get(self, max(self.value, 0))

    @property
    def is_driven(self) -> bool:
        """Whether it is of a drive at each time."""
        return self in {Kind.FORCE, Kind.POWER, Kind.CURVE}


#: how many of a unit make one of SI: thousandths, millionths, turns a minute, degrees
MILLI, MICRO, RPM, DEGREES = 1e3, 1e6, 30.0 / pi, 360.0 / TURN
#: the degrees of a turn of the master
TURN_DEG = 360.0
#: units of position, velocity, acceleration and jerk, and how many of them make one of SI
UNITS = {
    "length": (("mm", MILLI), ("mm/s", MILLI), ("m/s²", 1.0), ("m/s³", 1.0)),
    "angle": (("deg", DEGREES), ("deg/s", DEGREES), ("rad/s²", 1.0), ("rad/s³", 1.0)),
}
