"""Rows of formulas that are not affine in the law in many laws at once: at their places, or integrated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.affine import degree
from optlaws.formulas.of_motion import Motion
from optlaws.formulas.tree import Call, Formula, Number, Power, total
from optlaws.kept import kept_property
from optlaws.numerics.chebyshev import FEWEST, MOST, from_values, nodes
from optlaws.synthesis.arrays.columns import Columns, CurvedTangents
from optlaws.synthesis.arrays.constants import peaks
from optlaws.synthesis.families.curved import CurvedFamily, IntegralFamily, OfFormula

Array = NDArray[np.float64]

#: of the greatest value: what is left of the last coefficients of a formula along a law that is resolved
_RESOLVED = 1e-13
#: roundings of a formula's slope in a row
_IN_A_ROW, _UNIT = 16, 2.0**-53


@dataclass(frozen=True, eq=False)
class Formulas(CurvedTangents):
    """A smooth formula at each place, by the chain rule."""

    family: CurvedFamily

    @property
    def proving(self) -> bool:
        """Whether it is convex with every sign that counts."""
        return set(self.family.signs) <= set(self.family.tangents)

    @kept_property
    def _parts(self) -> list[Columns]:
        return [Columns(part) for _, part in self.family.parts]

    def _names(self, values: Array, u: Array) -> dict[str, Array]:
        return {**dict(zip(self.family.names, values, strict=True)), "k": self.family.k(u)}

    def at(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """Planes that touch the formula and its derivative by the place."""
        jets = [part.at(u, point) for part in self._parts]
        rows, slopes = (np.array([jet[i] for jet in jets]) for i in (0, 1))
        values, turned = (np.einsum("impn,mn->imp", matrix, point) for matrix in (rows, slopes))
        names, formula = self._names(values, u), self.family.slopes
        gradient, bent = formula.gradient(names), formula.hessian(names)
        way = np.concatenate([turned, np.full((1, *u.shape), -0.5)])
        turning = np.einsum("ijmp,jmp->imp", bent, way)
        own = gradient[:-1]
        value = np.einsum("imp,impn->mpn", own, rows)
        value[:, :, -1] += formula.value(names) - (own * values).sum(axis=0)
        slope = np.einsum("imp,impn->mpn", turning[:-1], rows) + np.einsum("imp,impn->mpn", own, slopes)
        slope[:, :, -1] += gradient[-1] * -0.5 - (turning[:-1] * values).sum(axis=0)
        bend = (turning * way).sum(axis=0) + (own * np.array([jet[2] for jet in jets])).sum(axis=0)
        return value, slope, bend

    def hidden(self, weights: Array, u: Array, point: Array) -> Array:
        """By the slopes of the formula at each place."""
        rows = np.array([part.at(u, point)[0] for part in self._parts])
        values = np.einsum("impn,mn->imp", rows, point)
        shares = np.abs(self.family.slopes.gradient(self._names(values, u))[:-1]) * weights
        own = np.array([part.rounding for part in self._parts])
        return np.asarray(np.einsum("imp,impn->mn", shares, _IN_A_ROW * _UNIT * np.abs(rows) + own[:, None, None]))

    def hessian(self, u: Array, point: Array, weights: Array) -> Array:
        """The second derivatives of the formula, between each two parts' rows."""
        rows = np.array([part.at(u, point)[0] for part in self._parts])
        values = np.einsum("impn,mn->imp", rows, point)
        bent = self.family.slopes.hessian(self._names(values, u))[:-1, :-1] * weights
        return _between(bent, rows[..., :-1])

    def greatest(self, point: Array) -> Array:
        """The greatest of the formula, with the signs that count, on its part of the interval in each law."""
        if self._squares is not None:
            # its kinks are where it vanishes: its square has none
            return np.asarray(np.sqrt(np.maximum(self._peaks(self._squares, point), 0.0)))
        return self._peaks(self.family.formula, point)

    @kept_property
    def _squares(self) -> Formula | None:
        """The square of a norm; None of what is none."""
        formula = self.family.formula
        norm = isinstance(formula, Call) and formula.function == "norm" and self.family.signs == (1.0,)
        return total([Power(part, Number(2.0)) for part in formula.parts]) if norm else None

    def _peaks(self, formula: Formula, point: Array) -> Array:
        series = self._series(formula, point)
        if series is None:
            return np.full(len(point), np.inf)
        size = peaks(series)
        if len(self.family.signs) == 2:
            return size
        signed = self.family.signs[0] * series
        signed[:, 0] += size
        return np.asarray(peaks(signed) - size)

    def _series(self, formula: Formula, point: Array) -> Array | None:
        """The series of a formula along each law; None where too few points resolve it."""
        degrees = {name: len(part.series) - 1 for name, part in self.family.parts}
        known = degree(formula, {**degrees, "k": 1})
        if known is not None:
            return self._interpolated(formula, point, known + 1)
        count = FEWEST
        while count <= MOST:
            series = self._interpolated(formula, point, count)
            tail = np.abs(series[:, -max(2, count // 10) :]).max(axis=1)
            if (tail <= _RESOLVED * np.abs(series).max(axis=1)).all():
                return series
            count = 2 * count - 1
        return None

    def _interpolated(self, formula: Formula, point: Array, count: int) -> Array:
        low, high = self.family.domain
        u = low + (high - low) * (nodes(count) + 1.0) / 2.0
        values = np.array([point @ part.family.columns(u)[0].T for part in self._parts])
        places = np.broadcast_to(u, values.shape[1:])
        heights = Motion(formula).values(self._names(values, places))
        return from_values(np.broadcast_to(heights, places.shape).T).T


@dataclass(frozen=True, eq=False)
class Integrals(CurvedTangents):
    """The integral of a formula, or its root. It has no place."""

    family: IntegralFamily

    @property
    def proving(self) -> bool:
        """Whether it is convex."""
        return self.family.convex

    def _names(self, point: Array) -> dict[str, Array]:
        values = np.einsum("ipn,mn->imp", self.family.columns, point)
        places = np.broadcast_to(self.family.places, values.shape[1:])
        return {**dict(zip(self.family.names, values, strict=True)), "k": places}

    def _planes(self, point: Array) -> tuple[Array, Array, Array]:
        """What the integral is in each law, its slope by its sum, and the sum's rows with 1 last."""
        names = self._names(point)
        weighted = self.family.slopes.gradient(names) * self.family.weights
        total = self.family.slopes.value(names) @ self.family.weights
        rows = np.einsum("imp,ipn->mn", weighted, self.family.columns)
        value, share = self.family.outer(total)
        return value, share, rows

    def at(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """The plane that touches it in each law."""
        value, share, rows = self._planes(point)
        plane = share[:, None] * rows
        plane[:, -1] += value - (plane * point).sum(axis=1)
        planes = np.repeat(plane[:, None, :], u.shape[1], axis=1)
        return planes, np.zeros_like(planes), np.zeros(u.shape)

    def hidden(self, weights: Array, u: Array, point: Array) -> Array:  # noqa: ARG002 - it has no place
        """By the slopes of the formula at each node."""
        names = self._names(point)
        sizes = np.abs(self.family.slopes.gradient(names)) * self.family.weights
        rows = np.einsum("imp,ipn->mn", sizes, np.abs(self.family.columns))
        share = self.family.outer(self.family.slopes.value(names) @ self.family.weights)[1]
        blur = (_IN_A_ROW + len(self.family.places)) * _UNIT
        return np.asarray((blur * share * weights.sum(axis=1))[:, None] * rows)

    def hessian(self, u: Array, point: Array, weights: Array) -> Array:  # noqa: ARG002 - it has no place
        """The second derivatives of the integral, or of its root."""
        bent = self.family.slopes.hessian(self._names(point)) * self.family.weights
        between = _between(bent, self.family.columns[:, None, :, :-1])
        if self.family.root:
            value, share, rows = self._planes(point)
            own = rows[:, :-1]
            across = own[:, :, None] * own[:, None, :]
            between = share[:, None, None] * between - across / (4.0 * value**3)[:, None, None]
        return np.asarray(between * weights.sum(axis=1)[:, None, None])

    def greatest(self, point: Array) -> Array:
        """The integral in each law."""
        return self._planes(point)[0]


def _between(bent: Array, rows: Array) -> Array:
    """For each law the sum over places and names i, j of bent[i, j] times rows[i] and rows[j]."""
    turned = np.einsum("ijmp,jmpn->impn", bent, np.broadcast_to(rows, (len(rows), *bent.shape[2:], rows.shape[-1])))
    wide = np.broadcast_to(rows, turned.shape)
    names, laws, places, size = turned.shape
    left, right = (part.transpose(1, 3, 0, 2).reshape(laws, size, names * places) for part in (wide, turned))
    return np.asarray(np.matmul(left, right.transpose(0, 2, 1)))


def formula_tangents(family: OfFormula) -> Formulas | Integrals | None:
    """The tangents of a formula's rows; None of a kind that is not known here, or where it has kinks over k."""
    if type(family) is IntegralFamily:
        return Integrals(family)
    if isinstance(family, CurvedFamily) and family.edges == (1.0, -1.0):
        return Formulas(family)
    return None
