"""All laws of a problem as numpy series, whatever its basis: columns of Chebyshev coefficients on each piece."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import sqrt
from typing import Any

import numpy as np
from numpy.polynomial import Chebyshev, chebyshev, legendre
from numpy.typing import NDArray
from scipy.interpolate import BPoly, BSpline
from scipy.linalg import null_space

from optlaws import BSplines, Pieces, Problem
from optlaws.synthesis import PolynomialBasis

Array = NDArray[np.float64]


class Undecided(Exception):  # noqa: N818
    """Another solver gave no answer good enough to compare with."""


@dataclass(frozen=True)
class Laws:
    """On each piece the Chebyshev coefficients of a: a column for each free function, the base law's last."""

    breaks: Sequence[float]
    columns: Sequence[Array]

    @property
    def free(self) -> int:
        return int(self.columns[0].shape[1]) - 1

    def derivative(self, nu: int) -> list[Array]:
        found: list[Array] = []
        for (low, high), column in zip(pairwise(self.breaks), self.columns, strict=True):
            # at least two rows, so that a slope can be taken
            slope = np.asarray(chebyshev.chebder(column, nu, scl=2.0 / (high - low)) if nu else column, dtype=float)
            found.append(
                np.asarray(np.vstack([slope, np.zeros((max(0, 2 - len(slope)), column.shape[1]))]), dtype=float)
            )
        return found

    def combined(self, nu: int, weights: Sequence[float]) -> list[Array]:
        """Sum of weights times derivatives from order nu on."""
        first, *others = (self.derivative(nu + i) for i in range(len(weights)))
        found = [weights[0] * one for one in first]
        for weight, other in zip(weights[1:], others, strict=True):
            for total, one in zip(found, other, strict=True):
                total[: len(one)] += weight * one
        return found

    def ratio(self, order: int) -> list[Array]:
        """The velocity divided by what vanishes where laws rest: it has the sign of b, and is not tiny at the ends."""
        found = []
        for low, high, one in zip(self.breaks, self.breaks[1:], self.derivative(1), strict=False):
            # (x + 1)/2 is k at the start of its piece, (1 - x)/2 is 1 - k
            divisor: Any = np.ones(1)
            for _ in range(order - 1):
                divisor = chebyshev.chebmul(divisor, [1.0, 1.0]) if low == 0.0 else divisor
                divisor = chebyshev.chebmul(divisor, [1.0, -1.0]) if high == 1.0 else divisor
            found.append(_divided(one, divisor))
        return found

    def chord(self, place: float) -> tuple[list[Array], float, float]:
        """(b(place) - b) / (2 (k - place))², right where c(place) = 0, on pieces about the place, and their ends."""
        found, touching = [], []
        for low, high, one in zip(self.breaks, self.breaks[1:], self.derivative(1), strict=False):
            x, length = (2.0 * place - low - high) / (high - low), high - low
            gap = -one
            gap[0] += chebyshev.chebval(x, one)
            touches = low <= place <= high
            found.append(_divided(gap, chebyshev.chebpow([-x * length, length], 2)) if touches else 0.0 * one)
            touching += [low, high] if touches else []
        return found, min(touching), max(touching)

    def row(self, nu: int, k: float) -> Array:
        piece = min(int(np.searchsorted(self.breaks, k, side="right")), len(self.columns)) - 1
        return np.asarray(self.rows(self.derivative(nu), piece, np.array([k]))[0])

    def rows(self, functions: Sequence[Array], piece: int, k: Array) -> Array:
        low, high = self.breaks[piece], self.breaks[piece + 1]
        return np.asarray(chebyshev.chebval((2.0 * k - low - high) / (high - low), functions[piece]).T)

    def mean(self, nu: int) -> Array:
        """A matrix whose product with (x, 1) has the RMS as its length."""
        x, weights = legendre.leggauss(40)
        found = []
        for piece, (low, high) in enumerate(pairwise(self.breaks)):
            values = self.rows(self.derivative(nu), piece, low + (high - low) * (x + 1.0) / 2.0)
            found.append(np.sqrt((high - low) * weights / 2.0)[:, None] * values)
        return np.vstack(found)


@lru_cache(maxsize=64)
def laws_of(problem: Problem) -> Laws:
    """All laws of a problem, its ends and its basis kept; mixed so that accelerations are orthogonal."""
    basis = problem.basis
    raw = _pieces(problem, basis) if isinstance(basis, Pieces) else _with_z(problem)
    values = np.vstack(
        [raw.rows(raw.derivative(2), i, grid(a, b, 60)) for i, (a, b) in enumerate(pairwise(raw.breaks))]
    )
    mixing = np.linalg.inv(np.linalg.qr(values[:, :-1])[1]) * sqrt(len(values))
    return Laws(raw.breaks, [np.column_stack([column[:, :-1] @ mixing, column[:, -1]]) for column in raw.columns])


