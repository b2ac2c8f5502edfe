"""Integrals of functions with their errors enclosed: Taylor's formula with its remainder in cells that are halved."""

from __future__ import annotations

from typing import Any

import numpy as np

from optlaws.errors import SolverFailure
from optlaws.numbers import Array
from optlaws.numerics.branch_and_bound import Function
from optlaws.numerics.interval import Interval
from optlaws.tolerances import ROUNDOFF, SMALLEST_SIZE

_ORDER = 6
_BLUR = 4.0
_DEEPEST = 60
_MOST = 200_000


def integral(function: Function, edges: Any, *, share: float = 1e-9) -> tuple[float, float]:
    """Between which values the integral of a function is, from the first of some edges to the last.

    Parameters
    ----------
    function
        As for `extremes`: Taylor terms in intervals of places.
    edges
        Increasing, shape (n + 1,); at inner ones it may jump.
    share
        By how much cells may be off, relative to the mean magnitude.

    Examples
    --------
    >>> from optlaws.numerics.taylor import variable
    >>> low, high = integral(lambda x, order: variable(x, order).magnitude(), [-1.0, 2.0])
    >>> low <= 2.5 <= high, high - low < 1e-7
    (True, True)
    """
    places = np.asarray(edges, dtype=np.float64)
    low, high, whole = places[:-1], places[1:], float(places[-1] - places[0])
    total, size = Interval(np.zeros(1), np.zeros(1)), 0.0
    for _ in range(_DEEPEST):
        part, rounding = _of_cells(function, low, high)
        sizes = np.abs(part.middle)
        size += float(sizes[np.isfinite(part.radius)].sum())
        with np.errstate(invalid="ignore"):
            near = np.maximum(0.5 * share * max(size / whole, SMALLEST_SIZE), _BLUR * rounding)
            open_ones = ~(part.radius <= near * (high - low))
        total = total + Interval(*(np.array([values[~open_ones].sum()]) for values in (part.middle, part.radius)))
        total = total + Interval(np.zeros(1), len(low) * ROUNDOFF * sizes[~open_ones].sum(keepdims=True))
        if not open_ones.any():
            return float(total.low[0]), float(total.high[0])
        size -= float(sizes[open_ones & np.isfinite(part.radius)].sum())
        low, high = low[open_ones], high[open_ones]
        middle = 0.5 * (low + high)
        low, high = np.append(low, middle), np.append(middle, high)
        if len(low) > _MOST:
            break
    raise SolverFailure("a function to be integrated has no bound between the places where it may jump")


def _of_cells(function: Function, low: Array, high: Array) -> tuple[Interval, Array]:
    """The integral over each cell: by the Taylor polynomial, or the range of slope or value where that is less.

    With what values are rounded, beyond which smaller cells are known no better.
    """
    count, middle = len(low), 0.5 * (low + high)
    half = np.maximum(high - middle, middle - low) * (1.0 + 4.0 * ROUNDOFF)
    places = Interval(np.concatenate([middle, middle]), np.concatenate([np.zeros(count), half]))
    terms = [term + np.zeros(2 * count) for term in function(places, _ORDER).terms]
    width = Interval(high - low, 2.0 * ROUNDOFF * (high - low))
    # a middle is rounded, so that odd terms do not vanish in full
    askew = 4.0 * ROUNDOFF * np.abs(middle) * np.abs(terms[1].middle[:count])
    mean, power = terms[0][:count] + Interval(np.zeros(count), askew), Interval(np.ones(count), np.zeros(count))
    square = Interval(half * half, 16.0 * ROUNDOFF * half * half)
    polynomial = mean
    for i in range(2, _ORDER, 2):
        power = power * square
        polynomial = polynomial + terms[i][:count] * power / (i + 1)
    rest = terms[_ORDER][count:] * (power * square) / (_ORDER + 1)
    # the mean of f is f(m) but for half of what the slope varies
    slope = terms[1][count:]
    ways = [
        polynomial + rest,
        Interval(mean.middle, mean.radius + 0.5 * slope.radius * half * (1.0 + 8.0 * ROUNDOFF)),
        terms[0][count:],
    ]
    radii = np.array([np.where(np.isfinite(way.radius), way.radius, np.inf) for way in ways])
    best = np.argmin(radii, axis=0)[None]
    middles = np.take_along_axis(np.array([way.middle for way in ways]), best, 0)[0]
    rounding = np.where(np.isfinite(mean.radius), mean.radius, 0.0)
    return Interval(middles, np.take_along_axis(radii, best, 0)[0]) * width, rounding
