"""Integrals of formulas with kinks in the law, such as max(c b, 0): sums over the stretches between these, law by law.

The kinks of a formula move with the law. The integral has none where they are plain: its slope is that of the formulas
between them, and what a kink moves by adds to its second derivatives.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from itertools import pairwise
from typing import Self

import numpy as np

from optlaws.formulas.arithmetic import NUMPY, Together
from optlaws.formulas.branches import branches_at, knots
from optlaws.formulas.slopes import Slopes
from optlaws.formulas.tree import Formula, Number
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss
from optlaws.numerics.roots import sign_changes
from optlaws.synthesis.families.curved import IntegralFamily, between
from optlaws.synthesis.families.family import RowJet, last_result

_ZERO = Number(0.0)
#: places at which kinks are looked for on a piece, times those of the rule
_LOOKS = 4
#: where between two edges a formula's branch is looked at, in the first of these that is as good as the others
_WITHIN = (0.5, 0.4, 0.75)


@dataclass(frozen=True, eq=False)
class SmoothStretch:
    """Between which k the formula is which smooth one."""

    low: float
    high: float
    formula: Formula


@dataclass(frozen=True, eq=False)
class KinkSplit:
    """The integral over the stretches of a law: its sum, and its slope as a row."""

    stretches: list[SmoothStretch]
    total: float
    slope: Array
    columns: Array  #: at the places of Gauss's rule, of the stretches one after the other, as all that follows
    names: dict[str, Array]
    weights: Array

    def by_formula(self) -> Iterator[tuple[Formula, dict[str, Array], Array, Array]]:
        """Each smooth nonzero formula with the names' values where it applies, their columns, and the weights."""
        count = len(self.weights) // len(self.stretches)
        for formula in dict.fromkeys(stretch.formula for stretch in self.stretches):
            if formula != _ZERO:
                here = np.repeat([stretch.formula == formula for stretch in self.stretches], count)
                names = {name: values[here] for name, values in self.names.items()}
                yield formula, names, self.columns[:, here], self.weights[here]


@dataclass(frozen=True, eq=False)
class AtKinks:
    """Formulas of the law, each at the place of a kink."""

    value: Array
    across: Array  #: derivatives with respect to the variables, shape (kinks, variables)
    along: Array  #: derivatives with respect to the kinks themselves


@dataclass(frozen=True, eq=False)
class FreeKinks:
    """The integral over stretches as a function of the law and of the places of its kinks, of which it is the greatest.

    It is smooth even where two kinks are next to each other, where as a function of the law alone its second
    derivatives grow without bound.
    """

    value: float
    share: float  #: of f with respect to the integral: 1, or less under a root
    slope: Array  #: of f with respect to the variables
    bend: Array  #: second derivatives of f with respect to the variables
    rise: Array  #: of f with respect to the kinks: by how much the formula before a kink is above that behind it there
    across: Array  #: derivatives of `rise` with respect to the variables, shape (kinks, variables)
    along: Array  #: derivatives of `rise` with respect to the kinks themselves


