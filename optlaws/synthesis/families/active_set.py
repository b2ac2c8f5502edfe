"""Active sets: active constraints with their places and multipliers, of an optimum or of a guess."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array

_TYPES = {"family": np.intp, "free": np.bool_}
#: family, position u, sign, whether it may move, and multiplier
Contact = tuple[int, float, float, bool, float]


@dataclass(frozen=True, eq=False)
class ActiveSet:
    """Variables, contacts (family, position u, sign, whether it may move) and multipliers, the equations' apart."""

    x: Array
    family: NDArray[np.intp]
    u: Array
    s: Array
    free: NDArray[np.bool_]
    multipliers: Array
    equality_multipliers: Array

    @classmethod
    def of_columns(cls, **columns: Any) -> Self:
        """An active set from sequences of numbers by its attributes."""
        return cls(**{name: np.asarray(values, _TYPES.get(name, np.float64)) for name, values in columns.items()})

    @classmethod
    def of_contacts(cls, x: Array, contacts: Iterable[Contact], equality_multipliers: Array) -> Self:
        """An active set from its contacts, one after the other."""
        columns = zip(("family", "u", "s", "free", "multipliers"), zip(*contacts, strict=True), strict=False)
        known = dict.fromkeys(("family", "u", "s", "free", "multipliers"), ()) | dict(columns)
        return cls.of_columns(x=x, **known, equality_multipliers=equality_multipliers)

    def at(self, x: Array) -> ActiveSet:
        """The active set with other variables; the same object if they are equal."""
        return self if x is self.x else replace(self, x=x)

    def only(self, contacts: NDArray[np.bool_]) -> ActiveSet:
        """The active set with some of its contacts."""
        return replace(
            self,
            family=self.family[contacts],
            u=self.u[contacts],
            s=self.s[contacts],
            free=self.free[contacts],
            multipliers=self.multipliers[contacts],
        )

    def joined(self, family: int, u: float, s: float, *, free: bool) -> ActiveSet:
        """The active set with one more contact, whose multiplier is 0."""
        return replace(
            self,
            family=np.append(self.family, family),
            u=np.append(self.u, u),
            s=np.append(self.s, s),
            free=np.append(self.free, free),
            multipliers=np.append(self.multipliers, 0.0),
        )

    def merged(self, near: float) -> ActiveSet:
        """The active set with contacts of one row merged that are nearer than a distance; sides of a break are not."""
        if not len(self.u):
            return self
        order = np.lexsort((self.u, self.s, self.family))
        family = self.family[order]
        u, s, weights = (part[order] for part in (self.u, self.s, self.multipliers))
        close = (np.diff(family) == 0) & (np.diff(s) == 0.0) & (np.diff(u) < near)
        # what may not move and lies beside another is the other side of a break, where the row jumps
        sides = ~self.free[order]
        close &= ~(sides[1:] & sides[:-1] & (np.diff(u) > 0.0))
        if not close.any():
            return self
        first = np.flatnonzero(np.concatenate([[True], ~close]))
        total = np.add.reduceat(weights, first)
        middle = np.add.reduceat(weights * u, first) / np.where(total == 0.0, 1.0, total)
        alone = np.diff(np.append(first, len(u))) == 1
        return replace(
            self,
            family=family[first],
            u=np.where(alone | (total == 0.0), u[first], middle),
            s=s[first],
            free=self.free[order][first],
            multipliers=total,
        )
