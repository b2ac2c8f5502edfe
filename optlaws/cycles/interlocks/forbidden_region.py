"""A region of the plane of two positions that their path does not enter: a tool and the workpiece around it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import hypot, sqrt
from typing import Any

import numpy as np

from optlaws.cycles.interlocks.enclosed_axis import EnclosedAxis, least
from optlaws.cycles.interlocks.interlock import AXIS, CALLED, PAIR, Interlock, LeastClearance
from optlaws.cycles.interlocks.polygon import SimplePolygon
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Listed, Text
from optlaws.errors import InputError
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Pair
from optlaws.tolerances import CLEARANCE_SHARE, INTERLOCK

_SQUARED_CLEARANCE = 1e-12  # the same of the square of a distance


@declared
class Forbidden(Interlock, kind="forbidden", title="a forbidden region"):
    """A polygon in the plane of the positions of two axes, which their path does not enter.

    The clearance is the distance of the path from the polygon: in metres of two slides, in radians of two tables; of a
    slide and a table both positions are divided by their strokes.

    Raises
    ------
    InputError
        If there are fewer than three corners, they lie on a line, or sides cross; with axes, if an axis is unknown or a
        position is of another kind.

    Examples
    --------
    >>> corners = [("100 mm", "0 mm"), ("140 mm", "0 mm"), ("140 mm", "60 mm"), ("100 mm", "60 mm")]
    >>> Forbidden("x", "z", corners).words
    'x and z stay out of a polygon of 4 corners'
    """

    axis: str = entry(AXIS, "An axis of the plane.", example="x")
    across: str = entry(AXIS, "The other one.", example="z")
    corners: Sequence[tuple[Any, Any]] = entry(
        Listed(PAIR, least=3, each="corner"),
        "At least three, in order, as pairs of positions; the polygon need not be convex, and its sides do not cross "
        "each other.",
        example=[["100 mm", "0 mm"], ["140 mm", "0 mm"], ["140 mm", "60 mm"]],
    )
    name: str = entry(Text(empty=True), CALLED, default="", kw_only=True)

    @property
    def axes(self) -> tuple[str, str]:
        """The axes of the plane."""
        return self.axis, self.across

    @property
    def words(self) -> str:
        """The forbidden region in words."""
        return f"{self.axis} and {self.across} stay out of a polygon of {len(self.corners)} corners"

    def check(self, cycles: Mapping[str, Any]) -> None:
        """Refuse axes that are not there, corners of another kind, and sides that cross."""
        first, second = self._checked_axes(cycles)
        polygon_of(self, first.axis, second.axis)

    def unit(self, kind: str, other: str) -> str:
        """The unit of distances in the plane; strokes where one axis is linear and the other rotary."""
        return unit_of(kind) if kind == other else "strokes"

    def room(self, cycles: Mapping[str, Any], times: Array) -> Array:
        """The distance of the path from the polygon, below 0 within it."""
        enclosed = [EnclosedAxis(cycles[name]) for name in self.axes]
        sizes = _sizes(*enclosed)
        polygon = polygon_of(self, *(axis.cycle.axis for axis in enclosed)).scaled(*sizes)
        x, y = (axis.cycle(times) / size for axis, size in zip(enclosed, sizes, strict=True))
        depth = polygon.outside(x, y)
        return np.asarray(np.where(depth > 0.0, np.sqrt(polygon.square(x, y)), depth))

    def _least_clearance(self, first: EnclosedAxis, second: EnclosedAxis) -> LeastClearance:
        """The least distance of the path from the polygon; if the path enters it, minus the greatest depth."""
        sizes = _sizes(first, second)
        polygon = polygon_of(self, first.cycle.axis, second.cycle.axis).scaled(*sizes)

        def path(at: Interval, order: int) -> Pair:
            return first.jet(at, order) / sizes[0], second.jet(at, order) / sizes[1]

        outside = polygon.outside
        known = least(lambda at, order: outside(*path(at, order)), (first, second), CLEARANCE_SHARE)
        size = hypot(first.stroke / sizes[0], second.stroke / sizes[1])
        clearance, bound, time = known.least, known.low, known.least_at
        if bound > INTERLOCK * size:
            # beyond a corner the distance is more than that from the lines that meet there
            far = least(lambda at, order: polygon.square(*path(at, order)), (first, second), _SQUARED_CLEARANCE)
            clearance, bound, time = sqrt(max(far.least, 0.0)), max(bound, sqrt(max(far.low, 0.0))), far.least_at
        unit = self.unit(first.cycle.axis, second.cycle.axis)
        return self._least(clearance, bound, unit, time, first.duration, size=size)


def _sizes(first: EnclosedAxis, second: EnclosedAxis) -> tuple[float, float]:
    """Scales of the positions: the strokes if one position is a length and the other an angle."""
    return (1.0, 1.0) if first.cycle.axis == second.cycle.axis else (first.stroke or 1.0, second.stroke or 1.0)


def polygon_of(rule: Forbidden, kind: str, across: str) -> SimplePolygon:
    """The polygon in SI units, where its axes are lengths or angles."""
    try:
        return SimplePolygon.through(corners_of(rule, kind, across))
    except InputError as error:
        raise InputError(f"interlock {rule.label}: {error}") from None


def corners_of(rule: Forbidden, kind: str, across: str) -> list[tuple[float, float]]:
    """The corners in SI units as they were given, where the axes are lengths or angles."""
    where = f"interlock {rule.label}"
    return [
        (quantity(x, kind, f"{where}: {rule.axis}"), quantity(y, across, f"{where}: {rule.across}"))
        for x, y in rule.corners
    ]
