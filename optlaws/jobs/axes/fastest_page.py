"""Axes at their greatest speed, as the job "cycle" seeks, tables and stores them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from optlaws.cycles.cycle import Cycle
from optlaws.errors import located
from optlaws.results import Page

if TYPE_CHECKING:
    from optlaws.cycles.fastest_cycle import FastestCycle
    from optlaws.cycles.machine_axes import Axes


def fastest_of(cycles: Mapping[str, Cycle], file: Path) -> dict[str, FastestCycle]:
    """Each axis at its greatest speed; errors name the file and the axis."""
    fastest = {}
    for name, cycle in cycles.items():
        with located(f"{file}: axis {name}"):
            fastest[name] = cycle.fastest()
    return fastest


def at_greatest_speed(axes: Axes, fastest: Mapping[str, FastestCycle]) -> Axes:
    """All axes at the greatest speed that every axis allows; unchanged where no speed is sought."""
    if not fastest:
        return axes
    from optlaws.cycles.machine_axes import Axes

    period = max(axis.period for axis in fastest.values())
    cycles = {
        name: fastest[name].cycle
        if fastest[name].period == period
        else replace(cycle, speed=None, period=f"{period!r} s")
        for name, cycle in axes.items()
    }
    return Axes(cycles, interlocks=axes.interlocks)


def fastest_facts(fastest: FastestCycle) -> dict[str, Any]:
    """The greatest speed of an axis for programs."""
    return {
        "status": fastest.status.value,
        "speed": fastest.speed,
        "rpm": fastest.rpm,
        "period": fastest.period,
        "lower_bound": fastest.lower_bound,
        "gains": [{"limit": gain.limit, "speed": gain.speed, "ratio": gain.ratio} for gain in fastest.gains],
        "segments": [
            {"name": each.name, "least": each.least, "duration": each.duration, "limits": list(each.limits),
             "binding": each.binding}
            for each in fastest.segments
        ],
    }  # fmt: skip


def fastest_page(title: str, fastest: Mapping[str, FastestCycle]) -> Page:
    """The greatest speed of each axis, what binds, and what more of it would give."""
    result = Page(title)
    for name, axis in fastest.items():
        result.heading(name).facts(axis.summary())
    return slowest(result, fastest)


def slowest(result: Page, fastest: Mapping[str, FastestCycle]) -> Page:
    """The page with a sentence on the slowest of several axes."""
    if len(fastest) > 1:
        name, axis = max(fastest.items(), key=lambda item: item[1].period)
        result.text(f"The machine is as fast as its slowest axis, {name}: {axis.rpm:.9g} rpm.")
    return result
