"""Proofs that many laws satisfy a family of constraints everywhere: by a bound on each cell, without sample points.

On a cell a row's residual is a Chebyshev series in the cell's own coordinate. A law keeps the row on the cell if the
series' first terms outweigh all others, or if the residual is convex there and a tangent shows that it stays up: at a
contact, whose cell it shares or is joined to by cells in which it is convex, or at the lowest place of the cell itself.
Cells in which neither shows are halved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.synthesis.families.family import LinearFamily

_CELL_MARGIN = 1e-12  # of a right side, or 1: a residual nearer to 0 is left to tangents
_TANGENT_FALL = 1e-13  # of the greatest term: by more a tangent at the lowest place may not fall

Flags = NDArray[np.bool_]

#: cells for each degree of a family's series over the whole interval
_DENSITY = 4.0
_LEAST_CELLS = 8
#: terms of a cell's series that are weighed one by one
_WEIGHED = 5
#: terms of a cell's series with which it is looked into; the others are charged
_LOOKED_AT = 14
_JOINED = 4
#: cells at a time that are looked into
_GATHERED = 256
_HALVINGS = 12
_STEPS = 8


@dataclass(frozen=True, eq=False)
class Cells:
    """Columns of families on cells of their domains, as Chebyshev series in each cell's own coordinate.

    Families whose rows hold with both signs come first; the others are turned so that they hold upward.
    """

    families: tuple[LinearFamily, ...]

    @kept_property
    def order(self) -> list[int]:
        """The families in the order of their cells."""
        return sorted(range(len(self.families)), key=lambda i: len(self.families[i].signs) == 1)

    @kept_property
    def edges(self) -> list[Array]:
        """The ends of each family's cells, ascending; in the order of the cells."""
        return [_edges(self.families[i]) for i in self.order]

    @kept_property
    def blocks(self) -> list[slice]:
        """Index ranges of the cells of each family, in order."""
        ends = np.cumsum([0] + [len(edges) - 1 for edges in self.edges]).tolist()
        return [slice(low, high) for low, high in pairwise(ends)]

    @kept_property
    def family(self) -> NDArray[np.intp]:
        """The number of the family that each cell belongs to."""
        return np.repeat(self.order, [block.stop - block.start for block in self.blocks])

    @kept_property
    def twofold(self) -> int:
        """How many cells are of families whose rows hold with both signs."""
        return sum(len(self.families[i].signs) == 2 for i in self.family.tolist())

    @kept_property
    def begins(self) -> Flags:
        """A mask of cells that have no neighbour before them."""
        broken = np.zeros(len(self.family), dtype=np.bool_)
        broken[[block.start for block in self.blocks]] = True
        return broken

    @kept_property
    def reach(self) -> Array:
        """The distance from a contact of each family up to which its tangent is used as a bound."""
        least = np.empty(len(self.families))
        least[self.order] = [(_JOINED + 1) * float(np.diff(edges).max()) for edges in self.edges]
        return least

    @kept_property
    def series(self) -> Array:
        """Coefficients of the columns on each cell, shape (coefficients, cells, variables + 1)."""
        parts = [_upward(self.families[i], edges) for i, edges in zip(self.order, self.edges, strict=True)]
        count = max(map(len, parts))
        return np.concatenate([np.pad(part, ((0, count - len(part)), (0, 0), (0, 0))) for part in parts], axis=1)

    @kept_property
    def by_cell(self) -> Array:
        """The coefficients cell by cell, shape (cells, coefficients, variables + 1)."""
        return np.ascontiguousarray(self.series.transpose(1, 0, 2))

    @kept_property
    def weighed(self) -> Array:
        """The first coefficients as one matrix for all laws, shape (variables + 1, coefficients * cells)."""
        first = self.series[:_WEIGHED]
        return np.ascontiguousarray(first.reshape(-1, first.shape[2]).T)

    @kept_property
    def rest(self) -> tuple[Array, Array]:
        """Bounds, by variable, of all other terms of the value and of the second derivative on a cell."""
        sizes = np.abs(self.series[_WEIGHED:])
        return sizes.sum(axis=0), np.einsum("n,nci->ci", _bends(len(self.series))[_WEIGHED:], sizes)


def _edges(family: LinearFamily) -> Array:
    low, high = np.arccos(np.array(family.domain)[::-1])
    count = max(_LEAST_CELLS, int(np.ceil(_DENSITY * len(family.series) * (high - low) / np.pi)))
    edges = np.cos(np.linspace(low, high, count + 1))[::-1].copy()
    edges[0], edges[-1] = family.domain
    return edges


