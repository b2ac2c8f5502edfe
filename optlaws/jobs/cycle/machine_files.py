"""What the axes of a problem file are exported to: the files of controllers, and what these will run."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import msgspec

from optlaws.cycles.cycle import Cycle
from optlaws.errors import InputError
from optlaws.exports.export import Export, export_cycle
from optlaws.exports.format import FORMATS, format_of
from optlaws.exports.identifiers import variable_names
from optlaws.files import tables, writing
from optlaws.jobs.cycle.entries import AskedExport, Axis, Study
from optlaws.results.page import Page

#: the exports of each axis by the names of their files
Exports = dict[str, dict[str, Export]]

#: what the picture of all axes is called
TOGETHER = "axes"
_HEADINGS = ("file", "format", "points", "peak velocity", "peak acceleration", "peak jerk", "greatest deviation, unit")


def exports_of(spec: Study, cycles: Mapping[str, Cycle], file: Path) -> Exports:
    """The exports that the axes name, made but not yet written.

    Raises
    ------
    InputError
        If one is wrong or cannot hold its axis, or two have the same file; the error names file and axis.
    """
    made: Exports = {}
    if len(spec.axis) > 1 and TOGETHER in {plain_name(axis.name) for axis in spec.axis}:
        raise InputError(f"{file}: an axis is called {TOGETHER}, as the picture of all is: give it another name")
    taken = {"cycle.md", "cycle.json", f"{TOGETHER}.svg", f"{TOGETHER}.png"}
    taken |= {f"{plain_name(axis.name)}{ending}" for axis in spec.axis for ending in (".csv", ".svg", ".png")}
    names = variable_names(axis.name for axis in spec.axis)
    for axis in spec.axis:
        try:
            made[axis.name] = _of_axis(axis, cycles[axis.name], names[axis.name], taken)
        except InputError as error:
            raise InputError(f"{file}: axis {axis.name}: export {error}") from None
    return made


def plain_name(axis: str) -> str:
    """The name of an axis as files have it.

    Examples
    --------
    >>> plain_name("Weld head")
    'weld_head'
    """
    return "".join(letter if letter.isalnum() else "_" for letter in axis.lower())


def add_exports(page: Page, made: Mapping[str, Export]) -> None:
    """A table of what controllers will run, where there are exports."""
    if made:
        page.text("What controllers will run: peaks of the exported files as interpolated, over the law's.")
        page.table(_HEADINGS, [_row(name, export) for name, export in made.items()], digits=7)


def _of_axis(axis: Axis, cycle: Cycle, variable: str, taken: set[str]) -> dict[str, Export]:
    made: dict[str, Export] = {}
    for asked in axis.export:
        name = _file_name(axis.name, asked)
        if name in taken:
            raise InputError(f"to {asked.to}: another file is called {name}: give each a name of its own")
        taken.add(name)
        try:
            made[name] = _export(cycle, asked, variable)
        except InputError as error:
            raise InputError(f"to {asked.to}: {error}") from None
    return made


def _export(cycle: Cycle, asked: AskedExport, variable: str) -> Export:
    given = msgspec.structs.asdict(asked)
    given["name"] = variable if asked.name is None else asked.name
    said = {"master": given.pop("master"), "unit": given.pop("unit")}
    del given["file"], given["to"]
    return export_cycle(cycle, asked.to, said, **given)


def _file_name(axis: str, asked: AskedExport) -> str:
    form = format_of(asked.to)
    name = asked.file or f"{plain_name(axis)}_{form.name}{FORMATS[form.name].extension}"
    if Path(name).name != name:
        raise InputError(f"to {asked.to}: file must be a name without a folder, got {name}")
    writing.check_name(Path(name))
    return name


def _row(name: str, export: Export) -> list[tables.Cell]:
    ratios = [export.report.ratio(nu) for nu in (1, 2, 3)]
    shown = [f"{ratio:.7g}" if abs(ratio) < float("inf") else "leaps" for ratio in ratios]
    deviation = f"{export.report.deviation[0].value:.3g} {export.motion.units.slave}"
    return [name, export.format.name, export.points, *shown, deviation]
