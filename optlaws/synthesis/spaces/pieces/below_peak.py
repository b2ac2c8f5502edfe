"""B <= b at the peak for piecewise laws, in rows that do not vanish at the peak."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.spaces.pieces.rows import PieceSeries
from optlaws.synthesis.spaces.polynomials.below_peak import chord, kink


def below_peak(acceleration: PieceSeries, jerk: PieceSeries, centre: float, *, smooth: bool) -> PieceSeries:
    """Piecewise series of (b - b0) / w with w > 0, b0 the velocity at the centre: at most 0 if and only if b <= b0.

    On a piece that reaches the centre w = (u - u0)², or |u - u0| where c may jump, which leaves a polynomial; on the
    others it is this at the end nearer to the centre. All is integrated from the centre outward, so nothing cancels.

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
    """What b - b0 was divided by on a piece at one of its ends."""
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
