"""What bounds a law in which the integral of a convex formula, or its root, is small: sums of what it is not below.

A convex formula is nowhere below its tangents, one that is made of straight ones nowhere below a mean of these whose
shares change from cell to cell. Added up with weights, or integrated, they leave one coordinate of the law alone: it is
at most so much times the integral, and so much more.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from optlaws.formulas.of_motion import MotionFormula
from optlaws.numbers import Array, power_of_two
from optlaws.numerics.chebyshev import gauss
from optlaws.numerics.tolerances import BALANCED, FLAT_INTEGRAL, POSITIVE_LEVEL, POSITIVE_SHARES, REACH_SETTLED
from optlaws.synthesis.families.curved import IntegralFamily
from optlaws.synthesis.functionals.curved_rows import columns_of, integral_rows, rule_cells
from optlaws.synthesis.functionals.sizes import LARGEST, SizeBound, feasible_directions

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace


_CELLS = 6
_STEPS, _HALVINGS = 30, 20
#: how far from the least value tangents touch, by what would double it; nearer, they are more alike on all sides
_NEARER = (1.0, 0.25, 0.0625, 0.015625)


def by_integral(space: LawSpace, motion: MotionFormula) -> SizeBound | None:
    """What bounds the laws in which the integral of a convex formula is small."""
    return by_straight_formulas(space, motion) or by_tangents(space, motion, root=False)


def by_straight_formulas(space: LawSpace, motion: MotionFormula) -> SizeBound | None:
    """The bound by the integral of the greatest of straight formulas; None of others, or where they show none."""
    formulas = motion.branches(1.0)
    straight = [] if formulas is None else [MotionFormula(formula, motion.start, motion.stop) for formula in formulas]
    if not straight or any(branch.affine is None for branch in straight):
        return None
    fixed, free = feasible_directions(space)
    rule = space.quadrature(2)
    sizes = rule.weights @ np.abs(rule.values[:, :-1] @ free)
    if not free.shape[1] or (sizes == 0.0).any():
        return None
    rows = _rows(space, motion, straight, free.shape[1])
    known = _reaches(rows[..., :-1] @ (free / sizes), rows[..., :-1] @ fixed + rows[..., -1])
    if known is None or not sum(known) < LARGEST:
        return None
    factor, beside = known
    return SizeBound.of_acceleration(factor, beside + _mean_acceleration(space, fixed))


def _mean_acceleration(space: LawSpace, coordinates: Array) -> float:
    """The mean of |c| in a law."""
    rule = space.quadrature(2)
    return float(rule.weights @ np.abs(rule.values @ np.append(coordinates, 1.0)))


def _rows(space: LawSpace, motion: MotionFormula, straight: list[MotionFormula], count: int) -> Array:
    """Integrals of the straight formulas over cells, shape (cells, formulas, coordinates + 1)."""
    edges = rule_cells(space, motion, _CELLS * (count + 2))
    x, share = gauss(space.degree_of(0) // 2 + _CELLS)
    rows = []
    for low, high in pairwise(edges.tolist()):
        k, weights = low + (high - low) * (x + 1.0) / 2.0, share * (high - low) / 2.0
        several = {nu: columns_of(space, nu, k) for nu in {nu for branch in straight for nu in branch.weights}}
        sums = np.zeros((len(straight), space.terms + 1))
        for i, branch in enumerate(straight):
            for nu, factor in branch.weights.items():
                sums[i] += (weights * MotionFormula(factor).values({"k": k})) @ several[nu]
            sums[i, -1] += weights @ np.broadcast_to(MotionFormula(branch.rest).values({"k": k}), k.shape)
        rows.append(sums)
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
    return float(factor), float(beside)


def by_tangents(space: LawSpace, motion: MotionFormula, *, root: bool) -> SizeBound | None:
    """The bound by the integral of a convex formula, or its root; None where its tangents show none."""
    nothing = np.zeros(space.terms)
    unit = power_of_two(np.sqrt(motion.scale)) if root else motion.scale
    rows = integral_rows(space, motion, "", nothing, 0.0, root=False, convex=True)
    plain = rows.scaled_down(unit**2 if root else unit)
    bound = _by_tangents(space, plain, replace(plain, root=True) if root else plain)
    return None if bound is None else bound.times(1.0 / unit)


def _by_tangents(space: LawSpace, plain: IntegralFamily, family: IntegralFamily) -> SizeBound | None:
    """The bound by f, which is convex: an integral or its root."""
    fixed, free = feasible_directions(space)
    if not free.size:
        # one law is all there is
        return SizeBound.of_acceleration(0.0, _mean_acceleration(space, fixed))
    with np.errstate(all="ignore"):
        lowest = _lowest(plain, fixed, free)
        bend = free.T @ _hessian(plain, lowest) @ free
    if not np.isfinite(bend).all() or not np.isfinite(lowest).all():
        return None
    sizes, turned = np.linalg.eigh(bend)
    if sizes[0] <= FLAT_INTEGRAL * sizes[-1]:
        return None
    steps = free @ (turned / np.sqrt(sizes))
    far = float(np.sqrt(2.0 * abs(_value(plain, lowest)))) or 1.0
    for reach in (far * nearer for nearer in _NEARER):
        heights, slopes = _tangents(family, lowest, reach * np.hstack([steps, -steps]).T, steps)
        shares = _shares(slopes) if np.isfinite(heights).all() else None
        if shares is not None:
            return _summed(space, lowest, steps, heights, shares)
    return None


def _summed(space: LawSpace, lowest: Array, steps: Array, heights: Array, shares: Array) -> SizeBound:
    """The bound that weighted tangents say."""
    rule = space.quadrature(2)
    means = rule.weights @ np.abs(rule.values[:, :-1] @ steps)
    factors = shares.sum(axis=1).reshape(2, -1).max(axis=0)
    beside = -(shares @ heights).reshape(2, -1).min(axis=0)
    return SizeBound.of_acceleration(float(factors @ means), float(beside @ means) + _mean_acceleration(space, lowest))


def _value(family: IntegralFamily, x: Array) -> float:
    return float(family.value(x, np.ones(1))[0])


def _hessian(family: IntegralFamily, x: Array) -> Array:
    bent = family.hessian(x, np.ones(1), np.ones(1))
    return np.zeros((len(x), len(x))) if bent is None else bent


def _lowest(family: IntegralFamily, x: Array, free: Array) -> Array:
    """Nearly where the integral is least, by Newton's method with steps that are halved."""
    value = _value(family, x)
    for _ in range(_STEPS):
        bend, slope = free.T @ _hessian(family, x) @ free, free.T @ family.jet(x, np.ones(1), np.ones(1)).gradient[0]
        if not np.isfinite(bend).all():
            return x
        step = free @ np.linalg.lstsq(bend, -slope, rcond=None)[0]
        for _ in range(_HALVINGS):
            there = _value(family, x + step)
            if there <= value:
                break
            step = step / 2.0
        else:
            return x
        x, before, value = x + step, value, there
        if before - value <= REACH_SETTLED * abs(value):
            return x
    return x


