"""A linear program on finitely many points by the simplex method, where IPOPT's answer is not sharp enough.

A vertex has as many binding rows as variables, and its multipliers balance exactly: where the optimum is flat, or
where multipliers of very different size meet, an interior point hides what a vertex shows.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.families.family import Points, Program
from optlaws.synthesis.method.on_points.flat import Table
from optlaws.synthesis.method.on_points.ipopt import Answer

Array = NDArray[np.float64]

# where a way ends without an answer, the next is asked: a presolve or a tolerance may be what stops it
_WAYS = (("highs-ds", True, 1e-10), ("highs-ds", False, 1e-10), ("highs-ds", False, 1e-9), ("highs-ipm", True, 1e-10))
_OPTIMAL, _INFEASIBLE = 0, 2
_MAGNIFIED = 2.0**14


def vertex_on_points(program: Program, points: list[Points], near: Array | None = None) -> Answer | None:
    """An optimal vertex of the program with its families held at the points only; None where none is found.

    Parameters
    ----------
    program
        A program whose families are all linear.
    points
        Where they are held.
    near
        Variables near the vertex, of which then the difference is sought, magnified: what the solver tolerates in a
        row becomes so much smaller.
    """
    from scipy.optimize import linprog

    solve: Any = linprog
    table = Table(program, points)
    right, equation_right = table.right, table.equation_right
    if near is not None:
        right = _MAGNIFIED * -table.residuals(near)
        equation_right = _MAGNIFIED * (equation_right - table.equations @ near)
    equations = {"A_eq": table.equations, "b_eq": equation_right} if len(program.right) else {}
    for method, presolve, tolerance in _WAYS:
        optimum = solve(
            program.objective,
            A_ub=table.rows,
            b_ub=right,
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
            x = np.asarray(optimum.x) if near is None else near + np.asarray(optimum.x) / _MAGNIFIED
            return _answer(table, points, x, optimum)
        if optimum.status == _INFEASIBLE:
            return None
    return None


def by_family(values: Array, points: list[Points]) -> list[Array]:
    """Values of all rows, those of each family apart."""
    return np.split(values, np.cumsum([len(held.u) for held in points])[:-1])


def _answer(table: Table, points: list[Points], x: Array, optimum: Any) -> Answer:  # noqa: ANN401 - scipy's OptimizeResult
    weights = np.maximum(-optimum.ineqlin.marginals, 0.0) / table.length
    equations = -np.asarray(optimum.eqlin.marginals, dtype=np.float64) / table.equation_length
    status = str(optimum.message)
    return Answer(x, [*by_family(weights, points), equations], success=True, status=status, iterations=0)
