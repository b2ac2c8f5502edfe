"""Functions of a law divided by what they vanish like, without which rows of them would be ill posed."""

from __future__ import annotations

from collections.abc import Callable
from math import factorial

import numpy as np
from numpy.polynomial import chebyshev, legendre

from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.families.piece_series import PieceSeries


def chord(jerk: Callable[[Array], Array], u: Array, centre: float, degree: int) -> Array:
    """(b - b0) / (u - u0)² at points u where b has the value b0 and no slope at u0; by an integral, so nothing cancels.

    Parameters
    ----------
    jerk
        Columns of j at points u = 1 - 2k, shape (points, columns); polynomials of a degree.
    u, centre
        The points and u0.
    degree
        The degree of b.

    Examples
    --------
    >>> chord(lambda u: np.full((len(u), 1), 8.0), np.array([0.25]), 0.5, 2)  # b = 1 + (u - 0.5)²
    array([[1.]])
    """
    # by Taylor the mean of b'' with the weight 1 - s, and b'' by u is j/4
    return _mean(jerk, u, centre, degree, lambda share: 1.0 - share) / 4.0


def kink(acceleration: Callable[[Array], Array], u: Array, centre: float, degree: int) -> Array:
    """(b - b0) / |u - u0| on one side of u0 where b has a kink; otherwise as `chord`.

    >>> kink(lambda u: np.full((len(u), 1), -4.0), np.array([0.75]), 0.5, 1)  # b = 1 + 2 (u - 0.5)
    array([[2.]])
    """
    side = np.sign(u - centre)[:, None]
    return -side * _mean(acceleration, u, centre, degree, np.ones_like) / 2.0


def _mean(
    values: Callable[[Array], Array], u: Array, centre: float, degree: int, weight: Callable[[Array], Array]
) -> Array:
    x, weights = legendre.leggauss(degree // 2 + 2)
    share = (1.0 + x) / 2.0
    places = centre + np.outer(u - centre, share)
    columns = values(places.reshape(-1)).reshape(len(u), len(share), -1)
    return np.asarray(np.einsum("psc,s->pc", columns, weights * weight(share) / 2.0))


def below_peak(acceleration: PieceSeries, jerk: PieceSeries, centre: float, *, smooth: bool) -> PieceSeries:
    """Piecewise series of (b - b0) / w with w > 0, b0 the velocity at the centre: at most 0 if and only if b <= b0.

    On a piece that reaches the centre w = (u - u0)², or |u - u0| where c may jump at the centre, which leaves a
    polynomial; on the others it is this at the end nearer to the centre. All is integrated from the centre outward, so
    nothing cancels.

    Parameters
    ----------
    acceleration, jerk
        The series of c and j by u = 1 - 2k.
    centre
        Where the peak is, in u.
    smooth
        Whether c is continuous and zero there; what the series has there is left out.
    """
    breaks = acceleration.breaks
    count = acceleration.series.shape[1] + 1
    divided = np.zeros((len(breaks) - 1, count, acceleration.series.shape[2]))
    power = 2 if smooth else 1
    touching = [i for i in range(len(divided)) if breaks[i + 1] <= centre <= breaks[i]]
    for i in touching:
        low, high = breaks[i + 1], breaks[i]
        u = low + (high - low) * (1.0 + nodes(count)) / 2.0
        of = chord if smooth else kink
        divided[i] = from_values(of(_extended(jerk if smooth else acceleration, i), u, centre, count - 1))
        if smooth:
            # it has two degrees less: the rest is rounding
            divided[i, max(count - 2, 1) :] = 0.0
    for i in (*range(touching[0] - 1, -1, -1), *range(touching[-1] + 1, len(divided))):
        inner, end = (i + 1, -1.0) if breaks[i + 1] >= centre else (i - 1, 1.0)
        near, behind = (breaks[i + 1], inner) if end < 0.0 else (breaks[i], inner)
        scale = abs(near - centre) ** power
        # the neighbour's value at the break, in its own units
        height = np.asarray(chebyshev.chebval(-end, divided[behind])) * _unit(breaks, behind, centre, power, near)
        rise = -np.asarray(chebyshev.chebint(acceleration.series[i], axis=0)) * (breaks[i] - breaks[i + 1]) / 4.0
        rise[0] += height - np.asarray(chebyshev.chebval(end, rise))
        divided[i] = rise / scale
    return PieceSeries(breaks, divided)


def _unit(breaks: Array, piece: int, centre: float, power: int, at: float) -> float:
    """The divisor of b - b0 on a piece at one of its ends."""
    low, high = breaks[piece + 1], breaks[piece]
    if low <= centre <= high:
        return float(abs(at - centre) ** power)
    return float(min(abs(low - centre), abs(high - centre)) ** power)


def _extended(pieces: PieceSeries, piece: int) -> Callable[[Array], Array]:
    """The columns of one piece as functions of u, at its ends too."""
    low, high = pieces.breaks[piece + 1], pieces.breaks[piece]

    def columns(u: Array) -> Array:
        return np.asarray(chebyshev.chebval(2.0 * (u - low) / (high - low) - 1.0, pieces.series[piece]).T)

    return columns


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
