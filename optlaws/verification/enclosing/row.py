"""Rows of a certificate in balls, and the limits that they set."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from flint import arb

from optlaws.synthesis.proof.nodes import Contact

Names = Mapping[str, float | arb]


@dataclass(frozen=True, eq=False)
class BallRow:
    """functions . (z, 1) + sum of constants + right; at most 0, or 0 for an equation, in every law of the problem."""

    functions: list[arb]
    constants: Names = field(default_factory=dict)
    right: arb | float = 0.0

    def vector(self, variables: list[str]) -> list[arb]:
        """Coefficients of z and of the named constants, then what is constant."""
        *free, base = self.functions
        return [*free, *(arb(self.constants.get(name, 0.0)) for name in variables), base + self.right]


@dataclass(frozen=True, eq=False)
class UpperLimit:
    """A sum of named constants, their signs turned, and a number, which a function of the law is at most."""

    constants: Names = field(default_factory=dict)
    high: float | arb = 0.0

    def row(self, functions: Iterable[arb], unit: arb | None = None) -> BallRow:
        """The row of a function of the law, in a unit if one is given."""
        if unit is None:
            return BallRow(list(functions), self.constants, -arb(self.high))
        constants = {name: arb(value) / unit for name, value in self.constants.items()}
        return BallRow([value / unit for value in functions], constants, -arb(self.high) / unit)


Maker = Callable[[Contact, Fraction], BallRow]
