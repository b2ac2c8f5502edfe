"""Functions that are polynomials between breaks, as Chebyshev series."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import product, real_parts_of_roots

_FLAT_SLOPE = 1e-9  # of a series: a slope that is less is flat
_SHARING = 8  # points of a piece, in the mean, from which on no copy of its series is made for each


@dataclass(frozen=True, eq=False)
class PieceSeries:
    """Breaks in u = 1 - 2k, descending from the piece at k = 0, and a Chebyshev series on each piece for each column.

    Shape of `series`: (pieces, coefficients, columns). On piece i the local variable runs from -1 at breaks[i + 1] to
    1 at breaks[i].
    """

    breaks: Array
    series: Array

    def place(self, u: Array) -> tuple[NDArray[np.intp], Array, Array]:
        """Piece, local variable and its slope by u; a break belongs to the piece at smaller u, that is later k."""
        count = len(self.breaks) - 1
        piece = np.clip(np.searchsorted(-self.breaks, -u, side="right") - 1, 0, count - 1)
        high, low = self.breaks[piece], self.breaks[piece + 1]
        slope = 2.0 / (high - low)
        # of one polynomial on [-1, 1] the variable is u itself, without rounding
        local = (u - low) * slope - 1.0 if count > 1 else u * slope - (high + low) / (high - low)
        return piece, np.clip(local, -1.0, 1.0), slope

    def derivative(self) -> PieceSeries:
        """Series of the derivative by u."""
        slope = 2.0 / (self.breaks[:-1] - self.breaks[1:])
        lower = chebyshev.chebder(self.series, axis=1) if self.series.shape[1] > 1 else np.zeros_like(self.series)
        return PieceSeries(self.breaks, np.asarray(lower) * slope[:, None, None])

    def values(self, u: Array) -> Array:
        """Columns at the points u, shape (points, columns)."""
        piece, local, _ = self.place(u)
        return self.sums(chebyshev.chebvander(local, self.series.shape[1] - 1), piece)

    def sums(self, basis: NDArray[np.floating[Any]], piece: NDArray[np.intp]) -> Array:
        """Columns at points of pieces from the Chebyshev polynomials there; many points of a piece share its series."""
        if len(self.series) == 1:
            return np.asarray(basis @ self.series[0])
        if len(piece) < _SHARING * len(self.series):
            return np.asarray(np.einsum("pm,pmc->pc", basis, self.series[piece]))
        columns = np.empty((len(piece), self.series.shape[2]))
        order = np.argsort(piece, kind="stable")
        ends = np.searchsorted(piece[order], np.arange(len(self.series) + 1))
        for series, (first, last) in zip(self.series, pairwise(ends), strict=True):
            here = order[first:last]
            shared = np.broadcast_to(series, (len(here), *series.shape))
            columns[here] = np.einsum("pm,pmc->pc", basis[here], shared)
        return columns

    def global_places(self, piece: int, local: Array) -> Array:
        """The u of local places on a piece."""
        high, low = self.breaks[piece], self.breaks[piece + 1]
        half = (high - low) / 2.0
        places: Array = low + (local + 1.0) * half if len(self.series) > 1 else (high + low) / 2.0 + half * local
        return places

    @kept_property
    def _derivatives(self) -> tuple[PieceSeries, PieceSeries, PieceSeries]:
        first = self.derivative()
        return self, first, first.derivative()

    def jets(self, u: Array) -> Array:
        """Columns with two derivatives by u at the points u, shape (3, points, columns)."""
        piece, local, _ = self.place(u)
        basis = chebyshev.chebvander(local, self.series.shape[1] - 1)
        return np.stack([each.sums(basis[:, : each.series.shape[1]], piece) for each in self._derivatives])

    def mirrored(self) -> PieceSeries:
        """The functions of -u.

        >>> series = PieceSeries(np.array([1.0, 0.5, -1.0]), np.arange(4.0).reshape(2, 2, 1))
        >>> bool(np.allclose(series.mirrored().values(np.array([0.7, -0.7])), series.values(np.array([-0.7, 0.7]))))
        True
        """
        series = self.series[::-1].copy()
        series[:, 1::2] *= -1.0
        return PieceSeries(-self.breaks[::-1], series)

    def roots(self, functions: Iterable[Array]) -> list[Array]:
        """Places among which every root is of a function given by its series on each piece."""
        several = ((i, real_parts_of_roots(series)) for i, series in enumerate(functions) if series.any())
        return [self.global_places(i, roots[np.abs(roots) < 1.0]) for i, roots in several]

    def stationary(self, function: Array, corners: Array, *, jumps: bool) -> Array:
        """Places among which every extremum of a function is: roots of its slope, and corners.

        Parameters
        ----------
        function
            Its series on each piece, shape (pieces, coefficients).
        corners
            The ends and the breaks, where it `jumps` the places on both sides of each.
        """
        slopes = [np.asarray(chebyshev.chebder(series), dtype=np.float64) for series in function]
        steep = [
            slope if np.abs(slope).max() > _FLAT_SLOPE * np.abs(series).max() else np.zeros(1)
            for slope, series in zip(slopes, function, strict=True)
        ]
        needed = np.ones(len(corners), dtype=np.bool_)
        if not jumps:
            # where the function goes on rising or falling, a corner is no extremum
            ends = [np.asarray(chebyshev.chebval(np.array([1.0, -1.0]), slope)) for slope in slopes]
            needed[1:-1] = [
                before[1] * after[0] <= _FLAT_SLOPE * max(before[1] ** 2, after[0] ** 2)
                for before, after in pairwise(ends)
            ]
        return np.concatenate([corners[needed], *self.roots(steep)])

    def slopes_over_root(self, function: Array) -> list[Array]:
        """Series of 2 (1-u) g' + g on each piece, whose roots are those of the slope of g / sqrt(1-u)."""
        slopes = []
        for series, high, low in zip(function, self.breaks, self.breaks[1:], strict=False):
            middle, half = (high + low) / 2.0, (high - low) / 2.0
            way = np.array([2.0 * (1.0 - middle) / half, -2.0])
            slope = product(way, np.asarray(chebyshev.chebder(series), dtype=np.float64))
            slopes.append(np.asarray(chebyshev.chebadd(series, slope)))
        return slopes
