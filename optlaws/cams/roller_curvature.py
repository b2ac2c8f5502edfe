"""The least radius of curvature of a roller's profile as a limit of a law, and what it costs at least.

The pitch curve bends by no more than 1/rho where s'' >= G(s, s'), which is not convex. What that costs is bounded in
two steps: between which values every law runs that is no worse than a known one, and, in each part of the time, a plane
that is nowhere above G between these values.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations_with_replacement, pairwise
from math import asin, cos, isfinite, pi, sin, sqrt

import numpy as np

from optlaws.cams.followers.contact import FollowerContact
from optlaws.errors import InfeasibleProblem, OptlawsError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.convexity import Endpoints, enclosed
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import derivative
from optlaws.formulas.tree import Formula
from optlaws.kept import kept_property
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import TURN
from optlaws.numbers import Array
from optlaws.numerics.taylor import Jet
from optlaws.synthesis.functionals.makers import value
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import at_most
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.solve import synthesize

_FORMULA_ROUNDING = 2.0**-40  # of what the value and the slopes of a formula amount to
_PLANE_GAIN = 2e-4  # of a bound: planes that say no more than this are left out
_PLANE_SLACK = 1e-9  # of a bound: by so much a formula lies within its planes

Pair = tuple[float, float]

_PARTS, _MANY = 40, 6
_NARROW = 1.75  # of what b can change by in a part: a range of b that is narrower is not computed for its own sake


@dataclass(frozen=True)
class RollerCurvature:
    """A greatest curvature of a roller's pitch curve as a limit of one piece's law: G(a, b) - c s''(1) <= 0.

    `radius` is the least radius of curvature of the pitch curve where it bulges, m; `period` is of a turn, in the unit
    of the piece's duration.
    """

    piece: Piece
    contact: FollowerContact
    radius: float
    period: float

    @property
    def _slope(self) -> float:
        """The derivative s' where b is 1."""
        return self.piece.stroke * self.period / (TURN * self.piece.duration)

    @property
    def factor(self) -> float:
        """The derivative s'' where c is 1, in strokes as G is."""
        return float(np.sign(self.piece.stroke)) * (self.period / (TURN * self.piece.duration)) ** 2

    @property
    def ends(self) -> Pair:
        """The velocities at both ends, which are given."""
        return float(self.piece.law.b(0.0)), float(self.piece.law.b(1.0))

    @kept_property
    def least(self) -> str:
        """G as a text in a and b, in strokes."""
        slope = f"({self._slope!r}*b)"
        moved = f"({self.piece.offset - self.contact.lowest!r} + ({self.piece.stroke!r})*a)"
        terms = self.contact.curvature_terms(moved, slope)
        assert terms is not None  # noqa: S101 - it has a roller
        along, across, turned, factor = terms
        square = f"({along}^2 + {across}^2)"
        return f"({turned} - {square}^1.5/{self.radius!r})/({factor}*{abs(self.piece.stroke)!r})"

    def window(self) -> Window:
        """The limit as a window of a problem that is not convex."""
        return Window(f"{self.least} - ({self.factor!r})*c", high=0.0)

    def broken(self) -> bool:
        """Whether the piece's law breaks it somewhere on a grid."""
        k = np.linspace(0.0, 1.0, 25 * _PARTS + 1)
        a, b, c = (np.asarray(quantity(k)) for quantity in (self.piece.law.a, self.piece.law.b, self.piece.law.c))
        needed = np.asarray(evaluate(self._formula, {"a": a, "b": b}, NUMPY))
        return bool((needed > self.factor * c + _PLANE_SLACK).any())

    def at_rest(self) -> float | None:
        """The radius of the pitch curve, m, at an end where the follower rests, if it is too small for any law."""
        for k in (0.0, 1.0):
            law = self.piece.law
            if abs(float(law.b(k))) + abs(float(law.c(k))) > _PLANE_SLACK:
                continue
            s = self.piece.offset + self.piece.stroke * float(law.a(k))
            radius = float(self.contact.radius_of_curvature(Jet((np.array(s), 0.0, 0.0)))) + self.contact.roller
            if 0.0 < radius * (1.0 + _PLANE_SLACK) < self.radius:
                return radius
        return None

    def is_out_of_reach(self) -> bool:
        """Whether no path that bends so little reaches the piece's nearer end from rest at the farther one.

        With r from the centre and p that of the tangent, dp/dr is r times the curvature: back from the rest, where p is
        r, no path between the ends falls faster over the angle than the circle of the least radius that touches there.
        Known of a slide whose way meets the cam's axis, whose pitch curve runs around it with the cam's angle.
        """
        piece, contact, radius = self.piece, self.contact, self.radius
        angle, rest = TURN * piece.duration / self.period, 1.0 if piece.stroke > 0.0 else 0.0
        if not contact.meets_axis or angle >= pi or abs(float(piece.law.b(rest))) > _PLANE_SLACK:
            return False
        shift = contact.level - contact.lowest + piece.offset
        near, far = sorted(shift + piece.stroke * float(piece.law.a(k)) for k in (0.0, 1.0))
        centre = far - radius
        if centre <= 0.0 or (centre > radius and angle >= asin(radius / centre)):
            return False
        reached = centre * cos(angle) + sqrt(radius**2 - (centre * sin(angle)) ** 2)
        return reached > near * (1.0 + _PLANE_SLACK)

    def planes(self, k: Sequence[float], a: Sequence[Pair], b: Sequence[Pair]) -> list[Window]:
        """Planes that are nowhere above G, one for each part of the time, while a and b stay in their ranges there."""
        low, high = np.array([a, b])[:, :, 0], np.array([a, b])[:, :, 1]
        at, reach = 0.5 * (low + high), 0.5 * (high - low)
        values = dict(zip("ab", at, strict=True))
        height = np.asarray(evaluate(self._formula, values, NUMPY)) + 0.0 * at[0]
        slopes = np.array([np.asarray(evaluate(slope, values, NUMPY)) + 0.0 * at[0] for slope in self._slopes])
        within = {name: Endpoints(*ends) for name, *ends in zip("ab", low, high, strict=True)}
        size = np.abs(height) + (np.abs(slopes) * np.maximum(np.abs(low), np.abs(high))).sum(axis=0)
        base = height - (slopes * at).sum(axis=0) - self._taken(within, reach) - _FORMULA_ROUNDING * size
        known = np.isfinite(base) & np.isfinite(slopes).all(axis=0)
        return [
            Window(f"({m!r})*a + ({n!r})*b - ({self.factor!r})*c", high=-bound, start=start, stop=stop)
            for m, n, bound, (start, stop), sure in zip(
                *slopes.tolist(), base.tolist(), pairwise(k), known, strict=True
            )
            if sure
        ]

    def _taken(self, within: dict[str, Endpoints], reach: Array) -> Array:
        """The greatest distance of G below a plane that touches it in the middle, by Taylor's formula."""
        taken = np.zeros(reach.shape[1])
        for i, j in combinations_with_replacement(range(2), 2):
            bend = enclosed(derivative(self._slopes[i], "ab"[j]), within)
            worst = 0.5 * np.maximum(-bend.low, 0.0) if i == j else np.maximum(np.abs(bend.low), np.abs(bend.high))
            taken = taken + worst * reach[i] * reach[j]
        return taken

    @kept_property
    def _formula(self) -> Formula:
        return read(self.least)

    @kept_property
    def _slopes(self) -> list[Formula]:
        return [derivative(self._formula, name) for name in "ab"]


