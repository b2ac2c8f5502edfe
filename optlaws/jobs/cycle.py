"""The job "cycle": whole cycles of one or several axes, tabled, drawn, exported and kept with their proofs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.interlocks.interlock import SMALL_UNITS, LeastClearance
from optlaws.cycles.machine_axes import Axes, Overlap
from optlaws.cycles.summary import drive_rows, joint_rows, proof_rows
from optlaws.errors import InputError, located
from optlaws.exports.export import Export, export_cycle
from optlaws.exports.format import FORMATS, format_of
from optlaws.exports.text import variable_names
from optlaws.files import tables, writing
from optlaws.jobs.cycle_entries import CycleProblemFile, ExportEntries, overlap_of, read_given
from optlaws.motion.quantities import QUANTITIES
from optlaws.plots.cycle import UNITS, axes_figure, cycle_figure
from optlaws.plots.interlocks import clearance_figure, timing_figure
from optlaws.results import Page, Results
from optlaws.tolerances import CYCLE_ROUNDING

#: the exports of each axis by the names of their files
Exports = dict[str, dict[str, Export]]

#: what the picture of all axes is called
TOGETHER = "axes"
#: the pictures of interlocked axes
TIMING, CLEARANCES, GIVEN = "timing", "clearances", "timing_given"
_PEAKS = ("peak velocity", "peak acceleration", "peak jerk")
_EXPORT_HEADINGS = ("file", "format", "points", *_PEAKS, "greatest deviation, unit")


def exports_of(spec: CycleProblemFile, cycles: Mapping[str, Cycle], file: Path) -> Exports:
    """The exports that the axes name, made but not yet written."""
    exports: Exports = {}
    pictures = {TOGETHER, TIMING, CLEARANCES, GIVEN}
    for name in sorted(pictures & {plain_name(axis.name) for axis in spec.axis}) if len(spec.axis) > 1 else ():
        raise InputError(f"{file}: an axis is called {name}, as the picture of all is: give it another name")
    taken = {"cycle.md", "cycle.json"} | {f"{name}.{ending}" for name in pictures for ending in ("svg", "png")}
    taken |= {f"{plain_name(axis.name)}{ending}" for axis in spec.axis for ending in (".csv", ".svg", ".png")}
    names = variable_names(axis.name for axis in spec.axis)
    for axis in spec.axis:
        exports[axis.name] = {}
        for entry in axis.export:
            with located(f"{file}: axis {axis.name}: export to {entry.to}"):
                name = _file_name(axis.name, entry)
                if name in taken:
                    raise InputError(f"another file is called {name}: give each a name of its own")
                taken.add(name)
                exports[axis.name][name] = _export(cycles[axis.name], entry, names[axis.name])
    return exports


def plain_name(axis: str) -> str:
    """The name of an axis as files have it."""
    return "".join(letter if letter.isalnum() else "_" for letter in axis.lower())


def _export(cycle: Cycle, entry: ExportEntries, variable: str) -> Export:
    given = msgspec.structs.asdict(entry)
    given["name"] = variable if entry.name is None else entry.name
    placement = {"master": given.pop("master"), "unit": given.pop("unit")}
    del given["file"], given["to"]
    return export_cycle(cycle, entry.to, placement, **given)


def _file_name(axis: str, entry: ExportEntries) -> str:
    form = format_of(entry.to)
    name = entry.file or f"{plain_name(axis)}_{form.name}{FORMATS[form.name].extension}"
    if Path(name).name != name:
        raise InputError(f"file must be a name without a folder, got {name}")
    writing.check_name(Path(name))
    return name


def _export_row(name: str, export: Export) -> list[tables.Cell]:
    ratios = [export.report.ratio(nu) for nu in (1, 2, 3)]
    shown = [f"{ratio:.7g}" if abs(ratio) < float("inf") else "leaps" for ratio in ratios]
    deviation = f"{export.report.deviation[0].value:.3g} {export.motion.units.slave}"
    return [name, export.format.name, export.points, *shown, deviation]


_CLEARANCE_HEADINGS = ("interlock", "status", "least clearance", "proven", "unit", "at, deg", "early by, ms")
_INTERLOCKS = "What is clear is proven over the whole cycle: nowhere is the clearance below the proven one."
_SHARE = 360.0


def run(results: Results) -> None:
    """Put the page, the motions, the pictures, the laws and the exports of all axes into results."""
    spec, given = read_given(results.entries, results.file)
    overlap = overlap_of(spec, given, results.file)
    cycles = given if overlap is None else overlap.axes
    exports = exports_of(spec, cycles, results.file)
    results.title = spec.title
    results.text("cycle.md", str(page(spec, cycles, exports, overlap)))
    facts = {"unit": "SI", "axes": {name: _stored(cycle) for name, cycle in cycles.items()}}
    results.data("cycle.json", facts | _of_interlocks(cycles, overlap))
    for name, cycle in cycles.items():
        results.text(f"{plain_name(name)}.csv", table_of_motion(cycle, spec.rows, results.about))
        results.picture(plain_name(name), cycle_figure(cycle, f"{spec.title}: {name}"))
        for file, export in exports[name].items():
            results.add(file, export.write)
    if len(cycles) > 1:
        results.picture(TOGETHER, axes_figure(cycles, spec.title))
    if cycles.rules:
        results.picture(TIMING, timing_figure(cycles, cycles.rules, spec.title))
    if overlap is not None:
        results.picture(GIVEN, timing_figure(given, given.rules, f"{spec.title}, as it was given"))
        results.picture(CLEARANCES, clearance_figure(cycles, cycles.rules, spec.title))


def table_of_motion(cycle: Cycle, rows: int, about: str) -> str:
    """Angle, time, position, velocity, acceleration and jerk at equal steps over the cycle, as CSV."""
    return tables.to_csv(_columns(cycle), _rows(cycle, rows), about=about)


def answer(entries: Mapping[str, Any], file: Path) -> dict[str, Any]:
    """The data of the cycles of a file for programs, in SI units, by the names of the axes."""
    spec, given = read_given(entries, file)
    overlap = overlap_of(spec, given, file)
    axes = given if overlap is None else overlap.axes
    return {name: _facts(cycle) for name, cycle in axes.items()} | _of_interlocks(axes, overlap)


def page(spec: CycleProblemFile, axes: Axes, exports: Exports, overlap: Overlap | None = None) -> Page:
    """The page of results."""
    result = Page(spec.title).text(spec.text)
    if len(axes) > 1:
        result.figure(TOGETHER, f"{spec.title}: all axes over one time")
    if overlap is not None:
        result.heading("Overlap").table(("what", "value", "unit"), _overlap_rows(overlap), digits=9)
        result.figure(GIVEN, f"{spec.title}: timing diagram as it was given")
    if axes.rules:
        result.figure(TIMING, f"{spec.title}: timing diagram")
        result.heading("Interlocks").figure(CLEARANCES, f"{spec.title}: clearance of the interlocks")
        result.text(_INTERLOCKS).table(_CLEARANCE_HEADINGS, [_clearance_row(least) for least in axes.clearances])
    for name, cycle in axes.items():
        result.heading(name).figure(plain_name(name), f"{spec.title}: {name}")
        result.table(_headings(cycle), [*_segment_rows(cycle), _whole_row(cycle)], digits=7)
        rows = [*proof_rows(cycle), *drive_rows(cycle), *joint_rows(cycle)]
        result.table(("what", "value", "unit"), [[row.name, row.value, row.unit or None] for row in rows], digits=9)
        if exports[name]:
            result.text("What controllers will run: peaks of the exported files as interpolated, over the law's.")
            result.table(_EXPORT_HEADINGS, [_export_row(*item) for item in exports[name].items()], digits=7)
    return result


def _of_interlocks(axes: Axes, overlap: Overlap | None) -> dict[str, Any]:
    """The least clearances of interlocks, where there are any, and what the overlap gains, where it is sought."""
    known: dict[str, Any] = {"interlocks": [least.to_row() for least in axes.clearances]} if axes.rules else {}
    if overlap is not None:
        names = ("goal", "objective", "lower_bound", "gain")
        facts = {name: getattr(overlap, name) for name in names}
        known["overlap"] = {"status": overlap.status.value, **facts, "binding": list(overlap.binding)}
    return known


def _overlap_rows(overlap: Overlap) -> list[list[tables.Cell]]:
    period = overlap.goal == "period"
    what = "least period" if period else "greatest acceleration, as a share of the given one"
    unit = "s" if period else None
    gain = "times as fast" if period else "times lower"
    rows: list[list[tables.Cell]] = [
        ["status", overlap.status.value, None],
        [what, overlap.objective, unit],
        ["proven lower bound", overlap.lower_bound, unit],
        ["gain", overlap.gain, gain],
    ]
    rows += [["bound by", name, None] for name in overlap.binding]
    return rows


def _clearance_row(least: LeastClearance) -> list[tables.Cell]:
    unit, size = SMALL_UNITS.get(least.unit, (least.unit, 1.0))
    margin = None if least.margin is None else 1e3 * least.margin
    return [least.interlock.label, least.status, size * least.clearance, size * least.bound, unit, least.angle, margin]


def _headings(cycle: Cycle) -> list[str]:
    sized = [f"peak {name}, {unit}" for name, (unit, _) in zip(QUANTITIES, UNITS[cycle.axis], strict=True)]
    return ["segment", "from, ms", "takes, ms", "takes, deg", "ends at, " + UNITS[cycle.axis][0][0], *sized[1:]]


def _segment_rows(cycle: Cycle) -> list[list[tables.Cell]]:
    position, factor = cycle.programme.start, UNITS[cycle.axis][0][1]
    rows: list[list[tables.Cell]] = []
    for stretch, peaks in zip(cycle.programme.stretches, cycle.peaks, strict=True):
        position += stretch.displacement
        rows.append(
            [
                peaks.name,
                1e3 * peaks.start,
                1e3 * peaks.duration,
                _SHARE * peaks.duration / cycle.duration,
                _plain(factor * position, factor * max(abs(position), abs(cycle.peak(0)))),
                *(peaks.peak(nu) * UNITS[cycle.axis][nu][1] for nu in (1, 2, 3)),
            ]
        )
    return rows


def _whole_row(cycle: Cycle) -> list[tables.Cell]:
    peaks = [cycle.peak(nu) * UNITS[cycle.axis][nu][1] for nu in (1, 2, 3)]
    return ["whole cycle", 0.0, 1e3 * cycle.duration, _SHARE, None, *peaks]


def _columns(cycle: Cycle) -> list[str]:
    return [
        "master, deg",
        "time, s",
        *(f"{name}, {unit}" for name, (unit, _) in zip(QUANTITIES, UNITS[cycle.axis], strict=True)),
    ]


def _rows(cycle: Cycle, count: int) -> list[list[tables.Cell]]:
    degrees = np.linspace(0.0, _SHARE, count)
    times = degrees * (cycle.duration / _SHARE)
    columns = [
        [_plain(value * factor, cycle.peak(nu) * factor) for value in cycle(times, nu).tolist()]
        for nu, (_, factor) in enumerate(UNITS[cycle.axis])
    ]
    return [list(row) for row in zip(degrees.tolist(), times.tolist(), *columns, strict=True)]


def _plain(value: float, size: float) -> float:
    return 0.0 if abs(value) <= CYCLE_ROUNDING * size else value


def _stored(cycle: Cycle) -> dict[str, Any]:
    """Facts of a cycle with its laws."""
    laws = [
        {"start": piece.start, "duration": piece.duration, "offset": piece.offset, "stroke": piece.stroke,
         "law": piece.law.to_dict()}
        for piece in cycle.pieces
    ]  # fmt: skip
    return _facts(cycle) | {"laws": laws}


def _facts(cycle: Cycle) -> dict[str, Any]:
    drive: dict[str, Any] = {} if cycle.drive is None else {"effort": cycle.effort.to_dict()}
    if cycle.load is not None:
        drive["load"] = {name: cycle.load_motion.peak(name).value for name in cycle.load_motion.machine.outputs}
    return {
        "period": cycle.duration,
        "status": cycle.status.value,
        "minimise": cycle.minimise,
        "objective": cycle.objective if cycle.solutions else None,
        "lower_bound": cycle.lower_bound if cycle.solutions else None,
        "search_space": cycle.search_space,
        "remarks": list(cycle.remarks),
        "segments": [
            {"name": peak.name, "start": peak.start, "duration": peak.duration}
            | {name: peak.peak(nu) for nu, name in enumerate(QUANTITIES) if nu}
            for peak in cycle.peaks
        ],
        "joints": list(cycle.joints),
        **drive,
    }
