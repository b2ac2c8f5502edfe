"""Families of formulas that are not affine in the law: at each place, or integrated over the interval."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Self

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.slopes import derivative, scaled
from optlaws.formulas.tree import Formula
from optlaws.kept import kept_property
from optlaws.numerics.candidates import candidates
from optlaws.synthesis.families.family import Family, Jet, LinearFamily

Array = NDArray[np.float64]

_LEAST_ROOT = 1e-12
_PLACES_PER_DEGREE = 2


@dataclass(frozen=True, eq=False)
class Slopes:
    """A formula in some names with its first and second derivatives by them.

    Attributes
    ----------
    formula
        The formula.
    names
        By which it is differentiated.
    """

    formula: Formula
    names: tuple[str, ...]

    @kept_property
    def first(self) -> list[Formula]:
        """By each name."""
        return [derivative(self.formula, name) for name in self.names]

    @kept_property
    def second(self) -> list[list[Formula]]:
        """By each two."""
        return [[derivative(slope, name) for name in self.names] for slope in self.first]

    def value(self, at: Mapping[str, Array]) -> Array:
        """The formula's values."""
        return _values(self.formula, at)

    def gradient(self, at: Mapping[str, Array]) -> Array:
        """Its derivatives, shape (names, places)."""
        return np.array([_slope(slope, at) for slope in self.first])

    def hessian(self, at: Mapping[str, Array]) -> Array:
        """Its second derivatives, shape (names, names, places)."""
        return np.array([[_slope(bend, at) for bend in row] for row in self.second])


def _values(formula: Formula, at: Mapping[str, Array]) -> Array:
    with np.errstate(all="ignore"):
        return np.broadcast_to(evaluate(formula, at, NUMPY), np.shape(at["k"])).astype(np.float64)


def _slope(formula: Formula, at: Mapping[str, Array]) -> Array:
    """The values of a slope; 0 where it has none: at the tip of a norm that is a slope of some tangent."""
    values = _values(formula, at)
    return np.where(np.isnan(values), 0.0, values)


def bent(bend: Array, rows: Array) -> Array:
    """Second derivatives by the variables, of those by the names (names, names, places) and the names' rows."""
    turned = np.einsum("ijp,jpn->ipn", bend, rows)
    return np.asarray(np.tensordot(rows, turned, axes=((0, 1), (0, 1))))


