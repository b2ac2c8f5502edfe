"""What bounds a law in which a formula is small, and what a formula is at least whatever the law."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.vocabulary import ORDERS
from optlaws.numbers import Array, power_of_two
from optlaws.numerics.tolerances import INVERSE_AGREES, POSITIVE_WEIGHTS, SIZE_RANK, TINY
from optlaws.synthesis.families.squares import SumOfSquares
from optlaws.synthesis.functionals.affine_rows import columns, gauss
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace


_ROUNDED = 1.0 + 1e-6
_ORDER = 2
_MOST_GAIN = 1e6
_ROOM = 1.01
#: the least sum of squares, in its unit, by whose root another is bounded
_LEAST = 1e-3
#: beyond this a bound says nothing
_LARGEST = 1e13


@dataclass(frozen=True, eq=False)
class Reach:
    """By how much values of a formula at places move the mean of |c|: sum of pulls times |f| plus the offset.

    Attributes
    ----------
    pulls
        One for each place.
    offset
        What is there without the formula.
    weights
        Of the places: the sum of weights times f² is the integral of f².
    turning
        Weights above 0 whose sum with f is the same in every law, None where there are none; and that sum.
    """

    pulls: Array
    offset: float
    weights: Array
    turning: tuple[Array, float] | None = None

    def by_peak(self) -> tuple[int, float, float]:
        """The bound for a formula whose magnitude is at most 1."""
        return _ORDER, _ROUNDED * float(self.pulls.sum()), _ROUNDED * self.offset

    def by_square(self) -> tuple[int, float, float]:
        """The bound for a formula whose square's integral is 1, by Cauchy's inequality."""
        return _ORDER, _ROUNDED * float(np.sqrt((self.pulls**2 / self.weights).sum())), _ROUNDED * self.offset

    def by_one_sign(self, sign: float) -> tuple[int, float, float] | None:
        """The bound for a formula that is at most 1 with a sign: what is above 0 less what is below is known."""
        if self.turning is None:
            return None
        turning, fixed = self.turning
        share = float((self.pulls / turning).max())
        most = 2.0 * share * float(turning.sum())
        return _ORDER, _ROUNDED * most, _ROUNDED * (self.offset + share * max(-sign * fixed, 0.0))


def reach(space: LawSpace, parts: tuple[MotionFormula, ...]) -> Reach | None:
    """How an affine formula's values bound the laws of a space; None where they do not, or hardly.

    The law's coordinates are a linear function of enough values of the formula, and so is its acceleration.
    """
    rules = [gauss(space, part) for part in parts]
    values = np.vstack([columns(space, part, u) for part, (u, _) in zip(parts, rules, strict=True)])
    return reach_of(space, values, np.concatenate([weight for _, weight in rules]))


def reach_of(space: LawSpace, values: Array, weights: Array) -> Reach | None:
    """The same of anything that is affine in the law, by its columns at places and the weights of these."""
    unit = power_of_two(float(np.abs(values).max(initial=0.0)))
    near = _reach_of(space, values / unit, weights)
    if near is None:
        return None
    turning = None if near.turning is None else (near.turning[0], near.turning[1] * unit)
    return replace(near, pulls=near.pulls / unit, turning=turning)


def _reach_of(space: LawSpace, values: Array, weights: Array) -> Reach | None:
    fixed, free = kept_directions(space)
    rows, right = values[:, :-1] @ free, -(values[:, :-1] @ fixed + values[:, -1])
    inverse = np.linalg.pinv(rows)
    if np.abs(inverse @ rows - np.eye(free.shape[1])).max(initial=0.0) * space.terms > INVERSE_AGREES:
        return None
    rule = space.quadrature(_ORDER)
    moved = rule.values[:, :-1] @ free @ inverse
    pulls = rule.weights @ np.abs(moved)
    still = rule.values[:, :-1] @ fixed + rule.values[:, -1]
    offset = float(rule.weights @ np.abs(moved @ right + still))
    if not float(pulls.sum()) + offset < _LARGEST:
        return None
    return Reach(pulls, offset, weights, _turning(rows, right, weights))


def by_norm(space: LawSpace, rows: Array) -> tuple[tuple[int, float, float], ...]:
    """What the RMS of c is at most in laws of a space, by the norm of rows: the least singular value of the way back.

    Nothing where the rows do not determine the law.
    """
    rule = space.quadrature(2)
    bent = np.sqrt(rule.weights)[:, None] * rule.values
    fixed, free = kept_directions(space)
    kept = np.append(fixed, 1.0)
    way: Array = np.asarray(np.linalg.qr(bent[:, :-1] @ free, mode="r"))
    if np.linalg.matrix_rank(way) < way.shape[1]:
        return ()
    least = float(np.linalg.svd(rows[:, :-1] @ free @ np.linalg.inv(way), compute_uv=False)[-1])
    if least * _MOST_GAIN < float(np.linalg.norm(rows)) / max(float(np.linalg.norm(bent)), 1.0):
        return ()
    factor = _ROOM / least
    return ((2, factor, _ROOM * float(np.linalg.norm(bent @ kept)) + factor * float(np.linalg.norm(rows @ kept))),)


def by_squares(space: LawSpace, square: SumOfSquares) -> tuple[int, float, float] | None:
    """What the RMS of c is at most in laws of a space, by a sum of squares of what is affine in them.

    Those in which it is at most t are an ellipsoid about the law in which it is least, whose size grows with the root
    of t: that is at most its tangent where t is twice the least. None where the sum does not determine the law.
    """
    if square.root:
        return next(iter(by_norm(space, square.rows)), None)
    rule = space.quadrature(_ORDER)
    bent = np.sqrt(rule.weights)[:, None] * rule.values
    fixed, free = kept_directions(space)
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
    gain, root = float(np.linalg.norm(bent[:, :-1] @ free @ back, 2)), float(np.sqrt(max(abs(least), _LEAST)))
    factor = _ROOM * gain / (2.0 * root)
    offset = _ROOM * (float(np.linalg.norm(bent @ lowest)) + gain * root / 2.0)
    return _ORDER, factor, offset - factor * (least - (_ROUNDED - 1.0) * abs(least))


def kept_directions(space: LawSpace) -> tuple[Array, Array]:
    """Coordinates that keep the space's equations, and in which directions they may be left without breaking one."""
    equations = space.equations()
    if not equations:
        return np.zeros(space.terms), np.eye(space.terms)
    matrix, right = (
        np.array([equation.row for equation in equations]),
        np.array([equation.right for equation in equations]),
    )
    _, sizes, directions = np.linalg.svd(matrix)
    rank = int((sizes > SIZE_RANK * sizes.max()).sum())
    return np.linalg.lstsq(matrix, right, rcond=None)[0], directions[rank:].T


