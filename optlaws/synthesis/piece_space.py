"""Free piecewise-polynomial laws: an acceleration in B-splines, the end conditions as equations."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import NDArray

from optlaws.laws.piecewise import PiecewiseLaw
from optlaws.laws.segments import PolynomialSegment
from optlaws.synthesis.boundary import BoundaryConditions
from optlaws.synthesis.piece_rows import PieceFamily, PieceProductFamily, PieceSeries
from optlaws.synthesis.polynomials import chebyshev_series
from optlaws.synthesis.rows import Family, NormFamily
from optlaws.synthesis.space import Equation, LawSpace, Quadrature

Array = NDArray[np.float64]


class PieceSpace(LawSpace):
    """Laws that are polynomials of a degree between breaks, with derivatives continuous up to an order.

    Coordinates are the coefficients of the acceleration in B-splines, which makes them local and well conditioned.
    Where `symmetric` they describe the first half only.

    Examples
    --------
    >>> space = piece_space(BoundaryConditions.rest(2), (0.0, 0.5, 1.0), 2, 1, symmetric=False)
    >>> space.terms
    2
    """

    def __init__(
        self, boundary: BoundaryConditions, breaks: tuple[float, ...], degree: int, continuity: int, *, symmetric: bool
    ) -> None:
        super().__init__()
        self.boundary, self.symmetric, self.continuity = boundary, symmetric, continuity
        self.domain = (0.0, 1.0) if symmetric else (-1.0, 1.0)
        kept = np.array([k for k in breaks if not symmetric or k <= 0.5])
        self.k = kept
        self._order = degree - 2
        self._acceleration = self._splines(kept, self._order, self._order - (continuity - 2))
        self.terms = self._acceleration.shape[2] - 1
        self._pieces: dict[int, PieceSeries] = {2: PieceSeries(1.0 - 2.0 * kept, self._acceleration)}
        self.start_velocity = float(boundary.start[1]) if boundary.order > 1 else 0.0
        end_velocity = float(boundary.end[1]) if boundary.order > 1 else 0.0
        self.velocity_change = end_velocity - self.start_velocity
        self.stroke = float(boundary.end[0]) - float(boundary.start[0])

    @staticmethod
    def _splines(breaks: Array, order: int, multiplicity: int) -> Array:
        """Chebyshev series of every B-spline on every piece, and a zero column for the base law."""
        from scipy.interpolate import BSpline

        inner = np.repeat(breaks[1:-1], multiplicity)
        knots = np.concatenate([np.repeat(breaks[0], order + 1), inner, np.repeat(breaks[-1], order + 1)])
        count = len(knots) - order - 1
        angle = (np.arange(order + 1) + 0.5) * np.pi / (order + 1)
        series = np.zeros((len(breaks) - 1, order + 1, count + 1))
        splines = BSpline(knots, np.eye(count), order)
        for i, (low, high) in enumerate(pairwise(breaks.tolist())):
            # the local variable falls with k
            values = splines(low + (high - low) * (1.0 - np.cos(angle)) / 2.0)
            series[i, :, :-1] = chebyshev_series(values, angle)
        return series

    def pieces(self, nu: int) -> PieceSeries:
        """Piecewise series of the derivative of order nu, the base law's column last."""
        if nu not in self._pieces:
            if nu > 2:
                lower = self.pieces(nu - 1).derivative()
                self._pieces[nu] = PieceSeries(lower.breaks, -2.0 * lower.series)
            else:
                start = self.start_velocity if nu == 1 else float(self.boundary.start[0])
                self._pieces[nu] = self._integrated(self.pieces(nu + 1), start)
        return self._pieces[nu]

    def _integrated(self, pieces: PieceSeries, start: float) -> PieceSeries:
        found = []
        value = np.zeros(pieces.series.shape[2])
        value[-1] = start
        for i, series in enumerate(pieces.series):
            length = (pieces.breaks[i] - pieces.breaks[i + 1]) / 2.0
            # against the local variable, which falls with k and is 1 at the piece's start
            whole = -np.asarray(chebyshev.chebint(series, axis=0)) * length / 2.0
            whole[0] += value - whole.sum(axis=0)
            found.append(whole)
            value = np.asarray(chebyshev.chebval(-1.0, whole))
        return PieceSeries(pieces.breaks, np.stack(found))

    def _wide(self, pieces: PieceSeries, size: int) -> PieceSeries:
        wide = np.zeros((*pieces.series.shape[:2], size + 1))
        wide[:, :, : self.terms] = pieces.series[:, :, :-1]
        wide[:, :, -1] = pieces.series[:, :, -1]
        return PieceSeries(pieces.breaks, wide)

    def derivative(
        self, nu: int, name: str, slack: Array, bound: float = 0.0, signs: tuple[float, ...] = (1.0, -1.0)
    ) -> PieceFamily:
        """Rows s a^(nu) <= slack . x + bound."""
        pieces = self._wide(self.pieces(nu), len(slack))
        jumps = nu > self.continuity
        return PieceFamily(name, slack, bound, signs, self.domain, series=np.zeros((1, 1)), pieces=pieces, jumps=jumps)

    def power(self, name: str, slack: Array, bound: float = 0.0) -> PieceProductFamily:
        """Rows |b c| <= slack . x + bound."""
        first, second = (self.derivative(nu, name, slack) for nu in (1, 2))
        return PieceProductFamily(name, slack, bound, (1.0, -1.0), self.domain, first=first, second=second)

    def norm(self, nu: int, name: str, slack: Array, bound: float = 0.0) -> NormFamily:
        """The row RMS of a^(nu) <= slack . x + bound."""
        rule = self.quadrature(nu)
        matrix = np.sqrt(rule.weights)[:, None] * rule.values
        return NormFamily(name, slack, bound, matrix=self.widened(matrix, len(slack)))

    def row(self, nu: int, k: float) -> Array:
        """The derivative of order nu at k: free functions, then the base law."""
        return np.asarray(self.pieces(nu).values(np.array([1.0 - 2.0 * k]))[0])

    def below(self, slack: Array) -> Family:
        """Rows b <= b(1/2)."""
        family = self.derivative(1, "b", slack, signs=(1.0,))
        middle = np.zeros(len(slack) + 1)
        middle[: self.terms] = self.row(1, 0.5)[:-1]
        middle[-1] = self.row(1, 0.5)[-1]
        series = family.pieces.series.copy()
        series[:, 0] -= middle
        return PieceFamily(
            "b",
            slack,
            signs=(1.0,),
            domain=self.domain,
            series=family.series,
            pieces=PieceSeries(family.pieces.breaks, series),
        )

    def forward(self, slack: Array) -> Family:
        """Rows b >= 0."""
        return self.derivative(1, "forward", slack, signs=(-1.0,))

    def equations(self) -> list[Equation]:
        """The end conditions that the base law and the splines do not keep by themselves."""
        order = self.boundary.order
        found = [(nu, 0.0, float(self.boundary.start[nu])) for nu in range(2, order)]
        if self.symmetric:
            found += [(0, 0.5, 0.5 * (float(self.boundary.start[0]) + float(self.boundary.end[0])))]
            found += [(nu, 0.5, 0.0) for nu in range(2, min(self.continuity, self._order + 2) + 1, 2)]
        else:
            found += [(nu, 1.0, float(self.boundary.end[nu])) for nu in range(order)]
        symbols = ("a", "b", "c", "j")
        rows = []
        for nu, k, value in found:
            row = self.row(nu, k)
            symbol = symbols[nu] if nu < len(symbols) else f"a^({nu})"
            rows.append(Equation(f"{symbol}({k:g}) = {value:g}", row[:-1], value - float(row[-1])))
        return rows

    def law(self, coordinates: Array) -> PiecewiseLaw:
        """The law with the given coordinates."""
        point = np.append(coordinates, 1.0)
        c, b = self.pieces(2).series @ point, self.pieces(1).series @ point
        c[:, 1::2] *= -1.0
        starts = b.sum(axis=1)
        segments = [PolynomialSegment(tuple(one.tolist()), float(v)) for one, v in zip(c, starts, strict=True)]
        breaks = self.k.tolist()
        if self.symmetric:
            ends = np.array([chebyshev.chebval(-1.0, one) for one in b])
            mirror = -c[::-1]
            mirror[:, 1::2] *= -1.0
            segments += [
                PolynomialSegment(tuple(one.tolist()), float(v)) for one, v in zip(mirror, ends[::-1], strict=True)
            ]
            breaks += [1.0 - k for k in breaks[-2::-1]]
        return PiecewiseLaw(breaks, segments, float(self.boundary.start[0]))

    def z_series(self, coordinates: Array) -> Array:  # noqa: ARG002
        """Empty: the law is not written with a Z."""
        return np.empty(0)

    def quadrature(self, nu: int) -> Quadrature:
        """Gauss points on every piece; moments are Legendre polynomials on one piece each."""
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


@lru_cache(maxsize=64)
def piece_space(
    boundary: BoundaryConditions, breaks: tuple[float, ...], degree: int, continuity: int, *, symmetric: bool
) -> PieceSpace:
    """The space, kept for the next call."""
    return PieceSpace(boundary, breaks, degree, continuity, symmetric=symmetric)
