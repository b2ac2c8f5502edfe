"""Constants from a formula: its peak, its root mean square, its integral, its value at a place."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from math import inf, isfinite
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import cut
from optlaws.errors import InputError
from optlaws.formulas.branches import knots, smooth
from optlaws.formulas.convexity import Judge
from optlaws.formulas.of_motion import MotionFormula, divisor
from optlaws.formulas.reading import FormulaError, read
from optlaws.formulas.slopes import constant
from optlaws.formulas.tree import ORDERS, SMOOTH_FUNCTIONS, Call, Exponentiation, Formula, Negative, Reciprocal
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array, power_of_two
from optlaws.numerics.chebyshev import gauss, value
from optlaws.numerics.panels import candidates, cut_at_roots, series_between
from optlaws.numerics.peaks import Peak, extremes
from optlaws.synthesis.families import names
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily
from optlaws.synthesis.families.piece_series import widened
from optlaws.synthesis.functionals.formula_rows import (
    Boxes,
    Branch,
    branch_rows,
    columns,
    envelopes,
    gauss_places,
    integral_rows,
    rows,
    sampled,
    sides,
    split,
    squared,
)
from optlaws.synthesis.functionals.sizes import known_values, size_bounds
from optlaws.synthesis.problem.constants import Functional, ProblemView
from optlaws.synthesis.problem.ranges import as_range
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.tolerances import BESIDE_BREAK, VALUE_ROUNDING

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace

#: values of b or c, among them 0, 1/2 and 1
_FROM_ZERO = frozenset(name for name, function in SMOOTH_FUNCTIONS.items() if function.from_zero)
_PASSED = 2049
#: motions at random, of which sizes, and how often one of the names is 0
_MOTIONS, _STILL = 4096, 0.2
_SIZES = {"a": 1.0, "b": 2.0, "c": 8.0, "j": 60.0}


def check_ends(motion: MotionFormula, conditions: BoundaryConditions) -> None:
    """Refuse a formula that has no value at the end conditions: at rest 1/b divides by 0."""
    for k, end in ((0.0, conditions.start), (1.0, conditions.end)):
        known = {name: end[nu] for name, nu in ORDERS.items() if nu < len(end)}
        every = motion.formula.different if motion.start <= k <= motion.stop else ()
        parts = [part for part in every if part.names() <= {*known, "k"} and part.names() & ORDERS.keys()]
        wrong = [part for part in parts if not np.isfinite(MotionFormula(part).values({**known, "k": k}))]
        if wrong:
            values = " and ".join(f"{name} = {known[name]:g}" for name in sorted(wrong[0].names() & ORDERS.keys()))
            text = str(motion.formula)
            places = (same.place for same in read(text).different if same == wrong[-1])
            raise FormulaError(
                f"{motion.formula} has no finite value at k = {k:g}, where {values} in every law: ask for a part "
                "of the interval, such as start=0.05, stop=0.95",
                text,
                next(places, 0),
            )


def check_passed(motion: MotionFormula, conditions: BoundaryConditions, *, smooth: bool) -> None:
    """Refuse a formula without a value wherever every law comes by: 1/(b - 1), where laws rise by 1 from rest to rest.

    They pass all a from 0 to 1, all b from 0 to their mean 1, and all c from -1 to 1 where c does not jump.
    """
    at_rest = conditions.start[:2] == (0, 0) and conditions.end[:2] == (1, 0)
    passed = {"a": (0.0, 1.0), "b": (0.0, 1.0)} | ({"c": (-1.0, 1.0)} if smooth else {})
    for part in motion.formula.different if at_rest and (motion.start, motion.stop) == (0.0, 1.0) else ():
        (name,) = part.names() if len(part.names()) == 1 else ("",)
        if name not in passed:
            continue
        values = np.linspace(*passed[name], _PASSED)
        nowhere = _nowhere(part, {name: values})
        if nowhere.any():
            raise InputError(
                f"{motion.formula} has no finite value where {name} = {values[nowhere][0]:.4g}, which every law "
                "passes: ask for a part of the interval, such as start=0.05, stop=0.2"
            )


def pitfalls(motion: MotionFormula) -> Iterator[str]:
    """Parts of a formula that some motions bring where they have no value or no slope, in words."""
    for part in motion.formula.different:
        if not part.names() & ORDERS.keys():
            continue
        if isinstance(part, Reciprocal):
            low, high = _between(part.of, motion)
            if low <= 0.0 <= high:
                yield f"{part} has no value where {part.of} = 0"
            continue
        inner = None
        if isinstance(part, Exponentiation) and not float(constant(part.exponent) or 0.5).is_integer():
            inner = part.base
        elif isinstance(part, Call) and part.function in _FROM_ZERO:
            inner = part.arguments[0]
        if inner is not None and _between(inner, motion)[0] <= 0.0:
            yield f"{part} has no slope or no value where {inner} <= 0"


def _between(formula: Formula, motion: MotionFormula) -> tuple[float, float]:
    """The least and the greatest of a formula's values in some motions, most of them gentle, some without any."""
    numbers = np.random.default_rng(0)
    names = {name: size * numbers.normal(size=_MOTIONS) for name, size in _SIZES.items()}
    for values in names.values():
        values[numbers.random(_MOTIONS) < _STILL] = 0.0
    k = motion.start + (motion.stop - motion.start) * numbers.random(_MOTIONS)
    values = np.broadcast_to(MotionFormula(formula).values({**names, "k": k}), (_MOTIONS,))
    known = values[np.isfinite(values)]
    return (float(known.min()), float(known.max())) if len(known) else (np.inf, -np.inf)


