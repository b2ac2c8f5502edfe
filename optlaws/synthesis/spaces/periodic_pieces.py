"""Periodic laws: polynomials between breaks whose derivatives at 1 equal those at 0, straight where required."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from optlaws.errors import InputError
from optlaws.numbers import MOST_PIECES, Array, numbers, whole
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.spaces.bases import Pieces
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.spaces.free_pieces import PieceSpace
from optlaws.synthesis.spaces.space import Equation


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
