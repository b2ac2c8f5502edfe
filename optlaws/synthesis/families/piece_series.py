"""Functions that are polynomials between breaks, as Chebyshev series, and the peaks of many series at once.

These are the peaks over the whole interval, as each law alone would have them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any, Self

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.laws import PolynomialLaw
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import basis_values, from_values, nodes, product, real_parts_of_roots
from optlaws.tolerances import BESIDE_BREAK

_FLAT_SLOPE = 1e-9  # of a series: a slope that is less is flat
_SHARING = 8  # points of a piece, in the mean, from which on no copy of its series is made for each

_SMALL = 4096  # values of polynomials: of fewer cosines are quicker than the recurrence

#: the ends of one piece that is the whole interval
WHOLE = np.array([1.0, -1.0])


def widened(columns: NDArray[Any], size: int) -> NDArray[Any]:
    """Columns for `size` variables: those beyond the coordinates are zero, the base law's stays last.

    >>> widened(np.array([1.0, 2.0, 3.0]), 4).tolist()
    [1.0, 2.0, 0.0, 0.0, 3.0]
    """
    wide = np.zeros((*columns.shape[:-1], size + 1), columns.dtype)
    wide[..., : columns.shape[-1] - 1], wide[..., -1] = columns[..., :-1], columns[..., -1]
    return wide


def sides_of(breaks: Array) -> Array:
    """The ends, and the places just before and just after each break between them, of functions that jump there.

    >>> sides_of(np.array([1.0, 0.25, -1.0])).round(12).tolist()
    [1.0, -1.0, 0.25, 0.25]
    """
    return np.concatenate([breaks[[0, -1]], breaks[1:-1] + BESIDE_BREAK, breaks[1:-1] - BESIDE_BREAK])


@dataclass(frozen=True, eq=False)
class PieceSeries:
    """Breaks in u = 1 - 2k, descending from the piece at k = 0, and a Chebyshev series on each piece for each column.

    Shape of `series`: (pieces, coefficients, columns). On piece i the local variable runs from -1 at breaks[i + 1] to
    1 at breaks[i].
    """

    breaks: Array
    series: NDArray[Any]

    @classmethod
    def whole(cls, series: NDArray[Any]) -> Self:
        """One polynomial on the whole interval, a column of its series for each function."""
        return cls(WHOLE, series[None])

    @property
    def terms(self) -> int:
        """The coefficients of each series."""
        return int(self.series.shape[1])

    def widened(self, size: int) -> PieceSeries:
        """The functions for `size` variables, as `widened` has columns."""
        return replace(self, series=widened(self.series, size))

    def scaled(self, factors: Array) -> Self:
        """The functions times factors."""
        return replace(self, series=self.series * factors)

    def place(self, u: Array) -> tuple[NDArray[np.intp], Array]:
        """Piece and local variable; a break belongs to the piece at smaller u, that is later k."""
        count = len(self.series)
        if count == 1:
            high, low = self.breaks.tolist()
            # on [-1, 1] the variable is u itself, without rounding
            local = u * (2.0 / (high - low)) - (high + low) / (high - low)
            return np.zeros(len(u), dtype=np.intp), np.minimum(np.maximum(local, -1.0), 1.0)
        piece = np.clip(np.searchsorted(-self.breaks, -u, side="right") - 1, 0, count - 1)
        high, low = self.breaks[piece], self.breaks[piece + 1]
        return piece, np.clip((u - low) * (2.0 / (high - low)) - 1.0, -1.0, 1.0)

    def derivative(self) -> PieceSeries:
        """Series of the derivative by u."""
        slope = 2.0 / (self.breaks[:-1] - self.breaks[1:])
        lower = chebyshev.chebder(self.series, axis=1) if self.series.shape[1] > 1 else np.zeros_like(self.series)
        return PieceSeries(self.breaks, np.asarray(lower) * slope[:, None, None])

    def values(self, u: Array) -> Array:
        """Columns at the points u, shape (points, columns)."""
        piece, local = self.place(u)
        return self.sums(self._basis(local), piece)

    def _basis(self, local: Array) -> Array:
        """The polynomials at local places: at the ends of pieces by the recurrence, which has more digits there."""
        is_single = len(self.series) == 1
        return basis_values(local, self.terms) if is_single else np.asarray(chebyshev.chebvander(local, self.terms - 1))

    def sums(self, basis: NDArray[np.floating[Any]], piece: NDArray[np.intp]) -> Array:
        """Columns at points of pieces from the Chebyshev polynomials there; many points of a piece share its series."""
        if len(self.series) == 1:
            return np.asarray(basis @ self.series[0])
        if len(piece) < _SHARING * len(self.series):
            return np.asarray(np.einsum("pm,pmc->pc", basis, self.series[piece]))
        columns = np.empty((len(piece), self.series.shape[2]))
        order = np.argsort(piece, kind="stable")
        ends = np.searchsorted(piece[order], np.arange(len(self.series) + 1))
        for series, (first, last) in zip(self.series, pairwise(ends), strict=True):
            here = order[first:last]
            shared = np.broadcast_to(series, (len(here), *series.shape))
            columns[here] = np.einsum("pm,pmc->pc", basis[here], shared)
        return columns

    def global_places(self, piece: int, local: Array) -> Array:
        """The u of local places on a piece."""
        high, low = self.breaks[piece], self.breaks[piece + 1]
        half = (high - low) / 2.0
        places: Array = low + (local + 1.0) * half if len(self.series) > 1 else (high + low) / 2.0 + half * local
        return places

    @kept_property
    def _jet(self) -> PieceSeries:
        """The series with their first and second derivatives by u beside them."""
        jet = np.zeros((*self.series.shape[:2], 3, self.series.shape[2]), self.series.dtype)
        each = self
        for nu in range(3):
            jet[:, : each.terms, nu] = each.series
            each = each.derivative()
        return PieceSeries(self.breaks, jet.reshape(*self.series.shape[:2], -1))

    def jets(self, u: Array) -> NDArray[Any]:
        """Columns with two derivatives by u at the points u, shape (3, points, columns)."""
        piece, local = self.place(u)
        flat = self._jet.sums(self._basis(local), piece)
        return np.asarray(flat.reshape(len(u), 3, self.series.shape[2]).transpose(1, 0, 2))

    def planes(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """Columns of one piece with their slopes by u at places of many laws, and the laws' second derivatives there.

        The places are rows of u, (laws, places), and the laws those of `point`.
        """
        polynomials = _polynomials(self.place(u.reshape(-1))[1], self.terms)
        (first, value), (second, slope), (third, bend) = self._parts
        columns = (
            (polynomials[used].T @ series).reshape(*u.shape, -1) for used, series in ((first, value), (second, slope))
        )
        return *columns, np.einsum("nmp,mn->mp", polynomials[third].reshape(-1, *u.shape), point @ bend.T)

    @kept_property
    def _parts(self) -> list[tuple[NDArray[np.intp], Array]]:
        """The polynomials that the functions and their derivatives have, with their coefficients."""
        parts = [(np.flatnonzero(series.any(axis=1)), series) for series in np.hsplit(self._jet.series[0], 3)]
        return [(used, np.ascontiguousarray(series[used])) for used, series in parts]

    def function(self, point: Array, u: Array) -> NDArray[Any]:
        """The sum of the functions times numbers, at the points u."""
        piece, local = self.place(u)
        series = self.series @ point
        if len(series) == 1:
            return np.asarray(chebyshev.chebval(local, series[0]))
        return np.asarray(chebyshev.chebval(local, series[piece].T, tensor=False))

    def mirrored(self) -> PieceSeries:
        """The functions of -u.

        >>> series = PieceSeries(np.array([1.0, 0.5, -1.0]), np.arange(4.0).reshape(2, 2, 1))
        >>> bool(np.allclose(series.mirrored().values(np.array([0.7, -0.7])), series.values(np.array([-0.7, 0.7]))))
        True
        """
        series = self.series[::-1].copy()
        series[:, 1::2] *= -1.0
        return PieceSeries(-self.breaks[::-1], series)

    def roots(self, functions: Iterable[Array]) -> list[Array]:
        """Places among which every root is of a function given by its series on each piece."""
        several = ((i, real_parts_of_roots(series)) for i, series in enumerate(functions) if series.any())
        return [self.global_places(i, roots[np.abs(roots) < 1.0]) for i, roots in several]

    def stationary(self, function: Array, corners: Array, *, jumps: bool) -> Array:
        """Places among which every extremum of a function is: roots of its slope, and corners.

        Parameters
        ----------
        function
            Its series on each piece, shape (pieces, coefficients).
        corners
            The ends and the breaks, where it `jumps` the places on both sides of each.
        """
        slopes = [np.asarray(chebyshev.chebder(series), dtype=np.float64) for series in function]
        if len(slopes) == 1:
            return np.concatenate([corners, *self.roots(slopes)])
        steep = [
            slope if np.abs(slope).max() > _FLAT_SLOPE * np.abs(series).max() else np.zeros(1)
            for slope, series in zip(slopes, function, strict=True)
        ]
        needed = np.ones(len(corners), dtype=np.bool_)
        if not jumps:
            # where the function goes on rising or falling, a corner is no extremum
            ends = [np.asarray(chebyshev.chebval(np.array([1.0, -1.0]), slope)) for slope in slopes]
            needed[1:-1] = [
                before[1] * after[0] <= _FLAT_SLOPE * max(before[1] ** 2, after[0] ** 2)
                for before, after in pairwise(ends)
            ]
        return np.concatenate([corners[needed], *self.roots(steep)])

    def slopes_over_root(self, function: Array) -> list[Array]:
        """Series of 2 (1-u) g' + g on each piece, whose roots are those of the slope of g / sqrt(1-u)."""
        slopes = []
        for series, high, low in zip(function, self.breaks, self.breaks[1:], strict=False):
            middle, half = (high + low) / 2.0, (high - low) / 2.0
            way = np.array([2.0 * (1.0 - middle) / half, -2.0])
            slope = product(way, np.asarray(chebyshev.chebder(series), dtype=np.float64))
            slopes.append(np.asarray(chebyshev.chebadd(series, slope)))
        return slopes


