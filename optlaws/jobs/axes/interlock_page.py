"""Interlocks of axes and how their moves overlap, as the job "cycle" tables and stores them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from optlaws.cycles.interlocks.interlock import SMALL_UNITS, LeastClearance
from optlaws.files.tables import Cell
from optlaws.results import Page

if TYPE_CHECKING:
    from optlaws.cycles.machine_axes import Axes, Overlap

#: the pictures of interlocked axes
TIMING, CLEARANCES, GIVEN = "timing", "clearances", "timing_given"
_CLEARANCE_HEADINGS = ("interlock", "status", "least clearance", "proven", "unit", "at, deg", "early by, ms")
_INTERLOCKS = "What is clear is proven over the whole cycle: nowhere is the clearance below the proven one."


def add_interlocks(result: Page, title: str, axes: Axes, overlap: Overlap | None) -> None:
    """Put what overlaps, timing diagrams and clearances on a page, where there are any."""
    if overlap is not None:
        result.heading("Overlap").table(("what", "value", "unit"), _overlap_rows(overlap), digits=9)
        result.figure(GIVEN, f"{title}: timing diagram as it was given")
    if axes.rules:
        result.figure(TIMING, f"{title}: timing diagram")
        result.heading("Interlocks").figure(CLEARANCES, f"{title}: clearance of the interlocks")
        result.text(_INTERLOCKS).table(_CLEARANCE_HEADINGS, [_clearance_row(least) for least in axes.clearances])


def interlock_facts(axes: Axes, overlap: Overlap | None) -> dict[str, Any]:
    """The least clearances of the interlocks, if any, and the gain of the overlap, if it is sought."""
    known: dict[str, Any] = {"interlocks": [least.to_row() for least in axes.clearances]} if axes.rules else {}
    if overlap is not None:
        names = ("goal", "objective", "lower_bound", "gain")
        facts = {name: getattr(overlap, name) for name in names}
        known["overlap"] = {"status": overlap.status.value, **facts, "binding": list(overlap.binding)}
    return known


def _overlap_rows(overlap: Overlap) -> list[list[Cell]]:
    period = overlap.goal == "period"
    what = "least period" if period else "greatest acceleration, as a share of the given one"
    unit = "s" if period else None
    gain = "times as fast" if period else "times lower"
    rows: list[list[Cell]] = [
        ["status", overlap.status.value, None],
        [what, overlap.objective, unit],
        ["proven lower bound", overlap.lower_bound, unit],
        ["gain", overlap.gain, gain],
    ]
    rows += [["bound by", name, None] for name in overlap.binding]
    return rows


def _clearance_row(least: LeastClearance) -> list[Cell]:
    unit, size = SMALL_UNITS.get(least.unit, (least.unit, 1.0))
    margin = None if least.margin is None else 1e3 * least.margin
    return [least.interlock.label, least.status, size * least.clearance, size * least.bound, unit, least.angle, margin]
