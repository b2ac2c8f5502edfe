"""What interlocks enclose in intervals: an axis over its clock; bounds and polygons in the plane of two positions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import pairwise
from math import hypot
from typing import Any, Literal, TypeAlias

import numpy as np

from optlaws.cycles.cycle import Cycle
from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.jets import formula_jet
from optlaws.formulas.tree import Formula
from optlaws.kept import kept_property
from optlaws.motion.smooth_stretches import EnclosedStretch, jet_of_parts, smooth_parts
from optlaws.numbers import Array
from optlaws.numerics.branch_and_bound import Extremes, extremes
from optlaws.numerics.interval import Interval, exact
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import INTERLOCK, PASS_WIDTH

_SECTION_WIDTH = 1e-12  # of a polygon: sides that are narrower are upright

Corner: TypeAlias = tuple[float, float]

#: of a point, as two jets or two numbers: how far it is beyond a line, or outside a region
Depth: TypeAlias = Callable[[Any, Any], Any]

Way: TypeAlias = Literal["up", "down"]

_ROUNDS = 60


@dataclass(frozen=True, eq=False)
class EnclosedAxis:
    """The position of an axis over the time of a cycle, in SI units, with enclosures of it and its derivatives.

    >>> from optlaws import Cycle, Return, Rise
    >>> axis = EnclosedAxis(Cycle([Rise("40 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s"))
    >>> [round(0.5 * (low + high), 9) for low, high in axis.passes(0.02)]
    [0.05, 0.2]
    """

    cycle: Cycle

    @kept_property
    def stretches(self) -> tuple[EnclosedStretch, ...]:
        """Smooth parts, one after the other."""
        return tuple(part for piece in self.cycle.pieces for part in smooth_parts(piece, EnclosedStretch))

    @kept_property
    def breaks(self) -> tuple[float, ...]:
        """Times between which the motion is smooth, both ends included."""
        return (*(stretch.start for stretch in self.stretches), self.stretches[-1].stop)

    @kept_property
    def stroke(self) -> float:
        """Between the least and the greatest position."""
        lows, highs = zip(*(stretch.extremes(0) for stretch in self.stretches), strict=True)
        return float(max(highs) - min(lows))

    def jet(self, at: Interval, order: int) -> Jet:
        """The position with its Taylor terms in intervals of time, each within two neighbouring breaks."""
        return jet_of_parts(self.stretches, lambda stretch, some: stretch.jet(some, order), at)

    def between(self, start: float, stop: float) -> tuple[float, float]:
        """Bounds of the position over a short while, breaks in it or not."""
        lows, highs = [], []
        for stretch in self.stretches:
            low, high = max(start, stretch.start), min(stop, stretch.stop)
            if low <= high:
                place = Interval(np.array([0.5 * (low + high)]), np.array([0.5 * (high - low)]))
                value = stretch.jet(place, 0).terms[0]
                lows.append(float(value.low[0]))
                highs.append(float(value.high[0]))
        return min(lows), max(highs)

    def passes(self, position: float, way: Way | None = None) -> list[tuple[float, float]]:
        """When it passes a position at which it does not rest, on its way up, down, or any: enclosures of the times.

        There are no other passes: what is left out is proven to be above or below the position.
        """
        low, high = np.array(self.breaks[:-1]), np.array(self.breaks[1:])
        for _ in range(_ROUNDS):
            if (high - low <= PASS_WIDTH * self.cycle.duration).all():
                break
            low, high = self._narrowed(low, high, position)
        joined = list[tuple[float, float]]()
        for start, stop in sorted(zip(low.tolist(), high.tolist(), strict=True)):
            if joined and start <= joined[-1][1] + PASS_WIDTH * self.cycle.duration:
                joined[-1] = joined[-1][0], max(stop, joined[-1][1])
            else:
                joined.append((start, stop))
        sign = {"up": 1.0, "down": -1.0, None: 0.0}[way]
        return [(start, stop) for start, stop in joined if sign * self.cycle(0.5 * (start + stop), 1) >= 0.0]

    def entries(self, position: float, way: Way) -> list[float]:
        """When it passes a position on its way up or down, or comes to rest at it from there."""
        near = INTERLOCK * self.stroke
        still = [each.stroke == 0.0 and abs(each.offset - position) <= near for each in self.stretches]
        if not any(still):
            return [0.5 * (low + high) for low, high in self.passes(position, way)]
        sign = 1.0 if way == "up" else -1.0
        pairs = zip(self.stretches, self.stretches[1:], still[1:], strict=False)
        return [after.start for before, after, rests in pairs if rests and sign * before.stroke > 0.0]

    def _narrowed(self, low: Array, high: Array, position: float) -> tuple[Array, Array]:
        """Cells in which it may be at a position: by Newton's method where the velocity has one sign, else halved."""
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        whole, at = self.jet(Interval(middle, half), 1), self.jet(exact(middle), 0).terms[0]
        met = (whole.terms[0].low <= position) & (whole.terms[0].high >= position)
        with np.errstate(divide="ignore", invalid="ignore"):
            steps = (position - at) / whole.terms[1]
            first = np.where(np.isfinite(steps.radius), np.maximum(low, middle + steps.low), low)
            last = np.where(np.isfinite(steps.radius), np.minimum(high, middle + steps.high), high)
        met &= first <= last
        first, last, low, high = first[met], last[met], low[met], high[met]
        wide = (last - first > 0.5 * (high - low)) & (last - first > PASS_WIDTH * self.cycle.duration)
        cut = 0.5 * (first + last)
        lows = np.concatenate([first, cut[wide]])
        highs = np.concatenate([np.where(wide, cut, last), last[wide]])
        return lows, highs


def least(
    function: Callable[[Interval, int], Jet],
    axes: Sequence[EnclosedAxis],
    share: float,
    within: tuple[float, float] | None = None,
) -> Extremes:
    """Least and greatest value of a function of axis motions, proven over a cycle or a window of it."""
    start, stop = within or (0.0, axes[0].cycle.duration)
    breaks = sorted({place for axis in axes for place in axis.breaks if start < place < stop})
    return extremes(function, [start, *breaks, stop], share=share, parts=2)


def at_positions(formula: Formula, x: Any) -> Any:
    """A formula of x where x is positions, or a jet of intervals of them."""
    if isinstance(x, Jet):
        return formula_jet(formula, "x", x)
    return np.asarray(evaluate(formula, {"x": x}, NUMPY)) + 0.0 * x


@dataclass(frozen=True)
class SimplePolygon:
    """A simple polygon by its corners, counterclockwise; closed by the side from the last to the first.

    `given` are its corners as they were given, in either order.

    >>> notched = SimplePolygon.through([(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)])
    >>> [bool(notched.outside(*point) > 0.0) for point in [(2.0, 2.0), (3.5, 2.0), (2.0, 0.5), (5.0, 2.0)]]
    [True, False, False, True]
    """

    corners: tuple[Corner, ...]
    given: tuple[Corner, ...] = ()

    @classmethod
    def through(cls, corners: Sequence[Corner]) -> SimplePolygon:
        """The polygon through corners in either order; polygons without area or with crossing sides are refused."""
        points = _bends(corners)
        sides = _sides(points)
        for i, first in enumerate(sides):
            for j in range(i + 2, len(sides) - (i == 0)):
                if _cross(first, sides[j]):
                    raise InputError(f"its sides {i + 1} and {j + 1} cross: name its corners in order along its edge")
        area = sum(x * up - y * across for (x, y), (across, up) in sides) if len(points) > 2 else 0.0
        size = max(hypot(x - corners[0][0], y - corners[0][1]) for x, y in corners)
        if not abs(area) > INTERLOCK * size * size:
            raise InputError("its corners lie on a line: a region has three or more that do not")
        return cls(tuple(points if area > 0.0 else points[::-1]), tuple(corners))

    def scaled(self, x: float, y: float) -> SimplePolygon:
        """The polygon with positions divided."""
        return SimplePolygon(tuple((across / x, up / y) for across, up in self.corners))

    def section(self, x: float) -> tuple[float, float]:
        """The least and the greatest y of the polygon at an x within it, or at the nearest that is.

        A side that is upright but for rounding counts whole.
        """
        across = [corner[0] for corner in self.corners]
        near = _SECTION_WIDTH * (max(across) - min(across))
        x = min(max(x, min(across)), max(across))
        met: list[float] = []
        for (start, first), (stop, last) in _sides(self.corners):
            low, high = max(min(start, stop), x - near), min(max(start, stop), x + near)
            if low <= high:
                shares = [(place - start) / (stop - start) for place in (low, high)] if start != stop else [0.0, 1.0]
                met += [first + share * (last - first) for share in shares]
        return min(met), max(met)

    @property
    def outside(self) -> Depth:
        """A function of a point: above 0 outside, 0 on the edge, below 0 within; no more than the distance if convex.

        A simple polygon consists of the half planes of its sides, each once: those on its hull meet, in a pocket they
        are joined, in a pocket of that they meet again (Dobkin, Guibas, Hershberger and Snoeyink 1988).
        """
        first = self.corners.index(min(self.corners))
        around = [*self.corners[first:], *self.corners[: first + 1]]
        return _chain(around, meets=True)

    def square(self, x: Any, y: Any) -> Any:
        """The square of the distance of a point from the edge."""
        return reduce(_lesser, [_square(start, stop, x, y) for start, stop in _sides(self.corners)])


def _chain(points: Sequence[Corner], *, meets: bool) -> Depth:
    """The depth of a chain of sides: of the parts between its points on the hull."""
    if len(points) == 2:
        return _beyond(points[0], points[1])
    last = len(points) - 1
    places = sorted({0, last, *_hull(points[:-1] if points[0] == points[-1] else points)})
    depths = [_chain(points[start : stop + 1], meets=not meets) for start, stop in pairwise(places)]
    joined = _greater if meets else _lesser
    return lambda x, y: reduce(joined, [depth(x, y) for depth in depths])


def _hull(points: Sequence[Corner]) -> set[int]:
    """Places of points that are corners of the hull of all."""
    order, met = sorted(range(len(points)), key=lambda i: points[i]), set[int]()
    for walk in (order, order[::-1]):
        hull: list[int] = []
        for i in walk:
            while len(hull) > 1 and _turn(points[hull[-2]], points[hull[-1]], points[i]) <= 0.0:
                hull.pop()
            hull.append(i)
        met |= set(hull)
    return met


def _beyond(start: Corner, stop: Corner) -> Depth:
    """The signed distance of a point to the right of a side."""
    across, up = (stop[0] - start[0], stop[1] - start[1])
    size = hypot(across, up)
    return lambda x, y: (x + (-start[0])) * (up / size) + (y + (-start[1])) * (-across / size)


def _square(start: Corner, stop: Corner, x: Any, y: Any) -> Any:
    """The square of the distance of a point from a side."""
    across, up = (stop[0] - start[0], stop[1] - start[1])
    size = hypot(across, up)
    east, north = x + (-start[0]), y + (-start[1])
    along = east * (across / size) + north * (up / size)
    over = _greater(_greater(along + (-size), -along), along * 0.0)
    off = _beyond(start, stop)(x, y)
    return off * off + over * over


def _greater(first: Any, second: Any) -> Any:
    return first.maximum(second) if isinstance(first, Jet) else np.maximum(first, second)


def _lesser(first: Any, second: Any) -> Any:
    return -_greater(-first, -second)


def _turn(first: Corner, second: Corner, third: Corner) -> float:
    return (second[0] - first[0]) * (third[1] - first[1]) - (second[1] - first[1]) * (third[0] - first[0])


def _cross(first: tuple[Corner, Corner], second: tuple[Corner, Corner]) -> bool:
    """Whether two sides have a point in common."""
    turns = [_turn(*first, end) for end in second], [_turn(*second, end) for end in first]
    if all(turn == 0.0 for pair in turns for turn in pair):
        apart = [
            max(a[i] for a in one_side) < min(b[i] for b in other) for i in (0, 1) for one_side, other in
            ((first, second), (second, first))
        ]  # fmt: skip
        return not any(apart)
    return turns[0][0] * turns[0][1] <= 0.0 and turns[1][0] * turns[1][1] <= 0.0


def _sides(points: Sequence[Corner]) -> list[tuple[Corner, Corner]]:
    return list(pairwise([*points, points[0]]))


def _bends(corners: Sequence[Corner]) -> list[Corner]:
    """Corners without duplicates and without corners on straight sides."""
    points = [(float(x), float(y)) for x, y in corners]
    i = 0
    while len(points) > 2 and i < len(points):
        before, here, after = points[i - 1], points[i], points[(i + 1) % len(points)]
        reach = hypot(after[0] - before[0], after[1] - before[1])
        size = max(hypot(here[0] - before[0], here[1] - before[1]), reach)
        if abs(_turn(before, here, after)) <= INTERLOCK * size * size:
            del points[i]
            i = max(i - 1, 0)
        else:
            i += 1
    return points
