"""synthesize_array(problems) -> SolutionArray: the best laws of many problems that differ in numbers, with proof.

What other modules build on is `solved(problems)`: it takes a `ProblemArray` (`ProblemArray.of(list_of_problems)` makes
one of any problems that are there, of one kind or of several) and raises nothing but for wrong arguments. Its
`SolutionArray` has `result(place)`, which is a `Solution` or the error of that problem, in the order of the problems.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import inf
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError
from optlaws.numbers import whole
from optlaws.shown.steps import Steps
from optlaws.suggest import unknown_key
from optlaws.synthesis.arrays.along import laws_along
from optlaws.synthesis.arrays.found import Found
from optlaws.synthesis.arrays.lines import Line, along_velocities, least_count, lines_of
from optlaws.synthesis.arrays.powers import unrivalled, with_quick_bounds
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.proof.no_law import proof_of_no_law
from optlaws.synthesis.search import Search
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solution_array import SolutionArray
from optlaws.synthesis.solve import BOUNDS, TIGHT, synthesize
from optlaws.synthesis.solved_parts import Part

_CHUNK = 10_000


def synthesize_array(problems: ProblemArray, *, bound: str = "quick") -> SolutionArray:
    """Find the best law of each of many problems and prove it: what `synthesize` gives for each, in far less time.

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
    if bound not in BOUNDS:
        raise InputError(unknown_key(bound, BOUNDS, "bound"))
    return solved(problems, bound=bound)


def synthesize_chunks(problems: ProblemArray, *, size: int = _CHUNK, bound: str = "quick") -> Iterator[SolutionArray]:
    """The same piece by piece, in the order of the flattened array: memory is that of one piece.

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
    places = range(0, problems.size, step)
    return (synthesize_array(problems.taken(np.arange(i, min(i + step, problems.size))), bound=bound) for i in places)


def solved(problems: ProblemArray, *, bound: str = "quick") -> SolutionArray:
    """What `synthesize_array` returns, of checked arguments."""
    began = perf_counter()
    parts: list[Part] = []
    others: dict[int, Solution | OptlawsError] = {}
    done = 0
    with Steps("laws", problems.size) as steps:
        for line in _lines(problems):
            laws = _along(problems, line, bound)
            rows = np.flatnonzero(laws.solved)
            if len(rows):
                parts.append(Part(line.places[rows], line.path.model, laws.taken(rows).frozen()))
                for beyond in (line.places[: rows[0]][::-1], line.places[rows[-1] + 1 :]):
                    others.update(_beyond(problems, beyond, bound))
            done += len(line.places)
            steps.reach(done)
    return completed(problems, parts, others, began, bound=bound)


def completed(
    problems: ProblemArray,
    parts: Sequence[Part],
    others: Mapping[int, Solution | OptlawsError],
    began: float,
    *,
    bound: str = "quick",
) -> SolutionArray:
    """What is known of some of the problems, with the rest solved one by one, each begun at the law before it."""
    known = np.concatenate([np.array(list(others), dtype=np.intp), *(part.places for part in parts)])
    rest = _others(problems, np.setdiff1d(np.arange(problems.size), known), bound)
    return SolutionArray(problems, tuple(parts), {**others, **rest}, perf_counter() - began)


def _along(problems: ProblemArray, line: Line, bound: str) -> Found:
    """The laws of a line, as far as they are proven; of least power, those that no other branch is better than."""
    if line.path.model.problem.convex:
        return laws_along(line.path, line.t)
    if bound == TIGHT:
        return Found.none(len(line.t), 0, 0, 0)
    laws = laws_along(line.path, line.t)
    sought = unrivalled(laws, line.places, lambda place: Search(model_of(problems.problem(place))).least())
    laws = laws.only(sought)
    limits = [known_limit(problems.problem(place)) for place in line.places.tolist()]
    return with_quick_bounds(line.path, line.t, laws, np.array([-inf if limit is None else limit for limit in limits]))


def _beyond(
    problems: ProblemArray, places: NDArray[np.intp], bound: str
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


def _lines(problems: ProblemArray) -> Iterator[Line]:
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


def _others(problems: ProblemArray, places: NDArray[np.intp], bound: str) -> dict[int, Solution | OptlawsError]:
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


def _alone(problems: ProblemArray, place: int, near: Solution | None, bound: str) -> Solution | OptlawsError:
    """One problem by itself, begun at a neighbour's law."""
    try:
        problem = problems.problem(place)
        # what was given need be no problem, which is for `synthesize` to say
        convex = getattr(problem, "convex", False)
        # where problems are not convex, the law of a branch that has become the worse one would stay
        return synthesize(problem, start=near if convex else None, bound=bound)
    except OptlawsError as error:
        return error
