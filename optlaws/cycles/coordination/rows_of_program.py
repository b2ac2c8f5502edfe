"""Rows of linear programs over positions at times: collected as they come, solved, and bounded by weak duality."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from optlaws.numbers import Array
from optlaws.tolerances import BENT_FEASIBILITY, ROUNDOFF

_MOST_BROKEN = 1e3


@dataclass(frozen=True)
class Solved:
    """A solution of a program, its value, and a bound that its multipliers prove."""

    unknowns: Array
    value: float
    bound: float


@dataclass(eq=False)
class Rows:
    """Rows over unknowns that are at least their right sides, or equal to them; each divided by its greatest entry."""

    size: int
    low: Array
    high: Array
    count: int = 0
    entries: list[tuple[Array, Array, Array]] = field(default_factory=list)
    sides: list[Array] = field(default_factory=list)
    equal: list[Array] = field(default_factory=list)

    def add(self, places: Sequence[int], values: Sequence[float], side: float, *, equal: bool = False) -> None:
        """A row by its places and values."""
        size = max(map(abs, values), default=0.0)
        if size > 0.0:
            self._append(np.zeros(len(values), dtype=int), np.array(places), np.array(values) / size)
            self._ended(np.array([side / size]), equal=equal)
        elif side > 0.0 or (equal and side != 0.0):
            self._ended(np.array([side]), equal=equal)

    def block(self, rows: Array, first: int, last: Array | None, sides: Array) -> None:
        """Rows of neighbours from a place on, shape (m, n), with an entry of each for the last unknown."""
        sizes = np.abs(rows).max(axis=1)
        sizes = sizes if last is None else np.maximum(sizes, np.abs(last))
        where, places = np.nonzero(rows)
        self._append(where, first + places, rows[where, places] / sizes[where])
        if last is not None:
            every = np.arange(len(rows))
            self._append(every, np.full(len(rows), self.size - 1), last / sizes)
        self._ended(sides / sizes, equal=False)

    def _append(self, where: Any, places: Any, values: Array) -> None:  # noqa: ANN401
        self.entries.append((where + self.count, places, values))

    def _ended(self, sides: Array, *, equal: bool) -> None:
        self.count += len(sides)
        self.sides.append(sides)
        self.equal.append(np.full(len(sides), equal))

    def solve(self, goal: int) -> Solved | None:
        """The least value of an unknown, with its bound; None where rows are proven to contradict each other."""
        matrix, right, equal = self._given
        weights = np.zeros(self.size)
        weights[goal] = 1.0
        solved = _bounded(weights, matrix, right, equal, self.low, self.high)
        if solved is not None:
            return solved
        # the least amount by which all rows are broken: above 0 where they contradict each other
        every = np.concatenate([right, -right[equal]])
        low, high = np.append(self.low, 0.0), np.append(self.high, _MOST_BROKEN)
        broken = _bounded(np.append(0.0 * weights, 1.0), _stacked(matrix, equal), every, None, low, high)
        if broken is not None and broken.bound > 0.0:
            return None
        return Solved(np.empty(0), float(self.low[goal]), float(self.low[goal]))

    def optimum(self, goal: int) -> Array | None:
        """The unknowns of least objective; None if the solver finds none."""
        weights = np.zeros(self.size)
        weights[goal] = 1.0
        answer = _answer(weights, *self._given, self.low, self.high)
        return np.asarray(answer.x) if answer.status == 0 else None

    @property
    def _given(self) -> tuple[Any, Array, Any]:
        """The matrix, the right sides, and which rows are equations."""
        from scipy.sparse import coo_array

        where, places, values = (np.concatenate(parts) for parts in zip(*self.entries, strict=True))
        matrix: Any = coo_array((values, (where, places)), shape=(self.count, self.size)).tocsr()
        return matrix, np.concatenate(self.sides), np.concatenate(self.equal)


def _answer(weights: Array, matrix: Any, right: Array, equal: Any, low: Array, high: Array) -> Any:  # noqa: ANN401
    """The solution of HiGHS for the least weighted sum of unknowns."""
    from scipy.optimize import linprog

    solve: Any = linprog
    among = np.zeros(len(right), dtype=bool) if equal is None else equal
    given = {"A_eq": matrix[among], "b_eq": right[among]} if among.any() else {}
    options = {"primal_feasibility_tolerance": BENT_FEASIBILITY, "dual_feasibility_tolerance": BENT_FEASIBILITY}
    return solve(
        weights,
        A_ub=-matrix[~among],
        b_ub=-right[~among],
        bounds=np.column_stack([low, high]),
        method="highs",
        options=options,
        **given,
    )


def _bounded(
    weights: Array, matrix: Any, right: Array, equal: Any, low: Array, high: Array  # noqa: ANN401
) -> Solved | None:  # fmt: skip
    """The answer with the lower bound of its multipliers, rounding included; None without an answer."""
    answer = _answer(weights, matrix, right, equal, low, high)
    if answer.status != 0:
        return None
    among = np.zeros(len(right), dtype=bool) if equal is None else equal
    prices = np.zeros(len(right))
    prices[~among] = np.maximum(-answer.ineqlin.marginals, 0.0)
    if among.any():
        prices[among] = answer.eqlin.marginals
    rest, reach = weights - prices @ matrix, np.maximum(np.abs(low), np.abs(high))
    sizes = np.abs(prices) @ np.abs(right) + (np.abs(prices) @ abs(matrix) + np.abs(weights)) @ reach
    rounding = 2.0 * (len(right) + len(weights)) * ROUNDOFF * float(sizes)
    bound = float(prices @ right + np.minimum(rest * low, rest * high).sum()) - rounding
    return Solved(np.asarray(answer.x), float(answer.fun), bound)


def _stacked(matrix: Any, equal: Array) -> Any:  # noqa: ANN401 - sparse arrays
    from scipy.sparse import csr_array, hstack, vstack

    rows = vstack([matrix, -matrix[equal]]) if equal.any() else matrix
    ones: Any = np.ones((rows.shape[0], 1))
    return csr_array(hstack([rows, ones]))
