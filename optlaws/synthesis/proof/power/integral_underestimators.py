"""Rows that every law in a box obeys where the integral of a formula, or its root, is bounded.

From any law of a box the integral is nowhere below its tangent plane and half the form of its second derivatives
somewhere on the way to the other law. That form is no less than one whose factors are the least that the formula's own
second derivatives can be, cell by cell. Where this has no negative eigenvalue the integral is convex in the box and the
plane stands as it is; else the negative ones cost what they can in the box.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import combinations_with_replacement, permutations
from typing import TYPE_CHECKING

import numpy as np

from optlaws.formulas.convexity import Endpoints, enclosed
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.slopes import derivative
from optlaws.formulas.tree import ORDERS, Formula
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss
from optlaws.synthesis.families.curved import IntegralFamily
from optlaws.synthesis.families.piece_series import widened
from optlaws.synthesis.functionals.curved_rows import columns_of, rule_cells
from optlaws.tolerances import BENEATH_ROUNDING, TINY

if TYPE_CHECKING:
    from optlaws.synthesis.proof.power.box import Box, BoxRows

_RULE_ROUNDING = 2.0**-36  # of what sums amount to: more than a rule is off by for what is no polynomial
_INTEGRAL_BLUR = 1e-12  # of sums and ends of integrals: more than they are rounded by


_CELLS = 32


@dataclass(frozen=True, eq=False)
class CurvatureBound:
    """Bounds of the second derivatives of an integral in a box."""

    #: low, high: least and greatest values of the derivatives on the cells
    low: Array
    high: Array
    #: middle and half width of the box's velocities
    middle: Array
    half: Array
    free: Array  #: directions, in units of the box, in which laws differ that keep the equations
    third: Mapping[tuple[int, int, int], Array]  #: greatest magnitudes of the formula's third derivatives on the cells
    anywhere: Array  #: a form over the velocities that second derivatives of the integral are nowhere below

    def costs(self, form: Array) -> tuple[Array, Array]:
        """Negative eigenvalues of a form, their signs turned, and magnitudes of their vectors, in units of the box."""
        scaled = self.half[:, None] * form * self.half
        sizes, turned = np.linalg.eigh(self.free.T @ scaled @ self.free)
        blur = _INTEGRAL_BLUR * float(np.abs(scaled).sum())
        return np.maximum(blur - sizes, 0.0), np.abs(self.free @ turned).T

    def taken(self, at: Array, form: Array) -> float:
        """The greatest amount by which a quadratic form is below the tangent plane; infinite if not known."""
        if not np.isfinite(form).all():
            return np.inf
        off = np.where(self.half > 0.0, 1.0 + np.abs(at - self.middle) / np.maximum(self.half, TINY), 0.0)
        costs, ways = self.costs(form)
        return float(0.5 * costs @ (ways @ off) ** 2)


class ConvexUnderestimator:
    """Planes that are lower bounds of the integral of a formula, or of its root, in a box."""

    def __init__(self, rows: BoxRows, family: IntegralFamily, motion: MotionFormula) -> None:
        self.rows, self.family, self.motion = rows, family, motion
        self.columns = np.stack([rows.mapped(column) for column in family.columns])
        self._blur = _RULE_ROUNDING if motion.degree(dict.fromkeys(ORDERS, 1)) is None else BENEATH_ROUNDING
        edges = rule_cells(rows.space, motion, _CELLS)
        self._last: tuple[Box, CurvatureBound | None] | None = None
        self.middle, self.reach = (edges[:-1] + edges[1:]) / 2.0, np.diff(edges) / 2.0

    @kept_property
    def _series(self) -> list[Array]:
        """Powers of each name's local coordinate over the cells, shape (powers, cells, variables + 1)."""
        return [self._taylor(ORDERS[name]) for name in self.family.names]

    def _taylor(self, nu: int) -> Array:
        space, planes, factor = self.rows.space, [], np.ones_like(self.reach)
        for i in range(space.degree_of(nu) + 1):
            columns = widened(columns_of(space, nu + i, self.middle), self.rows.variables)
            mapped = self.rows.mapped(columns)
            if i:
                # what is given has no derivative
                factor = factor * self.reach / i
            planes.append(factor[:, None] * mapped)
        return np.array(planes)

    @kept_property
    def _nodes(self) -> tuple[Array, list[Array]]:
        """Weights of places in every cell, shape (cells, places), and there the rows of each name."""
        count = 1 + max(len(row) for row in self._series)
        x, share = gauss(count)
        powers = x[:, None] ** np.arange(count)
        several = [np.einsum("xp,pcn->cxn", powers[:, : len(row)], row) for row in self._series]
        return self.reach[:, None] * share, several

    def ranges(self, box: Box, limits: Mapping[str, float]) -> tuple[Array, Array]:
        """Least and greatest values of the derivatives on the cells in the box, shape (names, cells) each.

        Derivatives are within their limits too, but for those of the law in the middle of the box.
        """
        middle, half = (box.low + box.high) / 2.0, (box.high - box.low) / 2.0
        lows, highs = [], []
        for name, series in zip(self.family.names, self._series, strict=True):
            value = series[0] @ np.append(middle, 1.0)
            bent = np.abs(series[1:] @ np.append(middle, 1.0)).sum(axis=0)
            wide = bent + (np.abs(series[:, :, :-1]) @ half).sum(axis=0)
            limit = limits.get(name, np.inf)
            lows.append(np.minimum(np.maximum(value - wide, -limit), value - bent))
            highs.append(np.maximum(np.minimum(value + wide, limit), value + bent))
        blur = _INTEGRAL_BLUR * (1.0 + np.maximum(np.abs(lows), np.abs(highs)))
        return np.array(lows) - blur, np.array(highs) + blur

    def least(self, box: Box, limits: Mapping[str, float]) -> float:
        """A lower bound of the integral in a box, independent of all other rows."""
        low, high = self.ranges(replace(box, low=self._lawful(box.low), high=self._lawful(box.high)), limits)
        within = self._intervals(low, high)
        least = np.broadcast_to(enclosed(self.motion.formula, within).low, self.middle.shape)
        least_there = float(least @ (2.0 * self.reach))
        return least_there - _INTEGRAL_BLUR * float(np.abs(least) @ self.reach)

    def _intervals(self, low: Array, high: Array) -> dict[str, Endpoints]:
        """The ranges of the derivatives and of k on the cells."""
        within = {name: Endpoints(*ends) for name, *ends in zip(self.family.names, low, high, strict=True)}
        return within | {"k": Endpoints(self.middle - self.reach, self.middle + self.reach)}

    def _lawful(self, side: Array) -> Array:
        """A side of a box with nothing for what is no velocity."""
        return np.where(np.arange(len(side)) < self.rows.terms, side, 0.0)

    def _third(self, low: Array, high: Array) -> dict[tuple[int, int, int], Array]:
        """Greatest magnitudes of third derivatives of the formula on the cells, for names in ascending order."""
        within = self._intervals(low, high)
        planes = {}
        for key, formula in self._third_formulas.items():
            ends = enclosed(formula, within)
            planes[key] = np.broadcast_to(np.maximum(np.abs(ends.low), np.abs(ends.high)), self.middle.shape)
        return planes

    def _anywhere(self, low: Array, high: Array) -> Array:
        """A quadratic form in the velocities below the integral's second derivatives, over the ranges."""
        within = self._intervals(low, high)
        count, widths = len(self.family.names), np.maximum(high - low, TINY)
        bend = np.zeros((count, count, len(self.middle)))
        for i, j in combinations_with_replacement(range(count), 2):
            ends = enclosed(self.family.slopes.second(i, j), within)
            if i == j:
                bend[i, i] += ends.low
                continue
            bend[i, j] = bend[j, i] = (ends.low + ends.high) / 2.0
            off = (ends.high - ends.low) / 2.0
            bend[i, i] -= off * widths[j] / widths[i]
            bend[j, j] -= off * widths[i] / widths[j]
        return self._summed(np.broadcast_to(bend[..., None], (count, count, *self._nodes[0].shape)))

    @kept_property
    def _third_formulas(self) -> dict[tuple[int, int, int], Formula]:
        used, second = self.family.names, self.family.slopes.second
        several = combinations_with_replacement(range(len(used)), 3)
        return {(i, j, m): derivative(second(i, j), used[m]) for i, j, m in several}

    def least_form(self, at: Array, third: Mapping[tuple[int, int, int], Array], off: Array) -> Array:
        """A form over the velocities whose half a plane from a law may be lifted by.

        By Taylor's formula: second derivatives there, less a third of what third ones can change on the way.

        Parameters
        ----------
        at
            The law's velocities.
        third
            Magnitudes of third derivatives on the cells.
        off
            How far derivatives may be from those of the law on the cells, shape (names, cells).
        """
        weights, columns = self._nodes
        law = self._law(at)
        moved = [np.asarray(column[:, :, :-1] @ law[:-1] + column[:, :, -1]) for column in columns]
        names = {**dict(zip(self.family.names, moved, strict=True)), "k": self._places}
        bend = np.reshape(self.family.slopes.hessian(names), (len(columns), len(columns), *weights.shape)).copy()
        widths = np.maximum(off, TINY)
        for key, most in third.items():
            for i, j, m in set(permutations(key)):
                # |x y| is at most the mean of what each takes in units of its width
                bend[i, i] -= (most * off[m] * widths[j] / widths[i] / 3.0)[:, None]
        return self._summed(bend)

    def _summed(self, bend: Array) -> Array:
        """The form over the velocities of one over the derivatives at every place."""
        terms, (weights, columns) = self.rows.terms, self._nodes
        left = np.stack([column[:, :, :terms].reshape(-1, terms) for column in columns])
        weighted = (bend * weights).reshape(len(columns), len(columns), -1)
        return np.asarray(np.einsum("ijx,ixn,jxm->nm", weighted, left, left, optimize=True))

    @kept_property
    def _places(self) -> Array:
        x, _ = gauss(self._nodes[0].shape[1])
        return np.asarray(self.middle[:, None] + self.reach[:, None] * x)

    def _law(self, at: Array) -> Array:
        """The variables of a box with 1 beside them."""
        return np.concatenate([at, np.zeros(self.rows.size - len(at)), [1.0]])

    def _bend(self, box: Box, limits: Mapping[str, float]) -> CurvatureBound | None:
        """The curvature allowance in a box; None without bounds of the second derivatives."""
        terms = self.rows.terms
        low, high = self.ranges(box, limits)
        middle, half = (box.low + box.high)[:terms] / 2.0, (box.high - box.low)[:terms] / 2.0
        with np.errstate(all="ignore"):
            third = {} if self.family.convex else self._third(low, high)
            anywhere = np.zeros((terms, terms)) if self.family.convex else self._anywhere(low, high)
        return CurvatureBound(low, high, middle, half, self._free(half), third, anywhere)

    def _free(self, half: Array) -> Array:
        """Directions, in units of the box, in which laws differ that keep the equations."""
        terms = self.rows.terms
        equations = self.rows.equations()
        of_laws = equations[~equations[:, terms:-1].any(axis=1), :terms] * half
        if not len(of_laws):
            return np.eye(terms)
        _, sizes, ways = np.linalg.svd(of_laws)
        rank = int((sizes > _INTEGRAL_BLUR * sizes.max(initial=0.0)).sum())
        return np.asarray(ways[rank:].T)

    def row(self, box: Box, at: Array, limits: Mapping[str, float], room: Array) -> Array:
        """The plane that touches at the law with these velocities, less the integral's slack; at most 0."""
        terms = self.rows.terms
        at = np.clip(at, box.low[:terms], box.high[:terms])
        bend = self._bend_of(box, limits)
        nothing = np.zeros(len(room))
        off = None if bend is None else self._off(at, bend)
        if bend is None or off is None:
            return nothing
        with np.errstate(all="ignore"):
            row = self._plane(at)
            if not self.family.convex:
                # second derivatives anywhere, or those at the law with third ones: whichever takes less
                forms = (bend.anywhere, self.least_form(at, bend.third, off))
                row[-1] -= min(bend.taken(at, form) for form in forms)
        if not np.isfinite(row).all():
            return nothing
        return row - (self._square(box, room) if self.family.root else room)

    def lost(self, box: Box, limits: Mapping[str, float]) -> Array:
        """The loss of planes that touch in the middle, for each velocity's range."""
        bend = self._bend_of(box, limits)
        if bend is None:
            return np.asarray((box.high - box.low)[: self.rows.terms])
        off = self._off(bend.middle, bend)
        if off is None or self.family.convex:
            return np.zeros(self.rows.terms)
        forms = [bend.anywhere, self.least_form(bend.middle, bend.third, off)]
        costs, ways = bend.costs(min(forms, key=lambda form: bend.taken(bend.middle, form)))
        return np.asarray((costs * ways.sum(axis=1)) @ ways)

    def _bend_of(self, box: Box, limits: Mapping[str, float]) -> CurvatureBound | None:
        if self._last is None or self._last[0] is not box:
            self._last = (box, self._bend(box, limits))
        return self._last[1]

    def _plane(self, at: Array) -> Array:
        moved = self.columns @ self._law(at)
        names = {**dict(zip(self.family.names, moved, strict=True)), "k": self.family.places}
        values, slopes = self.family.slopes.value(names), self.family.slopes.gradient(names)
        weighted = slopes * self.family.weights
        row = np.einsum("ip,ipn->n", weighted, self.columns)
        size = float(self.family.weights @ np.abs(values) + (np.abs(weighted) * np.abs(moved)).sum())
        row[-1] += float(self.family.weights @ values - (weighted * moved).sum()) - self._blur * size
        return np.asarray(row)

    def _off(self, at: Array, bend: CurvatureBound) -> Array | None:
        """The greatest distance of derivatives in the box from a law's, on the cells; None for a law outside."""
        law, rows = self._law(at), []
        for low, high, series in zip(bend.low, bend.high, self._series, strict=True):
            value, bent = series[0] @ law, np.abs(series[1:] @ law).sum(axis=0)
            if (value - bent < low).any() or (value + bent > high).any():
                return None
            rows.append(np.maximum(high - value, value - low) + bent)
        return np.array(rows)

    def _square(self, box: Box, room: Array) -> Array:
        """The secant of the slack's square, for a root."""
        least, most = (max(float(end[0]), 0.0) for end in box.extent(room[None]))
        square = (least + most) * room
        square[-1] -= least * most
        return np.asarray(square)
