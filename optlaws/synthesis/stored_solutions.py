"""Solutions of many problems as plain data that are read back as they were, with the errors of those without a law.

Nothing that is read is taken on trust: laws are those of their coordinates, numbers are those of their laws, bounds are
what the proofs beside them prove, and a problem is said to have no law where its proof shows that of this problem.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from functools import lru_cache, partial
from math import inf, isfinite, prod
from typing import Any, TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.laws import MotionLaw, smoothstep
from optlaws.numerics.tolerances import STORED_COEFFICIENT, STORED_VALUE
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.arrays.programs import FOLLOWING, NO_CONTACT, SolvedBatch
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import Program
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.pareto import Front
from optlaws.synthesis.problem.fields import differ_in_numbers
from optlaws.synthesis.problem.plain_entries import read_entries
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.evaluation import shortfalls, worth
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.data import as_json, problem_of, stated
from optlaws.synthesis.proof.no_law import beyond_limit, proof_of_no_law
from optlaws.synthesis.search import status_of
from optlaws.synthesis.solution import Solution, Status
from optlaws.synthesis.spaces.bases import PolynomialBasis
from optlaws.synthesis.spaces.splines import PiecewiseBasis

Plain = dict[str, Any]
Kind = TypeVar("Kind")


class StatedOptima(msgspec.Struct, forbid_unknown_fields=True):
    """What `SolvedBatch.to_dict` writes; objectives and excesses, which older files have, are recomputed."""

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
    """Laws that were found together: their places, a problem of their kind, and their optima as arrays."""

    places: list[int]
    problem: Plain
    found: StatedOptima


class StatedActiveSet(msgspec.Struct, forbid_unknown_fields=True):
    """What an `ActiveSet` holds."""

    x: list[float]
    family: list[int]
    u: list[float]
    s: list[float]
    free: list[bool]
    multipliers: list[float]
    equality_multipliers: list[float]


class StatedState(msgspec.Struct, forbid_unknown_fields=True):
    """What the claims of a law that was found alone do not say."""

    z_series: list[float]
    active_set: StatedActiveSet


class StatedSolution(msgspec.Struct, forbid_unknown_fields=True):
    """The row of a problem with a law; what is not read here follows from the law and its proofs."""

    problem: Plain
    law: Plain
    certificate: Plain
    status: Status
    objective: float
    lower_bound: float | None
    iterations: int
    seconds: float
    starts: tuple[float, ...]
    gap: Any = None
    limit: Any = None
    constants: Any = None
    z: Any = None
    power_certificate: Plain | None = None
    peak_certificate: Plain | None = None
    versions: Any = None
    state: StatedState | None = None
    about: str = ""


class StatedError(msgspec.Struct, forbid_unknown_fields=True):
    """The row of a problem without a law."""

    status: Status
    error: str
    problem: Plain | None = None
    proof: Plain | None = None
    tried: str = ""
    about: str = ""


class StatedSolutions(msgspec.Struct, forbid_unknown_fields=True):
    """What `SolutionArray.to_dict` writes."""

    shape: list[int]
    seconds: float
    solutions: list[Plain]
    problems: Plain | None
    parts: list[StatedPart]
    alone: dict[str, StatedState]
    about: str = ""


class StatedParetoFront(msgspec.Struct, forbid_unknown_fields=True):
    """What `Front.to_dict` writes."""

    over: list[str]
    values: list[list[float]]
    points: list[Plain]
    failed: list[float] = []
    errors: list[StatedError] = []
    about: str = ""


@dataclass(frozen=True, eq=False)
class StoredSolutions:
    """What was stored: the problems, the optima found together by place and program, and all that was found alone.

    `statuses` has the status that each row states.
    """

    problems: ProblemArray
    parts: list[tuple[NDArray[np.intp], Model, SolvedBatch]]
    others: dict[int, Solution | OptlawsError]
    seconds: float
    statuses: list[Status]


def plain_error(error: OptlawsError) -> Plain:
    """An error as plain data, from which `read_solutions` makes one that says and proves the same."""
    data: Plain = {"status": Status.of(error).value, "error": str(error.args[0]) if error.args else ""}
    for name in ("problem", "proof"):
        value = getattr(error, name, None)
        if value is not None:
            data[name] = value.to_dict()
    tried = getattr(error, "tried", "")
    return {**data, "tried": tried} if tried else data


def plain_state(solution: Solution) -> Plain:
    """What is kept of a law that was found alone beside its claims: Z's series, and where a neighbour is begun."""
    state = solution.active_set
    return {
        "z_series": list(solution.z_series),
        "active_set": {field.name: getattr(state, field.name).tolist() for field in fields(state)},
    }


