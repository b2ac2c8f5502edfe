"""Solving a chunk of points in this process: plain data in, rows out."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import msgspec

from optlaws.echo import cut
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.files.typed import typed
from optlaws.numbers import bounded
from optlaws.studies.points.points import key, keys_along
from optlaws.studies.points.study_file import entries
from optlaws.studies.solving import together
from optlaws.synthesis import Problem, Solution, synthesize
from optlaws.synthesis.problem.mixtures import meant

INFEASIBLE, WRONG_INPUT, NOT_FOUND = "infeasible", "wrong input", "not found"
TIME_LIMIT, DIED, ERROR = "time limit", "worker died", "error"
SOLVED = ("optimal", "local", "inaccurate")
STATUSES = (*SOLVED, INFEASIBLE, NOT_FOUND, WRONG_INPUT, TIME_LIMIT, DIED, ERROR)
_CONSTANTS = ("B", "C", "D", "J")

Row = dict[str, Any]
Run = Sequence[tuple[int, Mapping[str, Any]]]


class Task(msgspec.Struct, kw_only=True):
    """A chunk of points as plain data: the shared entries of their problems and what varies, by index."""

    chunk: int
    problem: dict[str, Any]
    points: list[tuple[int, dict[str, Any]]]
    bound: str = "quick"
    time_limit: float = 60.0
    imports: list[str] = []
    alone: bool = False


def in_process(task: Mapping[str, Any]) -> list[bytes]:
    """The rows of a chunk, solved here: for executors that need no watch over them, such as a serial one."""
    return list(rows(typed(task, Task)))


def rows(task: Task, begin: int = 0) -> Iterator[bytes]:
    """The rows of a chunk from one of its points on, one JSON text each."""
    for block in blocks(task, begin):
        yield from block


def blocks(task: Task, begin: int = 0) -> Iterator[list[bytes]]:
    """The rows of a chunk from one of its points on, those that came together in one list.

    Problems that differ in numbers are solved together where they can be, unless the task wants each alone; others in
    turn. A chunk begins cold, and so does a point after one without a law: its rows depend on nothing solved before it.
    """
    encode = msgspec.json.Encoder().encode
    for module in task.imports:
        importlib.import_module(module)
    for run in together.runs(task.points[begin:]):
        rows = _together(task, run)
        if rows is not None:
            yield [encode(row) for row in rows]
        else:
            yield from ([encode(row)] for row in _in_turn(task, run))


def _together(task: Task, run: Run) -> Iterator[Row] | None:
    """The rows of points that are solved as arrays; None where they cannot be."""
    if task.alone or len(run) == 1:
        return None
    along = together.along_B(task.problem, run)
    problems = (together.array_along_B if along else together.array_of)(task.problem, run, task.bound)
    if problems is None:
        return None
    try:
        rows, seconds = together.solved_rows(problems, task.bound)
    except Exception:  # noqa: BLE001 - whichever point it is of, alone it spoils its own row only
        return None
    blanks = _blanks(task, run) if along else (blank(task, index, inputs) for index, inputs in run)
    return (
        {**entry, **(_of_error(row, seconds) if isinstance(row, OptlawsError) else {**row, "seconds": seconds})}
        for entry, row in zip(blanks, rows, strict=True)
    )


def _in_turn(task: Task, run: Run) -> Iterator[Row]:
    previous: Solution | None = None
    for index, inputs in run:
        solved = solve(task, inputs, previous)
        previous = solved.solution
        yield {**blank(task, index, inputs), **solved.row}


def _blanks(task: Task, run: Run) -> Iterator[Row]:
    """The rows of points that differ in B alone before anything is known of them."""
    index, inputs = run[0]
    first, asked = blank(task, index, inputs), entries(task.problem, inputs)
    keys = keys_along(asked, "B", [inputs["B"] for _, inputs in run])
    return ({**first, "index": i, "key": key, "inputs": own} for (i, own), key in zip(run, keys, strict=True))


@dataclass(frozen=True)
class Solved:
    """What a point gave: the entries of its row, and the solution to start a neighbour from."""

    row: Row
    solution: Solution | None = None


def blank(task: Task, index: int, inputs: Mapping[str, Any]) -> Row:
    """The row of a point before anything is known of it."""
    asked = entries(task.problem, inputs)
    row: Row = {"index": index, "key": key(asked), "inputs": inputs, "status": ERROR}
    row |= dict.fromkeys(("objective", "lower_bound", "gap", "limit", *_CONSTANTS, "rms_c", "iterations"))
    return row | {"seconds": 0.0, "law": None, "error": None}


def failed(task: Task, place: int, status: str, error: str, seconds: float) -> bytes:
    """The row of a point that did not come back."""
    index, inputs = task.points[place]
    return msgspec.json.encode(blank(task, index, inputs) | {"status": status, "error": cut(error), "seconds": seconds})


def solve(task: Task, inputs: Mapping[str, Any], previous: Solution | None) -> Solved:
    """Solve one point; whatever happens ends in its row."""
    began = perf_counter()
    try:
        problem = Problem.from_dict(entries(task.problem, inputs))
        # continued where problems are not convex, the law of a branch that has become the worse one would stay
        start = previous if problem.convex else None
        with meant():
            solution = synthesize(problem, start=start, bound=task.bound)
        row = _row(solution)
    except Exception as error:  # noqa: BLE001 - a point must not end the study; its row keeps what happened
        return Solved(_of_error(error, perf_counter() - began))
    return Solved({**row, "seconds": perf_counter() - began}, solution)


def _of_error(error: Exception, seconds: float) -> Row:
    """The row of a point without a law."""
    if isinstance(error, InfeasibleProblem):
        status, text = INFEASIBLE, error.args[0]
    elif isinstance(error, SolverFailure):
        status, text = NOT_FOUND, error.args[0]
    elif isinstance(error, InputError):
        status, text = WRONG_INPUT, str(error)
    else:
        status, text = ERROR, f"{type(error).__name__}: {error}"
    return {"status": status, "error": cut(text), "seconds": seconds}


def _row(solution: Solution) -> Row:
    constants = solution.constants
    row: Row = {name: bounded(getattr(constants, name).value) for name in _CONSTANTS}
    return row | {
        "status": solution.status.value,
        "objective": solution.objective,
        "lower_bound": bounded(solution.lower_bound),
        "gap": bounded(solution.gap),
        "limit": solution.limit,
        "rms_c": bounded(constants.rms_c),
        "iterations": solution.iterations,
        "law": solution.law.to_dict(),
    }
