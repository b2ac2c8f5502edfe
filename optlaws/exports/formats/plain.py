"""Tables as text without a language: SEW, Lenze, KAS, ISG and TwinCAT CNC, Technosoft, plcopen, CSV; ROS 2 in YAML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.exports.format import MOST_POINTS, Request, Written, file_format
from optlaws.exports.point_tables import (
    DEGREES,
    NumberFormat,
    PointTable,
    chosen,
    chosen_table,
    hermite_table,
    is_cyclic,
    places,
    point_table,
)
from optlaws.exports.text import plain_column, table_heading
from optlaws.files.writing import MARK
from optlaws.motion.motion import SLAVES, Motion, Units
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import either, quantity
from optlaws.numbers import Array
from optlaws.numerics.splines import Ends, hermite_powers, linear_powers
from optlaws.tolerances import CLOSURE

_DECADIC_STEP = 1e-4  # the last digit that an ISG cam table has

MODELS = {
    "linear": "straight lines",
    "cubic": "C2 cubic spline clamped to the law's velocities at the ends",
    "akima": "Akima's cubics, as in Modelica's tables",
    "c1": "cubic Hermite with the law's velocities at the points",
    "quintic": "quintic Hermite",
    "septic": "Hermite of degree 7",
}
ISG_LINES, ISG_LEAST = 360, 0.1
TECHNOSOFT_POINTS, TECHNOSOFT_STEPS = 8192, 128
PLCOPEN_POINTS = 64


_TEXT = ("points", "counts", "digits", "decimal")
_plain_format = partial(file_format, takes=_TEXT, contents="x, y as text", limits="no number of points is stated")


def _columns_of_axes(motions: Mapping[str, Motion], request: Request) -> dict[str, Written]:
    """A single table over one master with columns for each axis, by their names; all exports share the text.

    Each axis has the points that it would have alone, and those of the others.
    """
    interpolation = request.interpolation_among(MODELS, "cubic")
    tables = {name: chosen_table(motion, request, interpolation, MOST_POINTS) for name, motion in motions.items()}
    if len(tables) > 1:
        numbers = NumberFormat(request.counts, request.digits)
        x = np.unique(np.concatenate([table.x for table in tables.values()]))
        # what differs by rounding is one place
        x = x[np.diff(x, append=np.inf) > CLOSURE * (x[-1] - x[0])]
        tables = {name: point_table(motion, x, numbers, interpolation) for name, motion in motions.items()}
    separator = ";" if request.decimal == "," else ","
    first = next(iter(motions.values()))
    headings, columns = [f"x {first.units.master}"], [next(iter(tables.values())).x.tolist()]
    for name, motion in motions.items():
        units, axis = motion.units, f"{name} " if len(motions) > 1 else ""
        derivatives = [units.slave, *(f"{units.slave}/{units.master}{power}" for power in ("", "^2", "^3"))]
        values = tables[name].values.tolist()
        headings += [f"{axis}{letter} {unit}" for letter, unit in zip("yVAJ", derivatives[: len(values)], strict=False)]
        columns += values
    about = table_heading(first, "table")[0]
    if len(motions) > 1:
        about = f"table of {', '.join(motions)} over one master in {first.units.master}"
    lines = [f"# {about}; {MARK}", separator.join(headings)]
    text = _lines([*lines, *_rows(columns, request, separator)])
    return {
        name: table.written(text, MODELS[interpolation], _overshoot(motions[name]) if interpolation == "septic" else ())
        for name, table in tables.items()
    }


def _overshoot(motion: Motion) -> tuple[str, ...]:
    """What is to be said of polynomials of degree 7 where the jerk jumps, as into a dwell."""
    jump, x = motion.jump(3)
    joint = f"the jerk jumps at {x:.9g} {motion.units.master}, and a point holds one value of it"
    remedy = "take interpolation='quintic', which leaves the jerk out"
    return (
        (f"{joint}: the run overshoots beside it, by the greatest deviation of the report; {remedy}",) if jump else ()
    )


@_plain_format(
    "csv",
    target="any, comma-separated values with units in the heading",
    contents="x, y and as many of V, A, J as the interpolation takes",
    model=f"as asked: {', '.join(MODELS)}",
    extension=".csv",
    takes=(*_TEXT, "interpolation"),
    write_joints=_columns_of_axes,
)
def _csv(motion: Motion, request: Request) -> Written:
    return _columns_of_axes({request.name: motion}, request)[request.name]


@_plain_format(
    "sew",
    target="SEW MOVI-C, list of points",
    model="cubics whose acceleration jumps at every point, or straight lines",
    extension=".csv",
    takes=(*_TEXT, "interpolation"),
)
def _sew(motion: Motion, request: Request) -> Written:
    interpolation = request.interpolation_among(("c1", "linear"), "c1")
    if interpolation == "linear":
        table = chosen_table(motion, request, interpolation, MOST_POINTS)
    else:
        numbers = NumberFormat(request.counts, request.digits)
        make = partial(hermite_table, motion, numbers=numbers, orders=2, with_derivatives=False)
        table = chosen(motion, request, make, least=2, most=MOST_POINTS)
    lines = [str(len(table.x)), *_rows(_x_and_y(table), request, ";")]
    model = {"linear": "straight lines", "c1": "cubics whose acceleration jumps at every point, here with the law's V"}
    return table.written(_lines(lines), model[interpolation])


@_plain_format("lenze", target="Lenze Cam Loader", model="C2 cubic spline (assumed)", extension=".txt")
def _lenze(motion: Motion, request: Request) -> Written:
    table = chosen_table(motion, request, "cubic", MOST_POINTS)
    first, *others = _rows(_x_and_y(table), request, " ")
    return table.written(_lines([f"{first} // {table_heading(motion, 'cam')[0]}; {MARK}", *others]), MODELS["cubic"])


@_plain_format(
    "plcopen",
    target="plcopen, the open run time (pyplcopen), cam table of load_cam_table_csv",
    model="C2 cubic spline, natural or cyclic, or straight lines",
    limits=f"at most {PLCOPEN_POINTS} points of a spline",
    extension=".csv",
    takes=("points", "counts", "digits", "interpolation"),
)
def _plcopen(motion: Motion, request: Request) -> Written:
    interpolation = request.interpolation_among(("cubic", "linear"))
    most, model, cyclic = MOST_POINTS, MODELS["linear"], is_cyclic(motion)
    if interpolation == "cubic":
        most, model = PLCOPEN_POINTS, f"C2 cubic spline, {'cyclic' if cyclic else 'natural'}"
    ends: Ends = "periodic" if cyclic else "natural"
    table = chosen_table(motion, request, interpolation, most, least=4, ends=ends)
    heading = f"# {table_heading(motion, 'cam')[0]}; {MARK}"
    return table.written(_lines([heading, *_rows(_x_and_y(table), request, ",")]), model)


@_plain_format(
    "kas",
    target="Kollmorgen KAS, cam profile as CSV",
    model="C2 cubic spline",
    limits="at least 4 segments; scaled by the greatest X and Y when it is imported",
    extension=".csv",
)
def _kas(motion: Motion, request: Request) -> Written:
    table = chosen_table(motion, request, "cubic", MOST_POINTS, least=5)
    lines = ["CYCLIC;YES;" if motion.repeats else "CYCLIC;NO;", "TABLE_BEGIN;;"]
    lines += [f"{row};SPLINE" for row in _rows(_x_and_y(table), request, ";")]
    top = plain_column(float(np.abs(values).max()) for values in (table.x, table.values[0]))
    notes = (f"KAS divides X and Y by their greatest values: set the scales to {top[0]} and {top[1]} in the dialog",)
    return table.written(_lines([*lines, "TABLE_END;;"]), MODELS["cubic"], notes)


@_plain_format(
    "isg",
    target="ISG kernel and TwinCAT CNC, cam table",
    contents="master, slave as integers of 1e-4 deg or 1e-4 mm",
    model="straight lines",
    limits=f"at most {ISG_LINES} points, at least {ISG_LEAST} deg apart; the master is an angle",
    extension=".txt",
    takes=("points",),
)
def _isg(motion: Motion, request: Request) -> Written:
    x_size = _unit_size(motion.units.master, "deg", "master")
    y_size = _unit_size(motion.units.slave, "deg" if motion.units.slave in {"deg", "rad", "°"} else "mm", "slave")
    most = min(ISG_LINES, 1 + int(np.floor(motion.length * x_size / ISG_LEAST * (1 + 1e-12))))

    x_step, y_step = _DECADIC_STEP / x_size, _DECADIC_STEP / y_size
    table = chosen(motion, request, partial(_integers, motion, x_step=x_step, y_step=y_step), least=2, most=most)
    name = "".join(letter if letter.isalnum() else "_" for letter in request.name)
    rows = [(round(x / x_step), round(y / y_step)) for x, y in zip(*_x_and_y(table), strict=True)]
    if min(after[0] - before[0] for before, after in pairwise(rows)) < round(ISG_LEAST / _DECADIC_STEP):
        raise InputError(f"ISG wants points at least {ISG_LEAST} deg apart: take fewer points")
    head = [
        f"Tablename = {name} # {table_heading(motion, 'cam')[0]}; {MARK}",
        "Table-ID = 1",
        "Tabletype = 7 # pairs of integers, 1e-4 deg or 1e-4 mm",
        "Function type = 1 # linear",
        f"Lines = {len(rows)}",
    ]
    return table.written(_lines([*head, "Begintable", *(f"{x} {y}" for x, y in rows), "EndTable"]), "straight lines")


@_plain_format(
    "technosoft",
    target="Technosoft, cam table",
    contents="x, y as integers",
    model="straight lines",
    limits=f"at most {TECHNOSOFT_POINTS} points with equal steps of a power of two, 32 bits",
    extension=".txt",
    takes=("points", "counts"),
)
def _technosoft(motion: Motion, request: Request) -> Written:
    step = motion.stroke / (request.counts or 65_536)
    table = chosen(
        motion, request, partial(_integers, motion, x_step=None, y_step=step), least=2, most=TECHNOSOFT_POINTS
    )
    rows = [(i * TECHNOSOFT_STEPS, round(y / step)) for i, y in enumerate(table.values[0].tolist())]
    if max(abs(y) for _, y in rows) >= 2**31:
        raise InputError("counts: a position is beyond 32 bits; take fewer counts")
    notes = (f"one count of the master is {motion.length / rows[-1][0]:.12g} {motion.units.master}",)
    return table.written(_lines([f"{x} {y}" for x, y in rows]), "straight lines", notes)


def _integers(motion: Motion, count: int, x_step: float | None, y_step: float) -> PointTable:
    """Points whose coordinates are whole multiples of steps, in machine units; of equal ones without that of x."""
    exact = places(motion, count) if x_step else np.linspace(motion.start, motion.stop, count)
    x_step = x_step or motion.length / (count - 1)
    x = np.rint(exact / x_step) * x_step
    if (np.diff(x) <= 0.0).any():
        raise InputError(f"{count} points of the master are closer than the target's step {x_step:g}: take fewer")
    y = np.rint(np.asarray(motion(exact)) / y_step) * y_step
    return PointTable(x, y[None], linear_powers(x, y), y_step)


def _unit_size(unit: str, target_unit: str, side: str) -> float:
    """The number of units of the file in a given unit."""
    dimension = "angle" if target_unit == "deg" else "length"
    try:
        return quantity(f"1 {unit}", dimension, side) / quantity(f"1 {target_unit}", dimension, side)
    except InputError:
        example = f"{side}='120 deg'" if dimension == "angle" else f"a stroke such as '35 {target_unit}'"
        refused = f"the {side} must be in {target_unit}, which the target counts, got {unit}"
        raise InputError(f"{refused}: give {example}") from None


# ROS 2: its controllers interpolate according to the entries of the points

_ROS_ORDERS = {"quintic": 3, "cubic": 2, "linear": 1}
_ROS_FIELDS = ("positions", "velocities", "accelerations")
_NANO = 1_000_000_000


def _joints(motions: Mapping[str, Motion], request: Request) -> dict[str, Written]:
    """A single trajectory of several joints, by their names; all exports share the text.

    Each joint has the points that it would have alone, and those of the others.
    """
    orders = _ROS_ORDERS[request.interpolation_among(_ROS_ORDERS, "quintic")]
    for name in motions:
        if not name.isprintable() or any(sign in name for sign in "\"'\\#:"):
            raise InputError(f"ROS takes no joint called {shortened(name)}: letters, digits, _ and / make a name")
    seconds = {name: _in_si(motion.over_time()) for name, motion in motions.items()}
    tables = {name: _ros_table(motion, request, orders) for name, motion in seconds.items()}
    if len(tables) > 1:
        places = np.unique(np.concatenate([table.x for table in tables.values()]))
        tables = {name: _at(motion, places, orders) for name, motion in seconds.items()}
    text = _ros_text(seconds, tables)
    written = {}
    for name, table in tables.items():
        units = motions[name].units
        run = table.run.in_units(units.rate or 1.0, 1.0 / either(f"1 {units.slave}", SLAVES, "slave")[1])
        written[name] = Written(text, run, DEGREES[orders], len(table.x))
    return written


@file_format(
    "ros2",
    target="ROS 2, trajectory_msgs/JointTrajectory as YAML",
    contents="positions, velocities, accelerations (m or rad, double), time in nanoseconds",
    model="quintic Hermite; cubic without accelerations, straight lines without velocities",
    limits="the master is time",
    extension=".yaml",
    takes=("points", "interpolation"),
    write_joints=_joints,
)
def _ros(motion: Motion, request: Request) -> Written:
    return _joints({request.name: motion}, request)[request.name]


def _ros_table(motion: Motion, request: Request, orders: int) -> PointTable:
    """The table with its times in whole nanoseconds, as messages hold them."""

    def make(count: int) -> PointTable:
        table = hermite_table(motion, count, NumberFormat(), orders)
        x = np.rint(table.x * _NANO) / _NANO
        if (np.diff(x) <= 0.0).any():
            raise InputError(f"{len(x)} points are closer than a nanosecond: take fewer")
        return replace(table, x=x, powers=hermite_powers(x, table.values))

    return chosen(motion, request, make, least=2, most=MOST_POINTS)


def _at(motion: Motion, places: Array, orders: int) -> PointTable:
    """The table at whole nanoseconds; a point within a nanosecond of a break has the break's values."""
    breaks = np.array(motion.breaks)
    near = breaks[np.abs(places[:, None] - breaks).argmin(axis=1)]
    at = np.where(np.abs(near - places) * _NANO <= 1.0, near, np.clip(places, motion.start, motion.stop))
    values = np.array([motion(at, nu) for nu in range(orders)])
    return PointTable(places, values, hermite_powers(places, values), 0.0)


