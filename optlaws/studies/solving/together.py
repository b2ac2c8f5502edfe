"""Points of a study that are solved together, as arrays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from math import isfinite
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError, OptlawsError
from optlaws.studies.points.study_file import entries
from optlaws.synthesis import Problem, ProblemArray, SolutionArray
from optlaws.synthesis.arrays.lines import least_count, lines_of
from optlaws.synthesis.arrays.powers import least_power
from optlaws.synthesis.problem.fields import from_entries
from optlaws.synthesis.problem.mixtures import meant
from optlaws.synthesis.solve_array import solved

Inputs = Mapping[str, Any]
Row = dict[str, Any]

#: numbers of a row that the solutions have as arrays
_NUMBERS = ("objective", "lower_bound", "gap", "limit", "B", "C", "D", "J", "rms_c")


#: of the points of a run: so many must be on lines, else each is solved from the one before it
_MOSTLY = 0.75


def runs(points: Sequence[tuple[int, Inputs]]) -> Iterator[list[tuple[int, Inputs]]]:
    """Points in their order, cut where anything but numbers changes.

    Examples
    --------
    >>> points = [(i, {"order": order, "B": B}) for i, (order, B) in enumerate([(3, 1.5), (3, 1.6), (4, 1.6)])]
    >>> [len(run) for run in runs(points)]
    [2, 1]
    """

    def shared(point: tuple[int, Inputs]) -> tuple[object, ...]:
        return tuple((name, None if _numbers(value) else repr(value)) for name, value in point[1].items())

    return (list(run) for _, run in groupby(points, shared))


def _numbers(value: object) -> bool:
    """Whether a value is a number, or a pair of bounds."""
    pair = value if isinstance(value, list | tuple) else (value,)
    return all(isinstance(number, float) or (isinstance(number, int) and pair is value) for number in pair)


def along_B(base: Mapping[str, Any], run: Sequence[tuple[int, Inputs]]) -> bool:
    """Whether the points of a run differ in the number B alone, and no text has places for it.

    Examples
    --------
    >>> along_B({"order": 4}, [(0, {"B": 1.5}), (1, {"B": 1.6})])
    True
    >>> along_B({"order": 4, "minimise": "{B}*C + J"}, [(0, {"B": 1.5}), (1, {"B": 1.6})])
    False
    """
    first = run[0][1]
    texts = [value for value in (*base.values(), *base.get("bounds", {}), *first.values()) if isinstance(value, str)]
    if not isinstance(first.get("B"), float) or any("{B}" in text or "{1-B}" in text for text in texts):
        return False
    others = {name: value for name, value in first.items() if name != "B"}
    return all({name: value for name, value in inputs.items() if name != "B"} == others for _, inputs in run)


def array_along_B(base: Mapping[str, Any], run: Sequence[tuple[int, Inputs]], bound: str) -> ProblemArray | None:
    """The problems of a run along B as one array; None where they are none or are better solved in turn.

    Examples
    --------
    >>> array_along_B({"order": 4}, [(0, {"B": 1.5}), (1, {"B": 1.6})], "quick").shape
    (2,)
    """
    try:
        fields = from_entries(entries(base, {**run[0][1], "B": 2.0}))
        if not _worth_an_array(Problem(**fields), len(run), bound):
            return None
    except InputError:
        return None
    return ProblemArray(**{**fields, "B": np.array([inputs["B"] for _, inputs in run])})


def _worth_an_array(problem: Problem, count: int, bound: str) -> bool:
    return problem.convex or (bound == "quick" and least_power(problem) and count >= least_count(problem))


def array_of(base: Mapping[str, Any], run: Sequence[tuple[int, Inputs]], bound: str) -> ProblemArray | None:
    """The problems of a run in which several numbers vary; None unless all are problems, most of them on lines.

    Examples
    --------
    >>> points = [(i, {"B": 1.7, "J": [0.0, 60.0 + i]}) for i in range(150)]
    >>> array_of({"order": 4}, points, "quick").shape, array_of({"order": 4}, points[:9], "quick")
    ((150,), None)
    """
    try:
        problems = [Problem.from_dict(entries(base, inputs)) for _, inputs in run]
    except InputError:
        return None
    if not all(problem.convex or (bound == "quick" and least_power(problem)) for problem in problems[:1]):
        return None
    lines = lines_of(problems, np.arange(len(problems)))
    on_lines = sum(len(line.places) for line in lines)
    return ProblemArray.of(problems) if on_lines >= _MOSTLY * len(problems) else None


def solved_rows(problems: ProblemArray, bound: str) -> tuple[list[Row | OptlawsError], float]:
    """What came out at each point, entries of its row or its error; and the time of each, its share of that of all."""
    began = perf_counter()
    with meant():
        rows = _rows(solved(problems, bound=bound))
    return rows, (perf_counter() - began) / max(len(rows), 1)


def _rows(laws: SolutionArray) -> list[Row | OptlawsError]:
    columns: dict[str, list[Any]] = {name: _plain(getattr(laws, name)) for name in _NUMBERS}
    columns["status"], columns["law"] = laws.status.tolist(), laws.stored_laws()
    iterations = [0] * laws.size
    for place, result in laws.others.items():
        iterations[place] = getattr(result, "iterations", 0)
    columns["iterations"] = iterations
    rows = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    return [laws.errors.get(i, row) for i, row in enumerate(rows)]


def _plain(values: NDArray[np.float64]) -> list[float | None]:
    return [value if isfinite(value) else None for value in values.tolist()]
