"""A priori bounds of laws in which a formula is small, and lower bounds of formulas in all laws.

Enough values of a formula that is affine in the law determine the law. A convex formula is nowhere below its tangents,
one that consists of affine parts nowhere below a mean of these whose shares change from cell to cell. Added up with
weights, or integrated, they leave one coordinate of the law alone: it is at most so much times the integral, and more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.tree import ORDERS
from optlaws.numbers import Array, power_of_two
from optlaws.numerics.chebyshev import gauss as gauss_rule
from optlaws.synthesis.families.cone import SumOfSquares
from optlaws.synthesis.families.curved import IntegralFamily
from optlaws.synthesis.functionals.affine_rows import columns, gauss
from optlaws.synthesis.functionals.curved_rows import columns_of, integral_rows, rule_cells
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.tolerances import SIZE_RANK, TINY

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace

_INVERSE_AGREES = 1e-6  # what an inverse times its matrix may differ from the identity by
_POSITIVE_WEIGHTS = 1e-4  # of a weight: what is no more is not clearly positive
_POSITIVE_LEVEL = 1e-7  # weights of levels that balance are at least so great
_BALANCED = 1e-9  # by so much weighted slopes may fail to balance
_REACH_SETTLED = 1e-6  # of an integral: a step of Newton's method that lowers it by less is the last
_FLAT_INTEGRAL = 1e-13  # of the greatest curvature: an integral that bends less in a direction is flat in it
_POSITIVE_SHARES = 1e-3  # how near the weights of tangents that balance are to each other at least
_LEAST_SQUARES = 1e-3  # of the unit of a sum of squares: the least by whose root the size of laws is bounded


_ROUNDED = 1.0 + 1e-6
_ORDER = 2
_MOST_GAIN = 1e6
_ROOM = 1.01
#: beyond this a bound says nothing
_LARGEST = 1e13
_CELLS = 6
_STEPS, _HALVINGS = 30, 20
#: how far from the least value tangents touch, by what would double it; nearer, they are more alike on all sides
_NEARER = (1.0, 0.25, 0.0625, 0.015625)


class SizeBound(NamedTuple):
    """The mean magnitude of a derivative of some order is at most a factor times a constant, plus an offset."""

    order: int
    factor: float
    offset: float

    @classmethod
    def of_acceleration(cls, factor: float, offset: float) -> Self:
        """The bound of |c|, with a margin for rounding."""
        return cls(_ORDER, _ROUNDED * factor, _ROUNDED * offset)

    def times(self, share: float) -> Self:
        """The bound by another constant, of which this one is at most a share."""
        return self._replace(factor=self.factor * share)


@dataclass(frozen=True, eq=False)
class Reach:
    """A bound of the mean of |c|: the sum of pulls times |f| at places, plus an offset."""

    pulls: Array  #: one for each place
    offset: float  #: what is there without the formula
    weights: Array  #: of the places: the sum of weights times f² is the integral of f²
    #: weights above 0 whose sum with f is the same in every law, None where there are none; and that sum
    turning: tuple[Array, float] | None = None

    def by_peak(self) -> SizeBound:
        """The bound for a formula whose magnitude is at most 1."""
        return SizeBound.of_acceleration(float(self.pulls.sum()), self.offset)

    def by_square(self) -> SizeBound:
        """The bound for a formula whose square's integral is 1, by Cauchy's inequality."""
        return SizeBound.of_acceleration(float(np.sqrt((self.pulls**2 / self.weights).sum())), self.offset)

    def by_one_sign(self, sign: float) -> SizeBound | None:
        """The bound for a formula that is at most 1 with a sign: what is above 0 less what is below is known."""
        if self.turning is None:
            return None
        turning, fixed = self.turning
        share = float((self.pulls / turning).max())
        most = 2.0 * share * float(turning.sum())
        return SizeBound.of_acceleration(most, self.offset + share * max(-sign * fixed, 0.0))


def reach(space: LawSpace, parts: tuple[MotionFormula, ...]) -> Reach | None:
    """How an affine formula's values bound the laws of a space; None where they do not, or hardly.

    The law's coordinates are a linear function of enough values of the formula, and so is its acceleration.
    """
    rules = [gauss(space, part) for part in parts]
    values = np.vstack([columns(space, part, u) for part, (u, _) in zip(parts, rules, strict=True)])
    return reach_of(space, values, np.concatenate([weight for _, weight in rules]))


def reach_of(space: LawSpace, values: Array, weights: Array) -> Reach | None:
    """A bound of the mean of |c| by any affine function of the law, from its columns and weights at places."""
    unit = power_of_two(float(np.abs(values).max(initial=0.0)))
    near = _reach_of(space, values / unit, weights)
    if near is None:
        return None
    turning = None if near.turning is None else (near.turning[0], near.turning[1] * unit)
    return replace(near, pulls=near.pulls / unit, turning=turning)


def _reach_of(space: LawSpace, values: Array, weights: Array) -> Reach | None:
    fixed, free = feasible_directions(space)
    rows, right = values[:, :-1] @ free, -(values[:, :-1] @ fixed + values[:, -1])
    inverse = np.linalg.pinv(rows)
    if np.abs(inverse @ rows - np.eye(free.shape[1])).max(initial=0.0) * space.terms > _INVERSE_AGREES:
        return None
    rule = space.quadrature(_ORDER)
    moved = rule.values[:, :-1] @ free @ inverse
    pulls = rule.weights @ np.abs(moved)
    still = rule.values[:, :-1] @ fixed + rule.values[:, -1]
    offset = float(rule.weights @ np.abs(moved @ right + still))
    if not float(pulls.sum()) + offset < _LARGEST:
        return None
    return Reach(pulls, offset, weights, _turning(rows, right, weights))


def by_norm(space: LawSpace, rows: Array) -> tuple[SizeBound, ...]:
    """A bound of the RMS of c in laws of a space by the norm of rows; nothing if they do not determine c.

    The factor is the inverse of the least singular value of the map from c to the rows.
    """
    rule = space.quadrature(2)
    bent = np.sqrt(rule.weights)[:, None] * rule.values
    fixed, free = feasible_directions(space)
    point = np.append(fixed, 1.0)
    triangle: Array = np.asarray(np.linalg.qr(bent[:, :-1] @ free, mode="r"))
    if not free.size or np.linalg.matrix_rank(triangle) < triangle.shape[1]:
        return ()
    least = float(np.linalg.svd(rows[:, :-1] @ free @ np.linalg.inv(triangle), compute_uv=False)[-1])
    if least * _MOST_GAIN < float(np.linalg.norm(rows)) / max(float(np.linalg.norm(bent)), 1.0):
        return ()
    factor = _ROOM / least
    offset = _ROOM * float(np.linalg.norm(bent @ point)) + factor * float(np.linalg.norm(rows @ point))
    return (SizeBound(2, factor, offset),)


def by_squares(space: LawSpace, square: SumOfSquares) -> SizeBound | None:
    """A bound of the RMS of c in laws of a space, by a sum of squares of affine functions.

    Those in which it is at most t are an ellipsoid about the law in which it is least, whose size grows with the root
    of t: that is at most its tangent where t is twice the least. None where the sum does not determine the law.
    """
    if square.root:
        return next(iter(by_norm(space, square.rows)), None)
    rule = space.quadrature(_ORDER)
    bent = np.sqrt(rule.weights)[:, None] * rule.values
    fixed, free = feasible_directions(space)
    rows, height = square.rows[:, :-1] @ free, square.rows @ np.append(fixed, 1.0)
    if not free.size or len(rows) < free.shape[1]:
        return None
    directions, way = np.linalg.qr(rows)
    sizes = np.linalg.svd(way, compute_uv=False)
    if sizes[-1] * _MOST_GAIN <= sizes[0]:
        return None
    back = np.linalg.inv(way)
    fixed = fixed - free @ (back @ (directions.T @ height + back.T @ (square.affine[:-1] @ free) / 2.0))
    lowest = np.append(fixed, 1.0)
    least = float(((square.rows @ lowest) ** 2).sum() + square.affine @ lowest)
    gain, root = float(np.linalg.norm(bent[:, :-1] @ free @ back, 2)), float(np.sqrt(max(abs(least), _LEAST_SQUARES)))
    factor = _ROOM * gain / (2.0 * root)
    offset = _ROOM * (float(np.linalg.norm(bent @ lowest)) + gain * root / 2.0)
    return SizeBound(_ORDER, factor, offset - factor * (least - (_ROUNDED - 1.0) * abs(least)))


def feasible_directions(space: LawSpace) -> tuple[Array, Array]:
    """Coordinates that keep the space's equations, and in which directions they may be left without breaking one."""
    equations = space.equations()
    if not equations:
        return np.zeros(space.terms), np.eye(space.terms)
    matrix, right = (np.array(part) for part in zip(*((each.row, each.right) for each in equations), strict=True))
    _, sizes, directions = np.linalg.svd(matrix)
    rank = int((sizes > SIZE_RANK * sizes.max()).sum())
    return np.linalg.lstsq(matrix, right, rcond=None)[0], directions[rank:].T


