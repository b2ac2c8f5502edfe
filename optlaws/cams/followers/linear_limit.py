"""Limits of a cam that are linear in a law: pressure angles of slides and arms, radii of curvature under flat faces."""

from __future__ import annotations

from dataclasses import dataclass

from optlaws.synthesis.functionals.makers import peak
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.windows import Window

PRESSURE, CURVATURE = "pressure angle", "radius of curvature"


@dataclass(frozen=True)
class LinearLimit:
    """A limit of a cam that is linear in a law: the sum of factors times a, b, c is at most `most` in a part of it."""

    factors: tuple[float, float, float]
    most: float
    start: float = 0.0
    stop: float = 1.0

    @property
    def formula(self) -> str:
        """The sum as a text."""
        return " + ".join(f"({factor!r})*{name}" for factor, name in zip(self.factors, "abc", strict=True) if factor)

    def window(self) -> Window:
        """The limit as a window of a problem."""
        return Window(self.formula, high=self.most, start=self.start, stop=self.stop)

    def excess(self) -> Functional:
        """By how much the greatest value of the sum goes beyond the limit."""
        return peak(f"{self.formula} + ({-self.most!r})", side="high")
