"""The job "cycle": whole cycles of one or several axes, with tables, plots, exports and proofs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.report import CycleReport
from optlaws.errors import InputError, located
from optlaws.exports.format import FORMATS, format_of
from optlaws.exports.text import variable_names
from optlaws.files import tables, writing
from optlaws.jobs.axes.axis_transitions import (
    AxisTransition,
    Named,
    TransitionEntries,
    add_transitions,
    transition_facts,
    transition_names,
    transitions_of,
    write_transitions,
)
from optlaws.jobs.axes.entry_sweep import SweptCycle, sweep_table
from optlaws.jobs.axes.fastest_page import (
    at_greatest_speed,
    fastest_facts,
    fastest_of,
    slowest,
)
from optlaws.jobs.axes.interlock_page import CLEARANCES, GIVEN, TIMING, add_interlocks, interlock_facts
from optlaws.jobs.cycle_entries import CycleProblemFile, ExportEntries, overlap_of, read_given, sweeps_of
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.plots.cycle import axes_figure, cycle_figure
from optlaws.plots.interlocks import clearance_figure, timing_figure
from optlaws.plots.machine import mechanism_figure, motor_figure
from optlaws.plots.sweep import sweep_figure
from optlaws.results import Page, Results

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from optlaws.cycles.fastest_cycle import FastestCycle
    from optlaws.cycles.machine_axes import Axes, Overlap
    from optlaws.cycles.moves.transition_cam import TransitionCam, TransitionKind
    from optlaws.exports.export import Export

#: the exports of each axis by the names of their files
Exports: TypeAlias = "dict[str, dict[str, Export]]"

#: what the picture of all axes is called
TOGETHER = "axes"
#: what tables and pictures of sweeps are called, before their numbers
SWEEP = "sweep_"
_PEAKS = ("peak velocity", "peak acceleration", "peak jerk")
_EXPORT_HEADINGS = ("file", "format", "points", *_PEAKS, "greatest deviation, unit")


def _exports_of(
    spec: CycleProblemFile, cycles: Mapping[str, Cycle], transitions: Sequence[AxisTransition], results: Results
) -> Exports:
    """The exports of the axes' cycles, run-ins and run-outs, which are put into results."""
    exports: Exports = {axis.name: {} for axis in spec.axis}
    names = variable_names(exports)
    for axis in spec.axis:
        for entry in axis.export:
            of = f"axis {axis.name}: export to {entry.to}"
            with located(f"{results.file}: {of}"):
                name, variable = _file_name(axis.name, entry), names[axis.name]
                ending = name.removeprefix(f"{plain_name(axis.name)}_")
                moved = {name: _export(cycles[axis.name], entry, variable)} | {
                    f"{cam.name}_{ending}": _export(cam.cam, entry, f"{variable}_{cam.name.rpartition('run_')[2]}")
                    for cam in transitions
                    if cam.axis == axis.name
                }
            for file, export in moved.items():
                results.add(file, export.write, of)
            exports[axis.name] |= moved
    return exports


def plain_name(axis: str) -> str:
    """The name of an axis as files have it."""
    return "".join(letter if letter.isalnum() else "_" for letter in axis.lower())


def _transition_names(spec: CycleProblemFile) -> Named:
    """The file names of run-ins and run-outs, each with its entries in the file."""
    given: dict[str, Mapping[TransitionKind, Sequence[TransitionEntries]]] = {
        axis.name: {"run-in": axis.run_in, "run-out": axis.run_out} for axis in spec.axis
    }
    return transition_names(given, {name: plain_name(name) for name in given})


def _export(cycle: Cycle | TransitionCam, entry: ExportEntries, variable: str) -> Export:
    from optlaws.exports.export import export_cycle

    given = {"name": variable} | entry.to_dict()
    for name in ("to", "file", "master", "unit"):
        given.pop(name, None)
    return export_cycle(cycle, entry.to, {"master": entry.master, "unit": entry.unit}, **given)


def _file_name(axis: str, entry: ExportEntries) -> str:
    form = format_of(entry.to)
    name = entry.file or f"{plain_name(axis)}_{form.name}{FORMATS[form.name].extension}"
    if Path(name).name != name:
        raise InputError(f"file must be a name without a folder, got {name}")
    writing.check_name(Path(name))
    return name


def _export_row(name: str, export: Export) -> list[tables.Cell]:
    ratios = [export.report.ratio(nu) for nu in (1, 2, 3)]
    shown = [f"{ratio:.7g}" if abs(ratio) < float("inf") else "jumps" for ratio in ratios]
    deviation = f"{export.report.deviation[0].value:.3g} {export.motion.units.slave}"
    return [name, export.format.name, export.points, *shown, deviation]


