"""The sweeps of problem files: the cycle of an axis for values of an entry, and the best value between these."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from copy import deepcopy
from math import inf, isnan, nan
from pathlib import Path
from typing import Any, NamedTuple

from optlaws.cycles.answers import BOUND_IN_DOUBLES, PROVEN_BOUND
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.report import objective_unit
from optlaws.cycles.specification.limits import FORCE_UNITS, FORCES
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure, located
from optlaws.files.reading import check_names
from optlaws.files.tables import Cell
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile, SweepEntries, cycle_of
from optlaws.laws.catalogue.reading import with_files
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.quantities import RPM
from optlaws.sentences import quantity_name
from optlaws.shown.report import ReportTable
from optlaws.shown.steps import step
from optlaws.synthesis.status import Status

_BETWEEN = 4  # values that are added at most
_GAINED = 1e-4  # of the objective: a value that promises less is not computed
_DIGITS = 4  # of such a value
_NUMBER = re.compile(r"([-+\d.eE]+)(\s*[^\d\s].*)")


class SweptCycle(NamedTuple):
    """A value of an entry, the cycle of the axis with it, None without a motion, its status, and why there is none."""

    value: str | float
    cycle: Cycle | None
    status: Status
    reason: str = ""

    @property
    def objective(self) -> float | None:
        """What is minimised; None where no law was looked for or found."""
        return None if self.cycle is None or not self.cycle.solutions else self.cycle.objective

    @property
    def name(self) -> str:
        """The value as text."""
        return self.value if isinstance(self.value, str) else f"{self.value:g}"

    def __str__(self) -> str:
        if self.cycle is None:
            return f"{self.name}: {self.status.value}: {self.reason}"
        known = "" if self.objective is None else f", {_with_unit(self.cycle)}"
        return f"{self.name}: {self.status.value}{known}"


class Sweep(NamedTuple):
    """A sweep with what was computed of it: all values, and others near the best, unless it was stopped before."""

    entries: SweepEntries
    rows: Sequence[SweptCycle]
    stopped: bool = False

    @property
    def remark(self) -> str:
        """Where the objective is least, and what is not known; a sentence or several."""
        entry, given = self.entries.entry, self.entries.values
        stop = f"The sweep of {entry} was stopped after {len(self.rows)} of {len(given)} values. " * self.stopped
        solved = [(row.objective, i) for i, row in enumerate(self.rows) if row.objective is not None]
        if len(solved) < 2:
            return stop
        best = self.rows[min(solved)[1]]
        assert best.cycle is not None  # noqa: S101 - it has an objective
        added = ", ".join(row.name for row in self.rows if row.value not in given)
        between = f" Added between the values that are given: {added}." if added else ""
        at_end = best in (self.rows[0], self.rows[-1]) and not self.stopped and not isnan(_number(best.value)[0])
        beyond = f" {self._beyond(best)}" if at_end else ""
        return f"{stop}The {_with_unit(best.cycle)}, is at {entry} = {best.name}.{between}{beyond}"

    def _beyond(self, best: SweptCycle) -> str:
        """That the best value is at the edge of the sweep, and how to widen it: by the ratio of the last two values."""
        last = self.rows[:2] if best is self.rows[0] else self.rows[:-3:-1]
        (edge, unit), (inner, _) = (_number(row.value) for row in last)
        further = edge**2 / inner if edge * inner > 0.0 else 2.0 * edge - inner
        value = f"{further:.{_DIGITS}g}"
        shown = f'"{value}{unit}"' if unit else value
        where = "least" if edge < inner else "greatest"
        return (
            f"It is the {where} of the values, at the edge of the sweep: less may lie beyond. Widen the sweep: add "
            f"{shown} to its values."
        )

    @property
    def table(self) -> ReportTable:
        """The objective with its bound, what drive and motor need, or why there is none, for each value."""
        cycles = [row.cycle for row in self.rows if row.cycle is not None]
        columns = _columns(cycles) if cycles else {}
        reasons = ["reason"] if any(row.reason for row in self.rows) else []
        cells: list[list[Cell]] = [
            [
                row.value,
                row.status.value,
                *(None if row.cycle is None else cell(row.cycle) for cell in columns.values()),
                row.reason,
            ]
            for row in self.rows
        ]
        shown = len(columns) + 2 + len(reasons)
        return ReportTable([self.entries.entry, "status", *columns, *reasons], [row[:shown] for row in cells])


def sweeps_of(spec: CycleProblemFile, file: Path) -> list[Sweep]:
    """The sweeps of a file; an error names the file and the sweep.

    One that is stopped by Ctrl-C has the rows so far, and is the last.
    """
    axes, sweeps = {axis.name: axis.to_dict() for axis in spec.axis}, list[Sweep]()
    for entries in spec.sweep:
        with located(f"{file}: sweep of {entries.entry}"):
            check_names([entries.axis], axes, "axis")
        with located(str(file)):
            sweeps.append(_swept_over(spec, entries, axes[entries.axis], file.parent))
        if sweeps[-1].stopped:
            break
    return sweeps


def _swept_over(spec: CycleProblemFile, entries: SweepEntries, axis: dict[str, Any], folder: Path) -> Sweep:
    """The given values in turn; then, as long as there is more to gain, values beside the best one."""
    rows = list[SweptCycle]()

    def compute(value: str | float) -> None:
        step(f"{entries.entry} = {value}")
        rows.append(_swept(spec, axis, entries.entry, value, folder))
        step(f"{entries.entry} = {rows[-1]}", stays=True)

    try:
        for value in entries.values:
            compute(value)
        for _ in range(_BETWEEN):
            beside = _beside_best(rows)
            if beside is None:
                break
            compute(beside)
    except KeyboardInterrupt:
        if not rows:
            raise
        return Sweep(entries, rows, stopped=True)
    except InputError:  # of an entry that takes no value between those given, as a degree
        if len(rows) < len(entries.values):
            raise
    if len(rows) > len(entries.values):
        rows.sort(key=lambda row: _number(row.value)[0])
    return Sweep(entries, rows)


def _number(value: str | float) -> tuple[float, str]:
    """A value as a number and its unit; no number where it is a word.

    >>> _number(20), _number("0.1 m"), _number("optimal")
    ((20.0, ''), (0.1, ' m'), (nan, 'optimal'))
    """
    if not isinstance(value, str):
        return float(value), ""
    number = _NUMBER.fullmatch(value)
    try:
        return (nan, value) if number is None else (float(number[1]), number[2])
    except ValueError:
        return nan, value


def _beside_best(rows: Sequence[SweptCycle]) -> str | float | None:
    """A value beside the best one, where the parabola through it and its neighbours is least; None without gain."""
    placed = sorted((*_number(row.value), row.objective) for row in rows if row.objective is not None)
    units = {_number(row.value)[1] for row in rows}
    if len(units) > 1 or len(placed) < len(rows) or any(isnan(place) for place, *_ in placed):
        return None
    best = min(range(len(placed)), key=lambda i: placed[i][2])
    if not 0 < best < len(placed) - 1:
        return None
    (low, _, before), (middle, unit, least), (high, _, after) = placed[best - 1 : best + 2]
    down, up = (least - before) / (middle - low), (after - least) / (high - middle)
    bend = (up - down) / (high - low)
    if not bend > 0.0:
        return None
    vertex = 0.5 * (low + middle - down / bend)
    if bend * (vertex - middle) ** 2 <= _GAINED * abs(least):
        return None
    place = float(f"{vertex:.{_DIGITS}g}")
    return None if any(place == each for each, *_ in placed) else f"{place:g}{unit}" if unit else place


def _swept(spec: CycleProblemFile, axis: dict[str, Any], entry: str, value: str | float, folder: Path) -> SweptCycle:
    """The cycle of an axis with another value of an entry, with its laws."""
    where = f"sweep of {entry}, {value}"
    try:
        with located(where):
            changed = AxisEntries.from_dict(with_entry(axis, entry, value, folder))
            cycle = cycle_of(changed, spec.speed, spec.period)
            _ = cycle.peaks  # laws are looked for now
            return SweptCycle(value, cycle, cycle.status)
    except (InfeasibleProblem, SolverFailure) as error:
        return SweptCycle(value, None, Status.of(error), str(error).removeprefix(f"{where}: "))


def with_entry(axis: dict[str, Any], entry: str, value: str | float, folder: Path = Path()) -> dict[str, Any]:
    """The entries of an axis with another value of a single entry; parts of a list are counted from 1.

    A file that the value names is relative to the folder.

    >>> with_entry({"drive": {"ratio": 20}, "segment": [{"by": "3 mm"}]}, "drive.ratio", 30.0)
    {'drive': {'ratio': 30.0}, 'segment': [{'by': '3 mm'}]}
    >>> with_entry({"segment": [{"by": "3 mm"}]}, "segment.1.by", "5 mm")
    {'segment': [{'by': '5 mm'}]}
    >>> with_entry({"drive": {"ratio": 20}}, "drvie.ratio", 30.0)
    Traceback (most recent call last):
    optlaws.errors.InputError: entry 'drvie.ratio': unknown entry 'drvie'; did you mean 'drive'?
    """
    changed = deepcopy(axis)
    place: Any = changed
    *way, last = entry.split(".")
    with located(f"entry {entry!r}"):
        for part in way:
            if isinstance(place, dict | list):
                parts = place if isinstance(place, dict) else {str(i): each for i, each in enumerate(place, 1)}
                check_names([part], parts, "entry")
                place = parts[part]
    if not isinstance(place, dict):
        raise InputError(f"entry {entry!r} must end in the name of an entry, such as drive.ratio")
    place |= with_files({last: value}, folder)
    return changed


def _least(cycle: Cycle) -> str:
    """What is least, such as "least RMS torque"."""
    return f"least {quantity_name(cycle.minimise)}"


def _with_unit(cycle: Cycle) -> str:
    """What is least, with its value."""
    return f"{_least(cycle)} found, {cycle.objective:.6g} {objective_unit(cycle)}"


def _columns(cycles: Sequence[Cycle]) -> dict[str, Callable[[Cycle], Cell]]:
    """Table columns for cycles of one kind, by their headings; bounds are called proven where all are."""
    cycle, columns = cycles[0], dict[str, Callable[[Cycle], Cell]]()
    if cycle.solutions:
        columns[f"{_least(cycle)}, {objective_unit(cycle)}"] = lambda each: each.objective
        names = {each.lower_bound_name for each in cycles}
        columns[PROVEN_BOUND if names == {PROVEN_BOUND} else BOUND_IN_DOUBLES] = lambda each: each.lower_bound or None
    if cycle.drive is not None:
        force, unit = FORCES[cycle.axis], FORCE_UNITS[cycle.axis]
        minimised = cycle.minimise if cycle.solutions else None
        if minimised != force:
            columns[f"peak {force}, {unit}"] = lambda each: each.effort.peak_force
        if minimised != f"rms {force}":
            columns[f"RMS {force}, {unit}"] = lambda each: each.effort.rms_force
    if isinstance(cycle.drive, Drive):
        columns["peak speed of the motor, rpm"] = lambda each: RPM * each.sheet.peak_speed
        columns["greatest use of the motor, %"] = _use
    return columns


def _use(cycle: Cycle) -> Cell:
    """The greatest share of a limit of the motor; None where it has none, a word beyond its greatest speed."""
    use = max((margin.use for margin in cycle.sheet.margins), default=None)
    return "too fast" if use == inf else None if use is None else 100.0 * use
