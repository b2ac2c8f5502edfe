"""The space of laws of each kind of basis: the laws of eq. 8 with a polynomial or a piecewise polynomial Z, and pieces.

With u = 1 - 2k the free part of the velocity of a polynomial law is (k(1-k))^(l-1) times a polynomial. Gegenbauer
polynomials of index l - 1/2 are orthogonal for that weight, those of degree 1 and more carry no stroke, and both Z(k)
and c(k) are again Gegenbauer series (of index l + 1/2 and l - 3/2): every free function has a closed form and nothing
is expanded.

With a piecewise polynomial Z, such as one in B-splines, every function is k^l (k-1)^l W_i(k), differentiated by the
product rule, so that nothing is integrated or expanded. The coordinates are such that the accelerations of the free
functions are orthonormal.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache, partial
from itertools import pairwise
from math import comb, perm
from sys import maxsize

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, gegenbauer, nodes
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.families.piece_series import PieceSeries
from optlaws.synthesis.spaces.bases import Basis, Chebyshev, Pieces, PiecewiseBasis, PolynomialBasis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions, law_from_z
from optlaws.synthesis.spaces.free_pieces import PeriodicPieces, PeriodicSpace, PieceSpace
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import ROUNDOFF


class PolynomialSpace(LawSpace):
    """Laws (8) with the given end conditions and Z of a degree, or, if `symmetric`, its part odd about k = 1/2 only.

    The free functions are scaled so that each has peak acceleration 1. All is dimensionless.

    Parameters
    ----------
    boundary
        End conditions; if `symmetric`, those of a law with a(k) + a(1-k) = 1.
    basis
        The basis of Z, of which the degree counts.
    symmetric
        Keep to symmetric laws: half the coordinates, and constraints need to hold on half the interval only.

    Examples
    --------
    >>> from optlaws import Chebyshev
    >>> space = PolynomialSpace(BoundaryConditions.rest(4), Chebyshev(3), symmetric=True)
    >>> space.terms, round(float(space.row(1, 0.5)[-1]), 12)
    (2, 2.1875)
    """

    def __init__(self, boundary: BoundaryConditions, basis: PolynomialBasis, *, symmetric: bool) -> None:
        super().__init__(boundary, (0.0, 1.0), maxsize, symmetric=symmetric)
        self.degree, self.base = basis.degree, law_from_z(boundary)
        #: degrees of the free velocities' Gegenbauer polynomials; Z has one degree less
        self.index = np.arange(2, self.degree + 2, 2) if symmetric else np.arange(1, self.degree + 2)
        self.terms = len(self.index)
        self._u = nodes(2 * self.order + self.degree + 3)

    @kept_property
    def _shapes(self) -> tuple[Array, Array, Array, Array]:
        """Displacement, velocity, acceleration and Z of the free functions at the Chebyshev points, and their scale."""
        l, m, u = self.order, self.index, self._u
        weight = 1.0 - u * u
        top = int(m[-1])
        velocity = weight ** (l - 1) * gegenbauer(l - 0.5, top, u)[m]
        if l == 1:
            acceleration = -2.0 * gegenbauer(1.5, top, u)[m - 1]
        else:
            factor = 2.0 * (m + 1) * (m + 2 * l - 2) / (2 * l - 3)
            acceleration = factor[:, None] * weight ** (l - 2) * gegenbauer(l - 1.5, top + 1, u)[m + 1]
        step = (2 * l - 1) / (2.0 * m * (m + 2 * l - 1))
        free = gegenbauer(l + 0.5, top - 1, u)[m - 1] * step[:, None]
        displacement = weight**l * free
        # k^l (k-1)^l is (-1/4)^l times the weight
        return displacement, velocity, acceleration, (-4.0) ** l * free

    @kept_property
    def scale(self) -> Array:
        """Scales of the free functions, with which each has the peak acceleration 1."""
        return np.asarray(1.0 / np.abs(self._shapes[2]).max(axis=1))

    def series(self, nu: int) -> Array:
        """Chebyshev series in u = 1 - 2k of the derivative of order nu, the base law's as the last column."""
        return np.asarray(self.pieces(nu).series[0])

    def _table(self, nu: int) -> PieceSeries:
        """The series on the whole interval, of symmetric laws too."""
        if nu > 2:
            return super()._table(nu)
        base = self.base((1.0 - self._u) / 2.0, nu)
        values = np.column_stack([(self._shapes[nu] * self.scale[:, None]).T, base])
        # what lies beyond the degree is rounding
        series = from_values(values)[: 2 * self.order + self.degree + 1 - nu]
        if self.symmetric:
            # a - 1/2 and c are odd about the middle, b is even: rounding must not blur it
            series[(1 if nu == 1 else (2 if nu == 0 else 0)) :: 2] = 0.0
        series.setflags(write=False)
        return PieceSeries.whole(series)

    def law(self, coordinates: Array) -> PolynomialLaw:
        """The law with the given coordinates (one for each free function)."""
        (series,), (start,) = self.laws(coordinates[None])
        return PolynomialLaw(series, a0=float(self.boundary.start[0]), b0=float(start))

    def laws(self, coordinates: Array) -> tuple[Array, Array]:
        """Accelerations of the laws with the coordinates in each row, as series in 2k - 1, and their b(0)."""
        columns = self.series(2)
        # one law after the other: in a product of matrices the rounding of one would depend on the others
        series = np.stack([columns[:, :-1] @ row for row in coordinates]) + columns[:, -1]
        series[:, 1::2] *= -1.0
        start = self.row(1, 0.0)
        return series, coordinates @ start[:-1] + start[-1]

    def z_series(self, coordinates: Array) -> Array:
        series = from_values((self._shapes[3] * self.scale[:, None]).T)[: self.degree + 1]
        mirrored: Array = series @ coordinates
        mirrored[1::2] *= -1.0
        if self.symmetric:
            mirrored[::2] = 0.0
        return mirrored

    def backward(self, slack: Array, bound: float) -> LinearFamily:
        """Rows -b <= slack . x + bound; b is even about 1/2 where the law is symmetric."""
        if not self.symmetric:
            return super().backward(slack, bound)
        table = PieceSeries.whole(self.series(1)[::2]).widened(len(slack))
        return LinearFamily(RowName.VELOCITY, slack, bound, (-1.0,), table=table, even=True)

    def below(self, slack: Array, peak: float = 0.5) -> ConstraintFamily:
        """Rows b <= b(peak) of laws with c(peak) = 0, divided by (2k - 2 peak)²: else they were ill posed."""
        if not self.symmetric:
            return super().below(slack, peak)
        table = PieceSeries.whole(-_chord(self.series(1)[::2])).widened(len(slack))
        return LinearFamily(RowName.BELOW_PEAK, slack, table=table, even=True)

    def forward(self, slack: Array) -> ConstraintFamily:
        """Rows b >= 0, from rest to rest as b / (k(1-k))^(l-1) >= 0 (in units of the base law's)."""
        if not self.at_rest:
            return super().forward(slack)
        scale = np.append(self.scale / float(self.base.b(0.5)), 1.0)
        columns = gegenbauer(self.order - 0.5, int(self.index[-1]), self._u)[np.append(self.index, 0)] * scale[:, None]
        series = -from_values(columns.T)
        table = PieceSeries.whole(series[::2] if self.symmetric else series).widened(len(slack))
        return LinearFamily(RowName.RATIO, slack, table=table, even=self.symmetric)


