"""Families whose functions are polynomials between breaks: splines and free piecewise laws."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Self

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import nodes, product, real_parts_of_roots
from optlaws.synthesis.families.family import LinearFamily, ProductFamily
from optlaws.tolerances import BESIDE_BREAK

_FLAT_SLOPE = 1e-9  # of a series: a slope that is less is flat

_MOST, _LEAST = 600, 8  # nodes of a family, and of a piece: its extrema join them
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
        return piece, np.clip((u - low) * slope - 1.0, -1.0, 1.0), slope

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
        places: Array = low + (local + 1.0) * (high - low) / 2.0
        return places


@dataclass(frozen=True, eq=False, kw_only=True)
class PieceFamily(LinearFamily):
    """A linear family of piecewise polynomials; contacts at breaks are kinks and stay where they are."""

    plain = False

    pieces: PieceSeries
    jumps: bool = False

    def in_units(self, units: Array, unit: float) -> Self:
        pieces = PieceSeries(self.pieces.breaks, self.pieces.series * np.append(units, 1.0) / unit)
        return replace(self, pieces=pieces, slack=self.slack * units / unit, bound=self.bound / unit)

    @property
    def continuable(self) -> bool:
        """False: contacts at kinks are neither fixed at an end nor free."""
        return False

    @kept_property
    def corners(self) -> Array:
        """The breaks; where f jumps there, the places just before and just after each."""
        breaks = self.pieces.breaks
        if not self.jumps:
            return breaks
        return np.concatenate([breaks[[0, -1]], breaks[1:-1] + BESIDE_BREAK, breaks[1:-1] - BESIDE_BREAK])

    def nodes(self) -> Array:
        """Corners, and inside each piece as many points as its degree, or fewer where they were too many."""
        count = self.pieces.series.shape[1]
        count = min(count, max(_LEAST, _MOST // len(self.pieces.breaks)))
        local = nodes(count) if count > 2 else np.empty(0)
        inner = [self.pieces.global_places(i, local) for i in range(len(self.pieces.breaks) - 1)]
        places = np.concatenate([self.corners, *inner])
        return places[(places >= self.domain[0]) & (places <= self.domain[1])]

    @kept_property
    def _derivatives(self) -> tuple[PieceSeries, PieceSeries, PieceSeries]:
        first = self.pieces.derivative()
        return self.pieces, first, first.derivative()

    def columns(self, u: Array) -> Array:
        piece, local, _ = self.pieces.place(u)
        basis = chebyshev.chebvander(local, self.pieces.series.shape[1] - 1)
        return np.stack([series.sums(basis[:, : series.series.shape[1]], piece) for series in self._derivatives])

    def value(self, x: Array, u: Array) -> Array:
        value: Array = self.pieces.values(u) @ np.append(x, 1.0)
        return value

    def stationary(self, x: Array) -> Array:
        """Roots of the derivative on every piece, and the breaks."""
        key = x.tobytes()
        places = self._last.get(key)
        if places is None:
            places = _stationary(self, [self.pieces.series @ np.append(x, 1.0)])
            self._last.clear()
            self._last[key] = places
        return places

    @kept_property
    def _last(self) -> dict[bytes, Array]:
        """Stationary places of the last variables, cached for repeated calls in a round."""
        return {}

    def pinned(self, u: Array) -> NDArray[np.bool_]:
        """Whether u is a corner."""
        return np.isin(u, self.corners)


@dataclass(frozen=True, eq=False, kw_only=True)
class PieceProductFamily(ProductFamily):
    """A product of two piecewise linear families."""

    first: PieceFamily
    second: PieceFamily

    def stationary(self, x: Array) -> Array:
        """Roots of the product's derivative on every piece, and the breaks."""
        point = np.append(x, 1.0)
        return _stationary(self.second, [self.first.pieces.series @ point, self.second.pieces.series @ point])

    def nodes(self) -> Array:
        """The nodes of the acceleration."""
        return self.second.nodes()

    def pinned(self, u: Array) -> NDArray[np.bool_]:
        """Whether u is a break."""
        return self.second.pinned(u)


def _stationary(family: PieceFamily, factors: list[Array]) -> Array:
    """Roots of the derivative on every piece, the ends, and the corners that may be extrema."""
    pieces = family.pieces
    places, slopes = [], []
    for i in range(len(pieces.breaks) - 1):
        series = factors[0][i]
        if len(factors) > 1:
            series = product(factors[0][i], factors[1][i])
        slope = np.asarray(chebyshev.chebder(series), dtype=np.float64)
        slopes.append(np.asarray(chebyshev.chebval(np.array([1.0, -1.0]), slope)))
        if np.abs(slope).max() > _FLAT_SLOPE * np.abs(series).max():
            roots = real_parts_of_roots(slope)
            places.append(pieces.global_places(i, roots[np.abs(roots) < 1.0]))
    needed = np.ones(len(family.corners), dtype=np.bool_)
    if not family.jumps:
        # where the function goes on rising or falling, a corner is no extremum
        needed[1:-1] = [
            before[1] * after[0] <= _FLAT_SLOPE * max(before[1] ** 2, after[0] ** 2)
            for before, after in pairwise(slopes)
        ]
    return np.concatenate([family.corners[needed], *places])
