"""Newton's method on the optimality conditions of many laws of one structure at once, and their certification.

The places of the contacts are eliminated: what a place moves by follows from what the variables do, by its row alone.

Of each law it is then known whether it keeps every row everywhere, and what its multipliers prove: the bounds are those
of certificates, rounded outward.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, log

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.synthesis.arrays.programs import Numbers, Path
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import BatchFamily, NonlinearFamily
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.duality import AprioriBounds, Sublevel, bounds_within, charge, roundings, weighted
from optlaws.tolerances import AGREEMENT

#: what is given up: a step that is greater than the next ones could mend
_SIZES = (1e3, 1e3, 10.0, 1.0, 0.3, 0.05, 1e-3, 1e-4)
_FAR = 1.05


@dataclass(frozen=True, eq=False)
class Structure:
    """Active constraints shared by many laws: the family and the sign of each contact, and whether it may move."""

    model: Model  #: the program, but for its numbers
    #: family, sign, free: of the contacts, by family
    family: NDArray[np.intp]
    sign: Array
    free: NDArray[np.bool_]

    @property
    def count(self) -> int:
        return len(self.family)

    @property
    def signature(self) -> tuple[tuple[int, float, bool], ...]:
        """A key that equal structures share."""
        return tuple(zip(self.family.tolist(), self.sign.tolist(), self.free.tolist(), strict=True))

    @kept_property
    def slack(self) -> Array:
        """Right sides of the contacts' rows in the variables."""
        return np.asarray(self.slacks[self.family])

    @kept_property
    def slacks(self) -> Array:
        """Right sides of all families in the variables."""
        program = self.model.program
        return np.array([family.slack for family in program.families]).reshape(-1, program.size)

    @kept_property
    def moving(self) -> NDArray[np.intp]:
        """A mask of the contacts that may move."""
        return np.flatnonzero(self.free)

    def rounding_errors(self, x: Array, u: Array, weights: Array) -> Array:
        """Rounding bounds of each entry of the sum of weights times rows, (laws, variables + 1)."""
        point = with_one(x)
        errors = np.zeros(point.shape)
        for family, contacts in self._own:
            errors += family.rounding_errors(weights[:, contacts], u[:, contacts], point)
        return errors

    @kept_property
    def _own(self) -> list[tuple[BatchFamily, slice]]:
        """The families that have contacts, each with which these are."""
        ends = np.searchsorted(self.family, np.arange(len(self.model.program.families) + 1)).tolist()
        families = zip(batch_families(self.model), pairwise(ends), strict=True)
        return [(family, slice(low, high)) for family, (low, high) in families if low < high]

    def jets(self, x: Array, u: Array) -> tuple[Array, Array, Array]:
        """Planes of s f and of their derivatives by the place, (laws, contacts, variables + 1), and second derivatives.

        Of families that are affine in the law they are the rows themselves.
        """
        laws, width = len(u), x.shape[1] + 1
        value, slope = np.empty((2, laws, self.count, width))
        bend = np.empty((laws, self.count))
        point = with_one(x)
        for family, contacts in self._own:
            f0, f1, f2 = family.planes(u[:, contacts], point)
            sign = self.sign[contacts]
            np.multiply(f0, sign[:, None], out=value[:, contacts])
            np.multiply(f1, sign[:, None], out=slope[:, contacts])
            np.multiply(f2, sign, out=bend[:, contacts])
        return value, slope, bend

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | float:
        """Second derivatives by the variables of the sum of weights times s f; 0 where all is affine."""
        total: Array | float = 0.0
        for family, contacts in self._own:
            if isinstance(family, NonlinearFamily):
                total = total + family.hessians(u[:, contacts], with_one(x), self.sign[contacts] * weights[:, contacts])
        return total


def structure_of(model: Model, optimum: ActiveSet) -> tuple[Structure, NDArray[np.intp]]:
    """The structure of an optimum, and the order of its contacts in it: by family and place."""
    order = np.lexsort((optimum.s, optimum.u, optimum.family))
    structure = Structure(model, optimum.family[order], optimum.s[order], optimum.free[order])
    return structure, order


