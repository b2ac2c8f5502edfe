"""Constants from a formula: its peak, its root mean square, its integral, its value at a place."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import TYPE_CHECKING

import numpy as np

from optlaws.echo import cut
from optlaws.formulas.branches import smooth
from optlaws.formulas.convexity import Judge
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.tree import ORDERS, Negative
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.numbers import Array, power_of_two
from optlaws.synthesis.families import names
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily
from optlaws.synthesis.families.piece_series import widened
from optlaws.synthesis.functionals.affine_rows import columns, gauss, rows, sampled, sides
from optlaws.synthesis.functionals.along_law import extremes_along, integral_along, value_along
from optlaws.synthesis.functionals.curved_rows import (
    Boxes,
    Branch,
    branch_rows,
    envelopes,
    integral_rows,
    split,
    squared,
)
from optlaws.synthesis.functionals.sizes import known_values, size_bounds
from optlaws.synthesis.functionals.undefined import check_ends, check_passed, pitfalls
from optlaws.synthesis.problem.constants import Functional, ProblemView
from optlaws.synthesis.problem.ranges import as_range
from optlaws.tolerances import VALUE_ROUNDING

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
    from optlaws.synthesis.spaces.space import LawSpace

_SHOWN = 200  # letters of a formula in an error


@dataclass(frozen=True, repr=False)
class OfFormula(Functional):
    """A constant from a formula of the motion."""

    motion: MotionFormula  #: the formula, and over which part of the interval

    @property
    def scale(self) -> float:
        return self.motion.scale

    @property
    def why(self) -> str:
        """The rule that decides whether the constant is convex."""
        return self.motion.verdict.why

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks on places where the formula has no value or no slope in some law."""
        return tuple(pitfalls(self.motion))

    @kept_property
    def even(self) -> bool:
        """Whether the formula is even or, where its sign does not count, odd about the middle of the interval."""
        mirrored = self.motion.mirrored()
        if (mirrored.start, mirrored.stop) != (self.motion.start, self.motion.stop):
            return False
        here, there = sampled(self.motion), sampled(mirrored)
        size = VALUE_ROUNDING * float(np.abs(here).max())
        with np.errstate(invalid="ignore"):
            apart = [float(np.abs(here - sign * there).max()) for sign in (1.0, -1.0)[: 1 + self.of_magnitude]]
        # where it has no value nothing is known of it
        return not min(apart) > size

    @property
    def of_magnitude(self) -> bool:
        """Whether the formula's sign does not count."""
        return False

    @property
    def affine(self) -> bool:
        return self.motion.affine is not None

    @kept_property
    def sign(self) -> int:
        """1 where the formula is nonnegative for every law, -1 where nonpositive, 0 where neither is known."""
        return Judge(frozenset(ORDERS), self.motion.start, self.motion.stop).sign(self.motion.formula)

    def parts(self, *, symmetric: bool) -> tuple[MotionFormula, ...]:
        """The formula, or for symmetric laws equivalent formulas on the first half."""
        return self.motion.halves() if symmetric else (self.motion,)

    def sizes(self, space: LawSpace) -> tuple[tuple[int, float, float], ...]:
        return size_bounds(self, space)

    def convex_families(
        self, space: LawSpace, slack: Array, bound: float, problem: ProblemView
    ) -> tuple[ConstraintFamily, ...]:
        """The rows themselves where they are convex; else rows of convex lower bounds, and a bound of the constant."""
        if self.convex:
            return self.families(space, slack, bound)
        floor = self.floor(space.boundary)
        beneath = self.beneath(boxes_of(problem), symmetric=space.symmetric)
        families = tuple(branch_rows(space, branch, slack, bound) for branch in beneath)
        if isfinite(floor) and slack.any():
            return (*families, LinearFamily.of_row(names.at_least(self.name), -slack, -floor))
        return families

    def branches(self, *, symmetric: bool) -> list[Branch]:  # noqa: ARG002 - what others of its kind need
        """The smooth formulas whose rows hold the constant; none where other rows do."""
        return []

    def beneath(self, boxes: Boxes, *, symmetric: bool) -> list[Branch]:  # noqa: ARG002 - what others of its kind need
        """Convex lower bounds of the constant's formula while derivatives are in their boxes."""
        return []

    def floor(self, conditions: BoundaryConditions) -> float:  # noqa: ARG002 - what others of its kind need
        """Zero where the formula is nonnegative or both signs count, else minus infinity."""
        return 0.0 if self.of_magnitude or self.sign > 0 else -inf

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """Rows that hold if and only if the constant is at most slack . x + bound; of formulas with values alone."""
        check_ends(self.motion, space.boundary)
        check_passed(self.motion, space.boundary, smooth=not space.jumps(2))
        return self._families(space, slack, bound)

    def _families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        return tuple(branch_rows(space, branch, slack, bound) for branch in self.branches(symmetric=space.symmetric))


