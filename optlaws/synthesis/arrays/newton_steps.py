"""Newton's method on the optimality conditions of many laws of one structure at once.

The places of the contacts are eliminated: what a place moves by follows from what the variables do, by its row alone.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.arrays.programs import Numbers
from optlaws.synthesis.arrays.rows import Structure

Array = NDArray[np.float64]

_STEPS = 8
#: convergence is quadratic: what is left after a step of this share is rounding
_CONVERGED = 1e-9
_FAR = 1.05


@dataclass(frozen=True, eq=False)
class States:
    """Variables, places, multipliers and those of the equations of many laws of one structure, one a row."""

    x: Array
    u: Array
    weights: Array
    equations: Array

    def __len__(self) -> int:
        return len(self.x)

    def taken(self, rows: NDArray[np.intp] | NDArray[np.bool_] | slice) -> States:
        """Some of them."""
        return States(self.x[rows], self.u[rows], self.weights[rows], self.equations[rows])

    @property
    def packed(self) -> Array:
        """All of it, side by side."""
        return np.concatenate([self.x, self.u, self.weights, self.equations], axis=1)

    @classmethod
    def unpacked(cls, rows: Array, structure: Structure) -> States:
        """States from what `packed` gave."""
        size, count = structure.model.program.size, structure.count
        parts = np.split(rows, [size, size + count, size + 2 * count], axis=1)
        return cls(*parts)


def step(structure: Structure, numbers: Numbers, states: States) -> tuple[States, Array]:
    """The states one step of Newton's method further, and the size of each step; infinite where there is none."""
    program, free = structure.model.program, structure.free
    jets = _Jets.of(structure, states)
    off = _at(jets.value, states.x) - numbers.bounds[:, structure.family]
    turned = _at(jets.slope[:, free], states.x)
    shift, pull = turned / jets.bend, states.weights[:, free] / jets.bend
    rows, slopes = jets.value[:, :, :-1], jets.slope[:, free, :-1]
    size, count, equations = program.size, structure.count, len(program.equalities)
    last = size + count
    system = _system(structure, states, jets)
    system[:, size + np.flatnonzero(free), :size] -= slopes * shift[:, :, None]
    defect = np.empty((len(states), last + equations, 1))
    balance = numbers.cost + np.einsum("mpi,mp->mi", rows, states.weights) + states.equations @ program.equalities
    defect[:, :size, 0] = balance - np.einsum("mpi,mp->mi", slopes, pull * turned)
    defect[:, size:last, 0] = off
    defect[:, size + np.flatnonzero(free), 0] -= turned * shift
    defect[:, last:, 0] = states.x @ program.equalities.T - numbers.right
    moved = -_solved(system, defect)[:, :, 0]
    dx = moved[:, :size]
    u = states.u.copy()
    u[:, free] -= shift + np.einsum("mpi,mi->mp", slopes, dx) / jets.bend
    further = States(states.x + dx, u, states.weights + moved[:, size:last], states.equations + moved[:, last:])
    sizes = np.abs(moved).max(axis=1) / np.maximum(1.0, np.abs(states.packed).max(axis=1))
    wild = ~np.isfinite(sizes) | (np.abs(u).max(axis=1, initial=0.0) > _FAR)
    return further, np.where(wild, np.inf, sizes)


@dataclass(frozen=True, eq=False)
class _Jets:
    """Planes of the contacts' rows, less the right sides' variables, and of their slopes; how the free ones bend."""

    value: Array
    slope: Array
    bend: Array

    @classmethod
    def of(cls, structure: Structure, states: States) -> _Jets:
        value, slope, bend = structure.jets(states.x, states.u)
        value[:, :, :-1] -= structure.slack
        bent = bend[:, structure.free]
        return cls(value, slope, np.where(bent == 0.0, np.inf, bent))


def _system(structure: Structure, states: States, jets: _Jets) -> Array:
    """Derivatives of the optimality conditions by variables and multipliers, with the places eliminated."""
    program, free = structure.model.program, structure.free
    rows, slopes = jets.value[:, :, :-1], jets.slope[:, free, :-1]
    size, last = program.size, program.size + structure.count
    whole = last + len(program.equalities)
    system = np.zeros((len(states), whole, whole))
    pull = states.weights[:, free] / jets.bend
    system[:, :size, :size] = -np.matmul((slopes * pull[:, :, None]).transpose(0, 2, 1), slopes)
    system[:, :size, :size] += structure.hessian(states.x, states.u, states.weights)
    system[:, :size, size:last] = rows.transpose(0, 2, 1)
    system[:, :size, last:] = program.equalities.T
    system[:, size:last, :size] = rows
    system[:, last:, :size] = program.equalities
    return system


def best_nearby(structure: Structure, states: States) -> NDArray[np.bool_]:
    """Where no law beside a state that meets the optimality conditions is better, of second order.

    Along what the rows leave free the objective bends upward if and only if the conditions' matrix has as many
    negative eigenvalues as there are rows.
    """
    system = _system(structure, states, _Jets.of(structure, states))
    known = np.isfinite(system).all(axis=(1, 2))
    found = np.zeros(len(states), dtype=np.bool_)
    rows = system.shape[1] - structure.model.program.size
    found[known] = (np.linalg.eigvalsh(system[known]) < 0.0).sum(axis=1) == rows
    return found


def converged(structure: Structure, numbers: Numbers, states: States) -> tuple[States, NDArray[np.bool_]]:
    """The states that Newton's method leads to, and where it does."""
    done = np.zeros(len(states), dtype=np.bool_)
    going = np.ones(len(states), dtype=np.bool_)
    rows = states.packed.copy()
    for _ in range(_STEPS):
        places = np.flatnonzero(going)
        if not len(places):
            break
        further, sizes = step(structure, numbers.taken(places), States.unpacked(rows[places], structure))
        rows[places] = further.packed
        going[places] = np.isfinite(sizes) & (sizes > _CONVERGED)
        done[places] = sizes <= _CONVERGED
    return States.unpacked(rows, structure), done


def clipped(structure: Structure, states: States) -> States:
    """The states with the places that rounding took out of their domain put on its end."""
    low, high = structure.domains.T
    return replace(states, u=np.minimum(np.maximum(states.u, low), high))


def _at(rows: Array, x: Array) -> Array:
    return np.asarray(np.einsum("mpi,mi->mp", rows[:, :, :-1], x) + rows[:, :, -1])


def _solved(system: Array, right: Array) -> Array:
    try:
        return np.asarray(np.linalg.solve(system, right), dtype=np.float64)
    except np.linalg.LinAlgError:
        # one singular system must not spoil the others
        found = np.full_like(right, np.nan)
        for i, (one, side) in enumerate(zip(system, right, strict=True)):
            with suppress(np.linalg.LinAlgError):
                found[i] = np.linalg.solve(one, side)
        return found
