"""Interval arithmetic on arrays, rounded outward: sums, products, quotients, roots and waves of middles and radii."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from optlaws.numbers import Array
from optlaws.tolerances import ROUNDOFF, TINY, WAVE_ROUNDING

_FEW = 2  # products whose sum is taken one by one
_WIDER = 1.0 + 8.0 * ROUNDOFF
_MANY = 4096  # numbers of products that are summed one by one too: a block of them all would not stay in the cache


@dataclass(slots=True, eq=False)  # frozen ones take thrice as long to make, and they are made by the ten thousand
class Interval:
    """Every number from middle - radius to middle + radius; arrays of one shape.

    >>> third = Interval(np.array([1.0]), np.array([0.0])) / Interval(np.array([3.0]), np.array([0.0]))
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

    def __getitem__(self, places: Any) -> Interval:
        return Interval(self.middle[places], self.radius[places])

    @property
    def _outer(self) -> Array:
        return self.radius + 2.0 * ROUNDOFF * (self.radius + np.abs(self.middle))

    def __neg__(self) -> Interval:
        return Interval(-self.middle, self.radius)

    def __add__(self, other: Any) -> Interval:
        if isinstance(other, Interval):
            return _rounded(self.middle + other.middle, self.radius + other.radius)
        return _rounded(self.middle + other, self.radius)

    def __sub__(self, other: Any) -> Interval:
        return self.__add__(-other)

    def __mul__(self, other: Any) -> Interval:
        with np.errstate(invalid="ignore"):  # 0 times infinity: no bound
            if not isinstance(other, Interval):
                return _rounded(self.middle * other, self.radius * abs(other))
            return _rounded(self.middle * other.middle, _radius_of_product(self, other))

    def __truediv__(self, other: Any) -> Interval:
        if isinstance(other, int | float):
            return _rounded(self.middle / other, self.radius / abs(other))
        return self.__mul__(_interval(other)._reciprocal())

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> Interval:
        return (-self).__add__(other)

    def __rtruediv__(self, other: Any) -> Interval:
        return self._reciprocal().__mul__(other)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any) -> Any:
        """The meaning of numpy's functions, and of an array to the left of an operator."""
        if method != "__call__" or ufunc not in _FUNCTIONS:
            return NotImplemented
        return _FUNCTIONS[ufunc](*inputs)

    def _reciprocal(self) -> Interval:
        size = np.abs(self.middle)
        known = size > self.radius * (1.0 + 4.0 * ROUNDOFF)
        least, most = np.where(known, size - self.radius, 1.0), size + self.radius
        with np.errstate(over="ignore"):
            low, high = 1.0 / np.where(known, most, 1.0), 1.0 / least
        middle, radius = 0.5 * (high + low), 0.5 * (high - low) + 4.0 * ROUNDOFF * high
        return Interval(np.where(known, np.sign(self.middle) * middle, 0.0), np.where(known, radius, np.inf))

    def root(self) -> Interval:
        """The square root, of what is at least 0 of it."""
        with np.errstate(invalid="ignore"):
            low, high = np.sqrt(np.maximum(self.middle - self.radius, 0.0)), np.sqrt(self.middle + self.radius)
            return between(low * (1.0 - 4.0 * ROUNDOFF), high * (1.0 + 4.0 * ROUNDOFF))

    def arctangent(self) -> Interval:
        """The angle of a tangent, within a right one."""
        with np.errstate(invalid="ignore"):
            return between(np.arctan(self.low) - WAVE_ROUNDING, np.arctan(self.high) + WAVE_ROUNDING)

    def sine(self) -> Interval:
        """The sine, which is never steeper than its angle."""
        return Interval(np.sin(self.middle), self.radius + WAVE_ROUNDING)

    def cosine(self) -> Interval:
        """The cosine, which is never steeper than its angle."""
        return Interval(np.cos(self.middle), self.radius + WAVE_ROUNDING)