def read_solution(data: object) -> Solution:
    """Read what `Solution.to_dict` wrote, and check all that is taken from it.

    Raises
    ------
    InputError
        If an entry is missing or wrong, or states what does not follow from the problem, the law and the proofs.
    """
    row = stated(data, StatedSolution, "solution")
    if row.state is None:
        raise InputError("this solution has no `state`, without which it is verified but not read: solve it again")
    state = row.state
    return _plainly(lambda: _solution(row, state, problem_of(row.problem)), "this is no solution")


def read_front(data: object) -> Front:
    """Read what `Front.to_dict` wrote, and check all that is taken from it.

    Raises
    ------
    InputError
        If an entry is missing or wrong, or states what does not follow from the problems, the laws and the proofs.
    """
    entries = stated(data, StatedParetoFront, "front")
    points = tuple(_at(f"points[{i}]", partial(read_solution, row)) for i, row in enumerate(entries.points))
    errors: dict[float, OptlawsError] = {value: SolverFailure("") for value in entries.failed}
    for i, (value, row) in enumerate(zip(entries.failed, entries.errors, strict=False)):
        errors[value] = _at(f"errors[{i}]", partial(_error, row, partial(problem_of, row.problem or {})))
    front = Front(tuple(entries.over), points, errors)
    if not _plainly(lambda: _same(front.values.tolist(), entries.values), "this is no front"):
        raise InputError("the values of a front are other than the constants of its laws")
    return front


def statuses_of(result: Solution | OptlawsError) -> list[Status]:
    """The statuses that a result can have; a law that a lower bound of a constant holds up is proven in part alone."""
    if not isinstance(result, Solution):
        return [Status.of(result)]
    problem = result.problem
    velocity = problem.range("B")
    held_up = any(limits.low > 0.0 for _, limits in problem.bounded) or (velocity is not None and velocity.low > 0.0)
    ways = {True: [True, False] if held_up else [True], False: [False]}[problem.convex]
    scale = problem.objective.scale
    return [status_of(result.objective, result.lower_bound, scale, proven=proven) for proven in ways]


def check_status(status: Status, result: Solution | OptlawsError, name: str) -> None:
    """Refuse a status that a result cannot have; `name` is what an error calls it.

    Raises
    ------
    InputError
        If it is another's.
    """
    possible = statuses_of(result)
    if status not in possible:
        raise InputError(f"the status of {name} is {status.value!r}, but it is {' or '.join(possible)}")


def read_solutions(data: object) -> StoredSolutions:
    """Read what `SolutionArray.to_dict` wrote, and check all that is taken from it."""
    entries = stated(data, StatedSolutions, "stored array of solutions")
    size, shape = prod(entries.shape), tuple(entries.shape)
    if min(shape, default=0) < 0 or size != len(entries.solutions):
        raise InputError(f"an array of solutions of shape {shape} has {size} solutions, got {len(entries.solutions)}")
    together = {place for part in entries.parts for place in part.places}
    alone = {str(place) for place in range(size)} - set(map(str, together))
    if sum(len(part.places) for part in entries.parts) != len(together) or not together <= set(range(size)):
        raise InputError("the parts of an array of solutions name a place twice, or one that it does not have")
    if not entries.alone.keys() <= alone:
        raise InputError("an array of solutions says of a law that it was found alone and is none of those")
    return _plainly(lambda: _Reading(entries, shape).stored(), "this is no array of solutions")


