"""Limits of cycles, segments and moves: their entries, and one mapping of kinds to the least and the greatest value."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import Any, NamedTuple, TypeAlias

from optlaws.echo import shortened
from optlaws.entries.declared import FrozenTable, TableOf, entry
from optlaws.entries.value_types import Either, Listed, Measured, ReadBy, Switch, is_list
from optlaws.errors import InputError
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import Kind, in_small_units, quantity, written
from optlaws.numerics.peaks import is_kept
from optlaws.sentences import Amount, quantity_name, sentence

#: a `Load`, which knows this module
Load: TypeAlias = Any

#: dimensions of the derivatives of a position, for slides and for tables
AXES = {
    "length": ("length", "velocity", "acceleration", "jerk", "snap"),
    "angle": ("angle", "angular velocity", "angular acceleration", "angular jerk", "angular snap"),
}
LIMITS = {
    "velocity": Kind.VELOCITY,
    "acceleration": Kind.ACCELERATION,
    "jerk": Kind.JERK,
    "snap": Kind.SNAP,
    "force": Kind.FORCE,
    "torque": Kind.FORCE,
    "power": Kind.POWER,
}
#: limits of the whole cycle or move alone
OF_WHOLE = {
    "rms force": Kind.RMS_FORCE,
    "rms torque": Kind.RMS_FORCE,
    "energy": Kind.ENERGY,
    "residual acceleration": Kind.RESIDUAL,
    "residual displacement": Kind.RESIDUAL_DISPLACEMENT,
}
FORCES = {"length": "force", "angle": "torque"}
FORCE_UNITS = {"length": "N", "angle": "N m"}
MOTOR, LOAD = "motor", "load "
DECELERATION, SPEEDING_UP, BACKWARDS = "deceleration", "acceleration along the motion", "velocity backwards"
_ALONG = (DECELERATION, SPEEDING_UP, BACKWARDS)
_NO_SIDES = (*OF_WHOLE.values(), Kind.VELOCITY_ALONG, Kind.ACCELERATION_ALONG)


def _limit(about: str, *dimensions: str, example: str) -> Any:
    return entry(Measured(*dimensions, bare=True, above=0.0), about, default=None, example=example)


def _sided(of: str, example: str, more: str = "") -> Any:
    """A limit of a derivative: of its magnitude, or its least and its greatest value."""
    dimensions = of, f"angular {of}"
    sides, most = Listed(Measured(*dimensions, bare=True), least=2, most=2), Measured(*dimensions, bare=True, above=0.0)
    about = f"The greatest {of}; of two the first is the least value{more}."
    return entry(Either(most, sides, which=is_list), about, default=None, example=example)


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
    MOTOR: entry(Switch(), "Whether all limits of its motor hold.", default=None, example=True),
}
_OF_MOVE = {
    **{name: _OF_MOTION[name] for name in ("velocity", "acceleration", "deceleration", "jerk")},
    "snap": _sided("snap", "900000 m/s^4"),
    "torque": _limit("At its motor.", "torque", example="6 N m"),
    "rms torque": _limit("At its motor, over the move.", "torque", example="2 N m"),
    "residual acceleration": _limit(
        "The amplitude of its follower's residual vibration, as an acceleration.",
        "acceleration",
        "angular acceleration",
        example="0.5 m/s^2",
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
    further=lambda name: _LOADED if name.removeprefix("rms ").startswith(LOAD) else None,
)
LIMITS_OF_MOVE = TableOf("limit", _OF_MOVE, keep=FrozenTable)


class LoadOutput(NamedTuple):
    """An output of the load, or its root mean square."""

    output: str
    mean: bool


#: the least and the greatest allowed value of each limited quantity in SI units
Limits: TypeAlias = Mapping[Kind | LoadOutput, tuple[float, float]]


class Side(NamedTuple):
    """What a limit of a segment bounds: the magnitude of a quantity, or with a sign one side of it, under its name."""

    kind: Kind
    sign: float = 0.0
    name: str = ""


#: the greatest allowed value of each limited side, in SI units
Sides: TypeAlias = dict[Side, float]


class LimitTaken(NamedTuple):
    """The use of a limit by a motion, in SI units.

    Attributes
    ----------
    name
        What is limited, such as "velocity".
    where
        The segment that takes most of it; empty of a limit of the whole.
    value, limit
        What is taken at most, everywhere in the segment or the cycle, and what is allowed.
    text
        The limit in the unit that machines have it in.
    value_text
        The value in that unit.
    unit
        That of value and limit, where there are no texts.
    """

    name: str
    where: str
    value: float
    limit: float
    text: str
    value_text: str = ""
    unit: str = ""

    @property
    def share(self) -> float:
        """The share that is taken: above 1 where the limit is broken."""
        return self.value / self.limit if self.limit else inf if self.value > 0.0 else 0.0

    @property
    def is_kept(self) -> bool:
        """Whether the limit is satisfied, up to rounding: one that is reached is kept."""
        return is_kept(self.value, self.limit)

    def __str__(self) -> str:
        value, limit = self.value_text or f"{self.value:.6g}", self.text or f"{self.limit:.6g}"
        where = f"{self.where}: " if self.where else ""
        return sentence("{}{}, {} of {}", where, quantity_name(self.name), value, limit)


def read_limits(entries: Mapping[str, Any], axis: str, where: str, load: Load = None) -> Limits:
    """The least and greatest value of each limited quantity in SI units, from the entries that have limits.

    A velocity that is at least 0 never turns back: it is above 0 along the motion, whichever way that goes.

    >>> read_limits({"acceleration": ("-8 m/s^2", "12 m/s^2"), "snap": "9 m/s^4"}, "length", "limits")
    {<Kind.ACCELERATION: 2>: (-8.0, 12.0), <Kind.SNAP: 4>: (-9.0, 9.0)}

    Raises
    ------
    InputError
        If a quantity is wrong, the same is limited twice, or there is no such load.
    """
    limits: Limits = {}
    for name, value in entries.items():
        kind, place, output = (LIMITS | OF_WHOLE).get(name), f"{where}: {name}", load_output(name, load)
        if output is not None:
            most = load.limit(value, output.output, f"{where}, {name}")
            limits = {**limits, output: (-most, most)}
        elif name == DECELERATION:
            limits = tightest(
                limits, {Kind.ACCELERATION_ALONG: (-quantity(value, AXES[axis][2], place, above=0.0), inf)}
            )
        elif kind is None:
            continue
        elif kind in limits and name in OF_WHOLE:
            raise InputError(f"{where}: rms force and rms torque are the same: give one of them")
        elif isinstance(value, list | tuple):
            limits = tightest(limits, _both(kind, value, axis, place))
        else:
            most = quantity(value, _dimension(kind, axis), place, above=0.0)
            apart = name == "acceleration" and DECELERATION in entries
            limits = tightest(limits, {Kind.ACCELERATION_ALONG: (-inf, most)} if apart else {kind: (-most, most)})
    if "energy" in entries and (Kind.RMS_FORCE in limits or MOTOR in entries):
        raise InputError(
            f"{where}: energy and an RMS force or torque, which a motor has as well, are both of the whole cycle: give "
            "one of them"
        )
    return limits


def load_output(name: str, load: Load) -> LoadOutput | None:
    """The output of the load that an objective or a limit names; None if of none."""
    output = name.removeprefix("rms ").removeprefix(LOAD)
    if name not in {f"{LOAD}{output}", f"rms {LOAD}{output}"}:
        return None
    if load is None:
        raise InputError(f"{name} is of a load: give one, such as load={{'period': '20 ms', 'damping': 0.05}}")
    load.machine.place(output)
    return LoadOutput(output, name.startswith("rms "))


def _both(kind: Kind, value: Any, axis: str, place: str) -> Limits:
    low, high = (quantity(side, _dimension(kind, axis), place) for side in value)
    if kind is Kind.VELOCITY and low == 0.0 < high:
        return {kind: (-high, high), Kind.VELOCITY_ALONG: (0.0, inf)}
    if not low < 0.0 < high:
        raise InputError(
            f"{place}: the least must be below 0 and the greatest above 0, such as ('-8 m/s^2', '12 m/s^2'), "
            f"got {shortened(value)}"
        )
    return {kind: (low, high)}


def _dimension(kind: Kind, axis: str) -> str:
    if kind.order:
        return AXES[axis][kind.order]
    known = {Kind.POWER: "power", Kind.ENERGY: "energy"}
    known |= {Kind.RESIDUAL: AXES[axis][2], Kind.RESIDUAL_DISPLACEMENT: axis}
    return known.get(kind, FORCES[axis])


def of_segments(limits: Limits) -> Limits:
    """The limits of each segment, without those of the whole cycle."""
    return {kind: ends for kind, ends in limits.items() if isinstance(kind, Kind) and kind not in OF_WHOLE.values()}


def sides(limits: Limits, direction: float) -> Sides:
    """The limited sides of a motion that goes in a direction."""
    bounds: Sides = {}
    along, both = limits.get(Kind.ACCELERATION_ALONG), (-inf, inf)
    known = {**limits, Kind.ACCELERATION: limits.get(Kind.ACCELERATION, both)} if along else limits
    kinds = (kind for kind in known if isinstance(kind, Kind) and kind not in _NO_SIDES)
    for kind in sorted(kinds, key=lambda kind: kind.value):
        low, high = known[kind]
        if low == -high and not (along and kind is Kind.ACCELERATION):
            bounds[Side(kind)] = high
            continue
        slow, fast = (along or both) if kind is Kind.ACCELERATION else both
        for sign, most in ((-1.0, -low), (1.0, high)):
            most_along = fast if sign == direction else -slow
            name = _name(kind) if most_along == inf else SPEEDING_UP if sign == direction else DECELERATION
            if min(most, most_along) < inf:
                bounds[Side(kind, sign, name)] = min(most, most_along)
    if Kind.VELOCITY_ALONG in limits:
        bounds[Side(Kind.VELOCITY_ALONG, -direction, BACKWARDS)] = 0.0
    return bounds


def tightest(limits: Limits, others: Limits) -> Limits:
    """Limits of both, whichever is less."""
    both = {**limits}
    for kind, (low, high) in others.items():
        least, most = both.get(kind, (-inf, inf))
        both[kind] = (max(least, low), min(most, high))
    return both


def raised(limits: Limits, more: Mapping[str, float], axis: str) -> Limits:
    """Limits times factors of those that have these names."""
    words = {kind: word_of(Side(kind), axis) for kind in limits if isinstance(kind, Kind)}
    slower = {**words, Kind.ACCELERATION_ALONG: DECELERATION}
    return {
        kind: (limits[kind][0] * more.get(slower[kind], 1.0), limits[kind][1] * more.get(word, 1.0))
        for kind, word in words.items()
    }


def along_motion(limits: Mapping[Side, float]) -> bool:
    """Whether a limit is of the direction of the motion, so that laws must not turn back."""
    return any(key.name in _ALONG for key in limits)


def greatest(limits: Mapping[Side, float], kind: Kind, direction: float = 0.0) -> float:
    """The greatest magnitude that a derivative may have in a direction, or with 0 in both; infinite without a limit."""
    known = (most for key, most in limits.items() if key.kind is kind and key.sign in {0.0, direction})
    return min(known, default=inf)


def both_sides(limits: Mapping[Side, float]) -> dict[Kind, tuple[float, float]]:
    """The least and greatest allowed value of each limited quantity, infinite without a limit."""
    kinds = dict.fromkeys(key.kind for key in limits if key.kind is not Kind.VELOCITY_ALONG)
    known: dict[Kind, tuple[float, float]] = {
        kind: (-greatest(limits, kind, -1.0), greatest(limits, kind, 1.0)) for kind in kinds
    }
    for sign in (key.sign for key in limits if key.kind is Kind.VELOCITY_ALONG):
        low, high = known.get(Kind.VELOCITY, (-inf, inf))
        known[Kind.VELOCITY] = (0.0, high) if sign < 0.0 else (low, 0.0)
    return known


def _name(kind: Kind) -> str:
    return next(name for name, each in LIMITS.items() if each is kind)


def name_of(key: Side, axis: str) -> str:
    """The name of a limited quantity."""
    if key.sign:
        beyond = {-1.0: "lowest ", 1.0: "highest "}
        return f"{'' if key.name in _ALONG else beyond[key.sign]}{key.name}"
    if key.kind is Kind.CURVE:
        return "share of the motor's curve"
    return FORCES[axis] if key.kind is Kind.FORCE else _name(key.kind)


def word_of(key: Side, axis: str) -> str:
    """The key under which a limit was given."""
    given = {
        Kind.CURVE: MOTOR,
        Kind.RMS_FORCE: f"rms {FORCES[axis]}",
        Kind.ENERGY: "energy",
        Kind.VELOCITY_ALONG: "velocity",
        Kind.ACCELERATION_ALONG: "acceleration",
    }
    if key.sign:
        return "acceleration" if key.name == SPEEDING_UP else given.get(key.kind, key.name)
    return given[key.kind] if key.kind in given else name_of(key, axis)


def in_units(key: Side, value: float, axis: str) -> str:
    """A limit as text, in the unit that machines have it in."""
    return sentence("the {} {}", name_of(key, axis), amount(key, value, axis))


def amount(key: Side, value: float, axis: str) -> Amount:
    """The value of a limit with its unit; of the least value of a derivative with its sign.

    >>> amount(Side(Kind.ACCELERATION, -1.0, "acceleration"), 8.0, "length"), amount(Side(Kind.POWER), 500.0, "length")
    ('-8 m/s^2', '500 W')
    """
    signed = value * key.sign if key.sign and key.name not in _ALONG else value
    if key.kind.order == 1:
        return in_small_units(signed, axis, "/s")
    if key.kind in {Kind.POWER, Kind.CURVE}:
        return Amount(signed, "W" if key.kind is Kind.POWER else "")
    return Amount(signed, f"{unit_of(axis)}/s^{key.kind.order}" if key.kind.order else FORCE_UNITS[axis])
