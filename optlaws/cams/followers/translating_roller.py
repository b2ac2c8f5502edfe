"""A roller on a slide, whose way may pass the cam's centre at an offset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from optlaws.cams.curves.jets import Jet, Pair
from optlaws.cams.followers.contact import RollerContact, side_of
from optlaws.cams.followers.follower import Follower, Place, roller_radius, shown
from optlaws.cycles.asked.quantities import quantity
from optlaws.errors import InputError


@dataclass(frozen=True)
class TranslatingRoller(Follower):
    """A follower that slides and has a roller.

    Parameters
    ----------
    radius
        Of the roller, such as "12 mm".
    offset
        Of the slide's way from the cam's centre; above 0 on the side to which the cam's top moves when it turns
        clockwise, so that with a cam that turns counterclockwise it lessens the pressure angle of the rise.

    Examples
    --------
    >>> TranslatingRoller("12 mm", offset="10 mm").axis
    'length'
    """

    radius: Any
    offset: Any = "0 mm"

    @property
    def axis(self) -> str:
        """It slides."""
        return "length"

    def contact(self, place: Place) -> RollerContact:  # noqa: D102
        radius, offset = roller_radius(self.radius, place), quantity(self.offset, "length", "roller: offset")
        if abs(offset) >= place.radius:
            raise InputError(
                f"roller: offset {shown(offset)} is beyond the base circle of radius {shown(place.radius)}: the roller"
                " cannot touch it: make the offset less or the base circle larger"
            )
        return SlidingRoller(place.turning, place.lowest, side_of(place.radius, abs(offset)), offset, radius)


@dataclass(frozen=True)
class SlidingRoller(RollerContact):
    """The same in numbers: x = offset, y = height + s.

    Examples
    --------
    >>> roller = SlidingRoller(1.0, 0.0, 0.08, 0.0, 0.012)
    >>> roller.pressure(Jet((0.02, 0.05))).terms[0]
    0.5
    """

    height: float
    offset: float
    radius: float

    @property
    def roller(self) -> float:
        """The roller's radius."""
        return self.radius

    def point(self, s: Jet) -> Pair:  # noqa: D102
        y = s + (self.height - self.lowest)
        return y * 0.0 + self.offset, y

    def components(self, s: Jet) -> Pair:  # noqa: D102
        return s.slope() - self.turning * self.offset, s + (self.height - self.lowest)

    def rate(self, s: Jet) -> float:  # noqa: ARG002, D102
        return 1.0
