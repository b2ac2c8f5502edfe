"""Any file with a cam's table as points with units: columns of text, or the layouts of controllers."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from optlaws.cycles.old_tables.heading_units import GRAD, MASTER, NAMES, SIZE, SLAVE, size_of, unit_in
from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.laws.catalogue.tables.columns import ISG, points_of
from optlaws.laws.catalogue.tables.curve_pieces import TablePoints, TableUnits
from optlaws.motion.quantities import either
from optlaws.numbers import Array

_WHOLE_TURN = 1e-6  # of a turn: a master without a unit whose length is so near 360, 1 or 2 pi is one turn
_STEP_OFF = 0.02  # of a step: by how much rows without that of the end may be off a step before the turn

_NUMBER = r"\d+(?:\.\d*)?(?:[eE][+-]?\d+)?"
#: units of places and heights in the comments that optlaws writes
_ABOUT = (
    re.compile(
        rf"master in (?P<master>\S+) from \S+ to [^\s,]+(?:, (?P<rate>{_NUMBER}) \S+/s)?, slave in (?P<slave>[^\s;]+)"
    ),
    re.compile(r"y\(x\) in (?P<slave>\S+) for x from \S+ to \S+ (?P<master>[^\s:]+):"),
)
_RATE = re.compile(rf"the master goes ({_NUMBER}) \S+/s")
_FACTOR = re.compile(rf"\s*({SIZE}(?:\s*/\s*[1-9]\d*)?)\s*(\D.*)")
#: masters without a unit, by their length
_TURNS = {360.0: "deg", 1.0: "turn", 2.0 * np.pi: "rad"}
#: what "grad" means where a table of such a length is a turn
_GRADS = {360.0: "deg", 400.0: "gon"}


def points_in(
    content: str,
    path: Path,
    columns: Sequence[int | str] | None = None,
    *,
    unit: str | None = None,
    master: str | None = None,
    cam: str | None = None,
) -> TablePoints:
    """The points in the text of a table in any layout, as `read_cycle_table` takes it; errors call it `path`.

    Their units are those that are given, else those in comments of optlaws or in headings, else by the length of the
    master.
    """
    points = points_of(path, columns, most=5, content=content, cam=cam)
    about = next((match for pattern in _ABOUT if (match := pattern.search(content[:10_000]))), None)
    stated = TableUnits(about["master"], about["slave"]) if about else TableUnits()
    with located(str(path)):
        if points.layout == ISG:
            # whole numbers of 1e-4 deg or 1e-4 mm, whatever the units of what they were made of
            turns = bool(about) and either(f"1 {stated.slave}", ("length", "angle"), "unit")[0] == "angle"
            stated = TableUnits("deg", "deg" if turns else "mm")
        elif points.layout.startswith("ROS"):
            stated = stated._replace(master=points.units.master)
            if unit is None and about is None:
                raise InputError("positions of ROS are in m or rad: say which as the unit")
        grad = _turn_of(points.places, _GRADS) if GRAD in points.units.master.casefold() else None
        of_master = master or stated.master or unit_in(points.units.master, MASTER, grad)
        of_slave = unit or stated.slave or unit_in(points.units.slave, SLAVE, grad)
        layout = points.layout
        if of_slave is None:
            of_slave = "mm"
            layout += f"{_without_unit(points.units.slave)}, taken as {of_slave}"
        if of_master is None:
            of_master = _turn_of(points.places, _TURNS)
        if of_master is None:
            of_master = "deg"
            layout += f", master{_without_unit(points.units.master)}, taken as {of_master}"
        size, slave = _sized(of_slave, ("length", "angle"), "unit")
        step, whole = _sized(of_master, ("angle", "time", "length"), "master")
    speed = _RATE.search(content[:10_000])
    rate = (about.groupdict().get("rate") or (speed and speed[1])) if about and of_master == about["master"] else None
    return replace(
        points, layout=layout, places=step * points.places, heights=size * points.heights, digit=size * points.digit,
        pieces=tuple(piece.scaled(step, size) for piece in points.pieces), units=TableUnits(whole, slave),
        rate=float(rate) if rate else None,
    )  # fmt: skip


def _turn_of(places: Array, turns: Mapping[float, str]) -> str | None:
    """The unit in which places go over a whole turn, of which the row of the end may be missing."""
    length, step = abs(places[-1] - places[0]), abs(places[-1] - places[-2])
    for turn, unit in turns.items():
        if abs(length - turn) <= _WHOLE_TURN * turn or abs(length + step - turn) <= _STEP_OFF * step:
            return unit
    return None


def _without_unit(heading: str) -> str:
    return f" without a known unit in {shortened(heading)}" if heading else " without a unit"


def _sized(text: str, dimensions: tuple[str, ...], name: str) -> tuple[float, str]:
    match = _FACTOR.fullmatch(text)
    size, unit = (size_of(match[1]), match[2].strip()) if match else (1.0, text.strip())
    unit = NAMES.get(unit.lower(), unit)
    either(f"1 {unit}", dimensions, name)
    if not size > 0.0:
        raise InputError(f"{name} must be a unit, or how many of one a number is, such as 0.01 mm, got {text}")
    return size, unit
