"""Laws of least power along a path: local optima, as for single problems, with the quick bound of each.

That a law is the best nearby, its state shows; that no other branch of laws is better, laws that are sought from all
starts do, here and there on the path. Between two that are as good as those of the path, the path's remain.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.arrays.continuation import laws_along
from optlaws.synthesis.arrays.newton_steps import with_one
from optlaws.synthesis.arrays.programs import Path, SolvedBatch, between
from optlaws.synthesis.families.family import ProductFamily
from optlaws.synthesis.families.peaks import by_pieces
from optlaws.synthesis.problem.constants import D
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import relaxed
from optlaws.tolerances import AGREEMENT

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
