"""A linear or conic program on finitely many points by Clarabel.

Its answer is good to some 1e-11 in the objective and in every row, and it uses that rows of pieces are sparse.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.cone import ConeFamily, SumOfSquares
from optlaws.synthesis.families.curved import FormulaFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily, Points, Program
from optlaws.synthesis.method.discretised.answer import Answer
from optlaws.tolerances import EMPTY_ROW

_CONIC_SOLVER = 1e-12  # what a solver of cones is told to leave of gap and feasibility

_USABLE = ("Solved", "AlmostSolved")
INFEASIBLE = "PrimalInfeasible"
_MAGNIFIED = 2.0**12
#: what a cone is taken to be at its tip by, magnified
_NOTHING = 16.0


def conic(program: Program) -> bool:
    """Whether every family is linear, a norm, quadratic or conic, but not all are linear."""
    return program.curved and all(map(of_cones, program.families))


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

    def near(self, x: Array) -> _Block:
        """The program for the difference from x, magnified.

        A cone's boundary is nearly straight where s is: of s the part along the ray through it and the one across that
        ray are p and q with p q at least the square of the rest, and p is magnified, q is not, the rest by the root.
        """
        if self.linear:
            return replace(self, right=_MAGNIFIED * (self.right - self.rows @ x))
        count, size = self.shares.shape
        rows = self.rows.reshape(count, size, -1)
        turned = np.stack([_turned(s) for s in (self.right - self.rows @ x).reshape(count, size)])
        return replace(
            self,
            rows=(turned @ rows / _MAGNIFIED).reshape(-1, rows.shape[2]),
            right=np.einsum("cij,cj->ci", turned, (self.right - self.rows @ x).reshape(count, size)).ravel(),
            shares=np.einsum("cij,cj->ci", turned, self.shares) / _MAGNIFIED,
        )


def _turned(s: Array) -> Array:
    """The matrix that magnifies a cone about s; of what is nearly nothing all of it."""
    size, length = len(s), float(np.linalg.norm(s[1:]))
    if size == 1 or length * _MAGNIFIED < _NOTHING:
        return np.asarray(_MAGNIFIED * np.eye(size))
    ray = np.append(1.0, s[1:] / length)
    across = np.append(1.0, -ray[1:])
    # a reflection that takes the ray's direction to an axis
    normal = ray[1:].copy()
    normal[0] += np.copysign(1.0, normal[0])
    beside = np.eye(size - 1) - 2.0 * np.outer(normal, normal) / float(normal @ normal)
    matrix = np.zeros((size, size))
    matrix[0], matrix[1] = (_MAGNIFIED * across + ray) / 2.0, (_MAGNIFIED * across - ray) / 2.0
    matrix[2:, 1:] = _MAGNIFIED**0.5 * beside[1:]
    return matrix


def optimum_on_points(program: Program, points: list[Points], near: Array | None = None) -> Answer:
    """The optimum of the program with its families enforced at the points only.

    Parameters
    ----------
    program
        A program whose families are all `of_cones`.
    points
        Where its families are imposed.
    near
        Variables near the optimum, of which then the difference is sought, magnified.
    """
    import clarabel

    blocks = [_block(family, grid) for family, grid in zip(program.families, points, strict=True)]
    scale = 1.0 / _length(program.equalities)
    equations, given = program.equalities * scale[:, None], program.right * scale
    if near is not None:
        blocks = [block.near(near) for block in blocks]
        given = _MAGNIFIED * (given - equations @ near)
    matrix = np.vstack([equations, *(block.rows for block in blocks)])
    right = np.concatenate([given, *(block.right for block in blocks)])
    cones = [clarabel.ZeroConeT(len(scale)), *(cone for block in blocks for cone in block.cones)]
    straight = np.zeros((program.size, program.size))
    # its size is none of the optimum's
    size = float(np.linalg.norm(program.objective)) or 1.0
    optimum = conic_optimum(straight, program.objective / size, matrix, right, cones, tolerance=_CONIC_SOLVER)
    if not usable(optimum):
        return Answer.missing(program, points, str(optimum.status), optimum.iterations)
    ends = np.cumsum([len(scale), *(len(block.right) for block in blocks)])[:-1]
    pulls, *duals = np.split(size * np.asarray(optimum.z), ends)
    weights = [block.weights(dual) for block, dual in zip(blocks, duals, strict=True)]
    x = np.asarray(optimum.x) if near is None else near + np.asarray(optimum.x) / _MAGNIFIED
    x, status = _on_equations(program, x), str(optimum.status)
    return Answer(x, [*weights, pulls * scale], success=True, status=status, iterations=optimum.iterations)


def conic_optimum(
    curvature: Array, cost: Array, rows: Array, right: Array, cones: list[Any], *, tolerance: float
) -> Any:
    """The least x . curvature . x / 2 + cost . x with right - rows . x in cones, by Clarabel."""
    import clarabel
    from scipy import sparse

    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = tolerance
    sparse_curvature, sparse_rows = sparse.csc_matrix(np.triu(curvature)), sparse.csc_matrix(rows)
    return clarabel.DefaultSolver(sparse_curvature, cost, sparse_rows, right, cones, settings).solve()


def usable(optimum: Any) -> bool:
    """Whether Clarabel found an optimum, to its accuracy or nearly so."""
    return str(optimum.status) in _USABLE


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
