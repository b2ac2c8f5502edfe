"""Points of a study that are solved together, as arrays, where they are convex."""

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
from optlaws.synthesis.problem.fields import from_entries
from optlaws.synthesis.problem.mixtures import meant
from optlaws.synthesis.solve_array import solved

Inputs = Mapping[str, Any]
Row = dict[str, Any]

#: numbers of a row that the solutions have as arrays
_NUMBERS = ("objective", "lower_bound", "gap", "limit", "B", "C", "D", "J", "rms_c")


def runs(points: Sequence[tuple[int, Inputs]]) -> Iterator[list[tuple[int, Inputs]]]:
    """Points in their order, cut where anything but the number B changes.

    Examples
    --------
    >>> points = [(i, {"order": order, "B": B}) for i, (order, B) in enumerate([(3, 1.5), (3, 1.6), (4, 1.6)])]
    >>> [len(run) for run in runs(points)]
    [2, 1]
    """

    def shared(point: tuple[int, Inputs]) -> tuple[object, ...]:
        inputs = point[1]
        is_number = isinstance(inputs.get("B"), float)
        return (is_number, *((name, repr(value)) for name, value in inputs.items() if name != "B" or not is_number))

    return (list(run) for _, run in groupby(points, shared))


def convex_array(base: Mapping[str, Any], run: Sequence[tuple[int, Inputs]]) -> ProblemArray | None:
    """The problems of a run as one array; None where they are none, are not convex, or text has places for B.

    Examples
    --------
    >>> convex_array({"order": 4}, [(0, {"B": 1.5}), (1, {"B": 1.6})]).shape
    (2,)
    """
    first = run[0][1]
    texts = [value for value in (*base.values(), *base.get("bounds", {}), *first.values()) if isinstance(value, str)]
    if not isinstance(first.get("B"), float) or any("{B}" in text or "{1-B}" in text for text in texts):
        return None
    try:
        fields = from_entries(entries(base, {**first, "B": 2.0}))
        if not Problem(**fields).convex:
            return None
    except InputError:
        return None
    return ProblemArray(**{**fields, "B": np.array([inputs["B"] for _, inputs in run])})


def solved_rows(problems: ProblemArray, bound: str) -> tuple[list[Row | OptlawsError], float]:
    """What came out at each point, entries of its row or its error; and the time of each, its share of that of all."""
    began = perf_counter()
    with meant():
        rows = _rows(solved(problems, bound=bound))
    return rows, (perf_counter() - began) / max(len(rows), 1)


def _rows(found: SolutionArray) -> list[Row | OptlawsError]:
    columns: dict[str, list[Any]] = {name: _plain(getattr(found, name)) for name in _NUMBERS}
    columns["status"], columns["law"] = found.status.tolist(), found.stored_laws()
    iterations = [0] * found.size
    for place, one in found.others.items():
        iterations[place] = getattr(one, "iterations", 0)
    columns["iterations"] = iterations
    rows = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    return [found.errors.get(i, row) for i, row in enumerate(rows)]


def _plain(values: NDArray[np.float64]) -> list[float | None]:
    return [value if isfinite(value) else None for value in values.tolist()]
