"""A roller on an arm that swings about a pivot."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, degrees
from typing import Any

from optlaws.cams.curves.jets import Jet, Pair
from optlaws.cams.followers.contact import RollerContact, half_turn
from optlaws.cams.followers.follower import Follower, Place, positive, roller_radius, shown
from optlaws.errors import InputError


@dataclass(frozen=True)
class OscillatingRoller(Follower):
    """A follower that swings and has a roller.

    Parameters
    ----------
    radius
        Of the roller, such as "12 mm".
    arm
        From the pivot to the roller's centre.
    pivot_distance
        From the cam's centre to the pivot.

    Examples
    --------
    >>> OscillatingRoller("12 mm", arm="90 mm", pivot_distance="120 mm").axis
    'angle'
    """

    radius: Any
    arm: Any
    pivot_distance: Any

    @property
    def axis(self) -> str:
        """It swings."""
        return "angle"

    def contact(self, place: Place) -> RollerContact:  # noqa: D102
        radius, arm = roller_radius(self.radius, place), positive(self.arm, "roller: arm")
        distance = positive(self.pivot_distance, "roller: pivot_distance")
        if arm <= abs(distance - place.radius):
            raise InputError(
                f"roller: arm {shown(arm)} is too short: from a pivot {shown(distance)} away it does not reach the base"
                f" circle of radius {shown(place.radius)}: make it longer than {shown(abs(distance - place.radius))}"
            )
        if arm >= distance + place.radius:
            raise InputError(
                f"roller: arm {shown(arm)} is too long: from a pivot {shown(distance)} away it reaches beyond the base"
                f" circle of radius {shown(place.radius)}: make it shorter than {shown(distance + place.radius)}"
            )
        first = acos((distance**2 + arm**2 - place.radius**2) / (2.0 * distance * arm))
        last = first + place.highest - place.lowest
        if not half_turn(last):
            raise InputError(
                f"roller: the arm swings from {degrees(first):.6g} to {degrees(last):.6g} deg from the line to the"
                " cam's centre, through its dead centre at 180 deg: make the swing smaller or the arm longer"
            )
        return SwingingRoller(place.turning, place.lowest, first, arm, distance, radius)


@dataclass(frozen=True)
class SwingingRoller(RollerContact):
    """The same in numbers: the pivot is at x = distance, the arm at psi = first + s from the line to the cam's centre.

    Examples
    --------
    >>> import numpy as np
    >>> roller = SwingingRoller(1.0, 0.0, 1.0, 0.09, 0.12, 0.012)
    >>> round(float(roller.pressure(Jet((np.float64(0.0), 0.0))).terms[0]), 6)
    0.249204
    """

    first: float
    arm: float
    distance: float
    radius: float

    @property
    def roller(self) -> float:
        """The roller's radius."""
        return self.radius

    def point(self, s: Jet) -> Pair:  # noqa: D102
        sine, cosine = self._psi(s).waves()
        return cosine * -self.arm + self.distance, sine * self.arm

    def components(self, s: Jet) -> Pair:  # noqa: D102
        sine, cosine = self._psi(s).waves()
        along = s.slope() * self.arm + (cosine * -self.distance + self.arm) * self.turning
        return along, sine * self.distance

    def rate(self, s: Jet) -> Jet:  # noqa: D102
        return s.slope() * self.turning + 1.0

    def _psi(self, s: Jet) -> Jet:
        return s + (self.first - self.lowest)