def _in_si(motion: Motion) -> Motion:
    """The motion in m or rad, the units of ROS."""
    axis, size = either(f"1 {motion.units.slave}", SLAVES, "slave")
    pieces = tuple(replace(piece, offset=size * piece.offset, stroke=size * piece.stroke) for piece in motion.pieces)
    return replace(motion, pieces=pieces, units=Units("s", unit_of(axis), 1.0))


def _ros_text(motions: Mapping[str, Motion], tables: Mapping[str, PointTable]) -> str:
    heading = table_heading(next(iter(motions.values())), "ROS 2, trajectory_msgs/JointTrajectory")[0]
    lines = [f"# {heading}; {MARK}", "joint_names:", *(f'- "{joint}"' for joint in motions), "points:"]
    x, values = next(iter(tables.values())).x, np.array([table.values for table in tables.values()])
    for time, rows in zip(x.tolist(), values.transpose(2, 1, 0).tolist(), strict=True):
        nanoseconds = round(time * _NANO)
        entries = [f"{field}: {row!r}" for field, row in zip(_ROS_FIELDS, rows, strict=False)]
        entries.append(f"time_from_start: {{sec: {nanoseconds // _NANO}, nanosec: {nanoseconds % _NANO}}}")
        lines += [f"- {entries[0]}", *(f"  {entry}" for entry in entries[1:])]
    return "\n".join([*lines, ""])


def _x_and_y(table: PointTable) -> tuple[list[float], list[float]]:
    return table.x.tolist(), table.values[0].tolist()


def _rows(columns: Sequence[Iterable[float]], request: Request, separator: str) -> list[str]:
    """Lines of a table whose numbers are given column by column."""
    texts = (plain_column(column, request.digits, request.decimal) for column in columns)
    return list(map(separator.join, zip(*texts, strict=True)))


def _lines(lines: Sequence[str]) -> str:
    return "\n".join([*lines, ""])
