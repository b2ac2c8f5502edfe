"""Whether many laws keep a family of rows at every place: on each cell of its domain by a bound, nowhere by points.

On a cell a row's residual is a Chebyshev series in the cell's own coordinate. A law keeps the row on the cell if the
series' first terms outweigh all others, or if the residual is convex there and a tangent shows that it stays up: at a
contact, whose cell it shares or is joined to by cells in which it is convex, or at the lowest place of the cell itself.
Cells in which neither shows are halved.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.synthesis.arrays.columns import Columns
from optlaws.synthesis.arrays.programs import Numbers

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: cells for each degree of a family's series over the whole interval
_DENSITY = 4.0
_LEAST_CELLS = 8
#: terms of a cell's series that are weighed one by one
_WEIGHED = 5
#: of a right side, or 1: a residual nearer to 0 is left to tangents
_MARGIN = 1e-12
#: terms of a cell's series with which it is looked into; the others are charged
_LOOKED_AT = 14
_JOINED = 4
_HALVINGS = 12
_STEPS = 8
#: of the greatest term: by more a tangent at the lowest place may not fall
_FALLS = 1e-13


@dataclass(frozen=True, eq=False)
class Cells:
    """The columns of a family on cells of its domain, as Chebyshev series in each cell's own coordinate."""

    columns: Columns

    @kept_property
    def edges(self) -> Array:
        """The ends of the cells, ascending."""
        low, high = np.arccos(np.array(self.columns.family.domain)[::-1])
        count = max(_LEAST_CELLS, int(np.ceil(_DENSITY * len(self.columns.family.series) * (high - low) / np.pi)))
        found = np.cos(np.linspace(low, high, count + 1))[::-1].copy()
        found[0], found[-1] = self.columns.family.domain
        return found

    @property
    def reach(self) -> float:
        """How far from a contact its tangent is relied on."""
        return (_JOINED + 1) * float(np.diff(self.edges).max())

    @kept_property
    def series(self) -> Array:
        """Coefficients of the columns on each cell, shape (coefficients, cells, variables + 1)."""
        family = self.columns.family
        count = max(len(family.series), _WEIGHED)
        angle = (np.arange(count) + 0.5) * (np.pi / count)
        middle, half = (self.edges[1:] + self.edges[:-1]) / 2.0, (self.edges[1:] - self.edges[:-1]) / 2.0
        places = middle + half * np.cos(angle)[:, None]
        values = family.columns(places.reshape(-1))[0].reshape(count, -1)
        back = np.cos(np.outer(np.arange(count), angle)) * (2.0 / count)
        back[0] /= 2.0
        return np.asarray((back @ values).reshape(count, len(middle), -1))

    @kept_property
    def weighed(self) -> Array:
        """The first coefficients as one matrix for all laws, shape (variables + 1, coefficients * cells)."""
        first = self.series[:_WEIGHED]
        return np.ascontiguousarray(first.reshape(-1, first.shape[2]).T)

    @kept_property
    def rest(self) -> tuple[Array, Array]:
        """By variable, what all other terms can add to the value and to the second derivative on a cell."""
        sizes = np.abs(self.series[_WEIGHED:])
        return sizes.sum(axis=0), np.einsum("n,nci->ci", _bends(len(self.series))[_WEIGHED:], sizes)


@dataclass(frozen=True, eq=False)
class Touching:
    """Contacts of a family in many laws: their places, shape (laws, contacts), and which may be relied on."""

    u: Array
    sound: Flags


