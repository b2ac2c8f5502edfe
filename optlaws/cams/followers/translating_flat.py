"""A flat face on a slide, square to its way."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import ClassVar

from optlaws.cams.followers.contact import CURVATURE, ContactState, Drag, LinearLimit, Transmission, bearing
from optlaws.cams.followers.follower import CamFollower, Place
from optlaws.cams.followers.rollers_and_faces import FaceContact
from optlaws.motion.piece import Piece
from optlaws.numerics.taylor import Jet, Pair


@dataclass(frozen=True)
class TranslatingFlat(CamFollower, kind="translating flat"):
    """A follower that slides and has a flat face square to its way.

    Examples
    --------
    >>> TranslatingFlat().axis
    'length'
    """

    axis: ClassVar[str] = "length"
    examples: ClassVar[dict[str, str]] = {}
    sizing_limit: ClassVar[str | None] = CURVATURE

    def contact(self, place: Place) -> FaceContact:
        return SlidingFace(place.turning, place.lowest, place.radius)

    def base_radius(self, level: float) -> float:
        """The height of the face."""
        return level


@dataclass(frozen=True)
class SlidingFace(FaceContact):
    """A sliding face in numbers: at y = height + s, touched at x = s', so that rho = height + s + s''."""

    def point(self, s: Jet) -> Pair:
        return s.slope() * self.turning, s + (self.level - self.lowest)

    def normal(self, s: Jet) -> Pair:
        return s * 0.0, s * 0.0 + 1.0

    def pressure(self, s: Jet) -> Jet:
        """Zero, as the contact force of a face square to its way has no component across it."""
        return s.slope() * 0.0

    def radius(self, s: Jet) -> Jet:
        return s.slope().slope() + s + (self.level - self.lowest)

    def reach(self, s: Jet) -> Jet:
        """The distance from the way of the slide, to the side to which the cam turns away from it."""
        return s.slope() * self.turning

    def state(self, point: Pair, normal: Pair) -> ContactState:
        height = point[0] * normal[0] + point[1] * normal[1]
        return ContactState(height + (self.lowest - self.level), height * 0.0 + 0.5 * pi, bearing(*normal))

    def transmission(self, s: Jet) -> Transmission:
        aside, height = self.point(s)
        none = height * 0.0
        return Transmission(none + 1.0, height.magnitude(), none, aside, Drag(none, -self.turning))

    def radius_limits(self, piece: Piece, limit: float, angle: float) -> list[LinearLimit]:
        stroke, size = piece.stroke, abs(piece.stroke)
        high = (self.level - self.lowest + piece.offset - limit) / size
        return [LinearLimit((-stroke / size, 0.0, -stroke / (size * angle**2)), high)]
