"""Regions of the plane of two positions: beyond a bound, outside a polygon, as functions that enclosures evaluate."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import pairwise
from math import hypot
from typing import Any, TypeAlias

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.tree import Formula
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet
from optlaws.synthesis.limits.formula_jets import formula_jet
from optlaws.tolerances import INTERLOCK, ROUNDOFF

_SECTION_WIDTH = 1e-12  # of a polygon: sides that are narrower are upright

Corner: TypeAlias = tuple[float, float]

#: of a point, as two jets or two numbers: how far it is beyond a line, or outside a region
Depth: TypeAlias = Callable[[Any, Any], Any]


@dataclass(frozen=True)
class TableBound:
    """Straight lines between places, constant beyond them."""

    places: tuple[float, ...]
    values: tuple[float, ...]

    def __call__(self, x: Array) -> Array:
        """Values of the bound at places."""
        return np.interp(x, self.places, self.values)

    def jet(self, x: Jet) -> Jet:
        """The bound where x is a jet of intervals: a sum of ramps, each with its kinks."""
        total = x * 0.0 + self.values[0]
        for (low, high), (start, stop) in zip(pairwise(self.places), pairwise(self.values), strict=True):
            slope = (stop - start) / (high - low)
            ramp = x.clipped(low, high) + (-low)
            total = total + ramp * Interval(np.array(slope), np.array(4.0 * ROUNDOFF * abs(slope)))
        return total


@dataclass(frozen=True)
class FormulaBound:
    """A formula of x with units: `size` is the unit of x and `scale` that of its value, both in SI."""

    formula: Formula
    size: float
    scale: float

    def __call__(self, x: Array) -> Array:
        """Values of the bound at places."""
        return np.asarray(evaluate(self.formula, {"x": np.asarray(x) / self.size}, NUMPY)) * self.scale + 0.0 * x

    def jet(self, x: Jet) -> Jet:
        """The bound where x is a jet of intervals."""
        share = 1.0 / self.size
        value = formula_jet(self.formula, "x", x * Interval(np.array(share), np.array(2.0 * ROUNDOFF * share)))
        return value * Interval(np.array(self.scale), np.array(ROUNDOFF * self.scale))


PositionBound: TypeAlias = TableBound | FormulaBound


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
