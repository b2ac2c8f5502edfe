"""Parts of an interval on which functions are smooth: their integrals and greatest values, to rounding."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple

import numpy as np

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss
from optlaws.tolerances import BEFORE_BREAK, EQUAL_EXTREMES, VALUE_ROUNDING

_PANELS = 200
_GAUSS = 10
_POLISHED = 3
_CUT = 16
_ROUNDS = 10  # of cutting a part: it is then as short as its share next to a break
_HALVES = 52

RealFunction = Callable[[Array], Array]


class Greatest(NamedTuple):
    """A greatest value and the place at which it is."""

    value: float
    place: float

    @classmethod
    def of(cls, values: Array, places: Array) -> Greatest:
        """The greatest of values, and the first place of those that are equal to it but for rounding."""
        greatest = float(values.max())
        rounding = EQUAL_EXTREMES * abs(greatest) if isfinite(greatest) else 0.0
        return cls(greatest, float(places[values >= greatest - rounding].min()))


@dataclass(frozen=True, eq=False)
class SmoothParts:
    """Parts between ascending edges; kinks and jumps of a function are at the edges only.

    Examples
    --------
    >>> parts = SmoothParts.between(0.0, 1.0, breaks=[0.25], signs=[lambda t: t - 0.6])
    >>> round(parts.integral(lambda t: np.abs(t - 0.6)), 12)
    0.26
    >>> parts.greatest(lambda t: np.sin(3.0 * t)).value
    1.0
    """

    edges: Array

    @classmethod
    def between(
        cls, start: float, stop: float, *, breaks: Iterable[float] = (), signs: Iterable[RealFunction] = ()
    ) -> SmoothParts:
        """The parts of an interval: equal ones, cut at breaks and at sign changes of functions."""
        even = np.unique([*np.linspace(start, stop, _PANELS + 1), *breaks])
        return cls(np.unique(np.concatenate([even, *(_crossings(function, even) for function in signs)])))

    @kept_property
    def places(self) -> tuple[Array, Array]:
        return _places(self.edges[:-1], self.edges[1:])

    def integral(self, function: RealFunction) -> float:
        """The integral of a function."""
        places, weights = self.places
        return float(weights @ function(places))

    def integrals(self, function: RealFunction) -> Array:
        """The integral of a function over each part."""
        return _integrals(function, self.edges[:-1], self.edges[1:])

    def halved(self, function: RealFunction) -> SmoothParts:
        """The parts halved until the integral of a function is right to rounding: finer at kinks that are no edges.

        >>> parts = SmoothParts.between(0.0, 1.0)
        >>> round(parts.halved(lambda t: np.abs(t - 0.6012)).integral(lambda t: np.abs(t - 0.6012)), 12)
        0.26024144
        """
        low, high, edges = self.edges[:-1], self.edges[1:], [self.edges]
        size = self.integral(lambda places: np.abs(function(places)))
        for _ in range(_HALVES):
            middle = 0.5 * (low + high)
            halves = _integrals(function, low, middle) + _integrals(function, middle, high)
            wrong = np.abs(halves - _integrals(function, low, high)) > VALUE_ROUNDING * size
            if not wrong.any():
                break
            edges.append(middle[wrong])
            low, high = (np.concatenate(ends)[np.tile(wrong, 2)] for ends in ((low, middle), (middle, high)))
        return SmoothParts(np.unique(np.concatenate(edges)))

    def greatest(self, function: RealFunction) -> Greatest:
        """The greatest value of a function: at the edges, beside them, and polished inside of the best parts."""
        edges, lengths = self.edges, np.diff(self.edges)
        sides = (edges[:-1] + BEFORE_BREAK * lengths, edges[1:] - BEFORE_BREAK * lengths)
        places = np.concatenate([*sides, self.places[0], edges])
        values = np.asarray(function(places))
        if values.max() == values.min():  # a constant, as in a rest
            return Greatest.of(values, places)
        inner = np.searchsorted(edges, places[np.argsort(values)[-_POLISHED:]], side="right") - 1
        best_parts = np.unique(np.clip(inner, 0, len(lengths) - 1))
        better, there = _polished(function, edges[best_parts], edges[best_parts + 1])
        return Greatest.of(np.append(values, better), np.append(places, there))


def _places(low: Array, high: Array) -> tuple[Array, Array]:
    """Gauss's places and weights between pairs of places, one pair after the other."""
    u, weights = gauss(_GAUSS)
    middles, halves = 0.5 * (low + high), 0.5 * (high - low)
    return (middles[:, None] + halves[:, None] * u).ravel(), (halves[:, None] * weights).ravel()


def _integrals(function: RealFunction, low: Array, high: Array) -> Array:
    places, weights = _places(low, high)
    return np.asarray((weights * function(places)).reshape(-1, _GAUSS).sum(axis=1))


def _polished(function: RealFunction, low: Array, high: Array) -> tuple[Array, Array]:
    """The greatest values between places, and where: a part is cut, and its best place with both neighbours again."""
    shares, parts = np.arange(1, _CUT)[:, None] / _CUT, np.arange(len(low))
    for _ in range(_ROUNDS):
        places = low + (high - low) * shares
        values = np.asarray(function(places.ravel())).reshape(places.shape)
        best = np.argmax(values, axis=0)
        step = (high - low) / _CUT
        low, high = places[best, parts] - step, places[best, parts] + step
    return values[best, parts], places[best, parts]


def _crossings(function: RealFunction, places: Array) -> Array:
    """Places between samples where a function changes its sign by more than its rounding."""
    lengths = np.diff(places)
    low, high = places[:-1] + BEFORE_BREAK * lengths, places[1:] - BEFORE_BREAK * lengths
    first, last = np.asarray(function(low)), np.asarray(function(high))
    rounding = VALUE_ROUNDING * float(np.max(np.abs([first, last]), initial=0.0))
    changed = (first * last < 0.0) & (np.maximum(np.abs(first), np.abs(last)) > rounding)
    low, high, rising = low[changed], high[changed], last[changed] > 0.0
    for _ in range(_HALVES if len(low) else 0):
        middle = 0.5 * (low + high)
        if not ((low < middle) & (middle < high)).any():
            break
        beyond = (np.asarray(function(middle)) > 0.0) == rising
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return 0.5 * (low + high)
