"""What the results of the job "cycle" have beside its axes: greatest speeds, interlocks, run-ins, run-outs, sweeps."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from optlaws.cycles.report import motion_table
from optlaws.cycles.summary import force_name, force_unit, objective_unit
from optlaws.errors import InfeasibleProblem, InputError, located
from optlaws.files.tables import Cell, to_csv
from optlaws.jobs.cycle_entries import AxisEntries, SweepEntries, SweptCycle
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.display_units import RPM
from optlaws.motion.quantities import QUANTITIES
from optlaws.plots.style import figure_of
from optlaws.results import Page, Results

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Cycle
    from optlaws.cycles.fastest_cycle import FastestCycle
    from optlaws.cycles.machine_axes import Axes, Overlap
    from optlaws.cycles.moves.transition_cam import TransitionCam

TRANSITIONS = "transitions.json"
_ABOUT = "Table and picture begin where the cam does: at {:.9g} deg of the cycle's master, until {:.9g} deg."
_CLEARANCE_HEADINGS = ("interlock", "status", "least clearance", "proven", "unit", "at, deg", "early by, ms")
_INTERLOCKS = "What is clear is proven over the whole cycle: nowhere is the clearance below the proven one."


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
        "gains": [vars(gain) for gain in fastest.gains],
        "segments": [{**vars(each), "limits": list(each.limits)} for each in fastest.segments],
    }


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


def add_interlocks(page: Page, title: str, axes: Axes, overlap: Overlap | None) -> None:
    """Put what overlaps, timing diagrams and clearances on a page, where there are any."""
    if overlap is not None:
        given = figure_of(overlap.given.plot(what="timing"), f"{title}, as it was given")
        page.heading("Overlap").facts(overlap.summary())
        page.picture("timing_given", f"{title}: timing diagram as it was given", given)
    if axes.rules:
        page.picture("timing", f"{title}: timing diagram", figure_of(axes.plot(what="timing"), title))
        clearances = figure_of(axes.plot(what="clearance"), title)
        page.heading("Interlocks").picture("clearances", f"{title}: clearance of the interlocks", clearances)
        page.text(_INTERLOCKS).table(_CLEARANCE_HEADINGS, [least.cells for least in axes.clearances])


def interlock_facts(axes: Axes, overlap: Overlap | None) -> dict[str, Any]:
    """The least clearances of the interlocks, if any, and the gain of the overlap, if it is sought."""
    known: dict[str, Any] = {"interlocks": [least.to_row() for least in axes.clearances]} if axes.rules else {}
    if overlap is not None:
        names = ("goal", "objective", "lower_bound", "gain")
        facts = {name: getattr(overlap, name) for name in names}
        known["overlap"] = {"status": overlap.status.value, **facts, "binding": list(overlap.binding)}
    return known


class AxisTransition(NamedTuple):
    """A run-in or run-out of an axis, under the name that its files have."""

    name: str
    axis: str
    cycle: Cycle
    cam: TransitionCam

    @property
    def title(self) -> str:
        first, last = self.cam.master
        return f"{self.axis}, {self.cam.kind} from {first:.6g} to {last:.6g} deg"


def transitions_of(axes: Iterable[AxisEntries], cycles: Mapping[str, Cycle], file: Path) -> list[AxisTransition]:
    """The run-ins and run-outs of axes, numbered where an axis has several of a kind.

    Raises
    ------
    InputError, InfeasibleProblem
        If an entry is wrong, or no law keeps the limits; the error names the file, the axis and the cam.
    """
    cams = []
    for axis in axes:
        cycle = cycles[axis.name]
        for kind, act, entries in (("run-in", cycle.run_in, axis.run_in), ("run-out", cycle.run_out, axis.run_out)):
            for i, given in enumerate(entries, start=1):
                number = f"_{i}" if len(entries) > 1 else ""
                try:
                    cam = act(**given.to_dict())
                except (InputError, InfeasibleProblem) as error:
                    raise type(error)(f"{file}: axis {axis.name}: {kind}: {error}") from None
                name = f"{plain_name(axis.name)}_{kind.replace('-', '_')}{number}"
                cams.append(AxisTransition(name, axis.name, cycle, cam))
    return cams


def add_transitions(page: Page, results: Results, transitions: Sequence[AxisTransition], rows: int) -> None:
    """Put the facts, the tables, the pictures and the proofs of run-ins and run-outs into results."""
    for transition in transitions:
        name, _, cycle, cam = transition
        table = motion_table(cam.piece.values, cam, cam.master, rows)
        results.text(f"{name}.csv", to_csv(*table, about=results.about))
        figure = figure_of(cam.plot(cycle=cycle), f"{results.title}: {cam.kind}")
        page.heading(transition.title).picture(name, f"{results.title}: {transition.title}", figure)
        page.text(_ABOUT.format(*cam.master)).facts(cam.summary(), places="s")
    if transitions:
        results.data(TRANSITIONS, {transition.name: transition.cam.claims() for transition in transitions})


def transition_facts(transitions: Sequence[AxisTransition]) -> dict[str, Any]:
    """Data of run-ins and run-outs for programs, in SI units; empty if there are none."""
    known = {name: _facts(cam) for name, _, _, cam in transitions}
    return {"transitions": known} if known else {}


def _facts(cam: TransitionCam) -> dict[str, Any]:
    return {
        "kind": cam.kind,
        "master": list(cam.master),
        "duration": cam.duration,
        "rest": cam.rest,
        "status": cam.status.value,
        "none_below": None if cam.least is None else cam.least.none_below,
        **{name: cam.peak(nu) for nu, name in enumerate(QUANTITIES) if nu},
        "jumps": cam.jumps,
    }


def plain_name(axis: str) -> str:
    """The name of an axis as files have it."""
    return "".join(letter if letter.isalnum() else "_" for letter in axis.lower())


def sweep_table(sweep: SweepEntries, rows: Sequence[SweptCycle]) -> tuple[list[str], list[list[Cell]]]:
    """Headings and cells of a sweep: the objective with its bound, and what drive and motor need."""
    cycles = [row.cycle for row in rows if row.cycle is not None]
    columns = _columns(cycles[0]) if cycles else {}
    cells: list[list[Cell]] = [
        [row.value, row.status.value, *(None if row.cycle is None else cell(row.cycle) for cell in columns.values())]
        for row in rows
    ]
    return [sweep.entry, "status", *columns], cells


def _columns(cycle: Cycle) -> dict[str, Callable[[Cycle], Cell]]:
    """Table columns for cycles of this kind, by their headings."""
    columns: dict[str, Callable[[Cycle], Cell]] = {}
    if cycle.solutions:
        columns[f"least {cycle.minimise}, {objective_unit(cycle)}"] = lambda each: each.objective
        columns["proven lower bound"] = lambda each: each.lower_bound or None
    if cycle.drive is not None:
        force, unit = force_name(cycle), force_unit(cycle)
        needed: dict[str, Callable[[Cycle], Cell]] = {
            "peak": lambda each: each.effort.peak_force,
            "RMS": lambda each: each.effort.rms_force,
        }
        minimised = {force: "peak", f"rms {force}": "RMS"}.get(cycle.minimise) if cycle.solutions else None
        columns |= {f"{name} {force}, {unit}": cell for name, cell in needed.items() if name != minimised}
    if isinstance(cycle.drive, Drive):
        columns["peak speed of the motor, rpm"] = lambda each: RPM * each.sheet.peak_speed
        columns["greatest use of the motor, %"] = _use
    return columns


def _use(cycle: Cycle) -> Cell:
    """The greatest share of a limit of the motor; None where it has none, a word beyond its greatest speed."""
    use = max((margin.use for margin in cycle.sheet.margins), default=None)
    return "too fast" if use == inf else None if use is None else 100.0 * use
