"""The cam of a mechanism of the kind "cam", whose follower's motion is given by segments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY
from typing import Any, get_args

from optlaws.cams.at_shaft import cam_mechanism
from optlaws.cams.disc import DiscCam, Turning
from optlaws.cams.followers.follower import CamFollower, stated_prime_radius
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.segments import SEGMENTS
from optlaws.entries.declared import ValueOf, declared, entry
from optlaws.entries.value_types import Choice, InSI, Measured, ReadBy, SINumber, Span
from optlaws.errors import InputError
from optlaws.mechanisms.linkages.bodies import NO_LOADS, Loads
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.mechanisms.linkages.mechanism_kinds import MechanismKind, OptionalEnds
from optlaws.motion.quantities import quantity
from optlaws.numbers import NumberOrQuantity, Quantity

_BY_TIME = ("velocity", "start_velocity", "end_velocity")


def _motion(segments: Any) -> Cycle:
    """The follower's motion over a turn of its cam, of segments whose durations are angles."""
    given = SEGMENTS.read(segments, "segment")
    for number, segment in enumerate(given, 1):
        durations = segment.duration if isinstance(segment.duration, tuple) else (segment.duration,)
        for duration in durations:
            if duration is not None:
                quantity(duration, "angle", f"segment {number}: duration over a turn of the cam")
        if any(getattr(segment, name, None) is not None for name in _BY_TIME):
            raise InputError(f"segment {number}: a cam's motion is over its angle: it takes no velocity by the time")
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
    prime_radius: Quantity = entry(Measured("length", above=0.0), "Of the prime circle.", example="60 mm")
    follower: CamFollower = entry(
        ValueOf(CamFollower), "The follower.", example={"kind": "translating roller", "radius": "12 mm"}
    )
    segment: Any = entry(
        ReadBy(_motion, "a list of segments whose durations are angles"),
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
    inertia: SINumber = entry(
        InSI("moment of inertia", least=0.0), "Of the cam and its shaft.", default=0.0, example="0.01 kg m^2"
    )
    loads: Loads = entry(
        ValueOf(Loads), "What acts on the follower, over its displacement from the prime circle.", default=NO_LOADS
    )
    over: OptionalEnds = entry(
        Span(InSI("angle")),
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
