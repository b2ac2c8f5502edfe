"""Peaks of a body that shares a law's kinetic energy: products of what is affine in the law, times powers of its Y.

Together they keep one energy, so that where the law has the velocity b the other has Y sqrt(B² - b²), and Y is such
that its stroke is 1. With B² - b² = t² q r, t = |1 - 2k|, all of it is affine in the law but for the roots and for Y.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import reduce
from typing import Self

import numpy as np
from numpy.polynomial import chebyshev, legendre

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import product, real_parts_of_roots
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, RowJet
from optlaws.tolerances import ENERGY_ROUNDING, LEAST_ENERGY, RULES_AGREE

_SPARE = 48
#: sizes of the rules that must agree on a tangent
_NODES = (160, 224)
_SHARES = (1.0, 0.8, 0.6, 0.4, 0.2, 0.0)
_LEAST_SHARE = 0.02


@dataclass(frozen=True, eq=False)
class Energy:
    """The integral of sqrt(B² - b²) over the first half of a symmetric law, with B² - b² = t² below above."""

    #: (B - b) / t² and B + b, both families in u = 2 t² - 1
    below: LinearFamily
    above: LinearFamily

    def in_units(self, units: Array, unit: float) -> Self:
        """The family of laws in other units."""
        return replace(self, below=self.below.in_units(units, unit), above=self.above.in_units(units, unit))

    @kept_property
    def columns(self) -> tuple[Array, Array]:
        """Rows of both at Gauss's nodes, a node's weight in each, so that the integral sums sqrt(below above)."""
        _, weight, below, above = self._rule(_SPARE + 4 * len(self.above.series))
        return weight[:, None] * below, weight[:, None] * above

    @kept_property
    def _rules(self) -> dict[int, tuple[Array, Array, Array, Array]]:
        return {count: self._rule(count) for count in _NODES}

    def _rule(self, count: int) -> tuple[Array, Array, Array, Array]:
        """Nodes t² of a quadrature rule with a number of points, their weights, and the rows on both sides there."""
        nodes, weights = legendre.leggauss(count)
        t = 0.5 * (nodes + 1.0)
        below, above = (family.columns(2.0 * t * t - 1.0)[0] for family in (self.below, self.above))
        return t * t, 0.25 * weights * t, below, above

    def value(self, x: Array) -> float:
        """The integral over the interval."""
        return float(self._integral(x).value[0])

    def majorant(self, x: Array) -> Array:
        """An affine function above the integral, its constant last: the tangent at x, up to rounding.

        By the means of two positive numbers sqrt(q r) <= (m q + r/m)/2 whatever the function m > 0 is. The integral of
        that is what Gauss's rule gives, but for rounding, if m is smooth: so the law is blended with a plain one,
        b = B (1 - t²), until rules of two sizes agree.
        """
        for share in _SHARES:
            first, other = (self._tangent(rule, x, share) for rule in self._rules.values())
            if first is not None and other is not None:
                off = float(np.abs(first - other).max())
                if off <= RULES_AGREE * float(np.abs(first).max()):
                    return first
        raise InputError("a law of shared energy must have a peak velocity above 0")

    def _tangent(self, rule: tuple[Array, Array, Array, Array], x: Array, share: float) -> Array | None:
        square, weight, below, above = rule
        point = np.append(x, 1.0)
        peak = 0.5 * float(self.above.value(x, np.array([-1.0]))[0])
        plain = peak * (2.0 - square)
        q, r = peak + share * (below @ point - peak), plain + share * (above @ point - plain)
        if not min(float(q.min()), float(r.min())) > _LEAST_SHARE * peak > 0.0:
            return None
        ratio = np.sqrt(r / q)
        return np.asarray(0.5 * ((weight * ratio) @ below + (weight / ratio) @ above))

    def factor(self, x: Array) -> Taylor:
        """Y, half of the inverse, with its derivatives."""
        return self._integral(x).power(-1.0).scaled(0.5)

    def _integral(self, x: Array) -> Taylor:
        below, above = (affine(columns, x) for columns in self.columns)
        return positive_product(below, above).power(0.5).total()


@dataclass(frozen=True, eq=False)
class Taylor:
    """Values at points with first and second derivatives by the place u and the variables; one point goes with all."""

    value: Array
    gradient: Array
    curvature: Array

    def __mul__(self, other: Taylor) -> Taylor:
        across = self.gradient[:, :, None] * other.gradient[:, None, :]
        return Taylor(
            self.value * other.value,
            self.gradient * other.value[:, None] + other.gradient * self.value[:, None],
            self.curvature * other.value[:, None, None]
            + other.curvature * self.value[:, None, None]
            + across
            + across.transpose(0, 2, 1),
        )

    def power(self, exponent: float) -> Taylor:
        """A power of positive values."""
        value = self.value**exponent
        slope = exponent * value / self.value
        bend = (exponent - 1.0) * slope / self.value
        across = self.gradient[:, :, None] * self.gradient[:, None, :]
        return Taylor(
            value,
            slope[:, None] * self.gradient,
            slope[:, None, None] * self.curvature + bend[:, None, None] * across,
        )

    def scaled(self, factor: float) -> Taylor:
        """The energy family scaled by a number."""
        return Taylor(factor * self.value, factor * self.gradient, factor * self.curvature)

    def raised(self, least: Array) -> Taylor:
        """Constant where it would be below `least`."""
        moves = (self.value > least).astype(np.float64)
        return Taylor(
            np.maximum(self.value, least), self.gradient * moves[:, None], self.curvature * moves[:, None, None]
        )

    def total(self) -> Taylor:
        """The sum over the points, as one."""
        return Taylor(np.array([self.value.sum()]), self.gradient.sum(axis=0)[None], self.curvature.sum(axis=0)[None])


def affine(columns: Array, x: Array) -> Taylor:
    """An affine function from its rows at points that stay, a number for each variable and the constant last."""
    gradient = np.column_stack([np.zeros(len(columns)), columns[:, :-1]])
    return Taylor(columns @ np.append(x, 1.0), gradient, np.zeros((len(columns),) + (columns.shape[1],) * 2))


def positive_product(below: Taylor, above: Taylor) -> Taylor:
    """The product, constant where it is less than counts in units of B², which the product is about."""
    scale = np.maximum(above.value**2, np.abs(below.value) * np.abs(above.value))
    return (below * above).raised(LEAST_ENERGY * np.maximum(scale, np.finfo(float).tiny))


@dataclass(frozen=True, eq=False, kw_only=True)
class EnergyFamily(ConstraintFamily):
    """f = scale Y^degree times the factors, divided by sqrt(below above) where `divided`."""

    factors: tuple[LinearFamily, ...]  #: affine in the law, over the same places
    energy: Energy  #: of which Y is made
    degree: int = 1
    divided: bool = False  #: whether sqrt(B² - b²)/t divides: then the places are those of the energy's families
    scale: float = 1.0
    convex: bool = False  #: f is Y B, and the program's laws have one B: then it is convex in them

    def scaled_down(self, by: float) -> Self:  # noqa: ARG002 - its unit is the law's
        """Itself: peaks of the other body are in the units of the law."""
        return self

    def in_units(self, units: Array, unit: float) -> Self:
        """The energy family for laws in other units; the other body's peaks do not depend on these."""
        return replace(
            self,
            factors=tuple(factor.in_units(units, unit) for factor in self.factors),
            energy=self.energy.in_units(units, unit),
            slack=self.slack * units,
        )

    def k(self, u: Array) -> Array:
        """The k of the factors' places."""
        return self.factors[0].k(u)

    def u(self, k: Array) -> Array:
        """Places of the factors, 2k - 1."""
        return self.factors[0].u(k)

    def nodes(self) -> Array | None:
        """Chebyshev points with both ends; None where there is one place."""
        low, high = self.domain
        if low == high:
            return None
        local = chebyshev.chebpts2(2 * len(self.slack) + 8)[::-1]
        return np.asarray(0.5 * (high + low) + 0.5 * (high - low) * local)

    def jet(self, x: Array, u: Array, s: Array) -> RowJet:
        peak = self._taylor(x, u)
        return RowJet(
            s * peak.value - self.right_side(x),
            s * peak.gradient[:, 0],
            s * peak.curvature[:, 0, 0],
            s[:, None] * peak.gradient[:, 1:] - self.slack,
            s[:, None] * peak.curvature[:, 0, 1:],
        )

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:
        return np.asarray(np.tensordot(weights, self._taylor(x, u).curvature[:, 1:, 1:], axes=1))

    def value(self, x: Array, u: Array) -> Array:
        values = np.full(len(u), self.scale * (0.5 / self.energy.value(x)) ** self.degree)
        for factor in self.factors:
            values = values * factor.value(x, u)
        if self.divided:
            values = values / np.sqrt(self._below_above(x, u).value)
        return values

    def stationary(self, x: Array) -> Array:
        """Roots of the derivative's numerator, a polynomial in u."""
        point = np.append(x, 1.0)
        top = reduce(product, (factor.series @ point for factor in self.factors))
        slope = _derivative(top)
        if self.divided:
            under = product(self.energy.below.series @ point, self.energy.above.series @ point)
            slope = np.asarray(chebyshev.chebsub(product(slope, under), 0.5 * product(top, _derivative(under))))
        return real_parts_of_roots(slope)

    def minorant(self, x: Array) -> Array:
        """An affine lower bound of Y B, the constant last, for all laws with the same B as the law x.

        1/I is at least its tangent 2/J - I/J² at any J, and the integral I at most its tangent at any law.
        """
        at_start = self.factors[0].columns(np.array(self.domain[:1]))[0, 0]
        above, point = self.energy.majorant(x), np.append(x, 1.0)
        peak, middle = float(at_start @ point), float(above @ point)
        row = (0.5 * self.scale / middle) * (at_start - (peak / middle) * above)
        # in laws of the same B its own row is a number
        row[-1] += 0.5 * self.scale * peak / middle * (1.0 - ENERGY_ROUNDING)
        return np.asarray(row, dtype=np.float64)

    def _taylor(self, x: Array, u: Array) -> Taylor:
        parts = [_at_places(factor, x, u) for factor in self.factors]
        if self.divided:
            parts.append(self._below_above(x, u).power(-0.5))
        return reduce(Taylor.__mul__, [*parts, *[self.energy.factor(x)] * self.degree]).scaled(self.scale)

    def _below_above(self, x: Array, u: Array) -> Taylor:
        return positive_product(_at_places(self.energy.below, x, u), _at_places(self.energy.above, x, u))


def _at_places(family: LinearFamily, x: Array, u: Array) -> Taylor:
    columns = family.columns(u)
    value, slope, curvature = columns @ np.append(x, 1.0)
    bend = np.zeros((len(u), len(x) + 1, len(x) + 1))
    bend[:, 0, 0] = curvature
    bend[:, 0, 1:] = bend[:, 1:, 0] = columns[1, :, :-1]
    return Taylor(value, np.column_stack([slope, columns[0, :, :-1]]), bend)


def _derivative(series: Array) -> Array:
    return np.asarray(chebyshev.chebder(series), dtype=np.float64)
