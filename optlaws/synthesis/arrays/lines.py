"""Problems that differ in numbers alone, put on straight lines: along each their programs' numbers are affine.

Laws of least power along a path are local optima, as for single problems, with the quick bound of each. That a law is
the best nearby, its state shows; that no other branch of laws is better, laws that are sought from all starts do, here
and there on the path. Between two that are as good as those of the path, the path's remain.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.arrays.continuation import laws_along
from optlaws.synthesis.arrays.newton_steps import with_one
from optlaws.synthesis.arrays.programs import Path, SolvedBatch, between, in_units_of, numbers_of
from optlaws.synthesis.families.family import ProductFamily
from optlaws.synthesis.families.piece_series import by_pieces
from optlaws.synthesis.problem.constants import D, RootMeanSquare
from optlaws.synthesis.problem.expression import Maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.program.writer import model_of, relaxed
from optlaws.synthesis.spaces.bases import PolynomialBasis
from optlaws.tolerances import AGREEMENT

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


_TANGENT_SETTLED = 1e-11  # of a bound: what its certificate may lose, whose tangent is settled to a millionth

#: laws sought from all starts: at least and at most on a path, and of how many one
_LEAST, _MOST, _EACH = 5, 13, 12
_PLACES = 256


def least_power(problem: Problem) -> bool:
    """Whether a problem minimises D alone over a convex set of laws.

    >>> least_power(Problem(B=1.7, order=4, minimise="D")), least_power(Problem(B=1.7, order=4, D=(0.0, 6.0)))
    (True, False)
    """
    power = problem.range("D")
    return (
        [term for _, term in problem.objective.terms] == [D]
        and all(constant.convex or constant == D for constant in problem.constants)
        and all(window.convex for window in problem.windows)
        and power is None
    )


def on_global_branch(
    laws: SolvedBatch, places: NDArray[np.intp], sought: Callable[[int], float | None]
) -> NDArray[np.bool_]:
    """A mask of laws of a path between two laws for which a search from all starts ends with no other.

    Parameters
    ----------
    laws, places
        The laws by ascending t, and what `sought` calls them.
    sought
        The objective that a search for one law from all starts ends with; None where it ends with no law.
    """
    known = np.flatnonzero(laws.solved)
    global_branch = np.zeros(len(places), dtype=np.bool_)
    before: int | None = None
    for row in _looked_at(known).tolist():
        best = sought(int(places[row]))
        same = best is not None and abs(best / laws.objective[row] - 1.0) <= AGREEMENT
        if same:
            global_branch[row if before is None else before : row + 1] = True
        before = row if same else None
    return global_branch & laws.solved


def _looked_at(known: NDArray[np.intp]) -> NDArray[np.intp]:
    """Indices of rows at which laws are compared: both ends and some between."""
    if not len(known):
        return known
    count = int(np.clip(len(known) // _EACH, _LEAST, _MOST))
    return np.unique(known[np.round(np.linspace(0, len(known) - 1, count)).astype(np.intp)])


def with_quick_bounds(path: Path, t: Array, laws: SolvedBatch, limits: Array) -> SolvedBatch:
    """The laws with what is proven of each: the limit, or the least D of the relaxed program where that may be more.

    Parameters
    ----------
    path, t, laws
        The laws and where they are on their path.
    limits
        What no law of each problem is below; minus infinity where nothing is known.
    """
    weight = _weights(path, t)
    objective = weight * _powers(path, laws)
    bound = limits.copy()
    low = np.flatnonzero(laws.solved & ~(weight * _needed_roots(path, laws) ** 2 < limits))
    if len(low):
        roots = _least_roots(path, t[low])
        proven = weight[low] * roots**2 * (1.0 - _TANGENT_SETTLED)
        bound[low] = np.maximum(bound[low], proven)
        # where the relaxed program has no proof
        bound[low[np.isnan(roots)]] = np.nan
    sound = laws.solved & np.isfinite(bound)
    return replace(laws, objective=np.where(sound, objective, np.nan), bound=np.where(sound, bound, np.nan))


def _weights(path: Path, t: Array) -> Array:
    """The weight of D in the objective."""
    return np.asarray(path.model.unit * path.numbers(t).cost[:, path.model.places[D.name]])


def _powers(path: Path, laws: SolvedBatch) -> Array:
    """The peak power of each law, recomputed over the whole interval."""
    [rows] = [family for family in path.model.program.families if isinstance(family, ProductFamily)]
    powers = np.full(len(laws.x), np.nan)
    powers[laws.solved] = rows.unit * by_pieces(lambda x: rows.greatest(with_one(x)), laws.x[laws.solved])
    return powers


def _needed_roots(path: Path, laws: SolvedBatch) -> Array:
    """The least r with |b| <= r sqrt(2k) and r sqrt(2(1-k)) everywhere, nearly, of each law."""
    k = np.arange(1, _PLACES) / _PLACES
    columns = (path.model.space.columns(1, 1.0 - 2.0 * k) / np.sqrt(2.0 * np.minimum(k, 1.0 - k))[:, None]).T
    return by_pieces(lambda x: np.abs(with_one(x) @ columns).max(axis=1), laws.x[:, : path.model.space.terms])


def _least_roots(path: Path, t: Array) -> Array:
    """Lower bounds of the root of D along the path, at ascending t, by the relaxed program; NaN if unproven.

    With D >= 2 s r - s² for any s the program's bound says the same of r, whatever the s.
    """
    first, last = path.problems
    tangent = max([1.0, *(problem.B for problem in path.problems if isinstance(problem.B, float))])
    loose = between(first, last, lambda problem: relaxed(problem, tangent))
    if loose is None:
        return np.full(len(t), np.nan)
    bounds = laws_along(loose, t).bound / _weights(loose, t)
    return np.asarray((bounds + tangent**2) / (2.0 * tangent))
