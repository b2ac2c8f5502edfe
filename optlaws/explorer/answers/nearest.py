"""How far one must go back: for each thing that a problem without a law asks, the nearest value that has one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import ceil, floor, log10
from typing import Any

from optlaws import Chebyshev, Problem, Solution
from optlaws.explorer.answers.asked import MOST_DEGREE, AskedLaw, problem_of, solved, without
from optlaws.explorer.answers.law_view import digits
from optlaws.synthesis.proof.infeasible import possible_velocities

#: a bound is put so much above the least value that a law can have, for at the least one the solver has no room
_ROOM = 1e-6
_FIGURES = 5
_STEPS = (2, 4, 8)


def answer(asked: AskedLaw) -> dict[str, Any]:
    """What to change, and to what, so that there is a law again: one change at a time, the others left as they are."""
    problem = problem_of(asked)
    return {"ways": [] if isinstance(solved(problem), Solution) else list(ways(problem))}


def ways(problem: Problem) -> Iterator[dict[str, Any]]:
    """Each way back: the entry to change, its nearest value that has a law, and both in words.

    Examples
    --------
    >>> from optlaws import at_most
    >>> for way in ways(Problem(B=1.7, order=4, J=at_most(20.0))):
    ...     print(way["entry"], way["text"])
    J raise the bound of J from 20 to 47.504
    """
    if isinstance(problem.B, float):
        yield from _velocity(problem, problem.B)
    for name in ("C", "D", "J", "rms_c"):
        yield from _bound(problem, name)
    if isinstance(problem.basis, Chebyshev):
        yield from _degree(problem, problem.basis.degree)


def _velocity(problem: Problem, B: float) -> Iterator[dict[str, Any]]:
    least, greatest = possible_velocities(problem)
    if least is not None and least > B and _has_law(replace(problem, B=least)):
        yield _way("B", least, f"raise B from {digits(B)} to {digits(least)}")
    elif greatest is not None and greatest < B and _has_law(replace(problem, B=greatest)):
        yield _way("B", greatest, f"lower B from {digits(B)} to {digits(greatest)}")


def _bound(problem: Problem, name: str) -> Iterator[dict[str, Any]]:
    """The least value that the rest of the problem leaves a bounded constant."""
    asked = problem.range(name)
    if asked is None or asked.low > 0.0:
        return
    least = solved(without(problem, name, minimise=name))
    if isinstance(least, Solution) and least.objective > asked.high:
        value = _rounded_up(least.objective * (1.0 + _ROOM))
        yield _way(name, value, f"raise the bound of {name} from {digits(asked.high)} to {digits(value)}")


def _degree(problem: Problem, degree: int) -> Iterator[dict[str, Any]]:
    for higher in (degree + step for step in _STEPS if degree + step <= MOST_DEGREE):
        if _has_law(replace(problem, basis=Chebyshev(higher))):
            yield _way("degree", higher, f"raise the degree from {degree} to {higher}")
            return


def _has_law(problem: Problem) -> bool:
    """Whether there is one; which B are possible is asked first, ten times as fast as a proof that there is none."""
    if isinstance(problem.B, float):
        least, greatest = possible_velocities(problem)
        if least is None or least > problem.B or (greatest is not None and greatest < problem.B):
            return False
    return isinstance(solved(problem), Solution)


def _rounded_up(value: float) -> float:
    unit = 10.0 ** (floor(log10(value)) + 1 - _FIGURES)
    return float(f"{ceil(value / unit) * unit:.{_FIGURES}g}")


def _way(entry: str, value: float, text: str) -> dict[str, Any]:
    return {"entry": entry, "value": value, "text": text}
