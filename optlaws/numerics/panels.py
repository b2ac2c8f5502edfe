"""Functions of one variable on panels, each a Chebyshev series: integrals and roots to rounding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.peaks import polished

Function = Callable[[Array], Array]
#: whether a panel of this series and this length is short enough
Short = Callable[[Array, float], bool]

TERMS = 33
RADIANS, WAVE_TERMS = 10.0, 41  # so many terms resolve so many radians of a sine, and of its square, to rounding


@dataclass(frozen=True, slots=True)
class Panels:
    """Edges of panels, and how many terms of a series resolve a function on each of them.

    >>> waves = Panels((0.0, 1.0, 2.0, 3.0))
    >>> bool(np.abs(waves.roots(np.cos, lambda t: -np.sin(t)) - np.pi / 2).min() < 1e-15)
    True
    >>> round(waves.square(np.cos), 12) == round(1.5 + 0.25 * float(np.sin(6.0)), 12)
    True
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
        return self.roots_of(self.series(f), f, slope)

    def roots_of(self, series: Array, f: Function, slope: Function) -> Array:
        """The roots where the series of f on every panel are known."""
        roots = [chebyshev.real_parts_of_roots(column) for column in series.T]
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


@dataclass(frozen=True, slots=True)
class Integral:
    """The integral of a function from the first edge of its panels."""

    edges: tuple[float, ...]
    parts: tuple[tuple[float, ...], ...]

    def __call__(self, t: Array) -> Array:
        """The integral up to t."""
        values = np.zeros(t.shape)
        places = np.searchsorted(self.edges[1:-1], t, side="right")
        for i, (low, high) in enumerate(pairwise(self.edges)):
            here = places == i
            if here.any():
                x = np.clip(2.0 * (t[here] - low) / (high - low) - 1.0, -1.0, 1.0)
                values[here] = chebyshev.value(np.array(self.parts[i]), x)
        return values


def equal(low: float, high: float, count: int, terms: int = TERMS) -> Panels:
    """A number of panels of equal length.

    >>> equal(0.0, 1.0, 2).edges
    (0.0, 0.5, 1.0)
    """
    return Panels(tuple(np.linspace(low, high, count + 1).tolist()), terms)


def of_waves(frequency: float, length: float) -> Panels:
    """Panels of u = s / length on which waves of at most this frequency in s are resolved, and their squares.

    >>> of_waves(20.0, 1.0).edges
    (0.0, 0.5, 1.0)
    """
    return equal(0.0, 1.0, max(1, ceil(frequency * length / RADIANS)), WAVE_TERMS)


def resolved(f: Function, first: Panels, short: Short) -> tuple[Panels, Array]:
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


def integral(f: Function, on: Panels) -> Integral:
    """The integral of f from the first edge on."""
    total, parts = 0.0, []
    for (low, high), values in zip(pairwise(on.edges), on.series(f).T, strict=True):
        integral = chebyshev.integral(values * (high - low), 0.0)
        integral[0] += total
        total = float(integral.sum())
        parts.append(tuple(integral.tolist()))
    return Integral(on.edges, tuple(parts))


def _places(low: Array, high: Array, x: Array) -> Array:
    """The places between the edges of panels for x in [-1, 1]."""
    return np.clip(low + 0.5 * (high - low) * (x + 1.0), low, high)
