"""ROS 2: trajectory_msgs/JointTrajectory, whose controllers interpolate according to the entries of the points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.exports.format import MOST_POINTS, Request, Written, file_format
from optlaws.exports.point_tables import DEGREES, NumberFormat, PointTable, chosen, hermite_table
from optlaws.exports.text import table_heading
from optlaws.files.writing import MARK
from optlaws.motion.motion import SLAVES, Motion, Units
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import either
from optlaws.numbers import Array
from optlaws.numerics.splines import hermite_powers

ORDERS = {"quintic": 3, "cubic": 2, "linear": 1}
FIELDS = ("positions", "velocities", "accelerations")
_NANO = 1_000_000_000


def joints(motions: Mapping[str, Motion], request: Request) -> dict[str, Written]:
    """A single trajectory of several joints, by their names; all exports share the text.

    Each joint has the points that it would have alone, and those of the others.
    """
    orders = ORDERS[request.interpolation_among(ORDERS, "quintic")]
    for name in motions:
        if not name.isprintable() or any(sign in name for sign in "\"'\\#:"):
            raise InputError(f"ROS takes no joint called {shortened(name)}: letters, digits, _ and / make a name")
    seconds = {name: _in_si(motion.over_time()) for name, motion in motions.items()}
    tables = {name: _table(motion, request, orders) for name, motion in seconds.items()}
    if len(tables) > 1:
        places = np.unique(np.concatenate([table.x for table in tables.values()]))
        tables = {name: _at(motion, places, orders) for name, motion in seconds.items()}
    text = _text(seconds, tables)
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
    write_joints=joints,
)
def _write(motion: Motion, request: Request) -> Written:
    return joints({request.name: motion}, request)[request.name]


def _table(motion: Motion, request: Request, orders: int) -> PointTable:
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


def _text(motions: Mapping[str, Motion], tables: Mapping[str, PointTable]) -> str:
    heading = table_heading(next(iter(motions.values())), "ROS 2, trajectory_msgs/JointTrajectory")[0]
    lines = [f"# {heading}; {MARK}", "joint_names:", *(f'- "{joint}"' for joint in motions), "points:"]
    x, values = next(iter(tables.values())).x, np.array([table.values for table in tables.values()])
    for time, rows in zip(x.tolist(), values.transpose(2, 1, 0).tolist(), strict=True):
        nanoseconds = round(time * _NANO)
        entries = [f"{field}: {row!r}" for field, row in zip(FIELDS, rows, strict=False)]
        entries.append(f"time_from_start: {{sec: {nanoseconds // _NANO}, nanosec: {nanoseconds % _NANO}}}")
        lines += [f"- {entries[0]}", *(f"  {entry}" for entry in entries[1:])]
    return "\n".join([*lines, ""])
