"""Limits of a cycle and of its segments: magnitudes, both sides apart, and slowing down apart from speeding up."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import Any, NamedTuple

from optlaws.cycles.specification.programme import AXES, TimedSegment
from optlaws.cycles.specification.segments import Free, Move
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import in_small_units, positive_quantity, quantity
from optlaws.numerics.peaks import is_kept
from optlaws.sentences import Amount, sentence

FORCE, POWER, CURVE = -1, -3, -6
LIMITS = {"velocity": 1, "acceleration": 2, "jerk": 3, "snap": 4, "force": FORCE, "torque": FORCE, "power": POWER}
#: limits of the whole cycle alone
MEANS = ("rms force", "rms torque")
FORCES = {"length": "force", "angle": "torque"}
DECELERATION, SPEEDING_UP = "deceleration", "acceleration along the motion"
_ALONG = (DECELERATION, SPEEDING_UP)
_TWO_SIDED = (1, 2, 3)  # orders whose least and greatest value may be given apart


class OneSided(NamedTuple):
    """One side of a derivative: `sign` times the derivative of order `nu` has a limit, under its given name.

    Along the motion its sign is that of a rise until the segment is known.
    """

    nu: int
    sign: float
    name: str

    def in_direction(self, direction: float) -> OneSided:
        """The side of a motion that goes in a direction."""
        return self._replace(sign=self.sign * direction) if self.name in _ALONG else self


#: what has a limit: the magnitude of a derivative, of force or power, or one side of a derivative
LimitKey = int | OneSided
Limits = dict[LimitKey, float]


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
        return self.value / self.limit

    @property
    def is_kept(self) -> bool:
        """Whether the limit is satisfied, up to rounding: one that is reached is kept."""
        return is_kept(self.value, self.limit)

    def __str__(self) -> str:
        value, limit = self.value_text or f"{self.value:.6g}", self.text or f"{self.limit:.6g}"
        return sentence("{}{}, {} of {}", f"{self.where}: " if self.where else "", self.name, value, limit)


def read_limits(entries: Mapping[str, Any], axis: str, where: str) -> Limits:
    """Limits in SI units by the limited quantity.

    >>> read_limits({"acceleration": ("-8 m/s^2", "12 m/s^2"), "velocity": "2 m/s"}, "length", "limits")
    {OneSided(nu=2, sign=-1.0, name='acceleration'): 8.0, OneSided(nu=2, sign=1.0, name='acceleration'): 12.0, 1: 2.0}
    """
    limits: Limits = {}
    apart = DECELERATION in entries
    for name, value in entries.items():
        place = f"{where}: {name}"
        if name == DECELERATION:
            limits[OneSided(2, -1.0, name)] = positive_quantity(value, AXES[axis][2], place)
        elif name in LIMITS and isinstance(value, list | tuple):
            limits |= _both(name, value, axis, place)
        elif name == "acceleration" and apart:
            limits[OneSided(2, 1.0, SPEEDING_UP)] = positive_quantity(value, AXES[axis][2], place)
        elif name in LIMITS:
            limits[LIMITS[name]] = positive_quantity(value, _dimension(LIMITS[name], axis), place)
    return limits


def _both(name: str, value: Any, axis: str, place: str) -> Limits:
    """The least and the greatest value of a derivative."""
    nu = LIMITS[name]
    low, high = (quantity(side, _dimension(nu, axis), place) for side in value)
    if not low < 0.0 < high:
        raise InputError(
            f"{place}: the least must be below 0 and the greatest above 0, such as ('-8 m/s^2', '12 m/s^2'), "
            f"got {shortened(value)}"
        )
    return {nu: high} if high == -low else {OneSided(nu, -1.0, name): -low, OneSided(nu, 1.0, name): high}


def _dimension(nu: int, axis: str) -> str:
    return AXES[axis][nu] if nu > 0 else {FORCE: FORCES[axis], POWER: "power"}[nu]


def limits_of_segment(stretch: TimedSegment, of_cycle: Mapping[LimitKey, float], axis: str) -> Limits:
    """Limits of a segment: the segment's own limits and the cycle's limits, whichever are lower.

    Raises
    ------
    InputError
        If slowing down has a limit where the motion may turn back.
    """
    entries = stretch.given.limits if isinstance(stretch.given, Move | Free) else {}
    given = read_limits(entries, axis, f"{stretch.where}: limits")
    limits: dict[tuple[int, float], tuple[float, LimitKey]] = {}
    for key, most in (*of_cycle.items(), *given.items()):
        here = key if isinstance(key, int) else key.in_direction(_direction(stretch, key))
        place = (here, 0.0) if isinstance(here, int) else (here.nu, here.sign)
        limits[place] = min(limits.get(place, (inf, here)), (most, here), key=lambda limit: limit[0])
    least = {limits[place][1]: limits[place][0] for place in sorted(limits)}
    for nu in _TWO_SIDED:
        _part(least, nu)
    return least


def _part(limits: Limits, nu: int) -> None:
    """Copy the limit of a derivative's magnitude to both sides, where a side has a limit of its own."""
    sides = {key.sign: key for key in limits if isinstance(key, OneSided) and key.nu == nu}
    most = limits.get(nu, inf)
    if not sides or most == inf:
        return
    del limits[nu]
    for sign in (-1.0, 1.0):
        key = sides.get(sign, OneSided(nu, sign, name_of(nu, "length")))
        limits[key] = min(limits.get(key, inf), most)


