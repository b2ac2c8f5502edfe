"""B >= 0 for piecewise laws from rest to rest, in rows that do not vanish at the ends."""

from __future__ import annotations

from math import factorial

import numpy as np
from numpy.polynomial import chebyshev, legendre

from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.spaces.pieces.rows import PieceSeries


def above_rest(velocity: PieceSeries, derivative: PieceSeries, order: int) -> PieceSeries:
    """Piecewise series of -b / w with w > 0: at most 0 if and only if b >= 0.

    With k1 the end of the first piece w = (k/k1)^(l-1) there, likewise on a last piece that ends with k = 1, and 1 on
    the others: w is continuous. Lower powers of k, which rest makes vanish, are left out.

    Parameters
    ----------
    velocity, derivative
        The series of b, and of the derivative of a of order l, by u = 1 - 2k.
    order
        The number l of boundary conditions, at least 2.
    """
    series = -velocity.series
    ends = [i for i, u in ((0, 1.0), (len(series) - 1, -1.0)) if velocity.breaks[i + (u < 0.0)] == u]
    for i in ends:
        series[i] = _divided(derivative, i, series.shape[1], order - 1)
    return PieceSeries(velocity.breaks, series)


def _divided(derivative: PieceSeries, piece: int, count: int, power: int) -> Array:
    """-b / w on the first or the last piece, by Taylor's remainder, so that nothing cancels."""
    # the share of the piece's length that a place is away from the end of the interval
    side = 1.0 if piece == 0 else -1.0
    away = (1.0 - side * nodes(count)) / 2.0
    x, weights = legendre.leggauss(count // 2 + 2)
    share = (1.0 + x) / 2.0
    local = side * (1.0 - 2.0 * np.outer(away, share))
    columns = chebyshev.chebval(local.reshape(-1), derivative.series[piece])
    values = columns.T.reshape(count, len(share), -1)
    means = np.einsum("psc,s->pc", values, weights * (1.0 - share) ** (power - 1) / 2.0)
    length = (derivative.breaks[piece] - derivative.breaks[piece + 1]) / 2.0
    return np.asarray(-from_values(means) * (side * length) ** power / factorial(power - 1))