def excess(cells: Cells, x: Array, numbers: Numbers, family: int, touching: Touching) -> Array:
    """By how much each law may break a family's rows anywhere, relative to the right side or 1; 0 where it does not.

    Parameters
    ----------
    cells
        Of the family.
    x, numbers, family
        The laws' variables, their programs' numbers and which of the families it is.
    touching
        Contacts whose own residuals are accounted for elsewhere.
    """
    family_rows = cells.columns.family
    room = x @ family_rows.slack + numbers.bounds[:, family]
    point = np.concatenate([x, np.ones((len(x), 1))], axis=1)
    if family_rows.domain[0] == family_rows.domain[1]:
        value = point @ family_rows.columns(np.array(family_rows.domain[:1]))[0, 0]
        broken = np.max([sign * value - room for sign in family_rows.signs], axis=0)
    else:
        broken = _Residuals(cells, point, room, touching).broken()
    return np.asarray(np.maximum(broken, 0.0) / np.maximum(1.0, np.abs(room)))


@dataclass(frozen=True, eq=False)
class _Residuals:
    """The room that many laws leave on cells: their variables and 1, their right sides, their contacts."""

    cells: Cells
    point: Array
    room: Array
    touching: Touching

    def broken(self) -> Array:
        """By how much each law may break the rows."""
        found = np.zeros(len(self.point))
        law, cell, sign = self._doubtful()
        if len(law):
            np.maximum.at(found, law, self._looked_into(law, cell, sign))
        return found

    def _doubtful(self) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
        """Laws, cells and signs for which neither the first terms nor a contact shows that rows are kept."""
        signs = self.cells.columns.family.signs
        first = (self.point @ self.cells.weighed).reshape(len(self.point), _WEIGHED, -1)
        beyond, bent = self._rest()
        value, sizes = first[:, 0], np.abs(first[:, 1:])
        sign = np.where(value < 0.0, -1.0, 1.0) if len(signs) == 2 else np.full(value.shape, signs[0])
        spread = sizes[:, 0] + sizes[:, 1] + sizes[:, 2] + sizes[:, 3] + beyond
        room = (self.room - _MARGIN * np.maximum(1.0, np.abs(self.room)))[:, None]
        left = sign * value + spread >= room
        convex = -4.0 * sign * first[:, 2] - 24.0 * sizes[:, 2] - 80.0 * sizes[:, 3] > bent
        law, cell = np.nonzero(left & ~_joined(self.cells.edges, convex, self.touching))
        toward = sign[law, cell]
        if len(signs) == 2:
            other, there = np.nonzero(spread - sign * value >= room)
            law, cell = np.concatenate([law, other]), np.concatenate([cell, there])
            toward = np.concatenate([toward, -sign[other, there]])
        return law, cell, toward

    def _rest(self) -> tuple[Array, Array]:
        """What the terms that are not weighed can add on each cell in any of the laws: in their mean, and beside it."""
        value, bend = self.cells.rest
        mean = self.point.mean(axis=0)
        away = np.abs(self.point - mean).max(axis=0)
        of_mean = np.abs(self.cells.series[_WEIGHED:] @ mean)
        bends = _bends(len(self.cells.series))[_WEIGHED:]
        return of_mean.sum(axis=0) + value @ away, bends @ of_mean + bend @ away

    def _looked_into(self, law: NDArray[np.intp], cell: NDArray[np.intp], sign: Array) -> Array:
        """How far the residual may be above 0 on cells of some laws, halved until a bound shows it."""
        series = self.cells.series
        kept = min(_LOOKED_AT, len(series))
        rows, beyond = np.empty((len(law), kept)), np.zeros(len(law))
        for one in np.unique(cell).tolist():
            mine = np.flatnonzero(cell == one)
            terms = self.point[law[mine]] @ series[:, one].T
            rows[mine] = -sign[mine, None] * terms[:, :kept]
            beyond[mine] = np.abs(terms[:, kept:]).sum(axis=1)
        rows[:, 0] += self.room[law] - beyond
        return _below_zero(rows)


def _bends(count: int) -> Array:
    """The greatest second derivatives of Chebyshev polynomials."""
    square = np.arange(count) ** 2.0
    return np.asarray(square * (square - 1.0) / 3.0)


