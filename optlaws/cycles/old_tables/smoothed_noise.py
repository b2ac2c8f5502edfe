"""Noise that a filter has smoothed: as if each row were the mean of so many, which tell no more than one of them.

Differences of neighbouring rows hide most of such noise, and those of rows farther apart show it. The noise of rows as
good as independent, by which a fit is as uncertain, is that of a row times the square root of these rows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from math import comb

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from optlaws.cycles.old_tables.samples import LEAST_NOISE, MEDIAN, Mask, Samples, rests_exactly
from optlaws.numbers import Array

#: by how much even steps differ, of their median; and rows that tell smoothed noise from other noise, at least
_EVEN, _FEWEST_ROWS = 1e-6, 350
#: of differences: their orders, and the rows from one to the next
_ORDERS, _STRIDES = range(5, 9), (1, 2, 3, 4, 5, 6, 8, 10, 12)
#: fewer differences tell nothing; by how much their size may change with the order where it is noise and no motion
_FEWEST, _WHITE = 24, 1.6
#: rows of moving means that are told apart, at most; and strides that each is compared at, at least
_MOST, _FEWEST_STRIDES = 15, 4
#: how far sizes may be off those of a moving mean, as the mean of logarithms; and times how far off independent noise
_OFF, _LIKELIER = 0.12, 0.5


def as_independent(samples: Samples) -> Samples:
    """The samples with the noise of rows as good as independent, where their noise is smoothed; else the samples.

    Of uneven places it is taken to be independent.

    Examples
    --------
    >>> from optlaws.cycles.old_tables.samples import samples_of
    >>> x, noise = np.linspace(0.0, 360.0, 1801), np.random.default_rng(1).normal(0.0, 6e-3, 1809)
    >>> smoothed = np.sin(np.radians(x)) + np.convolve(noise, np.ones(9) / 9.0, "valid")
    >>> samples = as_independent(samples_of(x, smoothed))
    >>> samples.averaged, round(float(samples.noise.max()), 5), round(samples.scatter, 5)
    (9, 0.00616, 0.00205)
    """
    steps, sizes = np.diff(samples.places), dict[int, float]()
    if np.ptp(steps) > _EVEN * np.median(steps) or len(steps) < _FEWEST_ROWS:
        return samples
    rests = rests_exactly(samples.heights)
    for stride in _STRIDES:
        by_order = _sizes(samples.heights, rests, stride)
        if len(by_order) == len(_ORDERS) and max(by_order) < _WHITE * min(by_order):
            sizes[stride] = float(np.median(by_order))
    least = max(samples.digit, LEAST_NOISE * float(np.ptp(samples.heights)))
    if not {1, 2, 3} <= sizes.keys() or sizes[1] < least:
        return samples
    fits = {rows: _fit(sizes, rows) for rows in range(1, min(_MOST, max(sizes)) + 1)}
    rows = min(fits, key=lambda each: fits[each][0])
    off, noise = fits[rows]
    if rows == 1 or off > min(_OFF, _LIKELIER * fits[1][0]):
        return samples
    return replace(samples, noise=np.maximum(samples.noise, np.sqrt(rows) * noise), averaged=rows)


def _fit(sizes: Mapping[int, float], rows: int) -> tuple[float, float]:
    """How far sizes by strides are off those of means of so many rows, of logarithms, and the noise of each mean.

    Longer strides than these rows tell no more of them, and show the motion itself.
    """
    strides = tuple(stride for stride in sizes if stride <= max(_FEWEST_STRIDES, rows + 1))
    logs = np.log([sizes[stride] for stride in strides]) - 0.5 * np.log(_of_mean(rows, strides))
    middle = float(np.median(logs))
    return float(np.abs(logs - middle).mean()), float(np.exp(middle))


def _sizes(heights: Array, rests: Mask, stride: int) -> list[float]:
    """The standard deviations that differences of rows so far apart show, for each order of which there are enough."""
    sizes = []
    for order in _ORDERS:
        if len(heights) < order * stride + _FEWEST:
            break
        weights = _weights(order)
        windows = slice(None), slice(None, None, stride)
        differences = sliding_window_view(heights, order * stride + 1)[windows] @ weights
        moving = ~sliding_window_view(rests, order * stride + 1)[windows].any(axis=1)
        if int(moving.sum()) < _FEWEST:
            break
        sizes.append(float(np.median(np.abs(differences[moving]))) / MEDIAN)
    return sizes


def _weights(order: int) -> Array:
    """The weights of a difference, divided by what noise of the size 1 makes of it."""
    weights = np.array([(-1.0) ** i * comb(order, i) for i in range(order + 1)])
    return np.asarray(weights / np.sqrt(weights @ weights))


@cache
def _of_mean(rows: int, strides: tuple[int, ...]) -> Array:
    """The variance of differences of moving means over so many rows, over that of a mean; one for each stride."""
    variances = []
    for stride in strides:
        of_orders = []
        for order in _ORDERS:
            weights, k = _weights(order), stride * np.arange(order + 1)
            shared = np.maximum(1.0 - np.abs(k[:, None] - k) / rows, 0.0)
            of_orders.append(float(weights @ shared @ weights))
        variances.append(np.median(of_orders))
    return np.array(variances)
