"""ROS 2: trajectory_msgs/JointTrajectory, whose controllers interpolate by what the points hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.exports.format import MOST_POINTS, Request, Written, file_format
from optlaws.exports.formats.point_table import DEGREES, NumberFormat, hermite_table
from optlaws.exports.interpolation import hermite_powers
from optlaws.exports.spacing import PointTable, chosen
from optlaws.exports.text import table_heading
from optlaws.files.writing import MARK
from optlaws.motion.motion import Motion, Units
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.motion.quantities import quantity

ORDERS = {"quintic": 3, "cubic": 2, "linear": 1}
FIELDS = ("positions", "velocities", "accelerations")
_NANO = 1_000_000_000


@file_format(
    "ros2",
    target="ROS 2, trajectory_msgs/JointTrajectory as YAML",
    contents="positions, velocities, accelerations (m or rad, double), time in nanoseconds",
    model="quintic Hermite; cubic without accelerations, straight lines without velocities",
    limits="the master is time",
    extension=".yaml",
    takes=("points", "interpolation"),
)
def _write(motion: Motion, request: Request) -> Written:
    interpolation = request.interpolation_among(ORDERS, "quintic")
    name = request.name
    if not name.isprintable() or any(sign in name for sign in "\"'\\#:"):
        raise InputError(f"ROS takes no joint called {shortened(name)}: letters, digits, _ and / make a name")
    seconds = _in_si(motion.over_time())

    def make(count: int) -> PointTable:
        return _timed(hermite_table(seconds, count, NumberFormat(), ORDERS[interpolation]))

    table = chosen(seconds, request, make, least=2, most=MOST_POINTS)
    return Written(_text(seconds, name, table), _back(table.run, motion), DEGREES[len(table.values)], len(table.x))


def _in_si(motion: Motion) -> Motion:
    """In m or rad, as ROS has them."""
    dimension, unit = ("angle", "rad") if _is_angle(motion.units.slave) else ("length", "m")
    size = quantity(f"1 {motion.units.slave}", dimension, "slave")
    pieces = tuple(replace(piece, offset=size * piece.offset, stroke=size * piece.stroke) for piece in motion.pieces)
    return replace(motion, pieces=pieces, units=Units("s", unit, 1.0))


def _is_angle(unit: str) -> bool:
    try:
        quantity(f"1 {unit}", "angle", "slave")
    except InputError:
        return False
    return True


def _timed(table: PointTable) -> PointTable:
    """The table with its times in whole nanoseconds, as messages hold them."""
    x = np.rint(table.x * _NANO) / _NANO
    if (np.diff(x) <= 0.0).any():
        raise InputError(f"{len(x)} points are closer than a nanosecond: take fewer")
    return replace(table, x=x, powers=hermite_powers(x, table.values))


def _back(run: PiecewiseMotion, motion: Motion) -> PiecewiseMotion:
    """The run by the motion's own master and in its slave's unit."""
    dimension = "angle" if _is_angle(motion.units.slave) else "length"
    return run.in_units(motion.units.rate or 1.0, 1.0 / quantity(f"1 {motion.units.slave}", dimension, "slave"))


def _text(motion: Motion, joint: str, table: PointTable) -> str:
    lines = [f"# {table_heading(motion, 'ROS 2, trajectory_msgs/JointTrajectory')[0]}; {MARK}"]
    lines += ["joint_names:", f'- "{joint}"', "points:"]
    for x, values in zip(table.x.tolist(), table.values.T.tolist(), strict=True):
        nanoseconds = round(x * _NANO)
        number_format = (f"  {field}: [{value!r}]" for field, value in zip(FIELDS, values, strict=False))
        first, *others = (line[2:] for line in number_format)
        lines += [f"- {first}", *(f"  {line}" for line in others)]
        lines.append(f"  time_from_start: {{sec: {nanoseconds // _NANO}, nanosec: {nanoseconds % _NANO}}}")
    return "\n".join([*lines, ""])
