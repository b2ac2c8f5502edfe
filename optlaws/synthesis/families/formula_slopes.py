"""Formulas with their slopes and second derivatives as arrays; long factors of the position are read from tables.

The inertia of a linkage is a formula of some hundred steps, its second derivative one of a thousand, and a search needs
them at some hundred positions at every step. Their values are known from polynomials on cells of the position.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from optlaws.formulas.arithmetic import NUMPY, Together, evaluate
from optlaws.formulas.slopes import added, derivative, multiplied
from optlaws.formulas.tree import Formula, Name, Product, Sum, Table, rebuilt, substituted
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import basis_values, from_values, nodes
from optlaws.tolerances import SERIES_ROUNDING

_BESIDE_TABLE = 1e-9  # of a stroke: positions so near a table's end are as good as in it, and places one

_POSITION = "a"
#: of how many steps a factor is long
_LONG = 8
#: the terms of a polynomial, into how many cells the positions are cut at first and at most
_TERMS, _FEWEST, _MOST = 14, 8, 256
#: how far beyond the stroke positions may be
_MARGINS = (0.125, 0.0)
_ORDERS = 3


@dataclass(frozen=True, eq=False)
class FactorTables:
    """Formulas of the position as polynomials on cells, with their first and second derivatives.

    Attributes
    ----------
    factors
        The formulas, by the names that stand for them.
    edges
        The ends of the cells, ascending.
    series
        By the order of the derivative Chebyshev coefficients, shape (cells, terms, factors).
    """

    factors: Mapping[str, Formula]
    edges: Array
    series: tuple[Array, ...]

    @kept_property
    def _reach(self) -> tuple[float, float]:
        """The centre of all cells, and the greatest distance of positions from it."""
        low, high = float(self.edges[0]), float(self.edges[-1])
        return (low + high) / 2.0, (high - low) / 2.0 + _BESIDE_TABLE

    def within(self, a: Array) -> bool:
        """Whether all positions are in cells."""
        middle, reach = self._reach
        return bool((np.abs(a - middle) <= reach).all())

    def values(self, a: Array, orders: int) -> Array:
        """The factors and their derivatives up to an order, shape (orders, factors, *places)."""
        flat = a.ravel()
        cell = np.clip(np.searchsorted(self.edges, flat, side="right") - 1, 0, len(self.edges) - 2)
        low, high = self.edges[cell], self.edges[cell + 1]
        basis = basis_values(np.clip((2.0 * flat - low - high) / (high - low), -1.0, 1.0), _TERMS)
        values = np.array([np.einsum("pt,ptf->fp", basis, series[cell]) for series in self.series[:orders]])
        return values.reshape(orders, len(self.factors), *a.shape)

    def by_name(self, a: Array) -> dict[str, Array]:
        """The factors at positions by their names; beyond the cells by their formulas."""
        if self.within(a):
            return dict(zip(self.factors, self.values(a, 1)[0], strict=True))
        with np.errstate(all="ignore"):
            return {
                name: np.broadcast_to(evaluate(factor, {_POSITION: a}, NUMPY), a.shape)
                for name, factor in self.factors.items()
            }


@lru_cache(maxsize=256)
def tabulated(formulas: tuple[Formula, ...]) -> tuple[tuple[Formula, ...], FactorTables | None]:
    """The formulas with names for their long factors of the position, and the factors' tables; None without factors.

    >>> from optlaws.formulas.reading import read
    >>> [outer], tables = tabulated((read("(1 + sin(a)^2/(2 + cos(3*a)))*c + b"),))
    >>> outer, round(float(tables.values(np.array([0.0]), 1)[0, 0, 0]), 12)
    (a0*c + b, 1.0)
    """
    shorthand: dict[Formula, str] = {}
    outer = tuple(_outer(formula, shorthand) for formula in formulas)
    tables = _tables(tuple(shorthand)) if shorthand else None
    return (formulas, None) if tables is None else (outer, tables)


def _outer(formula: Formula, shorthand: dict[Formula, str]) -> Formula:
    """The formula with names for its long factors, which it notes."""
    if _POSITION not in formula.names():
        return formula
    if _of_position(formula):
        return _named(formula, shorthand)
    if isinstance(formula, Sum | Product):
        together = added if isinstance(formula, Sum) else multiplied
        inner = [part for part in formula.parts if _of_position(part)]
        others = [_outer(part, shorthand) for part in formula.parts if not _of_position(part)]
        return together([_named(together(inner), shorthand), *others]) if inner else together(others)
    return rebuilt(formula, [_outer(part, shorthand) for part in formula.parts])


def _of_position(formula: Formula) -> bool:
    return formula.names() - {"pi"} == {_POSITION} and all(not step.formula.kinked for step in formula.steps)


def _named(formula: Formula, shorthand: dict[Formula, str]) -> Formula:
    long = len(formula.steps) >= _LONG or any(isinstance(step.formula, Table) for step in formula.steps)
    return Name(shorthand.setdefault(formula, f"{_POSITION}{len(shorthand)}")) if long else formula


def _tables(factors: tuple[Formula, ...]) -> FactorTables | None:
    """Tables of factors, beyond the stroke where they have values there; None where no cells resolve them."""
    for margin in _MARGINS:
        tables = _resolved(factors, -margin, 1.0 + margin)
        if tables is not None:
            return tables
    return None


def _resolved(factors: tuple[Formula, ...], low: float, high: float) -> FactorTables | None:
    formulas, joint = list(factors), list(factors)
    for _ in range(_ORDERS - 1):
        formulas = [derivative(formula, _POSITION) for formula in formulas]
        joint += formulas
    together, count = Together(tuple(joint)), _FEWEST
    knots = {place for factor in factors for place in _knots(factor) if low < place < high}
    while count <= _MOST:
        edges = np.array(sorted({*np.linspace(low, high, count + 1).tolist(), *knots}))
        edges = edges[np.append(True, np.diff(edges) > _BESIDE_TABLE)]
        places = edges[:-1] + np.diff(edges) * (nodes(_TERMS)[:, None] + 1.0) / 2.0
        values = np.empty((len(joint), *places.shape))
        with np.errstate(all="ignore"):
            for i, value in enumerate(together.values({_POSITION: places}, NUMPY)):
                values[i] = value
        if not np.isfinite(values).all():
            return None
        # terms, cells, formulas
        series = from_values(np.ascontiguousarray(values.transpose(1, 2, 0)).reshape(_TERMS, -1))
        series = series.reshape(_TERMS, len(edges) - 1, len(joint))
        size = np.abs(values).max(axis=(1, 2))
        if (np.abs(series[-2:]).max(axis=(0, 1)) <= SERIES_ROUNDING * size).all():
            orders = np.split(series.transpose(1, 0, 2), _ORDERS, axis=2)
            names = {f"{_POSITION}{i}": factor for i, factor in enumerate(factors)}
            return FactorTables(names, edges, tuple(map(np.ascontiguousarray, orders)))
        count *= 2
    return None


def _knots(factor: Formula) -> list[float]:
    """The positions at which splines of the position itself have knots."""
    tables = [step.formula for step in factor.steps if isinstance(step.formula, Table)]
    return [place for table in tables for place in table.places if table.of == Name(_POSITION)]


@dataclass(frozen=True, eq=False)
class Slopes:
    """A formula with its first and second derivatives by some of its names.

    Attributes
    ----------
    formula, names
        The formula, and by what its slopes are.
    tables
        Of the factors of the position, if the formula has names for them already.
    """

    formula: Formula
    names: tuple[str, ...]
    tables: FactorTables | None = None

    @kept_property
    def _plain(self) -> _Symbolic:
        factors = {} if self.tables is None else self.tables.factors
        return _Symbolic(substituted(self.formula, factors), self.names)

    @kept_property
    def _outer(self) -> tuple[_Symbolic, FactorTables] | None:
        """The formula over its names and the names of factors, with the factors' tables."""
        tables = self.tables
        formulas, tables = tabulated((self.formula,)) if tables is None else ((self.formula,), tables)
        return None if tables is None else (_Symbolic(formulas[0], (*self.names, *tables.factors)), tables)

    def second(self, i: int, j: int) -> Formula:
        """The formula of the second derivative by two of the names."""
        later, sooner = max(i, j), min(i, j)
        return self._plain.second.formulas[later * (later + 1) // 2 + sooner]

    def _factors(self, at: Mapping[str, Array], orders: int) -> tuple[_Symbolic, dict[str, Array], Array] | None:
        """The formula over names of factors, what all names are, the factors with derivatives; None beyond tables."""
        if self._outer is None:
            return None
        outer, tables = self._outer
        a = np.broadcast_to(at[_POSITION], np.shape(at["k"]))
        if not tables.within(a):
            return None
        values = tables.values(a, orders)
        return outer, {**at, **dict(zip(tables.factors, values[0], strict=True))}, values

    def value(self, at: Mapping[str, Array]) -> Array:
        """Values of the formula at the places."""
        known = self._factors(at, 1)
        return self._plain.value(at) if known is None else known[0].value(known[1])

    def value_and_gradient(self, at: Mapping[str, Array]) -> tuple[Array, Array]:
        """Values of the formula, and its derivatives, shape (names, places)."""
        known = self._factors(at, 2)
        if known is None:
            return self._plain.value_and_gradient(at)
        outer, names, factors = known
        value, gradient = outer.value_and_gradient(names)
        return value, self._turned(gradient, factors)

    def gradient(self, at: Mapping[str, Array]) -> Array:
        """Its derivatives, shape (names, places)."""
        known = self._factors(at, 2)
        if known is None:
            return self._plain.gradient(at)
        outer, names, factors = known
        return self._turned(outer.gradient(names), factors)

    def hessian(self, at: Mapping[str, Array]) -> Array:
        """Second derivatives of the formula, shape (names, names, places)."""
        known = self._factors(at, _ORDERS)
        if known is None:
            return self._plain.hessian(at)
        outer, names, (_, slopes, bends) = known
        count = len(self.names)
        gradient, hessian = outer.gradient(names)[count:], outer.hessian(names)
        across = np.einsum("ni...,i...->n...", hessian[:count, count:], slopes)
        twice = np.einsum("ij...,i...,j...->...", hessian[count:, count:], slopes, slopes)
        inner = hessian[:count, :count].copy()
        if _POSITION in self.names:
            place = self.names.index(_POSITION)
            inner[place] += across
            inner[:, place] += across
            inner[place, place] += twice + (gradient * bends).sum(axis=0)
        return np.asarray(inner)

    def _turned(self, gradient: Array, factors: Array) -> Array:
        """The gradient by the names, from that by the names and the factors."""
        count = len(self.names)
        inner = gradient[:count].copy()
        if _POSITION in self.names:
            inner[self.names.index(_POSITION)] += (gradient[count:] * factors[1]).sum(axis=0)
        return inner


@dataclass(frozen=True, eq=False)
class _Symbolic:
    """A formula and formulas of its derivatives."""

    formula: Formula
    names: tuple[str, ...]

    @kept_property
    def _value(self) -> Together:
        return Together((self.formula,))

    @kept_property
    def _first(self) -> Together:
        return Together(tuple(derivative(self.formula, name) for name in self.names))

    @kept_property
    def _both(self) -> Together:
        return Together((self.formula, *self._first.formulas))

    @kept_property
    def second(self) -> Together:
        """Second derivatives by two names, by the second name up to the first: the others are the same."""
        slopes = enumerate(self._first.formulas, 1)
        return Together(tuple(derivative(slope, name) for i, slope in slopes for name in self.names[:i]))

    def value(self, at: Mapping[str, Array]) -> Array:
        return np.asarray(_values(self._value, at)[0])

    def value_and_gradient(self, at: Mapping[str, Array]) -> tuple[Array, Array]:
        values = _values(self._both, at)
        return values[0], _slopes(values[1:])

    def gradient(self, at: Mapping[str, Array]) -> Array:
        return _slopes(_values(self._first, at))

    def hessian(self, at: Mapping[str, Array]) -> Array:
        values = _slopes(_values(self.second, at))
        rows, columns = np.tril_indices(len(self.names))
        bends = np.empty((len(self.names), len(self.names), *values.shape[1:]))
        bends[rows, columns], bends[columns, rows] = values, values
        return bends


def _values(formulas: Together, at: Mapping[str, Array]) -> Array:
    values = np.empty((len(formulas.formulas), *np.shape(at["k"])))
    with np.errstate(all="ignore"):
        for i, value in enumerate(formulas.values(at, NUMPY)):
            values[i] = value
    return values


def _slopes(values: Array) -> Array:
    """The values of slopes; 0 at the tip of a norm, where 0 is the slope of a valid tangent."""
    return np.where(np.isnan(values), 0.0, values)
