"""Solutions of many problems as plain data that are read back as they were, with the errors of those without a law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from math import inf, isfinite, prod
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.laws import MotionLaw
from optlaws.numbers import bounded
from optlaws.synthesis.arrays.found import Found
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.data import problem_of, stated
from optlaws.synthesis.proof.peaks.certificate import PeakCertificate
from optlaws.synthesis.proof.power.certificate import PowerCertificate
from optlaws.synthesis.solution import Solution, Status
from optlaws.synthesis.spaces.bases import Basis, basis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

#: what stands for the status of a problem without a law
INFEASIBLE, FAILED, INVALID = "infeasible", "failed", "invalid"

Plain = dict[str, Any]


class StatedPart(msgspec.Struct, forbid_unknown_fields=True):
    """Laws that were found together: their places, a problem of their kind, and their optima as arrays."""

    places: list[int]
    problem: Plain
    found: Plain


class StatedAlone(msgspec.Struct, forbid_unknown_fields=True):
    """What the row of a law that was found alone does not say."""

    z_series: list[float]
    active_set: Plain


class StatedSolutions(msgspec.Struct, forbid_unknown_fields=True):
    """What `SolutionArray.to_dict` writes."""

    shape: list[int]
    seconds: float
    solutions: list[Plain]
    problems: Plain | None
    parts: list[StatedPart]
    alone: dict[str, StatedAlone]
    about: str = ""


@dataclass(frozen=True, eq=False)
class Stored:
    """What was stored: the problems, the optima found together by place and program, and all that was found alone."""

    problems: ProblemArray
    parts: list[tuple[NDArray[np.intp], Model, Found]]
    others: dict[int, Solution | OptlawsError]
    seconds: float
    rows: list[Plain]


def status_of_error(error: OptlawsError) -> str:
    """What stands for the status of a problem with this error."""
    if isinstance(error, InfeasibleProblem):
        return INFEASIBLE
    return INVALID if isinstance(error, InputError) else FAILED


def plain_error(error: OptlawsError) -> Plain:
    """An error as plain data, from which `read_solutions` makes one that says and proves the same."""
    data: Plain = {"status": status_of_error(error), "error": str(error.args[0]) if error.args else ""}
    for name in ("problem", "proof"):
        value = getattr(error, name, None)
        if value is not None:
            data[name] = value.to_dict()
    tried = getattr(error, "tried", "")
    return {**data, "tried": tried} if tried else data


def plain_alone(solution: Solution) -> Plain:
    """What is kept of a law that was found alone beside its `to_dict`."""
    state = solution.active_set
    return {
        "z_series": list(solution.z_series),
        "active_set": {field.name: getattr(state, field.name).tolist() for field in fields(state)},
    }


def plain_problems(problems: ProblemArray) -> Plain | None:
    """The entries that were given as plain data; None where they are to be read from the rows."""
    if not problems.entries:
        return None
    try:
        return {name: _plain(value) for name, value in problems.entries.items()}
    except TypeError:
        return None


def read_solutions(data: object) -> Stored:
    """Read what `SolutionArray.to_dict` wrote.

    Raises
    ------
    InputError
        If an entry is missing or wrong.
    """
    stated_array = stated(data, StatedSolutions, "stored array of solutions")
    size, shape = prod(stated_array.shape), tuple(stated_array.shape)
    if min(shape, default=0) < 0 or size != len(stated_array.solutions):
        raise InputError(
            f"an array of solutions of shape {shape} has {size} solutions, got {len(stated_array.solutions)}"
        )
    together = [place for part in stated_array.parts for place in part.places]
    others = [place for place in range(size) if place not in set(together)]
    if len(together) + len(others) != size:
        raise InputError("the parts of an array of solutions name a place twice, or one that it does not have")
    try:
        return Stored(
            _problems(stated_array, shape),
            [_part(part) for part in stated_array.parts],
            {place: _alone(stated_array.solutions[place], stated_array.alone.get(str(place))) for place in others},
            stated_array.seconds,
            stated_array.solutions,
        )
    except (IndexError, KeyError, TypeError, ValueError) as error:
        raise (
            error if isinstance(error, InputError) else InputError(f"this is no array of solutions: {error}")
        ) from None


def _problems(stated_array: StatedSolutions, shape: tuple[int, ...]) -> ProblemArray:
    if stated_array.problems is None:
        return ProblemArray.of(
            [problem_of(row["problem"]) if "problem" in row else None for row in stated_array.solutions], shape
        )
    made = ProblemArray(**{name: _read(value) for name, value in stated_array.problems.items()})
    if made.shape == shape:
        return made
    # entries without arrays may have been taken many times
    places = np.arange(made.size) if made.size > 1 else np.zeros(prod(shape), dtype=np.intp)
    return made.taken(places.reshape(shape))


def _part(part: StatedPart) -> tuple[NDArray[np.intp], Model, Found]:
    places, model, laws = np.array(part.places, dtype=np.intp), model_of(problem_of(part.problem)), part.found
    optima = Found.from_dict(laws).frozen()
    rows = {len(getattr(optima, field.name)) for field in fields(optima)}
    if rows != {len(places)} or optima.x.shape[1] != model.program.size:
        raise InputError("a part of an array of solutions has optima of other problems, or more or fewer than places")
    return places, model, optima


def _alone(row: Plain, kept: StatedAlone | None) -> Solution | OptlawsError:
    if kept is None:
        return _error(row)
    power, peak = row.get("power_certificate"), row.get("peak_certificate")
    return Solution(
        problem=problem_of(row["problem"]),
        law=MotionLaw.from_dict(row["law"]),
        z_series=tuple(kept.z_series),
        objective=row["objective"],
        certificate=Certificate.from_dict(row["certificate"]),
        lower_bound=-inf if row["lower_bound"] is None else row["lower_bound"],
        limit=row["limit"],
        status=Status(row["status"]),
        iterations=row["iterations"],
        seconds=row["seconds"],
        starts=tuple(row["starts"]),
        power_certificate=None if power is None else PowerCertificate.from_dict(power),
        peak_certificate=None if peak is None else PeakCertificate.from_dict(peak),
        active_set=_active_set(kept.active_set),
    )


def _active_set(data: Plain) -> ActiveSet:
    kinds = {"family": np.intp, "free": np.bool_}
    return ActiveSet(**{name: np.array(value, dtype=kinds.get(name, np.float64)) for name, value in data.items()})


def _error(row: Plain) -> OptlawsError:
    problem = problem_of(row["problem"]) if "problem" in row else None
    if row["status"] == INFEASIBLE:
        proof = Certificate.from_dict(row["proof"]) if "proof" in row else None
        return InfeasibleProblem(row["error"], problem=problem, tried=row.get("tried", ""), proof=proof)
    if row["status"] == FAILED:
        return SolverFailure(row["error"], problem=problem, tried=row.get("tried", ""))
    if row["status"] == INVALID:
        return InputError(row["error"])
    raise InputError(f"a row without a law is {INFEASIBLE!r}, {FAILED!r} or {INVALID!r}, got {row['status']!r:.40}")


def _plain(value: Any) -> Any:  # noqa: ANN401
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


def _plain_array(values: NDArray[Any]) -> Plain:
    shape = list(values.shape)
    if values.dtype == object:
        return {"objects": [_plain_object(value) for value in values.reshape(-1).tolist()], "shape": shape}
    if values.dtype.kind not in "fiub":
        raise TypeError(str(values.dtype))
    flat = [value if np.isfinite(value) else str(value) for value in values.reshape(-1).tolist()]
    return {"array": flat, "shape": shape, "type": str(values.dtype)}


def _plain_object(value: Any) -> Any:  # noqa: ANN401
    """What stands at one place of an array of objects, of which each is read back as it was."""
    if isinstance(value, Range):
        return {"range": [value.low, bounded(value.high)]}
    if isinstance(value, Window):
        return {"window": value.to_dict()}
    if isinstance(value, BoundaryConditions):
        return {"start": list(map(float, value.start)), "end": list(map(float, value.end))}
    if isinstance(value, float) and not isfinite(value):
        return {"number": str(value)}
    return _plain(value)


def _read_object(value: Any) -> Any:  # noqa: ANN401
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


def _read(value: Any) -> Any:  # noqa: ANN401
    if isinstance(value, list):
        return tuple(map(_read, value))
    if not isinstance(value, dict):
        return value
    if "array" in value:
        kind = np.dtype(value["type"])
        numbers = [float(one) if isinstance(one, str) else one for one in value["array"]]
        return np.array(numbers, dtype=kind).reshape(value["shape"])
    if "objects" in value:
        objects = np.empty(len(value["objects"]), dtype=object)
        for i, one in enumerate(value["objects"]):
            objects[i] = _read_object(one)
        return objects.reshape(value["shape"])
    if "basis" in value:
        entries = dict(value["basis"])
        return basis(entries.pop("basis"), entries.pop("degree"), **entries)
    return {name: _read(part) for name, part in value["named"].items()}
