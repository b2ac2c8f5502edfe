"""From a solution on points to the optimum: its multipliers show which constraints are active."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet, Contact
from optlaws.synthesis.families.family import ConstraintFamily, Points, Program
from optlaws.synthesis.method.discretised.on_points import Answer
from optlaws.tolerances import BARRIER, SAME_PLACE

_SAME_HEIGHT = 1e-9  # what an extremum's residual may be below that of a point on its hill: rounding of a series


def as_answered(points: list[Points], answer: Answer) -> ActiveSet:
    """The answer's own contacts, for optima that are flat somewhere, where no exact active set exists."""
    *weights, equations = answer.multipliers
    active = [np.flatnonzero(w > answer.weightless * w.max(initial=0.0)) for w in weights]
    return ActiveSet(
        x=answer.x,
        family=np.repeat(np.arange(len(active), dtype=np.intp), [len(rows) for rows in active]),
        u=np.concatenate([grid.u[rows] for grid, rows in zip(points, active, strict=True)]),
        s=np.concatenate([grid.s[rows] for grid, rows in zip(points, active, strict=True)]),
        free=np.zeros(sum(map(len, active)), dtype=np.bool_),
        multipliers=np.concatenate([w[rows] for w, rows in zip(weights, active, strict=True)]),
        equality_multipliers=equations,
    )


def identified(program: Program, points: list[Points], answer: Answer) -> ActiveSet:
    """The contacts near an answer: each point's multiplier is given to the extremum that its hill leads to."""
    contacts: list[Contact] = []
    for i, (family, grid) in enumerate(zip(program.families, points, strict=True)):
        jet = family.jet(answer.x, grid.u, grid.s)
        binding = _binding(jet.gradient, answer.multipliers[i], jet.value)
        if not binding.any():
            continue
        u, s, residual = family.extremes(answer.x)
        higher = (s == grid.s[binding, None]) & (residual >= jet.value[binding, None] - _SAME_HEIGHT)
        distance = np.where(higher, np.abs(u - grid.u[binding, None]), np.inf)
        weights = answer.multipliers[i][binding]
        gathered = np.bincount(distance.argmin(axis=1), weights, len(u)).astype(np.float64)
        _merge(family, u, s, gathered)
        movable = family.movable(u)
        contacts += [(i, u[j], s[j], movable[j], gathered[j]) for j in np.flatnonzero(gathered)]
    return ActiveSet.of_contacts(answer.x, contacts, answer.multipliers[-1])


def _merge(family: ConstraintFamily, u: Array, s: Array, gathered: Array) -> None:
    """Give an end what belongs to an extremum that IPOPT's tolerance alone sets apart from it."""
    for end in np.flatnonzero(np.isin(u, family.domain)):
        same = (s == s[end]) & (np.abs(u - u[end]) < SAME_PLACE)
        total = gathered[same].sum()
        gathered[same] = 0.0
        gathered[end] = total


def _binding(rows: Array, weights: Array, residual: Array) -> NDArray[np.bool_]:
    # complementarity, in units in which each row has length 1: a contact's multiplier exceeds its distance
    length = np.linalg.norm(rows, axis=1)
    sizes = weights * length
    greatest = max(1.0, float(sizes.max(initial=0.0)))
    binding: NDArray[np.bool_] = (sizes * length > -residual * greatest) & (sizes > BARRIER * greatest)
    return binding