def _nowhere(part: Formula, names: Mapping[str, Array]) -> NDArray[np.bool_]:
    """Ascending values at which a part has no value, or none before the next one."""
    nowhere = ~np.isfinite(MotionFormula(part).values(names))
    beneath = divisor(part)
    if beneath is not None:
        below = MotionFormula(beneath).values(names)
        nowhere |= np.append(below[:-1] * below[1:] < 0.0, [False])
    return nowhere


_INTEGRAL_SETTLED = 1e-14  # of an integral: what twice as many places may change of the whole, where no cut is needed
_PIECE_SETTLED = 1e-6  # of an integral: what twice as many places may change of the last pieces

_LARGEST = 400
#: how often a piece that is not smooth is cut in two, and how many places of Gauss's rule the last ones have
_DEEPEST, _DENSE = 12, 32


def extremes_along(motion: MotionFormula, law: MotionLaw) -> tuple[Peak, Peak]:
    """The least and the greatest value of a formula in a law, each with its place; infinite where it has no bound."""
    pieces = [_candidates(motion, law, ends) for ends in pairwise(_smooth_edges(motion, law))]
    if not pieces:
        k = np.array([motion.start])
        return extremes(k, _values(motion, law, k))
    k, values = (np.concatenate(several) for several in zip(*pieces, strict=True))
    if not np.isfinite(values).all():
        worst = float(k[~np.isfinite(values)][0])
        return Peak(-np.inf, worst), Peak(np.inf, worst)
    return extremes(k, values)


def integral_along(motion: MotionFormula, law: MotionLaw, *, square: bool = False) -> float:
    """The integral over the part of a formula in a law, or of its square; infinite where it seems to have none."""
    integral = _Integral(motion, law, square=square)
    return sum(integral.over(ends) for ends in integral.pieces)


def value_along(motion: MotionFormula, law: MotionLaw) -> float:
    """The formula's value in a law where its part begins."""
    return float(_values(motion, law, np.array([motion.start]))[0])


def _values(motion: MotionFormula, law: MotionLaw, k: Array) -> Array:
    names = {name: law(k, ORDERS[name]) for name in motion.formula.names() if name in ORDERS}
    return np.broadcast_to(motion.values({**names, "k": k}), k.shape).astype(np.float64)


def _smooth_edges(motion: MotionFormula, law: MotionLaw) -> list[float]:
    """The k between which the formula is smooth along the law, with kinks and knots of splines that the law passes."""
    breaks = law.breaks if isinstance(law, PiecewiseLaw) else ()
    inner = {k for k in (*breaks, *motion.breaks) if motion.start < k < motion.stop}
    edges = sorted({motion.start, motion.stop, *inner})
    plain, bent = knots(motion.formula, ORDERS)
    if plain:
        values = [partial(_values, MotionFormula(switch), law) for switch in plain]
        cut = (cut_at_roots(lambda *_: of, edges) for of in values)  # noqa: B023 - called at once
        edges = sorted({place for places in cut for place in places})
    for switch in bent:
        edges = cut_at_roots(partial(_inside, MotionFormula(switch), law), edges)
    return edges


