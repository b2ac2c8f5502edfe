"""Families of constraints that hold at every k, and their semi-infinite programs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import wraps
from typing import Any, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes, product
from optlaws.synthesis.families.piece_series import PieceSeries, greatest, power_peaks, sides_of
from optlaws.tolerances import AT_END, ROW_ROUNDING

_END_OF_U = 1e-9  # of u: a place so near to the end is the end
_NO_NORM = 1e-12  # at standstill and in uniform motion a norm has no slope

Result = TypeVar("Result")

_MOST, _LEAST = 600, 8  # nodes of a family of pieces, and of a piece: its extrema join them


@dataclass(frozen=True, eq=False)
class RowJet:
    """Residuals of a family at points, their derivatives by the place u, and their gradients by the variables."""

    value: Array
    slope: Array
    curvature: Array
    gradient: Array
    slope_gradient: Array


@dataclass(frozen=True, eq=False)
class ConstraintFamily(ABC):
    """The constraint s f(u; x) <= slack . x + bound for every u of the domain and every sign s."""

    name: str  #: what is constrained; the certificate finds its formula by it
    slack: Array  #: of the right side: a variable such as the peak C; the bound is a number
    bound: float = 0.0
    signs: tuple[float, ...] = (1.0,)  #: the values of s: (1,), (-1,) or (1, -1) for a magnitude
    domain: tuple[float, float] = (-1.0, 1.0)  #: the least and the greatest u that count
    #: the family binds as an equation at a contact that it has, and nowhere else: a peak that is held up
    as_equation: bool = False
    #: what the rows have been divided by, a power of 2: certificates speak of them as they were
    unit: float = 1.0

    @property
    def continuable(self) -> bool:
        """Whether many laws at once are continued along their numbers with these rows."""
        return False

    @abstractmethod
    def jet(self, x: Array, u: Array, s: Array) -> RowJet:
        """Residuals s f - slack . x - bound of one law with their derivatives."""

    @abstractmethod
    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:
        """Second derivative by x of the sum of weights times f in one law; None where it is zero."""

    def same_rows(self, other: ConstraintFamily) -> bool:
        """Whether f is the same function of the variables and the place, of families of one kind."""
        common = {field.name for field in fields(ConstraintFamily)}
        return _same_fields(self, other, [field.name for field in fields(self) if field.name not in common])

    @abstractmethod
    def value(self, x: Array, u: Array) -> Array:
        """f at the points u."""

    @abstractmethod
    def stationary(self, x: Array) -> Array:
        """Points of [-1, 1] among which every stationary point of f is."""

    @abstractmethod
    def in_units(self, units: Array, unit: float) -> Self:
        """The family for variables x / units, divided by `unit`; coordinates are divided by `unit` too."""

    def scaled_down(self, by: float) -> Self:
        """The family divided by a power of 2, with the same variables."""
        if by == 1.0:
            return self
        return replace(self.in_units(np.ones(len(self.slack)), by), unit=self.unit * by)

    def nodes(self) -> Array | None:
        """First points of the family; None leaves the choice to the exchange method."""
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
        return 0.5 * (1.0 - u)

    def u(self, k: Array) -> Array:
        """The place that belongs to k."""
        return 1.0 - 2.0 * k

    def right_side(self, x: Array) -> float:
        """The right side of the row."""
        return float(self.slack @ x) + self.bound

    def extremes(self, x: Array) -> tuple[Array, Array, Array]:
        """Points, signs and residuals (positive where violated) at every end and stationary point."""
        low, high = self.domain
        if low == high:
            u = np.array([low])
        else:
            inner = self.stationary(x)
            inner = np.sort(inner[(inner > low + AT_END) & (inner < high - AT_END)])
            u = np.concatenate([[low], inner, [high]])
        value, room = self.value(x, u), self.right_side(x)
        signs = np.repeat(self.signs, len(u))
        return np.tile(u, len(self.signs)), signs, signs * np.tile(value, len(self.signs)) - room


class BatchFamily(ConstraintFamily):
    """A family that is evaluated for a batch of laws; one law is a batch of one.

    The places of the laws are rows of `u`, (laws, places), their variables and 1 rows of `point`.
    """

    @property
    def continuable(self) -> bool:
        """True, unless the function has kinks over the place."""
        return True

    @property
    def proving(self) -> bool:
        """Whether no law is beyond the planes, so that multipliers prove bounds."""
        return True

    @abstractmethod
    def planes(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """Planes that touch f and its derivative by the place, (laws, places, variables + 1); its second derivative.

        Of a family that is affine in the law they are the rows themselves.
        """

    @abstractmethod
    def rounding_errors(self, weights: Array, u: Array, point: Array) -> Array:
        """Rounding bounds of each entry of the sum of weights times planes, (laws, variables + 1)."""

    @abstractmethod
    def greatest(self, point: Array) -> Array:
        """The greatest of f, with the signs that count, in each law over the whole domain."""

    def jet(self, x: Array, u: Array, s: Array) -> RowJet:
        point = np.append(x, 1.0)
        planes, slopes, bend = self.planes(u[None], point[None])
        signs = s[:, None]
        rows, turned = signs * planes[0], signs * slopes[0]
        return RowJet(
            rows @ point - self.right_side(x), turned @ point, s * bend[0], rows[:, :-1] - self.slack, turned[:, :-1]
        )


def last_result(method: Callable[..., Result]) -> Callable[..., Result]:
    """A method of arrays that remembers its last result: slopes and second derivatives of one place come together."""
    name = f"_last_{method.__name__}"

    @wraps(method)
    def remembered(family: ConstraintFamily, *arrays: Array) -> Result:
        key = [(array.shape, array.tobytes()) for array in arrays]
        known = family.__dict__.get(name)
        if known is None or known[0] != key:
            known = family.__dict__[name] = key, method(family, *arrays)
        result: Result = known[1]
        return result

    return remembered


class NonlinearFamily(BatchFamily):
    """A batch family that is not affine in the law; a single law is a batch of one."""

    @abstractmethod
    def hessians(self, u: Array, point: Array, weights: Array) -> Array:
        """Second derivatives by the variables of the sum of weights times f."""

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:
        return np.asarray(self.hessians(u[None], np.append(x, 1.0)[None], weights[None])[0])


@dataclass(frozen=True, eq=False, kw_only=True)
class SeriesFamily(BatchFamily):
    """A family whose f consists of polynomials on pieces in u: one for each variable, that of the constant last."""

    table: PieceSeries

    @property
    def series(self) -> NDArray[Any]:
        """Chebyshev series in u, where there is one piece."""
        return np.asarray(self.table.series[0])

    def in_units(self, units: Array, unit: float) -> Self:
        """The functions and the right side in other units."""
        table = self.table.scaled(np.append(units, 1.0) / unit)
        return replace(self, table=table, slack=self.slack * units / unit, bound=self.bound / unit)

    def columns(self, u: Array) -> NDArray[Any]:
        """The functions with two derivatives by u, shape (3, points, variables + 1)."""
        return self.table.jets(u)


@dataclass(frozen=True, eq=False, kw_only=True)
class LinearFamily(SeriesFamily):
    """f is affine in x: the sum of the table's functions times the variables.

    Contacts at breaks are kinks and stay where they are.
    """

    jumps: bool = False  #: whether f may jump at breaks
    #: whether sqrt(1 - u), that is sqrt(2k), divides: b <= sqrt(2 D k) follows from b b' <= D
    root: bool = False
    mirrored: bool = False  #: whether it is written from the end of the interval: u = 2k - 1
    even: bool = False  #: whether f is even about k = 1/2, and written in u = 2 (1-2k)² - 1, of the k in [0, 1/2]

    @classmethod
    def of_row(
        cls, name: str, row: Array, bound: float, *, unit: float = 1.0, slack: Array | None = None
    ) -> LinearFamily:
        """The single row, row . x <= slack . x + bound, of which row and bound are divided by a unit."""
        table, slack = PieceSeries.whole(np.append(row / unit, 0.0)[None]), 0.0 * row if slack is None else slack
        return cls(name, slack, bound / unit, domain=(1.0, 1.0), unit=unit, table=table)

    def k(self, u: Array) -> Array:
        if self.even:
            return (1.0 - np.sqrt(np.maximum(u + 1.0, 0.0) / 2.0)) / 2.0
        return 0.5 * (1.0 + u) if self.mirrored else super().k(u)

    def u(self, k: Array) -> Array:
        if self.even:
            return 2.0 * (1.0 - 2.0 * k) ** 2 - 1.0
        return 2.0 * k - 1.0 if self.mirrored else super().u(k)

    @property
    def continuable(self) -> bool:
        """Whether it has one piece: contacts at kinks are neither fixed at an end nor free."""
        return len(self.table.series) == 1

    @kept_property
    def corners(self) -> Array:
        """The breaks; where f jumps there, the places just before and just after each."""
        return sides_of(self.table.breaks) if self.jumps else self.table.breaks

    def pinned(self, u: Array) -> NDArray[np.bool_]:
        """Whether u is a corner between pieces."""
        return super().pinned(u) if self.continuable else np.isin(u, self.corners)

    def nodes(self) -> Array | None:
        """Of pieces the corners, and inside each as many points as its degree, or fewer where they were too many."""
        if self.continuable:
            return None
        pieces = len(self.table.series)
        count = min(self.table.terms, max(_LEAST, _MOST // (pieces + 1)))
        local = nodes(count) if count > 2 else np.empty(0)
        places = np.concatenate([self.corners, *(self.table.global_places(i, local) for i in range(pieces))])
        return places[(places >= self.domain[0]) & (places <= self.domain[1])]

    def columns(self, u: Array) -> Array:
        """f's columns with two derivatives by u; under a root zero at k = 0, where the table has a zero."""
        jets = super().columns(u)
        if not self.root:
            return jets
        near = 1.0 - u < _END_OF_U
        left = np.where(near, 1.0, 1.0 - u)[:, None]
        g0, g1, g2 = jets
        rooted = np.stack([g0, g1 + g0 / (2.0 * left), g2 + g1 / left + 3.0 * g0 / (4.0 * left**2)])
        return np.asarray(np.where(near[:, None], 0.0, rooted / np.sqrt(left)))

    def rows(self, u: Array, s: Array) -> tuple[Array, Array]:
        """A and h of the rows A x <= h at the points u with signs s."""
        columns = self.columns(u)[0] * s[:, None]
        return columns[:, :-1] - self.slack, self.bound - columns[:, -1]

    def jet(self, x: Array, u: Array, s: Array) -> RowJet:
        """Residuals with their derivatives; of one law quicker than a batch of one."""
        columns = self.columns(u) * s[:, None]
        columns[0, :, :-1] -= self.slack
        value, slope, curvature = columns @ np.append(x, 1.0)
        return RowJet(value - self.bound, slope, curvature, columns[0, :, :-1], columns[1, :, :-1])

    def planes(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """The rows themselves, whatever the law."""
        if self.continuable and not self.root:
            return self.table.planes(u, point)
        columns = self.columns(u.reshape(-1)).reshape(3, *u.shape, -1)
        return columns[0], columns[1], np.einsum("mpi,mi->mp", columns[2], point)

    def hessian(self, x: Array, u: Array, weights: Array) -> Array | None:  # noqa: ARG002 - others need it
        """No Hessian (None), because f is affine."""
        return None

    @kept_property
    def rounding(self) -> Array:
        """Rounding bounds of each entry of a row."""
        return np.asarray(ROW_ROUNDING * np.abs(self.table.series).sum(axis=1).max(axis=0))

    def rounding_errors(self, weights: Array, u: Array, point: Array) -> Array:  # noqa: ARG002 - the same everywhere
        """Rounding bounds of rows at any place."""
        return np.asarray(weights.sum(axis=1)[:, None] * self.rounding)

    @kept_property
    def _over_domain(self) -> Array:
        """Chebyshev series over the domain of f's columns, or of what is above a bound where these are.

        Divided by a root that vanishes at its end f is a polynomial of that root.
        """
        low, high = self.domain
        count = self.table.terms
        if low == high:
            return np.asarray(self.columns(np.array([low]))[0])
        if self.root:
            count *= 2
            near, far = np.sqrt(1.0 - high), np.sqrt(1.0 - low)
            u = 1.0 - (near + (far - near) * (nodes(count) + 1.0) / 2.0) ** 2
        else:
            u = low + (high - low) * (nodes(count) + 1.0) / 2.0
        return np.asarray(from_values(self.columns(u)[0]))

    def greatest(self, point: Array) -> Array:
        """The greatest of f in each law, where it has one piece."""
        return greatest(point @ self._over_domain.T, self.signs)

    def value(self, x: Array, u: Array) -> Array:
        point = np.append(x, 1.0)
        return np.asarray(self.columns(u)[0] @ point) if self.root else self.table.function(point, u)

    def stationary(self, x: Array) -> Array:
        """Roots of the derivative, and the corners that may be extrema."""
        return self._stationary(np.append(x, 1.0))

    @last_result
    def _stationary(self, point: Array) -> Array:
        """The same, remembered for repeated calls in a round."""
        series = self.table.series @ point
        if self.root:
            return np.concatenate([self.corners, *self.table.roots(self.table.slopes_over_root(series))])
        return self.table.stationary(series, self.corners, jumps=self.jumps)


@dataclass(frozen=True, eq=False, kw_only=True)
class ProductFamily(NonlinearFamily):
    """f = g h, g and h affine in x: the power d = b c, which is not convex in x."""

    first: LinearFamily
    second: LinearFamily

    def scaled_down(self, by: float) -> Self:
        first = self.first.scaled_down(by)
        return replace(self, first=first, slack=self.slack / by, bound=self.bound / by, unit=self.unit * by)

    def in_units(self, units: Array, unit: float) -> Self:
        """Both factors in other units, and so the right side by the square."""
        first, second = (factor.in_units(units, unit) for factor in (self.first, self.second))
        square = unit * unit
        return replace(self, first=first, second=second, slack=self.slack * units / square, bound=self.bound / square)

    @property
    def continuable(self) -> bool:
        """Whether its factors have no pieces."""
        return self.second.continuable

    def nodes(self) -> Array | None:
        """Those of the acceleration."""
        return self.second.nodes()

    def pinned(self, u: Array) -> NDArray[np.bool_]:
        """Whether u is a corner between pieces."""
        return self.second.pinned(u)

    @property
    def proving(self) -> bool:
        """False: a plane that touches a power proves nothing."""
        return False

    def planes(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """Planes by the product rule."""
        g, h = self._columns(u)
        (g0, g1, g2), (h0, h1, h2) = g @ point[:, :, None], h @ point[:, :, None]
        value = h0 * g[0] + g0 * h[0]
        value[:, :, -1:] -= g0 * h0
        slope = h0 * g[1] + h1 * g[0] + g0 * h[1] + g1 * h[0]
        slope[:, :, -1:] -= g1 * h0 + g0 * h1
        return value, slope, (g2 * h0 + 2.0 * g1 * h1 + g0 * h2)[:, :, 0]

    @last_result
    def _columns(self, u: Array) -> list[Array]:
        """The columns of both factors with two derivatives by the place."""
        return [factor.columns(u.reshape(-1)).reshape(3, *u.shape, -1) for factor in (self.first, self.second)]

    def hessians(self, u: Array, point: Array, weights: Array) -> Array:  # noqa: ARG002 - what others of its kind need
        """The weighted sum of products of the factors' rows, as second derivatives."""
        g, h = (columns[0, :, :, :-1] for columns in self._columns(u))
        half = np.matmul((g * weights[:, :, None]).transpose(0, 2, 1), h)
        return np.asarray(half + half.transpose(0, 2, 1))

    def rounding_errors(self, weights: Array, u: Array, point: Array) -> Array:
        """Rounding bounds of the rows of both factors."""
        return np.asarray(sum(factor.rounding_errors(weights, u, point) for factor in (self.first, self.second)))

    def greatest(self, point: Array) -> Array:
        """The greatest magnitude of f in each law over the whole interval."""
        return power_peaks(*(point @ factor.series.T for factor in (self.first, self.second)))

    def value(self, x: Array, u: Array) -> Array:
        """G h at the points u, each evaluated by itself."""
        return self.first.value(x, u) * self.second.value(x, u)

    def stationary(self, x: Array) -> Array:
        """Roots of the slope, and the corners that may be extrema."""
        point, table = np.append(x, 1.0), self.second.table
        factors = (self.first.table.series @ point, table.series @ point)
        both = np.stack([product(*pair) for pair in zip(*factors, strict=True)])
        return table.stationary(both, self.second.corners, jumps=self.second.jumps)


@dataclass(frozen=True, eq=False, kw_only=True)
class WholeLawFamily(NonlinearFamily):
    """A family for a single number of the whole law, such as a norm or an integral; u is always 1."""

    domain: tuple[float, float] = (1.0, 1.0)

    def value(self, x: Array, u: Array) -> Array:
        return np.full(len(u), self.greatest(np.append(x, 1.0)[None])[0])

    def stationary(self, x: Array) -> Array:  # noqa: ARG002 - what others of its kind need
        """No places: there are none."""
        return np.empty(0)


@dataclass(frozen=True, eq=False, kw_only=True)
class NormFamily(WholeLawFamily):
    """f is the Euclidean norm of an affine map of x: the RMS of c or j."""

    matrix: Array

    def in_units(self, units: Array, unit: float) -> Self:
        """The map's columns and the right side in other units."""
        matrix = self.matrix * np.append(units, 1.0) / unit
        return replace(self, matrix=matrix, slack=self.slack * units / unit, bound=self.bound / unit)

    def planes(self, u: Array, point: Array) -> tuple[Array, Array, Array]:
        """Planes by the direction of each law; the norm of no law is below them."""
        planes = self._touching(point)[1][:, None, :].repeat(u.shape[1], axis=1)
        return planes, np.zeros(planes.shape), np.zeros(u.shape)

    @last_result
    def _touching(self, point: Array) -> tuple[Array, Array]:
        """The norm of each law, and the plane that touches it there."""
        image = point @ self.matrix.T
        size = np.maximum(np.sqrt((image * image).sum(axis=1)), _NO_NORM)
        return size, (image / size[:, None]) @ self.matrix

    def hessians(self, u: Array, point: Array, weights: Array) -> Array:  # noqa: ARG002 - it has no place
        size, shown = self._touching(point)
        rows, matrix = shown[:, :-1], self.matrix[:, :-1]
        bent = matrix.T @ matrix - rows[:, :, None] * rows[:, None, :]
        return np.asarray(bent * (weights.sum(axis=1) / size)[:, None, None])

    def rounding_errors(self, weights: Array, u: Array, point: Array) -> Array:  # noqa: ARG002 - it has no place
        """The rounding hidden in a unit vector times the matrix."""
        errors = len(self.matrix) * ROW_ROUNDING * np.abs(self.matrix).sum(axis=0)
        return np.asarray(weights.sum(axis=1)[:, None] * errors)

    def greatest(self, point: Array) -> Array:
        return self._touching(point)[0]


@dataclass(frozen=True, eq=False)
class Points:
    """Points of one family: positions u and signs s."""

    u: Array
    s: Array

    def joined(self, other: Points) -> Points:
        """The union of these points and others."""
        return Points(np.concatenate([self.u, other.u]), np.concatenate([self.s, other.s]))


@dataclass(frozen=True, eq=False)
class Program:
    """Minimise objective . x subject to families and equations: equalities . x = right; all in units near its size."""

    #: divided by powers of 2, as all else is, so that tolerances are shares of what things are
    families: tuple[ConstraintFamily, ...]
    equalities: Array
    right: Array
    objective: Array
    unit: float = 1.0  #: what the objective has been divided by
    equation_units: Array | None = None  #: what each equation has been divided by; None where none was

    @property
    def _units(self) -> Array:
        return np.ones(len(self.right)) if self.equation_units is None else self.equation_units

    def multipliers_of_equations(self, stated: Sequence[float]) -> Array:
        """The program's multipliers, from the multipliers of the problem's equations and objective."""
        units = self._units
        return np.array(stated[: len(units)], dtype=np.float64) * units[: len(stated)] / self.unit

    def stated_multipliers(self, equations: Array) -> Array:
        """The multipliers of the equations as the problem has them, from the program's own."""
        return np.asarray(equations * self.unit / self._units)

    @property
    def size(self) -> int:
        return len(self.objective)

    @property
    def curved(self) -> bool:
        """Whether a family is not affine in x."""
        return not all(isinstance(family, LinearFamily) for family in self.families)

    def objective_at(self, x: Array) -> float:
        """The objective at the variables x."""
        return float(self.objective @ x)

    def violation(self, x: Array) -> float:
        """Largest residual over every family and every u."""
        binding = [family for family in self.families if not family.as_equation]
        return max((float(family.extremes(x)[2].max()) for family in binding), default=0.0)


def _same(first: Any, other: Any) -> bool:
    if first is other:
        return True
    if isinstance(first, ConstraintFamily):
        return first.same_rows(other)
    if isinstance(first, PieceSeries):
        return _same_fields(first, other, [field.name for field in fields(first)])
    if isinstance(first, tuple):
        return len(first) == len(other) and all(map(_same, first, other))
    return np.array_equal(first, other) if isinstance(first, np.ndarray) else bool(first == other)


def _same_fields(first: object, other: object, names: Sequence[str]) -> bool:
    return type(first) is type(other) and all(_same(getattr(first, name), getattr(other, name)) for name in names)
