"""Halving: where what holds at one place and not at another ceases to hold."""

from __future__ import annotations

from collections.abc import Callable


def halved(holds: Callable[[float], bool], inside: float, outside: float, halvings: int = 200) -> tuple[float, float]:
    """Neighbours between the two places, or what so many halvings leave: it holds at the first, not at the second.

    For conditions; where a function's sign changes and scipy is at hand, `scipy.optimize.brentq` needs fewer steps.

    Examples
    --------
    >>> last, first = halved(lambda x: x * x <= 2.0, 0.0, 2.0)
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
