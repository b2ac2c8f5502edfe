"""Lower bounds of B of the loader, which is convex in the executive law, from tangents and a linear program.

The integral of sqrt(B² - b²) is concave in b, so its tangent at any law is never below it, and half of B over it,
which is B of the loader, never below the tangent of that. A bound needs nothing to be optimal.
"""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import NDArray

from optlaws.mechanisms.loader.search import FINE, Task, lowest, peaks

Array = NDArray[np.float64]

_EVERY = 4


def tangent_bound(task: Task, y: Array) -> float:
    """What no law of the task's space is below: weights of B_loader and C only; y is the law of the tangent.

    The multipliers come from a linear program over finitely many places; the bound is recomputed from them alone.
    """
    from scipy.optimize import linprog

    space, size = task.space, task.space.size
    even = np.linspace(0.0, 1.0, FINE)
    fine = space.rows(even)
    at = space.rows(np.union1d(even[::_EVERY], lowest(task, fine, np.append(y, peaks(task, fine, y)))))
    slope = 4.0 * at.t[:, None] * at.p
    slope = np.vstack([slope, -slope])
    parts = [-at.q, -at.ratio]  # b <= B, b >= 0
    if task.most < inf:
        parts.append(slope - np.append(np.zeros(size), task.most))
    fixed = sum(map(len, parts))
    weight = task.weights.get("C", 0.0)
    if weight:
        parts.append(slope)  # at most the variable C
    every = np.vstack(parts)
    peak = np.where(np.arange(len(every)) < fixed, 0.0, -1.0)
    goal = task.tangent(y)
    matrix = np.column_stack([every[:, :-1], peak])
    size_of_goal = max(float(np.abs(goal).max()), weight)
    answer = linprog(
        np.append(goal, weight) / size_of_goal,
        A_ub=matrix,
        b_ub=-every[:, -1],
        bounds=[(None, None)] * size + [(None, None) if weight else (0.0, 0.0)],
        method="highs",
    )
    constant = task.weights["B_loader"] * space.B * float(space.Y(y).value[0]) - float(goal @ y)
    extent = _extent(task, at.t)

    def proven(multipliers: Array) -> float:
        left = np.abs(goal + every[:, :-1].T @ multipliers)
        return constant + float(multipliers @ every[:, -1]) - float(left @ extent)

    found = -inf if weight else proven(np.zeros(len(every)))
    if answer.x is None:
        return found
    multipliers = _refined(size_of_goal * -answer.ineqlin.marginals, matrix, np.append(goal, weight))
    total = float(multipliers[fixed:].sum())
    if weight:
        multipliers[fixed:] *= weight / total if total > 0.0 else 0.0
    return max(found, proven(multipliers))


def _refined(multipliers: Array, matrix: Array, goal: Array) -> Array:
    """Multipliers that take up the goal to rounding, not only to the tolerance of the linear program."""
    found = np.maximum(multipliers, 0.0)
    active = np.flatnonzero(found > 0.0)
    left = goal + matrix[active].T @ found[active]
    found[active] += np.linalg.lstsq(matrix[active].T, -left, rcond=None)[0]
    return np.maximum(found, 0.0)


def _extent(task: Task, t: Array) -> Array:
    """What |y| is at most: 0 <= b <= B at places determines y, and makes what rounding leaves of the gradient cheap."""
    fall = t[:, None] ** 2 * task.space.rows(t).q
    found: Array = np.abs(np.linalg.pinv(fall[:, :-1])) @ (task.space.B + np.abs(fall[:, -1]))
    return found
