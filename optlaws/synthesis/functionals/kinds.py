"""Constants made of a formula: its peak, its root mean square, its value at a place."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.of_motion import Motion
from optlaws.laws import MotionLaw
from optlaws.synthesis.families.family import Family, LinearFamily, NormFamily
from optlaws.synthesis.functionals.affine_rows import columns, gauss, rows, sides
from optlaws.synthesis.functionals.along_law import extremes_along, mean_square_along, value_along
from optlaws.synthesis.functionals.sizes import known_values, reach
from optlaws.synthesis.problem.constants import Functional

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
    from optlaws.synthesis.spaces.space import LawSpace

Array = NDArray[np.float64]

_BOTH = (1.0, -1.0)
_ROUNDED = 1e-12


@dataclass(frozen=True, repr=False)
class OfFormula(Functional):
    """A constant made of a formula of the motion.

    Attributes
    ----------
    motion
        The formula, and over which part of the interval.
    """

    motion: Motion

    @property
    def why(self) -> str:
        """The rule that says whether the constant is convex."""
        return self.motion.verdict.why

    def parts(self, *, symmetric: bool) -> tuple[Motion, ...]:
        """The formula, or of symmetric laws what says the same on the first half."""
        return self.motion.halves() if symmetric else (self.motion,)

    def sizes(self, space: LawSpace) -> tuple[tuple[int, float, float], ...]:
        """A bound of the law's size, kept for the space."""
        kept = space.cached(("size", self.name), lambda: np.array(self._size(space) or ()))
        return ((int(kept[0]), float(kept[1]), float(kept[2])),) if len(kept) else ()

    def _size(self, space: LawSpace) -> tuple[int, float, float] | None:  # noqa: ARG002
        """An order, a factor and an offset; None where the constant does not bound the law."""
        return None

    @abstractmethod
    def value(self, law: MotionLaw) -> float:
        """The constant of a law, recomputed over the whole part."""

    @abstractmethod
    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[Family, ...]:
        """Rows that hold if and only if the constant is at most slack . x + bound."""


@dataclass(frozen=True, repr=False)
class FormulaPeak(OfFormula):
    """Peak of a formula: magnitude, or one sign only; made by `peak`."""

    signs: tuple[float, ...] = _BOTH

    def floor(self, conditions: BoundaryConditions) -> float:
        """A peak of one sign may be below 0; what the end conditions say of the formula it is not below."""
        if len(self.signs) == 2:
            return 0.0
        return max(low for _, low in self._known(conditions)) if self._known(conditions) else -np.inf

    def _known(self, conditions: BoundaryConditions) -> list[tuple[float, float]]:
        """What the formula, times the sign, is at the ends and in the mean, with what it is no less than rounded."""
        [sign] = self.signs
        return [(sign * one, sign * one - _ROUNDED * size) for one, size in known_values(self.motion, conditions)]

    def value(self, law: MotionLaw) -> float:
        """The peak over the whole part."""
        lowest, highest = extremes_along(self.motion, law)
        return max(highest.value if sign > 0.0 else -lowest.value for sign in self.signs)

    def _size(self, space: LawSpace) -> tuple[int, float, float] | None:
        """Of a peak of one sign only if some mean of the formula is the same in every law."""
        found = reach(space, self.parts(symmetric=space.symmetric)) if self.motion.start < self.motion.stop else None
        if found is None:
            return None
        return found.by_peak() if len(self.signs) == 2 else found.by_one_sign(self.signs[0])

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[Family, ...]:
        """One family; two where symmetric laws count on half the interval but the formula is not symmetric."""
        found = sides(self.motion, self.name, self.signs, symmetric=space.symmetric)
        return tuple(rows(space, side, slack, bound) for side in found)


@dataclass(frozen=True, repr=False)
class FormulaRms(OfFormula):
    """Root mean square of a formula over its part of the interval; made by `rms`."""

    def value(self, law: MotionLaw) -> float:
        """The root of the mean square, by Gauss's rule, exact where the formula is a polynomial of k."""
        length = self.motion.stop - self.motion.start
        return float(np.sqrt(mean_square_along(self.motion, law) / length))

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[Family, ...]:
        """A norm of the coordinates."""
        matrix = np.vstack([self._roots(space, half) for half in self.parts(symmetric=space.symmetric)])
        return (NormFamily(self.name, slack, bound, matrix=space.widened(matrix, len(slack))),)

    def _size(self, space: LawSpace) -> tuple[int, float, float] | None:
        """By Cauchy's inequality."""
        found = reach(space, self.parts(symmetric=space.symmetric))
        if found is None:
            return None
        order, factor, offset = found.by_square()
        return order, factor * float(np.sqrt(self.motion.stop - self.motion.start)), offset

    def _roots(self, space: LawSpace, motion: Motion) -> Array:
        u, weights = gauss(space, motion)
        share = weights / (self.motion.stop - self.motion.start)
        return np.sqrt(share)[:, None] * columns(space, motion, u)


@dataclass(frozen=True, repr=False)
class FormulaValue(OfFormula):
    """Value of a formula at one k; made by `value`."""

    def floor(self, conditions: BoundaryConditions) -> float:  # noqa: ARG002
        """A value may be below 0."""
        return -np.inf

    def value(self, law: MotionLaw) -> float:
        """The value."""
        return value_along(self.motion, law)

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[Family, ...]:
        """One row."""
        [motion] = self.parts(symmetric=space.symmetric)
        row = space.widened(columns(space, motion, np.array([1.0 - 2.0 * motion.start])), len(slack))
        return (LinearFamily(self.name, slack, bound, (1.0,), (1.0, 1.0), series=row),)