@dataclass(frozen=True, eq=False, kw_only=True)
class KinkedIntegralFamily(IntegralFamily):
    """f is the integral of a formula with kinks in the law, or its root: of each law over stretches of its own."""

    #: of 0 and places k the names' columns, shape (names, places, variables + 1); of 1 those of their slopes by k
    rows: Callable[[int, Array], Array]
    units: Array  #: what these are times
    edges: tuple[float, ...]  #: the k between which all but the kinks is smooth, ascending
    length: int  #: how many places a stretch needs

    @kept_property
    def _switches(self) -> list[Together]:
        """What changes its sign where the formula has kinks, and where it bends alone."""
        return [Together(tuple(formulas)) for formulas in knots(self.formula, self.names)]

    def in_units(self, units: Array, unit: float) -> Self:
        return replace(super().in_units(units, unit), units=self.units * np.append(units, 1.0))

    @property
    def quadratic(self) -> bool:
        """False: between kinks alone may it be."""
        return False

    @property
    def continuable(self) -> bool:
        """False: kinks move with each law."""
        return False

    def columns_at(self, k: Array, turn: int = 0) -> Array:
        """The names' columns at places, or the columns of their slopes in k."""
        return self.rows(turn, k) * self.units

    def _names(self, point: Array, k: Array, columns: Array) -> dict[str, Array]:
        return {**dict(zip(self.names, columns @ point, strict=True)), "k": k}

    @last_result
    def split(self, x: Array) -> KinkSplit:
        """The stretches of a law, and the integral over them."""
        return self._over(self._stretches(np.append(x, 1.0)), x)

    def _over(self, stretches: list[SmoothStretch], law: Array) -> KinkSplit:
        """The integral over some stretches, and its slope with the kinks fixed."""
        point = np.append(law, 1.0)
        x, share = gauss(self.length)
        low, width = (
            np.array(values)[:, None] for values in zip(*((s.low, s.high - s.low) for s in stretches), strict=True)
        )
        k, weights = (low + width * (x + 1.0) / 2.0).ravel(), (share * width / 2.0).ravel()
        columns = self.columns_at(k)
        split = KinkSplit(stretches, 0.0, np.zeros(len(point)), columns, self._names(point, k, columns), weights)
        total, slope = 0.0, split.slope
        for formula, names, rows, shares in split.by_formula():
            values, gradient = _slopes(formula, self.names).value_and_gradient(names)
            total += float(shares @ values)
            slope += np.tensordot(gradient * shares, rows, 2)
        return replace(split, total=total)

    def _stretches(self, point: Array) -> list[SmoothStretch]:
        edges = list(self.edges)
        for switches in self._switches:
            if switches.formulas:
                changes = sign_changes(partial(self._values, switches, point), edges, _LOOKS * self.length)
                edges = sorted({*edges, *changes.tolist()})
        stretches: list[SmoothStretch] = []
        places = self._plain_places(point, np.array(edges))
        names = self._names(point, places, self.columns_at(places))
        for (low, high), branch in zip(pairwise(edges), branches_at(self.formula, names, len(places)), strict=True):
            same = low not in self.edges and stretches and stretches[-1].formula == branch
            if same:
                stretches[-1] = replace(stretches[-1], high=high)
            else:
                stretches.append(SmoothStretch(low, high, branch))
        return stretches

    def _plain_places(self, point: Array, edges: Array) -> Array:
        """A place between any two edges where no switch is near 0, as some are in the middle of symmetric laws."""
        places = edges[:-1] + np.diff(edges) * np.array(_WITHIN)[:, None]
        together = [self._values(some, point, places.ravel()) for some in self._switches if some.formulas]
        values = np.abs(np.vstack([np.zeros((0, places.size)), *together])).reshape(-1, *places.shape)
        greatest = values.max(axis=(1, 2), initial=0.0)[:, None, None]
        clear = (values / np.where(greatest == 0.0, 1.0, greatest)).min(axis=0, initial=1.0)
        return np.asarray(places[np.argmax(clear, axis=0), np.arange(len(edges) - 1)])

    def _values(self, formulas: Together, point: Array, k: Array) -> Array:
        names = self._names(point, k, self.columns_at(k))
        with np.errstate(all="ignore"):
            return np.array([np.broadcast_to(value, k.shape) for value in formulas.values(names, NUMPY)])

    def touching(self, x: Array, u: float) -> tuple[float, ...]:  # noqa: ARG002 - it has no place
        """The variables of the law."""
        return tuple(x.tolist())

    def tangent_row(self, u: float, sign: float, point: tuple[float, ...]) -> Array | None:  # noqa: ARG002 - as others
        if not self.convex or len(point) != len(self.slack):
            return None
        split = self.split(np.array(point))
        height, share = self.touched(np.array(split.total))
        row: Array = share * split.slope
        row[-1] += height - row @ np.append(point, 1.0)
        return row

    def jet(self, x: Array, u: Array, s: Array) -> RowJet:
        split = self.split(x)
        value, share = self.outer(np.array(split.total))
        nothing = np.zeros(len(u))
        gradient = s[:, None] * (share * split.slope[:-1]) - self.slack
        return RowJet(s * value - self.right_side(x), nothing, nothing, gradient, np.zeros((len(u), len(x))))

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:  # noqa: ARG002 - it has no place
        of_law = self.free_kinks(x, self.split(x).stretches)
        moving = of_law.along != 0.0
        across = of_law.across[moving]
        moved = of_law.share * (across.T / -of_law.along[moving]) @ across
        return np.asarray((of_law.bend + moved) * float(weights.sum()))

    def free_kinks(self, x: Array, stretches: list[SmoothStretch]) -> FreeKinks:
        """The integral over stretches whose kinks are where they are put, with its derivatives."""
        split = self._over(stretches, x)
        value, share = self.outer(np.array(split.total))
        bend = np.zeros((len(x),) * 2)
        for formula, names, columns, shares in split.by_formula():
            of_names = _slopes(formula, self.names).derivatives(names)[2] * shares
            bend += between(of_names[:, :, None], columns[:, None, :, :-1])[0]
        bend *= share
        if self.root:
            bend -= np.outer(split.slope[:-1], split.slope[:-1]) / (4.0 * value**3)
        pairs = [pair for pair in pairwise(stretches) if self.movable_kink(pair[1].low)]
        beside = [(left.formula, right.formula) for left, right in pairs]
        sides = [{before: 1.0, behind: -1.0} if before != behind else {} for before, behind in beside]
        rise = self._at_kinks(x, self.kinks_of(stretches), sides)
        slope = share * split.slope[:-1]
        return FreeKinks(float(value), float(share), slope, bend, rise.value, rise.across, rise.along)

    def switches_of(self, x: Array, stretches: list[SmoothStretch]) -> list[Formula]:
        """Of each kink the smooth formula that changes its sign there.

        What the formulas beside a kink differ by does not say where it is: at the knots of a spline that is nothing,
        and where a square begins it is 0 with its slope.
        """
        k = self.kinks_of(stretches)
        if not len(k):
            return []
        names = self._names(np.append(x, 1.0), k, self.columns_at(k))
        several = [branches_at(switch, names, len(k)) for switches in self._switches for switch in switches.formulas]
        away = [_distances(self.at_kinks(x, stretches, switches)) for switches in several]
        return [several[i][kink] for kink, i in enumerate(np.argmin(away, axis=0).tolist())]

    def at_kinks(self, x: Array, stretches: list[SmoothStretch], switches: list[Formula]) -> AtKinks:
        """The switches of the kinks, each at its kink."""
        return self._at_kinks(x, self.kinks_of(stretches), [{switch: 1.0} for switch in switches])

    def _at_kinks(self, x: Array, k: Array, sums: list[dict[Formula, float]]) -> AtKinks:
        """Weighted sums of formulas, one at each place."""
        point, columns, turns = np.append(x, 1.0), self.columns_at(k), self.columns_at(k, 1)
        names, count = self._names(point, k, columns), len(k)
        value, along, across = np.zeros(count), np.zeros(count), np.zeros((count, len(x)))
        for formula in dict.fromkeys(formula for terms in sums for formula in terms):
            times = np.array([terms.get(formula, 0.0) for terms in sums])
            values, slopes = _slopes(formula, (*self.names, "k")).value_and_gradient(names)
            gradient = times * slopes
            value += times * values
            across += np.einsum("ip,ipn->pn", gradient[:-1], columns[:, :, :-1])
            along += np.einsum("ip,ip->p", gradient[:-1], turns @ point) + gradient[-1]
        return AtKinks(value, across, along)

    def movable_kink(self, k: float) -> bool:
        """Whether the end of a stretch is where a law has a kink, not an edge at which a formula ends."""
        return k not in self.edges

    def kinks_of(self, stretches: list[SmoothStretch]) -> Array:
        """The places of the kinks between stretches."""
        return np.array([right.low for right in stretches[1:] if self.movable_kink(right.low)])

    def with_kinks(self, stretches: list[SmoothStretch], kinks: Array) -> list[SmoothStretch]:
        """The stretches with their kinks elsewhere."""
        left = iter(kinks.tolist())
        lows = [stretches[0].low]
        lows += [next(left) if self.movable_kink(right.low) else right.low for right in stretches[1:]]
        ends = [*lows, stretches[-1].high]
        return [
            replace(stretch, low=low, high=high) for stretch, (low, high) in zip(stretches, pairwise(ends), strict=True)
        ]

    def value(self, x: Array, u: Array) -> Array:
        """Values of f at the places."""
        return np.full(len(u), self.outer(np.array(self.split(x).total))[0])


def _distances(switches: AtKinks) -> Array:
    """How far roots of the switches are from the kinks, to first order."""
    nowhere = np.full(len(switches.value), np.inf)
    return np.asarray(np.abs(np.divide(switches.value, switches.along, nowhere, where=switches.along != 0.0)))


@lru_cache(maxsize=256)
def _slopes(formula: Formula, names: tuple[str, ...]) -> Slopes:
    return Slopes(formula, names)
