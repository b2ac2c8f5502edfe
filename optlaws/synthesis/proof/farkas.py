"""Rows that contradict each other (Farkas): their multipliers, corrected so that the sum does not depend on the law.

Multipliers from a solver leave a rest of the sum that depends on the law, and where nothing bounds the law that rest
cannot be charged. Where the rows determine every variable a little of their multipliers takes it up, to the last bit
and whatever the rows' own rounding; all that is needed is that no multiplier becomes negative. Where they do not, what
is left is charged for laws as great as floating-point numbers can distinguish.
"""

from __future__ import annotations

import numpy as np

from optlaws.numbers import Array

_FARKAS_ROUNDING = 1e-14  # of weighted lengths of rows: more than the rounding of their sum
_FARKAS_FIRM = 1e-10  # of the greatest singular value: rows with less leave directions open

#: in units of free functions with peak acceleration 1; of a greater law no double tells whether it keeps the rows
_GREATEST = 1e12
_ROUNDS = 3


def farkas_margin(rows: Array, right: Array, multipliers: Array, count: int) -> float:
    """The margin by which rows . x <= right contradict each other, with multipliers; not above 0 if not shown.

    Parameters
    ----------
    rows, right
        Shapes (rows, variables) and (rows,).
    multipliers
        One for each row.
    count
        So many rows come first as inequalities, with multipliers of at least 0; the rest are equations.

    Examples
    --------
    >>> farkas_margin(np.array([[1.0], [-1.0]]), np.array([0.0, -0.25]), np.array([1.0, 1.0]), 2)
    0.25
    """
    if not len(rows):
        return 0.0
    length = np.maximum(np.linalg.norm(rows, axis=1), np.finfo(np.float64).tiny)
    # the weightier a multiplier, the more it may give
    ease = np.abs(multipliers) * length
    ease[count:] = max(float(ease.max()), np.finfo(np.float64).tiny)
    columns = (rows / length[:, None] * ease[:, None]).T
    values = np.linalg.svd(columns, compute_uv=False)
    corrected = multipliers.copy()
    for _ in range(_ROUNDS):
        corrected = corrected - np.linalg.lstsq(columns, rows.T @ corrected, rcond=_FARKAS_FIRM)[0] * ease / length
    if (corrected[:count] < 0.0).any():
        corrected = multipliers
    rest = rows.T @ corrected
    value = -float(corrected @ right)
    uncertain = float(np.linalg.norm(rest)) + _FARKAS_ROUNDING * float(np.abs(corrected) @ length)
    firm = len(rows) >= rows.shape[1] and float(values[-1]) > _FARKAS_FIRM * float(values[0])
    if firm:
        moved = uncertain / float(values[-1]) * ease / length
        if (corrected[:count] >= moved[:count]).all():
            return value - float(moved @ np.abs(right))
    return value - _GREATEST * float(np.abs(rest).sum())