def _chord(even: Array) -> Array:
    # T_2m(x) - T_2m(0) = -2 (-1)^m sin²(m p) with x = sin p: the division by x² has a closed form
    rows = len(even)
    p = np.arcsin(nodes(2 * rows)[:rows])
    m = np.arange(rows)
    kernel = 2.0 * (-1.0) ** m * (np.sin(np.outer(p, m)) / np.sin(p)[:, None]) ** 2
    return from_values(kernel @ even)


_VELOCITY_CHANGE = 16.0 * ROUNDOFF  # of accelerations: what their mean may miss of the change of the velocity
_EVEN_PART = 1e-9  # of the greatest singular value: less is no even part


class SplineSpace(LawSpace):
    """Laws (8) with the given end conditions and Z in a piecewise basis, or, if `symmetric`, its part odd about 1/2.

    >>> from optlaws import BSplines
    >>> [SplineSpace(BoundaryConditions.rest(3), BSplines(4), symmetric=half).terms for half in (False, True)]
    [7, 3]
    """

    def __init__(self, boundary: BoundaryConditions, basis: PiecewiseBasis, *, symmetric: bool) -> None:
        super().__init__(boundary, basis.breaks, basis.continuity, symmetric=symmetric)
        self.basis, self.base = basis, law_from_z(boundary)
        self._parts = (*(k for k in self.breaks if k < 0.5), 0.5) if symmetric else self.breaks
        mixing = _odd(basis.functions) if symmetric else np.eye(basis.size)
        self.terms = mixing.shape[1]
        self._z = np.einsum("spd,st->pdt", basis.functions, mixing)
        # orthonormal accelerations make the program well conditioned whatever the breaks
        rule = self.quadrature(2)
        root = np.linalg.qr(np.sqrt(rule.weights)[:, None] * rule.values[:, :-1], mode="r")
        self._z = self._z @ np.linalg.inv(root)
        self._pieces.clear()

    def _table(self, nu: int) -> PieceSeries:
        series = self._series(self._parts, 2 * self.order + self.basis.degree - nu, partial(self._derivative, nu))
        # the local variable falls with k
        series[:, 1::2] *= -1.0
        return PieceSeries(1.0 - 2.0 * np.array(self._parts), series)

    def _series(self, parts: tuple[float, ...], degree: int, values: Callable[[int, Array], Array]) -> Array:
        """Chebyshev series between `parts`, which may divide the pieces, of functions of a degree."""
        count = max(degree, 0) + 1
        pieces = []
        for low, high in pairwise(parts):
            piece = int(np.searchsorted(self.breaks, low, side="right")) - 1
            k = low + (high - low) * (1.0 + nodes(count)) / 2.0
            pieces.append(from_values(values(piece, k)))
        return np.stack(pieces)

    def _derivative(self, nu: int, piece: int, k: Array) -> Array:
        """The derivative of order nu at points of a piece: free functions, then the base law; the product rule."""
        free = np.zeros((len(k), self.terms))
        for i in range(min(nu, self.basis.degree) + 1):
            free += comb(nu, i) * _edge(self.order, nu - i, k)[:, None] * self._free(i, piece, k)
        return np.column_stack([free, self.base(k, nu)])

    def _free(self, nu: int, piece: int, k: Array) -> Array:
        """The derivative of order nu of every Z at points of a piece."""
        low, high = self.breaks[piece], self.breaks[piece + 1]
        slope = 2.0 / (high - low)
        series = np.asarray(chebyshev.chebder(self._z[piece], nu)) * slope**nu
        return np.asarray(chebyshev.chebval(slope * (k - low) - 1.0, series).T)

    def _ratio(self, piece: int, k: Array) -> Array:
        """B / (k(1-k))^(l-1) at points of a piece, in units of the base law's."""
        free = self.order * (2.0 * k - 1.0)[:, None] * self._free(0, piece, k)
        free += (k * (k - 1.0))[:, None] * self._free(1, piece, k)
        unit = (-4.0) ** (self.order - 1) * float(self.base.b(0.5))
        return np.column_stack([free / unit, np.ones(len(k))])

    def forward(self, slack: Array) -> ConstraintFamily:
        """Rows b >= 0, from rest to rest as b / (k(1-k))^(l-1) >= 0 (in units of the base law's)."""
        if not self.at_rest:
            return super().forward(slack)
        series = -self._series(self._parts, self.basis.degree + 1, self._ratio)
        series[:, 1::2] *= -1.0
        table = PieceSeries(self.pieces(1).breaks, series).widened(len(slack))
        return LinearFamily(RowName.RATIO, slack, domain=self.domain, table=table)

    def law(self, coordinates: Array) -> PiecewiseLaw:
        """The law with the given coordinates, on the breaks of Z."""
        point = np.append(coordinates, 1.0)
        c = self._accelerations @ point
        velocities = self._break_velocities @ point
        _continue(c, np.diff(self.breaks), velocities, max(self.continuity - 1, self.order - 2))
        starts = velocities[:-1].tolist()
        segments = [PolynomialSegment(tuple(series.tolist()), b) for series, b in zip(c, starts, strict=True)]
        return PiecewiseLaw(self.breaks, segments, float(self.boundary.start[0]))

    @kept_property
    def _accelerations(self) -> Array:
        return self._series(self.breaks, 2 * self.order + self.basis.degree - 2, partial(self._derivative, 2))

    @kept_property
    def _break_velocities(self) -> Array:
        pieces = [*range(len(self.breaks) - 1), len(self.breaks) - 2]
        return np.vstack([self._derivative(1, i, np.array([k])) for i, k in zip(pieces, self.breaks, strict=True)])

    def z_series(self, coordinates: Array) -> Array:
        return np.asarray(self._z @ coordinates).reshape(-1)


