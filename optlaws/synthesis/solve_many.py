"""Many problems, as arrays or in sequence: together along lines on which their numbers differ, else singly.

`solved` raises nothing but for wrong arguments: its `SolutionArray` has a `Solution` or an error of each problem.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from itertools import chain, islice, repeat
from math import inf
from time import perf_counter
from typing import Literal, overload

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.numbers import Array, whole
from optlaws.shown.steps import Steps
from optlaws.synthesis.arrays.continuation import StructureSegment, laws_along
from optlaws.synthesis.arrays.lines import (
    ProblemLine,
    along_velocities,
    form_of,
    least_count,
    least_power,
    lines_of,
    on_global_branch,
    with_quick_bounds,
)
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.arrays.programs import Path, SolvedBatch, between
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.proof.no_law import proof_of_no_law
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solution_array import SolutionArray, SolvedPart
from optlaws.synthesis.solve import TIGHT, Bound, LawSearch, check_bound, synthesize

ERRORS = ("raise", "return")
#: the default size of a piece of `synthesize_chunks`
_CHUNK = 10_000
#: how many problems are solved together: the first ones come soon, and memory is that of the last
_CHUNKS = (64, 512, 4096)

Errors = Literal["raise", "return"]
Result = Solution | OptlawsError


def solved(problems: ProblemArray, *, bound: Bound = "quick") -> SolutionArray:
    """The solutions of an array, for checked arguments."""
    began = perf_counter()
    parts: list[SolvedPart] = []
    others: dict[int, Result] = {}
    done = 0
    with Steps("laws", problems.size) as steps:
        for line in _lines(problems):
            laws = _along(problems, line, bound)
            rows = np.flatnonzero(laws.solved)
            if len(rows):
                parts.append(SolvedPart(line.places[rows], line.path.model, laws.taken(rows).frozen()))
                for beyond in (line.places[: rows[0]][::-1], line.places[rows[-1] + 1 :]):
                    others.update(_beyond(problems, beyond, bound))
            done += len(line.places)
            steps.reach(done)
    return completed(problems, parts, others, began, bound=bound)


def completed(
    problems: ProblemArray,
    parts: Sequence[SolvedPart],
    others: Mapping[int, Result],
    began: float,
    *,
    bound: Bound = "quick",
) -> SolutionArray:
    """Known solutions, completed by solving the other problems one by one, each from the law before it."""
    known = np.concatenate([np.array(list(others), dtype=np.intp), *(part.places for part in parts)])
    rest = _others(problems, np.setdiff1d(np.arange(problems.size), known), bound)
    return SolutionArray(problems, tuple(parts), {**others, **rest}, perf_counter() - began)


def _along(problems: ProblemArray, line: ProblemLine, bound: Bound) -> SolvedBatch:
    """The laws of a line, as far as they are proven; for least power, laws that no other branch improves."""
    if line.path.model.problem.convex:
        return laws_along(line.path, line.t)
    if bound == TIGHT:
        return SolvedBatch.none(len(line.t), 0, 0, 0)
    laws = laws_along(line.path, line.t)
    known = dict(zip(line.places.tolist(), laws.objective.tolist(), strict=True))

    def sought(place: int) -> float | None:
        return LawSearch(model_of(problems.problem(place))).least(known[place])

    laws = laws.only(on_global_branch(laws, line.places, sought))
    limits = [known_limit(problems.problem(place)) for place in line.places.tolist()]
    return with_quick_bounds(line.path, line.t, laws, np.array([-inf if limit is None else limit for limit in limits]))


def _beyond(problems: ProblemArray, places: NDArray[np.intp], bound: Bound) -> Iterator[tuple[int, Result]]:
    """The problems on a line outside the range with laws, the nearest first: the feasible range is convex."""
    previous: Solution | None = None
    ended: InfeasibleProblem | None = None
    for place in places.tolist():
        result: Result | None = None
        if ended is not None:
            result = _infeasible(problems.problem(place), ended)
        if result is None:
            result = _alone(problems, place, previous, bound)
            previous = result if isinstance(result, Solution) else previous
            if isinstance(result, InfeasibleProblem) and result.proof is not None:
                ended = result
        yield place, result


def _infeasible(problem: Problem, ended: InfeasibleProblem) -> InfeasibleProblem | None:
    """The error of a problem that the multipliers of a nearer one prove to have no law; None where they do not."""
    proof = proof_of_no_law(problem, ended.proof)
    if proof is None:
        return None
    return InfeasibleProblem(
        "no law of this problem exists: the constraints contradict each other where they do in a nearer problem of "
        "the same line",
        problem=problem,
        tried="the multipliers that prove it of a nearer problem prove it of this one too",
        proof=proof,
    )


def _lines(problems: ProblemArray) -> Iterator[ProblemLine]:
    velocities = problems.velocities
    if velocities is None:
        valid = {place: problem for place in range(problems.size) if (problem := _valid(problems, place)) is not None}
        yield from lines_of(list(valid.values()), np.array(list(valid), np.intp))
        return
    places = np.flatnonzero(~np.isnan(velocities))
    if len(places) < 2:
        return
    known = velocities[places]
    ends = [_valid(problems, int(places[at])) for at in (known.argmin(), known.argmax())]
    # the other entries may make no problem
    if ends[0] is None or ends[1] is None or len(places) < least_count(ends[0]):
        return
    line = along_velocities(ends[0], ends[1], known, places)
    if line is not None:
        yield line


def _valid(problems: ProblemArray, place: int) -> Problem | None:
    try:
        entry: object = problems.problem(place)
    except InputError:
        return None
    # an entry of a list need be none, which is for `synthesize` to say
    return entry if isinstance(entry, Problem) else None


def _others(problems: ProblemArray, places: NDArray[np.intp], bound: Bound) -> dict[int, Result]:
    """Results of the problems at these places, solved one by one, each from the law before it."""
    others: dict[int, Result] = {}
    previous: Solution | None = None
    with Steps("laws", len(places)) as steps:
        for place in places.tolist():
            result = _alone(problems, place, previous, bound)
            previous = result if isinstance(result, Solution) else previous
            others[place] = result
            steps.reach(len(others))
    return others


def _alone(problems: ProblemArray, place: int, near: Solution | None, bound: Bound) -> Result:
    """A single problem by itself, started from a neighbour's law."""
    try:
        problem = problems.problem(place)
        convex = getattr(problem, "convex", False)
        # where problems are not convex, the law of a branch that has become the worse one would stay
        return synthesize(problem, start=near if convex else None, bound=bound)
    except OptlawsError as error:
        return error