def curvature_of(piece: Piece, contact: FollowerContact, least: float, period: float) -> RollerCurvature | None:
    """The limit of a piece's law where the profile is to have a least radius of curvature in m; None under a face."""
    if not contact.roller or piece.stroke == 0.0:
        return None
    return RollerCurvature(piece, contact, least + contact.roller, period)


def bound_under(curvature: RollerCurvature, problem: Problem, most: float) -> float:
    """The lower bound of a convex problem's objective under a limit of curvature, where a law has the objective `most`.

    Laws that are better run in a tube: their b is between values at some times, each the optimum of a convex problem,
    and elsewhere no further from these than their greatest acceleration takes it. There planes below G are limits
    that are convex. Where nothing bounds the acceleration, the bound is that of the problem itself.
    """
    least = synthesize(problem).lower_bound
    greatest = _most_acceleration(problem, most)
    if greatest is None or most - least <= _PLANE_GAIN * most:
        return least
    try:
        k, a, b = _tube(replace(_light(problem), C=at_most(greatest)), greatest, curvature.ends)
        planes = curvature.planes(k, a, b)
        better = synthesize(replace(problem, windows=(*problem.windows, *planes))).lower_bound
    except InfeasibleProblem:
        return most  # no law is better than the one known
    except OptlawsError:
        return least
    return min(most, max(least, better))


