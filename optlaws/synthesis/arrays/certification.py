"""Certification of many laws at once: whether each keeps every row everywhere, and what its multipliers prove."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.arrays.dual_bounds import lower_bounds
from optlaws.synthesis.arrays.newton_steps import States, Structure, batch_families, locally_optimal, product, with_one
from optlaws.synthesis.arrays.programs import Numbers, Path
from optlaws.synthesis.families.family import BatchFamily, LinearFamily, NonlinearFamily
from optlaws.synthesis.families.peaks import peaks
from optlaws.synthesis.families.piece_series import EvenGegenbauer
from optlaws.synthesis.program.writer import Model

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
    program, checks = path.model.program, row_checks_of(path.model)
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
    return Certification(
        best=np.ones(len(states), dtype=np.bool_) if checks.proving else locally_optimal(structure, states),
        objective=path.model.unit * (states.x * numbers.cost).sum(axis=1),
        bound=lower_bounds(path, structure, numbers, states, value),
        excess=np.maximum(worst, checks.excess(point, room)),
        pull=np.where(np.isfinite(pull), pull, 0.0),
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
    def _series(self) -> dict[int, Array]:
        """The affine families, each as series over its domain."""
        return {i: _over_domain(family) for i, family in enumerate(self.families) if isinstance(family, LinearFamily)}

    def excess(self, point: Array, room: Array) -> Array:
        """The greatest violation of the rows of any family by each law, relative to the right side or 1."""
        shortfalls = np.zeros(len(point))
        for i, family in enumerate(self.families):
            if isinstance(family, NonlinearFamily):
                greatest = family.greatest(point)
            else:
                greatest = _greatest(point @ self._series[i].T, family.signs)
            over = np.maximum(greatest - room[:, i], 0.0) / np.maximum(1.0, np.abs(room[:, i]))
            shortfalls = np.maximum(shortfalls, over)
        return shortfalls


def _greatest(series: Array, signs: tuple[float, ...]) -> Array:
    """The greatest of series, with the signs that count."""
    if len(signs) > 1:
        return peaks(series)
    size = np.abs(series).sum(axis=1)
    raised = signs[0] * series
    raised[:, 0] += size
    return np.asarray(peaks(raised) - size)


def _over_domain(family: LinearFamily) -> Array:
    """Chebyshev series over a family's domain of its columns, or of what is above a bound where these are.

    Divided by a root that vanishes at its end f is a polynomial of that root; and where f is divided by powers that
    vanish there, its values are so great that the undivided ones say more.
    """
    low, high = family.domain
    count, weight, table = family.table.terms, np.ones(1), family.table
    if low == high:
        return np.asarray(family.columns(np.array([low]))[0])
    if family.root:
        count *= 2
        near, far = np.sqrt(1.0 - high), np.sqrt(1.0 - low)
        u = 1.0 - (near + (far - near) * (nodes(count) + 1.0) / 2.0) ** 2
    else:
        power = round(table.index - 0.5) if isinstance(table, EvenGegenbauer) else 0
        count += power
        u = low + (high - low) * (nodes(count) + 1.0) / 2.0
        weight = (((1.0 - u) / 2.0) ** power)[:, None]
    return np.asarray(from_values(family.columns(u)[0] * weight))


def row_checks_of(model: Model) -> RowChecks:
    """The row checks of a program, cached for programs with the same rows."""
    families = batch_families(model)
    key = tuple(
        (id(family.table), family.domain, family.signs, family.root) if isinstance(family, LinearFamily) else family
        for family in families
    )
    if key not in _CHECKS:
        if len(_CHECKS) >= _MOST:
            _CHECKS.clear()
        _CHECKS[key] = RowChecks(families)
    return _CHECKS[key]


_CHECKS: dict[tuple[object, ...], RowChecks] = {}
_MOST = 64