def _continue(c: Array, lengths: Array, velocities: Array, flat: int) -> None:
    """Move accelerations so that their integrals lead from velocity to velocity, where more than rounding is missed.

    Great coordinates cancel in them, and a law read from its accelerations alone would add up what is left. What they
    are moved by vanishes at the breaks with its derivatives below the order `flat`, as far as their degree allows.
    """
    orders = np.arange(0, c.shape[1], 2)
    shares = 1.0 / (1.0 - orders.astype(np.float64) ** 2)
    missed = np.diff(velocities) / lengths - c[:, ::2] @ shares
    rounding = _VELOCITY_CHANGE * (np.abs(c).sum(axis=1) + np.abs(velocities[1:]) / lengths)
    # (1 - x²)^n = 2^-n (1 - T2)^n
    hill = chebyshev.chebpow([0.5, 0.0, -0.5], min(flat, (c.shape[1] - 1) // 2), maxpower=c.shape[1])
    hill /= hill[::2] @ shares[: len(hill[::2])]
    c[:, : len(hill)] += np.where(np.abs(missed) > rounding, missed, 0.0)[:, None] * hill


def _odd(functions: Array) -> Array:
    """Combinations of the functions that are odd about 1/2, as orthonormal columns."""
    mirrored = functions[:, ::-1] * (-1.0) ** np.arange(functions.shape[2])
    _, sizes, combinations = np.linalg.svd((functions + mirrored).reshape(len(functions), -1).T)
    even = int((sizes > _EVEN_PART * sizes.max()).sum())
    return np.asarray(combinations[even:].T)


def _edge(order: int, nu: int, k: Array) -> Array:
    """The derivative of order nu of k^l (k-1)^l."""
    total = np.zeros_like(k)
    for i in range(max(nu - order, 0), min(nu, order) + 1):
        total += comb(nu, i) * perm(order, i) * perm(order, nu - i) * k ** (order - i) * (k - 1.0) ** (order - nu + i)
    return total


_CONVERSION_AGREES = 1e-8  # how near conversions between bases come, where even powers lose no digits

#: the greatest degree at which conversions are compared, where even powers lose no digits, and how near they come
_CHECKED = 6


#: the space of each kind of basis, of a special kind before those that it is one of
_SPACES: tuple[tuple[type[Basis], Callable[..., LawSpace]], ...] = (
    (PolynomialBasis, PolynomialSpace),
    (PeriodicPieces, PeriodicSpace),
    (Pieces, PieceSpace),
    (PiecewiseBasis, SplineSpace),
)


@lru_cache(maxsize=64)
def space_of(basis: Basis, boundary: BoundaryConditions, *, symmetric: bool) -> LawSpace:
    """The space of laws with the given basis and end conditions, cached for the next call.

    Raises
    ------
    InputError
        If there is none for this kind of basis, or its conversions contradict each other.

    Examples
    --------
    >>> space_of(Chebyshev(9), BoundaryConditions.rest(4), symmetric=True).terms
    5
    """
    if isinstance(basis, PolynomialBasis) and type(basis) is not Chebyshev:
        check_conversions(replace(basis, degree=min(basis.degree, _CHECKED)))
        return space_of(Chebyshev(basis.degree), boundary, symmetric=symmetric)
    for kind, space in _SPACES:
        if isinstance(basis, kind):
            return space(boundary, basis, symmetric=symmetric)
    raise InputError(f"there is no space of laws for {basis!r}: a basis is of polynomials, pieces or splines")


def check_conversions(basis: PolynomialBasis) -> None:
    """See that a basis leads from a Chebyshev series to its coefficients and back."""
    # any numbers do, and those of numpy.random take as long to import as a law takes to solve
    for turn in (1.0, 2.0):
        given = np.cos(turn * np.arange(1.0, basis.size + 1.0) ** 2)
        coefficients = np.asarray(basis.coefficients(given), dtype=np.float64)
        back = np.zeros(basis.size)
        series = np.asarray(basis.series(tuple(coefficients.tolist())), dtype=np.float64)
        if coefficients.shape == back.shape and series.ndim == 1 and len(series) <= len(back):
            back[: len(series)] = series
            if np.abs(back - given).max() <= _CONVERSION_AGREES:
                continue
        raise InputError(
            f"{type(basis).__name__}.coefficients and .series contradict each other at degree {basis.degree}: the "
            f"series {_shown(given)} comes back as {_shown(series)}. series(coefficients(s)) must be s, with "
            f"{basis.size} coefficients"
        )


def _shown(series: NDArray[np.float64]) -> str:
    return f"[{', '.join(f'{value:.4g}' for value in np.ravel(series)[: _CHECKED + 1])}]"
