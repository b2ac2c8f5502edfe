"""Places between two others where functions may be extreme or change their sign, from series of smooth parts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import pairwise

import numpy as np

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import derivative, from_values, interpolated, nodes, real_parts_of_roots
from optlaws.tolerances import QUOTIENT_BLUR, VALUE_ROUNDING

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
