"""Programs that differ in right sides, bounds and costs alone, as arrays along a path, and their optima as arrays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from itertools import starmap
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.family import ConstraintFamily, Program
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, model_of

_UNITS_ROUNDING = 1e-14  # of the greatest number of a family: by so much two may differ that are one in different units


@dataclass(frozen=True, eq=False)
class Numbers:
    """The numbers that differ between the programs of a stack."""

    right: Array  #: right sides of the equations, shape (programs, equations)
    bounds: Array  #: bounds of the families, shape (programs, families)
    cost: Array  #: what is minimised, shape (programs, variables)

    def __len__(self) -> int:
        return len(self.right)

    def taken(self, rows: NDArray[np.intp] | NDArray[np.bool_] | slice) -> Numbers:
        """The numbers of some of the programs."""
        return Numbers(self.right[rows], self.bounds[rows], self.cost[rows])


@dataclass(frozen=True, eq=False)
class Path:
    """Programs along a straight path: numbers that are affine in t, everything else as in the model."""

    model: Model  #: the program of one of them
    problems: tuple[Problem, ...]  #: the problems at its ends
    #: begin, slope: the numbers at t = 0, and what they change by as t does; each for one program
    begin: Numbers
    slope: Numbers
    #: families whose programs have them in units of their own bound; on the path they are in one unit
    measured: tuple[int, ...] = ()
    #: what is known of laws below a claim, computed once
    bounds_below_claim: dict[int | None, Any] = field(default_factory=dict, repr=False)

    def numbers(self, t: Array) -> Numbers:
        """The numbers at many t."""
        ways = ("right", "bounds", "cost")
        return Numbers(*(getattr(self.begin, way) + t[:, None] * getattr(self.slope, way) for way in ways))

    def program(self, t: float) -> Program:
        """The program at one t."""
        numbers, program = self.numbers(np.array([t])), self.model.program
        # what a family has computed stays with it
        families = tuple(
            family if family.bound == bound else replace(family, bound=float(bound))
            for family, bound in zip(program.families, numbers.bounds[0], strict=True)
        )
        return replace(program, families=families, right=numbers.right[0], objective=numbers.cost[0])


def numbers_of(program: Program) -> Numbers:
    """The numbers of one program."""
    bounds = np.array([[family.bound for family in program.families]])
    return Numbers(program.right[None, :], bounds.reshape(1, -1), program.objective[None, :])


def between(first: Problem, last: Problem, model: Callable[[Problem], Model] = model_of) -> Path | None:
    """The path from one problem at t = 0 to another at t = 1; None where their programs differ in more than numbers."""
    begin, end = model(first), model(last)
    start, stop = begin.program, in_units_of(begin.program, end.program)
    families = len(start.families) == len(stop.families) and all(map(_alike, start.families, stop.families))
    equal = start.equalities.shape == stop.equalities.shape and np.array_equal(start.equalities, stop.equalities)
    if not families or not equal or begin.places != end.places or begin.unit != end.unit:
        return None
    here, there = numbers_of(start), numbers_of(stop)
    slope = Numbers(there.right - here.right, there.bounds - here.bounds, there.cost - here.cost)
    measured = tuple(i for i, family in enumerate(stop.families) if family is not end.program.families[i])
    return Path(begin, (first, last), here, slope, measured)


def in_units_of(first: Program, other: Program) -> Program:
    """A program with its magnitudes in units of another's of the same kind: each has its own bound for a unit."""
    if len(first.families) != len(other.families):
        return other
    families = tuple(starmap(_measured, zip(first.families, other.families, strict=True)))
    return replace(other, families=families) if families != other.families else other


def _measured(first: ConstraintFamily, other: ConstraintFamily) -> ConstraintFamily:
    if (
        not isinstance(first, ConeFamily)
        or not isinstance(other, ConeFamily)
        or first.series.shape != other.series.shape
    ):
        return other
    size, other_size = (float(np.abs(family.series).max(initial=0.0)) for family in (first, other))
    if size == other_size or not other_size:
        return other
    share = size / other_size
    if np.abs(first.series - share * other.series).max() > _UNITS_ROUNDING * size:
        return other
    return replace(other, table=first.table, slack=share * other.slack, bound=share * other.bound)


def _alike(first: ConstraintFamily, other: ConstraintFamily) -> bool:
    """Whether two families have the same rows, which many laws are continued by."""
    if type(first) is not type(other) or not first.continuable:
        return False
    plain = all(getattr(first, name) == getattr(other, name) for name in ("name", "signs", "domain", "as_equation"))
    return plain and np.array_equal(first.slack, other.slack) and (first is other or first.same_rows(other))


NO_CONTACT = -1


@dataclass(frozen=True, eq=False)
class SolvedBatch:
    """Optima of programs that differ in numbers alone, one a row; NaN in the rows of programs that were not solved."""

    x: Array  #: the programs' variables, shape (programs, variables)
    #: family, u, sign, free, multiplier: contacts, shape (programs, most contacts): `NO_CONTACT` is the family of none
    family: NDArray[np.int16]
    u: Array
    sign: Array
    free: NDArray[np.bool_]
    multiplier: Array
    equations: Array  #: multipliers of the equations, shape (programs, equations)
    #: objective, bound, excess: the objective, what is proven that no law is below, and the most by which a row is
    #: broken; shape (programs,)
    objective: Array
    bound: Array
    excess: Array

    @classmethod
    def none(cls, count: int, variables: int, contacts: int, equations: int) -> Self:
        """No optimum of any of `count` programs."""
        shape = (count, contacts)
        return cls(
            x=np.full((count, variables), np.nan),
            family=np.full(shape, NO_CONTACT, dtype=np.int16),
            u=np.zeros(shape),
            sign=np.zeros(shape),
            free=np.zeros(shape, dtype=np.bool_),
            multiplier=np.zeros(shape),
            equations=np.full((count, equations), np.nan),
            objective=np.full(count, np.nan),
            bound=np.full(count, np.nan),
            excess=np.full(count, np.nan),
        )

    @property
    def solved(self) -> NDArray[np.bool_]:
        """A mask of programs that have an optimum in this result."""
        return ~np.isnan(self.objective)

    def active_set(self, place: int) -> ActiveSet:
        """An optimum in the form of the solver for single programs."""
        contacts = self.family[place] != NO_CONTACT
        return ActiveSet(
            x=self.x[place].copy(),
            family=self.family[place][contacts].astype(np.intp),
            u=self.u[place][contacts],
            s=self.sign[place][contacts],
            free=self.free[place][contacts],
            multipliers=self.multiplier[place][contacts],
            equality_multipliers=self.equations[place].copy(),
        )

    def taken(self, places: NDArray[np.intp]) -> SolvedBatch:
        """The optima of the programs at these places."""
        return SolvedBatch(**{entry.name: getattr(self, entry.name)[places] for entry in fields(self)})

    def only(self, chosen: NDArray[np.bool_]) -> Self:
        """The result for some programs only; the others count as not solved."""
        return replace(self, objective=np.where(chosen, self.objective, np.nan))

    def frozen(self) -> Self:
        """A copy whose arrays cannot be written to."""
        for entry in fields(self):
            getattr(self, entry.name).setflags(write=False)
        return self