@dataclass(eq=False)
class SolvedLine:
    """Convex problems between two, that differ in one number in which their programs are affine.

    The structures that laws at some values had are those that laws at others are tried with.

    Examples
    --------
    >>> problem = Problem(order=4)
    >>> line = SolvedLine(problem, "B", problem.at_velocity, 1.6, 1.8)
    >>> line.at(np.array([1.62, 1.7])).C.round(5).tolist(), line.at(np.array([1.65])).C.round(5).tolist()
    ([5.17368, 4.81977], [5.04086])
    """

    problem: Problem
    name: str  #: of the number
    problem_at: Callable[[float], Problem]  #: the problem at a value of it
    low: float
    high: float
    _segments: list[StructureSegment] = field(default_factory=list, repr=False)  #: what is known so far

    def _problems(self, values: Array) -> ProblemArray:
        if self.name != "B":
            return ProblemArray.of([self.problem_at(value) for value in values.tolist()])
        entries = {entry.name: getattr(self.problem, entry.name) for entry in fields(Problem)}
        return ProblemArray(**{**entries, "B": values})

    def at(self, values: Array) -> SolutionArray:
        """Solutions at values of the number; a few at a time are as quick as many."""
        began, problems = perf_counter(), self._problems(values)
        if self._path is None:
            return solved(problems)
        t = (values - self.low) / (self.high - self.low)
        order = np.argsort(t, kind="stable")
        order = order[(t[order] >= 0.0) & (t[order] <= 1.0)]
        laws = laws_along(self._path, t[order], self._segments)
        rows = np.flatnonzero(laws.solved)
        parts = [SolvedPart(order[rows], self._path.model, laws.taken(rows).frozen())] if len(rows) else []
        return completed(problems, parts, {}, began)

    @kept_property
    def _path(self) -> Path | None:
        """The programs from one end to the other; None where they are not on a path."""
        ends = self._problems(np.array([self.low, self.high]))
        try:
            first, last = ends.problem(0), ends.problem(1)
        except InputError:
            return None
        form = form_of(first).key
        return between(first, last) if first.convex and form is not None and form == form_of(last).key else None


