"""How many problems are solved: together along lines on which their numbers differ, the others one by one.

What other modules build on is `solved(problems)`: it takes a `ProblemArray` (`ProblemArray.of(list_of_problems)` makes
one of any problems that are there, of one kind or of several) and raises nothing but for wrong arguments. Its
`SolutionArray` has `result(place)`, which is a `Solution` or the error of that problem, in the order of the problems.
`SolvedLine` is asked for laws again and again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields
from math import inf
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InfeasibleProblem, InputError, OptlawsError
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.shown.steps import Steps
from optlaws.synthesis.arrays.continuation import StructureSegment
from optlaws.synthesis.arrays.continued_laws import laws_along, laws_on, segments_of
from optlaws.synthesis.arrays.lines import ProblemLine, along_velocities, form_of, least_count, lines_of
from optlaws.synthesis.arrays.powers import on_global_branch, with_quick_bounds
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.arrays.programs import Path, between
from optlaws.synthesis.arrays.solved_batch import SolvedBatch
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.proof.no_law import proof_of_no_law
from optlaws.synthesis.search import LawSearch
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solution_array import SolutionArray
from optlaws.synthesis.solve import TIGHT, Bound, synthesize
from optlaws.synthesis.solved_parts import SolvedPart


def solved(problems: ProblemArray, *, bound: Bound = "quick") -> SolutionArray:
    """What `synthesize_array` returns, of checked arguments."""
    began = perf_counter()
    parts: list[SolvedPart] = []
    others: dict[int, Solution | OptlawsError] = {}
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
    others: Mapping[int, Solution | OptlawsError],
    began: float,
    *,
    bound: Bound = "quick",
) -> SolutionArray:
    """What is known of some of the problems, with the rest solved one by one, each begun at the law before it."""
    known = np.concatenate([np.array(list(others), dtype=np.intp), *(part.places for part in parts)])
    rest = _others(problems, np.setdiff1d(np.arange(problems.size), known), bound)
    return SolutionArray(problems, tuple(parts), {**others, **rest}, perf_counter() - began)


def _along(problems: ProblemArray, line: ProblemLine, bound: Bound) -> SolvedBatch:
    """The laws of a line, as far as they are proven; of least power, those that no other branch is better than."""
    if line.path.model.problem.convex:
        return laws_along(line.path, line.t)
    if bound == TIGHT:
        return SolvedBatch.none(len(line.t), 0, 0, 0)
    laws = laws_along(line.path, line.t)
    sought = on_global_branch(laws, line.places, lambda place: LawSearch(model_of(problems.problem(place))).least())
    laws = laws.only(sought)
    limits = [known_limit(problems.problem(place)) for place in line.places.tolist()]
    return with_quick_bounds(line.path, line.t, laws, np.array([-inf if limit is None else limit for limit in limits]))


def _beyond(
    problems: ProblemArray, places: NDArray[np.intp], bound: Bound
) -> Iterator[tuple[int, Solution | OptlawsError]]:
    """The problems on a line beyond those with laws, the nearest first: these are a convex set, which ends for good."""
    previous: Solution | None = None
    ended: InfeasibleProblem | None = None
    for place in places.tolist():
        result: Solution | OptlawsError | None = None
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
        "the same line (error.proof is the certificate)",
        problem=problem,
        tried="the multipliers that prove it of a nearer problem prove it of this one too",
        proof=proof,
    )


def _lines(problems: ProblemArray) -> Iterator[ProblemLine]:
    velocities = problems.velocities
    if velocities is not None:
        places = np.flatnonzero(~np.isnan(velocities))
        if len(places) > 1:
            known = velocities[places]
            try:
                ends = [problems.problem(int(places[at])) for at in (known.argmin(), known.argmax())]
            except InputError:
                return  # the other entries make no problem
            if len(places) < least_count(ends[0]):
                return
            line = along_velocities(ends[0], ends[1], known, places)
            if line is not None:
                yield line
        return
    valid = [(place, problem) for place in range(problems.size) if (problem := _valid(problems, place)) is not None]
    yield from lines_of([problem for _, problem in valid], np.array([place for place, _ in valid], np.intp))


def _valid(problems: ProblemArray, place: int) -> Problem | None:
    try:
        given: object = problems.problem(place)
    except InputError:
        return None
    # what was given need be none, which is for `synthesize` to say
    return given if isinstance(given, Problem) else None


def _others(problems: ProblemArray, places: NDArray[np.intp], bound: Bound) -> dict[int, Solution | OptlawsError]:
    """What is solved one by one, each begun at the law before it."""
    others: dict[int, Solution | OptlawsError] = {}
    previous: Solution | None = None
    with Steps("laws", len(places)) as steps:
        for place in places.tolist():
            result = _alone(problems, place, previous, bound)
            previous = result if isinstance(result, Solution) else previous
            others[place] = result
            steps.reach(len(others))
    return others


def _alone(problems: ProblemArray, place: int, near: Solution | None, bound: Bound) -> Solution | OptlawsError:
    """One problem by itself, begun at a neighbour's law."""
    try:
        problem = problems.problem(place)
        # what was given need be no problem, which is for `synthesize` to say
        convex = getattr(problem, "convex", False)
        # where problems are not convex, the law of a branch that has become the worse one would stay
        return synthesize(problem, start=near if convex else None, bound=bound)
    except OptlawsError as error:
        return error


class SolvedLine:
    """Convex problems between two, that differ in one number in which their programs are affine.

    Where their structures change is found once, so that laws may be asked for again and again.

    Parameters
    ----------
    problem
        What else is asked.
    name, at
        The number, and the problem at a value of it; of B the values alone tell.
    low, high
        The ends.

    Examples
    --------
    >>> problem = Problem(order=4)
    >>> line = SolvedLine(problem, "B", problem.at_velocity, 1.6, 1.8)
    >>> line.at(np.array([1.62, 1.7])).C.round(5).tolist(), line.at(np.array([1.65])).C.round(5).tolist()
    ([5.17368, 4.81977], [5.04086])
    """

    def __init__(self, problem: Problem, name: str, at: Callable[[float], Problem], low: float, high: float) -> None:
        self.problem, self.name, self._at, self.low, self.high = problem, name, at, low, high

    def _problems(self, values: Array) -> ProblemArray:
        if self.name != "B":
            return ProblemArray.of([self._at(value) for value in values.tolist()])
        entries = {field.name: getattr(self.problem, field.name) for field in fields(Problem)}
        return ProblemArray(**{**entries, "B": values})

    def at(self, values: Array) -> SolutionArray:
        """What is solved at values of the number; few at a time are as quick as many."""
        began, problems = perf_counter(), self._problems(values)
        if self._path is None:
            return solved(problems)
        t = (values - self.low) / (self.high - self.low)
        order = np.argsort(t, kind="stable")
        order = order[(t[order] >= 0.0) & (t[order] <= 1.0)]
        laws = laws_on(self._path, self._segments, t[order])
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
        return between(first, last) if _one_form(first, last) else None

    @kept_property
    def _segments(self) -> list[StructureSegment]:
        return [] if self._path is None else segments_of(self._path, 0.0, 1.0)


def _one_form(first: Problem, last: Problem) -> bool:
    one, other = form_of(first).key, form_of(last).key
    return first.convex and one is not None and one == other