def _inside(motion: MotionFormula, law: MotionLaw, low: float, high: float) -> Callable[[Array], Array]:
    """The values on a piece, its ends taken just within it."""
    return lambda k: _on(motion, law, (low, high), k)[1]


def _on(motion: MotionFormula, law: MotionLaw, ends: tuple[float, float], k: Array) -> tuple[Array, Array]:
    """Places of a piece, its ends just within it, and the values there."""
    low, high = ends
    # kinks that meet at an end may leave a piece shorter than that
    beside = min(BESIDE_BREAK, 0.25 * (high - low))
    inside = np.clip(k, low + beside * (low > 0.0), high - beside * (high < 1.0))
    return inside, _values(motion, law, inside)


def _count(motion: MotionFormula, law: MotionLaw, ends: tuple[float, float]) -> int | None:
    """How many coefficients the formula has on a piece; None where it is no polynomial."""
    longest = None
    if isinstance(law, PolynomialLaw):
        longest = len(law.acceleration)
    elif isinstance(law, PiecewiseLaw):
        segment = law.segments[int(np.searchsorted(law.breaks, sum(ends) / 2.0)) - 1]
        longest = len(segment.acceleration) if isinstance(segment, PolynomialSegment) else None
    if longest is None:
        return None
    degree = motion.degree({name: max(longest + 1 - nu, 0) for name, nu in ORDERS.items()})
    return None if degree is None or degree > _LARGEST else degree + 1


def _candidates(motion: MotionFormula, law: MotionLaw, ends: tuple[float, float]) -> tuple[Array, Array]:
    """Candidates for extremes of the formula on a piece, and its values there."""
    inner = candidates(_inside(motion, law, *ends), ends, _count(motion, law, ends))
    return _on(motion, law, ends, np.concatenate([np.array(ends), inner]))


class _Integral:
    """The integral of a formula along a law, by Gauss's rule: exact where the formula is a polynomial."""

    def __init__(self, motion: MotionFormula, law: MotionLaw, *, square: bool) -> None:
        self.motion, self.law, self.square = motion, law, square
        self.pieces = list(pairwise(_smooth_edges(motion, law)))

    @kept_property
    def size(self) -> float:
        """The approximate size of the formula when no terms cancel."""
        return sum(abs(self._by_rule(ends, _DENSE, sizes=True)) for ends in self.pieces)

    def over(self, ends: tuple[float, float]) -> float:
        """The integral over a piece."""
        series = series_between(_inside(self.motion, self.law, *ends), ends, _count(self.motion, self.law, ends))
        if series is None:
            return self._in_parts(ends, 0)
        x, weights = gauss(len(series) + 1)
        values = np.asarray(value(series, x))
        return float(weights @ (values**2 if self.square else values)) * (ends[1] - ends[0]) / 2.0

    def _in_parts(self, ends: tuple[float, float], depth: int) -> float:
        """Over a piece that is not smooth: a kink that a law comes near and turns is known to some digits alone."""
        rough, fine = (self._by_rule(ends, count) for count in (_DENSE, 2 * _DENSE))
        off = abs(fine - rough)
        if off <= _INTEGRAL_SETTLED * self.size:
            return fine
        if depth == _DEEPEST:
            return fine if off <= _PIECE_SETTLED * abs(fine) else float("inf")
        middle = (ends[0] + ends[1]) / 2.0
        return sum(self._in_parts(half, depth + 1) for half in ((ends[0], middle), (middle, ends[1])))

    def _by_rule(self, ends: tuple[float, float], count: int, *, sizes: bool = False) -> float:
        x, weights = gauss(count)
        half = (ends[1] - ends[0]) / 2.0
        values = _on(self.motion, self.law, ends, ends[0] + half * (x + 1.0))[1]
        with np.errstate(invalid="ignore", over="ignore"):
            shown = values**2 if self.square else np.abs(values) if sizes else values
            return float(weights @ shown) * half


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
        u, weights = gauss_places(space, motion)
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
    for name, peak in (("b", "B"), ("c", "C"), ("j", "J")):
        limits = as_range(getattr(problem, peak, None), peak)
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
