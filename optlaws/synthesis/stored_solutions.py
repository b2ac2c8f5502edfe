"""Solutions of many problems as plain data that are read back as they were, with the errors of missing ones.

Nothing that is read is taken on trust: each law is read as a solution that stands alone, and a problem has no law only
where its proof shows that of this problem.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from math import inf, isfinite, prod
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError, OptlawsError, located
from optlaws.numbers import bounded
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.arrays.programs import NO_CONTACT
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.proof.data import as_json, problem_of, stated
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.spaces.bases import Basis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.stored_rows import Plain, StatedError, StatedSolution, attributes, plainly, read_error

#: kinds of numpy's arrays of numbers
_NUMBERS = "fiub"


def plain_entries(entries: Mapping[str, Any]) -> dict[str, Any] | None:
    """Entries as plain data; None where one is of a kind that cannot be read back.

    >>> plain_entries({"B": np.array([1.5, 1.6]), "order": 4})
    {'B': {'array': [1.5, 1.6], 'shape': [2], 'type': 'float64'}, 'order': 4}
    """
    try:
        return {name: _plain(value) for name, value in entries.items()}
    except TypeError:
        return None


def read_entries(data: Mapping[str, Any]) -> dict[str, Any]:
    """The entries that `plain_entries` wrote."""
    return {name: _read(value) for name, value in data.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return _plain_array(value)
    if isinstance(value, Range):
        return [value.low, bounded(value.high)]
    if isinstance(value, Basis):
        return {"basis": dict(value.to_dict())}
    if isinstance(value, Mapping):
        return {"named": {_name(key): _plain(part) for key, part in value.items()}}
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if value is None or type(value) in {bool, int, float, str}:
        return value
    raise TypeError(type(value).__name__)


def _plain_array(values: NDArray[Any]) -> dict[str, Any]:
    shape = list(values.shape)
    if values.dtype == object:
        return {"objects": [_plain_object(value) for value in values.reshape(-1).tolist()], "shape": shape}
    if values.dtype.kind not in _NUMBERS:
        raise TypeError(str(values.dtype))
    flat = [value if np.isfinite(value) else str(value) for value in values.reshape(-1).tolist()]
    return {"array": flat, "shape": shape, "type": str(values.dtype)}


def _plain_object(value: Any) -> Any:
    """An object at one place of an array, each read back as it was written."""
    if isinstance(value, Range):
        return {"range": [value.low, bounded(value.high)]}
    if isinstance(value, Window):
        return {"window": value.to_dict()}
    if isinstance(value, BoundaryConditions):
        return {"start": list(map(float, value.start)), "end": list(map(float, value.end))}
    if isinstance(value, float) and not isfinite(value):
        return {"number": str(value)}
    return _plain(value)


def _read_object(value: Any) -> Any:
    if not isinstance(value, dict):
        return _read(value)
    if "range" in value:
        low, high = value["range"]
        return Range(low, inf if high is None else high)
    if "window" in value:
        return Window.from_dict(value["window"])
    if "start" in value:
        return BoundaryConditions(value["start"], value["end"])
    return float(value["number"]) if "number" in value else _read(value)


def _name(key: object) -> str:
    if not isinstance(key, str):
        raise TypeError(type(key).__name__)
    return key


def _read(value: Any) -> Any:
    if isinstance(value, list):
        return tuple(map(_read, value))
    if not isinstance(value, dict):
        return value
    if "array" in value:
        kind = np.dtype(str(value["type"]))
        if kind.kind not in _NUMBERS:
            raise InputError(f"an array of entries is one of numbers, got {shortened(value['type'])}")
        numbers = [float(number) if isinstance(number, str) else number for number in value["array"]]
        return np.array(numbers, dtype=kind).reshape(value["shape"])
    if "objects" in value:
        objects = np.empty(len(value["objects"]), dtype=object)
        for i, stored in enumerate(value["objects"]):
            objects[i] = _read_object(stored)
        return objects.reshape(value["shape"])
    if "basis" in value:
        return Basis.from_dict(value["basis"])
    return {name: _read(part) for name, part in value["named"].items()}


class StatedSolutions(msgspec.Struct, forbid_unknown_fields=True):
    """The data that `SolutionArray.to_dict` writes; files of version 1.0 have the states of laws beside them."""

    shape: list[int]
    seconds: float
    solutions: list[Plain]
    problems: Plain | None
    parts: list[Plain] = []
    alone: dict[str, Plain] = {}
    about: str = ""


class StoredSolutions(NamedTuple):
    """Stored solutions: the problems, and a solution or an error of each place."""

    problems: ProblemArray
    results: dict[int, Solution | OptlawsError]
    seconds: float


def read_solutions(data: object) -> StoredSolutions:
    """Read what `SolutionArray.to_dict` wrote, and check all that is taken from it.

    Raises
    ------
    InputError
        If an entry is missing or wrong, or states what does not follow from the problems, the laws and the proofs.
    """
    entries = stated(data, StatedSolutions, "stored array of solutions")
    size, shape = prod(entries.shape), tuple(entries.shape)
    if min(shape, default=0) < 0 or size != len(entries.solutions):
        raise InputError(f"an array of solutions of shape {shape} has {size} solutions, got {len(entries.solutions)}")
    return plainly(lambda: _stored(entries, shape), "this is no array of solutions")


def _stored(entries: StatedSolutions, shape: tuple[int, ...]) -> StoredSolutions:
    problems, beside = _problems(entries, shape), _states_beside(entries)
    results: dict[int, Solution | OptlawsError] = {}
    for place, data in enumerate(entries.solutions):
        with located(f"solutions[{place}]"):
            if "error" in data:
                row = stated(data, StatedError, "row without a law")
                if row.problem is not None:
                    _check_problem(row.problem, problems.problem(place))
                results[place] = read_error(row, partial(problems.problem, place))
            else:
                state = {"state": beside[place]} if place in beside else {}
                law, problem = stated(state | data, StatedSolution, "solution"), problems.problem(place)
                _check_problem(law.problem, problem)
                results[place] = Solution(**attributes(law, problem))
    return StoredSolutions(problems, results, entries.seconds)


def _check_problem(given: Plain, problem: Problem) -> None:
    if given != as_json(problem.to_dict()):
        raise InputError("its problem is another than that of the arrays")


def _problems(entries: StatedSolutions, shape: tuple[int, ...]) -> ProblemArray:
    if entries.problems is None:
        given = [problem_of(row["problem"]) if "problem" in row else None for row in entries.solutions]
        return ProblemArray.of(given, shape)
    array = ProblemArray(**read_entries(entries.problems))
    if array.shape == shape:
        return array
    if array.size != 1:
        raise InputError(f"problems of shape {array.shape} are no array of solutions of shape {shape}")
    # entries without arrays may have been taken many times
    return array.taken(np.zeros(shape, dtype=np.intp))


def _states_beside(entries: StatedSolutions) -> dict[int, Plain]:
    """The states of laws, by their places, of files that have them beside the laws."""
    states: dict[int, Plain] = {int(place): state for place, state in entries.alone.items()}
    names = {"family": "family", "u": "u", "sign": "s", "free": "free", "multiplier": "multipliers"}
    for part in entries.parts:
        model, optima = model_of(problem_of(part["problem"])), part["found"]
        for row, place in enumerate(part["places"]):
            contacts = [i for i, family in enumerate(optima["family"][row]) if family != NO_CONTACT]
            columns = {name: [optima[stored][row][i] for i in contacts] for stored, name in names.items()}
            x, equations = optima["x"][row], optima["equations"][row]
            states[place] = {
                "z_series": list(model.space.z_series(model.coordinates(np.array(x)))),
                "active_set": {"x": x, **columns, "equality_multipliers": equations},
            }
    return states
