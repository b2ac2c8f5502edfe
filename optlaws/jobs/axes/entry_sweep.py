"""Sweeps of problem files of cycles: an entry of an axis takes several values, with a row of costs for each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import dataclass
from math import inf
from typing import Any

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.summary import force_unit, objective_unit
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Either, Listed, Number, Text
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.files.tables import Cell
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.display_units import RPM
from optlaws.suggest import unknown_key
from optlaws.synthesis.status import Status

_PERCENT = 100.0


@declared
class SweepEntries(Declared, title="a sweep"):
    """An entry of an axis, such as "drive.ratio" or "mechanism.crank", and the values that it takes."""

    axis: str = entry(Text(), "The axis.", example="slide")
    values: tuple[str | float, ...] = entry(
        Listed(Either(Number(), Text(), which=lambda value: int(isinstance(value, str))), least=2, most=50),
        "What the entry is in turn.",
        example=[10, 20, 30],
    )
    entry: str = entry(
        Text(), 'Of the axis, such as "drive.ratio", "mechanism.crank" or "segment.1.duration".', example="drive.ratio"
    )


@dataclass(frozen=True)
class SweptCycle:
    """The cycle of an axis with a value of its entry; None without a motion, with the reason as its status."""

    value: str | float
    cycle: Cycle | None
    status: Status


def with_entry(axis: dict[str, Any], entry: str, value: str | float) -> dict[str, Any]:
    """The entries of an axis with another value of a single entry; parts of a list are counted from 1.

    Examples
    --------
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
    for part in way:
        if isinstance(place, list) and part.isdigit() and 1 <= int(part) <= len(place):
            place = place[int(part) - 1]
        elif isinstance(place, dict) and part in place:
            place = place[part]
        else:
            known = place if isinstance(place, dict) else [str(i + 1) for i in range(len(place))]
            raise InputError(f"entry {entry!r}: {unknown_key(part, known, 'entry')}")
    if not isinstance(place, dict):
        raise InputError(f"entry {entry!r} must end in the name of an entry, such as drive.ratio")
    place[last] = value
    return changed


def swept(sweep: SweepEntries, axis: dict[str, Any], cycle_of: Callable[[dict[str, Any]], Cycle]) -> list[SweptCycle]:
    """The cycles of an axis by the values of a sweep, with their laws.

    Parameters
    ----------
    sweep
        The entry and its values.
    axis
        The entries of the axis as plain data.
    cycle_of
        What makes a cycle of such entries.

    Raises
    ------
    InputError
        If there is no such entry, or a value is wrong; the error names both.
    """
    rows = []
    for value in sweep.values:
        where = f"sweep of {sweep.entry}, {value}"
        try:
            cycle = cycle_of(with_entry(axis, sweep.entry, value))
            _ = cycle.peaks  # laws are looked for now
            rows.append(SweptCycle(value, cycle, cycle.status))
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
        except InfeasibleProblem:
            rows.append(SweptCycle(value, None, Status.INFEASIBLE))
        except SolverFailure:
            rows.append(SweptCycle(value, None, Status.FAILED))
    return rows


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
        force, unit = ("force" if cycle.axis == "length" else "torque"), force_unit(cycle)
        needed: dict[str, Callable[[Cycle], Cell]] = {
            "peak": lambda each: each.effort.peak_force,
            "RMS": lambda each: each.effort.rms_force,
        }
        minimised = {force: "peak", f"rms {force}": "RMS"}.get(cycle.minimise) if cycle.solutions else None
        columns |= {f"{name} {force}, {unit}": cell for name, cell in needed.items() if name != minimised}
    if isinstance(cycle.drive, Drive):
        columns |= {"peak speed of the motor, rpm": _peak_speed, "greatest use of the motor, %": _use}
    return columns


def _peak_speed(cycle: Cycle) -> Cell:
    return RPM * cycle.sheet.peak_speed if isinstance(cycle.drive, Drive) else None


def _use(cycle: Cycle) -> Cell:
    """The greatest share of a limit of the motor; None where it has none, a word beyond its greatest speed."""
    if not isinstance(cycle.drive, Drive):
        return None
    margins = cycle.sheet.margins
    use = max((margin.use for margin in margins), default=None)
    return "too fast" if use == inf else None if use is None else _PERCENT * use
