"""Whether many laws keep a family of rows at every place: on each cell of its domain by a bound, nowhere by points.

On a cell a row's residual is a Chebyshev series in the cell's own coordinate. A law keeps the row on the cell if the
series' first terms outweigh all others, or if the residual is convex there and a tangent shows that it stays up: at a
contact, whose cell it shares or is joined to by cells in which it is convex, or at the lowest place of the cell itself.
Cells in which neither shows are halved.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.synthesis.arrays.programs import Numbers
from optlaws.synthesis.arrays.rows import Columns

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: cells for each degree of a family's series over the whole interval
_DENSITY = 1.6
_LEAST_CELLS = 8
#: terms of a cell's series that are weighed one by one
_WEIGHED = 5
#: of a right side, or 1: a residual nearer to 0 is left to tangents
_MARGIN = 1e-12
_JOINED = 4
_HALVINGS = 12
_STEPS = 6
_UNPROVEN = np.inf


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
    own = cells.columns.family
    room = x @ own.slack + numbers.bounds[:, family]
    unit = np.maximum(1.0, np.abs(room))
    point = np.concatenate([x, np.ones((len(x), 1))], axis=1)
    found = np.zeros(len(x))
    if own.domain[0] == own.domain[1]:
        row = own.columns(np.array(own.domain[:1]))[0, 0]
        for sign in own.signs:
            found = np.maximum(found, (sign * (point @ row) - room) / unit)
        return found
    first = (point @ cells.weighed).reshape(len(x), _WEIGHED, -1)
    beyond, bent = _rest(cells, point)
    value = first[:, 0]
    spread = np.abs(first[:, 1:]).sum(axis=1) + beyond
    margin = (_MARGIN * unit)[:, None]
    if len(own.signs) == 2:
        clear = room[:, None] - np.abs(value) - spread > margin
        sign = np.where(value < 0.0, -1.0, 1.0)
        # the other sign is kept where this one is, unless the right side is below 0
        other = room[:, None] + np.abs(value) - spread > margin
    else:
        sign = np.broadcast_to(np.float64(own.signs[0]), value.shape)
        clear = room[:, None] - sign * value - spread > margin
        other = clear
    convex = -4.0 * sign * first[:, 2] - 24.0 * np.abs(first[:, 3]) - 80.0 * np.abs(first[:, 4]) - bent > 0.0
    kept = clear | (_joined(cells.edges, convex, touching) & (other | (len(own.signs) == 1)))
    law, cell = np.nonzero(~kept)
    if len(law):
        for one in own.signs:
            worst = _looked_into(cells.series, law, cell, point, room, one) / unit[law]
            np.maximum.at(found, law, worst)
    return found


def _rest(cells: Cells, point: Array) -> tuple[Array, Array]:
    """What the terms that are not weighed can add on each cell in any of the laws: in their mean, and beside it."""
    mean = point.mean(axis=0)
    away = np.abs(point - mean).max(axis=0)
    of_mean = np.abs(cells.series[_WEIGHED:] @ mean)
    value, bend = cells.rest
    bends = _bends(len(cells.series))[_WEIGHED:]
    return of_mean.sum(axis=0) + value @ away, bends @ of_mean + bend @ away


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


def _looked_into(
    series: Array, law: NDArray[np.intp], cell: NDArray[np.intp], point: Array, room: Array, sign: float
) -> Array:
    """How far the residual may be above 0 on cells of some laws, halved until a bound shows it."""
    rows = np.empty((len(law), len(series)))
    for one in np.unique(cell).tolist():
        mine = cell == one
        rows[mine] = -sign * (point[law[mine]] @ series[:, one].T)
    rows[:, 0] += room[law]
    found = np.zeros(len(law))
    owner = np.arange(len(law))
    for _ in range(_HALVINGS):
        low = _lowest(rows)
        np.maximum.at(found, owner, np.where(np.isnan(low), 0.0, -low))
        left = np.isnan(low)
        if not left.any():
            return found
        halves = [rows[left] @ one for one in _halving(rows.shape[1])]
        rows, owner = np.concatenate(halves), np.concatenate([owner[left]] * 2)
    # still convex nowhere: what is known is the bound alone
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
    """Lower bounds of convex series: the lowest end of the tangent near to where each is least."""
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
    reach = np.where(first > 0.0, 1.0 + at, 1.0 - at)
    return np.asarray(value - np.abs(first) * reach)


def _halving(count: int) -> tuple[Array, Array]:
    """Matrices from coefficients on an interval to those on its two halves."""
    angle = (np.arange(count) + 0.5) * (np.pi / count)
    back = np.cos(np.outer(angle, np.arange(count))) * (2.0 / count)
    back[:, 0] /= 2.0
    places = np.cos(angle)
    halves = ((places - 1.0) / 2.0, (places + 1.0) / 2.0)
    lower, upper = (np.asarray(chebyshev.chebvander(one, count - 1).T @ back) for one in halves)
    return lower, upper
