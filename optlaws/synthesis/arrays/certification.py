"""Certification of many laws at once: whether each keeps every row everywhere, and what its multipliers prove."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.synthesis.arrays.cells import Cells, Residuals, excess_at
from optlaws.synthesis.arrays.dual_bounds import lower_bounds
from optlaws.synthesis.arrays.newton_steps import States, Structure, batch_families, locally_optimal, product, with_one
from optlaws.synthesis.arrays.programs import Numbers, Path
from optlaws.synthesis.families.family import BatchFamily, LinearFamily, NonlinearFamily
from optlaws.synthesis.program.writer import Model

_CERTIFIED_EXCESS = 1e-11  # of a right side, or 1: by so much a row of a certified law may be broken
_SHARP_GAP = 5e-12  # of an objective: a bound that leaves more is computed more sharply, at a law solved to the end
_CURVED_GAP = 9e-11  # of an objective: what the bound of a proven law of curved rows may leave
_GREAT_MULTIPLIERS = 1e-9  # of an objective: what rounding may leave of it where multipliers are great
_CERTIFIED_PULL = 1e-12  # of the greatest multiplier: by so much one may be below 0, for which the bound counts it as 0
_SMALL_OBJECTIVE = 1e-6  # of an objective's scale: one that is less is measured by that


@dataclass(frozen=True, eq=False)
class Certification:
    """Objectives, lower bounds and what is broken of many laws."""

    #: objective, bound: what each law is worth, and what is proven that no law is below
    objective: Array
    bound: Array
    excess: Array  #: by how much a row may be broken anywhere, relative to its right side or 1
    pull: Array  #: how far the least multiplier is below 0, relative to the greatest; negative above it
    inward: Array  #: how fast a residual grows from a contact that is held at an end; negative where it falls
    #: whether no law beside it is better, where that does not follow from the bound: of problems that are not convex
    #: the bound is that of their rows' planes at the law
    best: NDArray[np.bool_]
    affine: bool  #: whether all rows are affine, so that a gap that is left is one of rounding
    scale: float  #: of the objective

    @property
    def broken(self) -> Array:
        """The greatest of several values that must not exceed 0, beyond rounding."""
        return np.asarray(np.maximum(np.maximum(self.excess, self.pull), self.inward))

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
    program, checks = path.model.program, row_checks_of(path.model)
    value, slope, _ = structure.jets(states.x, states.u)
    value[:, :, :-1] -= structure.slack
    point = with_one(states.x)
    residual = product(value, point) - numbers.bounds[:, structure.family]
    turned = product(slope, point)
    # toward the inside of the domain
    inward = np.where(states.u >= structure.domains[:, 1], -turned, turned)
    at_end = structure.at_end
    tangent = np.where(structure.free, np.abs(turned), np.where(at_end, np.maximum(inward, 0.0), 0.0))
    room = states.x @ structure.slacks.T + numbers.bounds
    unit = np.maximum(1.0, np.abs(room))[:, structure.family]
    broken = (np.maximum(residual, 0.0) + checks.reach[structure.family] * tangent) / unit
    off = np.abs(states.x @ program.equalities.T - numbers.right)
    worst = np.maximum(broken.max(axis=1, initial=0.0), off.max(axis=1, initial=0.0))
    touching = [states.u[:, contacts] for contacts in structure.of_families]
    greatest = np.abs(states.weights).max(axis=1, initial=0.0)
    pull = -(states.weights / np.where(greatest == 0.0, 1.0, greatest)[:, None]).min(axis=1, initial=np.inf)
    return Certification(
        best=np.ones(len(states), dtype=np.bool_) if checks.proving else locally_optimal(structure, states),
        objective=path.model.unit * (states.x * numbers.cost).sum(axis=1),
        bound=lower_bounds(path, structure, numbers, states, value),
        excess=np.maximum(worst, checks.excess(point, room, touching)),
        pull=np.where(np.isfinite(pull), pull, 0.0),
        inward=np.where(at_end, inward, -np.inf).max(axis=1, initial=-np.inf),
        affine=not program.curved,
        scale=path.model.unit,
    )


@dataclass(frozen=True, eq=False)
class RowChecks:
    """Checks of the rows of families for any laws."""

    families: Sequence[BatchFamily]

    @kept_property
    def proving(self) -> bool:
        """Whether multipliers prove bounds of the objective in this program."""
        return all(family.proving for family in self.families)

    @kept_property
    def _wide(self) -> dict[int, LinearFamily]:
        """The affine families that hold on an interval."""
        affine = {i: family for i, family in enumerate(self.families) if isinstance(family, LinearFamily)}
        return {i: family for i, family in affine.items() if family.domain[0] < family.domain[1]}

    @kept_property
    def _cells(self) -> Cells:
        return Cells(tuple(self._wide.values()))

    @kept_property
    def reach(self) -> Array:
        """The distance from a contact of each family up to which its tangent is used; 0 without cells."""
        shortfalls = np.zeros(len(self.families))
        if self._wide:
            shortfalls[list(self._wide)] = self._cells.reach
        return shortfalls

    def excess(self, point: Array, room: Array, touching: Sequence[Array]) -> Array:
        """The greatest violation of the rows of any family by each law, relative to the right side or 1."""
        shortfalls = np.zeros(len(point))
        if self._wide:
            wide = room[:, list(self._wide)], [touching[i] for i in self._wide]
            shortfalls = Residuals(self._cells, point, *wide).excess()
        for i, family in enumerate(self.families):
            if isinstance(family, NonlinearFamily):
                over = np.maximum(family.greatest(point) - room[:, i], 0.0) / np.maximum(1.0, np.abs(room[:, i]))
                shortfalls = np.maximum(shortfalls, over)
            elif isinstance(family, LinearFamily) and i not in self._wide:
                shortfalls = np.maximum(shortfalls, excess_at(family, point, room[:, i]))
        return shortfalls


def row_checks_of(model: Model) -> RowChecks:
    """The row checks of a program, cached for programs with the same rows."""
    families = batch_families(model)
    key = tuple(
        (type(family), id(family.series), family.domain, family.signs) if isinstance(family, LinearFamily) else family
        for family in families
    )
    if key not in _CHECKS:
        if len(_CHECKS) >= _MOST:
            _CHECKS.clear()
        _CHECKS[key] = RowChecks(families)
    return _CHECKS[key]


_CHECKS: dict[tuple[object, ...], RowChecks] = {}
_MOST = 64
