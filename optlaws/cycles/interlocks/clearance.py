"""An axis that stays clear of another: its position is never below, or above, a function of the other's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from optlaws.cycles.interlocks.enclosed_axis import EnclosedAxis, least
from optlaws.cycles.interlocks.interlock import AXIS, CALLED, PAIR, Interlock, LeastClearance
from optlaws.echo import shortened
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Either, Listed, Text, Together
from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.reading import read
from optlaws.formulas.tree import Formula, Table
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet
from optlaws.synthesis.limits.formula_jets import formula_jet
from optlaws.tolerances import CLEARANCE_SHARE, ROUNDOFF

_BOUND = Either(Listed(PAIR, least=2), Text(), which=lambda value: int(isinstance(value, str)))


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

    axis: str = entry(AXIS, "The axis whose position is bounded.", example="head")
    over: str = entry(AXIS, "The axis on whose position the bound depends.", kw_only=True, example="table")
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
    name: str = entry(Text(empty=True), CALLED, default="", kw_only=True)

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
    def axes(self) -> tuple[str, str]:
        """The axis that is bounded, and the axis on which the bound depends."""
        return self.axis, self.over

    @property
    def words(self) -> str:
        """The clearance condition in words."""
        side = "at least" if self.sign > 0.0 else "at most"
        if isinstance(self.given, str):
            return f"{self.axis} is {side} {self.given} of {self.over} ({', '.join(self.units or ())})"
        (first, low), (last, high) = self.given[0], self.given[-1]
        return f"{self.axis} is {side} {low} at {first} to {high} at {last} of {self.over}"

    def check(self, cycles: Mapping[str, Any]) -> None:
        """Refuse axes that are not there and bounds of another kind."""
        first, second = self._checked_axes(cycles)
        bound_of(self, first.axis, second.axis)

    def room(self, cycles: Mapping[str, Any], times: Array) -> Array:
        """The signed distance of the axis from its bound."""
        first, second = (cycles[name] for name in self.axes)
        bound = bound_of(self, first.axis, second.axis)
        return np.asarray(self.sign * (first(times) - bound(second(times))))

    def _least_clearance(self, first: EnclosedAxis, second: EnclosedAxis) -> LeastClearance:
        """The signed distance of the axis from its bound at the nearest point."""
        bound = bound_of(self, first.cycle.axis, second.cycle.axis)

        def room(at: Interval, order: int) -> Jet:
            difference = first.jet(at, order) - bound.jet(second.jet(at, order))
            return difference if self.sign > 0.0 else -difference

        known = least(room, (first, second), CLEARANCE_SHARE)
        unit = self.unit(first.cycle.axis, second.cycle.axis)
        return self._least(known.least, known.low, unit, known.least_at, first.duration, size=first.stroke)

    def formula(self) -> Formula:
        """The bound as a formula of x."""
        formula = read(self.given, names="x")
        if _has_table(formula):
            raise InputError("clearance: give a table as pairs, least=[('0 deg', '20 mm'), ...], not in a formula")
        return formula


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
    """A formula of x with units: `size` is the unit of its value and `scale` is the unit of x, both in SI."""

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


def bound_of(rule: Clearance, kind: str, over: str) -> PositionBound:
    """The bound in SI units, where the axis is a "length" or an "angle" and the other one is of the kind `over`."""
    where = f"interlock {rule.label}"
    if isinstance(rule.given, str):
        sizes = [
            quantity(f"1 {unit}", axis, f"{where}: unit")
            for unit, axis in zip(rule.units or (), (over, kind), strict=True)
        ]
        return FormulaBound(rule.formula(), sizes[0], sizes[1])
    places = [quantity(place, over, f"{where}: position of {rule.over}") for place, _ in rule.given]
    values = [quantity(value, kind, f"{where}: position of {rule.axis}") for _, value in rule.given]
    if any(low >= high for low, high in pairwise(places)):
        raise InputError(f"{where}: positions of {rule.over} must increase, got {shortened(rule.given)}")
    return TableBound(tuple(places), tuple(values))


def _has_table(formula: Formula) -> bool:
    return isinstance(formula, Table) or any(map(_has_table, formula.parts))
