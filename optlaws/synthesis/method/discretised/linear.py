"""Linear programs on finitely many points: vertices by the simplex method, and optima sharpened.

A vertex has as many binding rows as variables, and its multipliers balance exactly: where the optimum is flat, or
where multipliers of very different size meet, an interior point hides what a vertex shows.

Where an optimum is flat (a jerk that is constant, constraints that contradict each other along an interval) there is
no exact active set for Newton's method. IPOPT's answer then shows by its multipliers which rows bind; to make those
rows hold exactly, and the multipliers balance exactly, are two linear problems, solved by the least change.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import LinearFamily, Points, Program
from optlaws.synthesis.method.discretised.answer import Answer
from optlaws.tolerances import SIZE_RANK

_FLAT_GAP = 1e-9  # of an objective: what a linear program's vertex may be off its dual
_VERTEX_FEASIBILITY = 1e-11  # of a vertex: by so much its own equations may be missed
_VERTEX_BALANCED = 1e-12  # of the greatest multiplier: by so much a vertex may fail to balance

#: a row binds if its multiplier exceeds its distance times this, in units in which it has length 1; the more rows hold
#: together, the better they say where x is: as few as their own number, hardly independent, miss by 1e-10 in between
_FEWER = (1e-2, 1.0, 1e2, 1e4)
_MORE = (1.0, 1e-2, 1e-4, 1e-6, 1e-8)
# if a method ends without an answer, the next is tried: a presolve or a tolerance may be the obstacle
_WAYS = (("highs-ds", True, 1e-10), ("highs-ds", False, 1e-10), ("highs-ds", False, 1e-9), ("highs-ipm", True, 1e-10))
_OPTIMAL, _INFEASIBLE = 0, 2


def sharpened(program: Program, points: list[Points], answer: Answer) -> ActiveSet | None:
    """The optimum on the points that IPOPT's answer is near to; None where its multipliers do not show it.

    Parameters
    ----------
    program
        A program whose families are all linear.
    points, answer
        Where its families were imposed, and IPOPT's solution of that.
    """
    table = LinearTable(program, points)
    weights = np.concatenate(answer.multipliers[:-1]) * table.length
    ease = weights / max(1.0, float(weights.max(initial=0.0)))
    room = -table.residuals(answer.x)
    # too many rows cannot all hold, too few multipliers cannot balance: each is sought by itself
    vertices = (table.vertex_at(ease > share * room, answer.x) for share in _FEWER)
    x = next((nearest for nearest in vertices if nearest is not None), None)
    if x is None:
        return None
    for share in _MORE:
        binding = ease > share * room
        balance = table.balanced(binding, weights, answer.multipliers[-1])
        if balance is not None:
            multipliers, equations = balance
            active = np.flatnonzero(binding)
            gap = float(np.abs(multipliers * table.residuals(x)[active]).sum())
            if gap > _FLAT_GAP * max(1.0, abs(program.objective_at(x))):
                return None
            return ActiveSet(
                x=x,
                family=table.family[active],
                u=table.u[active],
                s=table.s[active],
                free=np.zeros(len(active), dtype=np.bool_),
                multipliers=multipliers / table.length[active],
                equality_multipliers=equations,
            )
    return None


class LinearTable:
    """All rows of a linear program on points, and its equations, scaled to length 1.

    Attributes
    ----------
    rows, right, length
        The rows, their right sides and what each was divided by.
    equations, equation_right, equation_length
        The same of the equations: high derivatives at the ends of short pieces make some of them very long.
    family, u, s
        To which family a row belongs, its place and its sign.
    """

    def __init__(self, program: Program, points: list[Points]) -> None:
        self.objective = program.objective
        self.equation_length = np.linalg.norm(program.equalities, axis=1)
        self.equation_length[self.equation_length < SIZE_RANK] = 1.0
        self.equations = program.equalities / self.equation_length[:, None]
        self.equation_right = program.right / self.equation_length
        families = [family for family in program.families if isinstance(family, LinearFamily)]
        parts = [family.rows(grid.u, grid.s) for family, grid in zip(families, points, strict=True)]
        rows = np.vstack([np.empty((0, program.size)), *(part for part, _ in parts)])
        self.length = np.linalg.norm(rows, axis=1)
        self.length[self.length < SIZE_RANK] = 1.0
        self.rows = rows / self.length[:, None]
        self.right = np.concatenate([np.empty(0), *(right for _, right in parts)]) / self.length
        self.family = np.repeat(np.arange(len(families)), [len(grid.u) for grid in points])
        self.u = np.concatenate([np.empty(0), *(grid.u for grid in points)])
        self.s = np.concatenate([np.empty(0), *(grid.s for grid in points)])

    def residuals(self, x: Array) -> Array:
        """Rows . x - right: negative where a row has slack."""
        return np.asarray(self.rows @ x - self.right)

    def vertex_at(self, binding: NDArray[np.bool_], x: Array) -> Array | None:
        """The nearest x at which the active rows and the equations hold exactly; None without such an x."""
        matrix = np.vstack([self.rows[binding], self.equations])
        right = np.concatenate([self.right[binding], self.equation_right])
        for _ in range(2):
            x = x + np.linalg.lstsq(matrix, right - matrix @ x, rcond=SIZE_RANK)[0]
        left = np.abs(matrix @ x - right).max(initial=0.0)
        return x if left <= _VERTEX_FEASIBILITY * max(1.0, float(np.abs(x).max())) else None

    def balanced(self, binding: NDArray[np.bool_], weights: Array, equations: Array) -> tuple[Array, Array] | None:
        """Multipliers near the given ones that balance the objective exactly; None if any would be negative.

        Those of the rows belong to rows of length 1, those of the equations to the program's own.
        """
        rows, before = self.rows[binding], weights[binding]
        matrix = np.hstack([rows.T * before, self.equations.T])
        scaled = equations * self.equation_length
        share = np.zeros(len(before) + len(scaled))
        for _ in range(2):
            changed = before * (1.0 + share[: len(before)])
            share = (
                share
                - np.linalg.lstsq(matrix, self._defect(rows, changed, scaled + share[len(before) :]), SIZE_RANK)[0]
            )
        changed, scaled = before * (1.0 + share[: len(before)]), scaled + share[len(before) :]
        left = np.abs(self._defect(rows, changed, scaled)).max()
        sound = left <= _VERTEX_BALANCED * max(1.0, float(changed.max(initial=0.0)))
        return (changed, scaled / self.equation_length) if sound and not (changed < 0.0).any() else None

    def sharp(self, vertex: Answer, points: list[Points]) -> Answer:
        """A vertex whose multipliers balance the objective exactly; unchanged if there are none."""
        weights = np.concatenate(vertex.multipliers[:-1]) * self.length
        binding = weights > 0.0
        balanced = self.balanced(binding, weights, vertex.multipliers[-1])
        if balanced is None:
            return vertex
        weights[binding], equations = balanced
        return replace(vertex, multipliers=[*by_family(weights / self.length, points), equations])

    def _defect(self, rows: Array, multipliers: Array, equations: Array) -> Array:
        return np.asarray(self.objective + rows.T @ multipliers + self.equations.T @ equations)


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
    table = LinearTable(program, points)
    equations = {"A_eq": table.equations, "b_eq": table.equation_right} if len(program.right) else {}
    for method, presolve, tolerance in _WAYS:
        optimum = solve(
            program.objective,
            A_ub=table.rows,
            b_ub=table.right,
            bounds=(None, None),
            method=method,
            options={
                "presolve": presolve,
                "primal_feasibility_tolerance": tolerance,
                "dual_feasibility_tolerance": tolerance,
            },
            **equations,
        )
        if optimum.status == _OPTIMAL:
            return _answer(table, points, optimum)
        if optimum.status == _INFEASIBLE:
            return None
    return None


def by_family(values: Array, points: list[Points]) -> list[Array]:
    """Values of all rows, separated by family."""
    return np.split(values, np.cumsum([len(grid.u) for grid in points])[:-1])


def _answer(table: LinearTable, points: list[Points], optimum: Any) -> Answer:
    weights = np.maximum(-optimum.ineqlin.marginals, 0.0) / table.length
    equations = -np.asarray(optimum.eqlin.marginals, dtype=np.float64) / table.equation_length
    status = str(optimum.message)
    return Answer(
        np.asarray(optimum.x), [*by_family(weights, points), equations], success=True, status=status, iterations=0
    )
