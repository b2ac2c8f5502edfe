"""Checks of numbers from users: a function for each kind, whose error names the number and the remedy."""

from __future__ import annotations

import operator
from collections.abc import Iterable
from decimal import ROUND_CEILING, Context
from fractions import Fraction
from math import frexp, inf, isfinite, ldexp, radians
from numbers import Rational, Real
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError

if TYPE_CHECKING:
    import pint

#: numbers of double precision, of any shape
Array: TypeAlias = NDArray[np.float64]
#: complex numbers of double precision, of any shape
Complex: TypeAlias = NDArray[np.complex128]
#: a number with its unit: a text such as "35 mm", or a quantity of pint, of any registry
Quantity: TypeAlias = "str | pint.Quantity[Any]"
#: a bare number in a documented unit, or a quantity with its own unit
NumberOrQuantity: TypeAlias = "float | str | pint.Quantity[Any]"

MAGNITUDE_LIMIT = 1e100
MOST_ORDER = 100
MOST_DEGREE = 200
MOST_PIECE_DEGREE = 30
MOST_PIECES = 1000
MOST_POINTS = 10**9
MOST_TEETH = 10_000
MOST_VELOCITY = 1e50
MOST_TERMS = 400
MOST_EXPONENT = 50
MOST_VALUES = 1_000_000
MOST_DERIVATIVE = 50
MOST_FREQUENCY = 1e5
MOST_WHOLE = 2**63 - 1

_DENOMINATOR_BITS = 100_000


def whole(value: Any, name: str, least: int = 0, most: int = MOST_WHOLE) -> int:
    """The value as an int, if it is an integer from `least` to `most`; errors call it `name`.

    Examples
    --------
    >>> whole(3, "nu")
    3
    """
    try:
        number = None if isinstance(value, bool | np.bool) else operator.index(value)
    except TypeError:
        number = None
    if number is None or number < least:
        text = "the text " * isinstance(value, str)
        raise InputError(f"{name} must be an integer of at least {least}, got {text}{shortened(value)}")
    if number > most:
        raise InputError(f"{name} must be an integer of at most {most}, got {shortened(value)}")
    return number


def real(value: Any) -> float | None:
    """The value as a float, infinite or not; None for anything but a real number within the range of floats.

    Examples
    --------
    >>> real(2), real("2"), real(True), real(10**400)
    (2.0, None, None, None)
    """
    if type(value) is float:
        # most are, and asking for the kind of number takes ten times as long
        return None if value != value else value  # noqa: PLR0124 - NaN
    if isinstance(value, bool | np.bool) or not isinstance(value, Real):
        return None
    try:
        number = float(value)
    except (OverflowError, ValueError):
        return None
    return None if number != number else number  # noqa: PLR0124 - NaN


def bounded(value: float) -> float | None:
    """The value for JSON, which has no infinity: None where there is no bound."""
    return value if isfinite(value) else None


def chop(value: float, size: float, share: float) -> float:
    """The value, or 0 where it is no more than rounding: a share of a size.

    Examples
    --------
    >>> chop(-6.77e-16, 5.528, 1e-12), chop(1.5, 2.0, 1e-12)
    (0.0, 1.5)
    """
    return 0.0 if abs(value) <= share * abs(size) else value


def chopped(values: Array, size: float, share: float) -> Array:
    """The values of an array, 0 where they are no more than rounding: a share of a size."""
    return np.where(np.abs(values) <= share * abs(size), 0.0, values)


def rounded_up(value: float, digits: int) -> float:
    """The least number of so many digits that is no less.

    >>> rounded_up(18.94701, 4), rounded_up(0.07, 4), rounded_up(0.0, 4)
    (18.95, 0.07, 0.0)
    """
    return float(Context(prec=digits, rounding=ROUND_CEILING).create_decimal(repr(float(value))))


def power_of_two(size: float) -> float:
    """The greatest power of 2 that is not above a size; 1 where the size is 0 or not finite.

    Numbers are divided by it, and multiplied again, without rounding.

    Examples
    --------
    >>> power_of_two(6.0), power_of_two(0.3), power_of_two(0.0)
    (4.0, 0.25, 1.0)
    """
    return ldexp(0.5, frexp(size)[1]) if 0.0 < size < inf else 1.0


def finite(value: Any, name: str) -> float:
    """The value as a float; errors call it `name`.

    Examples
    --------
    >>> finite(1, "b0")
    1.0
    """
    number = real(value)
    if number is None or not isfinite(number):
        united = hasattr(value, "units") or (isinstance(value, str) and value.strip()[:1] in set("+-.0123456789"))
        remedy = ": give the number alone, without a unit and not as text" if united else ""
        raise InputError(f"{name} must be a finite real number, got {shortened(value)}{remedy}")
    if abs(number) > MAGNITUDE_LIMIT:
        raise InputError(f"{name} must not exceed {MAGNITUDE_LIMIT:g} in magnitude, got {number!r}")
    return number


