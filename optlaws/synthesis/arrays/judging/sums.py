"""Sums of weighted rows of many laws, as sharp as if they were rounded once: great multipliers cancel in them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SPLIT = 2.0**27 + 1.0


def sums_of_rows(start: Array, weights: Array, rows: Array) -> Array:
    """What a start and the weighted rows of each law add up to, rounded once but for the square of what that is off.

    Parameters
    ----------
    start
        To which they are added, shape (laws, numbers) or one for all.
    weights, rows
        Shapes (laws, rows) and (laws, rows, numbers), or rows that are those of all laws.

    Examples
    --------
    >>> sums_of_rows(np.array([1.0]), np.array([[1e17, -1e17]]), np.array([[1.0], [1.0]])).tolist()
    [[1.0]]
    """
    total = np.broadcast_to(start, (len(weights), rows.shape[-1])).copy()
    rest = np.zeros_like(total)
    for i, weight in enumerate(weights.T):
        product, beside = _product(weight[:, None], rows[..., i, :])
        further = total + product
        moved = further - total
        rest += beside + ((total - (further - moved)) + (product - moved))
        total = further
    return np.asarray(total + rest)


def _product(first: Array, second: Array) -> tuple[Array, Array]:
    """A product, and what rounding took from it (Dekker 1971)."""
    product = first * second
    (a, b), (c, d) = _halves(first), _halves(second)
    return product, b * d - (((product - a * c) - b * c) - a * d)


def _halves(values: Array) -> tuple[Array, Array]:
    scaled = _SPLIT * values
    high = scaled - (scaled - values)
    return high, values - high
