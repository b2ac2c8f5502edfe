"""Flat faces on slides and on arms: envelopes and their curvature, sliding, and the limits of laws over them."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field, replace
from math import asin, atan, cos, degrees, pi, sin, tan
from typing import ClassVar

import numpy as np

from optlaws.cams.curves.extremes import (
    CamExtremes,
    EnclosedExtreme,
    FollowerSize,
    Undercut,
    enclosed_extremes,
    widened,
)
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cams.followers.contact import (
    CURVATURE,
    ContactState,
    Drag,
    FollowerContact,
    LinearLimit,
    Transmission,
    bearing,
    other_leg,
)
from optlaws.cams.followers.follower import CamFollower, Place, positive, shown
from optlaws.echo import shortened
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array, NumberOrQuantity
from optlaws.numerics.interval import Interval
from optlaws.numerics.peaks import is_kept
from optlaws.numerics.taylor import Jet, Pair, Term
from optlaws.tolerances import CAM_FEASIBILITY


@declared
class FlatFollower(CamFollower, title="a flat follower"):
    """A follower with a flat face."""

    face_length: NumberOrQuantity | None = entry(
        Measured("length", above=0.0),
        "Of the face: at least the travel of the contact along it, which is reported beside it.",
        default=None,
        kw_only=True,
        example="60 mm",
    )

    @abstractmethod
    def face(self, place: Place) -> FaceContact:
        """How its face touches a cam, however long it is."""

    def contact(self, place: Place) -> FaceContact:
        given = self.face_length
        length = None if given is None else quantity(given, "length", "face: face_length")
        return replace(self.face(place), length=length)


@dataclass(frozen=True)
class FaceContact(FollowerContact):
    """A flat face, of which the cam's profile is the envelope; its length in m where it is known."""

    length: float | None = field(default=None, kw_only=True)
    lost: ClassVar[int] = 1

    @abstractmethod
    def radius(self, s: Jet) -> Jet:
        """Radius of curvature of the profile; there is no undercut where it is above 0."""

    def profile_curvature(self, s: Jet) -> Jet:
        """Curvature of the profile, the reciprocal of its radius of curvature."""
        return 1.0 / self.radius(s)

    def radius_of_curvature(self, s: Jet) -> Term:
        return self.radius(s).terms[0]

    def curvature_excess(self, s: Jet, limit: float) -> Interval:
        excess: Interval = -self.radius(s).terms[0] + limit
        return excess

    def least_convex_radius(self, motion: CamMotion) -> EnclosedExtreme:
        return enclosed_extremes(motion, self.radius, 2)[0]

    def extremes(self, motion: CamMotion) -> CamExtremes:
        pressure, least = self.pressure_angles(motion), self.least_convex_radius(motion)
        # a face turns with the cam all the way, so that its envelope is convex where its radius is above 0
        undercut = Undercut.of(least, simple=motion.closed)
        return CamExtremes(pressure, least, None, undercut, () if self.length is None else self._along(motion))

    def _along(self, motion: CamMotion) -> tuple[FollowerSize, ...]:
        """The places of the contact along the face, from the foot of the shaft or the pivot, and their length."""
        first, last = enclosed_extremes(motion, self.reach, 1)
        ends = last.low - first.high, last.high - first.low
        needed = widened(*ends, last.angle, max(abs(first.low), abs(last.high)))
        places = {"contact along the face, least": first, "contact along the face, greatest": last}
        return *(FollowerSize(name, place) for name, place in places.items()), FollowerSize(
            "length of face", needed, self.length
        )

    @abstractmethod
    def reach(self, s: Jet) -> Jet:
        """The place along the face where it is touched."""


@dataclass(frozen=True)
class SlidingFace(FaceContact):
    """A face on a slide, square to its way where the angle is 0: at y = height + s on the way, rho = (y + s'') cos."""

    angle: float

    def point(self, s: Jet) -> Pair:
        far, reach = self._far(s), self.reach(s)
        return reach * cos(self.angle) - far * sin(self.angle), reach * sin(self.angle) + far * cos(self.angle)

    def normal(self, s: Jet) -> Pair:
        return s * 0.0 - sin(self.angle), s * 0.0 + cos(self.angle)

    def pressure(self, s: Jet) -> Jet:
        """The tangent of the inclination, the same everywhere."""
        return s.slope() * 0.0 + self.turning * tan(self.angle)

    def radius(self, s: Jet) -> Jet:
        return s.slope().slope() * cos(self.angle) + self._far(s)

    def reach(self, s: Jet) -> Jet:
        """The distance from the foot of the cam's centre, to the side to which the cam turns away from it."""
        return s.slope() * (self.turning * cos(self.angle))

    def _far(self, s: Jet) -> Jet:
        """The distance of the face from the cam's centre."""
        return (s + (self.level - self.lowest)) * cos(self.angle)

    def state(self, point: Pair, normal: Pair) -> ContactState:
        far = point[0] * normal[0] + point[1] * normal[1]
        height = far / cos(self.angle)
        return ContactState(height + (self.lowest - self.level), far * 0.0 + (0.5 * pi + self.angle), bearing(*normal))

    def transmission(self, s: Jet) -> Transmission:
        aside, _ = self.point(s)
        sine, cosine, none = sin(self.angle), cos(self.angle), aside * 0.0
        sliding = self._far(s) + s.slope() * (self.turning * sine)
        # the cam's surface runs past along the face, away from its turning unless it is touched below the shaft
        past = sign(sliding) * -self.turning
        drag = Drag(past * sine, past * cosine, aside * past * sine)
        return Transmission(none + cosine, sliding.magnitude(), none - sine, aside * cosine, drag)

    def radius_limits(self, piece: Piece, limit: float, angle: float) -> list[LinearLimit]:
        stroke, size = piece.stroke, abs(piece.stroke)
        high = (self.level - self.lowest + piece.offset - limit / cos(self.angle)) / size
        return [LinearLimit((-stroke / size, 0.0, -stroke / (size * angle**2)), high)]

    def pressure_limits(self, piece: Piece, limit: float, angle: float, *, below: bool) -> list[LinearLimit]:
        """No limits: either every law keeps a greatest pressure angle, or none does, which is refused."""
        del piece, angle, below
        if not is_kept(abs(tan(self.angle)), limit, CAM_FEASIBILITY):
            raise InputError(
                f"pressure_angle: it is that of the face, {degrees(abs(self.angle)):.6g} deg, whatever the law: give a"
                f" limit above {degrees(atan(limit)):.6g} deg, or a face that is less inclined"
            )
        return []


