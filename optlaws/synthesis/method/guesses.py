"""Starts of curved programs without a neighbour: laws that need no solver, and an interior start."""

from __future__ import annotations

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import IntegralFamily
from optlaws.synthesis.families.family import ConstraintFamily, NormFamily, Points, Program
from optlaws.tolerances import EXCESS

_VANISHED = 1e-13  # amplitudes that are minimised vanish if their sum is less

#: by how much the room of a start exceeds what its base law needs
_AMPLE = 1.2


def vanishing(program: Program) -> ActiveSet | None:
    """A law in which all amplitudes that are minimised vanish: many may have none, and then no contact shows one."""
    minimised = [family for family in program.families if (program.objective * family.slack).any()]
    cones = [family for family in minimised if isinstance(family, ConeFamily) and family.domain[0] == family.domain[1]]
    costs = np.flatnonzero(program.objective)
    bounded = all(sum(cone.slack[i] for cone in cones) for i in costs)
    if not cones or len(cones) < len(minimised) or not bounded:
        return None
    columns = [cone.columns(np.array(cone.domain[:1]))[0, 0] for cone in cones]
    rows = np.vstack([np.array([column.real, column.imag]) for column in columns])
    conditions = np.concatenate([rows[:, :-1], program.equalities])
    right = np.concatenate([-rows[:, -1], program.right])
    # what is minimised is to be nothing
    conditions[:, costs] = 0.0
    x = np.linalg.lstsq(conditions, right, rcond=None)[0]
    if np.abs(conditions @ x - right).max() > _VANISHED or program.violation(x) > EXCESS:
        return None
    return of_variables(program, x)


def of_variables(program: Program, x: Array) -> ActiveSet:
    """An active set of these variables without any contact."""
    return ActiveSet.of_contacts(x, (), np.zeros(len(program.right)))


def initial_guess(program: Program, points: list[Points]) -> Array:
    """The base law with slack for its constants: curved programs are hard to enter from infeasible values."""
    x = np.zeros(program.size)
    for family, grid in zip(program.families, points, strict=True):
        needed = float((grid.s * family.value(np.zeros(program.size), grid.u)).max()) - family.bound
        if isinstance(family, ConeFamily):
            needed = max(needed, 1.0)  # a cone's rows need room
        raised = family.slack > 0.0
        x[raised] = np.maximum(x[raised], _AMPLE * needed / family.slack[raised])
    return x


def sizes_only(program: Program, x: Array) -> ActiveSet | None:
    """A guess in which RMS and integrals alone bind, where they alone are minimised: it may need no IPOPT."""
    sizes = {i: family for i, family in enumerate(program.families) if _is_size(family)}
    bounded = {int(variable) for family in sizes.values() for variable in np.flatnonzero(family.slack)}
    if bounded != set(np.flatnonzero(program.objective).tolist()):
        return None
    numbers = np.array(list(sizes), dtype=np.intp)
    ones = np.ones(len(numbers))
    x = x + _least(program, list(sizes.values()))
    free = np.zeros(len(numbers), dtype=np.bool_)
    return ActiveSet(x, numbers, ones, ones, free, ones, np.zeros(len(program.right)))


def _is_size(family: ConstraintFamily) -> bool:
    return isinstance(family, NormFamily) or (isinstance(family, IntegralFamily) and family.convex)


def _least(program: Program, sizes: list[ConstraintFamily]) -> Array:
    """Coordinates of least sum of integrals and squared norms under the equations, to second order."""
    if not sizes:
        return np.zeros(program.size)
    models = [_second_order(family, program.size) for family in sizes]
    square, slope = (np.sum(parts, axis=0) for parts in zip(*models, strict=True))
    count = len(program.right)
    system = np.block([[square, program.equalities.T], [program.equalities, np.zeros((count, count))]])
    right = np.concatenate([-slope, program.right])
    return np.asarray(np.linalg.lstsq(system, right, rcond=None)[0][: program.size], dtype=np.float64)


def _second_order(family: ConstraintFamily, size: int) -> tuple[Array, Array]:
    """Second derivatives and slope, at the base law, of an integral or of half the square of a norm."""
    if isinstance(family, NormFamily):
        free, base = family.matrix[:, :-1], family.matrix[:, -1]
        return free.T @ free, free.T @ base
    ones, nothing = np.ones(1), np.zeros(size)
    bent = family.hessian(nothing, ones, ones)
    slope = family.jet(nothing, ones, ones).gradient[0] + family.slack
    return (np.zeros((size, size)) if bent is None else bent), slope
