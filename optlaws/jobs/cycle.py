"""The job "cycle": whole cycles of one or several axes, with tables, plots, exports and proofs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.report import CycleReport, FastestReport, motion_table
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.specification.segments import Dwell
from optlaws.echo import shortened
from optlaws.errors import InfeasibleProblem, InputError, located
from optlaws.exports.format import FORMATS, format_of
from optlaws.exports.text import variable_names
from optlaws.files import writing
from optlaws.files.tables import Cell
from optlaws.jobs.cycle_entries import (
    AxisEntries,
    CycleProblemFile,
    ExportEntries,
    read_given,
)
from optlaws.jobs.cycle_sweeps import sweeps_of
from optlaws.jobs.job_entries import plain_name
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.quantities import Exact
from optlaws.plots.style import figure_of, plot_style
from optlaws.plots.sweep import sweep_figure
from optlaws.results import Page, Results
from optlaws.shown.steps import step
from optlaws.studies.problem_entries import steady

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from optlaws.cycles.axes.machine_axes import Axes, Overlap
    from optlaws.cycles.fastest_cycle import FastestCycle
    from optlaws.cycles.transitions import TransitionCam
    from optlaws.exports.export import Export

#: the exports of each axis by the names of their files
Exports: TypeAlias = "dict[str, dict[str, Export]]"

#: what the picture of all axes is called
TOGETHER = "axes"
_PEAKS = ("peak velocity", "peak acceleration", "peak jerk")
_EXPORT_HEADINGS = ("file", "format", "points", *_PEAKS, "greatest deviation, unit")
_RUN = "What controllers will run: peaks of the exported files as interpolated, over the law's."
_RUN_INTERLOCKED = "The interlocks are proven of the laws: what is executed is off these by the greatest deviation."
_ABOUT = "Table and picture begin where the cam does: at {:.9g} deg of the cycle's master, until {:.9g} deg."
_INTERLOCKS = "The proven value is a lower bound of the clearance over the whole cycle."


class AxisTransition(NamedTuple):
    """A run-in or run-out of an axis, under the name that its files have."""

    name: str
    axis: str
    cam: TransitionCam


def run(results: Results) -> None:
    """Put the page, the motions, the pictures, the laws and the exports of all axes into results."""
    spec, given = read_given(results.entries, results.file)
    overlap = spec.overlap_of(given, results.file)
    fastest = fastest_of(given, results.file) if spec.fastest else {}
    cycles = at_greatest_speed(given if overlap is None else overlap.axes, fastest)
    transitions = _transitions(spec.axis, cycles, results.file)
    exports = _exports(spec, cycles, transitions, results)
    sweeps = sweeps_of(spec, results.file)
    results.title = spec.title
    page = results.page("cycle").text(spec.text).text("".join(slowest(fastest)))
    if len(cycles) > 1:
        page.picture(
            TOGETHER,
            f"{spec.title}: all axes over one time",
            lambda: figure_of(cycles.plot(), spec.title),
            "the picture of all axes",
        )
    _add_interlocks(page, spec.title, cycles, overlap)
    drawn: list[Mechanism] = []
    for name, cycle in cycles.items():
        step(f"axis {name}")
        results.table(plain_name(name), *CycleReport(cycle).motion(spec.rows), of=f"axis {name}: its table")
        _add_axis(page, f"{spec.title}: {name}", name, cycle, fastest.get(name), drawn)
        if len(cycles) > 1:
            page.text(_laws_of(name, cycle, overlap))
        _add_exports(page, exports[name], interlocked=bool(cycles.rules))
    for transition in transitions:
        _add_transition(page, results, transition, cycles[transition.axis], spec.rows)
    for number, sweep in enumerate(sweeps, 1):
        axis, entry = sweep.entries.axis, sweep.entries.entry
        results.table(f"sweep_{number}", *sweep.table)
        draw = partial(sweep_figure, *sweep.table, title=f"{spec.title}: {axis}")
        page.heading(f"{axis} by {entry}").picture(f"sweep_{number}", f"{axis} by {entry}", draw)
        page.text(sweep.remark).table(*sweep.table)
        results.stopped = sweep.remark if sweep.stopped else results.stopped
    facts = {"unit": "SI", "axes": {name: steady(CycleReport(cycle).stored) for name, cycle in cycles.items()}}
    with_proofs = {name: {"axis": axis, **cam.report().data, "cam": cam.to_dict()} for name, axis, cam in transitions}
    results.data("cycle.json", facts | _beside(cycles, overlap, with_proofs))
    if fastest:
        results.data("fastest.json", {name: axis.claims() for name, axis in fastest.items()})


def answer(entries: Mapping[str, Any], file: Path) -> dict[str, Any]:
    """The data of the cycles of a file for programs, in SI units, by the names of the axes."""
    spec, given = read_given(entries, file)
    if spec.fastest:
        return {name: fastest.report().data for name, fastest in fastest_of(given, file).items()}
    overlap = spec.overlap_of(given, file)
    axes = given if overlap is None else overlap.axes
    data = {name: cycle.report().data for name, cycle in axes.items()}
    transitions = {name: cam.report().data for name, _, cam in _transitions(spec.axis, axes, file)}
    return data | _beside(axes, overlap, transitions)


def _beside(axes: Axes, overlap: Overlap | None, transitions: Mapping[str, Any]) -> dict[str, Any]:
    """What is known beside the axes for programs: clearances, what overlaps, run-ins and run-outs, if there are any."""
    known = dict((axes if overlap is None else overlap).report().data)
    return known | ({"transitions": transitions} if transitions else {})


def fastest_of(cycles: Mapping[str, Cycle], file: Path) -> dict[str, FastestCycle]:
    """Each axis at its greatest speed; errors name the file and the axis."""
    fastest = {}
    for name, cycle in cycles.items():
        step(f"axis {name}: greatest speed")
        with located(f"{file}: axis {name}"):
            fastest[name] = cycle.fastest()
    return fastest


def at_greatest_speed(axes: Axes, fastest: Mapping[str, FastestCycle]) -> Axes:
    """All axes at the greatest speed that every axis allows; unchanged where no speed is sought."""
    if not fastest:
        return axes
    from optlaws.cycles.axes.machine_axes import Axes

    period = max(each.period for each in fastest.values())
    cycles = {
        name: each.cycle if each.period == period else replace(axes[name], speed=None, period=Exact(period, "s"))
        for name, each in fastest.items()
    }
    return Axes(cycles, interlocks=axes.interlocks)


def slowest(fastest: Mapping[str, FastestCycle]) -> list[str]:
    """A sentence on the slowest of several axes."""
    if len(fastest) <= 1:
        return []
    name, axis = max(fastest.items(), key=lambda item: item[1].period)
    return [f"The machine is as fast as its slowest axis, {name}: {axis.rpm:.9g} rpm."]


def _add_interlocks(page: Page, title: str, axes: Axes, overlap: Overlap | None) -> None:
    """Put what overlaps, timing diagrams and clearances on a page, where there are any."""
    if overlap is not None:
        given = overlap.given
        page.heading("Overlap").facts(overlap.summary()).picture(
            "timing_given",
            f"{title}: timing diagram before the overlap",
            lambda: figure_of(given.plot(what="timing"), f"{title} before the overlap"),
        )
    if axes.rules:
        page.picture("timing", f"{title}: timing diagram", lambda: figure_of(axes.plot(what="timing"), title))
        page.heading("Interlocks").picture(
            "clearances",
            f"{title}: clearance of the interlocks",
            lambda: figure_of(axes.plot(what="clearance"), title),
        )
        page.text(_INTERLOCKS).table(*axes.report().tables[0])


def _laws_of(name: str, cycle: Cycle, overlap: Overlap | None) -> str:
    """A sentence on the law of each move of an axis, with the laws among which it was looked for."""
    begun = cycle if overlap is None else overlap.given[name]
    sought = f"the best of {begun.search_space}"
    if overlap is not None and (overlap.goal == "period" or name in overlap.of):
        way = "fastest" if overlap.goal == "period" else "one of least acceleration"
        sought = f"the {way} of the laws of order {begun.order} with Z of degree {begun.degree}, in each time"
    laws = [
        (each.label, sought if is_optimal(each) else getattr(each, "law", "constant velocity"))
        for each in begun.segments
        if not isinstance(each, Dwell)
    ]
    moves = [f"{move}: {law if isinstance(law, str) else shortened(law)}" for move, law in laws]
    return f"Laws: {'; '.join(moves)}." if moves else ""


def _add_axis(
    page: Page, title: str, name: str, cycle: Cycle, fastest: FastestCycle | None, drawn: list[Mechanism]
) -> None:
    """Put an axis on a page: its motion, its motor, and its mechanism where that varies and is not `drawn` yet."""
    plain = plain_name(name)
    page.heading(name).picture(plain, title, lambda: figure_of(cycle.plot(), title), f"axis {name}: its picture")
    if fastest is not None:
        page.facts(fastest.summary())
        if (beside := FastestReport(fastest).beside) is not None:
            page.table(*beside.table)
    page.report(cycle.report())
    if isinstance(cycle.drive, Drive):
        caption = f"{title}, torque over speed at the motor"

        def draw() -> Figure:
            with plot_style():
                return figure_of(cycle.plot(over="speed"), caption)

        page.picture(f"{plain}_motor", caption, draw)
    mechanism = cycle.drive.mechanism if isinstance(cycle.drive, Drive) else cycle.drive
    if not isinstance(mechanism, Mechanism) or mechanism in drawn:
        return
    if mechanism.inertia_formula.names() | mechanism.load_formula.names():
        drawn.append(mechanism)
        about = f"{title}, the {mechanism.name}"
        page.picture(f"{plain}_mechanism", about, lambda: figure_of(mechanism.plot(), about))


def _transitions(axes: Iterable[AxisEntries], cycles: Mapping[str, Cycle], file: Path) -> list[AxisTransition]:
    """The run-ins and run-outs of axes, numbered where an axis has several of a kind."""
    cams = []
    for axis in axes:
        cycle = cycles[axis.name]
        for kind, make, entries in (("run-in", cycle.run_in, axis.run_in), ("run-out", cycle.run_out, axis.run_out)):
            for i, given in enumerate(entries, start=1):
                try:
                    cam = make(**given.to_dict())
                except (InputError, InfeasibleProblem) as error:
                    raise type(error)(f"{file}: axis {axis.name}: {kind}: {error}") from None
                number = f"_{i}" if len(entries) > 1 else ""
                cams.append(AxisTransition(f"{plain_name(axis.name)}_{plain_name(kind)}{number}", axis.name, cam))
    return cams


def _add_transition(page: Page, results: Results, transition: AxisTransition, cycle: Cycle, rows: int) -> None:
    """Put the facts, the table and the picture of a run-in or run-out into results."""
    name, axis, cam = transition
    first, last = cam.master
    title = f"{axis}, {cam.kind} from {first:.6g} to {last:.6g} deg"
    results.table(name, *motion_table(cam, cam.master, rows))
    page.heading(title).picture(
        name, f"{results.title}: {title}", lambda: figure_of(cam.plot(cycle=cycle), f"{results.title}: {cam.kind}")
    )
    page.text(_ABOUT.format(first, last)).facts(cam.summary(), places="s")


def _exports(
    spec: CycleProblemFile, cycles: Mapping[str, Cycle], transitions: Sequence[AxisTransition], results: Results
) -> Exports:
    """The exports of the axes' cycles, run-ins and run-outs, which are put into results."""
    exports: Exports = {axis.name: {} for axis in spec.axis}
    names = variable_names(exports)
    for axis in spec.axis:
        cams = [each for each in transitions if each.axis == axis.name]
        for entry in axis.export:
            of, variable = f"axis {axis.name}: export to {entry.to}", names[axis.name]
            with located(f"{results.file}: {of}"):
                name = _file_name(axis.name, entry)
                ending = name.removeprefix(f"{plain_name(axis.name)}_")
                moved = {name: _export(cycles[axis.name], entry, variable)} | {
                    f"{each.name}_{ending}": _export(each.cam, entry, f"{variable}_{each.name.rpartition('run_')[2]}")
                    for each in cams
                }
            for file, export in moved.items():
                results.add(file, export.write, of)
            exports[axis.name] |= moved
    return exports