@dataclass(frozen=True)
class _Reading:
    """An array of solutions that is read: what its file states, and the shape of its problems."""

    entries: StatedSolutions
    shape: tuple[int, ...]

    def stored(self) -> StoredSolutions:
        """All of it, checked."""
        entries = self.entries
        rows = [_row(row, f"solutions[{place}]") for place, row in enumerate(entries.solutions)]
        problems = self._problems()
        for place, row in enumerate(rows):
            if row.problem is not None and row.problem != as_json(problems.problem(place).to_dict()):
                raise InputError(f"the problem of solutions[{place}] is another than that of the arrays")
        others: dict[int, Solution | OptlawsError] = {}
        parts = [_part(part, problems, rows) for part in entries.parts]
        for place in sorted(set(range(len(rows))) - {place for part in entries.parts for place in part.places}):
            others[place] = _at(
                f"solutions[{place}]",
                lambda place=place: self._alone(place, rows[place], problems),  # type: ignore[misc]
            )
        return StoredSolutions(problems, parts, others, entries.seconds, [row.status for row in rows])

    def _problems(self) -> ProblemArray:
        entries, shape = self.entries, self.shape
        if entries.problems is None:
            given = [problem_of(row["problem"]) if "problem" in row else None for row in entries.solutions]
            return ProblemArray.of(given, shape)
        made = ProblemArray(**read_entries(entries.problems))
        if made.shape == shape:
            return made
        if made.size != 1:
            raise InputError(f"problems of shape {made.shape} are no array of solutions of shape {shape}")
        # entries without arrays may have been taken many times
        return made.taken(np.zeros(shape, dtype=np.intp))

    def _alone(self, place: int, row: StatedSolution | StatedError, problems: ProblemArray) -> Solution | OptlawsError:
        if isinstance(row, StatedError):
            return _error(row, lambda: problems.problem(place))
        kept = self.entries.alone.get(str(place))
        if kept is None:
            raise InputError("the arrays say nothing of its law")
        return _solution(row, kept, problems.problem(place))


def _solution(row: StatedSolution, state: StatedState, problem: Problem) -> Solution:
    law = MotionLaw.from_dict(row.law)
    _check_numbers(row, problem, law)
    _check_z(state.z_series, problem, law)
    solution = Solution(
        problem=problem,
        law=law,
        z_series=tuple(state.z_series),
        objective=row.objective,
        certificate=Certificate.from_dict(row.certificate),
        lower_bound=_bound(row),
        limit=known_limit(problem),
        status=row.status,
        iterations=row.iterations,
        seconds=row.seconds,
        starts=row.starts,
        power_certificate=_read(Certificate.from_dict, row.power_certificate),
        peak_certificate=_read(Certificate.from_dict, row.peak_certificate),
        active_set=_active_set(state.active_set, model_of(problem).program),
    )
    check_status(row.status, solution, "the solution")
    return solution


def _row(data: Plain, name: str) -> StatedSolution | StatedError:
    what = f"row of an array of solutions ({name})"
    return stated(data, StatedError, what) if "error" in data else stated(data, StatedSolution, what)


def _part(
    part: StatedPart, problems: ProblemArray, rows: list[StatedSolution | StatedError]
) -> tuple[NDArray[np.intp], Model, SolvedBatch]:
    model, found = model_of(problem_of(part.problem)), part.found
    optima = {field.name: getattr(found, field.name) for field in fields(SolvedBatch) if field.name not in FOLLOWING}
    own = [rows[place] for place in part.places]
    objective = [getattr(row, "objective", np.nan) for row in own]
    laws = SolvedBatch.from_dict({**optima, "objective": objective, "excess": [np.nan] * len(own)}).frozen()
    _check_optima(laws, len(part.places), model.program)
    for i, place in enumerate(part.places):
        row = own[i]
        if isinstance(row, StatedError):
            raise InputError(f"solutions[{place}] has no law, but the arrays have one")
        problem = problems.problem(place)
        _at(f"solutions[{place}]", lambda: _check_row(row, problem, replace(model, problem=problem), laws, i))  # noqa: B023
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
    own = laws.family != NO_CONTACT
    known = own & (laws.family >= 0) & (laws.family < len(program.families))
    if not all(np.isfinite(values).all() for values in numbers) or not (known == own).all():
        raise InputError("a part of an array of solutions has numbers that are not finite, or rows of no program")


def _check_row(row: StatedSolution, problem: Problem, model: Model, laws: SolvedBatch, i: int) -> None:
    """Refuse a row whose law, whose numbers or whose proof are not those of the arrays."""
    law = model.law(laws.x[i])
    if not _same(as_json(law.to_dict()), row.law):
        raise InputError("its law is another than that of the arrays' coordinates")
    _check_numbers(row, problem, law)
    bound, limit = float(laws.bound[i]), known_limit(problem)
    if max(bound, -inf if limit is None else limit) != _bound(row):
        raise InputError(f"its lower bound is {row.lower_bound!r}, but that of the arrays {bound!r}")
    if problem.convex:
        _check_contacts(Certificate.from_dict(row.certificate), model.program, laws, i)


