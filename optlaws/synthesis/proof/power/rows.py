"""Rows that every law in a box obeys if its objective is below a claim: |b c| <= D made linear, and formulas.

A box bounds the velocity at as many places as the laws have coordinates, so it bounds every linear function of the
law. Where it keeps b from zero, between L and U, the power's bound c <= D/b has a chord: 1/b <= 1/L + 1/U - b/(L U).

In a box the law's derivatives at a place lie between two values each. From the middle of these, and from each of their
corners, a formula that is not convex is nowhere below its tangent plane less what its second derivatives, enclosed over
them all, can take away (Taylor's formula with Lagrange's remainder). As a box shrinks that falls with the square of its
width.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement, product
from math import inf, isfinite, sqrt

import numpy as np

from optlaws.formulas.convexity import Endpoints, enclosed
from optlaws.formulas.tree import ORDERS
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.synthesis.families import names
from optlaws.synthesis.families.curved import CurvedFamily, IntegralFamily
from optlaws.synthesis.families.family import ConstraintFamily, ProductFamily
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.problem.constants import D, Functional, PeakConstant
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.duality import Sublevel
from optlaws.synthesis.proof.power import shared_energy
from optlaws.synthesis.proof.power.box import Box, BoxRows, Places
from optlaws.synthesis.spaces.of_basis import PolynomialSpace
from optlaws.tolerances import AWAY_FROM_REST, BENEATH_ROUNDING, TINY

#: constants whose bound is one of a derivative's magnitude everywhere
PEAKS = {"b": "B", "c": "C", "j": "J"}
#: where a plane touches
Way = tuple[int, ...] | None

_MOST_CORNERS = 8


def applies_to_formulas(problem: Problem) -> bool:
    """Whether boxes bound the problem's formulas: polynomials whose velocities some constant bounds."""
    model = model_of(problem)
    known = isinstance(model.space, PolynomialSpace) and model.space.order > 1
    families = model.program.families
    # of an integral that is not convex nothing is known in a box
    if any(isinstance(family, IntegralFamily) and not family.convex for family in families):
        return False
    if not known or not any(map(_bent, families)):
        return False
    return bool(np.isfinite(_own_sides(model, 1.0)).all()) and "B" in _greatest(model, 1.0)


def _own_names(model: Model) -> list[str]:
    return sorted(model.places, key=model.places.__getitem__)


def _bent(family: ConstraintFamily) -> bool:
    """Whether some sign of a family's rows bounds no convex set."""
    return isinstance(family, CurvedFamily) and any(sign not in family.tangents for sign in family.signs)


def _greatest(model: Model, claim: float) -> dict[str, float]:
    """Greatest values of the constants in laws below the claim, with a bound of |b|."""
    sublevel = Sublevel.of(model)
    bounds = sublevel.greatest_values(claim)
    bounds["B"] = min(bounds.get("B", inf), sublevel.greatest_velocity(bounds))
    return {name: bound for name, bound in bounds.items() if isfinite(bound)}


def _own_sides(model: Model, claim: float) -> Array:
    """Least and greatest values of the program's own variables, in their order, a row each."""
    constants = {leaf.name: leaf for _, leaf in leaves(model.problem.objective) if isinstance(leaf, Functional)}
    greatest, limits = _greatest(model, claim), model.problem.range("B")
    sides = []
    for name in _own_names(model):
        least = constants[name].floor(model.space.boundary) if name in constants else -inf
        if name == "B":
            least = limits.low if limits is not None else 0.0
        sides.append((least, greatest.get(name, inf)))
    return np.array(sides, dtype=np.float64).reshape(-1, 2)


