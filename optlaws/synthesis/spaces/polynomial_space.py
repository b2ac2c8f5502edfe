"""The laws of eq. 8 with polynomial Z as a linear space with well-conditioned coordinates.

With u = 1 - 2k the free part of the velocity is (k(1-k))^(l-1) times a polynomial. Gegenbauer polynomials of index
l - 1/2 are orthogonal for that weight, those of degree 1 and more carry no stroke, and both Z(k) and c(k) are again
Gegenbauer series (of index l + 1/2 and l - 3/2): every free function has a closed form and nothing is expanded.
"""

from __future__ import annotations

from sys import maxsize

import numpy as np

from optlaws.kept import kept_property
from optlaws.laws import PolynomialLaw
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, gegenbauer, nodes
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.families.piece_series import PieceSeries
from optlaws.synthesis.spaces.bases import PolynomialBasis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions, law_from_z
from optlaws.synthesis.spaces.space import LawSpace


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