def _polynomials(u: Array, count: int) -> Array:
    """Chebyshev polynomials at many places of [-1, 1], shape (count, places)."""
    if u.size * count < _SMALL:
        return np.asarray(np.cos(np.arange(count)[:, None] * np.arccos(u)))
    polynomials = np.empty((max(count, 2), len(u)))
    polynomials[0], polynomials[1] = 1.0, u
    twice = 2.0 * polynomials[1]
    for n in range(2, count):
        np.multiply(twice, polynomials[n - 1], out=polynomials[n])
        polynomials[n] -= polynomials[n - 2]
    return polynomials[:count]


_ANGLE_SETTLED = 1e-8  # of an angle: a peak is off by the square of it

#: points for each degree of the series: between them a peak rises by a share of less than 1/26 (Bernstein)
_DENSITY = 6
_STEPS = 16
_CHUNK = 1024


def peaks(series: Array) -> Array:
    """Greatest magnitude over [-1, 1] of each of many Chebyshev series, shape (laws, coefficients).

    As a sum of cosines f(angle) a series of degree n has |f''| <= n² max |f| (Bernstein): whatever lies between the
    points of a grid is above its neighbours by a known share at most, so that no peak is missed.

    Examples
    --------
    >>> peaks(np.array([[0.0, 0.0, 1.0], [0.5, 1.0, 0.0]])).tolist()
    [1.0, 1.5]
    """
    return by_pieces(_peaks, series)


