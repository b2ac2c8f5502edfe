"""What bounds a law in which a formula is small, and what a formula is at least whatever the law."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.vocabulary import ORDERS
from optlaws.numbers import Array, power_of_two
from optlaws.numerics.tolerances import INVERSE_AGREES, POSITIVE_WEIGHTS, SIZE_RANK, TINY
from optlaws.synthesis.functionals.affine_rows import columns, gauss
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace


_ROUNDED = 1.0 + 1e-6
_ORDER = 2
_MOST_GAIN = 1e6
_ROOM = 1.01
#: beyond this a bound says nothing
LARGEST = 1e13


class SizeBound(NamedTuple):
    """The mean magnitude of a derivative of some order is at most a factor times a constant, plus an offset."""

    order: int
    factor: float
    offset: float

    @classmethod
    def of_acceleration(cls, factor: float, offset: float) -> Self:
        """The bound of |c|, with room for rounding."""
        return cls(_ORDER, _ROUNDED * factor, _ROUNDED * offset)

    def times(self, share: float) -> Self:
        """The bound by another constant, of which this one is at most a share."""
        return self._replace(factor=self.factor * share)


@dataclass(frozen=True, eq=False)
class Reach:
    """By how much values of a formula at places move the mean of |c|: sum of pulls times |f| plus the offset."""

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
    """The same of anything that is affine in the law, by its columns at places and the weights of these."""
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
    if np.abs(inverse @ rows - np.eye(free.shape[1])).max(initial=0.0) * space.terms > INVERSE_AGREES:
        return None
    rule = space.quadrature(_ORDER)
    moved = rule.values[:, :-1] @ free @ inverse
    pulls = rule.weights @ np.abs(moved)
    still = rule.values[:, :-1] @ fixed + rule.values[:, -1]
    offset = float(rule.weights @ np.abs(moved @ right + still))
    if not float(pulls.sum()) + offset < LARGEST:
        return None
    return Reach(pulls, offset, weights, _turning(rows, right, weights))


def by_norm(space: LawSpace, rows: Array) -> tuple[SizeBound, ...]:
    """What the RMS of c is at most in laws of a space, by the norm of rows; nothing where they do not determine c.

    The factor is the inverse of the least singular value of the map from c to the rows.
    """
    rule = space.quadrature(2)
    bent = np.sqrt(rule.weights)[:, None] * rule.values
    fixed, free = feasible_directions(space)
    point = np.append(fixed, 1.0)
    triangle: Array = np.asarray(np.linalg.qr(bent[:, :-1] @ free, mode="r"))
    if np.linalg.matrix_rank(triangle) < triangle.shape[1]:
        return ()
    least = float(np.linalg.svd(rows[:, :-1] @ free @ np.linalg.inv(triangle), compute_uv=False)[-1])
    if least * _MOST_GAIN < float(np.linalg.norm(rows)) / max(float(np.linalg.norm(bent)), 1.0):
        return ()
    factor = _ROOM / least
    offset = _ROOM * float(np.linalg.norm(bent @ point)) + factor * float(np.linalg.norm(rows @ point))
    return (SizeBound(2, factor, offset),)


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
    return np.asarray(near - roots * (scaled @ np.linalg.lstsq(scaled, near / roots, rcond=None)[0]))


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
    terms = _mean_terms(motion, conditions)
    return values if terms is None else [*values, (sum(terms), sum(map(abs, terms)))]


def _mean_terms(motion: MotionFormula, conditions: BoundaryConditions) -> list[float] | None:
    """What adds up to the mean over the whole interval of a formula whose factors are numbers; None of others."""
    plain = motion.constant_weights()
    known = range(1, len(conditions.start) + 1)
    whole = motion.affine is not None and (motion.start, motion.stop) == (0.0, 1.0)
    if plain is None or not whole or any(nu not in known for nu in plain[0]):
        return None
    weights, rest = plain
    return [*(w * (conditions.end[nu - 1] - conditions.start[nu - 1]) for nu, w in weights.items()), rest]
