"""Many problems, one after the other or many at once: their solutions in order, errors as results where asked."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import Literal, overload

import numpy as np

from optlaws.errors import InputError, OptlawsError
from optlaws.suggest import unknown_key
from optlaws.synthesis.arrays.lines import lines_of
from optlaws.synthesis.arrays.powers import least_power
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import BOUNDS, synthesize
from optlaws.synthesis.solve_array import solved

ERRORS = ("raise", "return")
#: how many problems are solved together: the first ones come soon, and memory is that of the last
_CHUNKS = (64, 512, 4096)

Errors = Literal["raise", "return"]
Result = Solution | OptlawsError


@overload
def synthesize_many(
    problems: Iterable[Problem], *, bound: str = "quick", errors: Literal["raise"] = "raise"
) -> Iterator[Solution]: ...
@overload
def synthesize_many(problems: Iterable[Problem], *, bound: str = "quick", errors: Errors) -> Iterator[Result]: ...
def synthesize_many(
    problems: Iterable[Problem], *, bound: str = "quick", errors: Errors = "raise"
) -> Iterator[Solution] | Iterator[Result]:
    """Solve many problems, those that differ in numbers together, and give their solutions in order.

    Each is what `synthesize` gives for its problem, whatever the others are and however many. Problems are taken some
    thousand at a time and no more are kept, so that a million stream through; where each depends on the solution
    before it, use `sweep`. For arrays instead of solutions see `synthesize_array`.

    Parameters
    ----------
    problems
        The problems, of one kind or of several: a list, a generator or a `ProblemArray`.
    bound
        As of `synthesize`.
    errors
        What becomes of a problem without an answer: "raise" raises its error in its turn and ends, "return" gives
        the error in its place and goes on.

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
    if bound not in BOUNDS:
        raise InputError(unknown_key(bound, BOUNDS, "bound"))
    return _raised(_many(problems, bound), errors)


@overload
def sweep(problems: Iterable[Problem], *, errors: Literal["raise"] = "raise") -> Iterator[Solution]: ...
@overload
def sweep(problems: Iterable[Problem], *, errors: Errors) -> Iterator[Result]: ...
def sweep(problems: Iterable[Problem], *, errors: Errors = "raise") -> Iterator[Solution] | Iterator[Result]:
    """Solve problems in turn, each warm started by the one before it where they are neighbours.

    Where the problems are there already, in a list, they are solved together, as `synthesize_many` does, if all are
    convex or of least power and along lines. Of a generator they are taken one by one, so that each may depend on the
    solution before it.

    Parameters
    ----------
    problems
        The problems.
    errors
        What becomes of a problem without an answer: "raise" raises its error and ends the sweep, "return" gives the
        error in its place and goes on.

    Raises
    ------
    InfeasibleProblem, SolverFailure
        As `synthesize`, unless errors are returned.
    InputError
        If `errors` is unknown; and, unless errors are returned, if one of the problems is none.

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
    return _raised(_many(problems, "quick") if _together(problems) else _in_turn(problems), errors)


def check_errors(errors: object) -> None:
    """Refuse what is no way to deal with errors."""
    if errors not in ERRORS:
        raise InputError(unknown_key(errors, ERRORS, "errors"))


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
    """Whether there are problems that are as good solved together, and sooner: convex, or of least power on lines."""
    if not isinstance(problems, Sequence) or not all(isinstance(problem, Problem) for problem in problems):
        return False
    others = [problem for problem in problems if not problem.convex]
    if not all(map(least_power, others)):
        return False
    return sum(len(line.places) for line in lines_of(others, np.arange(len(others)))) == len(others)


def _in_turn(problems: Iterable[Problem]) -> Iterator[Result]:
    previous: Solution | None = None
    for problem in problems:
        try:
            previous = synthesize(problem, start=previous)
        except OptlawsError as error:
            yield error
        else:
            yield previous


def _many(problems: Iterable[Problem], bound: str) -> Iterator[Result]:
    for chunk in _chunks(problems):
        laws = solved(chunk, bound=bound)
        yield from map(laws.result, range(chunk.size))


def _chunks(problems: Iterable[Problem]) -> Iterator[ProblemArray]:
    """The problems, few at first and then many at a time."""
    if isinstance(problems, ProblemArray):
        begin = 0
        for size in _sizes(_CHUNKS[1:]):
            if begin >= problems.size:
                return
            yield problems.taken(np.arange(begin, min(begin + size, problems.size)))
            begin += size
    waiting = iter(problems)
    # what is there already need not be waited for
    for size in _sizes(_CHUNKS[1:] if isinstance(problems, Sequence) else _CHUNKS):
        some = list(islice(waiting, size))
        if not some:
            return
        yield ProblemArray.of(some)


def _sizes(chunks: tuple[int, ...]) -> Iterator[int]:
    yield from chunks
    while True:
        yield chunks[-1]