def greatest(series: Array, signs: tuple[float, ...]) -> Array:
    """The greatest over [-1, 1] of each of many Chebyshev series with the signs that count, one or both.

    >>> greatest(np.array([[-3.0, 0.0, 1.0]]), (1.0,)).tolist()
    [-2.0]
    """
    if len(signs) > 1:
        return peaks(series)
    size = np.abs(series).sum(axis=1)
    raised = signs[0] * series
    raised[:, 0] += size
    return np.asarray(peaks(raised) - size)


def power_peaks(velocity: Array, acceleration: Array) -> Array:
    """Greatest magnitude of the product of two series, for each of many laws."""
    return by_pieces(lambda b, c: _peaks(products(b, c)), velocity, acceleration)


def by_pieces(values: Callable[..., Array], *rows: Array) -> Array:
    """A value of each row of arrays, computed for some rows at a time: a million laws then need the memory of those.

    >>> by_pieces(lambda rows: rows.sum(axis=1), np.ones((3, 2))).tolist()
    [2.0, 2.0, 2.0]
    """
    begins = range(0, len(rows[0]), _CHUNK)
    return np.concatenate([np.empty(0), *(values(*(array[i : i + _CHUNK] for array in rows)) for i in begins)])


def of_polynomials(laws: Sequence[PolynomialLaw], name: str) -> Array:
    """B, C, D, J or rms_c of many polynomial laws."""
    count = max((len(law.acceleration) for law in laws), default=0) + 1
    c = np.array([[*law.acceleration, *[0.0] * (count - len(law.acceleration))] for law in laws]).reshape(-1, count)
    b = chebyshev.chebint(c, lbnd=-1.0, scl=0.5, axis=1)
    b[:, 0] += [law.b0 for law in laws]
    return constant_of_series(name, b, c, 2.0 * chebyshev.chebder(c, axis=1))


