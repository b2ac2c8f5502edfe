"""Any file with a cam's table as points with units: columns of text, or the layouts of controllers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from optlaws.cycles.old_tables.controller_files import Decoded, decoded
from optlaws.cycles.old_tables.layouts import CurvePiece, hermite
from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.laws.catalogue.tables.columns import TablePoints, points_of, resolution_of
from optlaws.laws.catalogue.tables.tokens import uncommented
from optlaws.motion.quantities import either
from optlaws.numbers import Array

_TABLE_JUMP = 1e-6  # of the positions: by how much pieces of a file may be apart where they meet, as REAL32 leaves them
_TABLE_MASTER = 1e-9  # of the master's length: places of a table that are nearer are one
_TABLE_RATE = (
    0.25  # velocities of a table that are so near the slopes of its positions are by the master, not the second
)
_TABLE_SLOPE = 0.5  # of the greatest velocity of a table: one that is farther from the slope of the positions is wrong
_WHOLE_TURN = 1e-6  # of a turn: a master without a unit whose length is so near 360, 1 or 2 pi is one turn

#: how many places of pieces stand for them
_PLACES = 721
#: units as headings write them
_UNITS = {"degree": "deg", "degrees": "deg", "grad": "deg", "°": "deg", "sec": "s", "turns": "turn", "revs": "rev"}
_WORD = re.compile(r"°|[A-Za-zµ]+")
#: units of places and heights in the comments that optlaws writes
_ABOUT = (
    re.compile(
        r"master in (?P<master>\S+) from \S+ to [^\s,]+(?:, (?P<rate>[\d.e+-]+) \S+/s)?, slave in (?P<slave>[^\s;]+)"
    ),
    re.compile(r"y\(x\) in (?P<slave>\S+) for x from \S+ to \S+ (?P<master>[^\s:]+):"),
)
_RATE = re.compile(r"the master goes (\d[\d.e+-]*) \S+/s")
_FACTOR = re.compile(r"\s*([\d.]+(?:[eE][+-]?\d+)?)\s*(\D.*)")
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
    with located(str(path)):
        known = decoded(content, cam) if columns is None else None
    if known is None and cam is not None:
        raise InputError(f"{path} has columns of numbers, and no cam {shortened(cam)}")
    if known is None:
        return _of_columns(path, content, columns, unit, master)
    with located(str(path)):
        return _of_layout(known, content, unit, master)


def _of_layout(known: Decoded, content: str, unit: str | None, master: str | None) -> CamPoints:
    digit = 0.0  # pieces are what runs, however their ends are rounded
    if known.pieces:
        places, heights = sampled(known.pieces)
    else:
        places, heights = (np.array(texts, dtype=np.float64) for texts in (known.places, known.heights))
        digit = resolution_of(known.heights, heights.tolist())
    if known.layout.startswith("ROS"):
        master = master or "s"
        if unit is None and _about(content) is None:
            raise InputError("positions of ROS are in m or rad: say which as the unit")
    units = _units(("", ""), content, unit, master, float(np.ptp(places)))
    return _in_units(CamPoints(places, heights, digit, known.layout, units))


def _of_columns(
    path: Path, content: str, columns: Sequence[int | str] | None, unit: str | None, master: str | None
) -> CamPoints:
    points = points_of(path, columns, most=5, content=content)
    with located(str(path)):
        layout, scale = _columns_layout(content, points)
        places, heights = scale * np.array(points.places), scale * np.array(points.heights)
        if scale != 1.0:
            # whole numbers of 1e-4 deg or 1e-4 mm, whatever the units of what they were made of
            about = _about(content)
            turns = about is not None and either(f"1 {about['slave']}", ("length", "angle"), "unit")[0] == "angle"
            unit, master = unit or ("deg" if turns else "mm"), master or "deg"
        units = _units(points.headings, content, unit, master, float(np.ptp(places)))
        if points.derivatives:
            places, heights = _through(places, heights, points.derivatives, points.lines)
    return _in_units(CamPoints(places, heights, scale * points.digit, layout, units))


def _columns_layout(content: str, points: TablePoints) -> tuple[str, float]:
    """The layout of columns, and the factors of their numbers; refuses a table that states another number of points."""
    lines = uncommented(content).splitlines()
    count = sum(bool(line.strip()) for line in lines[points.lines[0] - 1 : points.lines[-1]])
    lines = [line.strip() for line in lines if line.strip()]
    keywords, first = {line.split()[0].lower() for line in lines}, lines[0]
    if any(line.startswith("TABLE_BEGIN") for line in lines):
        if not any(line.startswith("TABLE_END") for line in lines):
            raise InputError("the table has no TABLE_END: its end is missing")
        return "Kollmorgen KAS", 1.0
    if "begintable" in keywords:
        stated = re.search(r"^\s*Lines\s*=\s*(\d+)", content, re.MULTILINE | re.IGNORECASE)
        if "endtable" not in keywords:
            raise InputError("the table has no EndTable: its end is missing")
        _compare(int(stated[1]) if stated else count, count)
        return "ISG and TwinCAT CNC", 1e-4
    if first.isdigit():
        _compare(int(first), count)
        return "SEW MOVI-C", 1.0
    return "columns of numbers", 1.0


def _compare(stated: int, count: int) -> None:
    if stated != count:
        raise InputError(f"the file states {stated} points and contains {count}: lines are missing or superfluous")


def sampled(pieces: Sequence[CurvePiece]) -> tuple[Array, Array]:
    """Places all over pieces that follow each other without a jump, and the positions there.

    >>> from optlaws.cycles.old_tables.layouts import powers
    >>> x, y = sampled([powers(0.0, 1.0, [0.0, 1.0]), powers(1.0, 3.0, [1.0, -0.5])])
    >>> len(x), float(y[-1])
    (721, 0.0)
    """
    start, stop = pieces[0].start, pieces[-1].stop
    size, at = 0.0, None
    for piece in pieces:
        low, high = piece.position(np.array([0.0, piece.stop - piece.start])).tolist()
        size = max(size, abs(low), abs(high))
        if at is not None and not (at[0] == piece.start and abs(at[1] - low) <= _TABLE_JUMP * size):
            raise InputError(
                f"a piece ends at {at[0]:.9g} with the position {at[1]:.9g} and the next begins at {piece.start:.9g} "
                f"with {low:.9g}: the pieces do not follow each other"
            )
        at = (piece.stop, high)
    joints = np.array([piece.start for piece in pieces] + [stop])
    x = np.unique(np.concatenate([np.linspace(start, stop, _PLACES), joints]))
    # places that are nearly a joint are the joint
    x = x[np.concatenate([[True], np.diff(x) > _TABLE_MASTER * (stop - start)])]
    which = np.clip(np.searchsorted(joints, x, side="right") - 1, 0, len(pieces) - 1)
    y = np.empty_like(x)
    for i, piece in enumerate(pieces):
        y[which == i] = piece.position(x[which == i] - piece.start)
    return x, y


def _through(
    places: Array, heights: Array, derivatives: Sequence[Sequence[float]], lines: Sequence[int]
) -> tuple[Array, Array]:
    """Positions by the polynomials between points with derivatives, which may be by the second."""
    rate = rate_of(places, heights, np.array(derivatives[0]), lines)
    values = [heights, *(np.array(row) / rate**nu for nu, row in enumerate(derivatives, start=1))]
    ends = list(zip(*values, strict=True))
    pieces = [
        hermite(float(start), float(stop), first, last)
        for start, stop, first, last in zip(places, places[1:], ends, ends[1:], strict=False)
    ]
    return sampled(pieces)


def rate_of(places: Array, heights: Array, velocities: Array, lines: Sequence[int]) -> float:
    """The speed of the master where velocities are per second; 1 where they are per unit of the master.

    The integral of their magnitude by the trapezium rule, which is sharp between rests, is the way of the positions
    times the rate.

    >>> x = np.linspace(0.0, 10.0, 101)
    >>> round(rate_of(x, np.sin(x), 5.0 * np.cos(x), range(101)), 2), rate_of(x, np.sin(x), np.cos(x), range(101))
    (5.0, 1.0)
    """
    steps, means = np.diff(places), 0.5 * (velocities[1:] + velocities[:-1])
    way = float(np.abs(np.diff(heights)).sum())
    rate = float(np.abs(steps * means).sum()) / way if way else 1.0
    off = np.abs(means - rate * np.diff(heights) / steps) / max(float(np.abs(velocities).max()), np.finfo(float).tiny)
    worst = int(np.argmax(off))
    if not rate > 0.0 or off[worst] > _TABLE_SLOPE:
        raise InputError(f"line {lines[worst]}: the velocity there is not that of the positions: check the columns")
    return 1.0 if abs(rate - 1.0) < _TABLE_RATE else rate


def _about(content: str) -> re.Match[str] | None:
    return next((match for pattern in _ABOUT if (match := pattern.search(content[:10_000]))), None)


def _units(headings: tuple[str, str], content: str, unit: str | None, master: str | None, length: float) -> TableUnits:
    """The given TableUnits, or the units from comments of optlaws or headings, or from the length of the master."""
    about = _about(content)
    stated = (about["master"], about["slave"]) if about else (None, None)
    stated_rate = _RATE.search(content[:10_000])
    rate = about.groupdict().get("rate") if about else None
    rate = rate or (stated_rate[1] if stated_rate else None)
    supposed = next((name for turn, name in _TURNS.items() if abs(length - turn) <= _WHOLE_TURN * turn), "deg")
    of_master = master or stated[0] or _unit_in(headings[0], ("angle", "time")) or supposed
    of_slave = unit or stated[1] or _unit_in(headings[1], ("length", "angle")) or "mm"
    slave_size, slave = _sized(of_slave, ("length", "angle"), "unit")
    master_size, of_units = _sized(of_master, ("angle", "time", "length"), "master")
    return TableUnits(
        slave, of_units, slave_size, master_size, float(rate) if rate and of_master == stated[0] else None
    )


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


def _in_units(points: CamPoints) -> CamPoints:
    """The points in whole units."""
    units = points.units
    slave, size = units.slave_size, units.master_size
    whole = TableUnits(units.slave, units.master, rate=units.rate)
    return CamPoints(size * points.places, slave * points.heights, slave * points.digit, points.layout, whole)
