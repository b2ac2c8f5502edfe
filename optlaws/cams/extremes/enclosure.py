"""Numbers with what they may be off by: sums, products, quotients and waves of arrays of them, roundings held."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROUNDING = 2.0**-53
_WAVES = 8.0 * ROUNDING  # of sines and cosines as numpy has them
_SMALLEST = 1e-300


@dataclass(frozen=True, eq=False)
class Enclosure:
    """Every number from middle - radius to middle + radius; arrays of one shape.

    Examples
    --------
    >>> third = Enclosure(np.array([1.0]), np.array([0.0])) / Enclosure(np.array([3.0]), np.array([0.0]))
    >>> bool(third.low[0] <= 1 / 3 <= third.high[0]), bool(third.radius[0] < 1e-15)
    (True, True)
    """

    middle: Array
    radius: Array

    @property
    def low(self) -> Array:
        """The least; minus infinity where nothing is known."""
        return np.where(np.isfinite(self.radius), self.middle - self._outer, -np.inf)

    @property
    def high(self) -> Array:
        """The greatest; infinity where nothing is known."""
        return np.where(np.isfinite(self.radius), self.middle + self._outer, np.inf)

    def __getitem__(self, places: Any) -> Enclosure:  # noqa: ANN401 - numpy's
        return Enclosure(self.middle[places], self.radius[places])

    @property
    def _outer(self) -> Array:
        return self.radius + 2.0 * ROUNDING * (self.radius + np.abs(self.middle))

    def __neg__(self) -> Enclosure:
        return Enclosure(-self.middle, self.radius)

    def __add__(self, other: Any) -> Enclosure:  # noqa: ANN401 - a number, an array or an enclosure
        two = _enclosure(other)
        return _rounded(self.middle + two.middle, self.radius + two.radius)

    def __sub__(self, other: Any) -> Enclosure:  # noqa: ANN401
        less = _enclosure(other)
        return _rounded(self.middle - less.middle, self.radius + less.radius)

    def __mul__(self, other: Any) -> Enclosure:  # noqa: ANN401
        two = _enclosure(other)
        with np.errstate(invalid="ignore"):  # 0 times infinity: no bound
            radius = np.abs(self.middle) * two.radius + self.radius * (np.abs(two.middle) + two.radius)
        return _rounded(self.middle * two.middle, radius)

    def __truediv__(self, other: Any) -> Enclosure:  # noqa: ANN401
        return self * _enclosure(other)._reciprocal()

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> Enclosure:  # noqa: ANN401
        return _enclosure(other) - self

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any) -> Any:  # noqa: ANN401 - numpy's
        """What numpy's functions and an array to the left of an operator mean."""
        if method != "__call__" or ufunc not in _FUNCTIONS:
            return NotImplemented
        return _FUNCTIONS[ufunc](*inputs)

    def _reciprocal(self) -> Enclosure:
        size = np.abs(self.middle)
        known = size > self.radius * (1.0 + 4.0 * ROUNDING)
        least, most = np.where(known, size - self.radius, 1.0), size + self.radius
        with np.errstate(over="ignore"):
            low, high = 1.0 / np.where(known, most, 1.0), 1.0 / least
        middle, radius = 0.5 * (high + low), 0.5 * (high - low) + 4.0 * ROUNDING * high
        return Enclosure(np.where(known, np.sign(self.middle) * middle, 0.0), np.where(known, radius, np.inf))

    def root(self) -> Enclosure:
        """The square root, of what is at least 0 of it."""
        low, high = np.sqrt(np.maximum(self.middle - self.radius, 0.0)), np.sqrt(self.middle + self.radius)
        return Enclosure(0.5 * (low + high), 0.5 * (high - low) + 4.0 * ROUNDING * high)

    def sine(self) -> Enclosure:
        """The sine."""
        return Enclosure(np.sin(self.middle), self.radius + _WAVES)

    def cosine(self) -> Enclosure:
        """The cosine."""
        return Enclosure(np.cos(self.middle), self.radius + _WAVES)


def exact(value: Any) -> Enclosure:  # noqa: ANN401 - a number or an array
    """Numbers as they are.

    Examples
    --------
    >>> exact(2.0).high - exact(2.0).low < 2e-15
    np.True_
    """
    middle = np.asarray(value, dtype=np.float64)
    return Enclosure(middle, np.zeros_like(middle))


def _enclosure(value: Any) -> Enclosure:  # noqa: ANN401
    if isinstance(value, Enclosure):
        return value
    return exact(value)


def _rounded(middle: Array, radius: Array) -> Enclosure:
    return Enclosure(middle, (radius + ROUNDING * np.abs(middle)) * (1.0 + 8.0 * ROUNDING) + _SMALLEST)


_FUNCTIONS: dict[Any, Callable[..., Enclosure]] = {
    np.sqrt: Enclosure.root,
    np.sin: Enclosure.sine,
    np.cos: Enclosure.cosine,
    np.add: lambda left, right: _enclosure(left) + right,
    np.subtract: lambda left, right: _enclosure(left) - right,
    np.multiply: lambda left, right: _enclosure(left) * right,
    np.divide: lambda left, right: _enclosure(left) / right,
}
