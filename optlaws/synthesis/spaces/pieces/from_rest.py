"""B <= sqrt(2 D k) for piecewise laws: their velocity divided by sqrt(2k), or by sqrt(2 - 2k) from the other end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from optlaws.numbers import Array
from optlaws.numerics.chebyshev import product, real_parts_of_roots
from optlaws.synthesis.families.family import MirroredFamily, RootFamily
from optlaws.synthesis.spaces.pieces.rows import PieceFamily, PieceSeries


@dataclass(frozen=True, eq=False, kw_only=True)
class PieceRootFamily(RootFamily, PieceFamily):
    """A root family of piecewise polynomials."""

    def stationary(self, x: Array) -> Array:
        """Roots of 2 (1-u) g' + g on every piece, and the breaks."""
        places = [self.corners]
        breaks = self.pieces.breaks
        for i, series in enumerate(self.pieces.series @ np.append(x, 1.0)):
            middle, half = (breaks[i] + breaks[i + 1]) / 2.0, (breaks[i] - breaks[i + 1]) / 2.0
            way = np.array([2.0 * (1.0 - middle) / half, -2.0])
            slope = product(way, np.asarray(chebyshev.chebder(series), dtype=np.float64))
            total = np.zeros(max(len(series), len(slope)))
            total[: len(series)] = series
            total[: len(slope)] += slope
            if total.any():
                roots = real_parts_of_roots(total)
                places.append(self.pieces.global_places(i, roots[np.abs(roots) < 1.0]))
        return np.concatenate(places)


@dataclass(frozen=True, eq=False, kw_only=True)
class PieceMirroredFamily(MirroredFamily, PieceRootFamily):
    """The same written from the end of the interval: u = 2k - 1."""


def mirrored(pieces: PieceSeries) -> PieceSeries:
    """The same functions of -u.

    Examples
    --------
    >>> series = PieceSeries(np.array([1.0, 0.5, -1.0]), np.arange(4.0).reshape(2, 2, 1))
    >>> bool(np.allclose(mirrored(series).values(np.array([0.7, -0.7])), series.values(np.array([-0.7, 0.7]))))
    True
    """
    series = pieces.series[::-1].copy()
    series[:, 1::2] *= -1.0
    return PieceSeries(-pieces.breaks[::-1], series)
