"""Reports of solutions, with the curves of their laws within the limits of their problems, and of fronts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import TYPE_CHECKING, Any

from optlaws.kept import kept_property
from optlaws.laws.report import LawReport, law_panels
from optlaws.numbers import Array
from optlaws.shown.report import Panel, PanelLimit, PlainReport, ReportTable, Series
from optlaws.shown.summary import Row, Summary
from optlaws.synthesis.problem.named_constants import title_of

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


_AXES = {"B": "peak velocity B", "C": "peak acceleration C", "D": "peak power D", "J": "peak jerk J"}


def axis_label(name: str) -> str:
    """What an axis for a constant is called: constants of machines have units of their own."""
    title = title_of(name)
    return title if title != name else f"{_AXES.get(name, name)} (dimensionless)"


def front_report(
    over: Sequence[str],
    facts: Sequence[Row],
    table: ReportTable,
    curves: Sequence[tuple[str, Array, Array]],
    plain: Callable[[], dict[str, Any]],
) -> PlainReport:
    """The report of a front: its points with their bounds and, of two constants, curves of the last over the first."""
    series = tuple(Series(at, values, i, name) for i, (name, at, values) in enumerate(curves))
    ends = (float(series[0].values.min()), float(series[0].values.max())) if series else (0.0, 0.0)
    panel = Panel(axis_label(over[-1]), "", series, ends=ends, across=axis_label(over[0]), per=1.0)
    return PlainReport(Summary(facts), [table], [panel] if series else [], plain)
