"""Solution of a chunk of points in this process, as arrays or in sequence: plain data in, rows out."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, groupby
from math import isfinite
from time import perf_counter
from typing import Any

import msgspec
import numpy as np

from optlaws.echo import cut
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.files.problem_file import typed
from optlaws.numbers import bounded
from optlaws.studies.points import key, keys_along
from optlaws.studies.specification import entries
from optlaws.studies.tables import CONSTANTS, StudyPoint
from optlaws.synthesis import Problem, ProblemArray, Solution, SolutionArray, Status, synthesize
from optlaws.synthesis.arrays.lines import least_count, least_power, lines_of
from optlaws.synthesis.problem.constants import meant
from optlaws.synthesis.problem.problem import from_entries
from optlaws.synthesis.solve import Bound
from optlaws.synthesis.solve_many import solved

#: numbers of a row that the solutions of an array have as arrays
_NUMBERS = ("objective", "lower_bound", "gap", "best_possible", *CONSTANTS)
#: of the points of a run: so many must be on lines, else each is solved from the one before it
_MOSTLY = 0.75

Inputs = Mapping[str, Any]
Run = Sequence[tuple[int, Inputs]]
_encode = msgspec.json.encode


@dataclass(frozen=True, kw_only=True)
class Task:
    """A chunk of points as plain data: the shared entries of their problems and what varies, by index."""

    chunk: int
    problem: dict[str, Any]
    points: list[tuple[int, dict[str, Any]]]
    bound: Bound = "quick"
    time_limit: float = 60.0
    imports: tuple[str, ...] = ()
    alone: bool = False


def in_process(task: Mapping[str, Any]) -> list[bytes]:
    """The rows of a chunk, solved here: for executors that need no watch over them, such as a serial one."""
    return list(chain.from_iterable(blocks(typed(task, Task))))


def blocks(task: Task, begin: int = 0) -> Iterator[list[bytes]]:
    """The rows of a chunk from one of its points on; rows that were solved together are in one list.

    Problems that differ in numbers are solved as arrays where they can be, unless the task wants each alone; others in
    turn. A chunk begins cold, and so does a point after one without a law: its rows depend on nothing solved before it.
    """
    for module in task.imports:
        importlib.import_module(module)
    for run in runs(task.points[begin:]):
        block = None if task.alone or len(run) == 1 else _as_array(task, run)
        if block is not None:
            yield block
        else:
            yield from _in_turn(task, run)


def failed(task: Task, place: int, status: Status, error: str, seconds: float) -> bytes:
    """The row of a point that did not come back."""
    return _row(task, *task.points[place], {"status": status, "error": cut(error), "seconds": seconds})


def _row(task: Task, index: int, inputs: Inputs, results: Mapping[str, Any]) -> bytes:
    """The row of one point."""
    return _encode(StudyPoint(index=index, key=key(entries(task.problem, inputs)), inputs=dict(inputs), **results))


def _in_turn(task: Task, run: Run) -> Iterator[list[bytes]]:
    """The rows of points in sequence, each started from its predecessor."""
    previous: Solution | None = None
    for index, inputs in run:
        results, previous = _solve(task, inputs, previous)
        yield [_row(task, index, inputs, results)]


def _solve(task: Task, inputs: Inputs, previous: Solution | None) -> tuple[dict[str, Any], Solution | None]:
    """The result at one point, and the solution that the next point starts from."""
    began = perf_counter()
    solution = None
    try:
        problem = Problem.from_dict(entries(task.problem, inputs))
        # continued where problems are not convex, the law of a branch that has become the worse one would stay
        start = previous if problem.convex else None
        with meant():
            solution = synthesize(problem, start=start, bound=task.bound)
        results = _of_solution(solution)
    except Exception as error:  # noqa: BLE001 - a point must not end the study; its row keeps what happened
        solution, results = None, _of_error(error)
    return {**results, "seconds": perf_counter() - began}, solution


def _of_solution(solution: Solution) -> dict[str, Any]:
    """The results of a point with a law."""
    constants = solution.constants
    return {
        "status": solution.status,
        "objective": solution.objective,
        "lower_bound": bounded(solution.lower_bound),
        "gap": bounded(solution.gap),
        "best_possible": solution.best_possible,
        **{name: bounded(getattr(constants, name).value) for name in "BCDJ"},
        "rms_c": bounded(constants.rms_c),
        "iterations": solution.iterations,
        "stored": _raw(solution.law.to_dict()),
    }


def _of_error(error: Exception) -> dict[str, Any]:
    """The results of a point without a law."""
    if not isinstance(error, OptlawsError):
        return {"status": Status.ERROR, "error": cut(f"{type(error).__name__}: {error}")}
    text = str(error.args[0]) if isinstance(error, InfeasibleProblem | SolverFailure) else str(error)
    return {"status": Status.of(error), "error": cut(text)}


def _raw(law: object) -> msgspec.Raw:
    return msgspec.Raw(_encode(law))


def runs(points: Run) -> Iterator[list[tuple[int, Inputs]]]:
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


def _as_array(task: Task, run: Run) -> list[bytes] | None:
    """The rows of points that are solved as an array; None where they cannot be."""
    along = along_B(task.problem, run)
    problems = (array_along_B if along else array_of)(task.problem, run, task.bound)
    if problems is None:
        return None
    began = perf_counter()
    try:
        results = solved_rows(problems, task.bound)
    except Exception:  # noqa: BLE001 - whichever point it is of, alone it spoils its own row only
        return None
    # each has its share of the time
    seconds = (perf_counter() - began) / len(run)
    if along:
        keys = keys_along(entries(task.problem, run[0][1]), "B", [inputs["B"] for _, inputs in run])
    else:
        keys = (key(entries(task.problem, inputs)) for _, inputs in run)
    return [
        _encode(StudyPoint(index=index, key=name, inputs=dict(inputs), seconds=seconds, **result))
        for (index, inputs), name, result in zip(run, keys, results, strict=True)
    ]


def solved_rows(problems: ProblemArray, bound: Bound) -> list[dict[str, Any]]:
    """The results of each point of an array."""
    with meant():
        return _of_solutions(solved(problems, bound=bound))


def _of_solutions(laws: SolutionArray) -> list[dict[str, Any]]:
    columns: dict[str, list[Any]] = {
        name: [value if isfinite(value) else None for value in getattr(laws, name).tolist()] for name in _NUMBERS
    }
    columns["status"], columns["stored"] = laws.status.tolist(), list(map(_raw, laws.stored_laws()))
    columns["iterations"] = [0] * laws.size
    for place, result in laws.others.items():
        columns["iterations"][place] = getattr(result, "iterations", 0)
    results = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    for place, error in laws.errors.items():
        results[place] = _of_error(error)
    return results


def along_B(base: Mapping[str, Any], run: Run) -> bool:
    """Whether the points of a run differ in B alone, and no text of the problem contains a placeholder.

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


def array_along_B(base: Mapping[str, Any], run: Run, bound: Bound) -> ProblemArray | None:
    """The problems of a run along B as an array; None where they are not, or are better solved in sequence."""
    try:
        fields = from_entries(entries(base, {**run[0][1], "B": 2.0}))
        problem = Problem(**fields)
    except InputError:
        return None
    if not (problem.convex or (bound == "quick" and least_power(problem) and len(run) >= least_count(problem))):
        return None
    alike = {name: _tuples(value) for name, value in fields.items()}
    return ProblemArray(**{**alike, "B": np.array([inputs["B"] for _, inputs in run])})


def _tuples(value: Any) -> Any:
    """Pairs of bounds as tuples: lists would be arrays."""
    if isinstance(value, Mapping):
        return {name: _tuples(entry) for name, entry in value.items()}
    return tuple(value) if isinstance(value, list) else value


def array_of(base: Mapping[str, Any], run: Run, bound: Bound) -> ProblemArray | None:
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
    if not (problems[0].convex or (bound == "quick" and least_power(problems[0]))):
        return None
    on_lines = sum(len(line.places) for line in lines_of(problems, np.arange(len(problems))))
    return ProblemArray.of(problems) if on_lines >= _MOSTLY * len(problems) else None
