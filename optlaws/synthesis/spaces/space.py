"""Base class of sets of laws, over which programs are written: affine functions of k for coordinates.

Rows of functions that vanish somewhere would be ill posed there: they are divided by what they vanish like.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from math import factorial
from typing import ClassVar

import numpy as np
from numpy.polynomial import chebyshev, legendre

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.families.family import (
    ConstraintFamily,
    LinearFamily,
    NormFamily,
    ProductFamily,
)
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.families.piece_series import PieceSeries, widened
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.tolerances import BESIDE_BREAK


def chord(jerk: Callable[[Array], Array], u: Array, centre: float, degree: int) -> Array:
    """(b - b0) / (u - u0)² at points u where b has the value b0 and no slope at u0; by an integral, so nothing cancels.

    Parameters
    ----------
    jerk
        Columns of j at points u = 1 - 2k, shape (points, columns); polynomials of a degree.
    u, centre
        The points and u0.
    degree
        The degree of b.

    Examples
    --------
    >>> chord(lambda u: np.full((len(u), 1), 8.0), np.array([0.25]), 0.5, 2)  # b = 1 + (u - 0.5)²
    array([[1.]])
    """
    # by Taylor the mean of b'' with the weight 1 - s, and b'' by u is j/4
    return _mean(jerk, u, centre, degree, lambda share: 1.0 - share) / 4.0


def kink(acceleration: Callable[[Array], Array], u: Array, centre: float, degree: int) -> Array:
    """(b - b0) / |u - u0| on one side of u0 where b has a kink; otherwise as `chord`.

    >>> kink(lambda u: np.full((len(u), 1), -4.0), np.array([0.75]), 0.5, 1)  # b = 1 + 2 (u - 0.5)
    array([[2.]])
    """
    side = np.sign(u - centre)[:, None]
    return -side * _mean(acceleration, u, centre, degree, np.ones_like) / 2.0


def _mean(
    values: Callable[[Array], Array], u: Array, centre: float, degree: int, weight: Callable[[Array], Array]
) -> Array:
    x, weights = legendre.leggauss(degree // 2 + 2)
    share = (1.0 + x) / 2.0
    places = centre + np.outer(u - centre, share)
    columns = values(places.reshape(-1)).reshape(len(u), len(share), -1)
    return np.asarray(np.einsum("psc,s->pc", columns, weights * weight(share) / 2.0))


def below_peak(acceleration: PieceSeries, jerk: PieceSeries, centre: float, *, smooth: bool) -> PieceSeries:
    """Piecewise series of (b - b0) / w with w > 0, b0 the velocity at the centre: at most 0 if and only if b <= b0.

    On a piece that reaches the centre w = (u - u0)², or |u - u0| where c may jump at the centre, which leaves a
    polynomial; on the others it is this at the end nearer to the centre. All is integrated from the centre outward, so
    nothing cancels.

    Parameters
    ----------
    acceleration, jerk
        The series of c and j by u = 1 - 2k.
    centre
        Where the peak is, in u.
    smooth
        Whether c is continuous and zero there; what the series has there is left out.
    """
    breaks = acceleration.breaks
    count = acceleration.series.shape[1] + 1
    divided = np.zeros((len(breaks) - 1, count, acceleration.series.shape[2]))
    power = 2 if smooth else 1
    touching = [i for i in range(len(divided)) if breaks[i + 1] <= centre <= breaks[i]]
    for i in touching:
        low, high = breaks[i + 1], breaks[i]
        u = low + (high - low) * (1.0 + nodes(count)) / 2.0
        of = chord if smooth else kink
        divided[i] = from_values(of(_extended(jerk if smooth else acceleration, i), u, centre, count - 1))
        if smooth:
            # it has two degrees less: the rest is rounding
            divided[i, max(count - 2, 1) :] = 0.0
    for i in (*range(touching[0] - 1, -1, -1), *range(touching[-1] + 1, len(divided))):
        inner, end = (i + 1, -1.0) if breaks[i + 1] >= centre else (i - 1, 1.0)
        near, behind = (breaks[i + 1], inner) if end < 0.0 else (breaks[i], inner)
        scale = abs(near - centre) ** power
        # the neighbour's value at the break, in its own units
        height = np.asarray(chebyshev.chebval(-end, divided[behind])) * _unit(breaks, behind, centre, power, near)
        rise = -np.asarray(chebyshev.chebint(acceleration.series[i], axis=0)) * (breaks[i] - breaks[i + 1]) / 4.0
        rise[0] += height - np.asarray(chebyshev.chebval(end, rise))
        divided[i] = rise / scale
    return PieceSeries(breaks, divided)


def _unit(breaks: Array, piece: int, centre: float, power: int, at: float) -> float:
    """The divisor of b - b0 on a piece at one of its ends."""
    low, high = breaks[piece + 1], breaks[piece]
    if low <= centre <= high:
        return float(abs(at - centre) ** power)
    return float(min(abs(low - centre), abs(high - centre)) ** power)


def _extended(pieces: PieceSeries, piece: int) -> Callable[[Array], Array]:
    """The columns of one piece as functions of u, at its ends too."""
    low, high = pieces.breaks[piece + 1], pieces.breaks[piece]

    def columns(u: Array) -> Array:
        return np.asarray(chebyshev.chebval(2.0 * (u - low) / (high - low) - 1.0, pieces.series[piece]).T)

    return columns


def above_rest(velocity: PieceSeries, derivative: PieceSeries, order: int) -> PieceSeries:
    """Piecewise series of -b / w with w > 0: at most 0 if and only if b >= 0.

    With k1 the end of the first piece w = (k/k1)^(l-1) there, likewise on a last piece that ends with k = 1, and 1 on
    the others: w is continuous. Lower powers of k, which rest makes vanish, are left out.

    Parameters
    ----------
    velocity, derivative
        The series of b, and of the derivative of a of order l, by u = 1 - 2k.
    order
        The number l of boundary conditions, at least 2.
    """
    series = -velocity.series
    ends = [i for i, u in ((0, 1.0), (len(series) - 1, -1.0)) if velocity.breaks[i + (u < 0.0)] == u]
    for i in ends:
        series[i] = _divided(derivative, i, series.shape[1], order - 1)
    return PieceSeries(velocity.breaks, series)


def _divided(derivative: PieceSeries, piece: int, count: int, power: int) -> Array:
    """-b / w on the first or the last piece, by Taylor's remainder, so that nothing cancels."""
    # the share of the piece's length that a place is away from the end of the interval
    side = 1.0 if piece == 0 else -1.0
    away = (1.0 - side * nodes(count)) / 2.0
    x, weights = legendre.leggauss(count // 2 + 2)
    share = (1.0 + x) / 2.0
    local = side * (1.0 - 2.0 * np.outer(away, share))
    columns = chebyshev.chebval(local.reshape(-1), derivative.series[piece])
    values = columns.T.reshape(count, len(share), -1)
    means = np.einsum("psc,s->pc", values, weights * (1.0 - share) ** (power - 1) / 2.0)
    length = (derivative.breaks[piece] - derivative.breaks[piece + 1]) / 2.0
    return np.asarray(-from_values(means) * (side * length) ** power / factorial(power - 1))


_CACHED = 32


@dataclass(frozen=True, eq=False)
class Equation:
    """A condition on the coordinates that every law of the space keeps: row . x = right."""

    name: str
    row: Array
    right: float


@dataclass(frozen=True, eq=False)
class Quadrature:
    """Weights (sum 1 over the interval), a derivative's columns at the points, and moment functions there, |.| <= 1."""

    weights: Array
    values: Array
    moments: Array


class LawSpace(ABC):
    """Laws base + sum x_i f_i, polynomials between breaks. Variables beyond `terms` belong to the program.

    Attributes
    ----------
    boundary, order, at_rest
        End conditions, how many there are at each end, and whether they are those of rest.
    breaks
        All breaks of the laws, of both halves.
    continuity
        Order up to which the derivatives of every law are continuous at the breaks.
    symmetric
        Whether the laws are; then constraints need to hold on the first half only.
    domain
        The least and the greatest u = 1 - 2k at which constraints need to hold.
    terms
        Number of coordinates.
    start_velocity, velocity_change, stroke
        b(0), b(1) - b(0) and a(1) - a(0) of the base law.
    """

    terms: int
    keeps_ends: ClassVar[bool] = True  #: whether every function keeps the end conditions, so that no equations need to

    def __init__(
        self, boundary: BoundaryConditions, breaks: tuple[float, ...], continuity: int, *, symmetric: bool
    ) -> None:
        self.boundary, self.order = boundary, boundary.order
        self.at_rest = boundary == BoundaryConditions.rest(self.order)
        self.breaks, self.continuity, self.symmetric = breaks, continuity, symmetric
        self.domain = (0.0, 1.0) if symmetric else (-1.0, 1.0)
        self.stroke = float(boundary.end[0]) - float(boundary.start[0])
        # with one condition at each end the base law is a straight line
        ends = (boundary.start[1], boundary.end[1]) if self.order > 1 else (self.stroke, self.stroke)
        self.start_velocity = float(ends[0])
        self.velocity_change = float(ends[1]) - self.start_velocity
        self._pieces: dict[int, PieceSeries] = {}
        self._cache: dict[Hashable, Array] = {}

    def cached(self, key: Hashable, make: Callable[[], Array]) -> Array:
        """The value of `make`, cached for the latest keys."""
        known = self._cache.get(key)
        if known is None:
            known = make()
            if len(self._cache) >= _CACHED:
                # a copy of the keys, for another thread may be changing them
                self._cache.pop(next(iter(self._cache.copy())), None)
            self._cache[key] = known
        return known

    @abstractmethod
    def law(self, coordinates: Array) -> MotionLaw:
        """The law with the given coordinates."""

    def z_series(self, coordinates: Array) -> Array:  # noqa: ARG002 - what others of its kind need
        """Chebyshev series of Z in 2k - 1, on each piece where it is piecewise; empty where the laws have no Z."""
        return np.empty(0)

    def derivative(
        self, nu: int, name: str, slack: Array, bound: float = 0.0, signs: tuple[float, ...] = (1.0, -1.0)
    ) -> LinearFamily:
        """Rows s a^(nu) <= slack . x + bound."""
        return self.combination(nu, (1.0,), name, slack, bound, signs=signs)

    def combination(
        self,
        nu: int,
        weights: tuple[float, ...],
        name: str,
        slack: Array,
        bound: float = 0.0,
        *,
        signs: tuple[float, ...] = (1.0, -1.0),
    ) -> LinearFamily:
        """Rows s (w0 a^(nu) + w1 a^(nu+1) + ...) <= slack . x + bound, on the space's part of the interval."""
        table, jumps = self.combined(nu, weights).widened(len(slack)), self.jumps(nu + len(weights) - 1)
        return LinearFamily(name, slack, bound, signs, self.domain, table=table, jumps=jumps)

    def combined(self, nu: int, weights: tuple[float, ...]) -> PieceSeries:
        """Series of w0 a^(nu) + w1 a^(nu+1) + ..., the base law's as the last column."""
        self._finite(nu + len(weights) - 1)
        lowest = self.pieces(nu)
        if weights == (1.0,):
            return lowest
        series = weights[0] * lowest.series
        for i, weight in enumerate(weights[1:], 1):
            terms = self.pieces(nu + i).series
            series[:, : terms.shape[1]] += weight * terms[:, : series.shape[1]]
        return PieceSeries(lowest.breaks, series)

    def _finite(self, nu: int) -> None:
        if nu > self.continuity + 1 and len(self.breaks) > 2:
            raise InputError(
                f"with continuity {self.continuity} the derivative of order {nu} has impulses at the breaks, which are "
                f"beyond every bound: give a continuity of at least {nu - 1}"
            )

    def backward(self, slack: Array, bound: float) -> LinearFamily:
        """Rows -b <= slack . x + bound."""
        return self.derivative(1, RowName.VELOCITY, slack, bound, (-1.0,))

    def power(self, name: str, slack: Array, bound: float = 0.0, weights: tuple[float, ...] = (1.0,)) -> ProductFamily:
        """Rows |b c| <= slack . x + bound; with weights, of w0 b + w1 c + ... and its derivative."""
        first, second = (self.combination(nu, weights, name, slack) for nu in (1, 2))
        return ProductFamily(name, slack, bound, (1.0, -1.0), self.domain, first=first, second=second)

    def norm(self, nu: int, name: str, slack: Array, bound: float = 0.0) -> NormFamily:
        """The row RMS of a^(nu) <= slack . x + bound."""
        rule = self.quadrature(nu)
        matrix = np.sqrt(rule.weights)[:, None] * rule.values
        return NormFamily(name, slack, bound, matrix=widened(matrix, len(slack)))

    def pieces(self, nu: int) -> PieceSeries:
        """Series of the derivative of order nu between breaks of the domain, the base law's column last."""
        if nu not in self._pieces:
            self._pieces[nu] = self._table(nu)
        return self._pieces[nu]

    def _table(self, nu: int) -> PieceSeries:
        """The same, of the derivative of the order below."""
        return self.pieces(nu - 1).derivative().scaled(np.full(self.terms + 1, -2.0))

    def columns(self, nu: int, u: Array) -> Array:
        """The derivative of order nu at places u = 1 - 2k, shape (places, terms + 1): the base law's is the last."""
        self._finite(nu)
        return self.pieces(nu).values(u)

    def degree_of(self, nu: int) -> int:
        """The degree in k of the derivative of order nu, on every piece."""
        return int(self.pieces(nu).series.shape[1]) - 1

    @property
    def edges(self) -> tuple[float, ...]:
        """The u between which every function is one polynomial, descending, in the domain."""
        return tuple(self.pieces(2).breaks.tolist())

    def part(self, start: float, stop: float, orders: Iterable[int]) -> tuple[float, float]:
        """The u of a part of the interval, up to just before its end where a derivative of one of the orders jumps."""
        low, high = 1.0 - 2.0 * stop, 1.0 - 2.0 * start
        if low == high or not any(map(self.jumps, orders)):
            return low, high
        # of symmetric laws the ends may be mirror images of breaks, rounded otherwise
        off = BESIDE_BREAK if self.symmetric else 0.0
        low, high = (next((edge for edge in self.edges[1:-1] if abs(u - edge) <= off), u) for u in (low, high))
        return low + BESIDE_BREAK if low in self.edges[1:-1] else low, high

    def jumps(self, nu: int) -> bool:
        """Whether the derivative of order nu may jump at a break."""
        return nu > self.continuity

    def vanishing(self, nu: int) -> int:  # noqa: ARG002 - none where end conditions are kept by every function
        """How many dimensions of the free functions have no derivative of order nu."""
        return 0

    def row(self, nu: int, k: float) -> Array:
        """The derivative of order nu at k: free functions, then the base law; end conditions are without rounding."""
        if k in {0.0, 1.0} and nu < self.order and self.keeps_ends:
            return np.append(np.zeros(self.terms), float((self.boundary.end if k else self.boundary.start)[nu]))
        return np.asarray(self.pieces(nu).values(np.array([1.0 - 2.0 * k]))[0])

    def below(self, slack: Array, peak: float = 0.5) -> ConstraintFamily:
        """Rows b <= b(peak) of laws with c(peak) = 0, divided by their zeros there; symmetric ones have it at 1/2."""
        centre = 1.0 - 2.0 * peak
        smooth = self.continuity > 1 or centre not in self.pieces(2).breaks
        table = below_peak(self.pieces(2), self.pieces(3), centre, smooth=smooth).widened(len(slack))
        return LinearFamily(RowName.BELOW_PEAK, slack, domain=self.domain, table=table, jumps=True)

    def forward(self, slack: Array) -> ConstraintFamily:
        """Rows b >= 0, which may be divided by their zeros at the ends for laws from rest to rest."""
        return self.derivative(1, RowName.FORWARD, slack, signs=(-1.0,))

    def from_rest(
        self, name: str, slack: Array, *, backward: bool = False, weights: tuple[float, ...] = (1.0,)
    ) -> ConstraintFamily:
        """Rows |b| / sqrt(2k) <= slack . x for k up to 1/2; |b| / sqrt(2 - 2k) for the other half where `backward`."""
        series = self.combined(1, weights)
        table = (series.mirrored() if backward else series).widened(len(slack))
        return LinearFamily(name, slack, 0.0, (1.0, -1.0), (0.0, 1.0), table=table, root=True, mirrored=backward)

    def quadrature(self, nu: int) -> Quadrature:
        """A rule exact for squares of the derivative of order nu, Gauss's on every piece, and Legendre polynomials."""
        self._finite(nu)
        pieces = self.pieces(nu)
        count, number = pieces.series.shape[1] + 1, len(pieces.series)
        x, weights = legendre.leggauss(count)
        u = np.concatenate([pieces.global_places(i, x) for i in range(number)])
        shares = (pieces.breaks[:-1] - pieces.breaks[1:]) / (pieces.breaks[0] - pieces.breaks[-1])
        moments = np.asarray(np.kron(np.eye(number), legendre.legvander(x, count - 1)), dtype=np.float64)
        return Quadrature(np.concatenate([share * weights / 2.0 for share in shares]), pieces.values(u), moments)

    def equations(self) -> list[Equation]:
        """Conditions that the coordinates must keep; none where the free functions keep them all."""
        return []
