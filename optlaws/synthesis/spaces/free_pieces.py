"""Free piecewise-polynomial laws: an acceleration in B-splines, the end conditions as equations."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.families.piece_series import PieceSeries
from optlaws.synthesis.spaces.divided_rows import above_rest
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.spaces.space import Equation, LawSpace


class PieceSpace(LawSpace):
    """Laws that are polynomials of a degree between breaks, with derivatives continuous up to an order.

    Coordinates are the coefficients of the acceleration in B-splines, which makes them local and well conditioned.
    Where `symmetric` they describe the first half only.

    >>> space = piece_space(BoundaryConditions.rest(2), (0.0, 0.5, 1.0), 2, 1, symmetric=False)
    >>> space.terms
    2
    """

    def __init__(
        self, boundary: BoundaryConditions, breaks: tuple[float, ...], degree: int, continuity: int, *, symmetric: bool
    ) -> None:
        super().__init__(breaks, continuity, symmetric=symmetric)
        self.boundary = boundary
        places = np.array([k for k in breaks if not symmetric or k <= 0.5])
        self.k = places
        self._order = degree - 2
        self._acceleration = self._splines(places, self._order, self._order - (continuity - 2))
        self._free_start = boundary.order == 1
        if self._free_start:
            # one more coordinate: the velocity at the start, beyond that of a = a(0) + stroke k
            self._acceleration = np.insert(self._acceleration, -1, 0.0, axis=2)
        self.terms = self._acceleration.shape[2] - 1
        self._pieces[2] = PieceSeries(1.0 - 2.0 * places, self._acceleration)
        self.stroke = float(boundary.end[0]) - float(boundary.start[0])
        self.start_velocity = self.stroke if self._free_start else float(boundary.start[1])
        end_velocity = self.stroke if self._free_start else float(boundary.end[1])
        self.velocity_change = end_velocity - self.start_velocity

    def _splines(self, breaks: Array, order: int, multiplicity: int) -> Array:
        """Chebyshev series of every B-spline on every piece, and a zero column for the base law."""
        from scipy.interpolate import BSpline

        inner = np.repeat(breaks[1:-1], multiplicity)
        knots = np.concatenate([np.repeat(breaks[0], order + 1), inner, np.repeat(breaks[-1], order + 1)])
        count = len(knots) - order - 1
        series = np.zeros((len(breaks) - 1, order + 1, count + 1))
        splines = BSpline(knots, np.eye(count), order)
        for i, (low, high) in enumerate(pairwise(breaks.tolist())):
            # the local variable falls with k
            values = splines(low + (high - low) * (1.0 - nodes(order + 1)) / 2.0)
            series[i, :, :-1] = from_values(values)
        return series

    def pieces(self, nu: int) -> PieceSeries:
        if nu not in self._pieces:
            if nu > 2:
                lower = self.pieces(nu - 1).derivative()
                self._pieces[nu] = PieceSeries(lower.breaks, -2.0 * lower.series)
            else:
                value = np.zeros(self.terms + 1)
                value[-1] = self.start_velocity if nu == 1 else float(self.boundary.start[0])
                if nu == 1 and self._free_start:
                    value[-2] = 1.0
                self._pieces[nu] = self._integrated(self.pieces(nu + 1), value)
        return self._pieces[nu]

    def vanishing(self, nu: int) -> int:
        """Accelerations of a degree below nu - 2, and the velocity at the start where it is free."""
        return max(nu - 2, 0) + (self._free_start and nu > 1)

    @staticmethod
    def _integrated(pieces: PieceSeries, value: Array) -> PieceSeries:
        integrals = []
        for i, series in enumerate(pieces.series):
            length = (pieces.breaks[i] - pieces.breaks[i + 1]) / 2.0
            # against the local variable, which falls with k and is 1 at the piece's start
            whole = -np.asarray(chebyshev.chebint(series, axis=0)) * length / 2.0
            whole[0] += value - whole.sum(axis=0)
            integrals.append(whole)
            value = np.asarray(chebyshev.chebval(-1.0, whole))
        return PieceSeries(pieces.breaks, np.stack(integrals))

    def forward(self, slack: Array) -> ConstraintFamily:
        order = self.boundary.order
        whole = len(self.k) == 2 and not self.symmetric
        if order == 1 or whole or self.boundary != BoundaryConditions.rest(order):
            return super().forward(slack)
        table = above_rest(self.pieces(1), self.pieces(order), order).widened(len(slack))
        return LinearFamily(RowName.RATIO, slack, domain=self.domain, table=table)

    def equations(self) -> list[Equation]:
        """The end conditions that the base law and the splines do not keep by themselves."""
        order = self.boundary.order
        conditions = [(nu, 0.0, float(self.boundary.start[nu])) for nu in range(2, order)]
        if self.symmetric:
            conditions += [(0, 0.5, 0.5 * (float(self.boundary.start[0]) + float(self.boundary.end[0])))]
            conditions += [(nu, 0.5, 0.0) for nu in range(2, min(self.continuity, self._order + 2) + 1, 2)]
        else:
            conditions += [(nu, 1.0, float(self.boundary.end[nu])) for nu in range(order)]
        symbols = ("a", "b", "c", "j")
        rows = []
        for nu, k, value in conditions:
            row = self.row(nu, k)
            symbol = symbols[nu] if nu < len(symbols) else f"a^({nu})"
            rows.append(Equation(f"{symbol}({k:g}) = {value:g}", row[:-1], value - float(row[-1])))
        return rows

    def law(self, coordinates: Array) -> PiecewiseLaw:
        point = np.append(coordinates, 1.0)
        c, b = self.pieces(2).series @ point, self.pieces(1).series @ point
        c[:, 1::2] *= -1.0
        starts = b.sum(axis=1)
        segments = [PolynomialSegment(tuple(series.tolist()), float(v)) for series, v in zip(c, starts, strict=True)]
        breaks = self.k.tolist()
        if self.symmetric:
            ends = np.array([chebyshev.chebval(-1.0, velocity) for velocity in b])
            mirror = -c[::-1]
            mirror[:, 1::2] *= -1.0
            segments += [
                PolynomialSegment(tuple(series.tolist()), float(v))
                for series, v in zip(mirror, ends[::-1], strict=True)
            ]
            breaks += [1.0 - k for k in breaks[-2::-1]]
        return PiecewiseLaw(breaks, segments, float(self.boundary.start[0]))

    def z_series(self, coordinates: Array) -> Array:  # noqa: ARG002 - what others of its kind need
        """Empty: the law is not written with a Z."""
        return np.empty(0)


@lru_cache(maxsize=16)
def piece_space(
    boundary: BoundaryConditions, breaks: tuple[float, ...], degree: int, continuity: int, *, symmetric: bool
) -> PieceSpace:
    """The law space, cached for the next call."""
    return PieceSpace(boundary, breaks, degree, continuity, symmetric=symmetric)