def _check_contacts(proof: Certificate, program: Program, laws: SolvedBatch, i: int) -> None:
    """Refuse contacts and multipliers of the arrays that are not those of the row's certificate."""
    own = [int(j) for family in range(len(program.families)) for j in np.flatnonzero(laws.family[i] == family)]
    kinds = [program.families[laws.family[i, j]] for j in own]
    same = [kind.name for kind in kinds] == [contact.constraint for contact in proof.contacts]
    places = [float(kind.k(laws.u[i, j : j + 1])[0]) for kind, j in zip(kinds, own, strict=True)]
    arrays: list[tuple[Any, list[float]]] = [
        (laws.sign[i, own], [contact.sign for contact in proof.contacts]),
        (np.clip(places, 0.0, 1.0), [contact.k for contact in proof.contacts]),
        (laws.multiplier[i, own], [contact.multiplier for contact in proof.contacts]),
        (laws.equations[i], list(proof.equations)),
    ]
    if not same or not all(_same(list(map(float, first)), second) for first, second in arrays):
        raise InputError("its certificate is another than that of the arrays' contacts and multipliers")


def _check_numbers(row: StatedSolution, problem: Problem, law: MotionLaw) -> None:
    """Refuse an objective that is not the law's, a law that breaks its problem, and a bound that nothing proves."""
    value, size = worth(problem, law), _size(problem)
    if not value.sound or shortfalls(problem, law):
        raise InputError("its law does not keep the constraints of its problem")
    if not abs(row.objective - value.objective) <= STORED_VALUE * max(abs(value.objective), size):
        raise InputError(f"the objective is {row.objective!r}, but that of its law {value.objective!r}")
    bound, proven = _bound(row), max(_proven(row, problem), default=-inf)
    if not (bound == -inf or bound <= proven + STORED_VALUE * max(abs(proven), size)):
        raise InputError(f"the lower bound is {bound!r}, but what is proven beside it {proven!r}")


def _proven(row: StatedSolution, problem: Problem) -> Iterator[float]:
    """What the row's proofs prove of its problem in doubles."""
    for data in (row.certificate, row.power_certificate, row.peak_certificate):
        proof = _read(Certificate.from_dict, data)
        if proof is not None and proof.problem != problem:
            raise InputError("a proof beside its law is of another problem")
        if proof is not None:
            yield proof.bound
    limit = known_limit(problem)
    if limit is not None:
        yield limit


def _size(problem: Problem) -> float:
    """How large the objective of a plain law is: what rounding is held against where an objective is nearly 0."""
    value = _of_plain_law(problem.shape) if isinstance(problem.B, float) else _of_plain_law(problem)
    return value if isfinite(value) else 0.0


@lru_cache(maxsize=256)
def _of_plain_law(problem: Problem) -> float:
    return abs(worth(problem, smoothstep(min(problem.order, 10))).objective)


def _bound(row: StatedSolution) -> float:
    return -inf if row.lower_bound is None else row.lower_bound


def _check_z(series: list[float], problem: Problem, law: MotionLaw) -> None:
    """Refuse coefficients of Z that do not make the law."""
    basis, order = problem.basis, problem.order
    if not isinstance(basis, PolynomialBasis | PiecewiseBasis):
        wrong = bool(series)
    else:
        k = (1.0 - np.cos((np.arange(2 * len(series) + 8) + 0.5) * (np.pi / (2 * len(series) + 8)))) / 2.0
        a0, a1 = (
            np.polynomial.polynomial.polyval(k, list(map(float, part)))
            for part in (problem.conditions.a0(), problem.conditions.a1())
        )
        a = a0 + k**order * (a1 + (k - 1.0) ** order * _z(basis, np.array(series), k))
        off = np.abs(a - np.array([float(law(place)) for place in k.tolist()]))
        wrong = not off.max() <= STORED_VALUE
    if wrong:
        raise InputError("the coefficients of Z in the arrays do not make its law")


