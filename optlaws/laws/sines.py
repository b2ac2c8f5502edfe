"""Sine segments of piecewise laws, for cycloids, modified sines and modified trapezoids."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, cos, pi

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.laws import series
from optlaws.laws.peaks import polished
from optlaws.laws.segments import Segment

Array = NDArray[np.float64]

PANEL = 10.0  # radians of a sine, and of its square, that one interpolant of COUNT values resolves to rounding
COUNT = 41


@dataclass(frozen=True)
class SineSegment(Segment, kind="sine"):
    """Acceleration c = p0 + p1 s + p2 s² + A sin(w s + phi) of s = k - start; velocity b0 at the start.

    Parameters
    ----------
    amplitude, frequency, phase
        A, w > 0 and phi; w in radians per unit of k.
    b0
        Velocity at the segment's start.
    powers
        Up to three numbers p0, p1, p2.

    Examples
    --------
    >>> segment = SineSegment(amplitude=2 * np.pi, frequency=2 * np.pi)
    >>> segment.derivative(np.array([0.5, 1.0]), 1.0, 0).round(12)
    array([0.5, 1. ])
    """

    amplitude: float
    frequency: float
    phase: float = 0.0
    b0: float = 0.0
    powers: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        self._check()
        if self.frequency <= 0.0 or len(self.powers) > 3:
            raise InputError(f"a sine segment needs frequency > 0 and at most three powers, got {self}")

    def derivative(self, u: Array, length: float, nu: int) -> Array:  # noqa: D102
        s, w = u * length, self.frequency
        steady = np.polynomial.Polynomial([*self.powers, 0.0])
        if nu >= 2:
            # a shift of the phase by quarter turns is a change of function: no rounding of multiples of pi
            turned = (np.sin, np.cos, lambda x: -np.sin(x), lambda x: -np.cos(x))[(nu - 2) % 4]
            smooth = steady.deriv(nu - 2)(s) if nu > 2 else steady(s)
            return np.asarray(smooth + self.amplitude * w ** (nu - 2) * turned(w * s + self.phase), dtype=np.float64)
        half = 0.5 * w * s
        if nu == 1:
            swing = 2.0 * np.sin(half + self.phase) * np.sin(half)
        else:
            swing = s * cos(self.phase) - 2.0 / w * np.cos(half + self.phase) * np.sin(half)
        start = self.b0 if nu else self.b0 * s
        return np.asarray(start + steady.integ(2 - nu)(s) + self.amplitude / w * swing, dtype=np.float64)

    def candidates(self, length: float, nu: int) -> Array:  # noqa: D102
        def slope(u: Array) -> tuple[Array, Array]:
            return self.derivative(u, length, nu + 1), self.derivative(u, length, nu + 2)

        return self._roots(slope, length)

    def power_candidates(self, length: float) -> Array:  # noqa: D102
        def slope(u: Array) -> tuple[Array, Array]:
            b, c, j, s = (self.derivative(u, length, nu) for nu in (1, 2, 3, 4))
            return c * c + b * j, 3.0 * c * j + b * s

        return self._roots(slope, length)

    def square(self, length: float, nu: int) -> float:  # noqa: D102
        x, change = _interpolation()
        total = 0.0
        for start, half in self._panels(length):
            values = change @ self.derivative(start + half * (x + 1.0), length, nu)
            total += 2.0 * half * length * series.mean_product(values, values)
        return total

    def _panels(self, length: float) -> list[tuple[float, float]]:
        count = max(1, ceil(self.frequency * length / PANEL))
        return [(i / count, 0.5 / count) for i in range(count)]

    def _roots(self, residual: Callable[[Array], tuple[Array, Array]], length: float) -> Array:
        nodes, change = _interpolation()
        found = []
        for start, half in self._panels(length):

            def local(x: Array, start: float = start, half: float = half) -> tuple[Array, Array]:
                value, slope = residual(np.clip(start + half * (x + 1.0), 0.0, 1.0))
                return value, slope * (half * length)

            x = polished(series.real_parts_of_roots(change @ local(nodes)[0]), local)
            found.append(np.clip(start + half * (x + 1.0), 0.0, 1.0))
        return np.concatenate(found)


@lru_cache(maxsize=1)
def _interpolation() -> tuple[Array, Array]:
    """Chebyshev points and the matrix that turns values there into a Chebyshev series."""
    x: Array = np.cos((np.arange(COUNT) + 0.5) * (pi / COUNT))
    change = series.basis_values(x, COUNT).T * (2.0 / COUNT)
    change[0] *= 0.5
    return x, change
