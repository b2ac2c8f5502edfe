"""Functions of one variable on pieces, each a Chebyshev series: stationary places, roots and integrals to rounding."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import ceil

import numpy as np

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.peaks import polished
from optlaws.tolerances import VALUE_ROUNDING

_QUOTIENT_BLUR = 1e-8  # of the greatest value: quotients of small numbers are rounded more than others
_DEEPEST = 12
#: for parts so short that nothing is smooth on them
_CLOSE = np.cos(np.linspace(0.0, np.pi, 129))

Function = Callable[[Array], Array]

TERMS = 33
RADIANS, WAVE_TERMS = 10.0, 41  # so many terms resolve so many radians of a sine, and of its square, to rounding


def series_between(function: Function, ends: tuple[float, float], count: int | None = None) -> Array | None:
    """Chebyshev series of a function in what runs from -1 to 1 between two places; None where it is not smooth.

    >>> series_between(lambda x: x * x, (0.0, 2.0)).round(12)
    array([1.5, 2. , 0.5])
    """
    low, high = ends

    def of_local(x: Array) -> Array:
        return function(low + (high - low) * (x + 1.0) / 2.0)

    if count is not None:
        return chebyshev.from_values(of_local(chebyshev.nodes(count)))
    try:
        return chebyshev.interpolated(of_local, "the function", _QUOTIENT_BLUR)
    except InputError:
        return None


def candidates(function: Function, ends: tuple[float, float], count: int | None = None) -> Array:
    """Places among which every stationary point of a function is; parts that are not smooth are cut in two.

    >>> candidates(lambda x: (x - 0.25) ** 2, (0.0, 1.0)).round(12)
    array([0.25])
    """
    places: list[Array] = []
    for low, high, series in _parts(function, ends, count):
        x = _CLOSE if series is None else chebyshev.real_parts_of_roots(chebyshev.derivative(series))
        places += [low + (high - low) * (x + 1.0) / 2.0, np.array([high])]
    return np.concatenate(places[:-1])


def _parts(
    function: Function, ends: tuple[float, float], count: int | None = None, depth: int = 0
) -> Iterator[tuple[float, float, Array | None]]:
    """Ends of parts in which a function is smooth, with its series there; None where no short part is smooth."""
    series, (low, high) = series_between(function, ends, count), ends
    if series is not None or depth >= _DEEPEST:
        yield low, high, series
        return
    middle = (low + high) / 2.0
    yield from _parts(function, (low, middle), None, depth + 1)
    yield from _parts(function, (middle, high), None, depth + 1)


def cut_at_roots(function: Callable[[float, float], Function], edges: list[float]) -> list[float]:
    """The edges and, between them, the sign changes of functions, except for nearly coincident ones.

    >>> cut_at_roots(lambda low, high: np.cos, [0.0, 2.0, 3.0])
    [0.0, 1.570796..., 2.0, 3.0]
    """
    edge = edges[:1]
    for low, high in pairwise(edges):
        of, some = function(low, high), [low]
        for start, stop, series in _parts(of, (low, high)):
            x = np.empty(0) if series is None else chebyshev.real_parts_of_roots(series)
            roots = start + (stop - start) * (x + 1.0) / 2.0
            some += [*np.unique(roots[(roots > start) & (roots < stop)]).tolist(), stop]
        places = np.array(some)
        values = of((places[1:] + places[:-1]) / 2.0)
        plain = np.flatnonzero(np.abs(values) > VALUE_ROUNDING * np.abs(values).max())
        turns = np.sign(values[plain[1:]]) != np.sign(values[plain[:-1]])
        edge += [*places[plain[1:]][turns].tolist(), high]
    return edge


@dataclass(frozen=True, slots=True)
class Panels:
    """Edges of panels, and how many terms of a series resolve a function on each of them.

    >>> waves = Panels((0.0, 1.0, 2.0, 3.0))
    >>> bool(np.abs(waves.roots(np.cos, lambda t: -np.sin(t)) - np.pi / 2).min() < 1e-15)
    True
    >>> round(waves.square(np.cos), 12) == round(1.5 + 0.25 * float(np.sin(6.0)), 12)
    True
    >>> waves.integral(np.cos)(np.array([0.0, np.pi / 2.0])).round(12)
    array([0., 1.])
    """

    edges: tuple[float, ...]
    terms: int = TERMS

    def series(self, f: Function) -> Array:
        """Chebyshev series of a function, a column for each panel."""
        low, high = np.array(self.edges[:-1]), np.array(self.edges[1:])
        if not len(low):
            return np.zeros((self.terms, 0))
        t = _places(low, high, chebyshev.nodes(self.terms)[:, None])
        return chebyshev.from_values(f(t.ravel()).reshape(t.shape))

    def roots(self, f: Function, slope: Function) -> Array:
        """Every place among which is each root of f; `slope` is its derivative."""
        roots = [chebyshev.real_parts_of_roots(column) for column in self.series(f).T]
        counts = [len(x) for x in roots]
        low, high = (np.repeat(np.array(edges), counts) for edges in (self.edges[:-1], self.edges[1:]))

        def residual(x: Array) -> tuple[Array, Array]:
            t = _places(low, high, x)
            return f(t), 0.5 * (high - low) * slope(t)

        return _places(low, high, polished(np.concatenate(roots), residual)) if sum(counts) else np.empty(0)

    def square(self, f: Function) -> float:
        """The integral of the square of f over all panels."""
        return sum(
            (high - low) * chebyshev.mean_product(product, product)
            for (low, high), product in zip(pairwise(self.edges), self.series(f).T, strict=True)
        )

    def integral(self, f: Function) -> Function:
        """The integral of f from the first edge on."""
        total, parts = 0.0, []
        for (low, high), values in zip(pairwise(self.edges), self.series(f).T, strict=True):
            part = chebyshev.integral(values * (high - low), 0.0)
            part[0] += total
            total = float(part.sum())
            parts.append(part)
        return partial(_on_panels, self.edges, parts)


def _on_panels(edges: tuple[float, ...], series: list[Array], t: Array) -> Array:
    values = np.zeros(t.shape)
    places = np.searchsorted(edges[1:-1], t, side="right")
    for i, (low, high) in enumerate(pairwise(edges)):
        here = places == i
        if here.any():
            values[here] = chebyshev.value(series[i], np.clip(2.0 * (t[here] - low) / (high - low) - 1.0, -1.0, 1.0))
    return values


def of_waves(frequency: float, length: float) -> Panels:
    """Panels of u = s / length on which waves of at most this frequency in s are resolved, and their squares.

    >>> of_waves(20.0, 1.0).edges
    (0.0, 0.5, 1.0)
    """
    count = max(1, ceil(frequency * length / RADIANS))
    return Panels(tuple(np.linspace(0.0, 1.0, count + 1).tolist()), WAVE_TERMS)


def resolved(f: Function, first: Panels, short: Callable[[Array, float], bool]) -> tuple[Panels, Array]:
    """Panels halved until each is short enough for the series that f has there; and these series, a column each.

    >>> halves, series = resolved(np.exp, Panels((0.0, 4.0), 9), lambda series, length: length <= 1.0)
    >>> halves.edges, series.shape
    ((0.0, 1.0, 2.0, 3.0, 4.0), (9, 4))
    """
    waiting = list(pairwise(first.edges))[::-1]
    edges, heights = list(first.edges[:1]), []
    while waiting:
        low, high = waiting.pop()
        series = Panels((low, high), first.terms).series(f)[:, 0]
        if short(series, high - low):
            edges.append(high)
            heights.append(series)
        else:
            middle = 0.5 * (low + high)
            waiting += [(middle, high), (low, middle)]
    return Panels(tuple(edges), first.terms), np.array(heights).T


def _places(low: Array, high: Array, x: Array) -> Array:
    """The places between the edges of panels for x in [-1, 1]."""
    return np.clip(low + 0.5 * (high - low) * (x + 1.0), low, high)
