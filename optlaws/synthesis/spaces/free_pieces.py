"""Free piecewise-polynomial laws: an acceleration in B-splines, the end conditions as equations.

Of periodic ones derivatives at 1 equal those at 0, and they are straight where required.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from optlaws.errors import InputError
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import MOST_PIECES, Array, numbers, whole
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.families.piece_series import PieceSeries
from optlaws.synthesis.spaces.bases import Pieces
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.spaces.space import Equation, LawSpace, above_rest


class PieceSpace(LawSpace):
    """Laws that are polynomials of a degree between breaks, with derivatives continuous up to an order.

    Coordinates are the coefficients of the acceleration in B-splines, which makes them local and well conditioned.
    Where `symmetric` they describe the first half only.

    >>> space = PieceSpace(BoundaryConditions.rest(2), Pieces(2, 2, 1), symmetric=False)
    >>> space.terms
    2
    """

    keeps_ends = False

    def __init__(self, boundary: BoundaryConditions, basis: Pieces, *, symmetric: bool) -> None:
        super().__init__(boundary, basis.breaks, basis.continuity, symmetric=symmetric)
        self.k = np.array([k for k in basis.breaks if not symmetric or k <= 0.5])
        self._degree = basis.degree - 2
        acceleration = self._splines(self.k, self._degree, self._degree - (basis.continuity - 2))
        if self.order == 1:
            # one more coordinate: the velocity at the start, beyond that of a = a(0) + stroke k
            acceleration = np.insert(acceleration, -1, 0.0, axis=2)
        self.terms = acceleration.shape[2] - 1
        self._pieces[2] = PieceSeries(1.0 - 2.0 * self.k, acceleration)

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

    def _table(self, nu: int) -> PieceSeries:
        if nu > 2:
            return super()._table(nu)
        value = np.zeros(self.terms + 1)
        value[-1] = self.start_velocity if nu == 1 else float(self.boundary.start[0])
        if nu == self.order == 1:
            value[-2] = 1.0
        return self._integrated(self.pieces(nu + 1), value)

    def vanishing(self, nu: int) -> int:
        """Accelerations of a degree below nu - 2, and the velocity at the start where it is free."""
        return max(nu - 2, 0) + (self.order == 1 < nu)

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
        whole = len(self.k) == 2 and not self.symmetric
        if self.order == 1 or whole or not self.at_rest:
            return super().forward(slack)
        table = above_rest(self.pieces(1), self.pieces(self.order), self.order).widened(len(slack))
        return LinearFamily(RowName.RATIO, slack, domain=self.domain, table=table)

    def equations(self) -> list[Equation]:
        """The end conditions that the base law and the splines do not keep by themselves."""
        order = self.order
        conditions = [(nu, 0.0, float(self.boundary.start[nu])) for nu in range(2, order)]
        if self.symmetric:
            conditions += [(0, 0.5, 0.5 * (float(self.boundary.start[0]) + float(self.boundary.end[0])))]
            conditions += [(nu, 0.5, 0.0) for nu in range(2, min(self.continuity, self._degree + 2) + 1, 2)]
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


@dataclass(frozen=True, init=False)
class PeriodicPieces(Pieces):
    """A free law over a whole cycle that repeats: velocity, acceleration and so on end as they begin.

    Laws in it have one condition at each end, order 1: the displacements a(0) and a(1). Rest is not required.

    Parameters
    ----------
    breaks, degree, continuity
        As of `Pieces`; what is continuous at the breaks is continuous from the end to the start too.
    straight
        Numbers of the pieces, from 0 on, on which the acceleration is 0: dwells and uniform motions.

    Raises
    ------
    InputError
        If the breaks do not increase from 0 to 1, the orders do not fit, there is no such piece, or all are straight.

    Examples
    --------
    >>> from optlaws import Problem, synthesize, via
    >>> ends = BoundaryConditions((0.0,), (0.0,))
    >>> there_and_back = Problem(
    ...     basis=PeriodicPieces(8, 3, 2), boundary=ends, symmetric=False, minimise="J", windows=[via("a", 1.0, at=0.5)]
    ... )
    >>> solution = synthesize(there_and_back)
    >>> solution.status.value, round(solution.objective, 6), round(solution.law.b(0.0) - solution.law.b(1.0), 9) + 0.0
    ('optimal', 96.0, 0.0)
    """

    straight: tuple[int, ...] = ()
    name = "periodic"

    def __init__(
        self, breaks: int | Sequence[float], degree: int = 5, continuity: int = 3, straight: Sequence[int] = ()
    ) -> None:
        super().__init__(breaks, degree, continuity)
        last = len(self.breaks) - 2
        # files may hold whole numbers as floats
        given = (
            int(number) if number.is_integer() else number for number in numbers(straight, "straight", MOST_PIECES)
        )
        pieces = {whole(number, "straight: the number of a piece", least=0, most=last) for number in given}
        if len(pieces) > last:
            raise InputError("straight: a law whose every piece is straight leaves no freedom: leave one out")
        object.__setattr__(self, "straight", tuple(sorted(pieces)))

    @property
    def mirrored(self) -> bool:
        """Never: what repeats may begin anywhere."""
        return False

    def check(self, *, symmetric: bool) -> None:
        """Refuse symmetric laws, which are not periodic."""
        if symmetric:
            raise InputError("a law that repeats is not symmetric about 1/2: give symmetric=False")

    def to_dict(self) -> dict[str, Any]:
        """Plain data as of `Pieces`, with the straight pieces."""
        return super().to_dict() | ({"straight": list(self.straight)} if self.straight else {})


class PeriodicSpace(PieceSpace):
    """Such laws as a linear space: the coefficients of the acceleration in periodic B-splines, and the first velocity.

    Examples
    --------
    >>> PeriodicSpace(BoundaryConditions((0.0,), (0.0,)), PeriodicPieces(4, 5, 3), symmetric=False).terms
    9
    """

    def __init__(self, boundary: BoundaryConditions, basis: PeriodicPieces, *, symmetric: bool) -> None:
        if boundary.order != 1:
            raise InputError(f"laws that repeat have one condition at each end, their order is 1, not {boundary.order}")
        self._straight = basis.straight
        super().__init__(boundary, basis, symmetric=symmetric)

    def _splines(self, breaks: Array, order: int, multiplicity: int) -> Array:
        """Chebyshev series of every periodic B-spline that is 0 on straight pieces, on every piece; then a zero."""
        from scipy.interpolate import BSpline

        count = (len(breaks) - 1) * multiplicity
        around = -(-(order + 1) // count) + 1
        knots = np.concatenate([np.repeat(breaks[:-1] + turn, multiplicity) for turn in range(-around, around + 2)])
        splines = BSpline(knots, np.eye(len(knots) - order - 1), order, extrapolate=False)
        series = np.zeros((len(breaks) - 1, order + 1, count + 1))
        for i, (low, high) in enumerate(pairwise(breaks.tolist())):
            # the local variable falls with k
            values = np.nan_to_num(splines(low + (high - low) * (1.0 - nodes(order + 1)) / 2.0))
            # every spline and its copies a turn before and after
            turns = np.pad(values, ((0, 0), (0, -values.shape[1] % count))).reshape(len(values), -1, count)
            series[i, :, :-1] = from_values(turns.sum(axis=1))
        bent = [j for j in range(count) if not series[list(self._straight), :, j].any()]
        return np.ascontiguousarray(series[:, :, [*bent, count]])

    def vanishing(self, nu: int) -> int:
        """A constant acceleration, where no piece is straight, and the velocity at the start."""
        return (nu > 2 and not self._straight) + (nu > 1)

    def equations(self) -> list[Equation]:
        """The displacement at the end, and that the velocity ends as it began."""
        row = self.row(1, 1.0) - self.row(1, 0.0)
        return [*super().equations(), Equation("b(1) = b(0)", row[:-1], -float(row[-1]))]
