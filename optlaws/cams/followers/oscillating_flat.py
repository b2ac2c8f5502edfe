"""A flat face on an arm that swings about a pivot."""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, degrees, pi, sin
from typing import ClassVar

from optlaws.cams.followers.contact import ContactState, Drag, Transmission, bearing, other_leg
from optlaws.cams.followers.follower import Place, positive, shown
from optlaws.cams.followers.rollers_and_faces import FaceContact, FlatFollower, sign
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.motion.quantities import quantity
from optlaws.numbers import Quantity
from optlaws.numerics.taylor import Jet, Pair


@declared
class OscillatingFlat(FlatFollower, kind="oscillating flat"):
    """A follower that swings and has a flat face.

    Examples
    --------
    >>> OscillatingFlat(pivot_distance="120 mm", face_offset="8 mm").axis
    'angle'
    """

    pivot_distance: Quantity = entry(
        Measured("length", above=0.0), "From the cam's centre to the pivot.", example="120 mm"
    )
    face_offset: Quantity = entry(
        Measured("length"),
        "From the pivot to the line of the face; above 0 where the face lies away from the cam.",
        default="0 mm",
    )
    axis: ClassVar[str] = "angle"
    lengths: ClassVar[tuple[str, ...]] = ("pivot_distance",)

    def face(self, place: Place) -> FaceContact:
        distance = positive(self.pivot_distance, "face: pivot_distance")
        offset = quantity(self.face_offset, "length", "face: face_offset")
        if abs(place.radius - offset) >= distance:
            raise InputError(
                f"face: a pivot {shown(distance)} away is too near for a prime circle of radius {shown(place.radius)}"
                f" and a face_offset of {shown(offset)}: put it farther than {shown(abs(place.radius - offset))}"
            )
        first = asin((place.radius - offset) / distance)
        last = first + place.highest - place.lowest
        if last >= 0.5 * pi:
            raise InputError(
                f"face: it swings from {degrees(first):.6g} to {degrees(last):.6g} deg from the line to the cam's"
                " centre, and touches nothing from 90 deg on: make the swing smaller or pivot_distance greater"
            )
        swiftest = -min(place.turning * slope for slope in place.slopes)
        if swiftest >= 1.0:
            raise InputError(
                f"face: it swings {swiftest:.6g} times as fast as the cam turns, in the same sense: the cam cannot"
                " touch it: spread the motion over more of the turn, or swing less"
            )
        return SwingingFace(place.turning, place.lowest, first, distance, offset)

    def prime_radius(self, level: float) -> float:
        """The distance of the face at an angle."""
        offset = quantity(self.face_offset, "length", "face: face_offset")
        return positive(self.pivot_distance, "face: pivot_distance") * sin(level) + offset

    @property
    def pivot(self) -> Quantity:
        """The distance of the pivot from the cam's centre."""
        return self.pivot_distance


@dataclass(frozen=True)
class SwingingFace(FaceContact):
    """A swinging face in numbers: its pivot at x = distance, the face at phi = first + s from the line to the centre.

    It is touched at distance cos(phi)/(1 ± phi') from the foot of the pivot.
    """

    distance: float
    offset: float

    @property
    def pivot(self) -> float:
        return self.distance

    def point(self, s: Jet) -> Pair:
        sine, cosine = self._waves(s)
        reach = self.reach(s)
        return sine * self.offset - reach * cosine + self.distance, reach * sine + cosine * self.offset

    def normal(self, s: Jet) -> Pair:
        return self._waves(s)

    def pressure(self, s: Jet) -> Jet:
        """The tangent of the pressure angle: the point touched moves square to the ray from the pivot."""
        reach = self.reach(s)
        return (reach * 0.0 + self.offset) / reach * self.turning

    def radius(self, s: Jet) -> Jet:
        sine, _ = self._waves(s)
        rate = self._rate(s)
        return (sine * self.distance - self.reach(s).slope() * self.turning) / rate + self.offset

    def reach(self, s: Jet) -> Jet:
        """The distance from the foot of the pivot towards the cam."""
        _, cosine = self._waves(s)
        return cosine * self.distance / self._rate(s)

    def state(self, point: Pair, normal: Pair) -> ContactState:
        sine = (point[0] * normal[0] + point[1] * normal[1] - self.offset) / self.distance
        phi = (sine / other_leg(sine)).arctangent()
        return ContactState(phi + (self.lowest - self.level), phi * -1.0 + 0.5 * pi, bearing(*normal))

    def transmission(self, s: Jet) -> Transmission:
        lever = self.reach(s).magnitude()
        (x, y), (nx, ny) = self.point(s), self.normal(s)
        sliding = (x * nx + y * ny) * self.turning + s.slope() * self.offset
        none = lever * 0.0
        return Transmission(lever, sliding.magnitude(), none, none, Drag(sign(sliding) * -self.offset))

    def _waves(self, s: Jet) -> Pair:
        return (s + (self.level - self.lowest)).waves()

    def _rate(self, s: Jet) -> Jet:
        return s.slope() * self.turning + 1.0
