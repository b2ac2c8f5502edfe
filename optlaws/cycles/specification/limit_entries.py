"""The entries of limits: what may be limited of a segment and of a whole cycle, and by which quantities."""

from __future__ import annotations

from typing import Any

from optlaws.entries.declared import TableOf, entry
from optlaws.entries.frozen import FrozenTable
from optlaws.entries.value_types import Either, Listed, Measured, ReadBy, Switch, is_list
from optlaws.motion.quantities import written


def _limit(about: str, *dimensions: str, example: str) -> Any:
    return entry(Measured(*dimensions, above=0.0), about, default=None, example=example)


def _sided(of: str, example: str, more: str = "") -> Any:
    """A limit of a derivative: of its magnitude, or its least and its greatest value."""
    dimensions = of, f"angular {of}"
    sides = Listed(Measured(*dimensions), least=2, most=2)
    about = f"The greatest {of}; of two the first is the least value{more}."
    return entry(Either(Measured(*dimensions, above=0.0), sides, which=is_list), about, default=None, example=example)


_OF_MOTION = {
    "velocity": _sided("velocity", "616 mm/s", ", 0 where motions never turn back"),
    "acceleration": _sided("acceleration", "20 m/s^2"),
    "deceleration": _limit("Of moves that slow down.", "acceleration", "angular acceleration", example="14 m/s^2"),
    "jerk": _sided("jerk", "2000 m/s^3"),
    "snap": _limit("The greatest snap.", "snap", "angular snap", example="900000 m/s^4"),
    "force": _limit("Of the drive of a slide.", "force", example="120 N"),
    "torque": _limit("Of the drive of a table, or at the input of a mechanism.", "torque", example="6 N m"),
    "power": _limit("Of the drive.", "power", example="400 W"),
}
_OF_WHOLE = {
    "rms force": _limit("Root mean square over the cycle, as motors are rated.", "force", example="40 N"),
    "rms torque": _limit("Likewise of a table, or at the input of a mechanism.", "torque", example="2 N m"),
    "energy": _limit("Of the drive over the cycle.", "energy", example="12 J"),
    "motor": entry(Switch(), "Whether all limits of its motor hold.", default=None, example=True),
}
_OF_MOVE = {
    **{name: _OF_MOTION[name] for name in ("velocity", "acceleration", "deceleration", "jerk")},
    "snap": _sided("snap", "900000 m/s^4"),
    "torque": _limit("At its motor.", "torque", example="6 N m"),
    "rms torque": _limit("At its motor, over the move.", "torque", example="2 N m"),
    "residual acceleration": _limit(
        "The amplitude that its follower vibrates on with.", "acceleration", "angular acceleration", example="0.5 m/s^2"
    ),
    "residual displacement": _limit("The same as a displacement, such as sway.", "length", "angle", example="20 mm"),
}
_LOADED = ReadBy(written, "a quantity, or of a `Machine` a number in SI units", json={"type": ["string", "number"]})
_OF_CYCLE = dict.fromkeys(_OF_WHOLE, "is of the whole cycle: give it among the limits of the Cycle")

LIMITS_OF_SEGMENT = TableOf("limit", _OF_MOTION, keep=FrozenTable, elsewhere=_OF_CYCLE)
LIMITS_OF_CYCLE = TableOf(
    "limit",
    _OF_MOTION | _OF_WHOLE,
    keep=FrozenTable,
    further=lambda name: _LOADED if name.removeprefix("rms ").startswith("load ") else None,
)
LIMITS_OF_MOVE = TableOf("limit", _OF_MOVE, keep=FrozenTable)