def _direction(stretch: TimedSegment, key: OneSided) -> float:
    if isinstance(stretch.given, Free) and key.name in _ALONG:
        raise InputError(
            f"{stretch.where} may turn back, where speeding up and slowing down are of no one direction: give its "
            "acceleration as the least and the greatest, such as ('-8 m/s^2', '12 m/s^2'), in place of a deceleration"
        )
    return -1.0 if stretch.displacement < 0.0 else 1.0


def tightest(limits: Mapping[LimitKey, float], others: Mapping[LimitKey, float]) -> Limits:
    """Limits of both, whichever is less.

    >>> tightest({1: 2.0, 2: 9.0}, {1: 3.0, FORCE: 5.0})
    {1: 2.0, 2: 9.0, -1: 5.0}
    """
    return {key: min(limits.get(key, inf), others.get(key, inf)) for key in dict.fromkeys([*limits, *others])}


def along_motion(limits: Mapping[LimitKey, float]) -> bool:
    """Whether slowing down has a limit of its own, so that laws must not turn back."""
    return any(isinstance(key, OneSided) and key.name in _ALONG for key in limits)


def greatest(limits: Mapping[LimitKey, float], nu: int, direction: float = 0.0) -> float:
    """The greatest magnitude that a derivative may have in a direction, or with 0 in both; infinite without a limit.

    >>> greatest({1: 2.0, OneSided(1, -1.0, "velocity"): 1.5}, 1, -1.0)
    1.5
    """
    sides = [
        most for key, most in limits.items() if isinstance(key, OneSided) and (key.nu, key.sign) == (nu, direction)
    ]
    return min([limits.get(nu, inf), *sides])


def both_sides(limits: Mapping[LimitKey, float]) -> dict[int, tuple[float, float]]:
    """The least and greatest allowed value of each limited quantity, infinite without a limit.

    >>> both_sides({2: 9.0, OneSided(2, -1.0, "acceleration"): 8.0})
    {2: (-8.0, 9.0)}
    """
    orders = dict.fromkeys(key if isinstance(key, int) else key.nu for key in limits)
    return {nu: (-greatest(limits, nu, -1.0), greatest(limits, nu, 1.0)) for nu in orders}


def name_of(key: LimitKey, axis: str) -> str:
    """The name of a limited quantity.

    >>> name_of(3, "length"), name_of(OneSided(2, -1.0, DECELERATION), "length"), name_of(FORCE, "angle")
    ('jerk', 'deceleration', 'torque')
    """
    if isinstance(key, OneSided):
        sides = {} if key.name in _ALONG else {-1.0: "lowest ", 1.0: "highest "}
        return f"{sides.get(key.sign, '')}{key.name}"
    if key in {FORCE, CURVE}:
        return FORCES[axis] if key == FORCE else "share of the motor's curve"
    return next(name for name, order in LIMITS.items() if order == key)


def word_of(key: LimitKey, axis: str) -> str:
    """The key under which a limit was given.

    >>> word_of(OneSided(2, 1.0, SPEEDING_UP), "length"), word_of(FORCE, "angle")
    ('acceleration', 'torque')
    """
    if isinstance(key, OneSided):
        return "acceleration" if key.name == SPEEDING_UP else key.name
    return "motor" if key == CURVE else name_of(key, axis)


def in_units(key: LimitKey, value: float, axis: str) -> str:
    """A limit as text, in the unit that machines have it in.

    >>> in_units(1, 0.616, "length"), in_units(FORCE, 120.0, "length"), in_units(3, 900.0, "angle")
    ('the velocity 616 mm/s', 'the force 120 N', 'the jerk 900 rad/s^3')
    """
    return sentence("the {} {}", name_of(key, axis), amount(key, value, axis))


def amount(key: LimitKey, value: float, axis: str) -> Amount:
    """The value of a limit with its unit; of the least value of a derivative with its sign.

    >>> amount(OneSided(2, -1.0, "acceleration"), 8.0, "length"), amount(-3, 500.0, "length")
    ('-8 m/s^2', '500 W')
    """
    nu = key if isinstance(key, int) else key.nu
    signed = value * key.sign if isinstance(key, OneSided) and key.name not in _ALONG else value
    if nu == 1:
        return in_small_units(signed, axis, "/s")
    if nu in {POWER, CURVE}:
        return Amount(signed, "W" if nu == POWER else "")
    return Amount(signed, ("N" if axis == "length" else "N m") if nu == FORCE else f"{unit_of(axis)}/s^{nu}")
