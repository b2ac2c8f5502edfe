"""A linear or conic program on finitely many points by Clarabel.

Its answer is good to some 1e-11 in the objective and in every row, and it uses that rows of pieces are sparse.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics.cones import SparseColumns, conic_optimum, usable
from optlaws.synthesis.families.cone import ConeFamily, SumOfSquares
from optlaws.synthesis.families.curved import FormulaFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily, Points, Program
from optlaws.synthesis.method.discretised.answer import Answer
from optlaws.tolerances import EMPTY_ROW

_CONIC_SOLVER = 1e-12  # what a solver of cones is told to leave of gap and feasibility


def of_cones(family: ConstraintFamily) -> bool:
    """Whether a family at a place is a linear row or a second-order cone."""
    if isinstance(family, FormulaFamily):
        return family.quadratic
    return isinstance(family, LinearFamily | NormFamily | ConeFamily)


@dataclass(frozen=True, eq=False)
class _Block:
    """Rows A x + s = h, s in cones one after the other with as many rows each.

    The multiplier of the constraint that a cone is of is the sum of its duals times `shares`, shape (cones, rows).
    """

    rows: Array
    right: Array
    shares: Array
    linear: bool

    @property
    def cones(self) -> list[Any]:
        import clarabel

        if self.linear:
            return [clarabel.NonnegativeConeT(len(self.right))]
        return [clarabel.SecondOrderConeT(self.shares.shape[1])] * len(self.shares)

    def weights(self, duals: Array) -> Array:
        """Multipliers of the constraints, one for each cone."""
        return np.asarray(np.maximum((duals.reshape(self.shares.shape) * self.shares).sum(axis=1), 0.0))


def optimum_on_points(program: Program, points: list[Points]) -> Answer:
    """The optimum of the program with its families enforced at the points only.

    Parameters
    ----------
    program
        A program whose families are all `of_cones`.
    points
        Where its families are imposed.
    """
    import clarabel

    blocks = [_block(family, grid) for family, grid in zip(program.families, points, strict=True)]
    scale = 1.0 / _length(program.equalities)
    equations, given = program.equalities * scale[:, None], program.right * scale
    matrix = np.vstack([equations, *(block.rows for block in blocks)])
    right = np.concatenate([given, *(block.right for block in blocks)])
    cones = [clarabel.ZeroConeT(len(scale)), *(cone for block in blocks for cone in block.cones)]
    # its size is none of the optimum's
    size = float(np.linalg.norm(program.objective)) or 1.0
    cost = program.objective / size
    columns = SparseColumns.of(matrix)
    optimum = conic_optimum(None, cost, columns, right, cones, tolerance=_CONIC_SOLVER, alike=True)
    if not usable(optimum):
        return Answer.missing(program, points, str(optimum.status), optimum.iterations)
    ends = np.cumsum([len(scale), *(len(block.right) for block in blocks)])[:-1]
    pulls, *duals = np.split(size * np.asarray(optimum.z), ends)
    weights = [block.weights(dual) for block, dual in zip(blocks, duals, strict=True)]
    x, status = _on_equations(program, np.asarray(optimum.x)), str(optimum.status)
    return Answer(x, [*weights, pulls * scale], success=True, status=status, iterations=optimum.iterations)


def _block(family: ConstraintFamily, points: Points) -> _Block:
    if isinstance(family, LinearFamily):
        rows, right = family.rows(points.u, points.s)
        scale = 1.0 / _length(rows)
        return _Block(rows * scale[:, None], right * scale, scale[:, None], linear=True)
    # a square is at most t where it is in the cone of t + 1 and t - 1: both move with the right side
    room, squared = np.append(family.slack, family.bound), False
    if isinstance(family, NormFamily):
        # the norm of the columns is that of the triangle
        parts = np.asarray(np.linalg.qr(family.matrix, mode="r"))[None]
        stacked = np.concatenate([room[None, None], parts], axis=1)
    elif isinstance(family, ConeFamily):
        columns = family.columns(points.u)[0]
        parts = np.stack([columns.real, columns.imag], axis=1)
        stacked = np.concatenate([np.broadcast_to(room, (len(parts), 1, parts.shape[2])), parts], axis=1)
    elif isinstance(family, FormulaFamily):
        sums = [family.squares(u) for u in points.u.tolist()]
        squared = not any(square.root for square in sums)
        stacked = np.stack([_stacked(square, room) for square in sums])
    else:
        raise TypeError(f"{type(family).__name__} is no cone")
    # a cone stays one if all its rows are multiplied alike
    scale = 1.0 / np.sqrt(np.maximum((stacked[:, :, :-1] ** 2).sum(axis=2).max(axis=1), EMPTY_ROW**2))
    flat = (stacked * scale[:, None, None]).reshape(-1, stacked.shape[2])
    shares = np.zeros(stacked.shape[:2])
    shares[:, : 2 if squared else 1] = scale[:, None]
    return _Block(-flat[:, :-1], flat[:, -1], shares, linear=False)


def _stacked(square: SumOfSquares, room: Array) -> Array:
    """The conic rows that bound a sum of squares by its slack."""
    triangle = np.asarray(np.linalg.qr(square.rows, mode="r")) if len(square.rows) > len(room) else square.rows
    if square.root:
        return np.vstack([room, triangle])
    rest, last = room - square.affine, np.append(np.zeros(len(room) - 1), 1.0)
    return np.vstack([rest + last, rest - last, 2.0 * triangle])


def _length(rows: Array) -> Array:
    length = np.linalg.norm(rows, axis=1)
    return np.where(length < EMPTY_ROW, 1.0, length)


def _on_equations(program: Program, x: Array) -> Array:
    """The nearest variables that keep the equations exactly."""
    scale = 1.0 / _length(program.equalities)
    matrix, right = program.equalities * scale[:, None], program.right * scale
    return np.asarray(x + np.linalg.lstsq(matrix, right - matrix @ x, rcond=None)[0])
