"""Certification of many laws at once: whether each keeps every row everywhere, and what its multipliers prove.

The bounds are those that contacts and multipliers prove as certificates do, rounded outward.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil, log

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.arrays.newton_steps import States, Structure, batch_families, locally_optimal, product, with_one
from optlaws.synthesis.arrays.programs import Numbers, Path
from optlaws.synthesis.families.family import BatchFamily
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.duality import AprioriBounds, Sublevel, bounds_within, charge, roundings, weighted

#: claims are taken from a geometric row, upward: what is known of laws below them is known of all before
_CLAIMS, _ABOVE = 1.01, 1.0 + 2.0**-40


def lower_bounds(path: Path, structure: Structure, numbers: Numbers, states: States, value: Array) -> Array:
    """Lower bounds of the objectives; negative multipliers count as zero.

    Parameters
    ----------
    path, structure, numbers, states
        The laws' programs and their states; one state may stand for all, if its contacts and multipliers are theirs
        and their costs are one.
    value
        The rows of the contacts, less the right sides' variables, shape (laws, contacts, variables + 1).
    """
    program = path.model.program
    weights, equations = np.maximum(states.weights, 0.0), states.equations
    cost = numbers.cost[: len(states)]
    rows = value[:, :, :-1]
    slope = cost + weighted(weights, rows) + equations @ program.equalities
    right = value[:, :, -1] - numbers.bounds[:, structure.family]
    plain = (weights * right).sum(axis=1) - (equations * numbers.right).sum(axis=1)
    count = roundings(structure.count + len(program.equalities))
    sizes = np.abs(equations)
    blur = weighted(weights, np.abs(rows)) + sizes @ np.abs(program.equalities) + np.abs(cost)
    unseen = structure.rounding_errors(states.x, states.u, weights)
    blur = count * blur + unseen[:, :-1]
    hidden = (weights * np.abs(right)).sum(axis=1) + (sizes * np.abs(numbers.right)).sum(axis=1)
    hidden = count * hidden + unseen[:, -1]
    claim = path.model.unit * float(plain.max(initial=0.0))
    return np.asarray(path.model.unit * (plain - hidden - charge(path.model, _below(path, claim), slope, blur)))


def _below(path: Path, claim: float) -> AprioriBounds:
    """Bounds of constants in laws of the path below the claim, or below one slightly above it."""
    step = ceil(log(claim) / log(_CLAIMS)) if claim > 0.0 else None
    if step not in path.bounds_below_claim:
        greatest: dict[str, float] = {}
        for problem in path.problems:
            model: Model = replace(path.model, problem=problem)
            most = 0.0 if step is None else _CLAIMS**step * _ABOVE
            for name, value in Sublevel.of(model).greatest_values(most).items():
                greatest[name] = max(greatest.get(name, 0.0), value)
        path.bounds_below_claim[step] = bounds_within(path.model, greatest)
    below: AprioriBounds = path.bounds_below_claim[step]
    return below


_CERTIFIED_EXCESS = 1e-11  # of a right side, or 1: by so much a row of a certified law may be broken
_SHARP_GAP = 5e-12  # of an objective: a bound that leaves more is computed more sharply, at a law solved to the end
_CURVED_GAP = 9e-11  # of an objective: what the bound of a proven law of curved rows may leave
_GREAT_MULTIPLIERS = 1e-9  # of an objective: what rounding may leave of it where multipliers are great
_CERTIFIED_PULL = 1e-12  # of the greatest multiplier: by so much one may be below 0, for which the bound counts it as 0
_INWARD = 0.25  # of a domain: how far inward the slope of a row at an end counts
_SMALL_OBJECTIVE = 1e-6  # of an objective's scale: one that is less is measured by that


@dataclass(frozen=True, eq=False)
class Certification:
    """Objectives, lower bounds and what is broken of many laws."""

    #: objective, bound: what each law is worth, and what is proven that no law is below
    objective: Array
    bound: Array
    excess: Array  #: by how much a row may be broken anywhere, relative to its right side or 1
    pull: Array  #: how far the least multiplier is below 0, relative to the greatest; negative above it
    #: whether no law beside it is better, where that does not follow from the bound: of problems that are not convex
    #: the bound is that of their rows' planes at the law
    best: NDArray[np.bool_]
    affine: bool  #: whether all rows are affine, so that a gap that is left is one of rounding
    scale: float  #: of the objective

    @property
    def sound(self) -> NDArray[np.bool_]:
        """A mask of states that are proven optimal, or locally optimal if the problem is not convex."""
        meets = self.gap <= (_GREAT_MULTIPLIERS if self.affine else _CURVED_GAP)
        return np.asarray(meets & (self.excess <= _CERTIFIED_EXCESS) & (self.pull <= _CERTIFIED_PULL) & self.best)

    @property
    def sharp(self) -> NDArray[np.bool_]:
        """A mask of states whose gap is so small that Newton's method cannot reduce it."""
        return np.asarray(self.sound & (self.gap <= _SHARP_GAP))

    @property
    def gap(self) -> Array:
        """Between objective and bound, as a share of the objective."""
        unit = np.where(np.abs(self.objective) > _SMALL_OBJECTIVE * self.scale, np.abs(self.objective), self.scale)
        return np.asarray(np.abs(self.objective - self.bound) / unit)


def certification_of(path: Path, structure: Structure, numbers: Numbers, states: States) -> Certification:
    """Certification of states of one structure; NaN and infinities are no laws."""
    program, families = path.model.program, batch_families(path.model)
    value, slope, _ = structure.jets(states.x, states.u)
    value[:, :, :-1] -= structure.slack
    point = with_one(states.x)
    residual = product(value, point) - numbers.bounds[:, structure.family]
    room = states.x @ structure.slacks.T + numbers.bounds
    # where a row grows inward from a contact at its end the contact is to move, however little it is broken
    ways = np.where(states.u >= structure.domains[:, 1], -1.0, 1.0)
    inward = product(slope, point) * np.where(structure.at_end, ways, 0.0)
    broken = np.maximum(residual, _INWARD * inward) / np.maximum(1.0, np.abs(room))[:, structure.family]
    off = np.abs(states.x @ program.equalities.T - numbers.right)
    worst = np.maximum(broken.max(axis=1, initial=0.0), off.max(axis=1, initial=0.0))
    greatest = np.abs(states.weights).max(axis=1, initial=0.0)
    pull = -(states.weights / np.where(greatest == 0.0, 1.0, greatest)[:, None]).min(axis=1, initial=np.inf)
    # whether multipliers prove bounds of the objective
    proving = all(family.proving for family in families)
    return Certification(
        best=np.ones(len(states), dtype=np.bool_) if proving else locally_optimal(structure, states),
        objective=path.model.unit * (states.x * numbers.cost).sum(axis=1),
        bound=lower_bounds(path, structure, numbers, states, value),
        excess=np.maximum(worst, _excess(families, point, room)),
        pull=np.where(np.isfinite(pull), pull, 0.0),
        affine=not program.curved,
        scale=path.model.unit,
    )


def _excess(families: Sequence[BatchFamily], point: Array, room: Array) -> Array:
    """The greatest violation of the rows of any family by each law, relative to the right side or 1."""
    shortfalls = np.zeros(len(point))
    for i, family in enumerate(families):
        over = np.maximum(family.greatest(point) - room[:, i], 0.0) / np.maximum(1.0, np.abs(room[:, i]))
        shortfalls = np.maximum(shortfalls, over)
    return shortfalls
