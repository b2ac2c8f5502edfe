"""Magnitudes of complex functions that are affine in the law: second-order cones, one for each place."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numerics.chebyshev import basis_values, product, real_parts_of_roots
from optlaws.synthesis.families.family import Family, Jet

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_NOTHING = 1e-300  # where the amplitude vanishes it has no slope
_NEGLIGIBLE = 2.0**-52


@dataclass(frozen=True, eq=False, kw_only=True)
class ConeFamily(Family):
    """f = |p|, p a complex Chebyshev series in u for each variable, and one that belongs to none as the last column.

    The place is no k but stands for another parameter, such as a frequency; u = -1 is its least value.
    """

    series: Complex

    def in_units(self, units: Array, unit: float) -> Self:
        """The series' columns and the right side in other units."""
        series = self.series * np.append(units, 1.0) / unit
        return replace(self, series=series, slack=self.slack * units / unit, bound=self.bound / unit)

    def k(self, u: Array) -> Array:
        """The place as a number from 0 at u = -1 to 1 at u = 1."""
        places: Array = (1.0 + u) / 2.0
        return places

    def u(self, k: Array) -> Array:
        """The u of such a number."""
        return 2.0 * k - 1.0

    def nodes(self) -> Array | None:
        """As many places as the series needs to be known, nearly."""
        if self.domain[0] == self.domain[1]:
            return None
        sizes = np.abs(self.series).max(axis=1)
        count = max(int((sizes > _NODES * sizes.max()).sum()), 3)
        return np.asarray(chebyshev.chebpts2(count)[::-1])

    @kept_property
    def _jet(self) -> Complex:
        first = _slope(self.series)
        return np.hstack([self.series, first, _slope(first)])

    def columns(self, u: Array) -> Complex:
        """p's columns with two derivatives by u, shape (3, points, variables + 1)."""
        flat = basis_values(np.minimum(np.maximum(u, -1.0), 1.0), len(self.series)) @ self._jet
        shaped: Complex = flat.reshape(len(u), 3, -1).transpose(1, 0, 2)
        return shaped

    def tangent(self, u: float, direction: Array) -> Array:
        """The affine function that a unit vector makes of p at u; |p| is nowhere below it."""
        columns = self.columns(np.array([u]))[0, 0]
        row: Array = direction[0] * columns.real + direction[1] * columns.imag
        return row

    def direction(self, x: Array, u: float) -> tuple[float, float]:
        """The unit vector of p at u."""
        p = complex(self.columns(np.array([u]))[0, 0] @ np.append(x, 1.0))
        size = max(abs(p), _NOTHING)
        return p.real / size, p.imag / size

    def jet(self, x: Array, u: Array, s: Array) -> Jet:
        """Residuals with their derivatives."""
        columns = self.columns(u)
        p0, p1, p2 = columns @ np.append(x, 1.0)
        f0, f1 = columns[:2, :, :-1]
        size = np.maximum(np.abs(p0), _NOTHING)
        slope = (p0.conj() * p1).real / size
        curvature = (np.abs(p1) ** 2 + (p0.conj() * p2).real) / size - slope**2 / size
        gradient = (p0.conj()[:, None] * f0).real / size[:, None]
        turning = (p1.conj()[:, None] * f0 + p0.conj()[:, None] * f1).real / size[:, None]
        slope_gradient = turning - gradient * (slope / size)[:, None]
        room = self.room(x)
        signs = s[:, None]
        return Jet(s * size - room, s * slope, s * curvature, signs * gradient - self.slack, signs * slope_gradient)

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:
        """The second derivatives of the weighted sum of the magnitudes."""
        columns = self.columns(u)[0]
        p = columns @ np.append(x, 1.0)
        size = np.maximum(np.abs(p), _NOTHING)
        # what turns p counts, what lengthens it does not
        across = (p.conj()[:, None] * columns[:, :-1]).imag / size[:, None]
        curved: Array = (across * (weights / size)[:, None]).T @ across
        return curved

    def value(self, x: Array, u: Array) -> Array:
        """|p| at the points u."""
        sizes: Array = np.abs(np.asarray(chebyshev.chebval(u, self.series @ np.append(x, 1.0))))
        return sizes

    def stationary(self, x: Array) -> Array:
        """Roots of the derivative of |p|²."""
        return stationary_places(self.series @ np.append(x, 1.0))


_NODES = 1e-6


def stationary_places(series: Complex) -> Array:
    """Points among which every stationary point in [-1, 1] of the magnitude of a complex series is.

    Examples
    --------
    >>> stationary_places(np.array([1.0j, 1.0])).round(12).tolist()
    [0.0]
    """
    sizes = np.abs(series)
    kept = np.flatnonzero(sizes > _NEGLIGIBLE * sizes.max(initial=0.0))
    if not len(kept):
        return np.empty(0)
    short = series[: kept[-1] + 1]
    squares = [product(part, part) for part in (short.real.copy(), short.imag.copy())]
    slope = np.asarray(chebyshev.chebder(squares[0] + squares[1]), dtype=np.float64)
    return real_parts_of_roots(slope)


def _slope(series: Complex) -> Complex:
    slope = np.zeros_like(series)
    lower = chebyshev.chebder(series)
    slope[: len(lower)] = lower
    return slope