@dataclass(frozen=True, repr=False)
class FormulaPeak(OfFormula):
    """Peak of a formula: of its magnitude, or of one sign only; constructed by `peak`."""

    signs: tuple[float, ...] = (1.0, -1.0)

    @property
    def of_magnitude(self) -> bool:
        """Whether both signs of the formula count."""
        return len(self.signs) == 2

    @property
    def counted(self) -> tuple[float, ...]:
        """The relevant signs: a single one for a formula that is nonnegative everywhere."""
        return (float(self.sign),) if self.of_magnitude and self.sign and not self.affine else self.signs

    def floor(self, conditions: BoundaryConditions) -> float:
        """A lower bound of the peak: a one-sided peak may be negative, but not below the formula's end values."""
        known = known_values(self.motion, conditions)
        least = 0.0 if self.of_magnitude or self.sign == self.signs[0] else -inf
        return max([least, *(sign * value - VALUE_ROUNDING * size for value, size in known for sign in self.signs)])

    def value(self, law: MotionLaw) -> float:
        return max(greatest_along(self.motion, sign, law) for sign in self.counted)

    def branches(self, *, symmetric: bool) -> list[Branch]:
        halves = sides(self.motion, self.name, self.counted, symmetric=symmetric)
        several = [split(side.motion, sign, side.name) for side in halves for sign in side.signs]
        return [branch for branches in several for branch in branches or []]

    def _families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """The families of the formula: one, or two for symmetric laws if the formula is not symmetric."""
        if self.affine:
            halves = sides(self.motion, self.name, self.signs, symmetric=space.symmetric)
            return tuple(rows(space, side, slack, bound) for side in halves)
        return super()._families(space, slack, bound)

    def beneath(self, boxes: Boxes, *, symmetric: bool) -> list[Branch]:
        """Convex lower bounds of the peak's formulas, and the formulas that are convex themselves."""
        convex = []
        for branch in self.branches(symmetric=symmetric):
            if branch.convex:
                convex.append(branch)
                continue
            motion = branch.motion
            signed = motion if branch.sign > 0.0 else replace(motion, formula=Negative(motion.formula))
            for i, formula in enumerate(envelopes(signed, boxes), 1):
                below = replace(signed, formula=formula)
                if below.curvature.convex:
                    convex.append(Branch(below, 1.0, names.envelope(i, branch.name, branch.sign)))
        return convex


@dataclass(frozen=True, repr=False)
class FormulaRms(OfFormula):
    """Root mean square of a formula over its part of the interval; constructed by `rms`."""

    @property
    def of_magnitude(self) -> bool:
        """Whether the formula is a magnitude; in a mean square it is squared."""
        return True

    @property
    def length(self) -> float:
        return self.motion.stop - self.motion.start

    def value(self, law: MotionLaw) -> float:
        """The root of the mean square, by Gauss's rule, exact where the formula is a polynomial of k."""
        return float(np.sqrt(integral_along(self.motion, law, square=True) / self.length))

    def _families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """A norm of the coordinates, or the root of an integral."""
        if not self.affine:
            root, square = float(np.sqrt(self.length)), squared(self.motion)
            return (integral_rows(space, square, self.name, slack * root, bound * root, root=True, convex=self.convex),)
        matrix = np.vstack([self._roots(space, half) for half in self.parts(symmetric=space.symmetric)])
        return (NormFamily(self.name, slack, bound, matrix=widened(matrix, len(slack))),)

    def _roots(self, space: LawSpace, motion: MotionFormula) -> Array:
        u, weights = gauss(space, motion)
        return np.sqrt(weights / self.length)[:, None] * columns(space, motion, u)


