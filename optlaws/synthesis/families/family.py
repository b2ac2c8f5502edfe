"""Families of constraints that hold at every k, and the semi-infinite programs made of them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numerics.chebyshev import product, real_parts_of_roots
from optlaws.numerics.gegenbauer import even_gegenbauer_jet

Array = NDArray[np.float64]

_END = 1e-9
_AT_END = 1e-8  # a stationary point that rounding has moved off an end by symmetry is that end
_NO_NORM = 1e-12  # at standstill and in uniform motion the norm has no slope


@dataclass(frozen=True, eq=False)
class Jet:
    """Residuals of a family at points, their derivatives by the place u, and their gradients by the variables."""

    value: Array
    slope: Array
    curvature: Array
    gradient: Array
    slope_gradient: Array


@dataclass(frozen=True, eq=False)
class Family(ABC):
    """The constraint s f(u; x) <= slack . x + bound for every u of the domain and every sign s.

    Attributes
    ----------
    name
        What is constrained; the certificate finds its formula by it.
    slack, bound
        The right side: a variable such as the peak C, a number, or both.
    signs
        The values of s: (1,), (-1,) or (1, -1) for a magnitude.
    domain
        The least and the greatest u that count.
    held
        The family binds as an equation at a contact that it has, and nowhere else: a peak that is held up.
    unit
        What the rows have been divided by, a power of 2: certificates speak of them as they were.
    """

    name: str
    slack: Array
    bound: float = 0.0
    signs: tuple[float, ...] = (1.0,)
    domain: tuple[float, float] = (-1.0, 1.0)
    held: bool = False
    unit: float = 1.0

    @abstractmethod
    def jet(self, x: Array, u: Array, s: Array) -> Jet:
        """Residuals s f - slack . x - bound with their derivatives."""

    @abstractmethod
    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:
        """Second derivative by x of the sum of weights times f; None where it is zero."""

    @abstractmethod
    def value(self, x: Array, u: Array) -> Array:
        """f at the points u."""

    @abstractmethod
    def stationary(self, x: Array) -> Array:
        """Points of [-1, 1] among which every stationary point of f is."""

    @abstractmethod
    def in_units(self, units: Array, unit: float) -> Self:
        """The same rows for variables x / units, divided by `unit`, which is what coordinates are divided by."""

    def scaled_down(self, by: float) -> Self:
        """The same rows, divided by a power of 2; the variables stay."""
        if by == 1.0:
            return self
        return replace(self.in_units(np.ones(len(self.slack)), by), unit=self.unit * by)

    def nodes(self) -> Array | None:
        """Where to hold the family first; None leaves the choice to the exchange."""
        return None

    def pinned(self, u: Array) -> NDArray[np.bool_]:
        """Whether a contact at u is a kink that stays where it is."""
        return np.zeros(len(u), dtype=np.bool_)

    def movable(self, u: Array) -> NDArray[np.bool_]:
        """Whether a contact at u may move: it is neither at an end nor pinned."""
        low, high = self.domain
        return (low < u) & (u < high) & ~self.pinned(u)

    def k(self, u: Array) -> Array:
        """The k in [0, 1] that belongs to u = 1 - 2k."""
        places: Array = (1.0 - u) / 2.0
        return places

    def u(self, k: Array) -> Array:
        """The place that belongs to k."""
        return 1.0 - 2.0 * k

    def room(self, x: Array) -> float:
        """The right side."""
        return float(self.slack @ x) + self.bound

    def extremes(self, x: Array) -> tuple[Array, Array, Array]:
        """Points, signs and residuals (positive where violated) at every end and stationary point."""
        low, high = self.domain
        if low == high:
            u = np.array([low])
        else:
            inner = self.stationary(x)
            inner = np.sort(inner[(inner > low + _AT_END) & (inner < high - _AT_END)])
            u = np.concatenate([[low], inner, [high]])
        value, room = self.value(x, u), self.room(x)
        signs = np.repeat(self.signs, len(u))
        return np.tile(u, len(self.signs)), signs, signs * np.tile(value, len(self.signs)) - room


@dataclass(frozen=True, eq=False, kw_only=True)
class LinearFamily(Family):
    """f is affine in x: a Chebyshev series in u for each variable, and one that belongs to none as the last column."""

    series: Array

    @kept_property
    def _jet(self) -> Array:
        parts = [self.series]
        for _ in range(2):
            slope = np.zeros_like(self.series)
            lower = chebyshev.chebder(parts[-1])
            slope[: len(lower)] = lower
            parts.append(slope)
        return np.hstack(parts)

    def columns(self, u: Array) -> Array:
        """f's columns with two derivatives by u, shape (3, points, variables + 1)."""
        angles = np.arccos(np.minimum(np.maximum(u, -1.0), 1.0))
        flat = np.cos(np.outer(angles, np.arange(len(self.series)))) @ self._jet
        shaped: Array = flat.reshape(len(u), 3, -1).transpose(1, 0, 2)
        return shaped

    def rows(self, u: Array, s: Array) -> tuple[Array, Array]:
        """A and h of the rows A x <= h at the points u with signs s."""
        columns = self.columns(u)[0] * s[:, None]
        return columns[:, :-1] - self.slack, self.bound - columns[:, -1]

    def jet(self, x: Array, u: Array, s: Array) -> Jet:
        """Residuals with their derivatives."""
        columns = self.columns(u) * s[:, None]
        columns[0, :, :-1] -= self.slack
        value, slope, curvature = columns @ np.append(x, 1.0)
        return Jet(value - self.bound, slope, curvature, columns[0, :, :-1], columns[1, :, :-1])

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:  # noqa: ARG002
        """None, for f is affine."""
        return None

    def in_units(self, units: Array, unit: float) -> Self:
        """The series' columns and the right side in other units."""
        series = self.series * np.append(units, 1.0) / unit
        return replace(self, series=series, slack=self.slack * units / unit, bound=self.bound / unit)

    def value(self, x: Array, u: Array) -> Array:
        """f at the points u."""
        return np.asarray(chebyshev.chebval(u, self.series @ np.append(x, 1.0)), dtype=float)

    def stationary(self, x: Array) -> Array:
        """Roots of the derivative's series."""
        slope = np.asarray(chebyshev.chebder(self.series @ np.append(x, 1.0)), dtype=np.float64)
        return real_parts_of_roots(slope)


