"""The report of a solution: its status and its bounds, and the curves of its law within the limits of its problem."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import TYPE_CHECKING, Any

from optlaws.kept import kept_property
from optlaws.laws.report import LawReport
from optlaws.shown.report import Panel, PanelLimit, ReportSegment, ReportTable
from optlaws.shown.summary import Summary

if TYPE_CHECKING:
    from optlaws.synthesis.problem.problem import Problem
    from optlaws.synthesis.solution import Solution

#: constants that limit a curve on both sides, or on one
_BOTH = {"B": "b", "C": "c", "D": "d", "J": "j"}
_SIDES = {"C_plus": ("c", 1.0), "C_minus": ("c", -1.0)}


@dataclass(frozen=True)
class SolutionReport:
    """The report of a solution; its panels are a, b, c, d and j over k, dimensionless."""

    solution: Solution
    tables: tuple[ReportTable, ...] = ()
    segments: tuple[ReportSegment, ...] = ()

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
            for panel in LawReport(self.solution.law).panels
        )

    @property
    def data(self) -> dict[str, Any]:
        """The solution with its proof."""
        return self.solution.to_dict()


def _limits(problem: Problem) -> Iterator[tuple[str, PanelLimit]]:
    """The limits that a problem sets to a, b, c, d and j: bounds of their peaks or of one side, and windows."""
    for name in (*_BOTH, *_SIDES):
        bound = problem.range(name)
        if bound is not None and isfinite(bound.high):
            letter, side = _SIDES.get(name, (_BOTH.get(name, ""), 0.0))
            low, high = -bound.high if side <= 0.0 else -inf, bound.high if side >= 0.0 else inf
            yield (
                letter,
                PanelLimit(0.0, 1.0, low, high, f"{name} {'=' if bound.fixed else 'at most'} {bound.high:.6g}"),
            )
    for window in problem.windows:
        yield (
            window.quantity,
            PanelLimit(window.start, window.stop, window.low, window.high, "via point" if window.point else "window"),
        )
