"""Interlocks: conditions on the positions of two axes, with the least clearance that a cycle proves to leave."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import floor, hypot, remainder, sqrt
from typing import Any, ClassVar

import numpy as np

from optlaws.cycles.axes.enclosed import EnclosedAxis, SimplePolygon, Way, at_positions, least
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.limits import AXES
from optlaws.cycles.specification.periods import extent
from optlaws.cycles.specification.segments import Dwell, Move
from optlaws.echo import shortened, unknown_key
from optlaws.entries.declared import Kinded, ValueOf, declared, entry
from optlaws.entries.value_types import Choice, Either, Listed, Measured, Number, Text, Together
from optlaws.errors import InputError, located
from optlaws.formulas.reading import read
from optlaws.formulas.tree import Call, Formula, Name, Table, number
from optlaws.mechanisms.linkages.mechanism_formulas import rescaled, times
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import UNITS, in_small_units, quantity
from optlaws.numbers import Array, Quantity
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet, Pair
from optlaws.sentences import Amount, sentence
from optlaws.tolerances import CLEARANCE_SHARE, CYCLE_ROUNDING, INTERLOCK, SAME_TIME

#: small units by those of SI, and how many of them make one
SMALL_UNITS = {unit_of(axis, nu): UNITS[axis][nu] for axis in UNITS for nu in (0, 1)}
_THOUSANDTHS, _WHOLE = 1000.0, 1e-6  # of a small unit, and how near to a whole one is it
_SQUARED_CLEARANCE = 1e-12  # of the square of a distance what `CLEARANCE_SHARE` is of it


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
        margin = None if self.margin is None else _known(1e3 * self.margin)
        clearance, bound = self.clearance, self.bound
        if self.unit in SMALL_UNITS:
            clearance, bound = _known(size * clearance), _known(size * bound)
        return [self.interlock.label, self.status, clearance, bound, unit, self.angle, margin]

    @property
    def text(self) -> str:
        """The condition as text, in millimetres or degrees."""
        _, _, clearance, _, unit, _, margin = self.cells
        ahead = "" if margin is None else f", time margin {margin:.6g} ms"
        return sentence("{} at {}{}", Amount(clearance, unit), Amount(self.angle, "deg"), ahead)


def _known(value: float) -> float:
    """What a machine knows of a value in millimetres, degrees or milliseconds: thousandths, none of them too many.

    >>> _known(20.24598), _known(8e-6), _known(31.0 - 1e-12)
    (20.245, 0.0, 31.0)
    """
    return floor(_THOUSANDTHS * value + _WHOLE) / _THOUSANDTHS


class AxisName(Text):
    """The name of an axis, which a form offers to choose."""

    def form(self) -> dict[str, Any]:
        return {"axis": True}


_POSITION = Measured("length", "angle")
_PAIR = Together(_POSITION, _POSITION)
_BOUND = Either(Listed(_PAIR, least=2), Text(), which=lambda value: int(isinstance(value, str)))
_AXIS = AxisName()
_CALLED = "What reports call it; the condition in words unless given."


class Interlock(Kinded, ABC, title="an interlock"):
    """A condition on the positions of two axes of one clock; subclasses define the condition."""

    axis: str
    name: str
    _other: ClassVar[str]  #: the entry that names its other axis

    @property
    def axes(self) -> tuple[str, str]:
        """The names of the two axes that it is of."""
        return self.axis, getattr(self, self._other)

    @property
    @abstractmethod
    def words(self) -> str:
        """The condition of the interlock in words."""

    @property
    def label(self) -> str:
        """Its name, or the condition in words."""
        return self.name or self.words

    def check(self, cycles: Mapping[str, Any]) -> None:
        """Refuse wrong data before any law is optimised."""
        self.in_si(cycles)

    def in_si(self, cycles: Mapping[str, Any]) -> Any:
        """What it gives of the positions of cycles by the names of their axes, in SI units; refuse what is wrong."""
        with located(f"interlock {self.label}"):
            for name in self.axes:
                if name not in cycles:
                    raise InputError(unknown_key(name, tuple(cycles), "axis"))
            if self.axes[0] == self.axes[1]:
                raise InputError(f"it is of two axes, and both are {self.axes[0]}")
            return self._in_si(*(cycles[name] for name in self.axes))

    def unit(self, kind: str, other: str) -> str:  # noqa: ARG002 - of the other one where a heir says so
        """The SI unit of the clearance, for axes that are lengths or angles: the first axis's unit by default."""
        return unit_of(kind)

    @abstractmethod
    def room(self, cycles: Mapping[str, Any], times: Array) -> Array:
        """The clearance at times in seconds, in SI units, for plots; NaN where the interlock imposes no condition."""

    def least_clearance(self, cycles: Mapping[str, Any]) -> LeastClearance:
        """The least clearance over the whole cycle that cycles by the names of their axes leave it."""
        first, second = (EnclosedAxis(cycles[name]) for name in self.axes)
        clearance, bound, time, size, *margin = self._least(self.in_si(cycles), first, second)
        slack, period = INTERLOCK * size, first.cycle.duration
        clearance, bound = (0.0 if abs(value) <= CYCLE_ROUNDING * size else value for value in (clearance, bound))
        status = "clear" if bound >= -slack else "broken" if clearance < -slack else "open"
        early = next((0.0 if abs(each) <= SAME_TIME * period else each for each in margin), None)
        unit = self.unit(first.cycle.axis, second.cycle.axis)
        return LeastClearance(self, clearance, bound, unit, time, 360.0 * time / period, early, status)

    @abstractmethod
    def _in_si(self, first: Cycle, second: Cycle) -> Any:
        """What it gives in SI units, of the cycles of its axes."""

    @abstractmethod
    def _least(self, given: Any, first: EnclosedAxis, second: EnclosedAxis) -> tuple[float, ...]:
        """The least clearance over the whole cycle, its bound, its time, the size beside which it is 0; a margin."""


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

    _other = "of"

    axis: str = entry(_AXIS, "What waits.", example="table")
    position: Quantity = entry(
        _POSITION, "A position that it passes, not one at which it rests.", example="5 deg", label="passes"
    )
    of: str = entry(_AXIS, "The other axis.", kw_only=True, example="die")
    above: Quantity | None = entry(
        _POSITION, "Above which of its positions the other axis is by then.", default=None, kw_only=True,
        example="31 mm",
    )  # fmt: skip
    below: Quantity | None = entry(_POSITION, "Or below which.", default=None, kw_only=True)
    way: Way | None = entry(
        Choice("up", "down"), "Where only passes in one direction count; all unless given.", default=None, kw_only=True
    )
    name: str = entry(Text(empty=True), _CALLED, default="", kw_only=True)

    def _check(self) -> None:
        if (self.above is None) == (self.below is None):
            raise InputError("after: say what the other axis is by then: above='31 mm', or below='31 mm', one of them")

    @property
    def words(self) -> str:
        side = f"above {self.above}" if self.below is None else f"below {self.below}"
        return f"{self.axis} passes {self.position}{self._way} after {self.of} is {side}"

    @property
    def _way(self) -> str:
        return "" if self.way is None else f" on its way {self.way}"

    @property
    def sign(self) -> float:
        """1 where the other axis is to be above, -1 where below."""
        return 1.0 if self.below is None else -1.0

    def positions(self, cycles: Mapping[str, Any]) -> tuple[float, float]:
        """Both positions in SI units."""
        passed, level = self.in_si(cycles)
        return passed, level

    def _in_si(self, first: Cycle, second: Cycle) -> tuple[float, float]:
        level = self.above if self.below is None else self.below
        return _passed(self.position, first, self.axis), _passed(level, second, self.of, rest=True)

    def unit(self, kind: str, other: str) -> str:  # noqa: ARG002 - whatever waits
        return unit_of(other)

    def room(self, cycles: Mapping[str, Any], times: Array) -> Array:
        return np.asarray(self.sign * (cycles[self.of](times) - self.positions(cycles)[1]))

    def events(self, cycles: Mapping[str, Any]) -> list[tuple[float, float | None, bool]]:
        """Each pass: its time, when the other axis comes beyond its position, and whether that is by then."""
        first, second = (EnclosedAxis(cycles[name]) for name in self.axes)
        given = self.positions(cycles)
        entries = self._entries(second, given[1])
        pairs: list[tuple[float, float | None, bool]] = []
        for _, clearance, time in self._passes(given, first, second):
            clear = clearance >= -INTERLOCK * second.stroke
            later = time + SAME_TIME * second.cycle.duration if clear else time
            before, after = ([at for at in entries if (at <= later) == early] for early in (True, False))
            nearest = (before or entries)[-1:] if clear else (after or entries)[:1]
            pairs.append((time, nearest[0] if nearest else None, clear))
        return pairs

    def _passes(
        self, given: tuple[float, float], first: EnclosedAxis, second: EnclosedAxis
    ) -> Iterator[tuple[float, float, float]]:
        """Of each pass the bound of the clearance, the clearance, and the time."""
        for start, stop in first.passes(given[0], self.way):
            time, level = 0.5 * (start + stop), given[1]
            low, high = second.between(start, stop)
            bound = low - level if self.sign > 0.0 else level - high
            yield bound, self.sign * (float(second.cycle(time)) - level), time

    def _entries(self, second: EnclosedAxis, level: float) -> list[float]:
        """When the other axis comes beyond its position."""
        return sorted(second.entries(level, "up" if self.sign > 0.0 else "down"))

    def _least(self, given: tuple[float, float], first: EnclosedAxis, second: EnclosedAxis) -> tuple[float, ...]:
        """The signed distance of the other axis beyond its required position at the worst passage of this axis.

        The margin is how long ago it passed that position, or how long it will take until it does, below 0.
        """
        known = list(self._passes(given, first, second))
        if not known:
            raise InputError(f"interlock {self.label}: {self.axis} never passes {self.position}{self._way}")
        bound, clearance, time = min(known)
        way, period = 1.0 if clearance >= 0.0 else -1.0, second.cycle.duration
        early = [way * ((way * (time - at)) % period) for at in self._entries(second, given[1])]
        if abs(clearance) <= CYCLE_ROUNDING * second.stroke:
            # where both pass at once either may be first by a rounding
            early = [remainder(time - at, period) for at in self._entries(second, given[1])]
        return clearance, bound, time, second.stroke, *sorted(early, key=abs)[:1]


