"""A priori bounds of laws in which a constant is small, and lower bounds of formulas in all laws.

A convex function is nowhere below its tangents. Weighted sums of enough of them leave the acceleration at one place
alone: it is at most the sum of the weights times the constant, and more.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.tree import ORDERS
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import nodes
from optlaws.synthesis.families.family import BatchFamily, LinearFamily
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.tolerances import SIZE_RANK, TINY

if TYPE_CHECKING:
    from optlaws.synthesis.problem.constants import Functional
    from optlaws.synthesis.spaces.space import LawSpace

_SUM_AGREES = 1e-9  # of an acceleration: what the weighted sum of rows may miss of it
_LARGEST = 1e13  # beyond this a bound says nothing
_MARGIN = 1e-6  # of a bound, for rounding

_ORDER = 2
_RISING = 1e-3  # of its slope: how much a tangent must rise in a direction
_DISTANCES = tuple(4.0**n for n in range(6))  # from the law of least RMS acceleration, by that
_MOST_TANGENTS = 200


def size_bounds(constant: Functional, space: LawSpace) -> tuple[tuple[int, float, float], ...]:
    """A bound of the mean of |c| in every law of a space: the order 2, a factor of the constant, and an offset.

    Empty where the constant's rows do not determine the acceleration, or hardly. The space caches it.

    Examples
    --------
    >>> from optlaws import BoundaryConditions, Chebyshev, peak
    >>> from optlaws.synthesis.spaces.of_basis import space_of
    >>> space = space_of(Chebyshev(3), BoundaryConditions.rest(2), symmetric=False)
    >>> [(order, factor, offset)] = size_bounds(peak("c"), space)
    >>> order, round(factor, 2), round(offset, 2)
    (2, 1.39, 3.24)
    """
    known = space.cached(("size", constant.name), lambda: np.array(_bound(constant, space)))
    return ((_ORDER, float(known[0]), float(known[1])),) if len(known) else ()


def _bound(constant: Functional, space: LawSpace) -> tuple[float, ...]:
    """The factor and the offset; empty where there are none."""
    rule = space.quadrature(_ORDER)
    law, steps = _directions(space)
    values, still = rule.values[:, :-1] @ steps, rule.values @ np.append(law, 1.0)
    rows_of_constant = constant.families(space, np.append(np.zeros(space.terms), 1.0), 0.0)
    unit = 1.0 if constant.normalised else constant.scale
    families = [family.scaled_down(unit) for family in rows_of_constant]
    proving = [family for family in families if isinstance(family, BatchFamily) and family.proving]
    tangents = Tangents([family for family in proving if not isinstance(family, LinearFamily)], law, steps)
    straight = [family for family in proving if isinstance(family, LinearFamily)]
    twofold = len(straight) == len(proving) and all(len(family.signs) > 1 for family in straight)
    rows = np.vstack([tangents.about(), *(_rows(family, law, steps, twofold=twofold) for family in straight)])
    sums = (_balanced if twofold else tangents.sums)(rows, np.vstack([values, -values]))
    if sums is None:
        return ()
    factors, heights = sums
    offsets = np.append(still, -still) - heights
    factor, offset = (float(rule.weights @ part.reshape(2, -1).max(axis=0)) for part in (factors, offsets))
    known = factor * constant.scale + abs(offset) < _LARGEST
    return ((1.0 + _MARGIN) * factor, offset + _MARGIN * abs(offset)) if known else ()


def _rows(family: LinearFamily, law: Array, steps: Array, *, twofold: bool) -> Array:
    """Rows g . y + h that the constant is at least in laws law + steps y, at nodes; of one sign if `twofold`."""
    low, high = family.domain
    places = family.nodes()
    if places is None:
        places = low + (high - low) * (1.0 + nodes(family.table.terms + 1)) / 2.0
    columns = np.delete(family.columns(places)[0], -2, axis=1) / family.slack[-1]
    rows = np.column_stack([columns[:, :-1] @ steps, columns @ np.append(law, 1.0)])
    sizes = np.linalg.norm(rows[:, :-1], axis=1)
    rows = rows[sizes > SIZE_RANK * sizes.max(initial=0.0)]
    return np.vstack([sign * rows for sign in family.signs[: 1 if twofold else None]])


def _balanced(rows: Array, targets: Array) -> tuple[Array, Array] | None:
    """Sums of the magnitudes of weights with which rows add up to targets, and of weights times heights."""
    size = np.linalg.norm(rows, axis=1).max(initial=TINY)
    weights = targets @ np.linalg.pinv(rows[:, :-1] / size) / size
    if np.abs(weights @ rows[:, :-1] - targets).max(initial=0.0) > _SUM_AGREES * np.abs(targets).max(initial=0.0):
        return None
    return np.abs(weights).sum(axis=1), weights @ rows[:, -1]


@dataclass(frozen=True, eq=False)
class Tangents:
    """Rows g . y + h of convex families in laws law + steps y."""

    families: Sequence[BatchFamily]
    law: Array
    steps: Array

    def about(self) -> Array:
        """The rows that touch to either side in each direction, at two distances."""
        unit = np.eye(self.steps.shape[1])
        places = [distance * side for distance in _DISTANCES[:2] for side in (*unit, *-unit)]
        return np.vstack([np.empty((0, len(unit) + 1)), *map(self.at, places if self.families else [])])

    def at(self, y: Array) -> Array:
        """The rows that touch in a law, each in the mean over places; none where a formula overflows."""
        x, rows = np.append(self.law + self.steps @ y, 0.0), []
        with np.errstate(all="ignore"):
            for family, u in zip(self.families, self._places, strict=True):
                jet = family.jet(x, u, np.full(len(u), family.signs[0]))
                slope = jet.gradient[:, :-1].mean(axis=0) @ self.steps
                rows.append(np.append(slope, jet.value.mean() - slope @ y) / family.slack[-1])
        return np.array([row for row in rows if np.isfinite(row).all()]).reshape(-1, self.steps.shape[1] + 1)

    @kept_property
    def _places(self) -> list[Array]:
        """A family's nodes and the middles between them, or its one place."""
        every = [
            np.array(family.domain[:1]) if (u := family.nodes()) is None else np.sort(u) for family in self.families
        ]
        return [np.concatenate([u, (u[1:] + u[:-1]) / 2.0]) for u in every]

    def sums(self, rows: Array, targets: Array) -> tuple[Array, Array] | None:
        """The same of weights of at least 0; where these miss a target, rows join that rise where they miss it."""
        sums, least = [], _SUM_AGREES * float(np.linalg.norm(targets, axis=1).max(initial=0.0))
        for target in targets:
            # the tangent in its own direction, whose weight alone is often enough
            rows = np.vstack([self.at(target / max(float(np.linalg.norm(target)), TINY)), rows])
            for _ in range(_MOST_TANGENTS):
                weights = nonnegative_weights(rows[:, :-1], target)
                missed = target - weights @ rows[:, :-1]
                off = float(np.linalg.norm(missed))
                further = self._beyond(missed / off) if off > least else rows[:0]
                rows = np.vstack([rows, further])
                if not len(further):
                    break
            if off > least:
                return None
            sums.append((weights.sum(), weights @ rows[:, -1]))
        totals, heights = np.array(sums).reshape(-1, 2).T
        return totals, heights

    def _beyond(self, direction: Array) -> Array:
        """Rows that rise in a direction, touching as near as there are some."""
        for distance in _DISTANCES if self.families else ():
            rows = self.at(distance * direction)
            rising = rows[:, :-1] @ direction > _RISING * np.linalg.norm(rows[:, :-1], axis=1)
            if rising.any():
                return np.asarray(rows[rising])
        return np.empty((0, len(direction) + 1))


