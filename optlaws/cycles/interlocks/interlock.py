"""Base class of interlocks: a condition on the positions of two axes, with the least clearance in a cycle."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from optlaws.cycles.interlocks.enclosed_axis import ClockedMotion, EnclosedAxis
from optlaws.cycles.specification.segments import Dwell, Move
from optlaws.entries.declared import Kinded
from optlaws.entries.value_types import Measured, Text, Together
from optlaws.errors import InputError
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import TURN, in_small_units, quantity
from optlaws.numbers import Array
from optlaws.sentences import Amount, sentence
from optlaws.suggest import unknown_key
from optlaws.tolerances import CYCLE_ROUNDING, INTERLOCK, SAME_TIME

#: small units by those of SI, and how many of them make one
SMALL_UNITS = {
    "m": ("mm", 1e3),
    "rad": ("deg", 360.0 / TURN),
    "m/s": ("mm/s", 1e3),
    "rad/s": ("deg/s", 360.0 / TURN),
}


@dataclass(frozen=True)
class LeastClearance:
    """The least clearance of an interlock in a cycle: the value at a time, and the proven bound for all times.

    Attributes
    ----------
    interlock
        The interlock.
    clearance
        The least, at `time`: above 0 where it is clear, below 0 where it is broken; in SI units.
    bound
        Nowhere in the cycle there is less: proven by enclosures over the whole of it. Of this and the clearance what is
        rounding beside the strokes is 0.
    unit
        Of both: "m", "rad", "m/s", or "strokes" where positions of two kinds are divided by their strokes.
    time
        When, in seconds.
    angle
        Where, in degrees of the master.
    margin
        By how many seconds the other axis is early, of an `After`; None of others, or where it is always there.
    status
        "clear" where the bound proves it, "broken" where the clearance disproves it, "open" where neither does.

    Examples
    --------
    >>> from optlaws import After, Axes, Dwell, Return, Rise
    >>> table = {"segments": [Dwell("0.5 s"), Rise("15 deg", "0.4 s", law="cycloidal"), Dwell()], "advance": "15 deg"}
    >>> die = [Rise("50 mm", "0.4 s", law="cycloidal"), Dwell("0.7 s"), Return(law="cycloidal")]
    >>> rule = After("table", "5 deg", of="die", above="31 mm")
    >>> least = Axes({"table": table, "die": die}, period="2 s", interlocks=[rule]).clearances[0]
    >>> least.status, round(least.clearance, 6), round(least.margin, 6), round(least.angle, 3)
    ('clear', 0.019, 0.441568, 119.855)
    """

    interlock: Interlock
    clearance: float
    bound: float
    unit: str
    time: float
    angle: float
    margin: float | None
    status: str

    def to_row(self) -> dict[str, Any]:
        """Its values by their names, plain and JSON-able, for tables and programs."""
        names = ("status", "clearance", "bound", "unit", "time", "angle", "margin")
        return {"interlock": self.interlock.label} | {name: getattr(self, name) for name in names}

    @property
    def cells(self) -> list[Any]:
        """Label, status, clearance, bound, the small unit of both, angle in degrees, margin in milliseconds."""
        unit, size = SMALL_UNITS.get(self.unit, (self.unit, 1.0))
        margin = None if self.margin is None else 1e3 * self.margin
        return [self.interlock.label, self.status, size * self.clearance, size * self.bound, unit, self.angle, margin]

    @property
    def text(self) -> str:
        """The condition as text, in millimetres or degrees."""
        unit, small = SMALL_UNITS.get(self.unit, (self.unit, 1.0))
        early = "" if self.margin is None else f", {1e3 * self.margin:.6g} ms early"
        clearance = Amount(round(small * self.clearance, 6) + 0.0, unit)
        return sentence("{} at {}{}", clearance, Amount(self.angle, "deg"), early)


#: positions at which interlocks look, and pairs of such
POSITION = Measured("length", "angle")
PAIR = Together(POSITION, POSITION)


class AxisName(Text):
    """The name of an axis, which a form offers to choose."""

    def form(self) -> dict[str, Any]:
        return {"axis": True}


AXIS = AxisName()
CALLED = "What reports call it; the condition in words unless given."


class Interlock(Kinded, ABC, title="an interlock"):
    """A condition on the positions of two axes of one clock; subclasses define the condition."""

    name: str

    @classmethod
    def kinds(cls) -> dict[str, type[Self]]:
        """The kinds by their names, whichever was imported first."""
        return dict(sorted(super().kinds().items()))

    @property
    @abstractmethod
    def axes(self) -> tuple[str, str]:
        """The names of the two axes that it is of."""

    @property
    @abstractmethod
    def words(self) -> str:
        """The condition of the interlock in words."""

    @property
    def label(self) -> str:
        """Its name, or the condition in words."""
        return self.name or self.words

    @abstractmethod
    def check(self, cycles: Mapping[str, Any]) -> None:
        """Refuse wrong data before any law is optimised."""

    def least_clearance(self, cycles: Mapping[str, Any]) -> LeastClearance:
        """The least clearance over the whole cycle that cycles by the names of their axes leave it."""
        first, second = (EnclosedAxis(cycles[name]) for name in self.axes)
        return self._least_clearance(first, second)

    def unit(self, kind: str, other: str) -> str:  # noqa: ARG002 - of the other one where a heir says so
        """The SI unit of the clearance, for axes that are lengths or angles: the first axis's unit by default."""
        return unit_of(kind)

    @abstractmethod
    def room(self, cycles: Mapping[str, Any], times: Array) -> Array:
        """The clearance at times in seconds, in SI units, for plots; NaN where the interlock imposes no condition."""

    @abstractmethod
    def _least_clearance(self, first: EnclosedAxis, second: EnclosedAxis) -> LeastClearance:
        """The least clearance over the whole cycle."""

    def _checked_axes(self, cycles: Mapping[str, Any]) -> tuple[ClockedMotion, ClockedMotion]:
        for name in self.axes:
            if name not in cycles:
                raise InputError(f"interlock {self.label}: {unknown_key(name, tuple(cycles), 'axis')}")
        if self.axes[0] == self.axes[1]:
            raise InputError(f"interlock {self.label}: it is of two axes, and both are {self.axes[0]}")
        return cycles[self.axes[0]], cycles[self.axes[1]]

    def _position(self, value: Any, cycle: ClockedMotion, axis: str, *, rest: bool = False) -> float:
        """A position within the stroke of an axis, in SI units; positions at rest are refused where not allowed."""
        position = quantity(value, cycle.axis, f"interlock {self.label}: position of {axis}")
        joints = joint_positions(cycle)
        low, high = min(joints), max(joints)
        slack = INTERLOCK * (high - low)
        shown = in_small_units(position, cycle.axis)
        far = not low - slack <= position <= high + slack
        free = [not isinstance(stretch.given, Move | Dwell) for stretch in cycle.programme.stretches]
        if far and not any(free):
            ends = in_small_units(low, cycle.axis), in_small_units(high, cycle.axis)
            text = "interlock {}: {} goes from {} to {} and never passes {}"
            raise InputError(sentence(text, self.label, axis, *ends, shown))
        still = (joint for joint, before, after in zip(joints, [free[-1], *free], [*free, free[0]], strict=True)
                 if not before and not after)  # fmt: skip
        if not rest and any(abs(position - joint) <= slack for joint in still):
            text = "interlock {}: {} rests at {}: name a position that it passes"
            raise InputError(sentence(text, self.label, axis, shown))
        return position

    def _least(
        self, clearance: float, bound: float, unit: str, time: float, period: float, *, size: float,
        margin: float | None = None,
    ) -> LeastClearance:  # fmt: skip
        slack = INTERLOCK * size
        clearance, bound = (0.0 if abs(value) <= CYCLE_ROUNDING * size else value for value in (clearance, bound))
        margin = 0.0 if margin is not None and abs(margin) <= SAME_TIME * period else margin
        status = "clear" if bound >= -slack else "broken" if clearance < -slack else "open"
        return LeastClearance(self, clearance, bound, unit, time, 360.0 * time / period, margin, status)


def joint_positions(cycle: ClockedMotion) -> list[float]:
    """Positions at which segments meet, both ends included, in SI units."""
    positions = [cycle.programme.start]
    for stretch in cycle.programme.stretches:
        positions.append(positions[-1] + stretch.displacement)
    return positions