def grid(low: float, high: float, count: int) -> Array:
    return (low + high) / 2.0 - (high - low) / 2.0 * np.cos(np.linspace(0.0, np.pi, count))


def _divided(columns: Array, divisor: Any) -> Array:
    """Series divided by one; at least two rows, so that a slope can be taken."""
    divided = [chebyshev.chebdiv(column, divisor)[0] for column in columns.T]
    size = max(2, *map(len, divided))
    return np.column_stack([np.pad(column, (0, size - len(column))) for column in divided])


def _ends(problem: Problem) -> list[list[float]]:
    conditions = problem.conditions
    return [[float(value) for value in side] for side in (conditions.start, conditions.end)]


def _with_z(problem: Problem) -> Laws:
    """The base law by Hermite interpolation, and k^l (k-1)^l times every function of Z."""
    basis, order = problem.basis, problem.order
    if isinstance(basis, BSplines):
        breaks, degree = basis.breaks, basis.degree
        inner = np.repeat(breaks[1:-1], degree - basis.continuity)
        knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
        shapes: list[Any] = [BSpline(knots, one, degree) for one in np.eye(len(knots) - degree - 1)]
    else:
        assert isinstance(basis, PolynomialBasis)
        breaks, degree = (0.0, 1.0), basis.degree
        shapes = [Chebyshev.basis(i, domain=(0.0, 1.0)) for i in range(degree + 1)]
    if problem.symmetric:
        shapes = [lambda k, shape=shape: shape(k) - shape(1.0 - k) for shape in shapes]
    hermite: Any = BPoly.from_derivatives([0.0, 1.0], _ends(problem))
    columns = []
    for low, high in pairwise(breaks):
        nodes = _nodes(low, high, degree + 2 * order)
        functions = [(nodes * (nodes - 1.0)) ** order * shape(nodes) for shape in shapes]
        columns.append(_series(np.column_stack([*functions, hermite(nodes)])))
    return _independent(Laws(breaks, columns))


def _nodes(low: float, high: float, degree: int) -> Array:
    angles = np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1)
    return np.asarray((low + high) / 2.0 + (high - low) / 2.0 * np.cos(angles))


def _series(values: Array) -> Array:
    """Chebyshev coefficients from values at Chebyshev points."""
    count = len(values)
    angles = np.pi * (np.arange(count) + 0.5) / count
    transform = np.cos(np.outer(np.arange(count), angles)) * 2.0 / count
    transform[0] /= 2.0
    return np.asarray(transform @ values)


def _independent(laws: Laws) -> Laws:
    """Without functions that are sums of others."""
    stacked = np.vstack([column[:, :-1] for column in laws.columns])
    _, sizes, right = np.linalg.svd(stacked / np.linalg.norm(stacked, axis=0).max(), full_matrices=False)
    mixing = right[sizes > 1e-12 * sizes[0]].T
    return Laws(laws.breaks, [np.column_stack([column[:, :-1] @ mixing, column[:, -1]]) for column in laws.columns])


def _pieces(problem: Problem, basis: Pieces) -> Laws:
    """Free coefficients on each piece; ends, continuity and symmetry leave a null space."""
    size, count = basis.degree + 1, len(basis.breaks) - 1
    total = size * count
    plain = Laws(
        basis.breaks, [np.pad(np.eye(size), ((0, 0), (size * i, total - size * (i + 1) + 1))) for i in range(count)]
    )
    rows, right = [], []
    for k, values in zip((0.0, 1.0), _ends(problem), strict=True):
        rows += [plain.row(nu, k)[:-1] for nu in range(len(values))]
        right += values
    for nu in range(basis.continuity + 1):
        functions = plain.derivative(nu)
        for i, k in enumerate(basis.breaks[1:-1]):
            left, after = (plain.rows(functions, piece, np.array([k]))[0] for piece in (i, i + 1))
            rows.append((left - after)[:-1])
            right.append(0.0)
    if problem.symmetric:
        for i in range(count):
            for n in range(size):
                row = np.zeros(total)
                row[size * i + n] += 1.0
                row[size * (count - 1 - i) + n] += (-1.0) ** n
                rows.append(row)
                right.append(float(n == 0))
    table, expected = np.array(rows), np.array(right)
    length = np.linalg.norm(table, axis=1)
    table, expected = table / length[:, None], expected / length
    start = np.linalg.lstsq(table, expected, rcond=1e-12)[0]
    if np.abs(table @ start - expected).max() > 1e-9:
        raise Undecided("the ends do not fit the pieces")
    mixed = np.column_stack([null_space(table, rcond=1e-11), start])
    return Laws(basis.breaks, [mixed[size * i : size * (i + 1)] for i in range(count)])