def with_one(x: Array) -> Array:
    """The variables of many laws and 1."""
    return np.concatenate([x, np.ones((len(x), 1))], axis=1)


def product(planes: Array, point: Array) -> Array:
    """Values of planes of each law at its variables and 1, shape (laws, planes)."""
    return np.asarray(np.matmul(planes, point[:, :, None])[:, :, 0])


def batch_families(model: Model) -> list[BatchFamily]:
    """The families of a model's program, which many laws are continued by."""
    families: list[BatchFamily] = []
    for family in model.program.families:
        if not isinstance(family, BatchFamily) or not family.continuable:
            raise TypeError(f"rows of {type(family).__name__} are not solved in arrays")
        families.append(family)
    return families


@dataclass(frozen=True, eq=False)
class States:
    """Variables, contacts and multipliers of many laws with the same structure, a row for each law."""

    x: Array
    u: Array
    weights: Array
    equations: Array

    def __len__(self) -> int:
        return len(self.x)

    def taken(self, rows: NDArray[np.intp] | NDArray[np.bool_] | slice) -> States:
        """The steps of some of the laws."""
        return States(self.x[rows], self.u[rows], self.weights[rows], self.equations[rows])

    @property
    def packed(self) -> Array:
        """All parts of the state in a single matrix."""
        return np.concatenate([self.x, self.u, self.weights, self.equations], axis=1)

    @classmethod
    def unpacked(cls, rows: Array, structure: Structure) -> States:
        """States from what `packed` gave."""
        size, count = structure.model.program.size, structure.count
        ends = (0, size, size + count, size + 2 * count, rows.shape[1])
        return cls(*(rows[:, low:high] for low, high in pairwise(ends)))


def step(structure: Structure, numbers: Numbers, states: States) -> tuple[States, Array]:
    """The states after a step of Newton's method, and the size of each step; infinite where the step fails."""
    program, free = structure.model.program, structure.moving
    jets, point = _Jets.of(structure, states), with_one(states.x)
    turned = product(jets.slope, point)
    shift, pull = turned / jets.bend, states.weights[:, free] / jets.bend
    rows, slopes = jets.value[:, :, :-1], jets.slope[:, :, :-1]
    size, count, equations = program.size, structure.count, len(program.equalities)
    last = size + count
    system = _system(structure, states, jets, pull)
    defect = np.empty((len(states), last + equations, 1))
    balance = numbers.cost + weighted(states.weights, rows) + states.equations @ program.equalities
    defect[:, :size, 0] = balance - weighted(pull * turned, slopes)
    defect[:, size:last, 0] = product(jets.value, point) - numbers.bounds[:, structure.family]
    if len(free):
        system[:, size + free, :size] -= slopes * shift[:, :, None]
        defect[:, size + free, 0] -= turned * shift
    defect[:, last:, 0] = states.x @ program.equalities.T - numbers.right
    moved = -_solved(system, defect)[:, :, 0]
    dx = moved[:, :size]
    u = states.u.copy()
    u[:, free] -= shift + np.matmul(slopes, dx[:, :, None])[:, :, 0] / jets.bend
    further = States(states.x + dx, u, states.weights + moved[:, size:last], states.equations + moved[:, last:])
    sizes = np.abs(moved).max(axis=1) / np.maximum(1.0, np.abs(states.packed).max(axis=1))
    wild = ~np.isfinite(sizes) | (np.abs(u).max(axis=1, initial=0.0) > _FAR)
    return further, np.where(wild, np.inf, sizes)


@dataclass(frozen=True, eq=False)
class _Jets:
    """Planes of the contacts' rows, with right sides subtracted; for free contacts also their slopes and curvatures."""

    value: Array
    slope: Array
    bend: Array

    @classmethod
    def of(cls, structure: Structure, states: States) -> _Jets:
        value, slope, bend = structure.jets(states.x, states.u)
        value[:, :, :-1] -= structure.slack
        if not structure.free.all():
            slope, bend = slope[:, structure.moving], bend[:, structure.moving]
        return cls(value, slope, np.where(bend == 0.0, np.inf, bend))


