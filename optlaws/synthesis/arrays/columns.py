"""Rows of one family in many laws at once: each with the plane that touches it there, as variables and 1 weigh it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.synthesis.arrays.constants import peaks, product
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.family import LinearFamily, NormFamily, ProductFamily, RatioFamily, RootFamily

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

#: of a row: what rounding may hide of it, as a share of the sum of its parts' sizes
ROUNDING = 4 * 2.0**-53
_NO_NORM = 1e-300
#: of fewer polynomials' values cosines are quicker than the recurrence
_SMALL = 4096


class Tangents(ABC):
    """What the optimality conditions of many laws need of one family."""

    @property
    def proving(self) -> bool:
        """Whether no law is beyond the planes, so that multipliers prove bounds."""
        return True

    @abstractmethod
    def at(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """Planes of f and of its derivative by the place, (laws, places, variables + 1), and its second derivative.

        The places of a law are a row of `u`, its variables and 1 a row of `point`.
        """

    @abstractmethod
    def hidden(self, weights: Array, u: Array, point: Array) -> Array:
        """What rounding may hide of each entry of the sum of weights times planes, (laws, variables + 1)."""

    def hessian(self, u: Array, point: Array, weights: Array) -> Array | None:  # noqa: ARG002 - of what is affine
        """Second derivatives by the variables of the sum of weights times f; None where f is affine."""
        return None


class CurvedTangents(Tangents):
    """Of a family that is not affine in the law."""

    @abstractmethod
    def greatest(self, point: Array) -> Array:
        """The greatest magnitude of f in each law, recomputed over the whole interval."""


@dataclass(frozen=True, eq=False)
class Columns(Tangents):
    """Rows that are affine in the law: Chebyshev polynomials times a family's series, row by row."""

    family: LinearFamily

    @kept_property
    def _parts(self) -> tuple[tuple[NDArray[np.intp], Array], ...]:
        """For f and its first two derivatives: which polynomials they are made of, and with what coefficients."""
        parts = []
        series = self.family.series
        for _ in range(3):
            kept = np.flatnonzero(series.any(axis=1))
            parts.append((kept, np.ascontiguousarray(series[kept])))
            series = np.asarray(chebyshev.chebder(series), dtype=np.float64)
        return tuple(parts)

    @kept_property
    def rounding(self) -> Array:
        """What rounding may hide of each entry of a row."""
        return np.asarray(ROUNDING * np.abs(self.family.series).sum(axis=0))

    def hidden(self, weights: Array, u: Array, point: Array) -> Array:  # noqa: ARG002 - the same everywhere
        """What rounding may hide of rows, whatever the place."""
        return np.asarray(weights.sum(axis=1)[:, None] * self.rounding)

    def at(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """The rows themselves, whatever the law."""
        if isinstance(self.family, RatioFamily | RootFamily):
            columns = self.family.columns(u.reshape(-1)).reshape(3, *u.shape, -1)
            return columns[0], columns[1], np.einsum("mpi,mi->mp", columns[2], point)
        polynomials = _polynomials(u.reshape(-1), len(self.family.series))
        value, slope = ((polynomials[kept].T @ series).reshape(*u.shape, -1) for kept, series in self._parts[:2])
        kept, series = self._parts[2]
        bend = np.einsum("nmp,mn->mp", polynomials[kept].reshape(len(kept), *u.shape), point @ series.T)
        return value, slope, bend


@dataclass(frozen=True, eq=False)
class Products(CurvedTangents):
    """The power b c: a product of two affine families, which is not convex."""

    family: ProductFamily

    @property
    def proving(self) -> bool:
        """False: a plane that touches a power proves nothing."""
        return False

    @kept_property
    def _factors(self) -> tuple[Columns, Columns]:
        return Columns(self.family.first), Columns(self.family.second)

    def hidden(self, weights: Array, u: Array, point: Array) -> Array:
        """The rounding that the rows of both factors hide."""
        return np.asarray(sum(factor.hidden(weights, u, point) for factor in self._factors))

    def at(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """Planes by the product rule."""
        (g, g_slope, g2), (h, h_slope, h2) = (factor.at(u, point) for factor in self._factors)
        g0, g1, h0, h1 = (np.einsum("mpi,mi->mp", one, point)[:, :, None] for one in (g, g_slope, h, h_slope))
        value = h0 * g + g0 * h
        value[:, :, -1] -= (g0 * h0)[:, :, 0]
        slope = h0 * g_slope + h1 * g + g0 * h_slope + g1 * h
        slope[:, :, -1] -= (g1 * h0 + g0 * h1)[:, :, 0]
        return value, slope, g2 * h0[:, :, 0] + 2.0 * (g1 * h1)[:, :, 0] + g0[:, :, 0] * h2

    def hessian(self, u: Array, point: Array, weights: Array) -> Array:
        """Rows of one factor times those of the other."""
        g, h = (factor.at(u, point)[0][:, :, :-1] for factor in self._factors)
        half = np.matmul((g * weights[:, :, None]).transpose(0, 2, 1), h)
        return np.asarray(half + half.transpose(0, 2, 1))

    def greatest(self, point: Array) -> Array:
        """The greatest magnitude of f in each law over the whole interval."""
        first, second = (point @ family.series.T for family in (self.family.first, self.family.second))
        return peaks(product(first, second))


@dataclass(frozen=True, eq=False)
class Norms(CurvedTangents):
    """A root mean square: the norm of what a matrix makes of the variables and 1. It has no place."""

    family: NormFamily

    def hidden(self, weights: Array, u: Array, point: Array) -> Array:  # noqa: ARG002 - it has no place
        """The rounding hidden in a unit vector times the matrix."""
        own = len(self.family.matrix) * ROUNDING * np.abs(self.family.matrix).sum(axis=0)
        return np.asarray(weights.sum(axis=1)[:, None] * own)

    def at(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """What the direction of each law shows of the norm; no law's norm is less."""
        value = np.repeat(self._shown(point)[1][:, None, :], u.shape[1], axis=1)
        return value, np.zeros_like(value), np.zeros(u.shape)

    def _shown(self, point: Array) -> tuple[Array, Array]:
        image = point @ self.family.matrix.T
        size = np.maximum(np.sqrt((image * image).sum(axis=1)), _NO_NORM)
        return size, (image / size[:, None]) @ self.family.matrix

    def hessian(self, u: Array, point: Array, weights: Array) -> Array:  # noqa: ARG002 - it has no place
        """The second derivatives of the norm."""
        size, shown = self._shown(point)
        rows, matrix = shown[:, :-1], self.family.matrix[:, :-1]
        bent = matrix.T @ matrix - rows[:, :, None] * rows[:, None, :]
        return np.asarray(bent * (weights.sum(axis=1) / size)[:, None, None])

    def greatest(self, point: Array) -> Array:
        """The norm of each law."""
        return self._shown(point)[0]


@dataclass(frozen=True, eq=False)
class Cones(CurvedTangents):
    """Magnitudes of complex functions that are affine in the law, such as residual vibrations over frequencies."""

    family: ConeFamily

    def hidden(self, weights: Array, u: Array, point: Array) -> Array:  # noqa: ARG002 - the same everywhere
        """The rounding hidden in a unit vector times the two parts of the columns."""
        own = ROUNDING * (np.abs(self.family.series.real) + np.abs(self.family.series.imag)).sum(axis=0)
        return np.asarray(weights.sum(axis=1)[:, None] * own)

    def _jets(self, u: Array, point: Array) -> tuple[Complex, Complex]:
        """The columns with two derivatives by the place, and what they are in each law."""
        columns = self.family.columns(u.reshape(-1)).reshape(3, *u.shape, -1)
        return columns, np.einsum("dmpi,mi->dmp", columns, point)

    def at(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """What the direction of each law shows of the magnitude; no law's is less."""
        (f0, f1, _), (p0, p1, p2) = self._jets(u, point)
        size = np.maximum(np.abs(p0), _NO_NORM)
        slope = (p0.conj() * p1).real / size
        value = (p0.conj()[:, :, None] * f0).real / size[:, :, None]
        turning = (p1.conj()[:, :, None] * f0 + p0.conj()[:, :, None] * f1).real / size[:, :, None]
        bend = (np.abs(p1) ** 2 + (p0.conj() * p2).real) / size - slope**2 / size
        return value, turning - value * (slope / size)[:, :, None], bend

    def hessian(self, u: Array, point: Array, weights: Array) -> Array:
        """What turns the function counts, what lengthens it does not."""
        (columns, *_), (p, *_) = self._jets(u, point)
        size = np.maximum(np.abs(p), _NO_NORM)
        across = (p.conj()[:, :, None] * columns[:, :, :-1]).imag / size[:, :, None]
        return np.asarray(np.matmul((across * (weights / size)[:, :, None]).transpose(0, 2, 1), across))

    def greatest(self, point: Array) -> Array:
        """The greatest magnitude in each law, wherever it is."""
        low, high = self.family.domain
        if low == high:
            return np.abs(self._jets(np.full((len(point), 1), low), point)[1][0, :, 0])
        real, imaginary = (point @ part.T for part in (self.family.series.real, self.family.series.imag))
        return np.asarray(np.sqrt(peaks(product(real, real) + product(imaginary, imaginary))))


def _polynomials(u: Array, count: int) -> Array:
    """Chebyshev polynomials at many places, shape (count, places)."""
    if u.size * count < _SMALL:
        return np.asarray(np.cos(np.arange(count)[:, None] * np.arccos(np.minimum(np.maximum(u, -1.0), 1.0))))
    polynomials = np.empty((max(count, 2), len(u)))
    polynomials[0], polynomials[1] = 1.0, np.clip(u, -1.0, 1.0)
    twice = 2.0 * polynomials[1]
    for n in range(2, count):
        np.multiply(twice, polynomials[n - 1], out=polynomials[n])
        polynomials[n] -= polynomials[n - 2]
    return polynomials[:count]
