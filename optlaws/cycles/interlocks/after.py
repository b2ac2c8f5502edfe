"""An axis that passes a position only after another is beyond one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from optlaws.cycles.interlocks.enclosed_axis import EnclosedAxis, Way
from optlaws.cycles.interlocks.interlock import AXIS, CALLED, POSITION, Interlock, LeastClearance
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Choice, Text
from optlaws.errors import InputError
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array, Quantity
from optlaws.tolerances import INTERLOCK, SAME_TIME


@declared
class After(Interlock, kind="after", title="an interlock after"):
    """An axis passes a position only after another one is above, or below, a position of its own.

    It holds at every instant of the cycle at which the axis passes the position. Positions are those of the first
    cycle, also where each cycle goes on from the one before.

    Raises
    ------
    InputError
        If not one of above and below is given, or `way` is no direction; with axes, if an axis is unknown, or a
        position is beyond its stroke.

    Examples
    --------
    >>> After("table", "5 deg", of="die", above="31 mm").words
    'table passes 5 deg after die is above 31 mm'
    >>> After("die", "31 mm", of="table", above="10 deg", way="down").words
    'die passes 31 mm on its way down after table is above 10 deg'
    """

    axis: str = entry(AXIS, "What waits.", example="table")
    position: Quantity = entry(
        POSITION, "A position that it passes, not one at which it rests.", example="5 deg", label="passes"
    )
    of: str = entry(AXIS, "The other axis.", kw_only=True, example="die")
    above: Quantity | None = entry(
        POSITION, "Above which of its positions the other axis is by then.", default=None, kw_only=True, example="31 mm"
    )
    below: Quantity | None = entry(POSITION, "Or below which.", default=None, kw_only=True)
    way: Way | None = entry(
        Choice("up", "down"), "Where only passes in one direction count; all unless given.", default=None, kw_only=True
    )
    name: str = entry(Text(empty=True), CALLED, default="", kw_only=True)

    def _check(self) -> None:
        if (self.above is None) == (self.below is None):
            raise InputError("after: say what the other axis is by then: above='31 mm', or below='31 mm', one of them")

    @property
    def axes(self) -> tuple[str, str]:
        """The axis that waits, and the axis for which it waits."""
        return self.axis, self.of

    @property
    def words(self) -> str:
        """The condition of the interlock in words."""
        way = "" if self.way is None else f" on its way {self.way}"
        side = f"above {self.above}" if self.below is None else f"below {self.below}"
        return f"{self.axis} passes {self.position}{way} after {self.of} is {side}"

    @property
    def sign(self) -> float:
        """1 where the other axis is to be above, -1 where below."""
        return 1.0 if self.below is None else -1.0

    def positions(self, cycles: Mapping[str, Any]) -> tuple[float, float]:
        """Both positions in SI units."""
        first, second = self._checked_axes(cycles)
        level = self.above if self.below is None else self.below
        return self._position(self.position, first, self.axis), self._position(level, second, self.of, rest=True)

    def check(self, cycles: Mapping[str, Any]) -> None:
        """Refuse unknown axes, and positions that the axes do not pass."""
        self.positions(cycles)

    def unit(self, kind: str, other: str) -> str:  # noqa: ARG002 - whatever waits
        """The unit of the axis that is to be beyond a position."""
        return unit_of(other)

    def room(self, cycles: Mapping[str, Any], times: Array) -> Array:
        """The signed distance of the other axis beyond its required position."""
        _, level = self.positions(cycles)
        return np.asarray(self.sign * (cycles[self.of](times) - level))

    def events(self, cycles: Mapping[str, Any]) -> list[tuple[float, float | None, bool]]:
        """Each pass: its time, when the other axis comes beyond its position, and whether that is by then."""
        position, level = self.positions(cycles)
        first, second = (EnclosedAxis(cycles[name]) for name in self.axes)
        entering: Way = "up" if self.sign > 0.0 else "down"
        entries = sorted(second.entries(level, entering))
        pairs: list[tuple[float, float | None, bool]] = []
        for start, stop in first.passes(position, self.way):
            time = 0.5 * (start + stop)
            clear = self.sign * (float(second.cycle(time)) - level) >= -INTERLOCK * second.stroke
            later = time + SAME_TIME * second.duration if clear else time
            before, after = (
                [entry for entry in entries if entry <= later],
                [entry for entry in entries if entry > later],
            )
            nearest = (before or entries)[-1:] if clear else (after or entries)[:1]
            pairs.append((time, nearest[0] if nearest else None, clear))
        return pairs

    def _least_clearance(self, first: EnclosedAxis, second: EnclosedAxis) -> LeastClearance:
        """The signed distance of the other axis beyond its required position at the worst passage of this axis."""
        position = quantity(self.position, first.cycle.axis, "position")
        level = quantity(self.above if self.below is None else self.below, second.cycle.axis, "level")
        passes = first.passes(position, self.way)
        if not passes:
            way = "" if self.way is None else f" on its way {self.way}"
            raise InputError(f"interlock {self.label}: {self.axis} never passes {self.position}{way}")
        known = []
        for start, stop in passes:
            low, high = second.between(start, stop)
            time = 0.5 * (start + stop)
            bound = low - level if self.sign > 0.0 else level - high
            known.append((bound, self.sign * (float(second.cycle(time)) - level), time))
        bound, clearance, time = min(known)
        margin = self._margin(second, level, time, clearance)
        unit = self.unit(first.cycle.axis, second.cycle.axis)
        return self._least(clearance, bound, unit, time, first.duration, size=second.stroke, margin=margin)

    def _margin(self, second: EnclosedAxis, level: float, time: float, clearance: float) -> float | None:
        """How long ago the other axis passed its position, or how long it will take until it does, below 0."""
        entering: Way = "up" if self.sign > 0.0 else "down"
        entries = second.entries(level, entering)
        if not entries:
            return None
        if clearance >= 0.0:
            return min((time - entry) % second.duration for entry in entries)
        return -min((entry - time) % second.duration for entry in entries)
