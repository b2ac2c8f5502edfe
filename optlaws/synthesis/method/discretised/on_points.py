"""Programs on finitely many points: the points, and optima of linear and conic programs by Clarabel and by HiGHS.

Clarabel's answer is good to some 1e-11 in the objective and in every row, and it uses that rows of pieces are sparse.
A vertex of the simplex method has as many binding rows as variables, and its multipliers balance exactly: where the
optimum is flat, or where multipliers of very different size meet, an interior point hides what a vertex shows.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebpts2

from optlaws.numbers import Array
from optlaws.numerics.chebyshev import nodes
from optlaws.numerics.cones import SparseColumns, conic_optimum, usable
from optlaws.synthesis.families.cone import ConeFamily, SumOfSquares
from optlaws.synthesis.families.curved import CurvedFamily, FormulaFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily, Points, Program
from optlaws.tolerances import EMPTY_ROW, SIZE_RANK

QUADRATIC = "quadratic programs"  #: that follow each other, whether or not the last one changed nothing
_NEARLY = (QUADRATIC, "Solved_To_Acceptable_Level")


@dataclass(frozen=True, eq=False)
class Answer:
    """A solver's solution: never reported, only a start for the exact active set.

    `multipliers` has an array for each family, in the order of its points, and the equations' last.
    """

    x: Array
    multipliers: list[Array]
    success: bool
    status: str
    iterations: int
    weightless: float = 1e-13  #: of the greatest multiplier of a family: what is less is rounding, or a barrier's

    @classmethod
    def missing(cls, program: Program, points: list[Points], status: str, iterations: int = 0) -> Answer:
        """That of a solver that has none, and says why."""
        nothing = [np.zeros(len(grid.u)) for grid in points]
        x = np.full(program.size, np.nan)
        return cls(x, [*nothing, np.zeros(len(program.right))], success=False, status=status, iterations=iterations)

    @property
    def usable(self) -> bool:
        """Whether x is a start for the exact active set: an answer that is nearly one is, it is polished anyway."""
        return self.success or self.status in _NEARLY


_NEARLY_BINDING = 1e-2  # of a right side, or 1: extrema within this of binding join the points that are held
_CLOSER = 0.25  # of the distance to the nearest point: how far off extrema further points join
_DENSE = 6  # times as many points beside formulas that are no polynomials


def first_points(program: Program) -> list[Points]:
    """First points of each family, enough for the solution on them to show the contacts."""
    # with no peak to hold them, the velocity constraints need points enough by themselves
    share = 1.0 if any(len(family.signs) > 1 for family in program.families) else 1.5
    times = _DENSE if _dense(program) else 1
    return [_points(family, times * program.size, share) for family in program.families]


def _dense(program: Program) -> bool:
    """Whether it has a formula that is no polynomial: between few points its law is another than on all."""
    return any(isinstance(family, CurvedFamily) and family.degree is None for family in program.families)


def _points(family: ConstraintFamily, size: int, even_share: float) -> Points:
    """Points of a family, few enough to be quick; the rarer sign of a magnitude has half as many."""
    low, high = family.domain
    if low == high:
        return Points(np.repeat([low], len(family.signs)), np.array(family.signs))
    given = family.nodes()
    if given is not None:
        if not len(given):
            given = np.array([low, high])  # a window between the nodes
        return Points(np.tile(given, len(family.signs)), np.repeat(family.signs, len(given)))
    u, s = [], []
    for i, sign in enumerate(family.signs):
        if isinstance(family, LinearFamily) and family.even:
            count = int(even_share * size) + 4
            places = chebpts2(count)[::-1]
        elif low == 0.0:
            count = int((1.5, 0.75)[i] * size) + 4
            places = high * nodes(2 * count)[:count]
        else:
            count = int(1.5 * size) + 4
            places = (high + low) / 2 + (high - low) / 2 * nodes(count)
        u.append(places)
        s.append(np.full(count, sign))
    return Points(np.concatenate(u), np.concatenate(s))


def with_extrema(program: Program, points: list[Points], x: Array) -> list[Points]:
    """The points of every family, with the extrema at x that are active or nearly active."""
    beside = _dense(program)
    return [_joined(family, grid, x, beside=beside) for family, grid in zip(program.families, points, strict=True)]


def _joined(family: ConstraintFamily, points: Points, x: Array, *, beside: bool) -> Points:
    if family.domain[0] == family.domain[1]:
        return points
    u, s, residual = family.extremes(x)
    near = residual > -_NEARLY_BINDING * max(1.0, abs(family.right_side(x)))
    for sign in family.signs:
        near &= (s != sign) | ~np.isin(u, points.u[points.s == sign])
    u, s = u[near], s[near]
    if beside and len(u):
        # where nothing proves an optimum its contacts are not followed, but enclosed ever closer
        apart = np.abs(u[:, None] - points.u)
        apart[(s[:, None] != points.s) | (apart == 0.0)] = np.inf
        off = _CLOSER * np.where(np.isfinite(nearest := apart.min(axis=1)), nearest, 0.0)
        u, s = np.clip(np.concatenate([u, u - off, u + off]), *family.domain), np.tile(s, 3)
    return points.joined(Points(u, s))


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


# if a method ends without an answer, the next is tried: a presolve or a tolerance may be the obstacle
_WAYS = (("highs-ds", True, 1e-10), ("highs-ds", False, 1e-10), ("highs-ds", False, 1e-9), ("highs-ipm", True, 1e-10))
_OPTIMAL, _INFEASIBLE = 0, 2


def vertex_on_points(program: Program, points: list[Points]) -> Answer | None:
    """An optimal vertex of the program with its families enforced at the points only; None if the solver fails.

    Parameters
    ----------
    program
        A program whose families are all linear.
    points
        Where they are imposed.
    """
    from scipy.optimize import linprog

    solve: Any = linprog
    families = [family for family in program.families if isinstance(family, LinearFamily)]
    parts = [family.rows(grid.u, grid.s) for family, grid in zip(families, points, strict=True)]
    rows = np.vstack([np.empty((0, program.size)), *(part for part, _ in parts)])
    right, length = np.concatenate([np.empty(0), *(most for _, most in parts)]), _lengths(rows)
    # high derivatives at the ends of short pieces make some equations very long
    equation_length = _lengths(program.equalities)
    equations = {
        "A_eq": program.equalities / equation_length[:, None],
        "b_eq": program.right / equation_length,
    }
    for method, presolve, tolerance in _WAYS:
        optimum = solve(
            program.objective,
            A_ub=rows / length[:, None],
            b_ub=right / length,
            bounds=(None, None),
            method=method,
            options={
                "presolve": presolve,
                "primal_feasibility_tolerance": tolerance,
                "dual_feasibility_tolerance": tolerance,
            },
            **(equations if len(program.right) else {}),
        )
        if optimum.status == _OPTIMAL:
            weights = np.maximum(-optimum.ineqlin.marginals, 0.0) / length
            by_family = np.split(weights, np.cumsum([len(grid.u) for grid in points])[:-1])
            multipliers = [*by_family, -np.asarray(optimum.eqlin.marginals, dtype=np.float64) / equation_length]
            return Answer(np.asarray(optimum.x), multipliers, success=True, status=str(optimum.message), iterations=0)
        if optimum.status == _INFEASIBLE:
            return None
    return None


def _lengths(rows: Array) -> Array:
    """The lengths of rows, 1 of those that are none."""
    length = np.linalg.norm(rows, axis=1)
    return np.asarray(np.where(length < SIZE_RANK, 1.0, length))
