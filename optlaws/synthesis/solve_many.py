"""Many problems, as arrays, in order or in turn: their solutions, errors as results where asked."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, islice, repeat
from typing import Literal, overload

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError, OptlawsError
from optlaws.numbers import whole
from optlaws.suggest import unknown_key
from optlaws.synthesis.arrays.lines import lines_of
from optlaws.synthesis.arrays.powers import least_power
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solution_array import SolutionArray
from optlaws.synthesis.solve import Bound, check_bound, synthesize
from optlaws.synthesis.solve_array import solved

ERRORS = ("raise", "return")
#: in a piece of `synthesize_chunks` unless asked otherwise
_CHUNK = 10_000
#: how many problems are solved together: the first ones come soon, and memory is that of the last
_CHUNKS = (64, 512, 4096)

Errors = Literal["raise", "return"]
Result = Solution | OptlawsError


def synthesize_array(problems: ProblemArray, *, bound: Bound = "quick") -> SolutionArray:
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
    check_bound(bound)
    return solved(problems, bound=bound)


def synthesize_chunks(problems: ProblemArray, *, size: int = _CHUNK, bound: Bound = "quick") -> Iterator[SolutionArray]:
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
    """Solve problems in turn, each warm started by the one before it where they are neighbours.

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
        What becomes of a problem without an answer: "raise" raises its error and ends the sweep, "return" gives the
        error in its place and goes on.

    Raises
    ------
    InfeasibleProblem, SolverFailure
        As `synthesize`, unless errors are returned.
    InputError
        If `bound` or `errors` is unknown; and, unless errors are returned, if one of the problems is none.

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
