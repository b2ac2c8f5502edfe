"""Base class of sets of laws, over which programs are written: affine functions of k for coordinates."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.polynomial import legendre

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.synthesis.families.family import (
    ConstraintFamily,
    LinearFamily,
    NormFamily,
    ProductFamily,
)
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.families.piece_series import PieceSeries, widened
from optlaws.synthesis.spaces.divided_rows import below_peak
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.tolerances import BESIDE_BREAK

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
