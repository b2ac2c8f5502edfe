"""A convex program on finitely many points by Clarabel, where RMS or amplitudes bind beside rows.

Its answer is good to some 1e-11 in the objective and in every row, which IPOPT's is not where many rows nearly bind,
and it uses that rows of pieces are sparse.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics.tolerances import CONIC_SOLVER, EMPTY_ROW
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily, Points, Program
from optlaws.synthesis.method.discretised.ipopt import Answer

_USABLE = ("Solved", "AlmostSolved")


def conic(program: Program) -> bool:
    """Whether every family is linear, a norm or made of cones, but not all of them linear."""
    kinds = all(isinstance(family, LinearFamily | NormFamily | ConeFamily) for family in program.families)
    return program.curved and kinds


@dataclass(frozen=True, eq=False)
class _Block:
    """Rows A x + s = h, s in cones one after the other with as many rows each; `scale` is what each is times."""

    rows: Array
    right: Array
    scale: Array
    linear: bool

    @property
    def cones(self) -> list[Any]:
        """Clarabel's cones."""
        import clarabel

        if self.linear:
            return [clarabel.NonnegativeConeT(len(self.right))]
        return [clarabel.SecondOrderConeT(len(self.right) // len(self.scale))] * len(self.scale)

    def weights(self, duals: Array) -> Array:
        """Multipliers of the constraints, one for each cone."""
        return np.asarray(np.maximum(duals[:: len(self.right) // len(self.scale)], 0.0) * self.scale)


def optimum_on_points(program: Program, points: list[Points]) -> Answer | None:
    """The optimum of the program with its families held at the points only; None where none is found.

    Parameters
    ----------
    program
        A program that is `conic`.
    points
        Where its families are held.
    """
    import clarabel

    blocks = [_block(family, held) for family, held in zip(program.families, points, strict=True)]
    scale = 1.0 / _length(program.equalities)
    matrix = np.vstack([program.equalities * scale[:, None], *(block.rows for block in blocks)])
    right = np.concatenate([program.right * scale, *(block.right for block in blocks)])
    cones = [clarabel.ZeroConeT(len(scale)), *(cone for block in blocks for cone in block.cones)]
    straight = np.zeros((program.size, program.size))
    optimum = conic_optimum(straight, program.objective, matrix, right, cones, tolerance=CONIC_SOLVER)
    if optimum is None:
        return None
    ends = np.cumsum([len(scale), *(len(block.right) for block in blocks)])[:-1]
    equations, *duals = np.split(np.asarray(optimum.z), ends)
    weights = [block.weights(dual) for block, dual in zip(blocks, duals, strict=True)]
    x = _on_equations(program, np.asarray(optimum.x))
    status = str(optimum.status)
    return Answer(x, [*weights, equations * scale], success=True, status=status, iterations=optimum.iterations)


def conic_optimum(
    curvature: Array, cost: Array, rows: Array, right: Array, cones: list[Any], *, tolerance: float
) -> Any:  # noqa: ANN401 - Clarabel's, imported late
    """The least x . curvature . x / 2 + cost . x with right - rows . x in cones, by Clarabel; None if it fails."""
    import clarabel
    from scipy import sparse

    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = tolerance
    sparse_curvature, sparse_rows = sparse.csc_matrix(np.triu(curvature)), sparse.csc_matrix(rows)
    optimum = clarabel.DefaultSolver(sparse_curvature, cost, sparse_rows, right, cones, settings).solve()
    return optimum if str(optimum.status) in _USABLE else None


def _block(family: ConstraintFamily, points: Points) -> _Block:
    if isinstance(family, LinearFamily):
        rows, right = family.rows(points.u, points.s)
        scale = 1.0 / _length(rows)
        return _Block(rows * scale[:, None], right * scale, scale, linear=True)
    if isinstance(family, NormFamily):
        # the norm of the columns is that of the triangle
        parts = np.asarray(np.linalg.qr(family.matrix, mode="r"))[None]
    elif isinstance(family, ConeFamily):
        columns = family.columns(points.u)[0]
        parts = np.stack([columns.real, columns.imag], axis=1)
    else:
        raise TypeError(f"{type(family).__name__} is no cone")
    room = np.broadcast_to(np.append(family.slack, family.bound), (len(parts), 1, parts.shape[2]))
    stacked = np.concatenate([room, parts], axis=1)
    # a cone stays one if all its rows are multiplied alike
    scale = 1.0 / np.sqrt(np.maximum((stacked[:, :, :-1] ** 2).sum(axis=2).max(axis=1), EMPTY_ROW**2))
    flat = (stacked * scale[:, None, None]).reshape(-1, parts.shape[2])
    return _Block(-flat[:, :-1], flat[:, -1], scale, linear=False)


def _length(rows: Array) -> Array:
    length = np.linalg.norm(rows, axis=1)
    return np.where(length < EMPTY_ROW, 1.0, length)


def _on_equations(program: Program, x: Array) -> Array:
    """The nearest variables that keep the equations exactly."""
    scale = 1.0 / _length(program.equalities)
    matrix, right = program.equalities * scale[:, None], program.right * scale
    return np.asarray(x + np.linalg.lstsq(matrix, right - matrix @ x, rcond=None)[0])
