"""Chebyshev series in x = 2k - 1: values, derivative, integral, product and roots; and how functions become series."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import fsum
from typing import TypeVar

import numpy as np
from numpy.polynomial.chebyshev import chebpts1
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.tolerances import EPSILON, SERIES_ROUNDING

Place = TypeVar("Place", float, Array)
Values = TypeVar("Values", Array, NDArray[np.complex128])

FEWEST, MOST = 17, 1025
_PLATEAU = 4.0  # times the greatest of the last half: what rounding makes of coefficients before these
_LONGEST, _SHORTER = 160, 0.9
_CUT = -0.004849834917525  # no place that anybody would choose for a root


@lru_cache(maxsize=256)
def nodes(count: int) -> Array:
    """The Chebyshev nodes in (-1, 1), descending, at which values determine a series with this number of terms.

    >>> nodes(3).round(6) + 0.0
    array([ 0.866025,  0.      , -0.866025])
    """
    places = np.ascontiguousarray(chebpts1(count)[::-1])
    places.setflags(write=False)
    return places


def from_values(values: Values) -> Values:
    """Series of functions known at as many nodes as they have terms; a row a node, and a column a function if several.

    >>> from_values(3.0 * nodes(2)).round(12) + 0.0
    array([0., 3.])
    """
    # on short panels functions are nearly constant, and what rounding makes of a constant would be alike on them all
    middle = values[len(values) // 2]
    series = np.asarray(_transform(len(values)) @ (values - middle), dtype=values.dtype)
    series[0] += middle
    return series


@lru_cache(maxsize=64)
def _transform(count: int) -> Array:
    # whole multiples of a quarter turn / count, taken modulo a turn before they are rounded
    quarters = np.multiply.outer(np.arange(count), 2 * np.arange(count) + 1) % (4 * count)
    matrix: Array = np.cos(quarters * (0.5 * np.pi / count)) * (2.0 / count)
    matrix[0] *= 0.5
    matrix.setflags(write=False)
    return matrix


def interpolated(function: Callable[[Array], Array], name: str, blur: float = SERIES_ROUNDING) -> Array:
    """Chebyshev series in x, |x| <= 1, of a smooth function, to rounding; `name` is for error messages.

    The number of nodes is doubled until the last coefficients are rounding; those are then left out. Where they never
    are, since the function's own values are rounded more, they may be up to `blur` of the greatest value.

    Raises
    ------
    InputError
        If a value is not finite, or 1025 nodes do not resolve the function.

    Examples
    --------
    >>> interpolated(lambda x: 2 * x * x, "f").round(12) + 0.0
    array([1., 0., 1.])
    """
    count = FEWEST
    while True:
        values = np.asarray(function(nodes(count)), dtype=np.float64)
        if not np.isfinite(values).all():
            raise InputError(f"{name} must have finite values on the whole interval")
        series = from_values(values)
        size, tail = float(np.abs(values).max()), float(np.abs(series[-max(2, count // 10) :]).max())
        if tail <= SERIES_ROUNDING * size:
            return shortened(series, SERIES_ROUNDING * size)
        rounding = _PLATEAU * float(np.abs(series[count // 2 :]).max())
        if count >= MOST and rounding <= blur * size:
            return shortened(series, rounding)
        if count >= MOST:
            raise InputError(f"{name} must be smooth on the whole interval: {count} points do not resolve it")
        count = 2 * count - 1


@lru_cache(maxsize=64)
def gauss(count: int) -> tuple[Array, Array]:
    """Places in [-1, 1] and weights of Gauss's rule, exact for polynomials of degree 2 count - 1.

    >>> places, weights = gauss(2)
    >>> float(weights @ places**2)
    0.666666666...
    """
    places, weights = leggauss(count)
    for numbers in (places, weights):
        numbers.setflags(write=False)
    return places, weights


def shortened(series: Array, noise: float) -> Array:
    """The series without what is at most noise at its end.

    >>> shortened(np.array([1.0, 0.0, 2.0, 1e-17]), 1e-16)
    array([1., 0., 2.])
    """
    counted = np.flatnonzero(np.abs(series) > noise)
    return series[: counted[-1] + 1] if len(counted) else np.zeros(1)


def value(series: Array, x: Place) -> Place:
    """Values of a series at x, |x| <= 1, by Clenshaw's recurrence; float in, float out.

    >>> value(np.array([1.0, 2.0, 3.0]), 0.5)
    0.5
    """
    twice = x + x
    last = before = x * 0.0
    for coefficient in series[:0:-1].tolist():
        last, before = coefficient + twice * last - before, last
    return float(series[0]) + x * last - before


def values(series: Array, x: Array) -> Array:
    """Values of several series, a column each, at x, |x| <= 1, by Clenshaw's recurrence; a row for each.

    >>> values(np.array([[1.0, 0.0], [2.0, 1.0]]), np.array([0.5, 1.0])).tolist()
    [[2.0, 3.0], [0.5, 1.0]]
    """
    columns, twice = series.reshape(*series.shape, *(1,) * x.ndim), x + x
    last: Array = np.zeros((series.shape[1], *x.shape))
    before = last
    for coefficients in columns[:0:-1]:
        last, before = coefficients + twice * last - before, last
    result: Array = columns[0] + x * last - before
    return result


def basis_values(x: Array, count: int) -> Array:
    """T_0, ..., T_(count-1) at x, shape (len(x), count); quick, and good to about count ulp.

    >>> basis_values(np.array([1.0]), 3)
    array([[1., 1., 1.]])
    """
    values: Array = np.cos(np.multiply.outer(np.arccos(x), _numbers(count)))
    return values


def derivative(series: Array) -> Array:
    """Series of the derivative with respect to k (twice the derivative with respect to x).

    >>> derivative(np.array([0.0, 0.0, 1.0]))
    array([0., 8.])
    """
    count = len(series)
    if count == 1:
        return np.zeros(1)
    steps = 4.0 * _numbers(count) * series
    result = np.empty(count - 1)
    for start in (count - 2, count - 3):
        if start >= 0:
            result[start::-2] = np.cumsum(steps[start + 1 :: -2][: start // 2 + 1])
    result[0] *= 0.5
    return result


def integral(series: Array, start: float) -> Array:
    """Series of the integral with respect to k from 0, plus its value `start` at k = 0.

    >>> integral(np.array([2.0]), 0.0)
    array([1., 1.])
    """
    count = len(series)
    result = np.zeros(count + 1)
    result[1:] = series
    result[1] *= 2.0
    result[1 : count - 1] -= series[2:]
    result[1:] /= 4.0 * _numbers(count + 1)[1:]
    result[0] = fsum([start, *result[1::2].tolist(), *(-result[2::2]).tolist()])
    return result


def mean_product(first: Array, second: Array) -> float:
    """Integral over k in [0, 1] of the product of two series, exact up to rounding.

    >>> mean_product(np.array([0.0, 1.0]), np.array([0.0, 3.0]))
    1.0
    """
    even = product(first, second)[::2]
    n = 2.0 * _numbers(len(even))
    return float(even @ (1.0 / (1.0 - n * n)))


def product(first: Array, second: Array) -> Array:
    """Series of the product, by 2 T_m T_n = T_(m+n) + T_|m-n|.

    >>> product(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    array([0.5, 0. , 0.5])
    """
    middle = len(second) - 1
    result = 0.5 * np.convolve(first, second)
    shifted = 0.5 * np.convolve(first, second[::-1])
    result[: len(first)] += shifted[middle:]
    result[1 : middle + 1] += shifted[:middle][::-1]
    return result


def real_parts_of_roots(series: Array) -> Array:
    """Points of [-1, 1] among which is, to rounding, every real root of the series there.

    They are the real parts of all eigenvalues of the colleague matrix, clipped to the interval: a multiple root
    splits into complex ones, so that a rule for which of them are real could only lose roots. Leading
    coefficients that are negligible relative to the largest are left out, for they would carry rounding errors of
    the eigenvalues into the rest. Even and odd series are halved: they are one in t = 2x² - 1, or x times one.

    >>> real_parts_of_roots(np.array([-0.5, 1.0]))
    array([0.5])
    >>> real_parts_of_roots(np.array([-0.5, 0.0, 1.0])).round(3)
    array([ 0.866, -0.866])
    """
    if len(series) > 2:
        if not series[1::2].any():
            return _both_signs(_roots(series[::2]))
        if not series[::2].any():
            return np.append(_both_signs(_roots(_divided(series[1::2]))), 0.0)
    return _roots(series)


def _both_signs(t: Array) -> Array:
    x = np.sqrt(0.5 * (t + 1.0))
    both: Array = np.concatenate([x, -x])
    return both


def _divided(odd: Array) -> Array:
    """Even series e with x e = sum odd[m] T_(2m+1): from x T_2m = (T_(2m+1) + T_|2m-1|) / 2."""
    signs: Array = np.where(_numbers(len(odd)) % 2.0 == 0.0, 1.0, -1.0)
    result: Array = 2.0 * signs * np.cumsum((signs * odd)[::-1])[::-1]
    result[0] *= 0.5
    return result


def _roots(series: Array) -> Array:
    size = np.abs(series)
    counted = shortened(series, EPSILON * float(size.max()))
    if len(counted) <= _LONGEST:
        return _eigenvalues(counted)
    # eigenvalues cost the cube of the length, and on a half of the interval a function has a shorter series
    noise = SERIES_ROUNDING * float(size.sum())
    places = [np.array([_CUT])]
    for low, high in ((-1.0, _CUT), (_CUT, 1.0)):
        x = low + (high - low) * (nodes(len(counted)) + 1.0) / 2.0
        half = shortened(from_values(np.asarray(value(counted, x))), noise)
        local = _roots(half) if len(half) < _SHORTER * len(counted) else _eigenvalues(half)
        places.append(low + (high - low) * (local + 1.0) / 2.0)
    return np.concatenate(places)


def _eigenvalues(series: Array) -> Array:
    count = len(series) - 1
    if count == 0:
        return np.empty(0)
    if count == 1:
        only: Array = np.clip(-series[:1] / series[1], -1.0, 1.0)
        return only
    skeleton, scale = _colleague(count)
    matrix = skeleton.copy()
    matrix[::-1, 0] -= series[:count] / series[count] * scale
    return np.clip(np.linalg.eigvals(matrix).real, -1.0, 1.0)


@lru_cache(maxsize=256)
def _colleague(count: int) -> tuple[Array, Array]:
    off = np.full(count - 1, 0.5)
    off[0] = np.sqrt(0.5)
    matrix = np.diag(off, 1) + np.diag(off, -1)
    scale = np.full(count, 0.5)
    scale[0] = np.sqrt(0.5)
    # turned by half a turn: the large entries then come first, which suits the QR iteration
    turned = np.ascontiguousarray(matrix[::-1, ::-1])
    turned.setflags(write=False)
    scale.setflags(write=False)
    return turned, scale


@lru_cache(maxsize=256)
def _numbers(count: int) -> Array:
    numbers = np.arange(count, dtype=np.float64)
    numbers.setflags(write=False)
    return numbers


def gegenbauer(index: float, degree: int, x: Array) -> Array:
    """Gegenbauer polynomials of the given index, degrees 0 to `degree`, one row each, by their recurrence.

    >>> gegenbauer(0.5, 2, np.array([1.0]))[:, 0].tolist()
    [1.0, 1.0, 1.0]
    """
    rows = np.empty((degree + 1, len(x)))
    rows[0] = 1.0
    if degree:
        rows[1] = 2.0 * index * x
    for m in range(1, degree):
        rows[m + 1] = (2 * (m + index) * x * rows[m] - (m + 2 * index - 1) * rows[m - 1]) / (m + 1)
    return rows