def _tangents(family: IntegralFamily, lowest: Array, ways: Array, steps: Array) -> tuple[Array, Array]:
    """Heights at the lowest place, and slopes along the steps, of tangents there and on all sides."""
    rows = [family.tangent_row(1.0, 1.0, family.touching(lowest + way, 1.0)) for way in (0.0 * ways[0], *ways)]
    stacked = np.array([row for row in rows if row is not None])
    # tangents that touch very far away overflow: nearer ones are tried then
    with np.errstate(over="ignore", invalid="ignore"):
        return stacked @ np.append(lowest, 1.0), stacked[:, :-1] @ steps


def _shares(slopes: Array) -> Array | None:
    """Weights of tangents, all at least 0, that leave each coordinate in turn, then each with its sign turned."""
    count = slopes.shape[1]
    units = np.vstack([np.eye(count), -np.eye(count)])
    if len(slopes) < 2 * count + 1 or not np.isfinite(slopes).all():
        return None
    inverse = np.linalg.pinv(slopes.T)
    level = np.ones(len(slopes)) - inverse @ slopes.sum(axis=0)
    if level.min() < POSITIVE_SHARES:
        return None
    shares = units @ inverse.T
    shares = shares + np.maximum((-shares / level).max(axis=1), 0.0)[:, None] * level
    return shares if np.abs(shares @ slopes - units).max() <= BALANCED else None