@dataclass(frozen=True, repr=False)
class FormulaIntegral(OfFormula):
    """Integral of a formula over its part of the interval; constructed by `integral`."""

    @property
    def scale(self) -> float:
        """The scale of the formula times the length of its part, a power of 2."""
        return power_of_two(self.motion.scale * (self.motion.stop - self.motion.start))

    def value(self, law: MotionLaw) -> float:
        """The integral by Gauss's rule, exact if the formula is a polynomial of k."""
        return integral_along(self.motion, law)

    def _families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        return (integral_rows(space, self.motion, self.name, slack, bound, root=False, convex=self.convex),)


@dataclass(frozen=True, repr=False)
class FormulaValue(OfFormula):
    """Value of a formula at a single k; constructed by `value`."""

    def value(self, law: MotionLaw) -> float:
        return value_along(self.motion, law)

    def branches(self, *, symmetric: bool) -> list[Branch]:
        [motion] = self.parts(symmetric=symmetric)
        return split(motion, 1.0, self.name) or []


def greatest_along(motion: MotionFormula, sign: float, law: MotionLaw) -> float:
    """The greatest value of a formula, times a sign, over its part of the interval."""
    if smooth(motion.formula, ORDERS):
        lowest, highest = extremes_along(motion, law)
        return highest.value if sign > 0.0 else -lowest.value
    ends = ((branch.sign, extremes_along(branch.motion, law)) for branch in split(motion, sign, "") or [])
    return max(highest.value if sign > 0.0 else -lowest.value for sign, (lowest, highest) in ends)


def refusal(constant: OfFormula) -> str | None:
    """The reason why a formula cannot be optimised: its kinks are not those of a maximum of smooth formulas."""
    signs = constant.counted if isinstance(constant, FormulaPeak) else (1.0,)
    bad = [sign for sign in signs if split(constant.motion, sign, constant.name) is None]
    if not bad or not isinstance(constant, FormulaPeak | FormulaValue):
        return None
    side = "high" if bad == [-1.0] else "low"
    hint = ""
    if len(signs) == 2 and len(bad) == 1:
        hint = f"; {_both_sides(constant.motion, side)}"
    formula = constant.motion.formula
    return f"{cut(str(formula), _SHOWN)} has kinks that are not those of a maximum of smooth formulas{hint}"


def _both_sides(motion: MotionFormula, side: str) -> str:
    """What can be minimised in place of a magnitude of which one side alone is a maximum of smooth formulas."""
    last = (motion.branches(1.0 if side == "high" else -1.0) or [motion.formula])[-1]
    parts = "" if (motion.start, motion.stop) == (0.0, 1.0) else f", start={motion.start!r}, stop={motion.stop!r}"
    both = f'maximum(peak("{motion.formula}", side="{side}"{parts}), peak("{last}", side="low"{parts}))'
    if len(both) > 2 * _SHOWN:
        both = (
            f'maximum(peak(..., side="{side}"{parts}), peak(..., side="low"{parts})) of it and of one of its branches'
        )
    return (
        f'side="{side}" is possible; for both sides write {both}, which is never less: of a drive they are `torque` '
        "and `branches[-1]`"
    )


def boxes_of(problem: ProblemView) -> dict[str, tuple[float, float]]:
    """The ranges of the derivatives in all laws of a problem, as far as its bounds imply them.

    Examples
    --------
    >>> from optlaws import Chebyshev, Problem, at_most
    >>> boxes_of(Problem(B=1.8, C=at_most(6.0), order=4, basis=Chebyshev(5), monotone=True))
    {'b': (0.0, 1.8), 'c': (-6.0, 6.0), 'a': (0.0, 1.0)}
    """
    boxes = {}
    for name, constant in (("b", "B"), ("c", "C"), ("j", "J")):
        limits = as_range(getattr(problem, constant, None), constant)
        if limits is not None and isfinite(limits.high):
            boxes[name] = (-limits.high, limits.high)
    if problem.monotone:
        boxes["b"] = (0.0, boxes.get("b", (0.0, inf))[1])
        if getattr(problem, "boundary", None) is None:
            boxes["a"] = (0.0, 1.0)
    elif "b" in boxes and getattr(problem, "boundary", None) is None:
        # a is at most B k from its start, and from its end
        most = (1.0 + boxes["b"][1]) / 2.0
        boxes["a"] = (1.0 - most, most)
    return {name: box for name, box in boxes.items() if all(map(isfinite, box))}
