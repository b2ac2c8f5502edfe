"""Ranges of constants in a problem: fixed, bounded or free."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from typing import Any

from optlaws.echo import CONSTANTS, shortened, unknown_key
from optlaws.errors import InputError
from optlaws.numbers import finite, real
from optlaws.synthesis.problem.constants import MAKERS, WITHOUT_ARGUMENTS, Functional
from optlaws.synthesis.problem.named_constants import is_named, named


@dataclass(frozen=True, repr=False)
class Range:
    """A constant between two values, dimensionless; without a bound, `low` is 0 and `high` infinite.

    Examples
    --------
    >>> between(1.5, 1.8)
    between(1.5, 1.8)
    """

    low: float = 0.0
    high: float = inf

    def __post_init__(self) -> None:
        for value in (self.low, self.high):
            _bound(value)
        if not isfinite(self.low) or self.low > self.high:
            raise InputError(f"the lower bound {self.low!r} must be finite and at most the upper one, {self.high!r}")

    def __repr__(self) -> str:
        if self.high == inf:
            return f"at_least({self.low!r})"
        return f"at_most({self.high!r})" if self.low == 0.0 else f"between({self.low!r}, {self.high!r})"

    @property
    def fixed(self) -> bool:
        """Whether the constant has one value."""
        return self.low == self.high


def _bound(value: Any) -> float:
    number = real(value)
    if number is None or number < 0.0:
        raise InputError(f"bounds must be numbers of at least 0, got {shortened(value)}")
    return finite(number, "a bound") if isfinite(number) else number


def between(low: float, high: float) -> Range:
    """A range of at least `low` and at most `high`.

    Raises
    ------
    InputError
        If they are not numbers of at least 0 in this order.

    Examples
    --------
    >>> between(1.5, 1.8).high
    1.8
    """
    return Range(low, high)


def at_most(high: float) -> Range:
    """A range of values at most `high`.

    Raises
    ------
    InputError
        If it is not a number of at least 0.

    Examples
    --------
    >>> at_most(60)
    at_most(60)
    """
    return Range(0.0, high)


def at_least(low: float) -> Range:
    """A range of values at least `low`.

    Raises
    ------
    InputError
        If it is not a finite number of at least 0.

    Examples
    --------
    >>> at_least(1.5).low
    1.5
    """
    return Range(low, inf)


def as_range(value: Any, name: str) -> Range | None:
    """A number, a Range, a pair [low, high] or None as a Range or None; errors call it `name`.

    >>> as_range(2, "B")
    between(2.0, 2.0)
    """
    if value is None or isinstance(value, Range):
        return value
    if isinstance(value, list | tuple) and len(value) == 2:
        low, high = value
        return _named_range(0.0 if low is None else low, inf if high is None else high, name)
    number = real(value)
    if number is None or not isfinite(number):
        raise InputError(
            f"{name} must be a finite number, a range such as between(1.5, 1.8), or None, got {shortened(value)}"
        )
    return _named_range(number, number, name)


def _named_range(low: Any, high: Any, name: str) -> Range:
    try:
        return Range(low, high)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None


def beyond(name: str, least: str, limits: Range) -> str:
    """The text of an error: a range ends where a constant begins.

    >>> beyond("residual", "0", at_most(0.0))
    'residual of at most 0.0 excludes every law: it must be above 0; give a greater bound, or minimise it'
    """
    return (
        f"{name} of at most {limits.high!r} excludes every law: it must be above {least}; give a greater bound, or "
        "minimise it"
    )


class Bounds(Mapping[Functional, Range]):
    """Ranges of constants by constant; frozen and hashable. Known constants may be given by name.

    >>> Bounds({"rms_c": at_most(4), "snap": None})
    {'rms_c': at_most(4)}
    """

    def __init__(self, given: Any = ()) -> None:
        if not isinstance(given, Mapping) and given != ():
            raise InputError(f"bounds must be a dict such as {{'rms_c': at_most(5)}}, got {shortened(given)}")
        self._ranges: dict[Functional, Range] = {}
        for key, value in dict(given).items():
            constant = _constant(key)
            if constant.name in {bounded.name for bounded in self._ranges}:
                raise InputError(f"bounds name {shortened(constant.title)} twice")
            limits = as_range(value, constant.title)
            if limits is not None and limits.high <= 0.0:
                raise InputError(beyond(constant.title, "0", limits))
            if limits is not None and limits != Range():
                self._ranges[constant] = limits

    def __getitem__(self, key: Functional | str) -> Range:
        if isinstance(key, str):
            return {constant.name: value for constant, value in self._ranges.items()}[key]
        return self._ranges[key]

    def __iter__(self) -> Iterator[Functional]:
        return iter(self._ranges)

    def __len__(self) -> int:
        return len(self._ranges)

    def __hash__(self) -> int:
        return hash(frozenset(self._ranges.items()))

    def __repr__(self) -> str:
        known = {constant: repr(constant.name) if is_named(constant) else repr(constant) for constant in self._ranges}
        return "{" + ", ".join(f"{known[constant]}: {value!r}" for constant, value in self._ranges.items()) + "}"


def _constant(key: Any) -> Functional:
    if isinstance(key, Functional):
        return key
    if not isinstance(key, str):
        raise InputError(f"bounds are of constants such as 'rms_c' or rms_c, got {shortened(key)}")
    if "(" in key:
        return named(key)
    if key not in WITHOUT_ARGUMENTS:
        raise InputError(unknown_key(key, (*WITHOUT_ARGUMENTS, *MAKERS), "constant", words=CONSTANTS))
    return WITHOUT_ARGUMENTS[key]


def read_bounds(most: Sequence[str], least: Sequence[str] = ()) -> dict[str, Range]:
    """Bounds from texts such as "rms_c=4": the greatest and the least values.

    >>> read_bounds(["rms_c=4", "snap=900"], ["rms_c=3.5"])
    {'rms_c': between(3.5, 4.0), 'snap': at_most(900.0)}
    """
    sides: tuple[dict[str, float], dict[str, float]] = ({}, {})
    for texts, side in ((least, sides[0]), (most, sides[1])):
        for text in texts:
            name, _, value = (part.strip() for part in text.rpartition("="))
            if "=" in name.partition("(")[0]:
                value = ""  # one sign too many; within brackets they belong to arguments
            try:
                number = float(value)
            except ValueError:
                raise InputError(
                    f"a bound is written as a constant = a number, such as rms_c=4, got {shortened(text)}"
                ) from None
            if name in side:
                raise InputError(f"{name!r} is bounded twice on one side")
            side[name] = number
    lows, highs = sides
    names = dict.fromkeys((*highs, *lows))
    return {name: _named_range(lows.get(name, 0.0), highs.get(name, inf), name) for name in names}
