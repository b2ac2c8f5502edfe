"""Between which values smooth functions stay on intervals: Bernstein coefficients enclose a polynomial."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import comb
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.series import chebyshev

Array = NDArray[np.float64]
Function = Callable[[Array], Array]

TERMS = 13
_PARTS = 4
_DEEPEST = 40
_MOST = 100_000
_ROUNDING = 2.0**-44
_TIE = 1e-10


class Enclosure(NamedTuple):
    """Least and greatest value of a function: what it reaches, and what it is proven not to pass.

    Attributes
    ----------
    least, most
        Values that it has at the places `least_at` and `most_at`.
    low, high
        It is nowhere below `low` and nowhere above `high`.
    """

    least: float
    least_at: float
    low: float
    most: float
    most_at: float
    high: float

    @property
    def peak(self) -> float:
        """The greatest magnitude that it reaches."""
        return max(abs(self.least), abs(self.most))

    @property
    def bound(self) -> float:
        """A magnitude that it is proven not to pass."""
        return max(abs(self.low), abs(self.high))


def bounds(function: Function, starts: Array, stops: Array) -> tuple[Array, Array]:
    """What a function stays between on each of many intervals on which it is smooth.

    On each it is interpolated by a polynomial of degree 12, whose Bernstein coefficients on quarters of the interval
    enclose it; its last two Chebyshev coefficients are added on both sides for what the polynomial is off by.

    Parameters
    ----------
    function
        Of places of shape (n, 13); any further axes of its values are kept.
    starts, stops
        Ends of the intervals, shape (n,).

    Returns
    -------
    Lower and upper bounds, of shape (n, ...).

    Examples
    --------
    >>> low, high = bounds(lambda x: x * x, np.array([0.0, 1.0]), np.array([1.0, 3.0]))
    >>> low.round(9) + 0.0, high.round(9)
    (array([0., 1.]), array([1., 9.]))
    """
    places = starts[:, None] + np.multiply.outer(stops - starts, 0.5 + 0.5 * chebyshev.nodes(TERMS))
    values = np.moveaxis(function(places), 1, 0)
    middle = values[TERMS // 2]
    off = (values - middle).reshape(TERMS, -1)
    series = chebyshev.from_values(off)
    missed = _missed(series, off)
    coefficients = _to_bernstein() @ off
    low = (coefficients.min(axis=0) - missed).reshape(middle.shape)
    high = (coefficients.max(axis=0) + missed).reshape(middle.shape)
    return middle + low, middle + high


@lru_cache(maxsize=1)
def _to_bernstein() -> Array:
    """From values at the nodes to Bernstein coefficients on each part of the interval."""
    u = 0.5 + 0.5 * chebyshev.nodes(TERMS)
    matrices = [np.linalg.inv(_bernstein((u - part / _PARTS) * _PARTS)) for part in range(_PARTS)]
    return np.concatenate(matrices)


def _bernstein(u: Array) -> Array:
    degree = TERMS - 1
    return np.array([comb(degree, i) * u**i * (1.0 - u) ** (degree - i) for i in range(TERMS)]).T


def integrated(function: Function, edges: Array, *, share: float = 1e-9, scale: float = 0.0) -> tuple[float, float]:
    """Between which values the integral of a function is that is smooth between edges.

    The polynomials of `bounds` are integrated; intervals are halved until what these may be off by is a share of the
    integral of the magnitude, or of that of a scale.

    Raises
    ------
    InputError
        As for `enclosed`.

    Examples
    --------
    >>> low, high = integrated(np.abs, np.array([-1.0, 0.3, 2.0]))
    >>> low <= 2.5 <= high, high - low < 1e-8
    (True, True)
    """
    starts, stops = np.asarray(edges[:-1], dtype=np.float64), np.asarray(edges[1:], dtype=np.float64)
    whole = float(edges[-1] - edges[0])
    total = missed = size = 0.0
    for _ in range(_DEEPEST):
        lengths = stops - starts
        values, off = _means(function, starts, stops)
        size += float(np.abs(values) @ lengths)
        # each interval may miss its part of what may be missed
        open_ones = off > 0.5 * share * max(size / whole, scale)
        total += float(values[~open_ones] @ lengths[~open_ones])
        missed += float(off[~open_ones] @ lengths[~open_ones])
        if not open_ones.any():
            return total - missed, total + missed
        size -= float(np.abs(values[open_ones]) @ lengths[open_ones])
        starts, stops = _halves(starts[open_ones], stops[open_ones])
    raise InputError("what is to be integrated is not smooth between the places where it may leap")


def _halves(starts: Array, stops: Array) -> tuple[Array, Array]:
    if len(starts) > _MOST:
        raise InputError("what is to be enclosed is not smooth: its extremes are hidden in rounding")
    middles = 0.5 * (starts + stops)
    return np.append(starts, middles), np.append(middles, stops)


def _means(function: Function, starts: Array, stops: Array) -> tuple[Array, Array]:
    """Means over intervals, and what these may be off by."""
    places = starts[:, None] + np.multiply.outer(stops - starts, 0.5 + 0.5 * chebyshev.nodes(TERMS))
    values = np.asarray(function(places), dtype=np.float64).T
    if not np.isfinite(values).all():
        raise InputError("what is to be integrated must be finite everywhere")
    series = chebyshev.from_values(values)
    even = np.arange(0, TERMS, 2)
    return (1.0 / (1.0 - even**2.0)) @ series[even], _missed(series, values)


def _missed(series: Array, values: Array) -> Array:
    """What polynomials of these series may be off by: twice their last two terms, and rounding."""
    return np.asarray(2.0 * np.abs(series[-2:]).sum(axis=0) + _ROUNDING * np.abs(values).max(axis=0))


def enclosed(function: Function, edges: Array, *, share: float = 1e-9, scale: float = 0.0) -> Enclosure:
    """Least and greatest value of a function that is smooth between edges, over the whole from the first to the last.

    Intervals are halved until the bounds are within a share of the function's greatest magnitude, or of a scale, of
    values that it has; those that cannot hold an extreme are left.

    Parameters
    ----------
    function
        Of an array of places of any shape, finite. At an inner edge it may leap: it is never asked there.
    edges
        Increasing, shape (n + 1,).
    share
        How near the bounds come.
    scale
        Of what the function is a difference: where it is next to nothing beside that, it is rounding.

    Raises
    ------
    InputError
        If the function is not finite, or so rough that forty halvings leave it unresolved.

    Examples
    --------
    >>> enclosure = enclosed(np.sin, np.array([0.0, 2.0, 7.0]))
    >>> round(enclosure.most, 9), round(enclosure.most_at, 4), 0.0 <= enclosure.high - enclosure.most < 1e-8
    (1.0, 1.5708, True)
    """
    starts, stops = np.asarray(edges[:-1], dtype=np.float64), np.asarray(edges[1:], dtype=np.float64)
    known = Enclosure(np.inf, 0.0, np.inf, -np.inf, 0.0, -np.inf)
    for _ in range(_DEEPEST):
        values, places = _tried(function, starts, stops)
        known = _with(known, values, places)
        low, high = bounds(function, starts, stops)
        slack = share * max(known.peak, scale)
        open_ones = (low < known.least - slack) | (high > known.most + slack)
        known = _within(known, low[~open_ones], high[~open_ones])
        if not open_ones.any():
            return known
        starts, stops = _halves(starts[open_ones], stops[open_ones])
    raise InputError("what is to be enclosed is not smooth between the places where it may leap")


def _with(known: Enclosure, values: Array, places: Array) -> Enclosure:
    """With values that the function has."""
    tie = _TIE * max(float(np.abs(values).max()), known.peak if np.isfinite(known.peak) else 0.0)
    least, least_at = _first(values, places, tie, (known.least, known.least_at))
    most, most_at = _first(-values, places, tie, (-known.most, known.most_at))
    return known._replace(least=least, least_at=least_at, most=-most, most_at=most_at)


def _first(values: Array, places: Array, tie: float, known: tuple[float, float]) -> tuple[float, float]:
    """The least value, and the first place where it is, but for rounding."""
    least = float(values.min())
    place = float(places[values <= least + tie].min())
    if least < known[0] - tie:
        return least, place
    return min(least, known[0]), min(place, known[1]) if least <= known[0] + tie else known[1]


def _within(known: Enclosure, low: Array, high: Array) -> Enclosure:
    """With bounds of further intervals, which hold what the function has there."""
    return known._replace(
        low=min(known.low, known.least, float(low.min(initial=np.inf))),
        high=max(known.high, known.most, float(high.max(initial=-np.inf))),
    )


def _tried(function: Function, starts: Array, stops: Array) -> tuple[Array, Array]:
    """Values next to both ends of each interval and inside it."""
    shares = np.array([1e-12, 0.25, 0.5, 0.75, 1.0 - 1e-12])
    places = starts[:, None] + np.multiply.outer(stops - starts, shares)
    values = np.asarray(function(places), dtype=np.float64)
    if not np.isfinite(values).all():
        raise InputError("what is to be enclosed must be finite everywhere")
    return values, places
