"""The report of axes: proven clearances, paths over the master, arrows of a timing diagram, planes of two positions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from math import inf
from typing import Any, NamedTuple

import numpy as np

from optlaws.cycles.axes.enclosed import at_positions
from optlaws.cycles.axes.interlock import (
    SMALL_UNITS,
    After,
    Clearance,
    Forbidden,
    Interlock,
    LeastClearance,
    Synchronous,
)
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.placed import broken_limits
from optlaws.cycles.report import objective_unit
from optlaws.kept import kept_property
from optlaws.motion.quantities import TURN_DEG, UNITS
from optlaws.numbers import Array
from optlaws.sentences import joined, quantity_name
from optlaws.shown.curve_points import refined
from optlaws.shown.report import Panel, PanelLimit, ReportSegment, ReportTable, Series
from optlaws.shown.summary import Row, Summary

_PLACES = 241  # of a cycle, to which those are added that its curves need
_PASS = 1.0 / 480.0  # of a cycle to either side of a pass, in which a clearance is to be above 0
_MARGIN = 0.06  # of a range of positions, which a plane shows on both sides


class Arrow(NamedTuple):
    """From when and where the other axis comes beyond its position, if ever, to when and where this one passes its own.

    Times are in seconds, positions in units for display; `clear` is whether the other axis is there by then.
    """

    number: int
    start: tuple[float, float] | None
    end: tuple[float, float]
    clear: bool


class Plane(NamedTuple):
    """The positions of two axes in units for display: the axes to the right and up, and what each range shows.

    `regions` are what interlocks forbid, by their numbers: corners of shape (n, 2), or the two ends of a wall.
    """

    axes: tuple[str, str]
    ranges: tuple[tuple[float, float], tuple[float, float]]
    regions: dict[int, Array]


class AxesReport:
    """The report of axes with their interlocks, whose parts are computed when they are needed."""

    segments: tuple[ReportSegment, ...] = ()

    def __init__(self, cycles: Mapping[str, Cycle], rules: Sequence[Interlock]) -> None:
        self.cycles, self.rules = cycles, rules
        self.duration = next(iter(cycles.values())).duration
        #: of its panels, which are over the master
        self.over: dict[str, Any] = {"across": "master, deg", "per": TURN_DEG / self.duration}

    @kept_property
    def clearances(self) -> tuple[LeastClearance, ...]:
        """The least clearance of every interlock, its place and its margin, proven over the whole cycle."""
        return tuple(rule.least_clearance(self.cycles) for rule in self.rules)

    @property
    def facts(self) -> Summary:
        """The least clearance of every interlock with its proof, limits that are broken, and what laws minimise."""
        clearances = (
            Row(name, value, unit, angle, status if margin is None else f"{status}, time margin {margin:.6g} ms")
            for name, status, value, _, unit, angle, margin in (least.cells for least in self.clearances)
        )
        laws = (
            Row(f"{name}: least {quantity_name(cycle.minimise)} for its times", cycle.objective, objective_unit(cycle),
                note=cycle.status.value)
            for name, cycle in self.cycles.items() if cycle.solutions
        )  # fmt: skip
        beyond = (Row(f"{name}: limit exceeded", text) for name, text in self.beyond)
        return Summary([*clearances, *beyond, *laws], at="deg")

    @kept_property
    def beyond(self) -> list[tuple[str, str]]:
        """Each axis that breaks limits, and which; such as one whose cycle is `unchecked`."""
        broken = {name: broken_limits(cycle) for name, cycle in self.cycles.items()}
        return [(name, joined("; ", texts)) for name, texts in broken.items() if texts]

    @property
    def tables(self) -> tuple[ReportTable, ...]:
        """The least clearances, where there are interlocks."""
        headings = ("interlock", "status", "least clearance", "proven", "unit", "at, deg", "time margin, ms")
        clearances = [least.cells for least in self.clearances]
        return (ReportTable(headings, clearances),) if clearances else ()

    @property
    def panels(self) -> tuple[Panel, ...]:
        """The position of every axis over common times, and every clearance with the least of it as its peak."""
        return (*self.positions, *map(self.clearance, range(len(self.rules)), self.clearances))

    @property
    def data(self) -> dict[str, Any]:
        """The interlocks with their clearances for programs, in SI units."""
        rows = ({**least.to_row(), "rule": least.interlock.to_dict()} for least in self.clearances)
        return {"interlocks": list(rows)} if self.rules else {}

    @kept_property
    def positions(self) -> tuple[Panel, ...]:
        """The position of every axis, in a unit for display, at times that all have in common."""
        curves = [partial(self.position, name) for name in self.cycles]
        joints = [peaks.start for cycle in self.cycles.values() for peaks in cycle.peaks]
        times = np.unique([*np.linspace(0.0, self.duration, _PLACES), *joints])
        times, values = refined(times, [curve(times) for curve in curves], curves, np.empty(0))
        shown = zip(self.cycles.items(), values, strict=True)
        return tuple(
            Panel(name, UNITS[cycle.axis][0][0], (Series(times, places),), ends=ends, **self.over)
            for (name, cycle), places in shown
            for ends in [(float(places.min()), float(places.max()))]
        )

    def position(self, name: str, times: Array | float) -> Array:
        """The position of an axis at times in seconds, in a unit for display."""
        return self._size(name) * np.asarray(self.cycles[name](times))

    def _size(self, name: str) -> float:
        return UNITS[self.cycles[name].axis][0][1]

    def clearance(self, number: int, least: LeastClearance | None = None) -> Panel:
        """The clearance of an interlock: above 0 over the cycle, or at the passes of an `After`; with its least one."""
        rule, duration = self.rules[number], self.duration
        of = rule.unit(*(self.cycles[name].axis for name in rule.axes))
        unit, size = SMALL_UNITS.get(of, (of, 1.0))

        def room(times: Array) -> Array:
            return size * rule.room(self.cycles, times)

        ends = rule.window(duration) if isinstance(rule, Synchronous) else ()
        marks = ends if least is None else (*ends, least.time)
        times = np.linspace(0.0, duration, _PLACES)
        times, (values,) = refined(times, [room(times)], [room], np.array(marks))
        spans = [(0.0, duration)]
        if isinstance(rule, After):
            apart = _PASS * duration
            spans = [(max(0.0, at - apart), min(duration, at + apart)) for at, _, _ in rule.events(self.cycles)]
        limits = tuple(PanelLimit(*span, 0.0, inf) for span in spans)
        peaks = () if least is None else ((least.time, size * least.clearance),)
        return Panel(f"clearance of {rule.label}", unit, (Series(times, values),), limits, peaks, **self.over)

    @property
    def arrows(self) -> Iterator[Arrow]:
        """The passes of every `After`."""
        for number, rule in enumerate(self.rules):
            if isinstance(rule, After):
                position, level = (
                    self._size(name) * place for name, place in zip(rule.axes, rule.positions(self.cycles), strict=True)
                )
                for time, entry, clear in rule.events(self.cycles):
                    yield Arrow(number, None if entry is None else (entry, level), (time, position), clear)

    @kept_property
    def planes(self) -> tuple[Plane, ...]:
        """A plane for each pair of axes with interlocks of their positions."""
        pairs: dict[frozenset[str], tuple[str, str]] = {}
        for rule in self.rules:
            if not isinstance(rule, Synchronous):
                across = (rule.over, rule.axis) if isinstance(rule, Clearance) else rule.axes
                pairs.setdefault(frozenset(rule.axes), across)
        return tuple(map(self._plane, pairs.values()))

    def _plane(self, pair: tuple[str, str]) -> Plane:
        rules = {number: rule for number, rule in enumerate(self.rules) if set(rule.axes) == set(pair)}
        paths, regions, ranges = {panel.name: panel.series[0].values for panel in self.positions}, {}, []
        for number, rule in rules.items():
            if isinstance(rule, Forbidden):
                corners = np.array(rule.in_si(self.cycles).given)[:, :: 1 if rule.axes == pair else -1]
                regions[number] = corners * [self._size(name) for name in pair]
        for i, name in enumerate(pair):
            places = np.concatenate([paths[name], *(region[:, i] for region in regions.values())])
            low, high = float(places.min()), float(places.max())
            margin = _MARGIN * ((high - low) or 1.0)
            ranges.append((low - margin, high + margin))
        for number, rule in rules.items():
            if isinstance(rule, After | Clearance):
                regions[number] = self._region(rule, pair, ranges)
        return Plane(pair, (ranges[0], ranges[1]), dict(sorted(regions.items())))

    def _region(self, rule: After | Clearance, pair: tuple[str, str], ranges: list[tuple[float, float]]) -> Array:
        """The forbidden side of a bound, or the wall that is not passed, up to the ends of the ranges."""
        order, side, given = 1 if rule.axes == pair else -1, 0 if rule.sign > 0.0 else 1, rule.in_si(self.cycles)
        (first, second), (ends, along) = (self._size(name) for name in rule.axes), ranges[::order]
        if isinstance(rule, After):
            wall = [[given[0] * first, level] for level in (given[1] * second, along[side])]
            return np.array(wall)[:, ::order]

        def edge(places: Array) -> Array:
            return np.asarray(at_positions(given, places / second) * first)

        places = np.linspace(*along, _PLACES)
        places, (values,) = refined(places, [edge(places)], [edge], np.empty(0))
        across, up = [*values, ends[side], ends[side]], [*places, places[-1], places[0]]
        return np.column_stack([across, up])[:, ::order]


class OverlapReport(AxesReport):
    """The report of axes that overlap: what is proven of that, before what their own has."""

    def __init__(self, overlap: Any) -> None:
        super().__init__(overlap.axes.cycles, overlap.axes.rules)
        self.overlap = overlap

    @property
    def facts(self) -> Summary:
        return Summary([*self.overlap.summary(), *super().facts], at="deg")

    @kept_property
    def data(self) -> dict[str, Any]:
        """The overlap and the clearances for programs, in SI units."""
        overlap = self.overlap
        known = {"status": overlap.status.value, **overlap.to_dict(), "gain": overlap.gain}
        del known["axes"]  # they stand beside it
        return {**super().data, "overlap": known}