def _joined(edges: Array, convex: Flags, touching: Touching) -> Flags:
    """Cells with a contact in which the residual is convex, and their neighbours as far as it is."""
    found = np.zeros_like(convex)
    if touching.u.shape[1]:
        cell = np.clip(np.searchsorted(edges, touching.u, side="right") - 1, 0, len(edges) - 2)
        law = np.broadcast_to(np.arange(len(convex))[:, None], cell.shape)
        found[law[touching.sound], cell[touching.sound]] = True
    found &= convex
    for _ in range(_JOINED):
        grown = found.copy()
        grown[:, 1:] |= found[:, :-1]
        grown[:, :-1] |= found[:, 1:]
        found = grown & convex
    return found


def _below_zero(rows: Array) -> Array:
    """How far each series may be below 0 on [-1, 1], halved until a bound shows it."""
    found = np.zeros(len(rows))
    owner = np.arange(len(rows))
    for _ in range(_HALVINGS):
        low = _lowest(rows)
        left = np.isnan(low)
        np.maximum.at(found, owner[~left], -low[~left])
        if not left.any():
            return found
        rows, owner = np.concatenate([rows[left] @ half for half in _halving(rows.shape[1])]), np.tile(owner[left], 2)
    # convex nowhere as yet: what is known is the bound alone
    np.maximum.at(found, owner, np.abs(rows[:, 1:]).sum(axis=1) - rows[:, 0])
    return found


def _lowest(rows: Array) -> Array:
    """A lower bound of each series on [-1, 1], at most 0 but for rounding where it matters; NaN where none shows."""
    n = np.arange(rows.shape[1])
    sizes = np.abs(rows)
    spread = sizes[:, 1:].sum(axis=1)
    found = np.where(rows[:, 0] > spread, 0.0, np.nan)
    # monotone: lowest at an end
    rising = sizes[:, 1] > sizes[:, 2:] @ (n[2:] ** 2.0)
    ends = np.minimum(rows.sum(axis=1), (rows * (-1.0) ** n).sum(axis=1))
    found = np.where(np.isnan(found) & rising, np.minimum(ends, 0.0), found)
    convex = np.isnan(found) & (4.0 * rows[:, 2] > sizes[:, 3:] @ _bends(rows.shape[1])[3:])
    if convex.any():
        found[convex] = np.minimum(_by_tangent(rows[convex]), 0.0)
    return found


def _by_tangent(rows: Array) -> Array:
    """Lower bounds of convex series: the lowest end of the tangent where each is least; NaN where that was not met."""
    series = rows.T
    slope = chebyshev.chebder(series)
    bend = chebyshev.chebder(slope)
    at = np.zeros(len(rows))
    for _ in range(_STEPS):
        first = chebyshev.chebval(at, slope, tensor=False)
        second = chebyshev.chebval(at, bend, tensor=False)
        at = np.clip(at - first / np.where(second > 0.0, second, np.inf), -1.0, 1.0)
    first = chebyshev.chebval(at, slope, tensor=False)
    value = chebyshev.chebval(at, series, tensor=False)
    # from the place itself to the end toward which the tangent falls
    fall = np.abs(first) * np.where(first > 0.0, 1.0 + at, 1.0 - at)
    return np.where(fall <= _FALLS * np.abs(rows).max(axis=1), value - fall, np.nan)


@lru_cache(maxsize=16)
def _halving(count: int) -> tuple[Array, Array]:
    """Matrices from coefficients on an interval to those on its two halves."""
    angle = (np.arange(count) + 0.5) * (np.pi / count)
    back = np.cos(np.outer(angle, np.arange(count))) * (2.0 / count)
    back[:, 0] /= 2.0
    places = np.cos(angle)
    halves = ((places - 1.0) / 2.0, (places + 1.0) / 2.0)
    lower, upper = (np.asarray(chebyshev.chebvander(one, count - 1).T @ back) for one in halves)
    return lower, upper
