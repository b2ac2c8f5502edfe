"""Chebyshev series in x = 2k - 1: values, derivative, integral, product and roots."""

from __future__ import annotations

from functools import lru_cache
from math import fsum
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Place = TypeVar("Place", float, Array)

NEGLIGIBLE = 2.0**-52


def value(series: Array, x: Place) -> Place:
    """Values of a series at x, |x| <= 1, by Clenshaw's recurrence; float in, float out.

    Examples
    --------
    >>> value(np.array([1.0, 2.0, 3.0]), 0.5)
    0.5
    """
    twice = x + x
    last = before = x * 0.0
    for coefficient in series[:0:-1].tolist():
        last, before = coefficient + twice * last - before, last
    return float(series[0]) + x * last - before


def basis_values(x: Array, count: int) -> Array:
    """T_0, ..., T_(count-1) at x, shape (len(x), count); quick, and good to about count ulp.

    Examples
    --------
    >>> basis_values(np.array([1.0]), 3)
    array([[1., 1., 1.]])
    """
    values: Array = np.cos(np.multiply.outer(np.arccos(x), _numbers(count)))
    return values


def derivative(series: Array) -> Array:
    """Series of the derivative with respect to k (twice that with respect to x).

    Examples
    --------
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

    Examples
    --------
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
    """Integral over k in [0, 1] of the product of two series, exact but for rounding.

    Examples
    --------
    >>> mean_product(np.array([0.0, 1.0]), np.array([0.0, 3.0]))
    1.0
    """
    even = product(first, second)[::2]
    n = 2.0 * _numbers(len(even))
    return float(even @ (1.0 / (1.0 - n * n)))


def product(first: Array, second: Array) -> Array:
    """Series of the product, by 2 T_m T_n = T_(m+n) + T_|m-n|.

    Examples
    --------
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

    Examples
    --------
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
    kept = np.flatnonzero(size > NEGLIGIBLE * size.max())
    count = int(kept[-1]) if len(kept) else 0
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
