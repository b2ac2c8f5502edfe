"""Integrals of formulas with kinks in the law, such as max(c b, 0): sums over the stretches between these, law by law.

The kinks of a formula move with the law. The integral has none where they are plain: its slope is that of the formulas
between them, and what a kink moves by adds to its second derivatives.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from itertools import pairwise
from typing import Self

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.branches import branch_at, switches
from optlaws.formulas.tree import Formula
from optlaws.kept import kept_property
from optlaws.series.candidates import cut_at_roots
from optlaws.series.chebyshev import gauss
from optlaws.synthesis.families.curved import IntegralFamily, Slopes, bent
from optlaws.synthesis.families.family import Jet

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stretch:
    """Between which k the formula is which smooth one."""

    low: float
    high: float
    formula: Formula


@dataclass(frozen=True, eq=False)
class Split:
    """What the stretches of a law make of the integral: its sum, and its slope as a row."""

    stretches: list[Stretch]
    total: float
    slope: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class KinkedIntegralFamily(IntegralFamily):
    """f is the integral of a formula with kinks in the law, or its root; `places` and `weights` are for guesses alone.

    Attributes
    ----------
    rows
        Of places k: the names' columns and those of their derivatives by k, shape (2, names, places, variables + 1).
    units
        What these are times.
    edges
        The k between which all but the kinks is smooth, ascending.
    length
        How many places a stretch needs.
    """

    rows: Callable[[Array], Array]
    units: Array
    edges: tuple[float, ...]
    length: int
    _known: dict[bytes, Split] = field(default_factory=dict, repr=False)

    @kept_property
    def _switches(self) -> list[Formula]:
        return switches(self.formula, self.names)

    def in_units(self, units: Array, unit: float) -> Self:
        """The same of variables in other units; its own unit stays."""
        return replace(super().in_units(units, unit), units=self.units * np.append(units, 1.0), _known={})

    def _names_at(self, point: Array, k: Array) -> tuple[dict[str, Array], Array]:
        """What the names are at places in a law, and their columns with those of their derivatives."""
        columns = self.rows(k) * self.units
        return {**dict(zip(self.names, columns[0] @ point, strict=True)), "k": k}, columns

    def split(self, x: Array) -> Split:
        """The stretches of a law, and the integral over them."""
        key = x.tobytes()
        if key not in self._known:
            self._known.clear()
            self._known[key] = self._split(np.append(x, 1.0))
        return self._known[key]

    def _split(self, point: Array) -> Split:
        stretches, total, slope = self._stretches(point), 0.0, np.zeros(len(point))
        for stretch in stretches:
            names, columns, weights = self._rule(point, stretch)
            slopes = _slopes(stretch.formula, self.names)
            total += float(weights @ slopes.value(names))
            slope += np.einsum("ip,ipn->n", slopes.gradient(names) * weights, columns[0])
        return Split(stretches, total, slope)

    def _stretches(self, point: Array) -> list[Stretch]:
        edges = list(self.edges)
        for switch in self._switches:
            value = partial(self._value, switch, point)
            edges = cut_at_roots(_same(value), edges)
        stretches: list[Stretch] = []
        for low, high in pairwise(edges):
            names, _ = self._names_at(point, np.array([(low + high) / 2.0]))
            formula = branch_at(self.formula, {name: float(value[0]) for name, value in names.items()})
            if stretches and stretches[-1].formula == formula and low not in self.edges:
                stretches[-1] = replace(stretches[-1], high=high)
            else:
                stretches.append(Stretch(low, high, formula))
        return stretches

    def _value(self, formula: Formula, point: Array, k: Array) -> Array:
        names, _ = self._names_at(point, k)
        return np.broadcast_to(np.asarray(evaluate(formula, names, NUMPY), dtype=np.float64), k.shape)

    def _rule(self, point: Array, stretch: Stretch) -> tuple[dict[str, Array], Array, Array]:
        x, share = gauss(self.length)
        half = (stretch.high - stretch.low) / 2.0
        names, columns = self._names_at(point, stretch.low + half * (x + 1.0))
        return names, columns, share * half

    def touching(self, x: Array, u: float) -> tuple[float, ...]:  # noqa: ARG002 - it has no place
        """The variables of the law."""
        return tuple(x.tolist())

    def tangent_row(self, u: float, sign: float, point: tuple[float, ...]) -> Array | None:  # noqa: ARG002
        """The affine function that touches f at the variables that are given, the constant last."""
        if not self.convex or len(point) != len(self.slack):
            return None
        own = self.split(np.array(point))
        value, share = self.outer(np.array(own.total))
        row: Array = share * own.slope
        row[-1] += value - row @ np.append(point, 1.0)
        return row

    def jet(self, x: Array, u: Array, s: Array) -> Jet:
        """The residual with its gradient."""
        own = self.split(x)
        value, share = self.outer(np.array(own.total))
        nothing = np.zeros(len(u))
        gradient = s[:, None] * (share * own.slope[:-1]) - self.slack
        return Jet(s * value - self.room(x), nothing, nothing, gradient, np.zeros((len(u), len(x))))

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:  # noqa: ARG002 - it has no place
        """Of f, times the sum of weights."""
        own, point = self.split(x), np.append(x, 1.0)
        matrix = np.zeros((len(x), len(x)))
        for stretch in own.stretches:
            names, columns, share = self._rule(point, stretch)
            matrix += bent(_slopes(stretch.formula, self.names).hessian(names) * share, columns[0][..., :-1])
        for left, right in pairwise(own.stretches):
            matrix += self._moved(point, left, right)
        if self.root:
            size, slope = self.outer(np.array(own.total))
            matrix = slope * matrix - np.outer(own.slope[:-1], own.slope[:-1]) / (4.0 * size**3)
        return np.asarray(matrix * float(weights.sum()))

    def _moved(self, point: Array, left: Stretch, right: Stretch) -> Array:
        """What it adds that the kink between two stretches moves: it is where their formulas have one value."""
        k = np.array([right.low])
        names, columns = self._names_at(point, k)
        both = [_slopes(side.formula, (*self.names, "k")).gradient(names)[:, 0] for side in (left, right)]
        apart = both[0] - both[1]
        across = apart[:-1] @ columns[0][:, 0, :-1]
        falls = float(apart[:-1] @ (columns[1][:, 0] @ point) + apart[-1])
        return np.zeros((len(across), len(across))) if falls == 0.0 else np.outer(across, across) / -falls

    def value(self, x: Array, u: Array) -> Array:
        """f."""
        return np.full(len(u), self.outer(np.array(self.split(x).total))[0])


def _same(value: Callable[[Array], Array]) -> Callable[[float, float], Callable[[Array], Array]]:
    return lambda low, high: value  # noqa: ARG005 - it is smooth beyond them too


@lru_cache(maxsize=256)
def _slopes(formula: Formula, names: tuple[str, ...]) -> Slopes:
    return Slopes(formula, names)
