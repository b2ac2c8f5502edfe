"""The report of a solution: its status and its bounds, and the curves of its law within the limits of its problem."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import TYPE_CHECKING, Any

from optlaws.kept import kept_property
from optlaws.laws.report import LawReport, law_panels
from optlaws.shown.report import Panel, PanelLimit
from optlaws.shown.summary import Summary

if TYPE_CHECKING:
    from optlaws.synthesis.problem.problem import Problem
    from optlaws.synthesis.solution import Solution

#: constants that limit a curve: the curve, and the sides on which they do
_LIMITING = {
    "B": ("b", "-+"),
    "C": ("c", "-+"),
    "D": ("d", "-+"),
    "J": ("j", "-+"),
    "C_plus": ("c", "+"),
    "C_minus": ("c", "-"),
}


@dataclass(frozen=True)
class SolutionReport(LawReport):
    """The report of a solution; its panels are a, b, c, d and j over k, dimensionless."""

    solution: Solution

    @property
    def facts(self) -> Summary:
        """The summary of the solution."""
        return self.solution.summary()

    @kept_property
    def panels(self) -> tuple[Panel, ...]:
        """The curves of the law, with the bounds and the windows of the problem."""
        limits = list(_limits(self.solution.problem))
        return tuple(
            replace(panel, limits=tuple(limit for letter, limit in limits if panel.name.endswith(f" {letter}")))
            for panel in law_panels(self.law)
        )

    @property
    def data(self) -> dict[str, Any]:
        """The solution with its proof."""
        return self.solution.to_dict()


def _limits(problem: Problem) -> Iterator[tuple[str, PanelLimit]]:
    """The limits that a problem sets to a, b, c, d and j: bounds of their peaks or of one side, and windows."""
    for name, (letter, sides) in _LIMITING.items():
        bound = problem.range(name)
        if bound is not None and isfinite(bound.high):
            ends = -bound.high if "-" in sides else -inf, bound.high if "+" in sides else inf
            yield letter, PanelLimit(0.0, 1.0, *ends, f"{name} {'=' if bound.fixed else 'at most'} {bound.high:.6g}")
    for each in problem.windows:
        name = "via point" if each.point else "window"
        yield each.quantity, PanelLimit(each.start, each.stop, each.low, each.high, name)
