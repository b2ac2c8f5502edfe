"""What a problem says of a constant: fixed, bounded or free."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite
from numbers import Real
from typing import Any

from optlaws.errors import InputError


@dataclass(frozen=True, repr=False)
class Range:
    """A constant between two values, dimensionless; `low` is 0 where there is none, `high` infinite.

    Examples
    --------
    >>> between(1.5, 1.8)
    between(1.5, 1.8)
    """

    low: float = 0.0
    high: float = inf

    def __post_init__(self) -> None:
        for value in (self.low, self.high):
            _check(value)
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


def _check(value: Any) -> None:  # noqa: ANN401 - it is checked here
    if isinstance(value, bool) or not isinstance(value, Real) or not float(value) >= 0.0:
        raise InputError(f"bounds must be numbers of at least 0, got {value!r}")


def between(low: float, high: float) -> Range:
    """At least `low` and at most `high`.

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
    """At most `high`.

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
    """At least `low`.

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


def as_range(value: Any, name: str) -> Range | None:  # noqa: ANN401 - it is checked here
    """A number, a Range, a pair [low, high] or None as a Range or None; `name` is what an error calls it.

    Raises
    ------
    InputError
        If it is none of these.

    Examples
    --------
    >>> as_range(2, "B")
    between(2.0, 2.0)
    """
    if value is None or isinstance(value, Range):
        return value
    if isinstance(value, list | tuple) and len(value) == 2:
        low, high = value
        return Range(0.0 if low is None else low, inf if high is None else high)
    if isinstance(value, bool) or not isinstance(value, Real) or not isfinite(value):
        raise InputError(f"{name} must be a finite number, a range such as between(1.5, 1.8), or None, got {value!r}")
    return Range(float(value), float(value))
