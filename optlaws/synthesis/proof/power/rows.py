"""Rows that every law in a box obeys if its objective is below a claim: |b c| <= D made linear.

A box bounds the velocity at as many places as the laws have coordinates, so it bounds every linear function of the
law. Where it keeps b from zero, between L and U, the power's bound c <= D/b has a chord: 1/b <= 1/L + 1/U - b/(L U).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isfinite, sqrt

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.family import ConstraintFamily, ProductFamily
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.problem.constants import D, PeakConstant
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.duality import Sublevel
from optlaws.synthesis.proof.power import formula_underestimators, shared_energy
from optlaws.synthesis.proof.power.box import Box, BoxRows, Places
from optlaws.synthesis.spaces.of_basis import PolynomialSpace
from optlaws.tolerances import AWAY_FROM_REST

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
    (formula_underestimators.applies, formula_underestimators.FormulaRows),
)


def rows_of(problem: Problem, claim: float, points: Sequence[float]) -> BoxRows | None:
    """The rows of a problem under a claim; None where nothing of it can be bounded by boxes."""
    return next((kind(problem, claim, points) for fits, kind in _KINDS if fits(problem)), None)
