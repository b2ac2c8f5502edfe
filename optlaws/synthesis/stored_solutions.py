"""Solutions of many problems as plain data that are read back unchanged, with the errors of missing ones.

Nothing that is read is taken on trust: laws are those of their coordinates, numbers are those of their laws, bounds are
what the proofs beside them prove, and a problem has no law only where its proof shows that of this problem.
"""

from __future__ import annotations

from dataclasses import fields, replace
from functools import partial
from math import inf, prod
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError, OptlawsError, located
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.arrays.programs import FOLLOWING, NO_CONTACT, SolvedBatch
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import Program
from optlaws.synthesis.problem.plain_entries import read_entries
from optlaws.synthesis.problem.problem import Problem, differ_in_numbers
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.data import as_json, problem_of, stated
from optlaws.synthesis.proof.nodes import Leaf
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.stored_rows import (
    Plain,
    StatedError,
    StatedSolution,
    StatedState,
    attributes,
    claims_of,
    equal_data,
    plainly,
    read_error,
)


class StatedOptima(msgspec.Struct, forbid_unknown_fields=True):
    """The data of `SolvedBatch.to_dict`; objectives and excesses, which older files have, are recomputed."""

    x: list[list[float]]
    family: list[list[int]]
    u: list[list[float]]
    sign: list[list[float]]
    free: list[list[bool]]
    multiplier: list[list[float]]
    equations: list[list[float]]
    bound: list[float]
    objective: Any = None
    excess: Any = None


class StatedPart(msgspec.Struct, forbid_unknown_fields=True):
    """Laws that were solved together: their places, a problem of their kind, and their optima as arrays."""

    places: list[int]
    problem: Plain
    optima: StatedOptima = msgspec.field(name="found")


class StatedSolutions(msgspec.Struct, forbid_unknown_fields=True):
    """The data that `SolutionArray.to_dict` writes."""

    shape: list[int]
    seconds: float
    solutions: list[Plain]
    problems: Plain | None
    parts: list[StatedPart]
    alone: dict[str, StatedState]
    about: str = ""


class StoredSolutions(NamedTuple):
    """Stored solutions: the problems, optima solved together by place and program, and those solved singly."""

    problems: ProblemArray
    parts: list[tuple[NDArray[np.intp], Model, SolvedBatch]]
    others: dict[int, Solution | OptlawsError]
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
    together = {place for part in entries.parts for place in part.places}
    if sum(len(part.places) for part in entries.parts) != len(together) or not together <= set(range(size)):
        raise InputError("the parts of an array of solutions name a place twice, or one that it does not have")
    alone = sorted(set(range(size)) - together)
    if not entries.alone.keys() <= set(map(str, alone)):
        raise InputError("an array of solutions lists a law as found singly that is not among its laws")
    return plainly(lambda: _stored(entries, shape, alone), "this is no array of solutions")


def _stored(entries: StatedSolutions, shape: tuple[int, ...], alone: list[int]) -> StoredSolutions:
    rows = [_row(row, f"solutions[{place}]") for place, row in enumerate(entries.solutions)]
    problems = _problems(entries, shape)
    for place, row in enumerate(rows):
        if row.problem is not None and row.problem != as_json(problems.problem(place).to_dict()):
            raise InputError(f"the problem of solutions[{place}] is another than that of the arrays")
    parts = [_part(part, problems, rows) for part in entries.parts]
    others: dict[int, Solution | OptlawsError] = {}
    for place in alone:
        row, state = rows[place], entries.alone.get(str(place))
        with located(f"solutions[{place}]"):
            if isinstance(row, StatedError):
                others[place] = read_error(row, partial(problems.problem, place))
            elif state is None:
                raise InputError("the arrays say nothing of its law")
            else:
                others[place] = Solution(**attributes(row, state, problems.problem(place)))
    return StoredSolutions(problems, parts, others, entries.seconds)


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


def _row(data: Plain, name: str) -> StatedSolution | StatedError:
    what = f"row of an array of solutions ({name})"
    return stated(data, StatedError, what) if "error" in data else stated(data, StatedSolution, what)