@dataclass(frozen=True, eq=False, kw_only=True)
class EvenFamily(LinearFamily):
    """A linear family of laws that are even about k = 1/2, as series in u = 2 (1-2k)² - 1."""

    def k(self, u: Array) -> Array:
        """The k in [0, 1/2] that belongs to u."""
        return (1.0 - np.sqrt(np.maximum(u + 1.0, 0.0) / 2.0)) / 2.0

    def u(self, k: Array) -> Array:
        """2 (1-2k)² - 1."""
        return 2.0 * (1.0 - 2.0 * k) ** 2 - 1.0


@dataclass(frozen=True, eq=False, kw_only=True)
class RootFamily(LinearFamily):
    """f is an affine series divided by sqrt(1-u), that is by sqrt(2k): b <= sqrt(2 D k) follows from b b' <= D."""

    def columns(self, u: Array) -> Array:
        """f's columns with two derivatives by u; zero at k = 0, where the series has a zero."""
        g0, g1, g2 = super().columns(u)
        near = 1.0 - u < _END
        left = np.where(near, 1.0, 1.0 - u)[:, None]
        root = np.sqrt(left)
        jets = np.stack([g0, g1 + g0 / (2.0 * left), g2 + g1 / left + 3.0 * g0 / (4.0 * left**2)])
        shaped: Array = np.where(near[:, None], 0.0, jets / root)
        return shaped

    def value(self, x: Array, u: Array) -> Array:
        """f at the points u."""
        value: Array = self.columns(u)[0] @ np.append(x, 1.0)
        return value

    def stationary(self, x: Array) -> Array:
        """Roots of 2 (1-u) g' + g."""
        series = self.series @ np.append(x, 1.0)
        slope = product(np.array([2.0, -2.0]), np.asarray(chebyshev.chebder(series)))
        total = np.zeros(max(len(series), len(slope)))
        total[: len(series)] = series
        total[: len(slope)] += slope
        return real_parts_of_roots(total)


