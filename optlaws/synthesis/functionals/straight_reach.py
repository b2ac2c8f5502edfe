"""What bounds a law in which the integral of a convex formula made of straight ones is small.

The formula is nowhere below any of the straight ones, nor below a mean of them whose shares change from cell to cell.
Integrated, such means leave one coordinate of the law alone: it is at most so much times the integral, and some more.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from optlaws.formulas.of_motion import MotionFormula
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss
from optlaws.numerics.tolerances import BALANCED, POSITIVE_LEVEL
from optlaws.synthesis.functionals.curved_rows import columns_of, rule_cells
from optlaws.synthesis.functionals.sizes import kept_directions

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace


_ORDER = 2
_ROUNDED = 1.0 + 1e-6
_CELLS = 6
_LARGEST = 1e13


def straight_reach(space: LawSpace, motion: MotionFormula) -> tuple[int, float, float] | None:
    """An order of derivative, a factor and an offset: its mean magnitude is at most the factor times f plus the offset.

    None where the formula is not made of straight ones, or they do not show that the law is bounded.

    Parameters
    ----------
    space
        Of the laws.
    motion
        The formula, over the part of the interval over which it is integrated.
    """
    formulas = motion.branches(1.0)
    straight = [] if formulas is None else [MotionFormula(formula, motion.start, motion.stop) for formula in formulas]
    if not straight or any(branch.affine is None for branch in straight):
        return None
    fixed, free = kept_directions(space)
    rule = space.quadrature(_ORDER)
    sizes = rule.weights @ np.abs(rule.values[:, :-1] @ free)
    if not free.shape[1] or (sizes == 0.0).any():
        return None
    rows = _rows(space, motion, straight, free.shape[1])
    slopes, heights = rows[..., :-1] @ (free / sizes), rows[..., :-1] @ fixed + rows[..., -1]
    known = _reaches(slopes, heights)
    if known is None:
        return None
    offset = float(rule.weights @ np.abs(rule.values @ np.append(fixed, 1.0)))
    factor, beside = (float(part) for part in known)
    return (_ORDER, _ROUNDED * factor, _ROUNDED * (beside + offset)) if factor + beside < _LARGEST else None


def _rows(space: LawSpace, motion: MotionFormula, straight: list[MotionFormula], count: int) -> Array:
    """Integrals of the straight formulas over cells, shape (cells, formulas, coordinates + 1)."""
    edges = rule_cells(space, motion, _CELLS * (count + 2))
    x, share = gauss(space.degree_of(0) // 2 + _CELLS)
    rows = []
    for low, high in pairwise(edges.tolist()):
        k, weights = low + (high - low) * (x + 1.0) / 2.0, share * (high - low) / 2.0
        several = {nu: columns_of(space, nu, k) for nu in {nu for branch in straight for nu in branch.weights}}
        own = np.zeros((len(straight), space.terms + 1))
        for i, branch in enumerate(straight):
            for nu, factor in branch.weights.items():
                own[i] += (weights * MotionFormula(factor).values({"k": k})) @ several[nu]
            own[i, -1] += weights @ np.broadcast_to(MotionFormula(branch.rest).values({"k": k}), k.shape)
        rows.append(own)
    return np.array(rows)


def _reaches(slopes: Array, heights: Array) -> tuple[float, float] | None:
    """Of all coordinates together: by how many times the integral they are bounded, and how much more."""
    from scipy.optimize import linprog

    cells, formulas, count = slopes.shape
    flat, heights = slopes.reshape(-1, count), heights.ravel()
    sums = np.kron(np.eye(cells), np.ones(formulas))
    matrix, right = np.vstack([flat.T, sums]), np.append(np.zeros(count), np.ones(cells))
    cost = np.append(np.zeros(cells * formulas), -1.0)
    # the shares are at least the last variable, which is as great as may be
    shifted = np.column_stack([matrix, matrix.sum(axis=1)])
    optimum = linprog(cost, A_eq=shifted, b_eq=right, method="highs")
    if optimum.x is None or optimum.x[-1] < POSITIVE_LEVEL:
        return None
    inverse = np.linalg.pinv(matrix)
    level = optimum.x[:-1] + optimum.x[-1]
    level = level - inverse @ (matrix @ level - right)
    moved = inverse[:, :count]
    off = float(np.abs(matrix @ moved - np.eye(count + cells)[:, :count]).max(initial=0.0))
    if off > BALANCED or (level <= 0.0).any():
        return None
    factor = beside = 0.0
    for column in moved.T:
        both = [max(float((-side / level).max()), 0.0) for side in (column, -column)]
        lifts = [-float((side + times * level) @ heights) for side, times in zip((column, -column), both, strict=True)]
        factor, beside = factor + max(both), beside + max(*lifts, 0.0)
    return factor, beside
