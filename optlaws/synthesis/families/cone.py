"""Magnitudes of complex functions that are affine in the law: second-order cones, one for each place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.formulas.slopes import Slopes
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import product, real_parts_of_roots
from optlaws.synthesis.families.family import NonlinearFamily, RowJet, SeriesFamily, last_result
from optlaws.synthesis.families.piece_series import peaks, products
from optlaws.tolerances import EPSILON, ROW_ROUNDING, TINY


@dataclass(frozen=True, eq=False)
class SumOfSquares:
    """The function |rows . (x, 1)|² + affine . (x, 1), or where `root` the norm |rows . (x, 1)|.

    Attributes
    ----------
    rows, affine
        Shapes (rows, variables + 1) and (variables + 1,).
    root
        Whether the root is meant; nothing affine is under it.
    """

    rows: Array
    affine: Array
    root: bool = False


def sum_of_squares(
    slopes: Slopes, at: Mapping[str, Array], columns: Array, weights: Array, *, root: bool = False
) -> SumOfSquares:
    """The sum over places of a formula that is quadratic in its names, and convex, times weights above 0.

    Parameters
    ----------
    slopes
        The formula with its derivatives by the names.
    at
        Where it is expanded: every name 0, and k.
    columns
        What the names are in the variables, shape (names, places, variables + 1).
    weights
        Of the places.
    root
        Whether its root is meant.
    """
    value, gradient, hessian = slopes.derivatives(at)
    sizes, axes = np.linalg.eigh(hessian.transpose(2, 0, 1) / 2.0)
    # it is convex: what is below 0 is rounding
    lengths = np.sqrt(np.maximum(sizes, 0.0) * weights[:, None])
    rows = np.einsum("pij,pj,ipn->pjn", axes, lengths, columns).reshape(-1, columns.shape[2])
    affine = np.einsum("ip,ipn->n", gradient * weights, columns)
    affine[-1] += float(weights @ value)
    return SumOfSquares(rows, affine, root)


_CONE_NODES = 1e-6  # of the greatest coefficient of a cone's series: those above it say how many nodes are looked at

Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False, kw_only=True)
class ConeFamily(SeriesFamily, NonlinearFamily):
    """f = |p|, p the sum of complex series times the variables.

    The place is no k but stands for another parameter, such as a frequency; u = -1 is its least value.
    """

    def k(self, u: Array) -> Array:
        """The place as a number from 0 at u = -1 to 1 at u = 1."""
        return 0.5 * (1.0 + u)

    def u(self, k: Array) -> Array:
        """The place u in [-1, 1] of a number in [0, 1]."""
        return 2.0 * k - 1.0

    def nodes(self) -> Array | None:
        """Chebyshev points, as many as determine the series up to rounding."""
        if self.domain[0] == self.domain[1]:
            return None
        sizes = np.abs(self.series).max(axis=1)
        count = max(int((sizes > _CONE_NODES * sizes.max()).sum()), 3)
        return np.asarray(chebyshev.chebpts2(count)[::-1])

    def tangent(self, u: float, direction: Array) -> Array:
        """The affine function of p at u along a unit vector; it is nowhere above |p|."""
        columns = self.columns(np.array([u]))[0, 0]
        return np.asarray(direction[0] * columns.real + direction[1] * columns.imag)

    def direction(self, x: Array, u: float) -> tuple[float, float]:
        """The unit vector of p at u."""
        p = complex(self.columns(np.array([u]))[0, 0] @ np.append(x, 1.0))
        size = max(abs(p), TINY)
        return p.real / size, p.imag / size

    @last_result
    def _jets(self, u: Array, point: Array) -> tuple[Complex, Complex]:
        """Columns with two derivatives with respect to the place, and their values in each law."""
        columns: Complex = self.columns(u.reshape(-1)).reshape(3, *u.shape, -1)
        return columns, (columns @ point[:, :, None])[..., 0]

    def planes(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """Planes by the direction of each law; the magnitude of no law is below them."""
        (f0, f1, _), (p0, p1, p2) = self._jets(u, point)
        size = np.maximum(np.abs(p0), TINY)
        slope = (p0.conj() * p1).real / size
        value = (p0.conj()[:, :, None] * f0).real / size[:, :, None]
        turning = (p1.conj()[:, :, None] * f0 + p0.conj()[:, :, None] * f1).real / size[:, :, None]
        bend = (np.abs(p1) ** 2 + (p0.conj() * p2).real) / size - slope**2 / size
        return value, turning - value * (slope / size)[:, :, None], bend

    def jet(self, x: Array, u: Array, s: Array) -> RowJet:
        """Residuals of one law with their derivatives; of a small amplitude rounding in its planes would be great."""
        _, (p0, p1, _) = self._jets(u[None], np.append(x, 1.0)[None])
        size = np.abs(p0[0])
        slope = (p0[0].conj() * p1[0]).real / np.maximum(size, TINY)
        return replace(super().jet(x, u, s), value=s * size - self.right_side(x), slope=s * slope)

    def hessians(self, u: Array, point: Array, weights: Array) -> Array:
        """Second derivatives of the weighted magnitudes: what turns p counts, what lengthens it does not."""
        (columns, *_), (p, *_) = self._jets(u, point)
        size = np.maximum(np.abs(p), TINY)
        across = (p.conj()[:, :, None] * columns[:, :, :-1]).imag / size[:, :, None]
        return np.asarray(np.matmul((across * (weights / size)[:, :, None]).transpose(0, 2, 1), across))

    def rounding_errors(self, weights: Array, u: Array, point: Array) -> Array:  # noqa: ARG002 - the same everywhere
        """The rounding hidden in a unit vector times the two parts of the columns."""
        errors = ROW_ROUNDING * (np.abs(self.series.real) + np.abs(self.series.imag)).sum(axis=0)
        return np.asarray(weights.sum(axis=1)[:, None] * errors)

    def greatest(self, point: Array) -> Array:
        """The greatest magnitude in each law, wherever it is."""
        low, high = self.domain
        if low == high:
            return np.abs(self._jets(np.full((len(point), 1), low), point)[1][0, :, 0])
        real, imaginary = (point @ part.T for part in (self.series.real, self.series.imag))
        return np.asarray(np.sqrt(peaks(products(real, real) + products(imaginary, imaginary))))

    def value(self, x: Array, u: Array) -> Array:
        """|p| at the points u."""
        return np.asarray(np.abs(chebyshev.chebval(u, self.series @ np.append(x, 1.0))))

    def stationary(self, x: Array) -> Array:
        """Roots of the derivative of |p|²."""
        return stationary_places(self.series @ np.append(x, 1.0))


def stationary_places(series: Complex) -> Array:
    """Points among which every stationary point in [-1, 1] of the magnitude of a complex series is."""
    sizes = np.abs(series)
    counted = np.flatnonzero(sizes > EPSILON * sizes.max(initial=0.0))
    if not len(counted):
        return np.empty(0)
    short = series[: counted[-1] + 1]
    squares = [product(part, part) for part in (short.real.copy(), short.imag.copy())]
    slope = np.asarray(chebyshev.chebder(squares[0] + squares[1]), dtype=np.float64)
    return real_parts_of_roots(slope)
