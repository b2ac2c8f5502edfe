"""A line of problems of which laws are asked for again and again: where its structures change is found once."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.synthesis.arrays.along import laws_on, segments_of
from optlaws.synthesis.arrays.lines import form_of
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.arrays.programs import Path, between
from optlaws.synthesis.arrays.walk import Segment
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.solution_array import SolutionArray
from optlaws.synthesis.solve_array import completed, solved
from optlaws.synthesis.solved_parts import Part

Array = NDArray[np.float64]


class SolvedLine:
    """Convex problems between two, that differ in one number in which their programs are affine.

    Parameters
    ----------
    problems
        The problems at some values of the number.
    low, high
        The ends.

    Examples
    --------
    >>> line = SolvedLine(lambda values: ProblemArray(B=values, order=4), 1.6, 1.8)
    >>> line.at(np.array([1.62, 1.7])).C.round(5).tolist(), line.at(np.array([1.65])).C.round(5).tolist()
    ([5.17368, 4.81977], [5.04086])
    """

    def __init__(self, problems: Callable[[Array], ProblemArray], low: float, high: float) -> None:
        self._problems, self.low, self.high = problems, low, high

    def at(self, values: Array) -> SolutionArray:
        """What is solved at values of the number; few at a time are as quick as many."""
        began, problems = perf_counter(), self._problems(values)
        if self._path is None:
            return solved(problems)
        t = (values - self.low) / (self.high - self.low)
        order = np.argsort(t, kind="stable")
        order = order[(t[order] >= 0.0) & (t[order] <= 1.0)]
        laws = laws_on(self._path, self._segments, t[order])
        rows = np.flatnonzero(laws.solved)
        parts = [Part(order[rows], self._path.model, laws.taken(rows).frozen())] if len(rows) else []
        return completed(problems, parts, {}, began)

    @kept_property
    def _path(self) -> Path | None:
        """The programs from one end to the other; None where they are not on a path."""
        ends = self._problems(np.array([self.low, self.high]))
        try:
            first, last = ends.problem(0), ends.problem(1)
        except InputError:
            return None
        return between(first, last) if _one_form(first, last) else None

    @kept_property
    def _segments(self) -> list[Segment]:
        return [] if self._path is None else segments_of(self._path, 0.0, 1.0)


def _one_form(first: Problem, last: Problem) -> bool:
    one, other = form_of(first).key, form_of(last).key
    return first.convex and one is not None and one == other
