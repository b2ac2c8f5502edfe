"""Axes as the page shows them: bars over the master, interlocks between them, planes of two positions, clearances."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any, cast

from optlaws.cycles.axes.interlock import After, Forbidden, Synchronous
from optlaws.cycles.axes.machine_axes import Axes
from optlaws.cycles.axes.report import AxesReport, Plane
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.specification.segments import Dwell
from optlaws.errors import InputError
from optlaws.explorer.views import cycle_view
from optlaws.explorer.views.cycle_view import CycleRequest, packaged_study
from optlaws.explorer.views.law_view import TITLES, digits, refusing
from optlaws.explorer.views.panel_data import drawn, fact_sentences, panel_data, table_data
from optlaws.motion.quantities import TURN_DEG, UNITS
from optlaws.sentences import Amount, joined, sentence
from optlaws.shown.report import Panel

_WORDS = {
    "clear": ("optimal", "interlocks clear", "Every clearance is proven over the whole cycle, as the table says."),
    "open": ("local", "interlocks open", "Nearer than the enclosures, so that neither is proven: "),
    "broken": ("refused", "interlock broken", "Broken: "),
}
_FIGURES = 12  # of durations that are put into a study


@refusing()
def answer(request: CycleRequest) -> dict[str, Any]:
    """The bars of every axis, and its interlocks in the timing diagram and in planes; or the reason for a refusal."""
    axes = axes_of(request.study)
    report, scale = cast("AxesReport", axes.report()), TURN_DEG / axes.duration
    clearances = map(report.clearance, range(len(axes.rules)))
    return {
        "across": "master",
        "unit": "deg",
        "note": f" ({digits(1e3 * axes.duration)} ms a turn)",
        "period": axes.duration,
        "at": drawn(scale * report.positions[0].series[0].at, 4),
        "rows": list(map(_row, axes.values(), report.positions)),
        "arrows": list(_arrows(axes, report)),
        "planes": [_plane(axes, plane) for plane in report.planes],
        "panels": list(map(panel_data, clearances)),
    }


def axes_of(study: dict[str, Any]) -> Axes:
    """The axes of a study, which are computed once."""
    return _read(json.dumps(study, sort_keys=True))


@lru_cache(maxsize=64)
def _read(question: str) -> Axes:
    spec = cycle_view.machine(json.loads(question))
    cycles = {axis.name: cycle_view.stored(spec, axis) for axis in spec.axis}
    return Axes(cycles, interlocks=spec.interlocks)


def _row(cycle: Cycle, position: Panel) -> dict[str, Any]:
    scale, units = TURN_DEG / cycle.duration, UNITS[cycle.axis]
    return {
        "name": position.name,
        "unit": position.unit,
        "values": drawn(position.series[0].values, 5),
        "bars": [
            {
                "name": peaks.name,
                "moves": not isinstance(segment, Dwell),
                "from": round(scale * peaks.start, 9),
                "to": round(scale * (peaks.start + peaks.duration), 9),
            }
            for segment, peaks in zip(cycle.segments, cycle.peaks, strict=True)
        ],
        "cells": [
            Amount(position.ends[1] - position.ends[0], position.unit),
            *(Amount(cycle.peak(nu) * size, unit) for nu, (unit, size) in enumerate(units) if nu > 0),
            "given" if not cycle.solutions else TITLES[cycle.status],
        ],
    }


def _arrows(axes: Axes, report: AxesReport) -> Iterator[dict[str, Any]]:
    """From when the other axis comes beyond its position to when this one passes its own; or a window of both."""
    scale, names = TURN_DEG / axes.duration, list(axes)
    known = [
        {"rule": number, "name": rule.label, "rows": [names.index(name) for name in rule.axes]}
        for number, rule in enumerate(axes.rules)
    ]
    for arrow in report.arrows:
        start, end = (place and [round(scale * place[0], 6), place[1]] for place in (arrow.start, arrow.end))
        yield known[arrow.number] | {"from": start, "to": end, "clear": arrow.clear}
    for number, rule in enumerate(axes.rules):
        if isinstance(rule, Synchronous):
            yield known[number] | {"window": [scale * at for at in rule.window(axes.duration)]}


def _plane(axes: Axes, plane: Plane) -> dict[str, Any]:
    """The plane of two axes, with the corners of forbidden regions and the ends of walls."""
    regions = []
    for number, region in plane.regions.items():
        rule = axes.rules[number]
        shown = {"rule": number, "name": rule.label, "turned": rule.axes[0] != plane.axes[0]}
        corners = [drawn(point, 5) for point in region]
        shape = (
            {"wall": corners} if isinstance(rule, After) else {"corners": corners, "free": isinstance(rule, Forbidden)}
        )
        regions.append(shown | shape)
    units = [UNITS[axes[name].axis][0][0] for name in plane.axes]
    return {"axes": plane.axes, "units": units, "ranges": plane.ranges, "regions": regions}


@refusing()
def clearances(request: CycleRequest) -> dict[str, Any]:
    """The proven clearances of the interlocks over the whole cycle, and the use of the limits of each axis."""
    axes = axes_of(request.study)
    report = cast("AxesReport", axes.report())
    panels = [
        panel_data(report.clearance(number, least)) | {"beyond": least.status == "broken"}
        for number, least in enumerate(report.clearances)
    ]
    rows = [
        {"name": name, "status": status, "value": Amount(value, unit), "at": angle}
        for name, status, value, _, unit, angle, _ in (least.cells for least in report.clearances)
    ]
    tables = [table_data(each) for each in report.tables]
    return {"rows": rows, "panels": panels, "tables": tables, "trust": _trust(axes, report)}


def _trust(axes: Axes, report: AxesReport) -> dict[str, Any]:
    worst = next((word for word in ("broken", "open") if any(each.status == word for each in axes.broken)), "clear")
    status, word, advice = _WORDS[worst]
    named = "; ".join(each.interlock.label for each in axes.broken if each.status == worst)
    if not axes.rules:
        status, word, advice = "given", "no interlocks", "No interlock between two axes is given."
    limits = [sentence("{}: limits exceeded: {}.", *each) for each in report.beyond]
    if limits:
        status, word = "refused", "beyond a limit" if worst == "clear" else f"{word}, beyond a limit"
    text = joined(" ", [f"{advice}{named}{'.' if named else ''}", *limits])
    proof = any(cycle.solutions for cycle in axes.values())
    return {"status": status, "word": word, "advice": text, "facts": fact_sentences(report.facts), "proof": proof}


@refusing()
def together(request: CycleRequest) -> dict[str, Any]:
    """The study with its moves overlapped, and the gain; or the reason for a refusal."""
    study, axes = request.study, axes_of(request.study)
    overlap = cycle_view.machine(study).overlap_of(axes, Path("the machine"))
    if overlap is None:
        raise InputError("say what the moves are to be put together for: the least period or the least acceleration")
    facts: list[str] = [*fact_sentences(overlap.summary())]
    free = (
        not isinstance(segment, Dwell) and is_optimal(segment) for axis in axes.values() for segment in axis.segments
    )
    if any(free):
        facts.append("the laws of its moves stand in the study as they are")
    return {"facts": facts, "study": _timed(study, overlap.axes)}


def _timed(study: dict[str, Any], axes: Axes) -> dict[str, Any]:
    """The study with the durations that its axes have now, in the unit of its clock."""
    clock = "period" if "period" in study else "speed"
    turn = f"{axes.duration:.{_FIGURES}g} s" if clock == "period" else f"{60.0 / axes.duration:.{_FIGURES}g} rpm"
    size, unit = (1.0, "s") if clock == "period" else (TURN_DEG / axes.duration, "deg")
    changed = []
    for axis in study["axis"]:
        cycle = axes[axis["name"]]
        segments = cycle.to_dict()["segments"]
        for segment, time in zip(segments, cycle.durations, strict=True):
            if isinstance(segment.get("law"), dict):
                segment["law"] = json.dumps(segment["law"])
            segment["duration"] = f"{size * time:.{_FIGURES}g} {unit}"
        changed.append(axis | {"segment": segments})
    same = abs(axes.duration - axes_of(study).duration) == 0.0
    return study | ({} if same else {clock: turn}) | {"axis": changed}


def example() -> dict[str, Any]:
    """The axes that the page shows where none were given: a table that indexes, and a die that waits for it."""
    return packaged_study("cycle_die_and_table", "overlap")
