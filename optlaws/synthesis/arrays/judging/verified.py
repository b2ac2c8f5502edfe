"""Whether states are laws that keep every row everywhere, and what they prove: each law judged by itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.arrays.columns import Columns, CurvedTangents
from optlaws.synthesis.arrays.judging.cells import Cells, Touching, excess
from optlaws.synthesis.arrays.judging.dual_bounds import lower_bounds
from optlaws.synthesis.arrays.newton_steps import States, best_nearby
from optlaws.synthesis.arrays.programs import Numbers, Path
from optlaws.synthesis.arrays.rows import Structure, columns_of, with_one

Array = NDArray[np.float64]

#: of a right side, or 1: by so much a row may be broken
_EXCESS = 1e-11
#: of the objective
_GAP = 9e-11
#: of the greatest multiplier: by so much one may be below 0, for which the bound counts it as 0
_PULL = 1e-12


@dataclass(frozen=True, eq=False)
class Judgement:
    """Objectives, lower bounds and what is broken of many laws.

    Attributes
    ----------
    objective, bound
        What each law is worth, and what is proven that no law is below.
    excess
        By how much a row may be broken anywhere, relative to its right side or 1.
    pull
        How far the least multiplier is below 0, relative to the greatest; negative above it.
    inward
        How fast a residual grows from a contact that is held at an end; negative where it falls.
    best
        Whether no law beside it is better, where that does not follow from the bound: of problems that are not convex
        the bound is that of their rows' planes at the law.
    """

    objective: Array
    bound: Array
    excess: Array
    pull: Array
    inward: Array
    best: NDArray[np.bool_]

    @property
    def broken(self) -> Array:
        """The greatest of what may not be above 0, but for rounding."""
        return np.asarray(np.maximum(np.maximum(self.excess, self.pull), self.inward))

    @property
    def sound(self) -> NDArray[np.bool_]:
        """Which are laws, and proven optimal, or locally so where the problem is not convex."""
        unit = np.where(np.abs(self.objective) > _SMALL, np.abs(self.objective), 1.0)
        meets = np.abs(self.objective - self.bound) <= _GAP * unit
        return np.asarray(meets & (self.excess <= _EXCESS) & (self.pull <= _PULL) & self.best)


_SMALL = 1e-6


def judged(path: Path, structure: Structure, numbers: Numbers, states: States) -> Judgement:
    """What states of one structure are worth; NaN and infinities are no laws."""
    program = path.model.program
    value, slope, _ = structure.jets(states.x, states.u)
    value[:, :, :-1] -= structure.slack
    residual = _at(value, states.x) - numbers.bounds[:, structure.family]
    turned = _at(slope, states.x)
    # toward the inside of the domain
    inward = np.where(states.u >= structure.domains[:, 1], -turned, turned)
    held = structure.held
    tangent = np.where(structure.free, np.abs(turned), np.where(held, np.maximum(inward, 0.0), 0.0))
    reach = np.array([_reach(columns) for columns in columns_of(path.model)])[structure.family]
    room = np.maximum(1.0, np.abs(states.x @ structure.slack.T + numbers.bounds[:, structure.family]))
    broken = (np.maximum(residual, 0.0) + reach * tangent) / room
    off = np.abs(states.x @ program.equalities.T - numbers.right)
    worst = np.maximum(broken.max(axis=1, initial=0.0), off.max(axis=1, initial=0.0))
    for i, columns in enumerate(columns_of(path.model)):
        worst = np.maximum(worst, _excess(columns, i, structure, numbers, states))
    greatest = np.abs(states.weights).max(axis=1, initial=0.0)
    pull = -(states.weights / np.where(greatest == 0.0, 1.0, greatest)[:, None]).min(axis=1, initial=np.inf)
    proving = all(columns.proving for columns in columns_of(path.model))
    return Judgement(
        best=np.ones(len(states), dtype=np.bool_) if proving else best_nearby(structure, states),
        objective=path.model.unit * (states.x * numbers.cost).sum(axis=1),
        bound=lower_bounds(path, structure, numbers, states, value),
        excess=worst,
        pull=np.where(np.isfinite(pull), pull, 0.0),
        inward=np.where(held, inward, -np.inf).max(axis=1, initial=-np.inf),
    )


def _reach(columns: Columns | CurvedTangents) -> float:
    """How far from a contact its tangent is relied on: nowhere, where peaks are recomputed over the whole interval."""
    return 0.0 if isinstance(columns, CurvedTangents) else cells_of(columns).reach


def _excess(
    columns: Columns | CurvedTangents, family: int, structure: Structure, numbers: Numbers, states: States
) -> Array:
    """By how much each law may break the rows of one family anywhere, relative to the right side or 1."""
    if not isinstance(columns, CurvedTangents):
        mine = structure.family == family
        touching = Touching(states.u[:, mine], np.isfinite(states.u[:, mine]))
        return excess(cells_of(columns), states.x, numbers, family, touching)
    own = structure.model.program.families[family]
    room = states.x @ own.slack + numbers.bounds[:, family]
    over = columns.greatest(with_one(states.x)) - room
    return np.asarray(np.maximum(over, 0.0) / np.maximum(1.0, np.abs(room)))


def cells_of(columns: Columns) -> Cells:
    """The cells of a family, kept with its columns."""
    key = id(columns)
    if key not in _KEPT or _KEPT[key].columns is not columns:
        if len(_KEPT) >= _MOST:
            _KEPT.clear()
        _KEPT[key] = Cells(columns)
    return _KEPT[key]


_KEPT: dict[int, Cells] = {}
_MOST = 256


def _at(rows: Array, x: Array) -> Array:
    return np.asarray(np.einsum("mpi,mi->mp", rows[:, :, :-1], x) + rows[:, :, -1])
