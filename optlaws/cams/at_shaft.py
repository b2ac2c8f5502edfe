"""A cam and its follower as a mechanism of the cam's shaft: the follower's mass and load over the cam's angle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY
from itertools import pairwise
from math import degrees
from typing import Any, get_args

import numpy as np

from optlaws.cams.disc import DiscCam, Turning
from optlaws.cams.followers.follower import CamFollower, stated_prime_radius
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.segments import SEGMENTS
from optlaws.entries.declared import ValueOf, declared, documented_by, entry
from optlaws.entries.value_types import Choice, InSI, Measured, ReadBy, SINumber, Span
from optlaws.errors import InputError
from optlaws.formulas.slopes import added, derivative, multiplied
from optlaws.formulas.tree import Exponentiation, Formula, Name, Number, Table, number
from optlaws.mechanisms.linkages.mechanism import LinkGeometry, Mechanism
from optlaws.mechanisms.linkages.mechanism_kinds import (
    NO_LOADS,
    DrivenLink,
    Loads,
    MechanismKind,
    OptionalEnds,
    reduced_inertia,
)
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array, NumberOrQuantity
from optlaws.numerics import chebyshev
from optlaws.tolerances import CLOSURE

_WEIGHTS = {"length": "mass", "angle": "moment of inertia"}
_MOST_PLACES = 396
_MOST_IN_STRETCH = 96
_INERTIA, _OVER = InSI("moment of inertia", least=0.0), Span(InSI("angle"))
_BY_TIME = ("velocity", "start_velocity", "end_velocity")


def _motion(segments: Any) -> Cycle:
    """The follower's motion over a turn of its cam, of segments whose durations are angles."""
    given = SEGMENTS.read(segments, "segment")
    for place, segment in enumerate(given, 1):
        durations = segment.duration if isinstance(segment.duration, tuple) else (segment.duration,)
        for duration in durations:
            if duration is not None:
                quantity(duration, "angle", f"segment {place}: duration over a turn of the cam")
        if any(getattr(segment, name, None) is not None for name in _BY_TIME):
            raise InputError(f"segment {place}: a cam's motion is over its angle: it takes no velocity by the time")
    return Cycle(given, period="1 s")


@declared
class CamAtShaft(MechanismKind, kind="cam"):
    """The mechanism of a cam and its follower, whose motion over the cam's angle consists of segments.

    Examples
    --------
    >>> segments = [{"kind": "rise", "by": "40 mm", "duration": "120 deg"}, {"kind": "return", "duration": "240 deg"}]
    >>> follower = {"kind": "translating roller", "radius": "12 mm"}
    >>> entries = {"kind": "cam", "prime_radius": "60 mm", "follower": follower, "segment": segments, "moved": "2 kg"}
    >>> CamAtShaft.from_dict(entries).cam.base_radius
    0.048
    """

    turns_steadily = True

    _: KW_ONLY
    prime_radius: NumberOrQuantity = entry(Measured("length", above=0.0), "Of the prime circle.", example="60 mm")
    follower: CamFollower = entry(
        ValueOf(CamFollower), "The follower.", example={"kind": "translating roller", "radius": "12 mm"}
    )
    segment: Any = entry(
        ReadBy(_motion, "a list of segments whose durations are angles", lambda cycle: SEGMENTS.plain(cycle.segments)),
        "The motion of the follower over a turn of the cam.",
        example=[{"kind": "rise", "by": "30 mm", "duration": "120 deg"}, {"kind": "return"}],
    )
    moved: NumberOrQuantity = entry(
        Measured("mass", "moment of inertia", bare=True, least=0.0),
        "What the follower moves: a mass, or of one that swings a moment of inertia about its pivot.",
        example="2 kg",
    )
    turning: Turning = entry(
        Choice(*get_args(Turning)), "The sense in which the cam turns.", default="counterclockwise"
    )
    inertia: SINumber = entry(_INERTIA, "Of the cam and its shaft.", default=0.0, example="0.01 kg m^2")
    loads: Loads = entry(
        ValueOf(Loads), "What acts on the follower, over its displacement from the prime circle.", default=NO_LOADS
    )
    over: OptionalEnds = entry(
        _OVER,
        "The range of x, the cam's angle; that of its motion unless given.",
        default=None,
        example=["0 deg", "120 deg"],
    )

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        if "base_radius" not in data or not isinstance(data.get("follower"), Mapping):
            return data
        former, follower = data.pop("base_radius"), CamFollower.from_dict(data["follower"])
        return {**data, "prime_radius": stated_prime_radius(data.get("prime_radius"), former, follower)}

    @property
    def cam(self) -> DiscCam:
        """The cam with its follower."""
        return DiscCam(self.segment, self.prime_radius, self.follower, turning=self.turning)

    @property
    def mechanism(self) -> Mechanism:
        shaft = cam_mechanism(self.cam, self.moved, inertia=self.inertia, loads=self.loads, over=self.over)
        friction = {"coulomb": self.coulomb, "viscous": self.viscous}
        return shaft.with_friction(**friction) if any(friction.values()) else shaft