def constant_of_series(name: str, b: Array, c: Array, j: Array) -> Array:
    """B, C, D, J or rms_c of many laws whose velocities, accelerations and jerks are series."""
    if name == "D":
        return power_peaks(b, c)
    return root_mean_squares(c) if name == "rms_c" else peaks({"B": b, "C": c, "J": j}[name])


def products(first: Array, second: Array) -> Array:
    """Products of Chebyshev series, law by law."""
    count = first.shape[1] + second.shape[1]
    values = [factor @ chebyshev.chebvander(nodes(count), factor.shape[1] - 1).T for factor in (first, second)]
    return from_values((values[0] * values[1]).T).T


def root_mean_squares(series: Array) -> Array:
    """Root of the mean square over [-1, 1] of each series."""
    u, weights = np.polynomial.legendre.leggauss(series.shape[1] + 1)
    values = series @ chebyshev.chebvander(u, series.shape[1] - 1).T
    return np.asarray(np.sqrt(values**2 @ weights / 2.0))


@lru_cache(maxsize=32)
def _grid(terms: int) -> tuple[Array, Array]:
    count = _DENSITY * terms
    angle = np.linspace(0.0, np.pi, count + 1)
    return angle, np.asarray(np.cos(np.outer(np.arange(terms), angle)), dtype=np.float64)


def _peaks(series: Array) -> Array:
    angle, columns = _grid(series.shape[1])
    values = np.abs(series @ columns)
    greatest: Array = values.max(axis=1)
    share = 1.0 - (np.pi / (2.0 * _DENSITY)) ** 2 / 2.0
    rising = np.full((len(values), values.shape[1] + 2), -1.0)
    rising[:, 1:-1] = values
    tops = (values >= rising[:, :-2]) & (values >= rising[:, 2:]) & (values >= (share * greatest)[:, None])
    law, place = np.nonzero(tops)
    np.maximum.at(greatest, law, _polished(series[law], angle[place], angle[1]))
    return greatest


def _polished(series: Array, angle: Array, apart: float) -> Array:
    """The magnitudes at peaks no farther from some angles than `apart`, by Newton's method between two sides of each.

    The angles are no lower than those that far away. Beyond an end, where a series rests, it is mirrored.
    """
    n = np.arange(series.shape[1])
    best, going = np.zeros(len(series)), np.arange(len(series))
    low, high = angle - apart, angle + apart
    for _ in range(_STEPS):
        turns, terms = angle[:, None] * n, series[going]
        cosines = terms * np.cos(turns)
        value = cosines.sum(axis=1)
        slope, bend = -(terms * n * np.sin(turns)).sum(axis=1), -(cosines * (n * n)).sum(axis=1)
        best[going] = np.maximum(best[going], np.abs(value))
        rising = value * slope > 0.0
        low, high = np.where(rising, angle, low), np.where(rising, high, angle)
        further = angle - np.divide(slope, bend, out=np.full_like(slope, np.inf), where=bend != 0.0)
        between = (low <= further) & (further <= high) & (value * bend < 0.0)
        further = np.where(between, further, (low + high) / 2.0)
        left = np.abs(further - angle) > _ANGLE_SETTLED
        angle, low, high, going = further[left], low[left], high[left], going[left]
        if not len(going):
            break
    return best
