"""The job "cycle": whole cycles of one or several axes, with tables, plots, exports and proofs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.report import CycleReport
from optlaws.errors import InputError, located
from optlaws.exports.format import FORMATS, format_of
from optlaws.exports.text import variable_names
from optlaws.files import tables, writing
from optlaws.jobs.cycle_entries import CycleProblemFile, ExportEntries, overlap_of, read_given, sweeps_of
from optlaws.jobs.cycle_pages import (
    AxisTransition,
    add_interlocks,
    add_transitions,
    at_greatest_speed,
    fastest_facts,
    fastest_of,
    interlock_facts,
    plain_name,
    slowest,
    sweep_table,
    transition_facts,
    transitions_of,
)
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.plots.style import figure_of, plot_style
from optlaws.plots.sweep import sweep_figure
from optlaws.results import Page, Results

if TYPE_CHECKING:
    from optlaws.cycles.fastest_cycle import FastestCycle
    from optlaws.cycles.moves.transition_cam import TransitionCam
    from optlaws.exports.export import Export

#: the exports of each axis by the names of their files
Exports: TypeAlias = "dict[str, dict[str, Export]]"

#: what the picture of all axes is called
TOGETHER = "axes"
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
    transitions = transitions_of(spec.axis, cycles, results.file)
    exports = _exports_of(spec, cycles, transitions, results)
    sweeps = sweeps_of(spec, results.file)
    results.title = spec.title
    page = slowest(results.page("cycle").text(spec.text), fastest)
    if len(cycles) > 1:
        figure = figure_of(cycles.plot(), spec.title)
        page.picture(TOGETHER, f"{spec.title}: all axes over one time", figure, "the picture of all axes")
    add_interlocks(page, spec.title, cycles, overlap)
    drawn: list[Mechanism] = []
    for name, cycle in cycles.items():
        table = table_of_motion(cycle, spec.rows, results.about)
        results.text(f"{plain_name(name)}.csv", table, f"axis {name}: its table")
        _add_axis(page, f"{spec.title}: {name}", name, cycle, fastest.get(name), drawn)
        if exports[name]:
            page.text("What controllers will run: peaks of the exported files as interpolated, over the law's.")
            page.table(_EXPORT_HEADINGS, [_export_row(*item) for item in exports[name].items()], digits=7)
    add_transitions(page, results, transitions, spec.rows)
    for number, (sweep, rows) in enumerate(zip(spec.sweep, sweeps, strict=True), 1):
        cells, by = sweep_table(sweep, rows), f"{sweep.axis} by {sweep.entry}"
        results.table(f"sweep_{number}", *cells)
        figure = sweep_figure(*cells, f"{spec.title}: {sweep.axis}")
        page.heading(by).picture(f"sweep_{number}", by, figure).table(*cells, digits=7)
    facts = {"unit": "SI", "axes": {name: _stored(cycle) for name, cycle in cycles.items()}}
    results.data("cycle.json", facts | interlock_facts(cycles, overlap) | transition_facts(transitions))
    if fastest:
        results.data("fastest.json", {name: axis.claims() for name, axis in fastest.items()})


def _add_axis(
    page: Page, title: str, name: str, cycle: Cycle, fastest: FastestCycle | None, drawn: list[Mechanism]
) -> None:
    """Put an axis on a page: its motion, its motor, and its mechanism where that varies and is not `drawn` yet."""
    plain = plain_name(name)
    page.heading(name).picture(plain, title, figure_of(cycle.plot(), title), f"axis {name}: its picture")
    if fastest is not None:
        page.facts(fastest.summary())
    page.report(cycle.report())
    if isinstance(cycle.drive, Drive):
        caption = f"{title}, torque over speed at the motor"
        with plot_style():
            figure = figure_of(cycle.plot(over="speed"), caption)
        page.picture(f"{plain}_motor", caption, figure)
    mechanism = cycle.drive.mechanism if isinstance(cycle.drive, Drive) else cycle.drive
    if not isinstance(mechanism, Mechanism) or mechanism in drawn:
        return
    if mechanism.inertia_formula.names() | mechanism.load_formula.names():
        drawn.append(mechanism)
        caption = f"{title}, the {mechanism.name}"
        page.picture(f"{plain}_mechanism", caption, figure_of(mechanism.plot(), caption))


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
    known = interlock_facts(axes, overlap) | transition_facts(transitions_of(spec.axis, axes, file))
    return {name: cycle.report().data for name, cycle in axes.items()} | known


def _stored(cycle: Cycle) -> dict[str, Any]:
    """Facts of a cycle with its laws."""
    laws = [
        {"start": piece.start, "duration": piece.duration, "offset": piece.offset, "stroke": piece.stroke,
         "law": piece.law.to_dict()}
        for piece in cycle.pieces
    ]  # fmt: skip
    return {**cycle.report().data, "laws": laws}
