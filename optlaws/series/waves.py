"""Roots and mean squares of waves: panel by panel, each resolved to rounding by one Chebyshev interpolant."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from optlaws.series import chebyshev
from optlaws.series.peaks import polished

Array = NDArray[np.float64]

PANEL = 10.0  # radians of a sine, and of its square, that one interpolant of COUNT values resolves to rounding
COUNT = 41


def panels(frequency: float, length: float) -> list[tuple[float, float]]:
    """Start and half width, in u = s / length, of equal panels of at most PANEL radians each.

    Examples
    --------
    >>> panels(20.0, 1.0)
    [(0.0, 0.25), (0.5, 0.25)]
    """
    count = max(1, ceil(frequency * length / PANEL))
    return [(i / count, 0.5 / count) for i in range(count)]


def wave_roots(residual: Callable[[Array], tuple[Array, Array]], frequency: float, length: float) -> Array:
    """Every u in [0, 1] where a residual, given with its derivative with respect to s, may be zero.

    Examples
    --------
    >>> 0.523599 in wave_roots(lambda u: (np.cos(3.0 * u), -3.0 * np.sin(3.0 * u)), 3.0, 1.0).round(6)
    True
    """
    nodes, change = _interpolation()
    found = []
    for start, half in panels(frequency, length):

        def local(x: Array, start: float = start, half: float = half) -> tuple[Array, Array]:
            value, slope = residual(np.clip(start + half * (x + 1.0), 0.0, 1.0))
            return value, slope * (half * length)

        x = polished(chebyshev.real_parts_of_roots(change @ local(nodes)[0]), local)
        found.append(np.clip(start + half * (x + 1.0), 0.0, 1.0))
    return np.concatenate(found)


def wave_square(values: Callable[[Array], Array], frequency: float, length: float) -> float:
    """Integral over s of the square of a wave given in u.

    Examples
    --------
    >>> round(wave_square(lambda u: np.sin(np.pi * u), np.pi, 1.0), 12)
    0.5
    """
    x, change = _interpolation()
    total = 0.0
    for start, half in panels(frequency, length):
        wave = change @ values(start + half * (x + 1.0))
        total += 2.0 * half * length * chebyshev.mean_product(wave, wave)
    return total


@lru_cache(maxsize=1)
def _interpolation() -> tuple[Array, Array]:
    """Chebyshev points and the matrix that turns values there into a Chebyshev series."""
    x: Array = np.cos((np.arange(COUNT) + 0.5) * (pi / COUNT))
    change = chebyshev.basis_values(x, COUNT).T * (2.0 / COUNT)
    change[0] *= 0.5
    return x, change
