"""Problems that differ in numbers alone, put on straight lines: along each their programs' numbers are affine."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.arrays.powers import least_power
from optlaws.synthesis.arrays.programs import Path, between, in_units_of, numbers_of
from optlaws.synthesis.problem.constants import RootMeanSquare
from optlaws.synthesis.problem.expression import Maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.spaces.bases import PolynomialBasis

_OFF_LINE = 1e-12  # of the size of a program's numbers: by so much they may be off a line

#: laws on a line, at least: of jerk structures change often, of root mean squares hardly
_LEAST, _LEAST_OF_JERK, _LEAST_OF_SMOOTH, _LEAST_OF_POWER = 48, 128, 24, 24
_JERK = 3


@dataclass(frozen=True, eq=False)
class ProblemLine:
    """Problems on a straight line: which, in ascending order of t, and the path through the first and the last."""

    places: NDArray[np.intp]
    t: Array
    path: Path


@dataclass(frozen=True, eq=False)
class Form:
    """The form of a problem without its numbers, and the numbers; `key` is None for unknown forms."""

    key: Hashable
    numbers: tuple[float, ...]


def along_velocities(
    template: Problem, last: Problem, velocities: Array, places: NDArray[np.intp]
) -> ProblemLine | None:
    """The line of problems that differ in B alone; the first and the last problem are given."""
    if form_of(template).key is None:
        return None
    path = between(template, last)
    order = np.argsort(velocities, kind="stable")
    least, greatest = float(velocities[order[0]]), float(velocities[order[-1]])
    if path is None or not least < greatest:
        return None
    return ProblemLine(places[order], (velocities[order] - least) / (greatest - least), path)


def least_count(problem: Problem) -> int:
    """The least number of problems on a line that are solved faster together than alone."""
    if not problem.convex:
        return _LEAST_OF_POWER
    if all(isinstance(constant, RootMeanSquare) for constant in problem.constants):
        return _LEAST_OF_SMOOTH
    return _LEAST_OF_JERK if any(getattr(term, "nu", 0) >= _JERK for term in problem.constants) else _LEAST


def lines_of(problems: Sequence[Problem], places: NDArray[np.intp]) -> Iterator[ProblemLine]:
    """Lines through enough of the problems, whose places are beside them; each is on one line at most."""
    kinds: dict[Hashable, list[int]] = {}
    forms = [form_of(problem) for problem in problems]
    for i, form in enumerate(forms):
        if form.key is not None:
            kinds.setdefault(form.key, []).append(i)
    for alike in kinds.values():
        least = least_count(problems[alike[0]])
        if len(alike) < least:
            continue
        numbers = np.array([forms[i].numbers for i in alike])
        counts = [len(np.unique(column)) for column in numbers.T]
        along = int(np.argmax(counts)) if counts else 0
        _, groups = np.unique(np.delete(numbers, along, axis=1), axis=0, return_inverse=True)
        for group in range(int(groups.max(initial=-1)) + 1):
            rows = np.flatnonzero(groups.reshape(-1) == group)
            line = (
                _line([problems[alike[i]] for i in rows.tolist()], numbers[rows, along]) if len(rows) >= least else None
            )
            if line is not None:
                yield ProblemLine(places[np.array(alike)[rows[line.places]]], line.t, line.path)


def _line(problems: list[Problem], values: Array) -> ProblemLine | None:
    order = np.argsort(values, kind="stable")
    first, last = values[order[0]], values[order[-1]]
    if not first < last:
        return None
    path = between(problems[order[0]], problems[order[-1]])
    t = (values[order] - first) / (last - first)
    middle = len(order) // 2
    if path is None or not _on(path, float(t[middle]), problems[order[middle]]):
        return None
    return ProblemLine(order.astype(np.intp), t, path)


def _on(path: Path, t: float, problem: Problem) -> bool:
    """Whether a problem's program is the path's program at t, up to rounding."""
    numbers, own_numbers = (
        path.numbers(np.array([t])),
        numbers_of(in_units_of(path.model.program, model_of(problem).program)),
    )
    return all(
        getattr(numbers, name).shape == getattr(own_numbers, name).shape
        and np.allclose(getattr(numbers, name), getattr(own_numbers, name), rtol=_OFF_LINE, atol=_OFF_LINE)
        for name in ("right", "bounds", "cost")
    )


def form_of(problem: Problem) -> Form:
    """A problem's form and its numbers; no form where it is not known here, or a constant is bounded from below.

    >>> first, second = (form_of(Problem(B=B, order=4)) for B in (1.6, 1.7))
    >>> first.key == second.key, first.numbers, second.numbers
    (True, (1.0, 1.6), (1.0, 1.7))
    """
    bounded = problem.bounded
    velocity = problem.B
    raised = any(limits.low > 0.0 for _, limits in bounded) or (isinstance(velocity, Range) and velocity.low > 0.0)
    if raised or not (problem.convex or least_power(problem)) or not isinstance(problem.basis, PolynomialBasis):
        return Form(None, ())
    terms = problem.objective.terms
    nested = any(isinstance(term, Maximum) for _, term in terms)
    objective: Hashable = repr(problem.objective) if nested else tuple(repr(term) for _, term in terms)
    numbers = [] if nested else [weight for weight, _ in terms]
    if isinstance(velocity, float):
        numbers.append(velocity)
    elif isinstance(velocity, Range):
        numbers.append(velocity.high)
    numbers += [limits.high for _, limits in bounded if isfinite(limits.high)]
    windows = []
    for window in problem.windows:
        ends = (isfinite(window.low), isfinite(window.high))
        windows.append((window.quantity, window.start, window.stop, *ends, window.value))
        numbers += [value for value in (window.low, window.high) if isfinite(value)]
    kinds = tuple((constant, isfinite(limits.high)) for constant, limits in bounded)
    key = (objective, type(velocity), kinds, tuple(windows), problem.order, problem.basis)
    rest = (problem.monotone, problem.symmetric, problem.boundary, problem.inflexion)
    return Form((*key, *rest), tuple(numbers))
