"""The laws of eq. 8 with a piecewise polynomial Z, such as one in B-splines, as a linear space.

Every function is k^l (k-1)^l W_i(k), differentiated by the product rule, so that nothing is integrated or expanded.
The coordinates are such that the accelerations of the free functions are orthonormal.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from math import comb, perm

import numpy as np
from numpy.polynomial import chebyshev

from optlaws.kept import kept_property
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.families.piece_series import PieceSeries
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions, law_from_z
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.synthesis.spaces.splines import PiecewiseBasis
from optlaws.tolerances import ROUNDOFF

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