@documented_by(CamAtShaft)
def cam_mechanism(
    cam: DiscCam,
    moved: NumberOrQuantity,
    *,
    inertia: NumberOrQuantity = 0.0,
    loads: Loads = NO_LOADS,
    over: tuple[NumberOrQuantity, NumberOrQuantity] | None = None,
) -> Mechanism:
    """The mechanism of a disc cam and its follower, without friction between them; x is the cam's angle.

    Over a range in which the motion has no break it is exact to rounding. Over breaks it is laid through splines, which
    for motions with bounded jerk are off by some millionths of the greatest torque.

    Parameters
    ----------
    cam
        The cam.
    loads
        What acts on the follower, over its displacement from the prime circle; a preload of 60 N is a force of "-60 N".

    Raises
    ------
    InputError
        If the range is not within the cam's motion, or gravity is given, which a cam's plane does not say.

    Examples
    --------
    >>> from optlaws import CamMotion, TranslatingRoller
    >>> cam = DiscCam(CamMotion.of_law("3-4-5", "40 mm", "120 deg"), "80 mm", TranslatingRoller("12 mm"))
    >>> shaft = cam_mechanism(cam, "2 kg", loads=Loads("-60 N", stiffness="3 N/mm"))
    >>> round(shaft.inertia("60 deg"), 9), round(shaft.load("60 deg"), 6)
    (0.002564692, 4.297183)
    """
    motion = cam.displacement
    first, last = motion.interval if over is None else _within(_OVER.read(over, "over"), motion.interval)
    if loads.gravity is not None:
        raise InputError(
            "loads: a cam has no plane for gravity: give the follower's weight as a force, such as '-20 N'"
        )
    weight, turning = InSI(_WEIGHTS[motion.axis], least=0.0).read(moved, "moved"), _INERTIA.read(inertia, "inertia")
    inner = [place for place in motion.breaks if first < place < last]
    position, velocity = _through_breaks(cam, [first, *inner, last]) if inner else _smooth(cam, first, last)
    follower = DrivenLink("follower", position, velocity, motion.axis)
    return Mechanism(
        added([number(turning), reduced_inertia(weight, velocity)]),
        added(loads.on(follower, "angle")),
        over=(first, last),
        axis="angle",
        name="cam",
        linkage=LinkGeometry((("follower", position),)),
    )


def _within(over: tuple[float, float], interval: tuple[float, float]) -> tuple[float, float]:
    """A range that must be within a motion's."""
    (low, high), slack = over, CLOSURE * (interval[1] - interval[0])
    if not interval[0] - slack <= low < high <= interval[1] + slack:
        raise InputError(
            f"over must be within the cam's motion, {degrees(interval[0]):.6g} to {degrees(interval[1]):.6g} deg, got "
            f"{degrees(low):.6g} to {degrees(high):.6g} deg"
        )
    return max(low, interval[0]), min(high, interval[1])


def _smooth(cam: DiscCam, first: float, last: float) -> tuple[Formula, Formula]:
    """Displacement and velocity as polynomials of the angle, where the motion has no break."""
    middle, half = 0.5 * (first + last), 0.5 * (last - first)

    def displacement(place: Array) -> Array:
        return np.asarray(cam.displacement(middle + half * np.clip(place, -1.0 + CLOSURE, 1.0 - CLOSURE)))

    series = chebyshev.interpolated(displacement, "displacement of the cam's follower")
    powers = np.polynomial.chebyshev.cheb2poly(series)
    place = multiplied([number(1.0 / half), added([Name("x"), number(-middle)])])
    terms = [number(float(powers[0]))]
    for i, value in enumerate(powers[1:].tolist(), 1):
        power = place if i == 1 else Exponentiation(place, Number(float(i)))
        terms.append(multiplied([number(value), power]))
    position = added(terms)
    return position, derivative(position, "x")


def _through_breaks(cam: DiscCam, breaks: list[float]) -> tuple[Formula, Formula]:
    """Displacement and velocity as splines whose knots are denser near breaks of the motion."""
    count = min(_MOST_IN_STRETCH, _MOST_PLACES // (len(breaks) - 1))
    if count < 4:
        raise InputError(f"the cam's motion has {len(breaks) - 2} breaks in this range: take a shorter one in over=")
    shares = 0.5 - 0.5 * np.cos(np.pi * np.arange(count) / count)
    parts = [low + (high - low) * shares for low, high in pairwise(breaks)]
    places = np.concatenate([*parts, [breaks[-1]]])
    x, known = Name("x"), tuple(places.tolist())
    values = [np.asarray(cam.displacement.jet(cam.displacement.within(places), 1).derivative(nu)) for nu in (0, 1)]
    position, velocity = (Table(x, known, tuple(some.tolist()), "spline") for some in values)
    return position, velocity
