"""Multipliers of many linear programs over one polytope in the unit cube, by the dual simplex method.

Of each step the multipliers are none below 0, so that they prove something wherever the method stops.
"""

from __future__ import annotations

import numpy as np

from optlaws.numbers import Array

_ROW_BROKEN = 1e-11  # of a row: what is broken by less is kept
_PIVOT_LEAST = 1e-8  # of a row: what a row of the basis must have of one that it leaves to
_TIE_BROKEN = 1e-9  # of a goal: what is added so that multipliers differ

#: steps, for each variable
_STEPS = 8


def multipliers_in_cube(goals: Array, rows: Array, right: Array) -> tuple[Array, Array]:
    """Multipliers of the rows for each goal that is minimised where rows . z <= right and no |z| exceeds 1.

    Parameters
    ----------
    goals, rows, right
        Shapes (goals, variables), (rows, variables), (rows,); rows whose magnitudes sum up to about 1.

    Returns
    -------
    multipliers
        Shape (goals, rows), none below 0. Where no z keeps the rows they are those of a sum that is above 0 everywhere.
    points
        The minimisers, shape (goals, variables); NaN where no z keeps the rows.

    Examples
    --------
    >>> weights, points = multipliers_in_cube(np.array([[-1.0, 0.0]]), np.array([[0.5, 0.5]]), np.array([-0.25]))
    >>> weights.round(6).tolist(), points.round(6).tolist()
    ([[2.0]], [[0.5, -1.0]])
    >>> weights, points = multipliers_in_cube(np.array([[-1.0, 0.0]]), np.array([[0.5, 0.5]]), np.array([-1.5]))
    >>> weights.round(6).tolist(), bool(np.isnan(points).all())
    ([[2.0]], True)
    """
    count, size = goals.shape
    every = np.vstack([rows, np.eye(size), -np.eye(size)])
    most = np.concatenate([right, np.ones(2 * size)])
    # what is minimised is not quite the goal: of multipliers that are 0 none would be the first to leave
    broken = goals + np.where(goals < 0.0, -_TIE_BROKEN, _TIE_BROKEN) * (1.0 + np.arange(size) / size)
    basis = len(rows) + np.arange(size) + np.where(broken > 0.0, size, 0)
    weights, points = np.zeros((count, len(every))), np.full((count, size), np.nan)
    left = np.arange(count)
    for step in range(_STEPS * size + 1):
        inverse = _inverses(every[basis[left]])
        z = (inverse @ most[basis[left], None])[:, :, 0]
        excess = z @ every.T - most
        entering = excess.argmax(axis=1)
        ended = excess[np.arange(len(left)), entering] <= _ROW_BROKEN
        if step == _STEPS * size:
            ended[:] = True
        if ended.any():
            at = left[ended]
            weights[at[:, None], basis[at]] = np.maximum(-(goals[at, None] @ inverse[ended])[:, 0], 0.0)
            points[at] = z[ended]
            left, inverse, entering = left[~ended], inverse[~ended], entering[~ended]
        if not len(left):
            break
        share = (every[entering, None] @ inverse)[:, 0]
        now = np.maximum(-(broken[left, None] @ inverse)[:, 0], 0.0)
        ratio = np.full(now.shape, np.inf)
        np.divide(now, share, out=ratio, where=share > _PIVOT_LEAST)
        leaving = ratio.argmin(axis=1)
        empty = np.isinf(ratio[np.arange(len(left)), leaving])
        if empty.any():
            # the rows of the basis can do nothing against the one that enters
            at = left[empty]
            weights[at[:, None], basis[at]] = np.maximum(-share[empty], 0.0)
            weights[at, entering[empty]] = 1.0
            points[at] = np.nan
            left, leaving, entering = left[~empty], leaving[~empty], entering[~empty]
        basis[left, leaving] = entering
    return weights[:, : len(rows)], points


def _inverses(matrices: Array) -> Array:
    """Inverses of matrices; zeros, which show nothing, of those that have none."""
    try:
        return np.asarray(np.linalg.inv(matrices))
    except np.linalg.LinAlgError:
        regular = np.linalg.matrix_rank(matrices) == matrices.shape[-1]
        inverses = np.zeros_like(matrices)
        inverses[regular] = np.linalg.inv(matrices[regular])
        return inverses
