"""Vertices of linear programs on finitely many points, by the simplex method.

A vertex has as many binding rows as variables, and its multipliers balance exactly: where the optimum is flat, or
where multipliers of very different size meet, an interior point hides what a vertex shows.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.family import LinearFamily, Points, Program
from optlaws.synthesis.method.discretised.answer import Answer
from optlaws.tolerances import SIZE_RANK

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