def _upward(family: LinearFamily, edges: Array) -> Array:
    """Coefficients of a family's columns on its cells, shape (coefficients, cells, variables + 1)."""
    count = max(len(family.series), _WEIGHED)
    angle = (np.arange(count) + 0.5) * (np.pi / count)
    middle, half = (edges[1:] + edges[:-1]) / 2.0, (edges[1:] - edges[:-1]) / 2.0
    places = middle + half * np.cos(angle)[:, None]
    values = family.columns(places.reshape(-1))[0].reshape(count, -1)
    back = np.cos(np.outer(np.arange(count), angle)) * (2.0 / count)
    back[0] /= 2.0
    upward = family.signs[0] if len(family.signs) == 1 else 1.0
    return np.asarray((upward * back @ values).reshape(count, len(middle), -1))


def excess_at(family: LinearFamily, point: Array, room: Array) -> Array:
    """The excess of a family whose domain is one place."""
    value = point @ family.columns(np.array(family.domain[:1]))[0, 0]
    broken = np.max([sign * value - room for sign in family.signs], axis=0)
    return np.asarray(np.maximum(broken, 0.0) / np.maximum(1.0, np.abs(room)))


@dataclass(frozen=True, eq=False)
class Residuals:
    """The slack of many laws in the rows of some families, on cells."""

    cells: Cells
    point: Array  #: the laws' variables and 1
    room: Array  #: the right sides of the families in each law, shape (laws, families)
    #: for each family the places of contacts whose own residuals are accounted for elsewhere, shape (laws, contacts)
    touching: Sequence[Array]

    def excess(self) -> Array:
        """The greatest violation of rows by each law, relative to the right side or 1; 0 without a violation."""
        shortfalls = np.zeros(len(self.point))
        law, cell, sign = self._doubtful()
        if len(law):
            room = self.room[law, self.cells.family[cell]]
            below = _below_zero(self._series(law, cell, sign, room))
            np.maximum.at(shortfalls, law, np.maximum(below, 0.0) / np.maximum(1.0, np.abs(room)))
        return shortfalls

    def _doubtful(self) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
        """Laws, cells and signs for which neither the first terms nor a contact proves the rows."""
        both = self.cells.twofold
        first = (self.point @ self.cells.weighed).reshape(len(self.point), _WEIGHED, -1)
        beyond, bent = self._rest()
        size = np.empty_like(first[:, 0])
        spread = np.abs(first[:, 1]) + beyond
        for n in range(2, _WEIGHED):
            spread += np.abs(first[:, n], out=size)
        most = first[:, 0] + spread
        np.add(np.abs(first[:, 0, :both], out=size[:, :both]), spread[:, :both], out=most[:, :both])
        law, cell = np.nonzero(self._reached(most))
        sign = np.where((cell < both) & (first[law, 0, cell] < 0.0), -1.0, 1.0)
        second, third, fourth = (first[law, n, cell] for n in (2, 3, 4))
        convex = -4.0 * sign * second - 24.0 * np.abs(third) - 80.0 * np.abs(fourth) > bent[cell]
        left = ~self._joined(law, cell, convex)
        law, cell, sign = law[left], cell[left], sign[left]
        if both and spread[:, :both].max(initial=0.0) >= self._limit.min(initial=np.inf):
            spread[:, :both] -= size[:, :both]
            spread[:, both:] = -np.inf
            other, there = np.nonzero(self._reached(spread))
            sign = np.concatenate([sign, np.where(first[other, 0, there] < 0.0, 1.0, -1.0)])
            law, cell = np.concatenate([law, other]), np.concatenate([cell, there])
        return law, cell, sign

    @property
    def _limit(self) -> Array:
        return np.asarray(self.room - _CELL_MARGIN * np.maximum(1.0, np.abs(self.room)))

    def _reached(self, most: Array) -> Flags:
        """The cells on which the slack is not proven to be positive."""
        limit, above = self._limit, np.empty(most.shape, dtype=np.bool_)
        for i, block in zip(self.cells.order, self.cells.blocks, strict=True):
            np.greater_equal(most[:, block], limit[:, i, None], out=above[:, block])
        return above

    def _rest(self) -> tuple[Array, Array]:
        """Bounds of the terms without weights on each cell, over all laws: their mean, and the rest."""
        value, bend = self.cells.rest
        mean = self.point.mean(axis=0)
        away = np.abs(self.point - mean).max(axis=0)
        of_mean = np.abs(self.cells.series[_WEIGHED:] @ mean)
        bends = _bends(len(self.cells.series))[_WEIGHED:]
        return of_mean.sum(axis=0) + value @ away, bends @ of_mean + bend @ away

    def _joined(self, law: NDArray[np.intp], cell: NDArray[np.intp], convex: Flags) -> Flags:
        """A mask of cells with a contact and a convex residual, and of cells joined to these."""
        shape = (len(self.point), len(self.cells.family))
        bent, marked = np.zeros(shape, dtype=np.bool_), np.zeros(shape, dtype=np.bool_)
        bent[law[convex], cell[convex]] = True
        for i, edges, block in zip(self.cells.order, self.cells.edges, self.cells.blocks, strict=True):
            u = self.touching[i]
            piece = np.minimum(np.maximum(np.searchsorted(edges, u, side="right") - 1, 0), len(edges) - 2)
            marked[np.arange(len(u))[:, None], block.start + piece] = True
        marked &= bent
        apart = self.cells.begins[1:]
        for _ in range(_JOINED):
            grown = marked.copy()
            grown[:, 1:] |= marked[:, :-1] & ~apart
            grown[:, :-1] |= marked[:, 1:] & ~apart
            marked = grown & bent
        return np.asarray(marked[law, cell])

    def _series(self, law: NDArray[np.intp], cell: NDArray[np.intp], sign: Array, room: Array) -> Array:
        """The residuals of some laws on cells: their first terms, less a bound of the remaining terms."""
        series = self.cells.by_cell
        leading = min(_LOOKED_AT, series.shape[1])
        rows = np.empty((len(law), leading))
        for i in range(0, len(law), _GATHERED):
            some = slice(i, i + _GATHERED)
            terms = np.matmul(series[cell[some]], self.point[law[some]][:, :, None])[:, :, 0]
            rows[some] = -sign[some, None] * terms[:, :leading]
            rows[some, 0] -= np.abs(terms[:, leading:]).sum(axis=1)
        rows[:, 0] += room
        return rows


