"""The equations of a program: the independent ones, and the multipliers that prove a contradiction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.tolerances import DEPENDENT_ROWS, EMPTY_ROW

_EQUATION_OFF = 1e-9  # of a right side, or 1: by so much an equation may be missed
_NO_MULTIPLIER = 1e-12  # a multiplier that is less is none


def contradiction(rows: Array, right: Array) -> Array | None:
    """Multipliers y with y . rows = 0 and y . right < 0, the greatest of size 1; None where the equations agree.

    As few equations as may be have a multiplier: an equation of no variable, two for one value, else those
    that the least squares of the residuals weigh.

    Parameters
    ----------
    rows, right
        The equations rows . x = right, shapes (equations, variables) and (equations,).

    Examples
    --------
    >>> contradiction(np.array([[1.0, 1.0], [2.0, 2.0]]), np.array([1.0, 4.0])).tolist()
    [1.0, -0.5]
    """
    length = np.linalg.norm(rows, axis=1)
    empty = length < EMPTY_ROW
    for i in np.flatnonzero(empty & (np.abs(right) > _EQUATION_OFF)):
        return _unit(len(right), int(i), -float(np.sign(right[i])))
    length[empty] = 1.0
    rows, right = np.where(empty[:, None], 0.0, rows / length[:, None]), right / length
    multipliers = _of_one_value(rows, right)
    if multipliers is None:
        residual = right - rows @ np.linalg.lstsq(rows, right, rcond=DEPENDENT_ROWS)[0]
        if np.abs(residual).max(initial=0.0) <= _EQUATION_OFF * max(1.0, float(np.abs(right).max(initial=0.0))):
            return None
        multipliers = -residual
    multipliers = multipliers / length
    multipliers = multipliers / np.abs(multipliers).max()
    multipliers[np.abs(multipliers) < _NO_MULTIPLIER] = 0.0
    return np.asarray(multipliers, dtype=np.float64)


def independent(rows: Array) -> NDArray[np.bool_]:
    """Indices of independent rows, the earlier ones first; the other rows depend on them.

    Examples
    --------
    >>> independent(np.array([[1.0, 0.0], [2.0, 0.0], [1.0, 1.0]])).tolist()
    [True, False, True]
    """
    chosen = np.zeros(len(rows), dtype=np.bool_)
    directions = np.empty((0, rows.shape[1]))
    for i, row in enumerate(rows):
        size = float(np.linalg.norm(row))
        if size < EMPTY_ROW:
            continue
        left = row / size
        for _ in range(2):
            left = left - directions.T @ (directions @ left)
        new = float(np.linalg.norm(left))
        if new > DEPENDENT_ROWS:
            chosen[i] = True
            directions = np.vstack([directions, left / new])
    return chosen


def _of_one_value(rows: Array, right: Array) -> Array | None:
    """Two equations with different values of the same sum."""
    for i in range(len(rows)):
        for j in range(i):
            for sign in (1.0, -1.0):
                off = right[i] - sign * right[j]
                same = np.abs(rows[i] - sign * rows[j]).max(initial=0.0) < EMPTY_ROW
                if same and abs(off) > _EQUATION_OFF * max(1.0, abs(right[i])):
                    size = float(np.sign(off))
                    return _unit(len(right), j, size * sign) + _unit(len(right), i, -size)
    return None


def _unit(count: int, place: int, size: float) -> Array:
    unit = np.zeros(count)
    unit[place] = size
    return unit
