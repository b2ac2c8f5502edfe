"""Families of formulas that are not affine in the law: at each place, or integrated over the interval."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Self

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.arithmetic import NUMPY, Together
from optlaws.formulas.branches import corners, switches
from optlaws.formulas.convexity import degree, quadratic
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.slopes import Slopes, scaled
from optlaws.formulas.tree import Call, Exponentiation, Formula, Number, total
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import FEWEST, MOST, from_values, nodes
from optlaws.numerics.panels import candidates
from optlaws.numerics.roots import sign_changes
from optlaws.synthesis.families.cone import SumOfSquares, sum_of_squares
from optlaws.synthesis.families.family import LinearFamily, NonlinearFamily, RowJet, WholeLawFamily, last_result
from optlaws.synthesis.families.piece_series import greatest, sides_of
from optlaws.tolerances import LEAST_ENERGY, ROUNDOFF

_FORMULA_RESOLVED = 1e-13  # of the greatest value: what the last coefficients of a formula along a law leave

_PLACES_PER_DEGREE = 2
_PLACES_OF_ANY = 8  # for every variable, of a formula that is no polynomial
_SQUARE = 2
#: roundings of a formula's slope in a row
_IN_A_ROW = 16
#: places at which knots are looked for, beside one for every variable
_LOOKS = 32


def between(bend: Array, rows: Array) -> Array:
    """Second derivatives by the variables, for each law the sum over places and names of bend[i, j] rows[i] rows[j].

    Those by the names are (names, names, laws, places), the names' rows (names, laws or 1, places, variables).
    """
    turned = np.einsum("ijmp,jmpn->impn", bend, rows)
    return np.asarray((rows.swapaxes(2, 3) @ turned).sum(axis=0))


@dataclass(frozen=True, eq=False, kw_only=True)
class FormulaFamily(NonlinearFamily):
    """Base class of families of non-affine formulas: a formula of derivatives of the law and of k."""

    formula: Formula

    @property
    def quadratic(self) -> bool:
        """Whether f is a convex quadratic function of the variables at each place, or the norm of an affine map."""
        return False

    def squares(self, u: float) -> SumOfSquares:
        """The quadratic form of f at a place, where f is `quadratic`."""
        raise TypeError(f"{self.formula} is not quadratic at {u:g}")

    def scaled_down(self, by: float) -> Self:
        return self if by == 1.0 else self._divided(by, scaled(self.formula, 1.0 / by))

    def _divided(self, by: float, formula: Formula) -> Self:
        return replace(self, formula=formula, slack=self.slack / by, bound=self.bound / by, unit=self.unit * by)

    @abstractmethod
    def touching(self, x: Array, u: float) -> tuple[float, ...]:
        """Values of the formula's names at which a tangent touches it in a law."""

    @abstractmethod
    def tangent_row(self, u: float, sign: float, point: tuple[float, ...]) -> Array | None:
        """The affine function of the variables that touches f there, the constant last; None where f may be below."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CurvedFamily(FormulaFamily):
    """f is a smooth formula of derivatives of the law and of k."""

    #: what its names stand for but k: families that are affine in the variables
    parts: tuple[tuple[str, LinearFamily], ...]
    #: the signs with which the formula is convex, so that its tangents are nowhere above it
    tangents: tuple[float, ...] = ()
    degree: int | None = None  #: of f in k along a law; None where it is no polynomial
    edges: tuple[float, ...] = (1.0, -1.0)  #: the u between which it is smooth, descending

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(name for name, _ in self.parts)

    @kept_property
    def slopes(self) -> Slopes:
        """The formula with its derivatives with respect to the parts, and to k last."""
        return Slopes(self.formula, (*self.names, "k"))

    def in_units(self, units: Array, unit: float) -> Self:  # noqa: ARG002 - a formula is in its own units
        """The family of variables in other units; its own unit stays."""
        parts = tuple((name, part.in_units(units, 1.0)) for name, part in self.parts)
        return replace(self, parts=parts, slack=self.slack * units)

    @kept_property
    def corners(self) -> tuple[Slopes, ...]:
        """Functions that are 0 where a law passes a corner of a table of straight lines."""
        return tuple(Slopes(corner, (*self.names, "k")) for corner in corners(self.formula, self.names))

    def at_corners(self, x: Array) -> tuple[Array, Array]:
        """Residuals and gradients, by corners and signs, of rows whose places move with the corners as the law does.

        -inf where the law passes none; where it passes one several times, of the place with the greatest residual.
        """

        def heights(u: Array) -> Array:
            at = self._at(np.array([part.value(x, u) for _, part in self.parts]), u)
            return np.array([np.broadcast_to(corner.value(at), u.shape) for corner in self.corners])

        u = sign_changes(heights, self.domain, _LOOKS + len(self.slack))
        values = np.full((len(self.corners), len(self.signs)), -np.inf)
        rows = np.zeros((*values.shape, len(x)))
        if not len(u):
            return values.ravel(), rows.reshape(-1, len(x))
        columns, (_, turned, _), names, _ = self._expansion(u[None], np.append(x, 1.0)[None])
        jets = [self.jet(x, u, np.full(len(u), sign)) for sign in self.signs]
        slopes = [corner.value_and_gradient(names)[1][:, 0] for corner in self.corners]
        for place, i in enumerate(np.argmin(np.abs(heights(u)), axis=0)):
            gradient = slopes[i][:, place]
            turning = gradient[:-1] @ turned[:, 0, place] - 0.5 * gradient[-1]
            if turning == 0.0:
                continue
            moving = -(gradient[:-1] @ columns[:, 0, 0, place, :-1]) / turning
            for j, jet in enumerate(jets):
                if jet.value[place] > values[i, j]:
                    values[i, j], rows[i, j] = jet.value[place], jet.gradient[place] + jet.slope[place] * moving
        return values.ravel(), rows.reshape(-1, len(x))

    def columns(self, u: Array) -> Array:
        """The parts' columns with two derivatives by u, shape (parts, 3, *places, variables + 1)."""
        return np.stack([part.columns(u.reshape(-1)).reshape(3, *u.shape, -1) for _, part in self.parts])

    def _at(self, values: Array, u: Array) -> dict[str, Array]:
        return {**dict(zip(self.names, values, strict=True)), "k": self.k(u)}

    def touching(self, x: Array, u: float) -> tuple[float, ...]:
        """Values of the parts at a place in a law."""
        return tuple((self.columns(np.array([u]))[:, 0, 0] @ np.append(x, 1.0)).tolist())

    def tangent_row(self, u: float, sign: float, point: tuple[float, ...]) -> Array | None:
        """The affine function that touches sign f where the parts are as given, the constant last."""
        if sign not in self.tangents or len(point) != len(self.parts):
            return None
        values = np.array(point)[:, None]
        at = self._at(values, np.array([u]))
        (value,), slopes = self.slopes.value_and_gradient(at)
        gradient = slopes[:-1, 0]
        row = sign * (gradient @ self.columns(np.array([u]))[:, 0, 0])
        row[-1] += sign * float(value - gradient @ values[:, 0])
        return np.asarray(row)

    @kept_property
    def quadratic(self) -> bool:
        """Whether the formula is a convex polynomial of degree 2 in its parts, or a norm that is straight in them."""
        if self.signs != (1.0,) or not self.proving:
            return False
        square = self._squares
        terms = quadratic(self.formula if square is None else square, self.names)
        return terms is not None and (square is None or all(len(key) == _SQUARE for key in terms))

    @kept_property
    def _by_parts(self) -> Slopes:
        return Slopes(self.formula if self._squares is None else self._squares, self.names)

    def squares(self, u: float) -> SumOfSquares:
        """The formula at a place as a sum of squares."""
        place, root = np.array([u]), self._squares is not None
        at = self._at(np.zeros((len(self.parts), 1)), place)
        return sum_of_squares(self._by_parts, at, self.columns(place)[:, 0], np.ones(1), root=root)

    @property
    def continuable(self) -> bool:
        """Whether the family is smooth over the whole interval."""
        return self.edges == (1.0, -1.0)

    @property
    def proving(self) -> bool:
        """Whether the family is convex with every relevant sign."""
        return set(self.signs) <= set(self.tangents)

    def planes(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """Planes that touch the formula and its derivative by the place, by the chain rule."""
        columns, (values, turned, bends), _, (height, gradient, bend) = self._expansion(u, point)
        rows, slopes = columns[:, 0], columns[:, 1]
        way = np.concatenate([turned, np.full((1, *u.shape), -0.5)])
        turning = np.einsum("ijmp,jmp->imp", bend, way)
        shares = gradient[:-1]
        value = np.einsum("imp,impn->mpn", shares, rows)
        value[:, :, -1] += height - (shares * values).sum(axis=0)
        slope = np.einsum("imp,impn->mpn", turning[:-1], rows) + np.einsum("imp,impn->mpn", shares, slopes)
        slope[:, :, -1] += gradient[-1] * -0.5 - (turning[:-1] * values).sum(axis=0)
        curvature = (turning * way).sum(axis=0) + (shares * bends).sum(axis=0)
        return value, slope, curvature

    def jet(self, x: Array, u: Array, s: Array) -> RowJet:
        """Residuals of one law with their derivatives; where it is bent rounding in its planes would be great."""
        _, (_, turned, _), _, (height, gradient, _) = self._expansion(u[None], np.append(x, 1.0)[None])
        slope = (gradient[:-1] * turned).sum(axis=0)[0] - 0.5 * gradient[-1, 0]
        value = s * height[0] - self.right_side(x)
        return replace(super().jet(x, u, s), value=value, slope=s * slope)

    @last_result
    def _expansion(self, u: Array, point: Array) -> tuple[Array, Array, dict[str, Array], tuple[Array, Array, Array]]:
        """The parts' columns, what these are in each law, the names, and the formula with its derivatives."""
        columns = self.columns(u)
        moved = (columns @ point[:, :, None])[..., 0].swapaxes(0, 1)
        names = self._at(moved[0], u)
        return columns, moved, names, self.slopes.derivatives(names)

    def hessians(self, u: Array, point: Array, weights: Array) -> Array:
        """The second derivatives of the weighted formula, between each two parts' rows."""
        columns, *_, (_, _, bend) = self._expansion(u, point)
        return between(bend[:-1, :-1] * weights, columns[:, 0, ..., :-1])

    def rounding_errors(self, weights: Array, u: Array, point: Array) -> Array:
        """Rounding bounds of the parts' rows, by the slopes of the formula at each place."""
        columns, *_, (_, gradient, _) = self._expansion(u, point)
        shares = np.abs(gradient[:-1]) * weights
        of_parts = np.array([part.rounding for _, part in self.parts])
        sizes = _IN_A_ROW * ROUNDOFF * np.abs(columns[:, 0]) + of_parts[:, None, None]
        return np.asarray(np.einsum("imp,impn->mn", shares, sizes))

    def greatest(self, point: Array) -> Array:
        """The greatest of the formula, with the signs that count, on its part of the interval in each law."""
        if self._squares is not None:
            # its kinks are where it vanishes: its square has none
            return np.asarray(np.sqrt(np.maximum(self._peaks(self._squares, point), 0.0)))
        return self._peaks(self.formula, point)

    @kept_property
    def _squares(self) -> Formula | None:
        """The square of a norm; None of what is none."""
        formula = self.formula
        norm = isinstance(formula, Call) and formula.function == "norm" and self.signs == (1.0,)
        return total([Exponentiation(part, Number(2.0)) for part in formula.parts]) if norm else None

    def _peaks(self, formula: Formula, point: Array) -> Array:
        series = self._series(formula, point)
        if series is None:
            return np.full(len(point), np.inf)
        return greatest(series, self.signs)

    def _series(self, formula: Formula, point: Array) -> Array | None:
        """The series of a formula along each law; None where a limited number of points cannot resolve it."""
        degrees = {name: part.table.terms - 1 for name, part in self.parts}
        known = degree(formula, {**degrees, "k": 1})
        if known is not None:
            return self._interpolated(formula, point, known + 1)
        count = FEWEST
        while count <= MOST:
            series = self._interpolated(formula, point, count)
            tail = np.abs(series[:, -max(2, count // 10) :]).max(axis=1)
            if (tail <= _FORMULA_RESOLVED * np.abs(series).max(axis=1)).all():
                return series
            count = 2 * count - 1
        return None

    def _interpolated(self, formula: Formula, point: Array, count: int) -> Array:
        low, high = self.domain
        u = low + (high - low) * (nodes(count) + 1.0) / 2.0
        values = np.array([point @ part.columns(u)[0].T for _, part in self.parts])
        places = np.broadcast_to(u, values.shape[1:])
        heights = MotionFormula(formula).values(self._at(values, places))
        return from_values(np.broadcast_to(heights, places.shape).T).T

    def value(self, x: Array, u: Array) -> Array:
        values = [part.value(x, u) for _, part in self.parts]
        return self.slopes.value(self._at(np.array(values), u))

    @last_result
    def stationary(self, x: Array) -> Array:
        """Places among which every stationary point of the domain is, and the edges; beyond it f may have no value."""
        count = None if self.degree is None else self.degree + 1
        stretches = [ends for stretch in self._stretches for ends in pairwise(self._cut_at_knots(x, stretch))]
        inner = [candidates(lambda u: self.value(x, u), ends, count) for ends in stretches]
        return np.concatenate([*inner, *(np.array(ends) for ends in stretches), self._ends])

    @kept_property
    def _knots(self) -> Together:
        """A function that vanishes where a law passes a knot of a spline."""
        return Together(tuple(switches(self.formula, self.names)))

    def _cut_at_knots(self, x: Array, ends: tuple[float, float]) -> list[float]:
        """The ends of a stretch, and between them the places where a law passes a knot of a spline."""
        if not self._knots.formulas or ends[0] == ends[1]:
            return list(ends)

        def values(u: Array) -> Array:
            at = self._at(np.array([part.value(x, u) for _, part in self.parts]), u)
            return np.array([np.broadcast_to(value, u.shape) for value in self._knots.values(at, NUMPY)])

        return sorted({*ends, *sign_changes(values, ends, _LOOKS + len(self.slack)).tolist()})

    @kept_property
    def _ends(self) -> Array:
        """The edges; where a part jumps there, the places just before and just after each."""
        edges = np.array(self.edges)
        return sides_of(edges) if any(part.jumps for _, part in self.parts) else edges

    @kept_property
    def _stretches(self) -> list[tuple[float, float]]:
        """Between which u of the domain it is smooth."""
        low, high = self.domain
        ends = np.sort(self._ends).tolist()
        pairs = pairwise(ends) if len(ends) == len(self.edges) else zip(ends[::2], ends[1::2], strict=True)
        return [(max(a, low), min(b, high)) for a, b in pairs if a < high and b > low][::-1]

    def nodes(self) -> Array | None:
        """The nodes of the formula's parts, or as many as its degree needs."""
        low, high = self.domain
        if low == high:
            return None
        per_degree = _PLACES_OF_ANY if self.degree is None else _PLACES_PER_DEGREE
        count = per_degree * max(len(part.slack) for _, part in self.parts) + 8
        within = self._stretches
        local = np.cos(np.linspace(0.0, np.pi, max(count // len(within), 4)))
        return np.unique(np.concatenate([a + (b - a) * (local + 1.0) / 2.0 for a, b in within]))

    def pinned(self, u: Array) -> NDArray[np.bool_]:
        """Whether u is an edge, or a side of one."""
        return np.isin(u, self._ends)


@dataclass(frozen=True, eq=False, kw_only=True)
class IntegralFamily(WholeLawFamily, FormulaFamily):
    """f is the sum over nodes of weights times a smooth formula of names and k, or the root of that."""

    names: tuple[str, ...]
    columns: Array  #: rows of the names at the nodes, shape (names, nodes, variables + 1)
    places: Array  #: the k of the nodes
    weights: Array  #: of the nodes
    root: bool = False  #: whether the root of the sum is meant
    convex: bool = False  #: whether f is convex, so that its tangents are nowhere above it

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

    @property
    def proving(self) -> bool:
        """Whether the formula is convex, so that its tangents prove bounds."""
        return self.convex

    @kept_property
    def quadratic(self) -> bool:
        """Whether the formula is a polynomial of degree 2 in its names; under a root of nothing but squares."""
        terms = quadratic(self.formula, self.names) if self.convex else None
        return terms is not None and not (self.root and any(len(key) != _SQUARE for key in terms))

    def squares(self, u: float) -> SumOfSquares:  # noqa: ARG002 - it has no place
        """The integral as a sum of squares."""
        at = self._at(np.zeros((len(self.names), len(self.places))))
        return sum_of_squares(self.slopes, at, self.columns, self.weights, root=self.root)

    def _at(self, values: Array) -> dict[str, Array]:
        return {**dict(zip(self.names, values, strict=True)), "k": np.broadcast_to(self.places, values.shape[1:])}

    def touching(self, x: Array, u: float) -> tuple[float, ...]:  # noqa: ARG002 - it has no place
        """Values of the names at the nodes in a law, one name after the other."""
        return tuple((self.columns @ np.append(x, 1.0)).ravel().tolist())

    def tangent_row(self, u: float, sign: float, point: tuple[float, ...]) -> Array | None:  # noqa: ARG002 - as others
        """The affine function that touches f where the names are as given, the constant last."""
        if not self.convex or len(point) != self.columns[:, :, 0].size:
            return None
        values = np.array(point).reshape(len(self.names), -1)
        at = self._at(values)
        # in a law so far away that the formula overflows there is no tangent
        with np.errstate(over="ignore", invalid="ignore"):
            value, gradient = self.slopes.value_and_gradient(at)
            height, share = self.touched(np.array(float(self.weights @ value)))
            weighted = gradient * self.weights
            row = np.asarray(share * np.einsum("ip,ipn->n", weighted, self.columns))
            row[-1] += float(height) - share * float((weighted * values).sum())
        return row if np.isfinite(row).all() else None

    def outer(self, total: Array) -> tuple[Array, Array]:
        """The value of f for a sum over the nodes, and its derivative with respect to the sum."""
        if not self.root:
            return total, np.ones_like(total)
        size = np.sqrt(np.maximum(total, LEAST_ENERGY**2))
        return size, 0.5 / size

    def touched(self, total: Array) -> tuple[Array, Array]:
        """The tangent at a sum over the nodes, and its slope in the sum; f is nowhere below the tangent.

        Near 0, where the slope of a root is finite only by that, the rest of the tangent has slope 0.
        """
        share = self.outer(total)[1]
        return (2.0 * share * np.maximum(total, 0.0) if self.root else total), share

    def _at_nodes(self, point: Array) -> dict[str, Array]:
        return self._at((self.columns @ point.T).swapaxes(1, 2))

    def _planes(self, names: dict[str, Array]) -> tuple[Array, Array, Array]:
        """The tangent in each law, its slope with respect to the sum over the nodes, and the sum's rows with 1 last."""
        value, gradient = self.slopes.value_and_gradient(names)
        height, share = self.touched(value @ self.weights)
        return height, share, np.asarray((gradient * self.weights @ self.columns).sum(axis=0))

    def planes(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        height, share, rows = self._planes(self._at_nodes(point))
        plane = share[:, None] * rows
        plane[:, -1] += height - (plane * point).sum(axis=1)
        planes = plane[:, None, :].repeat(u.shape[1], axis=1)
        return planes, np.zeros(planes.shape), np.zeros(u.shape)

    def hessians(self, u: Array, point: Array, weights: Array) -> Array:  # noqa: ARG002 - it has no place
        names = self._at_nodes(point)
        moved = between(self.slopes.derivatives(names)[2] * self.weights, self.columns[:, None, :, :-1])
        if self.root:
            _, share, rows = self._planes(names)
            of_law = rows[:, :-1]
            across = of_law[:, :, None] * of_law[:, None, :]
            moved = share[:, None, None] * moved - across * (2.0 * share**3)[:, None, None]
        return np.asarray(moved * weights.sum(axis=1)[:, None, None])

    def rounding_errors(self, weights: Array, u: Array, point: Array) -> Array:  # noqa: ARG002 - it has no place
        """Rounding bounds of the names' rows, by the slopes of the formula at each node."""
        names = self._at_nodes(point)
        value, gradient = self.slopes.value_and_gradient(names)
        sizes = np.abs(gradient) * self.weights
        rows = np.einsum("imp,ipn->mn", sizes, np.abs(self.columns))
        share = self.outer(value @ self.weights)[1]
        blur = (_IN_A_ROW + len(self.places)) * ROUNDOFF
        return np.asarray((blur * share * weights.sum(axis=1))[:, None] * rows)

    def greatest(self, point: Array) -> Array:
        return self.outer(self.slopes.value(self._at_nodes(point)) @ self.weights)[0]