@dataclass(frozen=True, eq=False)
class Plane:
    """Tangent planes that underestimate sign times a family's formula, less the curvature allowance."""

    #: family, sign: the rows of a formula
    family: CurvedFamily
    sign: float
    way: Way  #: None for the middle of the ranges; for a corner -1 or 1 by which end of each

    def touching(self, low: Array, high: Array) -> Array:
        """The derivatives there, from their least and greatest values; shape (names, places) each."""
        if self.way is None:
            return np.asarray((low + high) / 2.0)
        return np.where(np.array(self.way)[:, None] > 0, high, low)

    def taken(self, low: Array, high: Array, k: Array) -> Array:
        """The greatest curvature term within the ranges, by which the plane is lowered."""
        taken = np.zeros(k.shape)
        if self.sign in self.family.tangents:
            return taken
        within = {name: Endpoints(*ends) for name, *ends in zip(self.family.names, low, high, strict=True)}
        within["k"] = Endpoints(k, k)
        reach = (high - low) / (2.0 if self.way is None else 1.0)
        for i, j in combinations_with_replacement(range(len(reach)), 2):
            bend = enclosed(self.family.slopes.second(i, j), within)
            least, most = (bend.low, bend.high) if self.sign > 0.0 else (-bend.high, -bend.low)
            if i == j:
                worst = 0.5 * np.maximum(-least, 0.0)
            elif self.way is None:
                worst = np.maximum(np.abs(least), np.abs(most))
            else:
                worst = np.maximum(-least if self.way[i] == self.way[j] else most, 0.0)
            taken = taken + np.where(worst == 0.0, 0.0, worst * reach[i] * reach[j])
        return taken


class FormulaRows(BoxRows):
    """Rows of a problem with peaks of formulas, where `applies_to_formulas` is true; parameters as for `BoxRows`."""

    def __init__(self, problem: Problem, claim: float, points: Sequence[float]) -> None:
        super().__init__(problem, claim, points)
        self.greatest = _greatest(self.model, claim)
        families = self.model.program.families
        self.families = [family for family in families if isinstance(family, CurvedFamily)]
        self._orders = sorted({ORDERS[name] for family in self.families for name in family.names})
        self._laws = {nu: self.space.derivative(nu, "", np.zeros(self.variables)) for nu in self._orders}

    def root(self) -> Box:
        low, high = self.brackets_at(self.points)
        sides = _own_sides(self.model, self.claim)
        return Box(np.append(low, sides[:, 0]), np.append(high, sides[:, 1]))

    def brackets_at(self, k: Array) -> tuple[Array, Array]:
        """Least and greatest velocity at the places k: the peak's, and the bounds by C from the ends."""
        low, high = np.full(k.shape, -self.greatest["B"]), np.full(k.shape, self.greatest["B"])
        if self.problem.monotone:
            low = np.maximum(low, 0.0)
        start = self.space.start_velocity
        for place, velocity in ((0.0, start), (1.0, start + self.space.velocity_change)):
            away = np.abs(k - place)
            reach = np.where(away > 0.0, self.greatest.get("C", inf) * np.maximum(away, TINY), 0.0)
            low, high = np.maximum(low, velocity - reach), np.minimum(high, velocity + reach)
        return low, high

    def is_curved(self, family: ConstraintFamily) -> bool:
        return isinstance(family, CurvedFamily)

    @kept_property
    def _planes(self) -> dict[tuple[str, float], Plane]:
        """Planes by the names and the signs of their rows."""
        planes = {}
        for family in self.families:
            ways: list[Way] = [None]
            if _bent(family) and 2 ** len(family.names) <= _MOST_CORNERS:
                ways += list(product((-1, 1), repeat=len(family.names)))
            for (i, way), sign in product(enumerate(ways), family.signs):
                planes[names.plane(i, family.name), sign] = Plane(family, sign, way)
        return planes

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all possible planes."""
        return tuple(dict.fromkeys(name for name, _ in self._planes))

    def kinds(self, box: Box) -> list[tuple[str, float]]:
        """The names of all planes with their signs."""
        del box
        return list(self._planes)

    def places(self, k: Array) -> Places:
        """Rows of the derivatives that are in the formulas."""
        rows = (self.mapped(np.asarray(law.columns(law.u(k))[0])) for law in self._laws.values())
        return Places(k, tuple(rows))

    def curved(self, box: Box, places: Places, name: str, signs: Array) -> Array:
        """Planes of a name; zeros outside the formula's part and where it has no value."""
        rows = dict(zip(self._orders, places.rows, strict=True))
        curved = np.zeros((len(places.k), self.size + 1))
        for sign in np.unique(signs).tolist():
            plane = self._planes.get((name, sign))
            if plane is None:
                continue
            u = plane.family.u(places.k)
            mine = (signs == sign) & (u >= plane.family.domain[0]) & (u <= plane.family.domain[1])
            if mine.any():
                parts = np.stack([rows[ORDERS[part]][mine] for part in plane.family.names])
                curved[mine] = self._rows(box, plane, places.k[mine], parts)
        return curved

    def _rows(self, box: Box, plane: Plane, k: Array, parts: Array) -> Array:
        family, sign = plane.family, plane.sign
        low, high = self._ranges(box, family.names, parts, k)
        touch = plane.touching(low, high)
        with np.errstate(all="ignore"):
            values = {**dict(zip(family.names, touch, strict=True)), "k": k}
            value, gradient = family.slopes.value_and_gradient(values)
            gradient = gradient[:-1]
            row = np.einsum("ip,ipn->pn", sign * gradient, parts)
            size = np.abs(value) + (np.abs(gradient) * np.maximum(np.abs(low), np.abs(high))).sum(axis=0)
            row[:, -1] += (
                sign * (value - (gradient * touch).sum(axis=0)) - plane.taken(low, high, k) - BENEATH_ROUNDING * size
            )
            row -= self._room(family)
        return np.where(np.isfinite(row).all(axis=1)[:, None], row, 0.0)

    def _room(self, family: CurvedFamily) -> Array:
        row: Array = self.mapped(np.append(family.slack, family.bound)[None])[0]
        return row

    def _ranges(self, box: Box, parts_of: Sequence[str], parts: Array, k: Array) -> tuple[Array, Array]:
        """Least and greatest values of the derivatives at the places k of the laws in a box."""
        lows, highs = [], []
        for name, rows in zip(parts_of, parts, strict=True):
            low, high = box.extent(rows)
            if name == "b":
                least, most = self.brackets_at(k)
            else:
                most = np.full(k.shape, self.greatest.get(PEAKS.get(name, ""), inf))
                least = -most
            lows.append(np.maximum(low, least))
            highs.append(np.minimum(high, most))
        return np.array(lows), np.array(highs)


