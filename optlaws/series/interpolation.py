"""Smooth functions as Chebyshev series, to machine accuracy."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError

Array = NDArray[np.float64]

FEWEST, MOST = 17, 1025
RESOLVED = 2.0**-50  # what is left of the last tenth of the coefficients, relative to the largest


def chebyshev_series(function: Callable[[Array], Array], name: str) -> Array:
    """Chebyshev series in x, |x| <= 1, of a function of an array of x; `name` is what an error calls it.

    The number of points is doubled until the last coefficients are rounding; those are then left out.

    Raises
    ------
    InputError
        If a value is not finite, or 1025 points do not resolve the function.

    Examples
    --------
    >>> chebyshev_series(lambda x: 2 * x * x, "f").round(12)
    array([1., 0., 1.])
    """
    count = FEWEST
    while True:
        x = points(count)
        values = np.asarray(function(x), dtype=np.float64)
        if not np.isfinite(values).all():
            raise InputError(f"{name} must have finite values on the whole interval")
        found = transformed(values)
        size = np.abs(found)
        noise = RESOLVED * float(np.abs(values).max())
        if size[-max(2, count // 10) :].max() <= noise:
            kept = np.flatnonzero(size > noise)
            return found[: kept[-1] + 1] if len(kept) else np.zeros(1)
        if count >= MOST:
            raise InputError(f"{name} must be smooth on the whole interval: {count} points do not resolve it")
        count = 2 * count - 1


def points(count: int) -> Array:
    """The Chebyshev points of a number of coefficients, in (-1, 1).

    Examples
    --------
    >>> points(2).round(6)
    array([ 0.707107, -0.707107])
    """
    places: Array = np.cos((np.arange(count) + 0.5) * (np.pi / count))
    return places


def transformed(values: Array) -> Array:
    """Chebyshev series of values at the Chebyshev points.

    Examples
    --------
    >>> transformed(3.0 * points(2)).round(12) + 0.0
    array([0., 3.])
    """
    found: Array = _transform(len(values)) @ values
    return found


@lru_cache(maxsize=16)
def _transform(count: int) -> Array:
    # whole multiples of a quarter turn / count, taken modulo a turn before they are rounded
    quarters = np.multiply.outer(np.arange(count), 2 * np.arange(count) + 1) % (4 * count)
    matrix: Array = np.cos(quarters * (0.5 * np.pi / count)) * (2.0 / count)
    matrix[0] *= 0.5
    matrix.setflags(write=False)
    return matrix