def synthesize_array(problems: ProblemArray, *, bound: Bound = "quick") -> SolutionArray:
    """Find and prove the best law of each of many problems: results as from `synthesize`, in far less time.

    A problem without a law, or a number that makes no problem, spoils its own place alone.

    Parameters
    ----------
    problems
        What to solve.
    bound
        As for `synthesize`.

    Returns
    -------
    SolutionArray
        Laws, constants, bounds and statuses as arrays; errors where there is no law.

    Raises
    ------
    InputError
        If `problems` is no `ProblemArray`, or the bound is none.

    Examples
    --------
    >>> laws = synthesize_array(ProblemArray(B=np.linspace(1.6, 1.9, 4), order=4))
    >>> laws.C.round(5).tolist(), bool((laws.gap < 1e-10).all())
    ([5.26222, 4.81977, 4.69579, 4.63147], True)
    """
    if not isinstance(problems, ProblemArray):
        raise InputError(f"synthesize_array takes a ProblemArray, got {shortened(problems)}")
    check_bound(bound)
    return solved(problems, bound=bound)


def synthesize_chunks(problems: ProblemArray, *, size: int = _CHUNK, bound: Bound = "quick") -> Iterator[SolutionArray]:
    """Solve an array piece by piece, in the order of the flattened array, with the memory of one piece.

    Parameters
    ----------
    problems, bound
        As for `synthesize_array`.
    size
        The number of problems in a piece.

    Raises
    ------
    InputError
        As `synthesize_array`, or if the size is no whole number of at least 1.

    Examples
    --------
    >>> pieces = synthesize_chunks(ProblemArray(B=np.linspace(1.6, 1.9, 5), order=4), size=2)
    >>> [piece.shape for piece in pieces]
    [(2,), (2,), (1,)]
    """
    if not isinstance(problems, ProblemArray):
        raise InputError(f"synthesize_chunks takes a ProblemArray, got {shortened(problems)}")
    step = whole(size, "size", least=1)
    return (synthesize_array(piece, bound=bound) for piece in _pieces(problems, repeat(step)))


@overload
def synthesize_many(
    problems: Iterable[Problem], *, bound: Bound = "quick", errors: Literal["raise"] = "raise"
) -> Iterator[Solution]: ...
@overload
def synthesize_many(problems: Iterable[Problem], *, bound: Bound = "quick", errors: Errors) -> Iterator[Result]: ...
def synthesize_many(
    problems: Iterable[Problem], *, bound: Bound = "quick", errors: Errors = "raise"
) -> Iterator[Solution] | Iterator[Result]:
    """Solve many problems, those that differ in numbers together, and give their solutions in order.

    Each is what `synthesize` returns for its problem, independently of the others. Problems are read and solved some
    thousand at a time, so that a million need no more memory; where each depends on the solution before it, use
    `sweep`. For arrays instead of solutions see `synthesize_array`.

    Parameters
    ----------
    problems
        The problems, of one kind or of several: a list, a generator or a `ProblemArray`.
    bound
        As of `synthesize`.
    errors
        "raise" raises the error of a problem without a solution in its turn and ends, "return" yields the error in
        place of the solution and continues.

    Raises
    ------
    InfeasibleProblem, SolverFailure
        As `synthesize`, unless errors are returned.
    InputError
        If `bound` or `errors` is unknown; and, unless errors are returned, if one of the problems is none.

    Examples
    --------
    >>> problems = [Problem(B=B, order=order) for order in (3, 4) for B in (1.05, 1.6)]
    >>> results = list(synthesize_many(problems, errors="return"))
    >>> [round(result.objective, 4) if isinstance(result, Solution) else type(result).__name__ for result in results]
    ['InfeasibleProblem', 4.6751, 'InfeasibleProblem', 5.2622]
    """
    check_errors(errors)
    check_bound(bound)
    return _raised(_many(problems, bound), errors)