def sign(jet: Jet) -> Jet:
    """1 or -1; where intervals leave open which, all between."""
    first = jet.terms[0]
    if not isinstance(first, Interval):
        return Jet((np.sign(first), *(np.zeros(np.shape(first)),) * jet.order))
    signs: Array = np.where(first.low > 0.0, 1.0, np.where(first.high < 0.0, -1.0, 0.0))
    jump = Interval(np.zeros(signs.shape), np.where(signs == 0.0, np.inf, 0.0))
    return Jet((Interval(signs, np.where(signs == 0.0, 1.0, 0.0)), *(jump,) * jet.order))


@declared
class TranslatingFlat(FlatFollower, kind="translating flat"):
    """A follower that slides and has a flat face square to its way.

    Examples
    --------
    >>> TranslatingFlat().axis
    'length'
    """

    axis: ClassVar[str] = "length"
    sizing_limit: ClassVar[str | None] = CURVATURE

    def face(self, place: Place) -> FaceContact:
        return SlidingFace(place.turning, place.lowest, place.radius, 0.0, angle=0.0)

    def prime_radius(self, level: float) -> float:
        """The height of the face."""
        return level


@declared
class InclinedFlat(FlatFollower, kind="inclined flat"):
    """A follower that slides and has a flat face which is not square to its way.

    Its cam is that of a square face that moves cos(inclination) as far, turned by the inclination; the pressure angle
    is the inclination at every angle of the cam.

    Examples
    --------
    >>> InclinedFlat(inclination="10 deg").axis
    'length'
    """

    inclination: NumberOrQuantity = entry(
        Measured("angle"),
        "Between the face and the perpendicular to the slide, above 0 where the face rises to the side to which the "
        "top of a cam moves that turns clockwise; less than 90 deg.",
        example="10 deg",
    )
    axis: ClassVar[str] = "length"
    sizing_limit: ClassVar[str | None] = CURVATURE

    @property
    def angle(self) -> float:
        """The inclination in rad."""
        angle = quantity(self.inclination, "angle", "face: inclination")
        if abs(angle) >= 0.5 * pi:
            raise InputError(
                f"face: inclination must be between -90 and 90 deg, got {shortened(self.inclination)}: beyond these no"
                " cam lifts the face"
            )
        return angle

    def face(self, place: Place) -> FaceContact:
        return SlidingFace(place.turning, place.lowest, place.radius / cos(self.angle), 0.0, self.angle)

    def prime_radius(self, level: float) -> float:
        """The distance of a face that meets the slide's way at a height."""
        return level * cos(self.angle)


@declared
class OscillatingFlat(FlatFollower, kind="oscillating flat"):
    """A follower that swings and has a flat face.

    Examples
    --------
    >>> OscillatingFlat(pivot_distance="120 mm", face_offset="8 mm").axis
    'angle'
    """

    pivot_distance: NumberOrQuantity = entry(
        Measured("length", above=0.0), "From the cam's centre to the pivot.", example="120 mm"
    )
    face_offset: NumberOrQuantity = entry(
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
        return SwingingFace(place.turning, place.lowest, first, 0.0, distance, offset)

    def prime_radius(self, level: float) -> float:
        """The distance of the face at an angle."""
        offset = quantity(self.face_offset, "length", "face: face_offset")
        return positive(self.pivot_distance, "face: pivot_distance") * sin(level) + offset


@dataclass(frozen=True)
class SwingingFace(FaceContact):
    """A swinging face in numbers: its pivot at x = distance, the face at phi = first + s from the line to the centre.

    It is touched at distance cos(phi)/(1 ± phi') from the foot of the pivot.
    """

    distance: float
    offset: float

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