def run(results: Results) -> None:
    """Put the page, the motions, the pictures, the laws and the exports of all axes into results."""
    spec, given = read_given(results.entries, results.file)
    overlap = overlap_of(spec, given, results.file)
    fastest = fastest_of(given, results.file) if spec.fastest else {}
    cycles = at_greatest_speed(given if overlap is None else overlap.axes, fastest)
    transitions = transitions_of(_transition_names(spec), cycles, results.file)
    exports = _exports_of(spec, cycles, transitions, results)
    sweeps = sweeps_of(spec, results.file)
    results.title = spec.title
    shown = page(spec, cycles, exports, sweeps=sweeps, fastest=fastest, overlap=overlap, transitions=transitions)
    results.text("cycle.md", str(shown))
    for number, (sweep, rows) in enumerate(zip(spec.sweep, sweeps, strict=True), 1):
        headings, cells = sweep_table(sweep, rows)
        results.table(f"{SWEEP}{number}", headings, cells)
        results.picture(f"{SWEEP}{number}", sweep_figure(headings, cells, f"{spec.title}: {sweep.axis}"))
    facts = {"unit": "SI", "axes": {name: _stored(cycle) for name, cycle in cycles.items()}}
    results.data("cycle.json", facts | interlock_facts(cycles, overlap) | transition_facts(transitions))
    if fastest:
        results.data("fastest.json", {name: axis.claims() for name, axis in fastest.items()})
    pictures = _drive_pictures(cycles)
    for name, cycle in cycles.items():
        table = table_of_motion(cycle, spec.rows, results.about)
        results.text(f"{plain_name(name)}.csv", table, f"axis {name}: its table")
        results.picture(plain_name(name), cycle_figure(cycle, f"{spec.title}: {name}"), f"axis {name}: its picture")
        for picture in pictures[name]:
            results.picture(picture.name, picture.draw(f"{spec.title}: {name}, {picture.caption}"))
    write_transitions(results, spec.title, transitions, spec.rows)
    if len(cycles) > 1:
        results.picture(TOGETHER, axes_figure(cycles, spec.title), "the picture of all axes")
    if cycles.rules:
        results.picture(TIMING, timing_figure(cycles, cycles.rules, spec.title))
    if overlap is not None:
        results.picture(GIVEN, timing_figure(given, given.rules, f"{spec.title}, as it was given"))
        results.picture(CLEARANCES, clearance_figure(cycles, cycles.rules, spec.title))


class _DrivePicture(NamedTuple):
    """A picture of a mechanism or of what drives it: its name, its caption, and what draws it under a title."""

    name: str
    caption: str
    draw: Callable[[str], Figure]


def _drive_pictures(cycles: Mapping[str, Cycle]) -> dict[str, list[_DrivePicture]]:
    """The pictures of each axis: of its motor, and of its mechanism where that is the first of its kind and varies."""
    pictures: dict[str, list[_DrivePicture]] = {}
    drawn: list[Mechanism] = []
    for name, cycle in cycles.items():
        pictures[name] = []
        if not isinstance(cycle.drive, Mechanism | Drive):
            continue
        if isinstance(cycle.drive, Drive):
            draw = partial(motor_figure, cycle, cycle.drive)
            pictures[name].append(_DrivePicture(f"{plain_name(name)}_motor", "torque over speed at the motor", draw))
        mechanism = cycle.drive.mechanism if isinstance(cycle.drive, Drive) else cycle.drive
        varies = mechanism.inertia_formula.names() | mechanism.load_formula.names()
        if varies and mechanism not in drawn:
            drawn.append(mechanism)
            picture = partial(mechanism_figure, mechanism)
            pictures[name].append(_DrivePicture(f"{plain_name(name)}_mechanism", f"the {mechanism.name}", picture))
    return pictures


def table_of_motion(cycle: Cycle, rows: int, about: str) -> str:
    """Angle, time, position, velocity, acceleration and jerk at equal steps over the cycle, as CSV.

    With a drive force (or torque) and power, with a motor its speed too.
    """
    return tables.to_csv(*CycleReport(cycle).motion(rows), about=about)


def answer(entries: Mapping[str, Any], file: Path) -> dict[str, Any]:
    """The data of the cycles of a file for programs, in SI units, by the names of the axes."""
    spec, given = read_given(entries, file)
    if spec.fastest:
        return {name: fastest_facts(fastest) for name, fastest in fastest_of(given, file).items()}
    overlap = overlap_of(spec, given, file)
    axes = given if overlap is None else overlap.axes
    known = interlock_facts(axes, overlap) | transition_facts(transitions_of(_transition_names(spec), axes, file))
    return {name: cycle.report().data for name, cycle in axes.items()} | known


def page(
    spec: CycleProblemFile,
    axes: Axes,
    exports: Exports,
    *,
    sweeps: Sequence[list[SweptCycle]],
    fastest: Mapping[str, FastestCycle],
    overlap: Overlap | None,
    transitions: Sequence[AxisTransition],
) -> Page:
    """The page of the cycles' results."""
    result = slowest(Page(spec.title).text(spec.text), fastest)
    if len(axes) > 1:
        result.figure(TOGETHER, f"{spec.title}: all axes over one time")
    add_interlocks(result, spec.title, axes, overlap)
    pictures = _drive_pictures(axes)
    for name, cycle in axes.items():
        result.heading(name).figure(plain_name(name), f"{spec.title}: {name}")
        if name in fastest:
            result.facts(fastest[name].summary())
        result.report(cycle.report())
        for picture in pictures[name]:
            result.figure(picture.name, f"{spec.title}: {name}, {picture.caption}")
        if exports[name]:
            result.text("What controllers will run: peaks of the exported files as interpolated, over the law's.")
            result.table(_EXPORT_HEADINGS, [_export_row(*item) for item in exports[name].items()], digits=7)
    add_transitions(result, spec.title, transitions)
    for number, (sweep, swept_cycles) in enumerate(zip(spec.sweep, sweeps, strict=True), 1):
        result.heading(f"{sweep.axis} by {sweep.entry}").figure(f"{SWEEP}{number}", f"{sweep.axis} by {sweep.entry}")
        result.table(*sweep_table(sweep, swept_cycles), digits=7)
    return result


def _stored(cycle: Cycle) -> dict[str, Any]:
    """Facts of a cycle with its laws."""
    laws = [
        {"start": piece.start, "duration": piece.duration, "offset": piece.offset, "stroke": piece.stroke,
         "law": piece.law.to_dict()}
        for piece in cycle.pieces
    ]  # fmt: skip
    return {**cycle.report().data, "laws": laws}