POWER_ROWS = (RowName.POWER, RowName.POWER_FROM_LEAST)


def applies(problem: Problem) -> bool:
    """Whether the power of the problem's laws can be bounded by boxes: polynomials whose end velocities are given."""
    model = model_of(problem)
    # a peak of one sign may be below 0 where the velocity changes from end to end, and boxes begin at 0
    one_sided = any(isinstance(leaf, PeakConstant) and len(leaf.signs) == 1 for _, leaf in leaves(problem.objective))
    if one_sided and problem.boundary is not None:
        return False
    known = isinstance(model.space, PolynomialSpace) and model.space.order > 1
    return known and isfinite(greatest(model, 1.0).get("D", inf))


def greatest(model: Model, claim: float) -> dict[str, float]:
    """Greatest values of the constants in a law whose objective is below the claim."""
    bounds = Sublevel.of(model).greatest_values(claim)
    if "D" in bounds:
        ends = (model.space.start_velocity, model.space.start_velocity + model.space.velocity_change)
        bounds["B"] = min(bounds.get("B", inf), sqrt(max(map(abs, ends)) ** 2 + bounds["D"]))
    return bounds


class PowerRows(BoxRows):
    """The rows of a problem with D, where `applies` is true; parameters as for `BoxRows`."""

    def __init__(self, problem: Problem, claim: float, points: Sequence[float]) -> None:
        super().__init__(problem, claim, points)
        self.greatest = greatest(self.model, claim)
        self.place = self.model.places.get("D")
        self.anchors = self._anchors()

    @property
    def tightens(self) -> bool:
        """The chords of the power's bound are."""
        return True

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the rows by the greatest and by the least D of a box."""
        return POWER_ROWS

    @property
    def branched(self) -> list[int]:
        """D, where it is minimised with others."""
        alone = [leaf for _, leaf in leaves(self.problem.objective)] == [D]
        return [] if self.place is None or alone else [self.place]

    def is_curved(self, family: ConstraintFamily) -> bool:
        return isinstance(family, ProductFamily)

    def kinds(self, box: Box) -> list[tuple[str, float]]:
        """Both signs of each curved row; the second row applies only if D has a lower bound."""
        names = POWER_ROWS if self.place is not None and box.low[self.place] > 0.0 else POWER_ROWS[:1]
        return [(name, sign) for name in names for sign in (1.0, -1.0)]

    def places(self, k: Array) -> Places:
        """Rows of b and c."""
        return Places(k, (self.derivative(1, k), self.derivative(2, k)))

    def curved(self, box: Box, places: Places, name: str, signs: Array) -> Array:
        """The rows of the power in a box, for places and signs."""
        velocity, acceleration = places.rows
        return self.power(box, (places.k, velocity, acceleration), signs, least=name == RowName.POWER_FROM_LEAST)

    def _anchors(self) -> Anchors:
        ends = self.space.start_velocity, self.space.start_velocity + self.space.velocity_change
        anchors = Anchors(np.array([0.0, 1.0]), np.array(ends), np.array(ends))
        limits, peak = self.problem.range("B"), self.problem.peak_at
        if limits is not None and limits.low > 0.0 and peak is not None:
            anchors = anchors.joined(np.array([peak]), np.array([limits.low]), np.array([self.greatest["B"]]))
        return anchors

    def root(self) -> Box:
        low, high = self.brackets_at(self.points)
        others = sorted(self.model.places, key=self.model.places.__getitem__)
        limits = self.problem.range("B")
        least = [limits.low if name == "B" and limits is not None else 0.0 for name in others]
        return Box(np.append(low, least), np.append(high, [self.greatest[name] for name in others]))

    def brackets_at(self, k: Array) -> tuple[Array, Array]:
        return self._everywhere(self.anchors, k)

    def _everywhere(self, anchors: Anchors, k: Array) -> tuple[Array, Array]:
        low, high = velocity_brackets(anchors, self.greatest["D"], k)
        if self.problem.monotone:
            low = np.maximum(low, 0.0)
        return low, np.minimum(high, self.greatest["B"])

    def brackets(self, box: Box, k: Array, velocity: Array) -> tuple[Array, Array]:
        """Least and greatest velocity at the places k of the laws in the box."""
        inside = self.anchors.joined(self.points, box.low[: self.terms], box.high[: self.terms])
        low, high = self._everywhere(inside, k)
        least, most = box.extent(velocity)
        return np.maximum(low, least), np.minimum(high, most)

    def power(self, box: Box, rows: tuple[Array, Array, Array], signs: Array, *, least: bool = False) -> Array:
        """Rows s c <= D/|b| by the chord of 1/|b|, at places k given with the rows of b and c there.

        Where D is a variable, D/|b| is bounded from its greatest value or from its least one. A row of zeros where
        the box does not keep b from zero.
        """
        k, velocity, acceleration = rows
        low, high = self.brackets(box, k, velocity)
        forth = np.where(high < -AWAY_FROM_REST, -1.0, 1.0)
        near, far = np.where(forth > 0.0, low, -high), np.where(forth > 0.0, high, -low)
        away = (near > AWAY_FROM_REST) & (far >= near)
        near, far = np.where(away, near, 1.0), np.where(away, far, 1.0)
        most = self.greatest["D"] if self.place is None else (box.low if least else box.high)[self.place]
        bounding = signs[:, None] * acceleration + (most / (near * far) * forth)[:, None] * velocity
        if self.place is None:
            bounding[:, -1] -= most / near + most / far
        else:
            other = near if least else far
            bounding[:, self.place] -= 1.0 / other
            bounding[:, -1] -= most / near + most / far - most / other
        return np.where(away[:, None], bounding, 0.0)


@dataclass(frozen=True, eq=False)
class Anchors:
    """Places k at which the velocity is known to lie between two values."""

    k: Array
    low: Array
    high: Array

    def joined(self, k: Array, low: Array, high: Array) -> Anchors:
        """The anchors with more of them joined."""
        return Anchors(*(np.concatenate(pair) for pair in ((self.k, k), (self.low, low), (self.high, high))))


def velocity_brackets(anchors: Anchors, D: float, k: Array) -> tuple[Array, Array]:
    """Least and greatest velocity at the places k of a law with peak power D (dimensionless).

    >>> rest = Anchors(np.array([0.0]), np.zeros(1), np.zeros(1))
    >>> velocity_brackets(rest, 2.0, np.array([0.25]))[1].tolist()
    [1.0]
    """
    change = 2.0 * D * np.abs(k[:, None] - anchors.k)
    low = _signed_root(anchors.low * np.abs(anchors.low) - change).max(axis=1)
    high = _signed_root(anchors.high * np.abs(anchors.high) + change).min(axis=1)
    return low, high


def _signed_root(square: Array) -> Array:
    root: Array = np.copysign(np.sqrt(np.abs(square)), square)
    return root


_KINDS = (
    (shared_energy.applies, shared_energy.EnergyRows),
    (applies, PowerRows),
    (applies_to_formulas, FormulaRows),
)


def rows_of(problem: Problem, claim: float, points: Sequence[float]) -> BoxRows | None:
    """The rows of a problem under a claim; None where nothing of it can be bounded by boxes."""
    return next((kind(problem, claim, points) for fits, kind in _KINDS if fits(problem)), None)
