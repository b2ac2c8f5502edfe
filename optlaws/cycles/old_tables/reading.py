"""Any file with a cam's table as points with units: columns of text, or the layouts of controllers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from optlaws.errors import InputError, located
from optlaws.laws.catalogue.tables.columns import ISG, points_of
from optlaws.laws.catalogue.tables.curve_pieces import CurvePiece
from optlaws.laws.catalogue.tables.table_points import TablePoints
from optlaws.motion.quantities import either
from optlaws.numbers import Array

_WHOLE_TURN = 1e-6  # of a turn: a master without a unit whose length is so near 360, 1 or 2 pi is one turn

#: units as headings write them
_UNITS = {"degree": "deg", "degrees": "deg", "grad": "deg", "°": "deg", "sec": "s", "turns": "turn", "revs": "rev"}
_WORD = re.compile(r"°|[A-Za-zµ]+")
_NUMBER = r"\d+(?:\.\d*)?(?:[eE][+-]?\d+)?"
#: units of places and heights in the comments that optlaws writes
_ABOUT = (
    re.compile(
        rf"master in (?P<master>\S+) from \S+ to [^\s,]+(?:, (?P<rate>{_NUMBER}) \S+/s)?, slave in (?P<slave>[^\s;]+)"
    ),
    re.compile(r"y\(x\) in (?P<slave>\S+) for x from \S+ to \S+ (?P<master>[^\s:]+):"),
)
_RATE = re.compile(rf"the master goes ({_NUMBER}) \S+/s")
_FACTOR = re.compile(rf"\s*({_NUMBER}|\.\d+)\s*(\D.*)")
#: masters without a unit, by their length
_TURNS = {360.0: "deg", 1.0: "turn", 2.0 * np.pi: "rad"}


class TableUnits(NamedTuple):
    """The units of positions and of the master, how many of these a number is, and the speed of the master if known."""

    slave: str
    master: str
    slave_size: float = 1.0
    master_size: float = 1.0
    rate: float | None = None


@dataclass(frozen=True)
class CamPoints:
    """Points of a cam with units: the master and the positions, arrays of shape (n,)."""

    places: Array
    heights: Array
    digit: float  #: the unit of the last digit of the positions
    layout: str
    units: TableUnits
    pieces: tuple[CurvePiece, ...] = ()  #: what runs between the points, where the file states it
    lines: Sequence[int] = ()  #: where the points stand in the file


def points_in(
    content: str,
    path: Path,
    columns: Sequence[int | str] | None = None,
    *,
    unit: str | None = None,
    master: str | None = None,
    cam: str | None = None,
) -> CamPoints:
    """The points in the text of a table in any layout, as `read_cycle_table` takes it; errors call it `path`."""
    points = points_of(path, columns, most=5, content=content, cam=cam)
    with located(str(path)):
        if points.layout.startswith("ROS") and unit is None and _about(content) is None:
            raise InputError("positions of ROS are in m or rad: say which as the unit")
        units = _units(points, content, unit, master)
    slave, size = units.slave_size, units.master_size
    places, heights = size * np.array(points.places), slave * np.array(points.heights)
    pieces = tuple(piece.scaled(size, slave) for piece in points.pieces)
    whole = TableUnits(units.slave, units.master, rate=units.rate)
    return CamPoints(places, heights, slave * points.digit, points.layout, whole, pieces, points.lines)


def _about(content: str) -> re.Match[str] | None:
    return next((match for pattern in _ABOUT if (match := pattern.search(content[:10_000]))), None)


def _units(points: TablePoints, content: str, unit: str | None, master: str | None) -> TableUnits:
    """The given TableUnits, or the units from comments of optlaws or headings, or from the length of the master."""
    about = _about(content)
    stated = (about["master"], about["slave"]) if about else ("", "")
    if points.layout == ISG:
        # whole numbers of 1e-4 deg or 1e-4 mm, whatever the units of what they were made of
        turns = bool(stated[1]) and either(f"1 {stated[1]}", ("length", "angle"), "unit")[0] == "angle"
        stated = ("deg", "deg" if turns else "mm")
    elif points.layout.startswith("ROS"):
        stated = (points.units[0], stated[1])
    stated_rate = _RATE.search(content[:10_000])
    rate = about.groupdict().get("rate") if about else None
    rate = rate or (stated_rate[1] if stated_rate else None)
    length = abs(points.places[-1] - points.places[0])
    supposed = next((name for turn, name in _TURNS.items() if abs(length - turn) <= _WHOLE_TURN * turn), "deg")
    of_master = master or stated[0] or _unit_in(points.units[0], ("angle", "time")) or supposed
    of_slave = unit or stated[1] or _unit_in(points.units[1], ("length", "angle")) or "mm"
    slave_size, slave = _sized(of_slave, ("length", "angle"), "unit")
    master_size, of_units = _sized(of_master, ("angle", "time", "length"), "master")
    known = float(rate) if rate and about and of_master == about["master"] else None
    return TableUnits(slave, of_units, slave_size, master_size, known)


def _sized(text: str, dimensions: tuple[str, ...], name: str) -> tuple[float, str]:
    match = _FACTOR.fullmatch(text)
    size, unit = (float(match[1]), match[2].strip()) if match else (1.0, text.strip())
    unit = _UNITS.get(unit.lower(), unit)
    either(f"1 {unit}", dimensions, name)
    if not size > 0.0:
        raise InputError(f"{name} must be a unit, or how many of one a number is, such as 0.01 mm, got {text}")
    return size, unit


def _unit_in(heading: str, dimensions: tuple[str, ...]) -> str | None:
    """The unit in a heading, the last word of it that is one."""
    for word in reversed(_WORD.findall(heading)):
        unit = _UNITS.get(word.lower(), word)
        if len(unit) == 1 and unit not in {"m", "s"}:
            continue
        try:
            either(f"1 {unit}", dimensions, "heading")
        except InputError:
            continue
        return str(unit)
    return None
