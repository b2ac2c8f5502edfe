"""Roots of functions: places where they may be extreme, change their sign or take a value; and bisection.

Series of smooth parts have them all; bisection finds one between two places.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import derivative, from_values, interpolated, nodes, real_parts_of_roots
from optlaws.tolerances import QUOTIENT_BLUR, TOUCHING, VALUE_ROUNDING

_DEEPEST = 12
#: for parts so short that nothing is smooth on them
_CLOSE = np.cos(np.linspace(0.0, np.pi, 129))


def series_between(
    function: Callable[[Array], Array], ends: tuple[float, float], count: int | None = None
) -> Array | None:
    """Chebyshev series of a function in what runs from -1 to 1 between two places; None where it is not smooth.

    >>> series_between(lambda x: x * x, (0.0, 2.0)).round(12)
    array([1.5, 2. , 0.5])
    """
    low, high = ends

    def of_local(x: Array) -> Array:
        return function(low + (high - low) * (x + 1.0) / 2.0)

    if count is not None:
        return from_values(of_local(nodes(count)))
    try:
        return interpolated(of_local, "the function", QUOTIENT_BLUR)
    except InputError:
        return None


def candidates(function: Callable[[Array], Array], ends: tuple[float, float], count: int | None = None) -> Array:
    """Places among which every stationary point of a function is; parts that are not smooth are cut in two.

    >>> candidates(lambda x: (x - 0.25) ** 2, (0.0, 1.0)).round(12)
    array([0.25])
    """
    places: list[Array] = []
    for low, high, series in _parts(function, ends, count):
        x = _CLOSE if series is None else real_parts_of_roots(derivative(series))
        places += [low + (high - low) * (x + 1.0) / 2.0, np.array([high])]
    return np.concatenate(places[:-1])


def roots_between(function: Callable[[Array], Array], ends: tuple[float, float]) -> Array:
    """Places strictly between two among which every change of sign of a function is; kinks are cut at.

    >>> roots_between(lambda x: x * x - 0.25, (0.0, 2.0)).round(12)
    array([0.5])
    """
    places: list[Array] = []
    for low, high, series in _parts(function, ends):
        x = np.empty(0) if series is None else real_parts_of_roots(series)
        roots = low + (high - low) * (x + 1.0) / 2.0
        places += [np.unique(roots[(roots > low) & (roots < high)]), np.array([high])]
    return np.concatenate(places[:-1])


def _parts(
    function: Callable[[Array], Array], ends: tuple[float, float], count: int | None = None, depth: int = 0
) -> Iterator[tuple[float, float, Array | None]]:
    """Ends of parts in which a function is smooth, with its series there; None where no short part is smooth."""
    series, (low, high) = series_between(function, ends, count), ends
    if series is not None or depth >= _DEEPEST:
        yield low, high, series
        return
    middle = (low + high) / 2.0
    yield from _parts(function, (low, middle), None, depth + 1)
    yield from _parts(function, (middle, high), None, depth + 1)


def cut_at_roots(function: Callable[[float, float], Callable[[Array], Array]], edges: list[float]) -> list[float]:
    """The edges, and between them the places where functions change their sign, but for those next to another one.

    >>> cut_at_roots(lambda low, high: np.cos, [0.0, 2.0, 3.0])
    [0.0, 1.570796..., 2.0, 3.0]
    """
    edge = edges[:1]
    for low, high in pairwise(edges):
        of = function(low, high)
        edge += [*_changes(of, np.array([low, *roots_between(of, (low, high)), high])), high]
    return edge


def cut_at_all(functions: Iterable[Callable[[Array], Array]], edges: list[float]) -> list[float]:
    """The edges, and between them the places where any of several functions, smooth there, changes its sign.

    >>> cut_at_all([np.cos, np.sin], [1.0, 4.0])
    [1.0, 1.570796..., 3.141592..., 4.0]
    """
    places = {*edges}
    for function in functions:
        places.update(cut_at_roots(lambda low, high: function, edges))  # noqa: ARG005, B023 - it is called at once
    return sorted(places)


def _changes(function: Callable[[Array], Array], places: Array) -> list[float]:
    """Those of the inner places at which a function that is more than rounding changes its sign."""
    values = function((places[1:] + places[:-1]) / 2.0)
    plain = np.flatnonzero(np.abs(values) > VALUE_ROUNDING * np.abs(values).max())
    turns = np.sign(values[plain[1:]]) != np.sign(values[plain[:-1]])
    return [float(place) for place in places[plain[1:]][turns]]


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