def _turning(rows: Array, right: Array, weights: Array) -> tuple[Array, float] | None:
    """Weights above 0 of the places whose sum with f is the same in every law, near to the rule's own if such are."""
    turning = _balanced(rows, weights, weights)
    if (turning <= POSITIVE_WEIGHTS * weights).any():
        even = _evenly(rows, weights)
        turning = turning if even is None else _balanced(rows, weights, even)
    if (turning <= POSITIVE_WEIGHTS * weights).any():
        return None
    return turning, -float(turning @ right)


def _balanced(rows: Array, weights: Array, near: Array) -> Array:
    """The weights nearest to given ones that no law moves."""
    roots = np.sqrt(weights)
    scaled = roots[:, None] * rows
    moved: Array = near - roots * (scaled @ np.linalg.lstsq(scaled, near / roots, rcond=None)[0])
    return moved


def _evenly(rows: Array, weights: Array) -> Array | None:
    """Of the weights that no law moves those whose least share of the rule's own is greatest; None if there are none.

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


def known_values(motion: MotionFormula, conditions: BoundaryConditions) -> list[tuple[float, float]]:
    """What the end conditions say a formula is at an end, or in the mean; each with a size that its rounding has.

    Examples
    --------
    >>> from optlaws.formulas.of_motion import of_text
    >>> from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
    >>> known_values(of_text("c + 2*b"), BoundaryConditions.rest(3))
    [(0.0, 8.0), (0.0, 8.0), (2.0, 2.0)]
    """
    values = []
    for k, end in ((0.0, conditions.start), (1.0, conditions.end)):
        if motion.start <= k <= motion.stop and max(motion.orders, default=0) < len(end):
            value = motion.values({"k": k, **{name: end[nu] for name, nu in ORDERS.items() if nu < len(end)}})
            values.append((float(value), max(motion.scale, abs(float(value)))))
    mean = mean_value(motion, conditions)
    return values if mean is None else [*values, (mean, _mean_size(motion, conditions))]


def mean_value(motion: MotionFormula, conditions: BoundaryConditions) -> float | None:
    """The mean over the whole interval of a formula whose factors are numbers; None where it is not known."""
    terms = _mean_terms(motion, conditions)
    return None if terms is None else sum(terms)


def _mean_size(motion: MotionFormula, conditions: BoundaryConditions) -> float:
    return sum(map(abs, _mean_terms(motion, conditions) or []))


def _mean_terms(motion: MotionFormula, conditions: BoundaryConditions) -> list[float] | None:
    plain = motion.constant_weights()
    known = range(1, len(conditions.start) + 1)
    whole = motion.affine is not None and (motion.start, motion.stop) == (0.0, 1.0)
    if plain is None or not whole or any(nu not in known for nu in plain[0]):
        return None
    weights, rest = plain
    return [*(w * (conditions.end[nu - 1] - conditions.start[nu - 1]) for nu, w in weights.items()), rest]