def between(low: Array, high: Array) -> Interval:
    """The interval from low to high; all numbers if an end is not finite.

    >>> interval = between(np.array([1.0]), np.array([2.0]))
    >>> bool(interval.low[0] <= 1.0), bool(interval.high[0] >= 2.0)
    (True, True)
    """
    known = np.isfinite(low) & np.isfinite(high)
    low, high = np.where(known, low, 0.0), np.where(known, high, 0.0)
    middle = 0.5 * low + 0.5 * high
    radius = np.maximum(middle - low, high - middle) * (1.0 + 4.0 * ROUNDOFF)
    return Interval(middle, np.where(known, radius, np.inf))


def bearing(y: Interval, x: Interval) -> Interval:
    """The direction of the vectors (x, y) relative to their midpoint's, rad; unbounded where one may vanish.

    >>> turn = bearing(exact(np.array([2.0])), exact(np.array([0.0])))
    >>> bool(turn.low[0] <= 0.5 * np.pi <= turn.high[0])
    True
    """
    off, size = np.hypot(x.radius, y.radius), np.hypot(x.middle, y.middle)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = off / size * (1.0 + 16.0 * ROUNDOFF)
        turned = np.where(share < 1.0, np.arcsin(np.where(share < 1.0, share, 0.0)), np.inf)
    return Interval(np.arctan2(y.middle, x.middle), turned * (1.0 + 8.0 * ROUNDOFF) + WAVE_ROUNDING)


def dot(first: Sequence[Any], second: Sequence[Any]) -> Any:
    """The sum of products of two sequences, up to the length of the shorter one.

    >>> dot([1.0, 2.0], [3.0, 4.0])
    11.0
    """
    pairs = list(zip(first, second, strict=False))
    alike = all(
        isinstance(left, Interval) and left.middle.shape == pairs[0][0].middle.shape for pair in pairs for left in pair
    )
    if len(pairs) < _FEW or not alike:
        total = pairs[0][0] * pairs[0][1]
        for left, right in pairs[1:]:
            total = total + left * right
        return total
    with np.errstate(invalid="ignore"):  # 0 times infinity: no bound
        if len(pairs) * pairs[0][0].middle.size > _MANY:
            return _one_by_one(pairs)
        return dot_of_rows(stacked([left for left, _ in pairs]), stacked([right for _, right in pairs]))


def stacked(rows: Sequence[Interval]) -> Interval:
    """Intervals of one shape as one, a row each.

    >>> stacked([exact(np.array([1.0])), exact(np.array([2.0]))]).middle.tolist()
    [[1.0], [2.0]]
    """
    return Interval(np.array([row.middle for row in rows]), np.array([row.radius for row in rows]))


def dot_of_rows(first: Interval, second: Interval) -> Interval:
    """The sum over the rows of products of two intervals of one shape; 0 times infinity is not a number.

    >>> dot_of_rows(exact(np.array([[1.0], [2.0]])), exact(np.array([[3.0], [4.0]]))).middle
    array([11.])
    """
    if first.middle.size > _MANY:
        return _one_by_one([(first[i], second[i]) for i in range(len(first.middle))])
    products, radii = first.middle * second.middle, _radius_of_product(first, second)
    radii += (len(products) + 1) * ROUNDOFF * np.abs(products)
    return _summed(products.sum(axis=0), radii.sum(axis=0))


def convolved(first: Interval, second: Interval) -> Interval:
    """The rows of the product of two power series in the rows, as many as each has; 0 times infinity is not a number.

    >>> series = exact(np.array([[1.0], [1.0], [0.0]]))
    >>> convolved(series, series).middle.ravel().tolist()
    [1.0, 2.0, 1.0]
    """
    if first.middle.size > _MANY:
        return stacked([dot_of_rows(first[: i + 1], second[i::-1]) for i in range(len(first.middle))])
    left, right, starts, counts = _places_of_products(len(first.middle))
    first, second = first[left], second[right]
    products, radii = first.middle * second.middle, _radius_of_product(first, second)
    sizes = np.abs(products)
    sizes *= counts.reshape(-1, *(1,) * (products.ndim - 1))
    radii += sizes
    middle, radius = np.empty((len(starts), *products.shape[1:])), np.empty((len(starts), *products.shape[1:]))
    for i, start in enumerate(starts):
        np.add.reduce(products[start : start + i + 1], out=middle[i, ...])
        np.add.reduce(radii[start : start + i + 1], out=radius[i, ...])
    return _summed(middle, radius)


