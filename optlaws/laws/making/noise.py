"""Noise of measured tables: how much of it there is, by the higher differences, and the law that it hides."""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from optlaws.laws.making.splines import Spline, divisions, nearest

Array = NDArray[np.float64]

#: orders of the differences: high enough to hide a smooth law, and few enough points for its joints not to fill them
_ORDERS = range(4, 9)
#: fewer points tell no noise from the joints of a law's pieces
_FEWEST = 31
#: noise that changes the acceleration of a law through the points by less is none, in units of stroke over time squared
_UNSEEN = 0.1
#: the mean of the lower half of the sizes of normal deviates
_LOWER_HALF = 0.324672
#: pieces of the splines to which the points are compared, and numbers in their matrices
_MOST_PIECES = 200
_LARGEST = 2_000_000
#: by how much, times the number of points to the power -1/2, an estimate of rounding may pass what rounding scatters
_BEYOND_ROUNDING = 5.0
#: times the number of points to the power -1/2: splines that scatter no more above the best are as good
_AS_GOOD = 1.5


def noise(places: Array, heights: Array) -> float:
    """The standard deviation of what scatters the points; 0 where none is seen, or the points are too few to tell.

    Divided differences of points on a smooth law become small as their order rises, those of white noise do not; joints
    of the law may show in them as noise.

    Examples
    --------
    >>> k = np.linspace(0.0, 1.0, 361)
    >>> exact = k**3 * (10 - 15 * k + 6 * k**2)
    >>> noise(k, exact), round(noise(k, exact + np.random.default_rng(1).normal(0.0, 1e-4, 361)), 5)
    (0.0, 0.0001)
    """
    if len(places) < _FEWEST:
        return 0.0
    scatters = [_scatter(places, heights, order) for order in _ORDERS]
    steps = _step_of_rounding(heights) / sqrt(12.0)
    if 6.0 * max(steps, min(scatters)) <= _UNSEEN * float(np.median(np.diff(places))) ** 2:
        return 0.0
    return max(steps, float(np.median(scatters[-3:])))


def of_rounding(size: float, unit: float, count: int) -> bool:
    """Whether noise of a size, estimated from so many points, may be that of rounding to a unit alone.

    Examples
    --------
    >>> of_rounding(0.003, 0.01, 361), of_rounding(0.005, 0.01, 361)
    (True, False)
    """
    return size**2 <= unit**2 / 12.0 * (1.0 + _BEYOND_ROUNDING / sqrt(count))


def through_noise(places: Array, heights: Array, *, rest: bool) -> tuple[float, Spline]:
    """How far points scatter about the spline that foretells left-out ones best, and the simplest that does as well.

    The first is that of generalised cross-validation (Craven and Wahba); of the others that scatter no more than
    chance explains the one of fewest pieces is taken. Its ends are free, for the first and the last point scatter too.
    """
    count = len(places)
    best, splines = (inf, inf), []
    for pieces in divisions(max(1, min(_MOST_PIECES, count // 2, _LARGEST // count))):
        spline = nearest(places, heights, pieces, rest=rest, known=False)
        if spline is not None:
            squares = float(((spline(places) - heights) ** 2).sum())
            splines.append((sqrt(squares / (count - spline.free)), spline))
            best = min(best, (squares / (count - spline.free) ** 2, splines[-1][0]))
    enough = best[1] * (1.0 + _AS_GOOD / sqrt(count))
    return best[1], next(spline for scatter, spline in splines if scatter <= enough)


def _scatter(places: Array, heights: Array, order: int) -> float:
    """The size of white noise whose divided differences are as large as those of the points."""
    k, a = sliding_window_view(places / np.median(np.diff(places)), order + 1), sliding_window_view(heights, order + 1)
    apart = k[:, :, None] - k[:, None, :] + np.eye(order + 1)
    weights = 1.0 / apart.prod(axis=2)
    sizes = np.sort(np.abs((weights * a).sum(axis=1)) / np.sqrt((weights**2).sum(axis=1)))
    # the larger half may be those of the law's joints
    return float(sizes[: (len(sizes) + 1) // 2].mean()) / _LOWER_HALF


def _step_of_rounding(heights: Array) -> float:
    """The unit of heights so coarse that most of them come more than once; else 0."""
    levels = np.unique(heights)
    return float(np.diff(levels).min()) if 2 * len(levels) <= len(heights) else 0.0
