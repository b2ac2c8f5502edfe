"""Rows of a program at the contacts of many laws at once, with their derivatives by the place."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import BatchFamily, NonlinearFamily
from optlaws.synthesis.program.writer import Model

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Structure:
    """Which constraints bind: the family and the sign of each contact, and whether it may move; the same for many laws.

    Attributes
    ----------
    model
        The program, but for its numbers.
    family, sign, free
        Of the contacts, by family.
    """

    model: Model
    family: NDArray[np.intp]
    sign: Array
    free: NDArray[np.bool_]

    @property
    def count(self) -> int:
        """The number of contacts."""
        return len(self.family)

    @property
    def signature(self) -> tuple[tuple[int, float, bool], ...]:
        """What two structures have in common that are the same."""
        return tuple(zip(self.family.tolist(), self.sign.tolist(), self.free.tolist(), strict=True))

    @property
    def affine(self) -> bool:
        """Whether the contacts' places and multipliers are the same for all right sides: rows alone determine them."""
        program = self.model.program
        return not program.curved and bool(
            2 * self.free.sum() + (~self.free).sum() + len(program.equalities) == program.size
        )

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
    def domains(self) -> Array:
        """The least and the greatest place of each contact's row."""
        families = self.model.program.families
        return np.array([families[i].domain for i in self.family]).reshape(-1, 2)

    @kept_property
    def moving(self) -> NDArray[np.intp]:
        """Which contacts may move."""
        return np.flatnonzero(self.free)

    @kept_property
    def held(self) -> NDArray[np.bool_]:
        """Which contacts are held at an end off which they could move."""
        return np.asarray(~self.free & (self.domains[:, 0] != self.domains[:, 1]))

    def rounding_errors(self, x: Array, u: Array, weights: Array) -> Array:
        """What rounding may hide of each entry of the sum of weights times rows, (laws, variables + 1)."""
        point = with_one(x)
        errors = np.zeros(point.shape)
        for family, own in self._own:
            errors += family.rounding_errors(weights[:, own], u[:, own], point)
        return errors

    @kept_property
    def of_families(self) -> list[slice]:
        """Which contacts are those of each family; none of some."""
        ends = np.searchsorted(self.family, np.arange(len(self.model.program.families) + 1)).tolist()
        return [slice(low, high) for low, high in pairwise(ends)]

    @kept_property
    def _own(self) -> list[tuple[BatchFamily, slice]]:
        """The families that have contacts, each with which these are."""
        families = zip(batch_families(self.model), self.of_families, strict=True)
        return [(family, own) for family, own in families if own.start < own.stop]

    def jets(self, x: Array, u: Array) -> tuple[Array, Array, Array]:
        """Planes of s f and of their derivatives by the place, (laws, contacts, variables + 1), and second derivatives.

        Of families that are affine in the law they are the rows themselves.
        """
        laws, width = len(u), x.shape[1] + 1
        value, slope = np.empty((2, laws, self.count, width))
        bend = np.empty((laws, self.count))
        point = with_one(x)
        for family, own in self._own:
            f0, f1, f2 = family.planes(u[:, own], point)
            sign = self.sign[own]
            np.multiply(f0, sign[:, None], out=value[:, own])
            np.multiply(f1, sign[:, None], out=slope[:, own])
            np.multiply(f2, sign, out=bend[:, own])
        return value, slope, bend

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | float:
        """Second derivatives by the variables of the sum of weights times s f; 0 where all is affine."""
        total: Array | float = 0.0
        for family, own in self._own:
            if isinstance(family, NonlinearFamily):
                total = total + family.hessians(u[:, own], with_one(x), self.sign[own] * weights[:, own])
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
    """What planes of each law are at its variables and 1, shape (laws, planes)."""
    return np.asarray(np.matmul(planes, point[:, :, None])[:, :, 0])


def weighted(weights: Array, rows: Array) -> Array:
    """The sum of the rows of each law, weighted."""
    return np.asarray(np.matmul(weights[:, None, :], rows)[:, 0])


def batch_families(model: Model) -> list[BatchFamily]:
    """The families of a model's program, which many laws are continued by.

    Raises
    ------
    TypeError
        If one is of a kind that is not solved in arrays.
    """
    families: list[BatchFamily] = []
    for family in model.program.families:
        if not isinstance(family, BatchFamily) or not family.continuable:
            raise TypeError(f"rows of {type(family).__name__} are not solved in arrays")
        families.append(family)
    return families