@lru_cache(maxsize=64)
def _places_of_products(count: int) -> tuple[Any, Any, list[int], Array]:
    """Which rows products of two series take, by the rows of the result, where these start, and their rounding."""
    rows = np.repeat(np.arange(count), np.arange(1, count + 1))
    left = np.concatenate([np.arange(i + 1) for i in range(count)])
    return left, rows - left, [i * (i + 1) // 2 for i in range(count)], np.asarray((rows + 2.0) * ROUNDOFF)


def _summed(middle: Array, radius: Array) -> Interval:
    radius = radius * (1.0 + 32.0 * ROUNDOFF)
    radius += TINY
    return Interval(middle, radius)


def _one_by_one(pairs: Sequence[tuple[Interval, Interval]]) -> Interval:
    """The sum of products, each added in its turn."""
    (middle, radius), *others = ((left.middle * right.middle, _radius_of_product(left, right)) for left, right in pairs)
    radius += (len(pairs) + 1) * ROUNDOFF * np.abs(middle)
    for product, off in others:
        middle += product
        radius += off + (len(pairs) + 1) * ROUNDOFF * np.abs(product)
    return _summed(middle, radius)


def _radius_of_product(left: Interval, right: Interval) -> Any:
    """The deviation of a product from the product of the midpoints, without its rounding."""
    radius = np.abs(left.middle) * right.radius
    # in place: what such steps cost is the memory that they take
    radius += (np.abs(right.middle) + right.radius) * left.radius
    return radius


def hull(first: Interval, second: Interval) -> Interval:
    """The least interval that holds two.

    >>> both = hull(exact(np.array([1.0])), exact(np.array([3.0])))
    >>> bool(both.low[0] <= 1.0), bool(both.high[0] >= 3.0), round(float(both.radius[0]), 12)
    (True, True, 1.0)
    """
    return between(np.minimum(first.low, second.low), np.maximum(first.high, second.high))


def highest(value: Any) -> Array:
    """The greatest that numbers may be.

    >>> float(highest(2.0)), bool(highest(exact(2.0)) >= 2.0)
    (2.0, True)
    """
    return value.high if isinstance(value, Interval) else np.asarray(value, dtype=np.float64)


def middle(value: Any) -> Array:
    """The middles of intervals; numbers are their own middles.

    >>> float(middle(2.0)), float(middle(exact(2.0)))
    (2.0, 2.0)
    """
    return value.middle if isinstance(value, Interval) else np.asarray(value, dtype=np.float64)


def chosen(where: Any, first: Interval, second: Interval) -> Interval:
    """The first where a condition holds, else the second.

    >>> chosen(np.array([True, False]), exact(np.array([1.0, 1.0])), exact(np.array([2.0, 2.0]))).middle
    array([1., 2.])
    """
    return Interval(np.where(where, first.middle, second.middle), np.where(where, first.radius, second.radius))


def exact(value: Any) -> Interval:
    """Intervals without width around exact numbers.

    >>> exact(2.0).high - exact(2.0).low < 2e-15
    np.True_
    """
    middle = np.asarray(value, dtype=np.float64)
    return Interval(middle, np.zeros_like(middle))


def _interval(value: Any) -> Interval:
    return value if isinstance(value, Interval) else exact(value)


def _rounded(middle: Array, radius: Array) -> Interval:
    wider = np.abs(middle)
    wider *= ROUNDOFF
    wider += radius
    wider *= _WIDER
    wider += TINY
    return Interval(middle, wider)


_FUNCTIONS: dict[Any, Callable[..., Interval]] = {
    np.negative: Interval.__neg__,
    np.arctan: Interval.arctangent,
    np.arctan2: lambda y, x: bearing(_interval(y), _interval(x)),
    np.sqrt: Interval.root,
    np.sin: Interval.sine,
    np.cos: Interval.cosine,
    np.add: lambda left, right: _interval(left) + right,
    np.subtract: lambda left, right: _interval(left) - right,
    np.multiply: lambda left, right: _interval(left) * right,
    np.divide: lambda left, right: _interval(left) / right,
}