@dataclass(frozen=True, eq=False, kw_only=True)
class MirroredFamily(RootFamily):
    """A root family written from the end of the interval: u = 2k - 1."""

    def k(self, u: Array) -> Array:
        """The k that belongs to u = 2k - 1."""
        return (1.0 + u) / 2.0

    def u(self, k: Array) -> Array:
        """2k - 1."""
        return 2.0 * k - 1.0


@dataclass(frozen=True, eq=False, kw_only=True)
class RatioFamily(EvenFamily):
    """An even family whose columns are Gegenbauer polynomials, `scale` times; the last one, of degree 0, is the base's.

    Their values grow so much toward k = 0 that a series would lose the digits of the others.
    """

    index: float = 0.5
    scale: Array = field(default_factory=lambda: np.ones(1))

    def in_units(self, units: Array, unit: float) -> Self:
        """The base's column in other units; those of the coordinates stay."""
        own = np.append(units[: len(self.scale) - 1] / unit, 1.0 / unit)
        return replace(super().in_units(units, unit), scale=self.scale * own)

    def columns(self, u: Array) -> Array:
        """f's columns with two derivatives by u, by recurrence."""
        polynomials = even_gegenbauer_jet(self.index, len(self.scale) - 1, u)
        shaped = np.zeros((3, len(u), len(self.slack) + 1))
        shaped[:, :, : len(self.scale) - 1] = polynomials[:, :, 1:] * self.scale[:-1]
        shaped[:, :, -1] = polynomials[:, :, 0] * self.scale[-1]
        return shaped

    def value(self, x: Array, u: Array) -> Array:
        """f at the points u, by recurrence."""
        value: Array = self.columns(u)[0] @ np.append(x, 1.0)
        return value


@dataclass(frozen=True, eq=False, kw_only=True)
class ProductFamily(Family):
    """f = g h, g and h affine in x: the power d = b c, which is not convex in x."""

    first: LinearFamily
    second: LinearFamily

    def scaled_down(self, by: float) -> Self:
        """The same rows, divided by a power of 2."""
        first = self.first.scaled_down(by)
        return replace(self, first=first, slack=self.slack / by, bound=self.bound / by, unit=self.unit * by)

    def in_units(self, units: Array, unit: float) -> Self:
        """Both factors in other units, and so the right side by the square."""
        first, second = (factor.in_units(units, unit) for factor in (self.first, self.second))
        square = unit * unit
        return replace(self, first=first, second=second, slack=self.slack * units / square, bound=self.bound / square)

    def jet(self, x: Array, u: Array, s: Array) -> Jet:
        """Residuals with their derivatives, by the product rule."""
        g, h = self.first.columns(u), self.second.columns(u)
        point = np.append(x, 1.0)
        (g0, g1, g2), (h0, h1, h2) = g @ point, h @ point
        g, h = g[:, :, :-1], h[:, :, :-1]
        gradient = g0[:, None] * h[0] + h0[:, None] * g[0]
        slope_gradient = g1[:, None] * h[0] + h0[:, None] * g[1] + g0[:, None] * h[1] + h1[:, None] * g[0]
        return Jet(
            s * g0 * h0 - self.room(x),
            s * (g1 * h0 + g0 * h1),
            s * (g2 * h0 + 2.0 * g1 * h1 + g0 * h2),
            s[:, None] * gradient - self.slack,
            s[:, None] * slope_gradient,
        )

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:  # noqa: ARG002
        """The sum of weights times g's row by h's and h's by g's."""
        g, h = self.first.columns(u)[0, :, :-1], self.second.columns(u)[0, :, :-1]
        half: Array = (g * weights[:, None]).T @ h
        return half + half.T

    def value(self, x: Array, u: Array) -> Array:
        """G h at the points u, each evaluated by itself."""
        return self.first.value(x, u) * self.second.value(x, u)

    def stationary(self, x: Array) -> Array:
        """Roots of g' h + g h'."""
        point = np.append(x, 1.0)
        g, h = self.first.series @ point, self.second.series @ point
        slopes = [product(np.asarray(chebyshev.chebder(p)), q) for p, q in ((g, h), (h, g))]
        total = np.zeros(max(map(len, slopes)))
        for slope in slopes:
            total[: len(slope)] += slope
        return real_parts_of_roots(total)


