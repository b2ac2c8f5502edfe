"""Optima of many programs of one kind, as arrays: what the laws are, where rows bind, and what is proven."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from optlaws.files.reading import JsonText
from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet

NO_CONTACT = -1

#: what is computed from the laws when they are read
FOLLOWING = ("objective", "excess")


@dataclass(frozen=True, eq=False)
class SolvedBatch(JsonText):
    """Optima of programs that differ in numbers alone, one a row; NaN in the rows of programs that were not solved.

    Attributes
    ----------
    x
        The programs' variables, shape (programs, variables).
    family, u, sign, free, multiplier
        Contacts, shape (programs, most contacts): `NO_CONTACT` is the family of none.
    equations
        Multipliers of the equations, shape (programs, equations).
    objective, bound, excess
        The objective, what is proven that no law is below, and the most by which a row is broken (NaN of laws that were
        read from a file, which keep their rows as every `Solution` does); shape (programs,).
    """

    x: Array
    family: NDArray[np.int16]
    u: Array
    sign: Array
    free: NDArray[np.bool_]
    multiplier: Array
    equations: Array
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
        """Which programs have an optimum here."""
        return ~np.isnan(self.objective)

    def active_set(self, place: int) -> ActiveSet:
        """One optimum in the terms of the solver of single programs."""
        own = self.family[place] != NO_CONTACT
        return ActiveSet(
            x=self.x[place].copy(),
            family=self.family[place][own].astype(np.intp),
            u=self.u[place][own],
            s=self.sign[place][own],
            free=self.free[place][own],
            multipliers=self.multiplier[place][own],
            equality_multipliers=self.equations[place].copy(),
        )

    def taken(self, places: NDArray[np.intp]) -> SolvedBatch:
        """Some of the rows."""
        return SolvedBatch(**{field.name: getattr(self, field.name)[places] for field in fields(self)})

    def only(self, kept: NDArray[np.bool_]) -> Self:
        """The same without the objectives of the others, so that they count as not solved."""
        return replace(self, objective=np.where(kept, self.objective, np.nan))

    def frozen(self) -> Self:
        """A copy whose arrays cannot be written to."""
        for field in fields(self):
            getattr(self, field.name).setflags(write=False)
        return self

    def to_dict(self) -> dict[str, Any]:
        """Plain lists of what does not follow from the laws: all but objectives and excesses."""
        return {field.name: getattr(self, field.name).tolist() for field in fields(self) if field.name not in FOLLOWING}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Read what `to_dict` wrote, and what follows; it is checked by whoever reads."""
        kinds = {"family": np.int16, "free": np.bool_}
        return cls(**{name: np.array(value, dtype=kinds.get(name, np.float64)) for name, value in data.items()})
