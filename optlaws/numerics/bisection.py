"""Bisection: where what holds at one place and not at another ceases to hold, and where functions take a value."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.tolerances import TOUCHING


def bisect(holds: Callable[[float], bool], inside: float, outside: float, halvings: int = 200) -> tuple[float, float]:
    """Neighbours between two places, or what so many halvings leave: it holds at the first, not at the second.

    For conditions; where a function's sign changes and scipy is at hand, `scipy.optimize.brentq` needs fewer steps.

    >>> last, first = bisect(lambda x: x * x <= 2.0, 0.0, 2.0)
    >>> last * last <= 2.0 < first * first, first - last < 1e-15
    (True, True)
    """
    for _ in range(halvings):
        middle = 0.5 * (inside + outside)
        if middle in (inside, outside):
            break
        if holds(middle):
            inside = middle
        else:
            outside = middle
    return inside, outside


def bisect_each(
    holds: Callable[[Array], NDArray[np.bool_]], inside: Array, outside: Array, halvings: int = 60
) -> tuple[Array, Array]:
    """Pairs of places many at once: a condition on arrays holds at the first of each pair, not at the second.

    >>> bisect_each(lambda x: x * x <= np.array([2.0, 9.0]), np.zeros(2), np.full(2, 4.0))[0].round(12)
    array([1.41421356, 3.        ])
    """
    for _ in range(halvings):
        middle = 0.5 * (inside + outside)
        within = holds(middle)
        inside, outside = np.where(within, middle, inside), np.where(within, outside, middle)
    return inside, outside


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
    crossed = [_crossing(f, float(places[i]), float(places[i + 1]), value, signs[0, i] > 0.0) for i in passed]
    return np.sort(np.concatenate([touched, crossed]))


def _crossing(f: Callable[[float], float], left: float, right: float, value: float, falling: bool) -> float:  # noqa: FBT001
    """The place where a monotone function passes a value; nothing is evaluated at its two ends."""
    return bisect(lambda k: (f(k) > value) == falling, left, right)[0]
