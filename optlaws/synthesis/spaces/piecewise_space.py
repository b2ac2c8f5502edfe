"""Laws that are polynomials between breaks, as a linear space: what free pieces and Z in B-splines share."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev, legendre

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.families.piece_series import PieceSeries
from optlaws.synthesis.spaces.polynomial_space import chord, kink
from optlaws.synthesis.spaces.space import LawSpace, Quadrature


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


class PiecewiseSpace(LawSpace):
    """A space given by the piecewise series of every derivative, on the first half only where `symmetric`."""

    breaks: tuple[float, ...]  #: all breaks of the laws, of both halves
    continuity: int  #: order up to which the derivatives of every law are continuous at the breaks

    def __init__(self, breaks: tuple[float, ...], continuity: int, *, symmetric: bool) -> None:
        super().__init__()
        self.breaks, self.continuity, self.symmetric = breaks, continuity, symmetric
        self.domain = (0.0, 1.0) if symmetric else (-1.0, 1.0)
        self._pieces: dict[int, PieceSeries] = {}

    @abstractmethod
    def pieces(self, nu: int) -> PieceSeries:
        """Piecewise series of the derivative of order nu, the base law's column last."""

    def _finite(self, nu: int) -> None:
        if nu > self.continuity + 1 and len(self.breaks) > 2:
            raise InputError(
                f"with continuity {self.continuity} the derivative of order {nu} has impulses at the breaks, which are "
                f"beyond every bound: give a continuity of at least {nu - 1}"
            )

    def given(self, series: PieceSeries, size: int, *, jumps: bool = False) -> dict[str, Any]:
        """The series on every piece, over all variables."""
        return {"series": self.widened(series.series, size), "breaks": series.breaks, "jumps": jumps}

    def turned(self, series: PieceSeries) -> PieceSeries:
        """The pieces in the opposite order, each turned."""
        return series.mirrored()

    def combined(self, nu: int, weights: tuple[float, ...]) -> PieceSeries:
        self._finite(nu + len(weights) - 1)
        lowest = self.pieces(nu)
        if weights == (1.0,):
            return lowest
        series = weights[0] * lowest.series
        for i, weight in enumerate(weights[1:], 1):
            terms = self.pieces(nu + i).series
            series[:, : terms.shape[1]] += weight * terms[:, : series.shape[1]]
        return PieceSeries(lowest.breaks, series)

    def columns(self, nu: int, u: Array) -> Array:
        """The derivative of order nu at places u = 1 - 2k: free functions, then the base law."""
        self._finite(nu)
        return self.pieces(nu).values(u)

    def degree_of(self, nu: int) -> int:
        return int(self.pieces(nu).series.shape[1]) - 1

    @property
    def edges(self) -> tuple[float, ...]:
        """The breaks; for symmetric laws, the breaks of the first half."""
        return tuple(self.pieces(2).breaks.tolist())

    def jumps(self, nu: int) -> bool:
        return nu > self.continuity

    def row(self, nu: int, k: float) -> Array:
        return np.asarray(self.pieces(nu).values(np.array([1.0 - 2.0 * k]))[0])

    def below(self, slack: Array, peak: float = 0.5) -> ConstraintFamily:
        """Rows b <= b(peak), divided by their zeros there, without which they would be ill posed."""
        centre = 1.0 - 2.0 * peak
        smooth = self.continuity > 1 or centre not in self.pieces(2).breaks
        series = below_peak(self.pieces(2), self.pieces(3), centre, smooth=smooth)
        return LinearFamily(RowName.BELOW_PEAK, slack, domain=self.domain, **self.given(series, len(slack), jumps=True))

    def quadrature(self, nu: int) -> Quadrature:
        """Gauss points on every piece; moments are Legendre polynomials on one piece each."""
        self._finite(nu)
        pieces = self.pieces(nu)
        count = pieces.series.shape[1] + 1
        x, weights = legendre.leggauss(count)
        share = 2.0 if self.symmetric else 1.0
        number = len(pieces.breaks) - 1
        u = np.concatenate([pieces.global_places(i, x) for i in range(number)])
        lengths = (pieces.breaks[:-1] - pieces.breaks[1:]) / 2.0
        moments = np.asarray(np.kron(np.eye(number), legendre.legvander(x, count - 1)), dtype=np.float64)
        weighted = np.concatenate([share * length * weights / 2.0 for length in lengths])
        return Quadrature(weighted, pieces.values(u), moments)
