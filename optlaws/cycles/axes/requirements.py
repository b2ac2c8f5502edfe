"""Requirements of interlocks on instants: while a segment of one axis passes, another axis is beyond a level."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from optlaws.cycles.axes.axis_plan import AxisPlan
from optlaws.cycles.axes.interlock import After, Clearance, Forbidden, Interlock
from optlaws.cycles.axes.regions import SimplePolygon
from optlaws.errors import InputError
from optlaws.numbers import Array

_PLACES = 65


@dataclass(frozen=True, eq=False)
class LevelSide:
    """On which side of a level, a function of the position of the axis that passes, the other axis is to be.

    `bends` are positions at which the function is not smooth.
    """

    sign: float
    level: Callable[[float], float]
    bends: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class WaitOption:
    """A side, and a joint of the other axis around which it stays there."""

    side: LevelSide
    joint: int


@dataclass(frozen=True, eq=False)
class Requirement:
    """A condition: while a segment of an axis goes between two positions, the other axis is on one of several sides."""

    rule: Interlock
    axis: AxisPlan
    segment: int
    other: AxisPlan
    sides: tuple[LevelSide, ...]
    places: tuple[float, float]

    @property
    def extended(self) -> bool:
        """Whether the requirement covers more than one position."""
        return self.axis.segments[self.segment].moves and self.places[0] != self.places[1]

    def bends(self) -> list[float]:
        """Shares of the segment where it begins, ends, or a level bends."""
        segment, (low, high) = self.axis.segments[self.segment], sorted(self.places)
        if not segment.moves:
            return [0.0]
        inner = {place for side in self.sides for place in side.bends if low < place < high}
        return sorted(segment.share(place) for place in {low, high, *inner})

    def shares(self) -> Array:
        """Shares of the segment at which it is at positions where the requirement holds: many, with all bends."""
        segment = self.axis.segments[self.segment]
        if not segment.moves:
            return np.zeros(1)
        bends = self.bends()
        return np.union1d(np.linspace(bends[0], bends[-1], _PLACES), bends) if self.extended else np.array(bends[:1])

    def options(self) -> list[WaitOption]:
        """Joints of the other axis that are on a side wherever the segment passes."""
        segment = self.axis.segments[self.segment]
        positions = [segment.position(share) for share in self.shares()]
        options = []
        for side in self.sides:
            levels = [side.level(position) for position in positions]
            for joint in range(len(self.other.positions)):
                repeated = joint > 0 and not self.other.segments[joint - 1].moves
                if not repeated and all(self.other.beyond(joint, level, side.sign) for level in levels):
                    options.append(WaitOption(side, joint))
        return options

    def rows(self, option: WaitOption, share: float) -> list[Array]:
        """Rows over the unknowns that are not negative where the requirement holds after a share of the segment."""
        segment = self.axis.segments[self.segment]
        level = option.side.level(segment.position(share))
        low, high = self.other.window(option.joint, level, option.side.sign)
        early, late = self.axis.event(self.segment, share), self.axis.event(self.segment, share)
        if not segment.moves:
            late = self.axis.instant(self.segment + 1)
        return [row for row in (low if low is None else early - low, high if high is None else high - late)
                if row is not None]  # fmt: skip


def requirements(
    rules: Sequence[Interlock], plans: Mapping[str, AxisPlan], cycles: Mapping[str, Any]
) -> list[Requirement]:
    """All conditions of interlocks on the instants of planned axes."""
    known: list[Requirement] = []
    for rule in rules:
        first, second = (plans[name] for name in rule.axes)
        if isinstance(rule, After):
            known += _of_passes(rule, first, second, cycles)
        elif isinstance(rule, Clearance):
            bound = rule.in_si(cycles)
            side = LevelSide(rule.sign, _plain(bound), getattr(bound, "places", ()))
            known += [
                Requirement(rule, second, i, first, (side,), (segment.start, segment.stop))
                for i, segment in enumerate(second.segments)
            ]
        elif isinstance(rule, Forbidden):
            known += _of_region(rule, first, second, rule.in_si(cycles))
        else:
            raise InputError(f"interlock {rule.label}: only After, Clearance and Forbidden are put together anew")
    return known


def _of_passes(rule: After, first: AxisPlan, second: AxisPlan, cycles: Mapping[str, Any]) -> list[Requirement]:
    position, level = rule.positions(cycles)
    side = LevelSide(rule.sign, lambda _: level)
    return [
        Requirement(rule, first, i, second, (side,), (position, position))
        for i, segment in enumerate(first.segments)
        if (segment.start - position) * (segment.stop - position) < 0.0
        and rule.way in {None, "up" if segment.stop > segment.start else "down"}
    ]


def _of_region(rule: Forbidden, first: AxisPlan, second: AxisPlan, polygon: SimplePolygon) -> list[Requirement]:
    low, high = min(x for x, _ in polygon.corners), max(x for x, _ in polygon.corners)
    bends = tuple(x for x, _ in polygon.corners)
    sides = (
        LevelSide(1.0, lambda x: polygon.section(x)[1], bends),
        LevelSide(-1.0, lambda x: polygon.section(x)[0], bends),
    )
    known = []
    for i, segment in enumerate(first.segments):
        ends = sorted((segment.start, segment.stop))
        places = max(low, ends[0]), min(high, ends[1])
        if places[0] <= places[1]:
            known.append(Requirement(rule, first, i, second, sides, places))
    return known


def _plain(bound: Callable[[Array], Array]) -> Callable[[float], float]:
    return lambda x: float(bound(np.array(x)))