def _passed(value: Any, cycle: Cycle, axis: str, *, rest: bool = False) -> float:
    """A position within the stroke of an axis, in SI units; positions at rest are refused where not allowed."""
    position = quantity(value, cycle.axis, f"position of {axis}")
    stretches = cycle.programme.stretches
    joints = cycle.programme.offsets
    low, high = min(joints), max(joints)
    slack = INTERLOCK * (high - low)
    shown = in_small_units(position, cycle.axis)
    free = [not isinstance(stretch.given, Move | Dwell) for stretch in stretches]
    if not low - slack <= position <= high + slack and not any(free):
        ends = in_small_units(low, cycle.axis), in_small_units(high, cycle.axis)
        raise InputError(sentence("{} goes from {} to {} and never passes {}", axis, *ends, shown))
    still = (joint for joint, before, after in zip(joints, [free[-1], *free], [*free, free[0]], strict=True)
             if not before and not after)  # fmt: skip
    if not rest and any(abs(position - joint) <= slack for joint in still):
        raise InputError(sentence("{} rests at {}: name a position that it passes", axis, shown))
    return position


@declared
class Clearance(Interlock, kind="clearance"):
    """The position of an axis is at least, or at most, a function of another's position, over the whole cycle.

    Raises
    ------
    InputError
        If not one of least and most is given, pairs do not increase, or a formula cannot be read or has no units; with
        axes, if an axis is unknown or a position is of another kind.

    Examples
    --------
    >>> Clearance("head", over="table", least=[("0 deg", "20 mm"), ("45 deg", "60 mm")]).words
    'head is at least 20 mm at 0 deg to 60 mm at 45 deg of table'
    >>> Clearance("head", over="table", least="20 + 40*x/45", units=("deg", "mm")).words
    'head is at least 20 + 40*x/45 of table (deg, mm)'
    """

    _other = "over"

    axis: str = entry(_AXIS, "The axis whose position is bounded.", example="head")
    over: str = entry(_AXIS, "The axis on whose position the bound depends.", kw_only=True, example="table")
    least: Any = entry(
        _BOUND,
        "The least position: pairs of a position of `over` and the bound there, straight between them and constant "
        'beyond; or a formula of x, such as "20 + 40*x/45".',
        default=None,
        kw_only=True,
        example=[["0 deg", "20 mm"], ["45 deg", "60 mm"]],
    )
    most: Any = entry(_BOUND, "The greatest position, likewise; one of them.", default=None, kw_only=True)
    units: Sequence[str] | None = entry(
        Together(Text(), Text()),
        'Of a formula: the unit of x and that of the bound, such as ["deg", "mm"].',
        default=None,
        kw_only=True,
    )
    name: str = entry(Text(empty=True), _CALLED, default="", kw_only=True)

    def _check(self) -> None:
        if (self.least is None) == (self.most is None):
            raise InputError(
                "clearance: give the least position, least=[('0 deg', '20 mm'), ...], or the most, not both"
            )
        if isinstance(self.given, str):
            self.formula()
            if self.units is None:
                raise InputError("clearance: a formula needs the units of x and of its value, such as ('deg', 'mm')")
        elif self.units is not None:
            raise InputError("clearance: pairs have their units in them: leave `units` out")

    @property
    def given(self) -> Any:
        """The bound as it was given."""
        return self.most if self.least is None else self.least

    @property
    def sign(self) -> float:
        """1 where the bound is the least position, -1 where the greatest."""
        return -1.0 if self.least is None else 1.0

    @property
    def words(self) -> str:
        side = "at least" if self.sign > 0.0 else "at most"
        if isinstance(self.given, str):
            return f"{self.axis} is {side} {self.given} of {self.over} ({', '.join(self.units or ())})"
        (first, low), (last, high) = self.given[0], self.given[-1]
        return f"{self.axis} is {side} {low} at {first} to {high} at {last} of {self.over}"

    def formula(self) -> Formula:
        """The bound as a formula of x."""
        formula = read(self.given, names="x")
        if any(isinstance(part, Table) for part in formula.different):
            raise InputError("clearance: give a table as pairs, least=[('0 deg', '20 mm'), ...], not in a formula")
        return formula

    def _in_si(self, first: Cycle, second: Cycle) -> Formula:
        """The bound as a formula of x in SI units; straight lines through pairs, constant beyond them."""
        kinds = second.axis, first.axis
        if isinstance(self.given, str):
            units = zip(self.units or (), kinds, strict=True)
            size, scale = (quantity(f"1 {unit}", kind, "unit") for unit, kind in units)
            return times(rescaled(self.formula(), "x", "x", (0.0, 1.0 / size)), scale)
        places, values = (
            tuple(quantity(value, kind, f"position of {name}") for value in side)
            for side, kind, name in zip(zip(*self.given, strict=True), kinds, (self.over, self.axis), strict=True)
        )
        if any(low >= high for low, high in pairwise(places)):
            raise InputError(f"positions of {self.over} must increase, got {shortened(self.given)}")
        within = Call("max", (Call("min", (Name("x"), number(places[-1]))), number(places[0])))
        return Table(within, places, values)

    def _between(self, given: Formula, first: Any, second: Any) -> Any:
        """How far the position of the first axis is beyond the bound, for positions and for jets of them."""
        difference = first - at_positions(given, second)
        return difference if self.sign > 0.0 else -difference

    def room(self, cycles: Mapping[str, Any], times: Array) -> Array:
        return np.asarray(self._between(self.in_si(cycles), *(cycles[name](times) for name in self.axes)))

    def _least(self, given: Formula, first: EnclosedAxis, second: EnclosedAxis) -> tuple[float, ...]:
        def room(at: Interval, order: int) -> Jet:
            between: Jet = self._between(given, first.jet(at, order), second.jet(at, order))
            return between

        known = least(room, (first, second), CLEARANCE_SHARE)
        return known.least, known.low, known.least_at, first.stroke


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

    _other = "across"

    axis: str = entry(_AXIS, "An axis of the plane.", example="x")
    across: str = entry(_AXIS, "The other one.", example="z")
    corners: Sequence[tuple[Any, Any]] = entry(
        Listed(_PAIR, least=3, each="corner"),
        "At least three, in order, as pairs of positions; the polygon need not be convex, and its sides do not cross "
        "each other.",
        example=[["100 mm", "0 mm"], ["140 mm", "0 mm"], ["140 mm", "60 mm"]],
    )
    name: str = entry(Text(empty=True), _CALLED, default="", kw_only=True)

    @property
    def words(self) -> str:
        return f"{self.axis} and {self.across} stay out of a polygon of {len(self.corners)} corners"

    def _in_si(self, first: Cycle, second: Cycle) -> SimplePolygon:
        return SimplePolygon.through(
            [(quantity(x, first.axis, self.axis), quantity(y, second.axis, self.across)) for x, y in self.corners]
        )

    def unit(self, kind: str, other: str) -> str:
        """The unit of distances in the plane; strokes where one axis is linear and the other rotary."""
        return unit_of(kind) if kind == other else "strokes"

    def room(self, cycles: Mapping[str, Any], times: Array) -> Array:
        axes = [EnclosedAxis(cycles[name]) for name in self.axes]
        sizes = _sizes(*axes)
        polygon = self.in_si(cycles).scaled(*sizes)
        path = [axis.cycle(times) / size for axis, size in zip(axes, sizes, strict=True)]
        depth = polygon.outside(*path)
        return np.asarray(np.where(depth > 0.0, np.sqrt(polygon.square(*path)), depth))

    def _least(self, given: SimplePolygon, first: EnclosedAxis, second: EnclosedAxis) -> tuple[float, ...]:
        """The least distance of the path from the polygon; if the path enters it, minus the greatest depth."""
        axes, sizes = (first, second), _sizes(first, second)
        polygon = given.scaled(*sizes)

        def path(at: Interval, order: int) -> Pair:
            return first.jet(at, order) / sizes[0], second.jet(at, order) / sizes[1]

        outside = polygon.outside
        known = least(lambda at, order: outside(*path(at, order)), axes, CLEARANCE_SHARE)
        size = hypot(first.stroke / sizes[0], second.stroke / sizes[1])
        if known.low <= INTERLOCK * size:
            return known.least, known.low, known.least_at, size
        # beyond a corner the distance is more than that from the lines that meet there
        far = least(lambda at, order: polygon.square(*path(at, order)), axes, _SQUARED_CLEARANCE)
        return sqrt(max(far.least, 0.0)), max(known.low, sqrt(max(far.low, 0.0))), far.least_at, size


