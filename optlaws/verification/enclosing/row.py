"""A row of a certificate in balls."""

from __future__ import annotations

from collections.abc import Callable, Mapping
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


Maker = Callable[[Contact, Fraction], BallRow]