@dataclass(frozen=True, eq=False, kw_only=True)
class OfFormula(Family):
    """What families of formulas that are not affine have in common: a formula of derivatives of the law and of k."""

    formula: Formula

    def scaled_down(self, by: float) -> Self:
        """The same rows, divided by a power of 2: so is the formula."""
        return self if by == 1.0 else self._divided(by, scaled(self.formula, 1.0 / by))

    def _divided(self, by: float, formula: Formula) -> Self:
        return replace(self, formula=formula, slack=self.slack / by, bound=self.bound / by, unit=self.unit * by)

    @abstractmethod
    def touching(self, x: Array, u: float) -> tuple[float, ...]:
        """Where in the names of the formula a tangent touches it in a law."""

    @abstractmethod
    def tangent_row(self, u: float, sign: float, point: tuple[float, ...]) -> Array | None:
        """The affine function of the variables that touches f there, the constant last; None where f may be below."""

    @abstractmethod
    def same_rows(self, other: OfFormula) -> bool:
        """Whether f is the same function of the variables and the place."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CurvedFamily(OfFormula):
    """f is a smooth formula of derivatives of the law and of k.

    Attributes
    ----------
    formula
        The formula.
    parts
        What its names stand for but k: families that are affine in the variables.
    tangents
        The signs with which the formula is convex, so that its tangents are nowhere above it.
    degree
        Of f in k along a law; None where it is no polynomial.
    edges
        The u between which it is smooth, descending.
    """

    parts: tuple[tuple[str, LinearFamily], ...]
    tangents: tuple[float, ...] = ()
    degree: int | None = None
    edges: tuple[float, ...] = (1.0, -1.0)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of its parts."""
        return tuple(name for name, _ in self.parts)

    @kept_property
    def slopes(self) -> Slopes:
        """With its derivatives by the parts, and by k last."""
        return Slopes(self.formula, (*self.names, "k"))

    def in_units(self, units: Array, unit: float) -> Self:  # noqa: ARG002 - a formula is in its own units
        """The family of variables in other units; its own unit stays."""
        parts = tuple((name, part.in_units(units, 1.0)) for name, part in self.parts)
        return replace(self, parts=parts, slack=self.slack * units)

    def columns(self, u: Array) -> Array:
        """The parts' columns with two derivatives by u, shape (parts, 3, places, variables + 1)."""
        return np.stack([part.columns(u) for _, part in self.parts])

    def _at(self, values: Array, u: Array) -> dict[str, Array]:
        return {**dict(zip(self.names, values, strict=True)), "k": self.k(u)}

    def touching(self, x: Array, u: float) -> tuple[float, ...]:
        """What the parts are at a place in a law."""
        return tuple((self.columns(np.array([u]))[:, 0, 0] @ np.append(x, 1.0)).tolist())

    def tangent_row(self, u: float, sign: float, point: tuple[float, ...]) -> Array | None:
        """The affine function that touches sign f where the parts are as given, the constant last."""
        if sign not in self.tangents or len(point) != len(self.parts):
            return None
        values = np.array(point)[:, None]
        at = self._at(values, np.array([u]))
        gradient = self.slopes.gradient(at)[:-1, 0]
        row = sign * (gradient @ self.columns(np.array([u]))[:, 0, 0])
        row[-1] += sign * float(self.slopes.value(at)[0] - gradient @ values[:, 0])
        return np.asarray(row)

    def jet(self, x: Array, u: Array, s: Array) -> Jet:
        """Residuals with their derivatives, by the chain rule."""
        columns = self.columns(u)
        moved = columns @ np.append(x, 1.0)
        at = self._at(moved[:, 0], u)
        value, gradient, bend = self.slopes.value(at), self.slopes.gradient(at), self.slopes.hessian(at)
        way = np.concatenate([moved[:, 1], np.full((1, len(u)), -0.5)])
        turning = np.einsum("ijp,jp->ip", bend, way)
        slope = (gradient * way).sum(axis=0)
        curvature = (turning * way).sum(axis=0) + (gradient[:-1] * moved[:, 2]).sum(axis=0)
        rows = columns[:, :, :, :-1]
        by_x = np.einsum("ip,ipn->pn", gradient[:-1], rows[:, 0])
        slope_by_x = np.einsum("ip,ipn->pn", turning[:-1], rows[:, 0]) + np.einsum(
            "ip,ipn->pn", gradient[:-1], rows[:, 1]
        )
        signs = s[:, None]
        return Jet(s * value - self.room(x), s * slope, s * curvature, signs * by_x - self.slack, signs * slope_by_x)

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:
        """The second derivatives of the weighted sum of the formula."""
        columns = self.columns(u)[:, 0]
        bend = self.slopes.hessian(self._at(columns @ np.append(x, 1.0), u))[:-1, :-1]
        return bent(bend * weights, columns[:, :, :-1])

    def value(self, x: Array, u: Array) -> Array:
        """f at the points u."""
        values = [part.value(x, u) for _, part in self.parts]
        return self.slopes.value(self._at(np.array(values), u))

    def stationary(self, x: Array) -> Array:
        """Places among which every stationary point of the domain is, and the edges; beyond it f may have no value."""
        count = None if self.degree is None else self.degree + 1
        inner = [candidates(lambda u: self.value(x, u), ends, count) for ends in self._stretches]
        return np.concatenate([*inner, self.edges])

    @property
    def _stretches(self) -> list[tuple[float, float]]:
        """Between which u of the domain it is smooth."""
        low, high = self.domain
        return [(max(a, low), min(b, high)) for b, a in pairwise(self.edges) if a < high and b > low]

    def same_rows(self, other: OfFormula) -> bool:
        """Whether another family has the same formula of the same series."""
        if not isinstance(other, CurvedFamily) or (self.formula, self.names) != (other.formula, other.names):
            return False
        rows = (
            np.array_equal(first.series, two.series)
            for (_, first), (_, two) in zip(self.parts, other.parts, strict=True)
        )
        return (self.tangents, self.edges) == (other.tangents, other.edges) and all(rows)

    def nodes(self) -> Array | None:
        """The nodes of the formula's parts, or as many as its degree needs."""
        low, high = self.domain
        if low == high:
            return None
        count = _PLACES_PER_DEGREE * max(len(part.slack) for _, part in self.parts) + 8
        within = self._stretches
        local = np.cos(np.linspace(0.0, np.pi, max(count // len(within), 4)))
        return np.unique(np.concatenate([a + (b - a) * (local + 1.0) / 2.0 for a, b in within]))

    def pinned(self, u: Array) -> NDArray[np.bool_]:
        """Whether u is an edge."""
        return np.isin(u, self.edges)


@dataclass(frozen=True, eq=False, kw_only=True)
class IntegralFamily(OfFormula):
    """f is the sum over nodes of weights times a smooth formula, or the root of that. It has no place: u is 1.

    Attributes
    ----------
    formula
        The formula, of the names and of k.
    names
        What `columns` are of.
    columns
        Their rows at the nodes, shape (names, nodes, variables + 1).
    places
        The k of the nodes.
    weights
        Of the nodes.
    root
        Whether the root of the sum is meant.
    convex
        Whether f is convex, so that its tangents are nowhere above it.
    """

    names: tuple[str, ...]
    columns: Array
    places: Array
    weights: Array
    root: bool = False
    convex: bool = False
    domain: tuple[float, float] = (1.0, 1.0)

    @kept_property
    def slopes(self) -> Slopes:
        """The formula with its derivatives by the names."""
        return Slopes(self.formula, self.names)

    def scaled_down(self, by: float) -> Self:
        """The same row, divided by a power of 2; under a root the formula is by its square."""
        if by == 1.0:
            return self
        return self._divided(by, scaled(self.formula, 1.0 / (by * by if self.root else by)))

    def in_units(self, units: Array, unit: float) -> Self:  # noqa: ARG002 - a formula is in its own units
        """The family of variables in other units; its own unit stays."""
        return replace(self, columns=self.columns * np.append(units, 1.0), slack=self.slack * units)

    def _at(self, values: Array) -> dict[str, Array]:
        return {**dict(zip(self.names, values, strict=True)), "k": self.places}

    def same_rows(self, other: OfFormula) -> bool:
        """Whether another family has the same formula of the same rows at the same nodes."""
        if not isinstance(other, IntegralFamily) or (self.formula, self.names) != (other.formula, other.names):
            return False
        arrays = ((self.columns, other.columns), (self.places, other.places), (self.weights, other.weights))
        return (self.root, self.convex) == (other.root, other.convex) and all(np.array_equal(*two) for two in arrays)

    def touching(self, x: Array, u: float) -> tuple[float, ...]:  # noqa: ARG002 - it has no place
        """What the names are at the nodes in a law, one name after the other."""
        return tuple((self.columns @ np.append(x, 1.0)).ravel().tolist())

    def tangent_row(self, u: float, sign: float, point: tuple[float, ...]) -> Array | None:  # noqa: ARG002
        """The affine function that touches f where the names are as given, the constant last."""
        if not self.convex or len(point) != self.columns[:, :, 0].size:
            return None
        values = np.array(point).reshape(len(self.names), -1)
        at = self._at(values)
        # in a law so far away that the formula overflows there is no tangent
        with np.errstate(over="ignore", invalid="ignore"):
            gradient = self.slopes.gradient(at) * self.weights
            value, share = self.outer(np.array(float(self.weights @ self.slopes.value(at))))
            row = np.asarray(share * np.einsum("ip,ipn->n", gradient, self.columns))
            row[-1] += value - share * float((gradient * values).sum())
        return row if np.isfinite(row).all() else None

    def outer(self, total: Array) -> tuple[Array, Array]:
        """What f is where the sum over the nodes is this, and its derivative by the sum."""
        if not self.root:
            return total, np.ones_like(total)
        size = np.sqrt(np.maximum(total, _LEAST_ROOT**2))
        return size, 0.5 / size

    def _sum(self, x: Array) -> tuple[Array, Array, dict[str, Array]]:
        at = self._at(self.columns @ np.append(x, 1.0))
        gradient = self.slopes.gradient(at) * self.weights
        return np.asarray(self.weights @ self.slopes.value(at)), np.einsum("ip,ipn->n", gradient, self.columns)[:-1], at

    def jet(self, x: Array, u: Array, s: Array) -> Jet:
        """The residual with its gradient."""
        total, by_x, _ = self._sum(x)
        value, share = self.outer(total)
        nothing = np.zeros(len(u))
        gradient = s[:, None] * (share * by_x) - self.slack
        return Jet(s * value - self.room(x), nothing, nothing, gradient, np.zeros((len(u), len(x))))

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:  # noqa: ARG002 - it has no place
        """The second derivatives of f, times the sum of weights."""
        total, by_x, at = self._sum(x)
        moved = bent(self.slopes.hessian(at) * self.weights, self.columns[:, :, :-1])
        if self.root:
            size, share = self.outer(total)
            moved = share * moved - np.outer(by_x, by_x) / (4.0 * size**3)
        return np.asarray(moved * float(weights.sum()))

    def value(self, x: Array, u: Array) -> Array:
        """f."""
        return np.full(len(u), self.outer(self._sum(x)[0])[0])

    def stationary(self, x: Array) -> Array:  # noqa: ARG002
        """No places: an integral has none."""
        return np.empty(0)
