"""Two axes that run at the same velocity over a window of the clock."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from optlaws.cycles.interlocks.enclosed_axis import ClockedMotion, EnclosedAxis, least
from optlaws.cycles.interlocks.interlock import AXIS, CALLED, Interlock, LeastClearance
from optlaws.cycles.specification.programme import AXES, time_of
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Measured, Number, Text, Together
from optlaws.errors import InputError
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array, Quantity
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import CLEARANCE_SHARE


@declared
class Synchronous(Interlock, kind="synchronous", title="a synchronous motion"):
    """An axis runs at the velocity of another, or at a multiple of it, over a window of the clock.

    The clearance is the tolerance less the greatest difference of the velocities in the window.

    Raises
    ------
    InputError
        If the window is none, or the ratio no number; with axes, if an axis is unknown, they move in different ways,
        one a length and the other an angle, or the tolerance is no velocity above 0.

    Examples
    --------
    >>> Synchronous("shear", "belt", during=("60 deg", "120 deg"), within="1 mm/s").words
    'shear runs with belt from 60 deg to 120 deg within 1 mm/s'
    """

    axis: str = entry(AXIS, "The axis that follows.", example="shear")
    to: str = entry(AXIS, "The axis with which it runs.", example="belt")
    during: tuple[Quantity, Quantity] = entry(
        Together(Measured("angle", "time"), Measured("angle", "time")),
        "From when to when: two angles of the master or times.",
        kw_only=True,
        example=["60 deg", "120 deg"],
    )
    within: Quantity = entry(
        Measured("velocity", "angular velocity", above=0.0),
        "By how much the velocities may differ.",
        kw_only=True,
        example="1 mm/s",
    )
    ratio: float = entry(Number(), "Of the velocity of `axis` to that of `to`.", default=1.0, kw_only=True)
    name: str = entry(Text(empty=True), CALLED, default="", kw_only=True)

    @property
    def axes(self) -> tuple[str, str]:
        """The two axes whose velocities are compared."""
        return self.axis, self.to

    @property
    def words(self) -> str:
        """The condition of synchronous motion in words."""
        times = "" if self.ratio == 1.0 else f" at {self.ratio:g} times its velocity"
        return f"{self.axis} runs with {self.to}{times} from {self.during[0]} to {self.during[1]} within {self.within}"

    def window(self, period: float) -> tuple[float, float]:
        """Begin and end of the window, in seconds."""
        start, stop = (time_of(place, period, f"interlock {self.label}: during") for place in self.during)
        if not 0.0 <= start < stop <= period:
            raise InputError(f"interlock {self.label}: during is two places of one cycle, the earlier one first")
        return start, stop

    def check(self, cycles: Mapping[str, Any]) -> None:
        """Refuse axes that are not there or of two kinds, and a window that is none."""
        first, second = self._checked_axes(cycles)
        if first.axis != second.axis:
            raise InputError(f"interlock {self.label}: one axis moves by lengths, the other by angles")
        self.window(first.duration)
        self._tolerance(first)

    def unit(self, kind: str, other: str) -> str:  # noqa: ARG002 - both are of one kind
        """The unit of velocities."""
        return unit_of(kind, 1)

    def room(self, cycles: Mapping[str, Any], times: Array) -> Array:
        """The tolerance minus the difference of the velocities, in the window."""
        first, second = (cycles[name] for name in self.axes)
        start, stop = self.window(first.duration)
        difference = np.abs(first(times, 1) - self.ratio * second(times, 1))
        return np.where((times >= start) & (times <= stop), self._tolerance(first) - difference, np.nan)

    def _least_clearance(self, first: EnclosedAxis, second: EnclosedAxis) -> LeastClearance:
        """The tolerance less the greatest difference of the velocities."""
        window, tolerance = self.window(first.duration), self._tolerance(first.cycle)

        def difference(at: Interval, order: int) -> Jet:
            return first.jet(at, order + 1).slope() - second.jet(at, order + 1).slope() * self.ratio

        known = least(difference, (first, second), CLEARANCE_SHARE, window)
        low, high = known.least < -known.most, known.peak
        time = known.least_at if low else known.most_at
        unit = self.unit(first.cycle.axis, second.cycle.axis)
        return self._least(tolerance - high, tolerance - known.bound, unit, time, first.duration, size=tolerance)

    def _tolerance(self, cycle: ClockedMotion) -> float:
        return quantity(self.within, AXES[cycle.axis][1], f"interlock {self.label}: within")