def positive(value: Any, name: str) -> float:
    """The value as a float above 0."""
    number = finite(value, name)
    if number <= 0.0:
        raise InputError(f"{name} must be above 0, got {shortened(value)}")
    return number


def circular_frequency(value: Any, name: str = "frequency") -> float:
    """Radians of a free vibration in the rise, as a float above 0 and at most 100 000."""
    if isinstance(value, str) or hasattr(value, "units"):
        raise InputError(
            f"{name} is dimensionless, the radians of the free vibration within the motion, got {shortened(value)}: "
            "give 2 pi times the frequency in Hz and the duration in s, as Follower.from_vibration does"
        )
    number = positive(value, name)
    if number > MOST_FREQUENCY:
        raise InputError(
            f"{name} must not exceed {MOST_FREQUENCY:g}, where a follower is as good as rigid, got {number!r}"
        )
    return number


def derivative(value: Any, name: str = "nu") -> int:
    """The order of a derivative as an int, at most 50."""
    return whole(value, name, most=MOST_DERIVATIVE)


def not_negative(value: Any, name: str) -> float:
    """The value as a float of at least 0."""
    number = finite(value, name)
    if number < 0.0:
        raise InputError(f"{name} must be at least 0, got {shortened(value)}")
    return number


def numbers(values: Any, name: str, most: int = MOST_VALUES) -> tuple[float, ...]:
    """The values as a tuple of floats; errors call them `name`."""
    if type(values) in {tuple, list} and len(values) <= most and all(map(is_usual, values)):
        return tuple(values)
    return tuple(float(value) for value in fractions(values, name, most))


def is_usual(value: object) -> bool:
    """Whether a value is a float that `finite` takes."""
    return type(value) is float and -MAGNITUDE_LIMIT <= value <= MAGNITUDE_LIMIT


def fractions(values: Iterable[Any], name: str, most: int = MOST_TERMS) -> list[Fraction]:
    """The exact values of ints, floats and Fractions; errors call them `name`.

    Examples
    --------
    >>> fractions([1, 0.5], "z")
    [Fraction(1, 1), Fraction(1, 2)]
    """
    return [_fraction(value, f"{name}[{i}]") for i, value in enumerate(listed(values, name, most))]


def listed(values: Any, name: str, most: int = MOST_TERMS) -> list[Any]:
    """The values as a list up to a given length."""
    items: list[Any] = []
    try:
        if isinstance(values, str | bytes):
            raise TypeError  # noqa: TRY301 - text is no sequence of numbers
        for value in values:
            items.append(value)
            if len(items) > most:
                raise InputError(f"{name} may have {most} values, got more")
    except TypeError:
        raise InputError(f"{name} must be a sequence of real numbers, got {shortened(values)}") from None
    return items


def _fraction(value: Any, name: str) -> Fraction:
    if is_usual(value):
        return Fraction(value)
    if not isinstance(value, bool) and isinstance(value, Rational):
        exact = Fraction(int(value.numerator), int(value.denominator))
    elif (number := real(value)) is not None and isfinite(number):
        exact = Fraction(number)
    else:
        raise InputError(f"{name} must be a finite real number, got {shortened(value)}")
    if abs(exact) > MAGNITUDE_LIMIT:
        raise InputError(f"{name} must not exceed {MAGNITUDE_LIMIT:g} in magnitude: a law is dimensionless")
    if exact.denominator.bit_length() > _DENOMINATOR_BITS:
        raise InputError(
            f"{name} must be a fraction of few digits, got {exact.denominator.bit_length()} bits below its line"
        )
    return exact


def times(k: Any) -> Array:
    """Dimensionless times as floats, of any shape.

    Examples
    --------
    >>> times([0, 1])
    array([0., 1.])
    """
    given = _array(k)
    if given is None:
        raise InputError(f"k must be real numbers in [0, 1], got {shortened(k)}")
    inside = (given >= 0.0) & (given <= 1.0)
    if not inside.all():
        raise InputError(f"k must be in [0, 1], got {float(given[~inside].flat[0])!r}")
    return given


def real_times(k: Any) -> Array:
    """Finite times of any shape."""
    given = _array(k)
    if given is None or not np.isfinite(given).all():
        raise InputError(f"k must be finite real numbers, got {shortened(k)}")
    return given


def _array(values: Any) -> Array | None:
    """The values as floats; None where one is no real number."""
    try:
        given = np.asarray(values)
    except (ValueError, TypeError, OverflowError, RecursionError):
        return None
    if given.dtype.kind not in "fiu" and given.size:
        return None
    return given.astype(np.float64)


def number_or_array(values: Array) -> float | Array:
    """Values in the shape of the given argument: a float for a scalar, else an array."""
    return values if np.ndim(values) else float(values)


def deg(angle: float) -> float:
    """An angle given in degrees, in radians: the library computes in these.

    Examples
    --------
    >>> deg(180)
    3.141592653589793
    """
    return radians(angle)