def nonnegative_weights(rows: Array, target: Array) -> Array:
    """Weights, none below 0, with which rows come nearest to a target."""
    from scipy.optimize import nnls

    sizes = np.maximum(np.linalg.norm(rows, axis=1), TINY)
    weights: Array = np.zeros(len(rows))
    if len(rows):  # without any it would end the process
        with suppress(RuntimeError):  # its steps may be too many
            weights = nnls((rows / sizes[:, None]).T, target)[0] / sizes
    return weights


def _directions(space: LawSpace) -> tuple[Array, Array]:
    """The law of least RMS acceleration that keeps the equations, and its directions, each of the same RMS."""
    rule, equations = space.quadrature(_ORDER), space.equations()
    columns = np.sqrt(rule.weights)[:, None] * rule.values
    law, free = np.zeros(space.terms), np.eye(space.terms)
    if equations:
        matrix, right = (np.array(part) for part in zip(*((each.row, each.right) for each in equations), strict=True))
        _, sizes, directions = np.linalg.svd(matrix)
        rank = int((sizes > SIZE_RANK * sizes.max()).sum())
        law, free = np.linalg.lstsq(matrix, right, rcond=None)[0], directions[rank:].T
    values = columns[:, :-1] @ free
    law = law - free @ np.linalg.lstsq(values, columns @ np.append(law, 1.0), rcond=None)[0]
    _, sizes, directions = np.linalg.svd(values)
    # what has no acceleration is as long as the others
    lengths = np.full(len(directions), sizes.max(initial=TINY))
    lengths[: len(sizes)] = np.where(sizes > SIZE_RANK * lengths[: len(sizes)], sizes, lengths[: len(sizes)])
    return law, free @ directions.T * (float(np.linalg.norm(columns @ np.append(law, 1.0))) or 1.0) / lengths


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