def _system(structure: Structure, states: States, jets: _Jets, pull: Array) -> Array:
    """Derivatives of the optimality conditions by variables and multipliers, with the places eliminated."""
    program = structure.model.program
    rows, slopes = jets.value[:, :, :-1], jets.slope[:, :, :-1]
    size, last = program.size, program.size + structure.count
    whole = last + len(program.equalities)
    system = np.zeros((len(states), whole, whole))
    np.matmul((slopes * -pull[:, :, None]).transpose(0, 2, 1), slopes, out=system[:, :size, :size])
    if program.curved:
        system[:, :size, :size] += structure.hessian(states.x, states.u, states.weights)
    system[:, :size, size:last] = rows.transpose(0, 2, 1)
    system[:, :size, last:] = program.equalities.T
    system[:, size:last, :size] = rows
    system[:, last:, :size] = program.equalities
    return system


def locally_optimal(structure: Structure, states: States) -> NDArray[np.bool_]:
    """A mask of states that satisfy the second-order optimality conditions.

    Along what the rows leave free the objective bends upward if and only if the conditions' matrix has as many
    negative eigenvalues as there are rows.
    """
    jets = _Jets.of(structure, states)
    system = _system(structure, states, jets, states.weights[:, structure.moving] / jets.bend)
    known = np.isfinite(system).all(axis=(1, 2))
    definite = np.zeros(len(states), dtype=np.bool_)
    rows = system.shape[1] - structure.model.program.size
    definite[known] = (np.linalg.eigvalsh(system[known]) < 0.0).sum(axis=1) == rows
    return definite


def converged(structure: Structure, numbers: Numbers, states: States) -> tuple[States, NDArray[np.bool_]]:
    """The states that Newton's method leads to, and where it does."""
    done = np.zeros(len(states), dtype=np.bool_)
    going = np.ones(len(states), dtype=np.bool_)
    rows = states.packed.copy()
    for most in _SIZES:
        places = np.flatnonzero(going)
        if not len(places):
            break
        further, sizes = step(structure, numbers.taken(places), States.unpacked(rows[places], structure))
        rows[places] = further.packed
        going[places] = (sizes <= most) & (sizes > AGREEMENT)
        done[places] = sizes <= AGREEMENT
    return States.unpacked(rows, structure), done


def clipped(structure: Structure, states: States) -> States:
    """The states with the places that rounding took out of their domain put on its end."""
    families = structure.model.program.families
    low, high = np.array([families[i].domain for i in structure.family]).reshape(-1, 2).T
    return replace(states, u=np.minimum(np.maximum(states.u, low), high))


def _solved(system: Array, right: Array) -> Array:
    try:
        return np.asarray(np.linalg.solve(system, right), dtype=np.float64)
    except np.linalg.LinAlgError:
        # one singular system must not spoil the others
        solution = np.full_like(right, np.nan)
        for i, (matrix, side) in enumerate(zip(system, right, strict=True)):
            with suppress(np.linalg.LinAlgError):
                solution[i] = np.linalg.solve(matrix, side)
        return solution


#: claims are taken from a geometric row, upward: what is known of laws below them is known of all before
_CLAIMS, _ABOVE = 1.01, 1.0 + 2.0**-40


def lower_bounds(path: Path, structure: Structure, numbers: Numbers, states: States, value: Array) -> Array:
    """Lower bounds of the objectives; negative multipliers count as zero.

    Parameters
    ----------
    path, structure, numbers, states
        The laws' programs and their states.
    value
        The rows of the contacts, less the right sides' variables, shape (laws, contacts, variables + 1).
    """
    program = path.model.program
    weights, equations, cost = np.maximum(states.weights, 0.0), states.equations, numbers.cost
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
    value, _, _ = structure.jets(states.x, states.u)
    value[:, :, :-1] -= structure.slack
    point = with_one(states.x)
    residual = product(value, point) - numbers.bounds[:, structure.family]
    room = states.x @ structure.slacks.T + numbers.bounds
    broken = residual / np.maximum(1.0, np.abs(room))[:, structure.family]
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