@dataclass(frozen=True, eq=False, kw_only=True)
class NormFamily(Family):
    """f is the Euclidean norm of an affine map of x: the RMS of c or j. It has no place: u is 1."""

    matrix: Array
    domain: tuple[float, float] = (1.0, 1.0)

    def in_units(self, units: Array, unit: float) -> Self:
        """The map's columns and the right side in other units."""
        matrix = self.matrix * np.append(units, 1.0) / unit
        return replace(self, matrix=matrix, slack=self.slack * units / unit, bound=self.bound / unit)

    def jet(self, x: Array, u: Array, s: Array) -> Jet:
        """The residual with its gradient."""
        image = self.matrix @ np.append(x, 1.0)
        norm = max(float(np.linalg.norm(image)), _NO_NORM)
        zero, flat = np.zeros(len(u)), np.zeros((len(u), len(x)))
        gradient = s[:, None] * (image @ self.matrix[:, :-1] / norm) - self.slack
        return Jet(s * norm - self.room(x), zero, zero, gradient, flat)

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:  # noqa: ARG002
        """The second derivatives of the norm, times the sum of weights."""
        image = self.matrix @ np.append(x, 1.0)
        norm = max(float(np.linalg.norm(image)), _NO_NORM)
        direction = image @ self.matrix[:, :-1] / norm
        curved: Array = self.matrix[:, :-1].T @ self.matrix[:, :-1] - np.outer(direction, direction)
        return curved * (float(weights.sum()) / norm)

    def value(self, x: Array, u: Array) -> Array:
        """The norm."""
        return np.full(len(u), float(np.linalg.norm(self.matrix @ np.append(x, 1.0))))

    def stationary(self, x: Array) -> Array:  # noqa: ARG002
        """No places: a norm has none."""
        return np.empty(0)


@dataclass(frozen=True, eq=False)
class Points:
    """Points of one family: positions u and signs s."""

    u: Array
    s: Array

    def joined(self, other: Points) -> Points:
        """These points and others."""
        return Points(np.concatenate([self.u, other.u]), np.concatenate([self.s, other.s]))


@dataclass(frozen=True, eq=False)
class Program:
    """Minimise objective . x subject to families and equations: equalities . x = right; all in units near its size.

    Attributes
    ----------
    families, equalities, right, objective
        Divided by powers of 2, so that tolerances are shares of what things are.
    unit, equation_units
        What the objective has been divided by, and each equation; None where no equation was.
    """

    families: tuple[Family, ...]
    equalities: Array
    right: Array
    objective: Array
    unit: float = 1.0
    equation_units: Array | None = None

    def multipliers_of_equations(self, stated: Sequence[float]) -> Array:
        """The program's own multipliers, from those of the equations and the objective as the problem has them."""
        units = np.ones(len(self.right)) if self.equation_units is None else self.equation_units
        return np.array(stated[: len(units)], dtype=np.float64) * units[: len(stated)] / self.unit

    def stated_multipliers(self, equations: Array) -> Array:
        """The other way round."""
        units = np.ones(len(self.right)) if self.equation_units is None else self.equation_units
        return np.asarray(equations * self.unit / units)

    @property
    def size(self) -> int:
        """Number of variables."""
        return len(self.objective)

    @property
    def scale(self) -> float:
        """What residuals are compared with: 1, as laws have stroke and duration 1."""
        return 1.0

    @property
    def curved(self) -> bool:
        """Whether a family is not affine in x."""
        return not all(isinstance(family, LinearFamily) for family in self.families)

    def worth(self, x: Array) -> float:
        """The objective at x."""
        return float(self.objective @ x)

    def violation(self, x: Array) -> float:
        """Largest residual over every family and every u."""
        binding = [family for family in self.families if not family.held]
        return max((float(family.extremes(x)[2].max()) for family in binding), default=0.0)