def _light(problem: Problem) -> Problem:
    """A problem that all laws of another one keep, solved in less time: without its formulas where they are many."""
    if len(problem.windows) <= _MANY:
        return problem
    return replace(problem, windows=tuple(window for window in problem.windows if window.motion is None))


def _most_acceleration(problem: Problem, most: float) -> float | None:
    limit = problem.range("C")
    levels = [most] if problem.minimise == "C" else []
    levels += [limit.high] if limit is not None and isfinite(limit.high) else []
    return min(levels) * (1.0 + _PLANE_SLACK) if levels else None


def _tube(problem: Problem, greatest: float, ends: Pair) -> tuple[list[float], list[Pair], list[Pair]]:
    """Ends of parts of the time, and the ranges of a and b in all laws of a problem in each part."""
    k = np.linspace(0.0, 1.0, _PARTS + 1).tolist()
    width = 1.0 / _PARTS
    change = greatest * width
    b = _ranges_at(problem, k, ends, change)
    velocities = [
        (-_highest(-before[0], -other[0], change), _highest(before[1], other[1], change))
        for before, other in pairwise(b)
    ]
    # between two velocities a goes no further than with half of what the acceleration can change on the way
    least = [width * (0.5 * (before[0] + other[0]) - 0.25 * change) for before, other in pairwise(b)]
    most = [width * (0.5 * (before[1] + other[1]) + 0.25 * change) for before, other in pairwise(b)]
    a = [
        (max(sum(least[:i]), 1.0 - sum(most[i:])), min(sum(most[:i]), 1.0 - sum(least[i:]))) for i in range(_PARTS + 1)
    ]
    displacements = [
        (
            max(before[0] + min(low, 0.0) * width, other[0] - max(high, 0.0) * width),
            min(before[1] + max(high, 0.0) * width, other[1] - min(low, 0.0) * width),
        )
        for (before, other), (low, high) in zip(pairwise(a), velocities, strict=True)
    ]
    return k, displacements, velocities


def _highest(first: float, last: float, change: float) -> float:
    """An upper bound between two known values of a function whose rate of change is bounded."""
    first, last = min(first, last + change), min(last, first + change)
    return 0.5 * (first + last + change)


def _ranges_at(problem: Problem, k: Sequence[float], ends: Pair, change: float) -> list[Pair]:
    """The ranges of b at places between which it changes by so much at most: computed where they are widest."""
    known = {0: (ends[0],) * 2, _PARTS: (ends[1],) * 2}
    while True:
        ranges = [
            (
                max(low - change * abs(i - place) for place, (low, _) in known.items()),
                min(high + change * abs(i - place) for place, (_, high) in known.items()),
            )
            for i in range(_PARTS + 1)
        ]
        widths = {i: high - low for i, (low, high) in enumerate(ranges) if i not in known}
        widest = max(widths, key=widths.__getitem__, default=0)
        if not widest or widths[widest] <= _NARROW * change:
            return ranges
        low, high = (synthesize(replace(problem, minimise=value(b, at=k[widest]))).lower_bound for b in ("b", "-b"))
        known[widest] = low, -high
