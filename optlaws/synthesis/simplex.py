"""A linear program on finitely many points by the simplex method, where IPOPT's answer is not sharp enough.

A vertex has as many binding rows as variables, and its multipliers balance exactly: where the optimum is flat, or
where multipliers of very different size meet, an interior point hides what a vertex shows.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from optlaws.synthesis.flat_optima import Table
from optlaws.synthesis.rows import Points, Program
from optlaws.synthesis.transcription import Answer

_TOLERANCES = (1e-10, 1e-9)


def vertex_on_points(program: Program, points: list[Points]) -> Answer | None:
    """An optimal vertex of the program with its families held at the points only; None where none is found.

    Parameters
    ----------
    program
        A program whose families are all linear.
    points
        Where they are held.
    """
    from scipy.optimize import linprog

    solve: Any = linprog
    table = Table(program, points)
    equations = {"A_eq": program.equalities, "b_eq": program.right} if len(program.right) else {}
    for tolerance in _TOLERANCES:
        found = solve(
            program.objective,
            A_ub=table.rows,
            b_ub=table.right,
            bounds=(None, None),
            method="highs-ds",
            options={"primal_feasibility_tolerance": tolerance, "dual_feasibility_tolerance": tolerance},
            **equations,
        )
        if found.status == 0:
            weights = np.maximum(-found.ineqlin.marginals, 0.0) / table.length
            ends = np.cumsum([len(mine.u) for mine in points])[:-1]
            multipliers = [*np.split(weights, ends), -np.asarray(found.eqlin.marginals, dtype=np.float64)]
            return Answer(np.asarray(found.x), multipliers, success=True, status=str(found.message), iterations=0)
    return None
