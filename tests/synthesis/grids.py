"""Laws of eq. 8 on a dense grid, for HiGHS: what is least there can only be less than what is least everywhere."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from scipy.optimize import linprog

Array = NDArray[np.float64]
Function = Callable[[Array], Array]


@dataclass(frozen=True)
class Grid:
    """The free functions and the base law as a series on every piece, and how many points each piece has."""

    breaks: Sequence[float]
    series: Sequence[Sequence[Chebyshev]]
    points: int

    def rows(self, nu: int, start: float = 0.0, stop: float = 1.0) -> Array:
        """The derivative of order nu at the points of an interval, ends of pieces included; the base law's last."""
        found = []
        for (low, high), laws in zip(pairwise(self.breaks), self.series, strict=True):
            k = (low + high) / 2 - (high - low) / 2 * np.cos(np.linspace(0.0, np.pi, self.points))
            found.append(_values(laws, nu, k[(k >= start) & (k <= stop)]))
        return np.asarray(np.vstack(found))

    def row(self, nu: int, k: float) -> Array:
        """The derivative of order nu at one k."""
        piece = min(int(np.searchsorted(self.breaks, k, side="right")), len(self.series)) - 1
        return np.asarray(_values(self.series[piece], nu, np.array([k]))[0])

    def least(
        self, upper: Sequence[tuple[Array, float | None]], equal: Sequence[tuple[Array, float]] = ()
    ) -> float | None:
        """The least t with rows . (z, 1) <= number, or <= t where None, and equations; None if there is none."""
        size = len(self.series[0]) - 1
        table, right = [], []
        for rows, bound in upper:
            table.append(np.column_stack([rows[:, :-1], np.full(len(rows), -1.0 if bound is None else 0.0)]))
            right.append((0.0 if bound is None else bound) - rows[:, -1])
        answer = linprog(
            np.append(np.zeros(size), 1.0),
            A_ub=np.vstack(table),
            b_ub=np.concatenate(right),
            A_eq=np.array([np.append(row[:-1], 0.0) for row, _ in equal]) if equal else None,
            b_eq=[value - row[-1] for row, value in equal] if equal else None,
            bounds=(None, None),
        )
        return float(np.asarray(answer.fun)) if answer.status == 0 else None


def grid(order: int, breaks: Sequence[float], functions: Sequence[Function], degree: int, points: int) -> Grid:
    """Rest to rest with Z made of the functions, polynomials of a degree between the breaks."""
    edge = Polynomial([0.0, -1.0, 1.0]) ** order
    smooth = (Polynomial([0.0, -1.0, 1.0]) ** (order - 1)).integ()
    laws: list[Function] = [lambda k, function=function: edge(k) * function(k) for function in functions]  # type: ignore[misc] # bound early
    laws.append(lambda k: smooth(k) / smooth(1.0))
    top = degree + 2 * order
    angles = np.pi * (np.arange(top + 1) + 0.5) / (top + 1)
    series = []
    for low, high in pairwise(breaks):
        nodes = (low + high) / 2 - (high - low) / 2 * np.cos(angles)
        series.append([Chebyshev.fit(nodes, law(nodes), top, domain=(low, high)) for law in laws])
    return Grid(breaks, series, points)


def _values(laws: Sequence[Chebyshev], nu: int, k: Array) -> Array:
    return np.asarray(np.column_stack([(law.deriv(nu) if nu else law)(k) for law in laws]))


def polynomials(order: int, degree: int, points: int = 1201) -> Grid:
    """Laws with Z of a degree."""
    functions = [Chebyshev.basis(i, domain=(0.0, 1.0)) for i in range(degree + 1)]
    return grid(order, (0.0, 1.0), functions, degree, points)


def splines(order: int, breaks: Sequence[float], degree: int, continuity: int, points: int = 161) -> Grid:
    """Laws with Z in B-splines, as scipy has them."""
    inner = np.repeat(breaks[1:-1], degree - continuity)
    knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    count = len(knots) - degree - 1
    functions = [BSpline(knots, one, degree) for one in np.eye(count)]
    return grid(order, breaks, functions, degree, points)