def _bends(count: int) -> Array:
    """The greatest second derivatives of Chebyshev polynomials."""
    square = np.arange(count) ** 2.0
    return np.asarray(square * (square - 1.0) / 3.0)


def _below_zero(rows: Array) -> Array:
    """A bound of each series below 0 on [-1, 1], by repeated halving."""
    depths = np.zeros(len(rows))
    owner = np.arange(len(rows))
    for _ in range(_HALVINGS):
        low = _lowest(rows)
        left = np.isnan(low)
        np.maximum.at(depths, owner[~left], -low[~left])
        if not left.any():
            return depths
        rows, owner = np.concatenate([rows[left] @ half for half in _halving(rows.shape[1])]), np.tile(owner[left], 2)
    # convex nowhere as yet: what is known is the bound alone
    np.maximum.at(depths, owner, np.abs(rows[:, 1:]).sum(axis=1) - rows[:, 0])
    return depths


def _lowest(rows: Array) -> Array:
    """A lower bound of each series on [-1, 1], capped at 0; NaN where no rule gives a bound."""
    n = np.arange(rows.shape[1])
    sizes = np.abs(rows)
    spread = sizes[:, 1:].sum(axis=1)
    lowest = np.where(rows[:, 0] > spread, 0.0, np.nan)
    # monotone: lowest at an end
    rising = sizes[:, 1] > sizes[:, 2:] @ (n[2:] ** 2.0)
    ends = np.minimum(rows.sum(axis=1), (rows * (-1.0) ** n).sum(axis=1))
    lowest = np.where(np.isnan(lowest) & rising, np.minimum(ends, 0.0), lowest)
    convex = np.isnan(lowest) & (4.0 * rows[:, 2] > sizes[:, 3:] @ _bends(rows.shape[1])[3:])
    if convex.any():
        lowest[convex] = np.minimum(_by_tangent(rows[convex]), 0.0)
    return lowest


def _by_tangent(rows: Array) -> Array:
    """Lower bounds of convex series: the lowest end of the tangent where each is least; NaN where that was not met."""
    series = rows.T
    jets = np.zeros((3, *series.shape))
    jets[0] = series
    jets[1, :-1] = chebyshev.chebder(series)
    jets[2, :-2] = chebyshev.chebder(series, 2)
    at, order = np.zeros(len(rows)), np.arange(rows.shape[1])[:, None]
    for _ in range(_STEPS):
        value, first, second = (jets * np.cos(order * np.arccos(at))).sum(axis=1)
        step = first / np.where(second > 0.0, second, np.inf)
        further = np.minimum(np.maximum(at - step, -1.0), 1.0)
        if (further == at).all():
            break
        at = further
    value, first, _ = (jets * np.cos(order * np.arccos(at))).sum(axis=1)
    # from the place itself to the end toward which the tangent falls
    fall = np.abs(first) * np.where(first > 0.0, 1.0 + at, 1.0 - at)
    return np.where(fall <= _TANGENT_FALL * np.abs(rows).max(axis=1), value - fall, np.nan)


@lru_cache(maxsize=16)
def _halving(count: int) -> tuple[Array, Array]:
    """Matrices from coefficients on an interval to coefficients on its two halves."""
    angle = (np.arange(count) + 0.5) * (np.pi / count)
    back = np.cos(np.outer(angle, np.arange(count))) * (2.0 / count)
    back[:, 0] /= 2.0
    places = np.cos(angle)
    halves = ((places - 1.0) / 2.0, (places + 1.0) / 2.0)
    lower, upper = (np.asarray(chebyshev.chebvander(half, count - 1).T @ back) for half in halves)
    return lower, upper
