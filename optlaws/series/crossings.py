"""Where a function takes a value: looked for between places where it turns or jumps, so that none is passed over."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from optlaws.series.halving import halved
from optlaws.series.tolerances import TOUCHING

Array = NDArray[np.float64]


def crossings(f: Callable[[float], float], places: Array, after: Array, before: Array, value: float) -> Array:
    """All places, ascending, where a function takes a value; of a stretch on which it rests there, both ends.

    A jump over the value is no place that has it.

    Parameters
    ----------
    f
        The function.
    places
        Ascending places; it is monotone between neighbours.
    after, before
        Its values just after and just before each of them, which differ where it jumps.
    value
        The value.

    Examples
    --------
    >>> ends, heights = np.array([0.0, 0.5, 1.0]), np.array([1.0, 0.0, 1.0])
    >>> crossings(lambda x: (2 * x - 1) ** 2, ends, heights, heights, 0.25).round(12).tolist()
    [0.25, 0.75]
    """
    heights = np.array([after, before])
    size = np.abs(heights[np.isfinite(heights)]).max(initial=abs(value))
    signs = np.where(np.abs(heights - value) <= TOUCHING * size, 0.0, np.sign(heights - value))
    touched = places[(signs == 0.0).any(axis=0)]
    passed = np.flatnonzero(signs[0, :-1] * signs[1, 1:] < 0.0)
    crossed = [_crossing(f, places[i], places[i + 1], value, signs[0, i] > 0.0) for i in passed]
    return np.sort(np.concatenate([touched, crossed]))


def _crossing(f: Callable[[float], float], left: float, right: float, value: float, falling: bool) -> float:  # noqa: FBT001
    """Where a monotone function passes a value; its two ends are never asked."""
    return halved(lambda k: (f(k) > value) == falling, float(left), float(right))[0]