def _export(cycle: Cycle | TransitionCam, entry: ExportEntries, variable: str) -> Export:
    from optlaws.exports.export import export_cycle

    apart = {"to", "file", "master", "unit"}
    options = {name: value for name, value in entry.to_dict().items() if name not in apart}
    return export_cycle(cycle, entry.to, {"master": entry.master, "unit": entry.unit}, **{"name": variable, **options})


def _file_name(axis: str, entry: ExportEntries) -> str:
    form = format_of(entry.to)
    name = entry.file or f"{plain_name(axis)}_{form.name}{FORMATS[form.name].extension}"
    if Path(name).name != name:
        raise InputError(f"file must be a name without a folder, got {name}")
    writing.check_name(Path(name))
    return name


def _add_exports(page: Page, exports: Mapping[str, Export], *, interlocked: bool) -> None:
    """Put the peaks of what controllers execute on a page, with what is off the law by much."""
    if not exports:
        return
    words = [_RUN, *([_RUN_INTERLOCKED] if interlocked else [])]
    words += [f"{file}: {warning}." for file, export in exports.items() for warning in export.warnings]
    page.text(" ".join(words)).table(_EXPORT_HEADINGS, [_export_row(*item) for item in exports.items()])


def _export_row(name: str, export: Export) -> list[Cell]:
    ratios = [export.report.ratio(nu) for nu in (1, 2, 3)]
    shown = [f"{ratio:.7g}" if abs(ratio) < inf else "jumps" for ratio in ratios]
    deviation = f"{export.report.deviation[0].value:.3g} {export.motion.units.slave}"
    return [name, export.format.name, export.points, *shown, deviation]
