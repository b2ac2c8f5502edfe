"""Solutions of many problems as plain data that are read back as they were, with the errors of missing ones.

Nothing that is read is taken on trust: each law is read as a solution that stands alone, and a problem has no law only
where its proof shows that of this problem.
"""

from __future__ import annotations

from functools import partial
from math import prod
from typing import NamedTuple

import msgspec
import numpy as np

from optlaws.errors import InputError, OptlawsError, located
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.arrays.programs import NO_CONTACT
from optlaws.synthesis.problem.plain_entries import read_entries
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.proof.data import as_json, problem_of, stated
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.stored_rows import Plain, StatedError, StatedSolution, attributes, plainly, read_error


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
                results[place] = read_error(row, partial(problems.problem, place))
            else:
                state = {"state": beside[place]} if place in beside else {}
                results[place] = _solution(stated(state | data, StatedSolution, "solution"), problems, place)
    return StoredSolutions(problems, results, entries.seconds)


def _solution(row: StatedSolution, problems: ProblemArray, place: int) -> Solution:
    problem = problems.problem(place)
    if row.problem != as_json(problem.to_dict()):
        raise InputError("its problem is another than that of the arrays")
    return Solution(**attributes(row, problem))


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