@overload
def sweep(
    problems: Iterable[Problem], *, bound: Bound = "quick", errors: Literal["raise"] = "raise"
) -> Iterator[Solution]: ...
@overload
def sweep(problems: Iterable[Problem], *, bound: Bound = "quick", errors: Errors) -> Iterator[Result]: ...
def sweep(
    problems: Iterable[Problem], *, bound: Bound = "quick", errors: Errors = "raise"
) -> Iterator[Solution] | Iterator[Result]:
    """Solve problems in sequence, each warm started from its predecessor where they are neighbours.

    Where the problems are there already, in a list, they are solved together, as `synthesize_many` does, if all are
    convex or of least power and along lines. Of a generator they are taken one by one, so that each may depend on the
    solution before it.

    Parameters
    ----------
    problems
        The problems.
    bound
        As of `synthesize`.
    errors
        As of `synthesize_many`, with the same errors.

    Examples
    --------
    >>> from dataclasses import replace
    >>> first = Problem(B=1.6, order=4)
    >>> [round(s.objective, 6) for s in sweep(replace(first, B=B) for B in (1.6, 1.62))]
    [5.262224, 5.173677]
    >>> results = list(sweep((replace(first, B=B) for B in (1.1, 1.6)), errors="return"))
    >>> [type(result).__name__ for result in results]
    ['InfeasibleProblem', 'Solution']
    """
    check_errors(errors)
    check_bound(bound)
    return _raised(_many(problems, bound) if _together(problems) else _in_turn(problems, bound), errors)


def check_errors(errors: object) -> None:
    """Refuse unknown treatments of errors."""
    check_names([errors], ERRORS, "errors")


def _raised(results: Iterator[Result], errors: Errors) -> Iterator[Result]:
    for result in results:
        if not isinstance(result, OptlawsError):
            yield result
        elif errors == "raise":
            raise result
        else:
            # its frames would keep what was tried
            yield result.with_traceback(None)


def _together(problems: object) -> bool:
    """Whether the problems are there already, and as good solved together: convex, or of least power on lines."""
    if not isinstance(problems, Sequence) or not all(isinstance(problem, Problem) for problem in problems):
        return False
    others = [problem for problem in problems if not problem.convex]
    if not all(map(least_power, others)):
        return False
    return sum(len(line.places) for line in lines_of(others, np.arange(len(others)))) == len(others)


def _in_turn(problems: Iterable[Problem], bound: Bound) -> Iterator[Result]:
    previous: Solution | None = None
    for problem in problems:
        try:
            previous = synthesize(problem, start=previous, bound=bound)
        except OptlawsError as error:
            yield error
        else:
            yield previous


def _many(problems: Iterable[Problem], bound: Bound) -> Iterator[Result]:
    for chunk in _chunks(problems):
        laws = solved(chunk, bound=bound)
        yield from map(laws.result, range(chunk.size))


def _chunks(problems: Iterable[Problem]) -> Iterator[ProblemArray]:
    """The problems, few at first and then many at a time."""
    if isinstance(problems, ProblemArray):
        yield from _pieces(problems, chain(_CHUNKS[1:], repeat(_CHUNKS[-1])))
        return
    waiting = iter(problems)
    # what is there already need not be waited for
    for size in chain(_CHUNKS[1:] if isinstance(problems, Sequence) else _CHUNKS, repeat(_CHUNKS[-1])):
        some = list(islice(waiting, size))
        if not some:
            return
        yield ProblemArray.of(some)


def _pieces(problems: ProblemArray, sizes: Iterable[int]) -> Iterator[ProblemArray]:
    """The problems of the flattened array in pieces of some sizes."""
    begin = 0
    for size in sizes:
        if begin >= problems.size:
            return
        yield problems.taken(np.arange(begin, min(begin + size, problems.size)))
        begin += size
