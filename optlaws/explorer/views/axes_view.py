"""Axes as the page shows them: bars over the master, interlocks between them, planes of two positions, clearances."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.interlocks.after import After
from optlaws.cycles.interlocks.forbidden_region import Forbidden
from optlaws.cycles.interlocks.interlock import SMALL_UNITS, Interlock, LeastClearance
from optlaws.cycles.interlocks.synchronous import Synchronous
from optlaws.cycles.machine_axes import Axes
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.specification.segments import Dwell
from optlaws.errors import InputError
from optlaws.explorer.views import cycle_view
from optlaws.explorer.views.cycle_view import CycleRequest, packaged_study
from optlaws.explorer.views.law_view import TITLES, digits, refusing
from optlaws.explorer.views.panel_data import drawn, fact_sentences
from optlaws.explorer.views.requests import Question
from optlaws.jobs.cycle_entries import CycleProblemFile
from optlaws.motion.display_units import TURN_DEG, UNITS
from optlaws.numbers import Array
from optlaws.plots.interlocks import forbidden_region, plane_axes, wider
from optlaws.sentences import Amount, joined, sentence
from optlaws.shown.curve_points import refined

_PLACES = 241
_WHERE = Path("the machine")
_PASS = 0.75  # degrees to either side of a pass, in which a clearance is to be above 0
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
    times, positions = _positions(axes)
    return {
        "across": f"master, deg ({digits(1e3 * axes.duration)} ms a turn)",
        "period": axes.duration,
        "at": drawn(TURN_DEG / axes.duration * times, 4),
        "rows": [_row(name, cycle, values) for (name, cycle), values in zip(axes.items(), positions, strict=True)],
        "arrows": [arrow for number, rule in enumerate(axes.rules) for arrow in _arrows(axes, number, rule)],
        "planes": list(_planes(axes, dict(zip(axes, positions, strict=True)))),
        "panels": [_room(axes, rule, times) for rule in axes.rules],
    }


def axes_of(study: dict[str, Any]) -> Axes:
    """The axes of a study.

    Raises
    ------
    InputError
        If an entry is unknown or wrong, or larger than the explorer takes, or a law is named by a file.
    """
    return _read(json.dumps(study, sort_keys=True))


@lru_cache(maxsize=64)
def _read(question: str) -> Axes:
    spec = CycleProblemFile.read(json.loads(question), _WHERE)
    cycles: dict[str, Cycle] = {}
    for axis in spec.axis:
        if axis.name in cycles:
            raise InputError(f"two axes are called {axis.name}: give each a name of its own")
        cycle_view.check_axis(axis)
        cycles[axis.name] = cycle_view.stored(spec, axis)
    return Axes(cycles, interlocks=spec.interlocks)


def _positions(axes: Axes) -> tuple[Array, list[Array]]:
    """Times at which all paths are drawn, and the positions of each axis there in small units."""
    joints = [peaks.start for cycle in axes.values() for peaks in cycle.peaks]
    times = np.unique([*np.linspace(0.0, axes.duration, _PLACES), *joints])
    curves = [_position_of(cycle) for cycle in axes.values()]
    return refined(times, [curve(times) for curve in curves], curves, np.empty(0))


def _position_of(cycle: Cycle) -> Any:
    size = UNITS[cycle.axis][0][1]
    return lambda times: size * np.asarray(cycle(times))


def _row(name: str, cycle: Cycle, values: Array) -> dict[str, Any]:
    scale, units = TURN_DEG / cycle.duration, UNITS[cycle.axis]
    return {
        "name": name,
        "unit": units[0][0],
        "values": drawn(values, 5),
        "bars": [
            {
                "name": peaks.name,
                "moves": not isinstance(segment, Dwell),
                "from": round(scale * peaks.start, 9),
                "to": round(scale * (peaks.start + peaks.duration), 9),
            }
            for segment, peaks in zip(cycle.segments, cycle.peaks, strict=True)
        ],
        "stroke": Amount(float(np.ptp(values)), units[0][0]),
        "peaks": [Amount(cycle.peak(nu) * size, unit) for nu, (unit, size) in enumerate(units) if nu > 0],
        "law": "given" if not cycle.solutions else TITLES[cycle.status],
    }


def _arrows(axes: Axes, number: int, rule: Interlock) -> Iterator[dict[str, Any]]:
    """From when the other axis comes beyond its position to when this one passes its own; or a window of both."""
    scale, names = TURN_DEG / axes.duration, list(axes)
    rows = [names.index(name) for name in rule.axes]
    if isinstance(rule, Synchronous):
        yield {
            "rule": number,
            "name": rule.label,
            "rows": rows,
            "window": [scale * at for at in rule.window(axes.duration)],
        }
    if not isinstance(rule, After):
        return
    position, level = (
        UNITS[axes[name].axis][0][1] * place for name, place in zip(rule.axes, rule.positions(axes), strict=True)
    )
    for time, entry, clear in rule.events(axes):
        yield {
            "rule": number,
            "name": rule.label,
            "rows": rows,
            "to": [round(scale * time, 6), position],
            "from": None if entry is None else [round(scale * entry, 6), level],
            "clear": clear,
        }


def _planes(axes: Axes, positions: dict[str, Array]) -> Iterator[dict[str, Any]]:
    """A plane for each pair of interlocked axes, with its forbidden regions."""
    planes: dict[frozenset[str], tuple[str, str]] = {}
    for rule in axes.rules:
        if not isinstance(rule, Synchronous):
            planes.setdefault(frozenset(rule.axes), plane_axes(rule))
    for pair, plane in planes.items():
        rules = [(number, rule) for number, rule in enumerate(axes.rules) if set(rule.axes) == pair]
        corners = [
            forbidden_region(axes, rule, plane, ((0.0, 0.0), (0.0, 0.0)))
            for _, rule in rules
            if isinstance(rule, Forbidden)
        ]
        limits = [
            wider([positions[name], *(corner[:, i] for corner in corners if corner is not None)])
            for i, name in enumerate(plane)
        ]
        yield {
            "axes": list(plane),
            "units": [UNITS[axes[name].axis][0][0] for name in plane],
            "ranges": limits,
            "regions": [shown for number, rule in rules for shown in _region(axes, number, rule, plane, limits)],
        }


def _region(
    axes: Axes, number: int, rule: Interlock, plane: tuple[str, str], limits: Sequence[tuple[float, float]]
) -> Iterator[dict[str, Any]]:
    """The part of a plane that an interlock forbids: the corners of a region, or a wall."""
    region = forbidden_region(axes, rule, plane, limits)
    if region is None:
        return
    shown: dict[str, Any] = {"rule": number, "name": rule.label}
    corners = [drawn(point, 5) for point in region]
    if isinstance(rule, After):
        yield shown | {"wall": corners}
    else:
        yield shown | {"corners": corners, "free": isinstance(rule, Forbidden), "turned": rule.axes[0] != plane[0]}


def _room(axes: Axes, rule: Interlock, times: Array) -> dict[str, Any]:
    """The clearance of an interlock over the master, as a panel."""
    of = rule.unit(*(axes[name].axis for name in rule.axes))
    unit, size = SMALL_UNITS.get(of, (of, 1.0))
    scale = TURN_DEG / axes.duration

    def room(at: Array) -> Array:
        return size * rule.room(axes, at)

    ends = np.array(rule.window(axes.duration)) if isinstance(rule, Synchronous) else np.empty(0)
    passes = [scale * time for time, _, _ in rule.events(axes)] if isinstance(rule, After) else None
    at, (values,) = refined(times, [room(times)], [room], ends)
    spans = [(0.0, TURN_DEG)] if passes is None else [(at - _PASS, at + _PASS) for at in passes]
    limits = [
        {"from": max(0.0, start), "to": min(TURN_DEG, stop), "value": None, "least": 0.0} for start, stop in spans
    ]
    curve = {"at": drawn(scale * at, 4), "values": drawn(values)}
    return {"name": f"clearance of {rule.label}", "unit": unit, "series": [curve], "limits": limits, "peaks": []}


@refusing()
def clearances(request: CycleRequest) -> dict[str, Any]:
    """The proven clearances of the interlocks over the whole cycle, and the use of the limits of each axis.

    Examples
    --------
    >>> clearances(CycleRequest(study=example()))["trust"]["word"]
    'interlocks clear'
    """
    axes = axes_of(request.study)
    return {"rows": [_clearance(least) for least in axes.clearances], "trust": _trust(axes)}


def _clearance(least: LeastClearance) -> dict[str, Any]:
    name, status, value, bound, unit, angle, margin = least.cells
    early = "" if margin is None else digits(margin, 6)
    cells = [Amount(value, unit), Amount(bound, unit), digits(angle, 6), early]
    return {"name": name, "status": status, "value": value, "at": angle, "cells": cells}


def _trust(axes: Axes) -> dict[str, Any]:
    facts = [sentence("{}: {}", least.interlock.label, least.text) for least in axes.clearances]
    facts += [
        sentence("{}: least {} for its times, {}", name, cycle.minimise, TITLES[cycle.status])
        for name, cycle in axes.items()
        if cycle.solutions
    ]
    worst = next((word for word in ("broken", "open") if any(each.status == word for each in axes.broken)), "clear")
    status, word, advice = _WORDS[worst]
    named = "; ".join(each.interlock.label for each in axes.broken if each.status == worst)
    if not axes.rules:
        status, word, advice = "given", "no interlocks", "Nothing is asked of two axes at a time."
    limits = [
        sentence("{}: {}", name, broken["advice"])
        for name, cycle in axes.items()
        if (broken := cycle_view.broken_limits(cycle))
    ]
    if limits:
        status, word = "refused", "beyond a limit" if worst == "clear" else f"{word}, beyond a limit"
    text = joined(" ", [f"{advice}{named}{'.' if named else ''}", *limits])
    proof = any(cycle.solutions for cycle in axes.values())
    return {"status": status, "word": word, "advice": text, "gap": "", "facts": facts, "proof": proof}


@refusing()
def together(request: CycleRequest) -> dict[str, Any]:
    """The study with its moves overlapped, and the gain; or the reason for a refusal.

    Examples
    --------
    >>> answered = together(CycleRequest(study=example() | {"overlap": {"goal": "acceleration", "of": ["die"]}}))
    >>> answered["facts"][1]
    'greatest acceleration, as a share of the given one 0.1938937'
    """
    study, axes = request.study, axes_of(request.study)
    overlap = CycleProblemFile.read(study, _WHERE).overlap_of(axes, _WHERE)
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
    timed = {name: cycle.to_dict()["segments"] for name, cycle in axes.items()}
    for segments in timed.values():
        for segment in segments:
            if isinstance(segment.get("law"), dict):
                segment["law"] = json.dumps(segment["law"])
            seconds = float(segment["duration"].split()[0])
            size, unit = (1.0, "s") if clock == "period" else (TURN_DEG / axes.duration, "deg")
            segment["duration"] = f"{size * seconds:.{_FIGURES}g} {unit}"
    changed = [axis | {"segment": timed[axis["name"]]} for axis in study["axis"]]
    same = abs(axes.duration - axes_of(study).duration) == 0.0
    return study | ({} if same else {clock: turn}) | {"axis": changed}


def example() -> dict[str, Any]:
    """The axes that the page shows where none were given: a table that indexes, and a die that waits for it."""
    return packaged_study("cycle_die_and_table", "overlap")


QUESTIONS: dict[str, Question] = {
    "axes": (CycleRequest, answer),
    "axes-clearances": (CycleRequest, clearances),
    "axes-together": (CycleRequest, together),
}
