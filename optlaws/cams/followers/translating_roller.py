"""A roller on a slide, whose way may pass the cam's centre at an offset."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import hypot, sqrt
from typing import ClassVar

from optlaws.cams.followers.contact import PRESSURE, ContactState, CurvatureTerms, LinearLimit, Transmission
from optlaws.cams.followers.follower import CamFollower, Place, roller_radius, shown
from optlaws.cams.followers.rollers_and_faces import RollerContact
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import quantity
from optlaws.numbers import Quantity
from optlaws.numerics.taylor import Jet, Pair


@declared
class TranslatingRoller(CamFollower, kind="translating roller"):
    """A follower that slides and has a roller.

    Examples
    --------
    >>> TranslatingRoller("12 mm", offset="10 mm").axis
    'length'
    """

    radius: Quantity = entry(Measured("length", above=0.0), "Radius of the roller.", example="12 mm")
    offset: Quantity = entry(
        Measured("length"),
        "Distance of the slide's way from the cam's centre; above 0 on the side to which the cam's top moves when it "
        "turns clockwise, so that with a cam that turns counterclockwise it lessens the pressure angle of the rise.",
        default="0 mm",
    )
    axis: ClassVar[str] = "length"
    lengths: ClassVar[tuple[str, ...]] = ("radius", "offset")
    sizing_limit: ClassVar[str | None] = PRESSURE

    def contact(self, place: Place) -> RollerContact:
        radius, offset = roller_radius(self.radius, place), quantity(self.offset, "length", "roller: offset")
        if abs(offset) >= place.radius:
            raise InputError(
                f"roller: offset {shown(offset)} is beyond the prime circle of radius {shown(place.radius)}: the roller"
                " cannot touch it: make the offset less or the prime circle larger"
            )
        return SlidingRoller(
            place.turning,
            place.lowest,
            sqrt((place.radius - abs(offset)) * (place.radius + abs(offset))),
            offset,
            radius,
        )

    def prime_radius(self, level: float) -> float:
        """The way from the cam's centre to the roller's at a height."""
        return hypot(level, quantity(self.offset, "length", "roller: offset"))

    def from_beneath(self) -> TranslatingRoller:
        """The same follower with its offset on the other side."""
        return replace(self, offset=f"{-quantity(self.offset, 'length', 'roller: offset')!r} m")


@dataclass(frozen=True)
class SlidingRoller(RollerContact):
    """A sliding roller in numbers: its centre is at x = offset, y = height + s."""

    offset: float
    radius: float

    @property
    def roller(self) -> float:
        """The radius of the roller in metres."""
        return self.radius

    def point(self, s: Jet) -> Pair:
        y = s + (self.level - self.lowest)
        return y * 0.0 + self.offset, y

    def components(self, s: Jet) -> Pair:
        return s.slope() - self.turning * self.offset, s + (self.level - self.lowest)

    def rate(self, s: Jet) -> float:  # noqa: ARG002
        return 1.0

    def curvature_terms(self, displacement: str, slope: str) -> CurvatureTerms:
        along = f"({slope} - ({self.turning * self.offset!r}))"
        across = f"({self.level!r} + {displacement})"
        return CurvatureTerms(along, across, f"{along}^2 + {across}^2 + {along}*{slope}", across)

    def state(self, point: Pair, normal: Pair) -> ContactState:
        height = (self.square_of_centre(point, normal) - self.offset**2).root()
        return self.state_at(height + (self.lowest - self.level), point, normal)

    def transmission(self, s: Jet) -> Transmission:
        tangent = self.pressure(s)
        cosine = 1.0 / (tangent * tangent + 1.0).root()
        return Transmission(cosine, self.rolling(s), tangent * cosine * self.turning, cosine * 0.0)

    def pressure_limits(
        self,
        piece: Piece,
        limit: float,
        angle: float,
        *,
        below: bool,  # noqa: ARG002 - they are exact
    ) -> list[LinearLimit]:
        stroke, size = piece.stroke, abs(piece.stroke)
        high = (self.level - self.lowest + piece.offset) / size
        offset = self.turning * self.offset / (limit * size)
        slope = stroke / (angle * limit * size)
        return [LinearLimit((-stroke / size, sign * slope, 0.0), high + sign * offset) for sign in (1.0, -1.0)]
