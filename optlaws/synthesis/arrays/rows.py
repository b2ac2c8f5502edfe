"""Rows of a program at the contacts of many laws at once, with their derivatives by the place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import Family, LinearFamily, RatioFamily
from optlaws.synthesis.program.writer import Model

Array = NDArray[np.float64]

#: of a row: what rounding may hide of it, as a share of the sum of its series' sizes
_ROUNDING = 4 * 2.0**-53


@dataclass(frozen=True, eq=False)
class Columns:
    """The columns of one affine family at many places: Chebyshev polynomials times its series, row by row."""

    family: LinearFamily

    @kept_property
    def _parts(self) -> tuple[tuple[NDArray[np.intp], Array], ...]:
        """For f and its first two derivatives: which polynomials they are made of, and with what coefficients."""
        found = []
        series = self.family.series
        for _ in range(3):
            kept = np.flatnonzero(series.any(axis=1))
            found.append((kept, np.ascontiguousarray(series[kept])))
            series = np.asarray(chebyshev.chebder(series), dtype=np.float64)
        return tuple(found)

    @kept_property
    def rounding(self) -> Array:
        """What rounding may hide of each entry of a row."""
        return np.asarray(_ROUNDING * np.abs(self.family.series).sum(axis=0))

    def at(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """Rows of f and of its derivative, shape (laws, places, variables + 1), and its second derivative there.

        The places of a law are a row of `u`, its variables and 1 a row of `point`.
        """
        if isinstance(self.family, RatioFamily):
            columns = self.family.columns(u.reshape(-1)).reshape(3, *u.shape, -1)
            return columns[0], columns[1], np.einsum("mpi,mi->mp", columns[2], point)
        polynomials = _polynomials(u.reshape(-1), len(self.family.series))
        value, slope = ((polynomials[kept].T @ series).reshape(*u.shape, -1) for kept, series in self._parts[:2])
        kept, series = self._parts[2]
        bend = np.einsum("nmp,mn->mp", polynomials[kept].reshape(len(kept), *u.shape), point @ series.T)
        return value, slope, bend


def _polynomials(u: Array, count: int) -> Array:
    """Chebyshev polynomials at many places, shape (count, places)."""
    found = np.empty((max(count, 2), len(u)))
    found[0], found[1] = 1.0, np.clip(u, -1.0, 1.0)
    twice = 2.0 * found[1]
    for n in range(2, count):
        np.multiply(twice, found[n - 1], out=found[n])
        found[n] -= found[n - 2]
    return found[:count]


@dataclass(frozen=True, eq=False)
class Structure:
    """Which constraints bind: the family and the sign of each contact, and whether it may move; the same for many laws.

    Attributes
    ----------
    model
        The program, but for its numbers.
    family, sign, free
        Of the contacts, by family.
    """

    model: Model
    family: NDArray[np.intp]
    sign: Array
    free: NDArray[np.bool_]

    @property
    def count(self) -> int:
        """The number of contacts."""
        return len(self.family)

    @property
    def signature(self) -> tuple[tuple[int, float, bool], ...]:
        """What two structures have in common that are the same."""
        return tuple(zip(self.family.tolist(), self.sign.tolist(), self.free.tolist(), strict=True))

    @property
    def affine(self) -> bool:
        """Whether the contacts' places and multipliers are the same for all right sides: rows alone determine them."""
        program = self.model.program
        return bool(2 * self.free.sum() + (~self.free).sum() + len(program.equalities) == program.size)

    @kept_property
    def slack(self) -> Array:
        """Right sides of the contacts' rows in the variables."""
        families = self.model.program.families
        return np.array([families[i].slack for i in self.family]).reshape(self.count, -1)

    @kept_property
    def rounding(self) -> Array:
        """What rounding may hide of each entry of each contact's row."""
        columns = columns_of(self.model)
        return np.array([columns[i].rounding for i in self.family]).reshape(self.count, -1)

    def jets(self, x: Array, u: Array) -> tuple[Array, Array, Array]:
        """Rows s f and their derivatives by the place, (laws, contacts, variables + 1), and second derivatives."""
        laws, width = len(u), x.shape[1] + 1
        value, slope = np.empty((2, laws, self.count, width))
        bend = np.empty((laws, self.count))
        point = np.concatenate([x, np.ones((laws, 1))], axis=1)
        columns = columns_of(self.model)
        for i in np.unique(self.family).tolist():
            mine = np.flatnonzero(self.family == i)
            own = slice(int(mine[0]), int(mine[-1]) + 1)
            f0, f1, f2 = columns[i].at(u[:, own], point)
            sign = self.sign[own]
            np.multiply(f0, sign[:, None], out=value[:, own])
            np.multiply(f1, sign[:, None], out=slope[:, own])
            np.multiply(f2, sign, out=bend[:, own])
        return value, slope, bend


def structure_of(model: Model, optimum: ActiveSet) -> tuple[Structure, NDArray[np.intp]]:
    """The structure of an optimum, and the order of its contacts in it: by family and place."""
    order = np.lexsort((optimum.s, optimum.u, optimum.family))
    found = Structure(model, optimum.family[order], optimum.s[order], optimum.free[order])
    return found, order


def columns_of(model: Model) -> Sequence[Columns]:
    """The columns of each family, kept with the model's space."""
    families = model.program.families
    key = ("columns", *(id(_series(family)) for family in families))
    if key not in _KEPT:
        if len(_KEPT) >= _MOST:
            _KEPT.clear()
        _KEPT[key] = [Columns(family) for family in families if isinstance(family, LinearFamily)]
    return _KEPT[key]


_KEPT: dict[tuple[object, ...], list[Columns]] = {}
_MOST = 64


def _series(family: Family) -> object:
    return family.series if isinstance(family, LinearFamily) else family
