"""The answer of a solver to a program on finitely many points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.family import Points, Program

QUADRATIC = "quadratic programs"  #: that follow each other, whether or not the last one changed nothing
_NEARLY = (QUADRATIC, "Solved_To_Acceptable_Level")


@dataclass(frozen=True, eq=False)
class Answer:
    """A solver's solution: never reported, only a start for the exact active set.

    `multipliers` has an array for each family, in the order of its points, and the equations' last.
    """

    x: Array
    multipliers: list[Array]
    success: bool
    status: str
    iterations: int
    weightless: float = 1e-13  #: of the greatest multiplier of a family: what is less is rounding, or a barrier's

    @classmethod
    def missing(cls, program: Program, points: list[Points], status: str, iterations: int = 0) -> Answer:
        """That of a solver that has none, and says why."""
        nothing = [np.zeros(len(grid.u)) for grid in points]
        x = np.full(program.size, np.nan)
        return cls(x, [*nothing, np.zeros(len(program.right))], success=False, status=status, iterations=iterations)

    @property
    def usable(self) -> bool:
        """Whether x is a start for the exact active set: an answer that is nearly one is, it is polished anyway."""
        return self.success or self.status in _NEARLY