def _sizes(first: EnclosedAxis, second: EnclosedAxis) -> tuple[float, float]:
    """Scales of the positions: the strokes if one position is a length and the other an angle."""
    return (1.0, 1.0) if first.cycle.axis == second.cycle.axis else (first.stroke or 1.0, second.stroke or 1.0)


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

    _other = "to"

    axis: str = entry(_AXIS, "The axis that follows.", example="shear")
    to: str = entry(_AXIS, "The axis with which it runs.", example="belt")
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
    name: str = entry(Text(empty=True), _CALLED, default="", kw_only=True)

    @property
    def words(self) -> str:
        times = "" if self.ratio == 1.0 else f" at {self.ratio:g} times its velocity"
        return f"{self.axis} runs with {self.to}{times} from {self.during[0]} to {self.during[1]} within {self.within}"

    def window(self, period: float) -> tuple[float, float]:
        """Begin and end of the window, in seconds."""
        start, stop = (extent(place, f"interlock {self.label}: during").at(period) for place in self.during)
        if not 0.0 <= start < stop <= period:
            raise InputError(f"interlock {self.label}: during is two places of one cycle, the earlier one first")
        return start, stop

    def _in_si(self, first: Cycle, second: Cycle) -> float:
        """The tolerance of the velocities."""
        if first.axis != second.axis:
            raise InputError("one axis moves by lengths, the other by angles")
        return quantity(self.within, AXES[first.axis][1], "within")

    def check(self, cycles: Mapping[str, Any]) -> None:
        super().check(cycles)
        self.window(cycles[self.axis].duration)

    def unit(self, kind: str, other: str) -> str:  # noqa: ARG002 - both are of one kind
        return unit_of(kind, 1)

    def room(self, cycles: Mapping[str, Any], times: Array) -> Array:
        first, second = (cycles[name] for name in self.axes)
        start, stop = self.window(first.duration)
        difference = np.abs(first(times, 1) - self.ratio * second(times, 1))
        return np.where((times >= start) & (times <= stop), self.in_si(cycles) - difference, np.nan)

    def _least(self, given: float, first: EnclosedAxis, second: EnclosedAxis) -> tuple[float, ...]:
        def difference(at: Interval, order: int) -> Jet:
            return first.jet(at, order + 1).slope() - second.jet(at, order + 1).slope() * self.ratio

        known = least(difference, (first, second), CLEARANCE_SHARE, self.window(first.cycle.duration))
        time = known.least_at if known.least < -known.most else known.most_at
        return given - known.peak, given - known.bound, time, given


#: the interlocks of a machine, which errors call by their numbers
INTERLOCKS = Listed(ValueOf(Interlock), each="interlock")
