"""A flat face on a slide, inclined to the square of its way."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, cos, degrees, pi, sin, tan
from typing import ClassVar

from optlaws.cams.followers.contact import CURVATURE, ContactState, Drag, LinearLimit, Transmission, bearing
from optlaws.cams.followers.follower import CamFollower, Place
from optlaws.cams.followers.rollers_and_faces import FaceContact, sign
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import quantity
from optlaws.numbers import Quantity
from optlaws.numerics.taylor import Jet, Pair


@dataclass(frozen=True)
class InclinedFlat(CamFollower, kind="inclined flat"):
    """A follower that slides and has a flat face which is not square to its way.

    Its cam is that of a square face that moves cos(inclination) as far, turned by the inclination; the pressure angle
    is the inclination at every angle of the cam.

    Parameters
    ----------
    inclination
        Between the face and the square of the way, above 0 where the face rises to the side to which the cam's top
        moves when it turns clockwise; less than 90 deg.

    Examples
    --------
    >>> InclinedFlat(inclination="10 deg").axis
    'length'
    """

    inclination: Quantity
    axis: ClassVar[str] = "length"
    examples: ClassVar[dict[str, str]] = {"inclination": "10 deg"}
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

    def contact(self, place: Place) -> FaceContact:
        return InclinedFace(place.turning, place.lowest, place.radius / cos(self.angle), self.angle)

    def base_radius(self, level: float) -> float:
        """The distance of a face that meets the slide's way at a height."""
        return level * cos(self.angle)


@dataclass(frozen=True)
class InclinedFace(FaceContact):
    """An inclined face in numbers: it meets the slide's way at y = height + s, so that rho = (height + s + s'') cos."""

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
        """How far the face is from the cam's centre."""
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
        """No limits: a greatest pressure angle is kept by every law, or by no law, which is refused."""
        del piece, angle, below
        if abs(tan(self.angle)) > limit:
            raise InputError(
                f"pressure_angle: it is that of the face, {degrees(abs(self.angle)):.6g} deg, whatever the law: give a"
                f" limit above {degrees(atan(limit)):.6g} deg, or a face that is less inclined"
            )
        return []