def _z(basis: PolynomialBasis | PiecewiseBasis, series: NDArray[np.float64], k: NDArray[np.float64]) -> Any:  # noqa: ANN401
    """Z at times k, of its Chebyshev series, on each piece where it has some."""
    if isinstance(basis, PolynomialBasis):
        return np.polynomial.chebyshev.chebval(2.0 * k - 1.0, series)
    breaks = np.array(basis.breaks, dtype=np.float64)
    rows = series.reshape(len(breaks) - 1, -1)
    i = np.clip(np.searchsorted(breaks, k, side="right") - 1, 0, len(rows) - 1)
    x = 2.0 * (k - breaks[i]) / (breaks[i + 1] - breaks[i]) - 1.0
    return (rows[i] * np.cos(np.arange(rows.shape[1]) * np.arccos(np.clip(x, -1.0, 1.0))[:, None])).sum(axis=1)


def _active_set(entries: StatedActiveSet, program: Program) -> ActiveSet:
    """Where a neighbouring problem may begin: any numbers will do that are of the program's shape."""
    kinds = {"family": np.intp, "free": np.bool_}
    state = ActiveSet(
        **{
            field.name: np.array(getattr(entries, field.name), dtype=kinds.get(field.name, np.float64))
            for field in fields(ActiveSet)
        }
    )
    counts = {len(part) for part in (state.family, state.u, state.s, state.free, state.multipliers)}
    finite = all(np.isfinite(getattr(state, field.name)).all() for field in fields(state))
    known = ((state.family >= 0) & (state.family < len(program.families))).all()
    sizes = (len(state.x), len(state.equality_multipliers)) == (program.size, len(program.right))
    if len(counts) != 1 or not finite or not known or not sizes:
        raise InputError("the contacts and multipliers in the arrays are not of its program")
    return state


def _error(row: StatedError, problem: Callable[[], Problem]) -> OptlawsError:
    """The error of a row without a law, which has to be so of its problem."""
    if row.status is Status.INVALID:
        if row.problem is not None or row.proof is not None:
            raise InputError(f"a row that is {row.status.value!r} has neither problem nor proof")
        if _is_problem(problem):
            raise InputError("it is said to be no problem, but it is one")
        return InputError(row.error)
    if row.status is Status.FAILED:
        if row.proof is not None:
            raise InputError(f"a row that is {row.status.value!r} has no proof")
        return SolverFailure(row.error, problem=problem(), tried=row.tried)
    if row.proof is None:
        if not beyond_limit(problem()):
            raise InputError("it is said to have no law, but no proof stands beside it")
        return InfeasibleProblem(row.error, problem=problem(), tried=row.tried)
    proof = proof_of_no_law(problem(), Certificate.from_dict(row.proof))
    if proof is None:
        raise InputError("it is said to have no law, but its proof does not show that of its problem")
    return InfeasibleProblem(row.error, problem=problem(), tried=row.tried, proof=proof)


def _is_problem(problem: Callable[[], Problem]) -> bool:
    try:
        model_of(problem())
    except InputError:
        return False
    return True


def _same(first: Any, second: Any) -> bool:  # noqa: ANN401 - JSON
    """Whether plain data are the same, numbers but for the rounding of the greatest beside them."""
    if isinstance(first, dict) and isinstance(second, dict):
        return first.keys() == second.keys() and all(_same(first[name], second[name]) for name in first)
    if isinstance(first, list) and isinstance(second, list) and first and all(map(_is_number, [*first, *second])):
        allowed = STORED_COEFFICIENT * max(map(abs, first))
        return len(first) == len(second) and all(abs(a - b) <= allowed for a, b in zip(first, second, strict=True))
    if isinstance(first, list) and isinstance(second, list):
        return len(first) == len(second) and all(map(_same, first, second))
    if _is_number(first) and _is_number(second):
        return bool(abs(first - second) <= STORED_COEFFICIENT * max(abs(first), 1.0))
    return bool(first == second)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _read(read: Callable[[Plain], Kind], data: Plain | None) -> Kind | None:
    return None if data is None else read(data)


def _at(name: str, read: Callable[[], Kind]) -> Kind:
    """What is read at a place, which an error names."""
    try:
        return read()
    except InputError as error:
        raise InputError(f"{name}: {error}") from None


def _plainly(read: Callable[[], Kind], name: str) -> Kind:
    """What is read of data that may be anything."""
    try:
        return read()
    except InputError:
        raise
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        raise InputError(f"{name}: {shortened(str(error))}") from None