def _part(
    part: StatedPart, problems: ProblemArray, rows: list[StatedSolution | StatedError]
) -> tuple[NDArray[np.intp], Model, SolvedBatch]:
    model, stated = model_of(problem_of(part.problem)), part.optima
    optima = {field.name: getattr(stated, field.name) for field in fields(SolvedBatch) if field.name not in FOLLOWING}
    solutions = [rows[place] for place in part.places]
    objective = [getattr(row, "objective", np.nan) for row in solutions]
    laws = SolvedBatch.from_dict({**optima, "objective": objective, "excess": [np.nan] * len(solutions)}).frozen()
    _check_optima(laws, len(part.places), model.program)
    for i, place in enumerate(part.places):
        row = solutions[i]
        if isinstance(row, StatedError):
            raise InputError(f"solutions[{place}] has no law, but the arrays have one")
        problem = problems.problem(place)
        with located(f"solutions[{place}]"):
            _check_row(row, problem, replace(model, problem=problem), laws, i)
    same = problems.problem(part.places[0]) if part.places else model.problem
    if not differ_in_numbers(same, model.problem) or (
        problems.one_objective and repr(same.objective) != repr(model.problem.objective)
    ):
        raise InputError("a part of an array of solutions has optima of other problems")
    return np.array(part.places, dtype=np.intp), model, laws


def _check_optima(laws: SolvedBatch, count: int, program: Program) -> None:
    """Refuse arrays that are no optima of a program."""
    shapes = {(getattr(laws, name).ndim, len(getattr(laws, name))) for name in ("objective", "bound")}
    contacts = {getattr(laws, name).shape for name in ("family", "u", "sign", "free", "multiplier")}
    sizes = {laws.x.shape, laws.equations.shape}
    if (
        shapes != {(1, count)}
        or len(contacts) != 1
        or any(len(shape) != 2 or shape[0] != count for shape in contacts)
        or sizes != {(count, program.size), (count, len(program.right))}
    ):
        raise InputError("a part of an array of solutions has optima of other problems, or more or fewer than places")
    numbers = (laws.x, laws.u, laws.sign, laws.multiplier, laws.equations, laws.bound)
    used = laws.family != NO_CONTACT
    known = used & (laws.family >= 0) & (laws.family < len(program.families))
    if not all(np.isfinite(values).all() for values in numbers) or not (known == used).all():
        raise InputError("a part of an array of solutions has numbers that are not finite, or rows of no program")


def _check_row(row: StatedSolution, problem: Problem, model: Model, laws: SolvedBatch, i: int) -> None:
    """Refuse a row whose law, numbers or proof differ from the arrays."""
    law = model.law(laws.x[i])
    if not equal_data(as_json(law.to_dict()), row.law):
        raise InputError("its law is another than that of the arrays' coordinates")
    claims, bound = claims_of(row, problem, law), float(laws.bound[i])
    if max(bound, -inf if claims["best_possible"] is None else claims["best_possible"]) != claims["lower_bound"]:
        raise InputError(f"its lower bound is {row.lower_bound!r}, but that of the arrays {bound!r}")
    if problem.convex:
        _check_contacts(claims["certificate"].leaf, model.program, laws.active_set(i))


def _check_contacts(leaf: Leaf, program: Program, optimum: ActiveSet) -> None:
    """Refuse contacts and multipliers of the arrays that differ from the row's certificate."""
    order = np.argsort(optimum.family, kind="stable")
    families = [program.families[family] for family in optimum.family[order]]
    places = [float(family.k(optimum.u[j : j + 1])[0]) for family, j in zip(families, order, strict=True)]
    names = ("constraint", "sign", "k", "multiplier")
    columns: list[list[Any]] = [[getattr(contact, name) for contact in leaf.contacts] for name in names]
    arrays: list[list[Any]] = [
        [family.name for family in families],
        optimum.s[order].tolist(),
        np.clip(places, 0.0, 1.0).tolist(),
        optimum.multipliers[order].tolist(),
    ]
    if not equal_data([*arrays, optimum.equality_multipliers.tolist()], [*columns, list(leaf.equations)]):
        raise InputError("its certificate is another than that of the arrays' contacts and multipliers")
