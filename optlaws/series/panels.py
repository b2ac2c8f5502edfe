"""Functions of one variable on panels, each a Chebyshev series: integrals and roots to rounding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import SolverFailure
from optlaws.series import chebyshev
from optlaws.series.peaks import polished

Array = NDArray[np.float64]
Function = Callable[[Array], Array]

COUNT = 33
RESOLVED = 2e-15
SMALLEST = 1e-6


@dataclass(frozen=True, slots=True)
class Panels:
    """Edges of panels, short enough for the function they were made for."""

    edges: tuple[float, ...]

    def series(self, f: Function) -> list[Array]:
        """Chebyshev series of a function on each panel."""
        return [_series(f, low, high) for low, high in pairwise(self.edges)]

    def roots(self, f: Function, slope: Function) -> Array:
        """Every place among which is each root of f; `slope` is its derivative."""
        found = []
        for (low, high), values in zip(pairwise(self.edges), self.series(f), strict=True):
            half = 0.5 * (high - low)

            def local(x: Array, low: float = low, high: float = high, half: float = half) -> tuple[Array, Array]:
                t = np.clip(low + half * (x + 1.0), low, high)
                return f(t), half * slope(t)

            x = polished(chebyshev.real_parts_of_roots(values), local)
            found.append(np.clip(low + half * (x + 1.0), low, high))
        return np.concatenate(found) if found else np.empty(0)

    def square(self, f: Function) -> float:
        """Integral of f²."""
        return sum(
            (high - low) * chebyshev.mean_product(one, one)
            for (low, high), one in zip(pairwise(self.edges), self.series(f), strict=True)
        )


@dataclass(frozen=True, slots=True)
class Integral:
    """The integral of a function from the first edge of its panels."""

    edges: tuple[float, ...]
    parts: tuple[tuple[float, ...], ...]

    def __call__(self, t: Array) -> Array:
        """The integral up to t."""
        found = np.zeros(t.shape)
        places = np.searchsorted(self.edges[1:-1], t, side="right")
        for i, (low, high) in enumerate(pairwise(self.edges)):
            here = places == i
            if here.any():
                x = np.clip(2.0 * (t[here] - low) / (high - low) - 1.0, -1.0, 1.0)
                found[here] = chebyshev.value(np.array(self.parts[i]), x)
        return found


def panels(f: Function, low: float, high: float, scale: float) -> Panels:
    """Panels from low to high on which f = sqrt(scale² - b²) is resolved to rounding; none where low = high.

    Where f is small next to its scale, rounding of b is all the larger in it, and nothing finer is asked.
    """
    if not low < high:
        return Panels(())
    if not np.isfinite(f(np.linspace(low, high, COUNT))).all():
        raise SolverFailure(f"the velocity of the loader is not finite between t = {low:g} and {high:g}")
    waiting, edges = [(low, high)], [low]
    while waiting:
        start, end = waiting.pop()
        values = np.abs(_series(f, start, end))
        rounding = RESOLVED * scale * max(1.0, scale / max(float(values[0]), 1e-9 * scale))
        if values[-3:].max() <= rounding or end - start < SMALLEST:
            edges.append(end)
        else:
            middle = 0.5 * (start + end)
            waiting += [(middle, end), (start, middle)]
    return Panels(tuple(edges))


def integral(f: Function, on: Panels) -> Integral:
    """The integral of f from the first edge on."""
    total, parts = 0.0, []
    for (low, high), values in zip(pairwise(on.edges), on.series(f), strict=True):
        one = chebyshev.integral(values * (high - low), 0.0)
        one[0] += total
        total = float(one.sum())
        parts.append(tuple(one.tolist()))
    return Integral(on.edges, tuple(parts))


def _series(f: Function, low: float, high: float) -> Array:
    x, change = _interpolation()
    return change @ f(np.clip(low + 0.5 * (high - low) * (x + 1.0), low, high))


@lru_cache(maxsize=1)
def _interpolation() -> tuple[Array, Array]:
    x: Array = np.cos((np.arange(COUNT) + 0.5) * (np.pi / COUNT))
    change = chebyshev.basis_values(x, COUNT).T * (2.0 / COUNT)
    change[0] *= 0.5
    return x, change