def _turning(rows: Array, right: Array, weights: Array) -> tuple[Array, float] | None:
    """Weights above 0 of the places whose sum with f is the same in every law, near to the rule's own if such are."""
    turning = _balanced(rows, weights, weights)
    if (turning <= _POSITIVE_WEIGHTS * weights).any():
        even = _evenly(rows, weights)
        turning = turning if even is None else _balanced(rows, weights, even)
    if (turning <= _POSITIVE_WEIGHTS * weights).any():
        return None
    return turning, -float(turning @ right)


def _balanced(rows: Array, weights: Array, near: Array) -> Array:
    """The weights nearest to given ones for which the weighted sum does not depend on the law."""
    roots = np.sqrt(weights)
    scaled = roots[:, None] * rows
    return np.asarray(near - roots * (scaled @ np.linalg.lstsq(scaled, near / roots, rcond=None)[0]))


def _evenly(rows: Array, weights: Array) -> Array | None:
    """Weights in the null space whose least share of the rule's weights is greatest; None if there are none.

    They are above 0 wherever no direction lowers f at every place.
    """
    from scipy.optimize import linprog

    # the rule's own times the least share, and what there is more
    moved = (weights[:, None] * rows).T
    matrix = np.vstack([np.column_stack([moved, moved.sum(axis=1)]), np.append(weights, weights.sum())])
    matrix[:-1] /= np.maximum(np.abs(matrix[:-1]).max(axis=1, keepdims=True), TINY)
    right, cost = np.zeros(len(matrix)), np.zeros(matrix.shape[1])
    right[-1], cost[-1] = weights.sum(), -1.0
    optimum = linprog(cost, A_eq=matrix, b_eq=right, method="highs")
    return None if optimum.x is None else weights * (optimum.x[:-1] + optimum.x[-1])


