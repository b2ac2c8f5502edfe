"""Constants of many polynomial laws at once: peaks over the whole interval, as each law alone would have them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from optlaws.laws import PolynomialLaw
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes

_ANGLE_SETTLED = 1e-8  # of an angle: a peak is off by the square of it

#: points for each degree of the series: between them a peak rises by a share of less than 1/26 (Bernstein)
_DENSITY = 6
_STEPS = 16
_CHUNK = 1024


def peaks(series: Array) -> Array:
    """Greatest magnitude over [-1, 1] of each of many Chebyshev series, shape (laws, coefficients).

    As a sum of cosines f(angle) a series of degree n has |f''| <= n² max |f| (Bernstein): whatever lies between the
    points of a grid is above its neighbours by a known share at most, so that no peak is missed.

    Examples
    --------
    >>> peaks(np.array([[0.0, 0.0, 1.0], [0.5, 1.0, 0.0]])).tolist()
    [1.0, 1.5]
    """
    return by_pieces(_peaks, series)


def greatest(series: Array, signs: tuple[float, ...]) -> Array:
    """The greatest over [-1, 1] of each of many Chebyshev series with the signs that count, one or both.

    >>> greatest(np.array([[-3.0, 0.0, 1.0]]), (1.0,)).tolist()
    [-2.0]
    """
    if len(signs) > 1:
        return peaks(series)
    size = np.abs(series).sum(axis=1)
    raised = signs[0] * series
    raised[:, 0] += size
    return np.asarray(peaks(raised) - size)


def power_peaks(velocity: Array, acceleration: Array) -> Array:
    """Greatest magnitude of the product of two series, for each of many laws."""
    return by_pieces(lambda b, c: _peaks(products(b, c)), velocity, acceleration)


def by_pieces(values: Callable[..., Array], *rows: Array) -> Array:
    """A value of each row of arrays, computed for some rows at a time: a million laws then need the memory of those.

    >>> by_pieces(lambda rows: rows.sum(axis=1), np.ones((3, 2))).tolist()
    [2.0, 2.0, 2.0]
    """
    begins = range(0, len(rows[0]), _CHUNK)
    return np.concatenate([np.empty(0), *(values(*(array[i : i + _CHUNK] for array in rows)) for i in begins)])


def of_polynomials(laws: Sequence[PolynomialLaw], name: str) -> Array:
    """B, C, D, J or rms_c of many polynomial laws."""
    count = max((len(law.acceleration) for law in laws), default=0) + 1
    c = np.array([[*law.acceleration, *[0.0] * (count - len(law.acceleration))] for law in laws]).reshape(-1, count)
    b = chebyshev.chebint(c, lbnd=-1.0, scl=0.5, axis=1)
    b[:, 0] += [law.b0 for law in laws]
    return constant_of_series(name, b, c, 2.0 * chebyshev.chebder(c, axis=1))


def constant_of_series(name: str, b: Array, c: Array, j: Array) -> Array:
    """B, C, D, J or rms_c of many laws whose velocities, accelerations and jerks are series."""
    if name == "D":
        return power_peaks(b, c)
    return root_mean_squares(c) if name == "rms_c" else peaks({"B": b, "C": c, "J": j}[name])


def products(first: Array, second: Array) -> Array:
    """Products of Chebyshev series, law by law."""
    count = first.shape[1] + second.shape[1]
    values = [factor @ chebyshev.chebvander(nodes(count), factor.shape[1] - 1).T for factor in (first, second)]
    return from_values((values[0] * values[1]).T).T


def root_mean_squares(series: Array) -> Array:
    """Root of the mean square over [-1, 1] of each series."""
    u, weights = np.polynomial.legendre.leggauss(series.shape[1] + 1)
    values = series @ chebyshev.chebvander(u, series.shape[1] - 1).T
    return np.asarray(np.sqrt(values**2 @ weights / 2.0))


@lru_cache(maxsize=32)
def _grid(terms: int) -> tuple[Array, Array]:
    count = _DENSITY * terms
    angle = np.linspace(0.0, np.pi, count + 1)
    return angle, np.asarray(np.cos(np.outer(np.arange(terms), angle)), dtype=np.float64)


def _peaks(series: Array) -> Array:
    angle, columns = _grid(series.shape[1])
    values = np.abs(series @ columns)
    greatest: Array = values.max(axis=1)
    share = 1.0 - (np.pi / (2.0 * _DENSITY)) ** 2 / 2.0
    rising = np.full((len(values), values.shape[1] + 2), -1.0)
    rising[:, 1:-1] = values
    tops = (values >= rising[:, :-2]) & (values >= rising[:, 2:]) & (values >= (share * greatest)[:, None])
    law, place = np.nonzero(tops)
    np.maximum.at(greatest, law, _polished(series[law], angle[place], angle[1]))
    return greatest


def _polished(series: Array, angle: Array, apart: float) -> Array:
    """The magnitudes at peaks no farther from some angles than `apart`, by Newton's method between two sides of each.

    The angles are no lower than those that far away. Beyond an end, where a series rests, it is mirrored.
    """
    n = np.arange(series.shape[1])
    best, going = np.zeros(len(series)), np.arange(len(series))
    low, high = angle - apart, angle + apart
    for _ in range(_STEPS):
        turns, terms = angle[:, None] * n, series[going]
        cosines = terms * np.cos(turns)
        value = cosines.sum(axis=1)
        slope, bend = -(terms * n * np.sin(turns)).sum(axis=1), -(cosines * (n * n)).sum(axis=1)
        best[going] = np.maximum(best[going], np.abs(value))
        rising = value * slope > 0.0
        low, high = np.where(rising, angle, low), np.where(rising, high, angle)
        further = angle - np.divide(slope, bend, out=np.full_like(slope, np.inf), where=bend != 0.0)
        between = (low <= further) & (further <= high) & (value * bend < 0.0)
        further = np.where(between, further, (low + high) / 2.0)
        left = np.abs(further - angle) > _ANGLE_SETTLED
        angle, low, high, going = further[left], low[left], high[left], going[left]
        if not len(going):
            break
    return best