def by_integral(space: LawSpace, motion: MotionFormula) -> SizeBound | None:
    """A priori bounds of laws in which the integral of a convex formula is small."""
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
    if known is None or not sum(known) < _LARGEST:
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
    x, share = gauss_rule(space.degree_of(0) // 2 + _CELLS)
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
    """Bounds of all coordinates: a factor times the integral, plus an offset."""
    from scipy.optimize import linprog

    cells, formulas, count = slopes.shape
    flat, heights = slopes.reshape(-1, count), heights.ravel()
    sums = np.kron(np.eye(cells), np.ones(formulas))
    matrix, right = np.vstack([flat.T, sums]), np.append(np.zeros(count), np.ones(cells))
    cost = np.append(np.zeros(cells * formulas), -1.0)
    # the shares are at least the last variable, which is as great as may be
    shifted = np.column_stack([matrix, matrix.sum(axis=1)])
    optimum = linprog(cost, A_eq=shifted, b_eq=right, method="highs")
    if optimum.x is None or optimum.x[-1] < _POSITIVE_LEVEL:
        return None
    inverse = np.linalg.pinv(matrix)
    level = optimum.x[:-1] + optimum.x[-1]
    level = level - inverse @ (matrix @ level - right)
    moved = inverse[:, :count]
    off = float(np.abs(matrix @ moved - np.eye(count + cells)[:, :count]).max(initial=0.0))
    if off > _BALANCED or (level <= 0.0).any():
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
    family = replace(plain, root=True) if root else plain
    bound = by_squares(space, family.squares(1.0)) if family.quadratic else None
    bound = bound or _by_tangents(space, plain, family)
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
    if sizes[0] <= _FLAT_INTEGRAL * sizes[-1]:
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
    """The bound that follows from weighted tangents."""
    rule = space.quadrature(2)
    means = rule.weights @ np.abs(rule.values[:, :-1] @ steps)
    factors = shares.sum(axis=1).reshape(2, -1).max(axis=0)
    beside = -(shares @ heights).reshape(2, -1).min(axis=0)
    return SizeBound.of_acceleration(float(factors @ means), float(beside @ means) + _mean_acceleration(space, lowest))


def _value(family: IntegralFamily, x: Array) -> float:
    return float(family.value(x, np.ones(1))[0])


def _hessian(family: IntegralFamily, x: Array) -> Array:
    return np.asarray(family.hessian(x, np.ones(1), np.ones(1)))


def _lowest(family: IntegralFamily, x: Array, free: Array) -> Array:
    """An approximate minimiser of the integral, by Newton's method with halved steps."""
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
        if before - value <= _REACH_SETTLED * abs(value):
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
    """Nonnegative weights of tangents that isolate each coordinate in turn, with both signs."""
    count = slopes.shape[1]
    units = np.vstack([np.eye(count), -np.eye(count)])
    if len(slopes) < 2 * count + 1 or not np.isfinite(slopes).all():
        return None
    inverse = np.linalg.pinv(slopes.T)
    level = np.ones(len(slopes)) - inverse @ slopes.sum(axis=0)
    if level.min() < _POSITIVE_SHARES:
        return None
    shares = units @ inverse.T
    shares = shares + np.maximum((-shares / level).max(axis=1), 0.0)[:, None] * level
    return shares if np.abs(shares @ slopes - units).max() <= _BALANCED else None


def known_values(motion: MotionFormula, conditions: BoundaryConditions) -> list[tuple[float, float]]:
    """Values of a formula at the ends or in the mean that follow from the end conditions, with rounding sizes.

    Examples
    --------
    >>> from optlaws.formulas.of_motion import of_text
    >>> from optlaws import BoundaryConditions
    >>> known_values(of_text("c + 2*b"), BoundaryConditions.rest(3))
    [(0.0, 8.0), (0.0, 8.0), (2.0, 2.0)]
    """
    values = []
    for k, end in ((0.0, conditions.start), (1.0, conditions.end)):
        if motion.start <= k <= motion.stop and max(motion.orders, default=0) < len(end):
            value = motion.values({"k": k, **{name: end[nu] for name, nu in ORDERS.items() if nu < len(end)}})
            values.append((float(value), max(motion.scale, abs(float(value)))))
    terms = _mean_terms(motion, conditions)
    return values if terms is None else [*values, (sum(terms), sum(map(abs, terms)))]


def _mean_terms(motion: MotionFormula, conditions: BoundaryConditions) -> list[float] | None:
    """Terms of the mean of a formula with constant factors; None for other formulas."""
    plain = motion.constant_weights()
    known = range(1, len(conditions.start) + 1)
    whole = motion.affine is not None and (motion.start, motion.stop) == (0.0, 1.0)
    if plain is None or not whole or any(nu not in known for nu in plain[0]):
        return None
    weights, rest = plain
    return [*(w * (conditions.end[nu - 1] - conditions.start[nu - 1]) for nu, w in weights.items()), rest]
