"""A flat face on a slide, square to its way."""

from __future__ import annotations

from dataclasses import dataclass

from optlaws.cams.curves.jets import Jet, Pair
from optlaws.cams.followers.contact import FaceContact
from optlaws.cams.followers.follower import Follower, Place


@dataclass(frozen=True)
class TranslatingFlat(Follower):
    """A follower that slides and has a flat face square to its way.

    Examples
    --------
    >>> TranslatingFlat().axis
    'length'
    """

    @property
    def axis(self) -> str:
        """It slides."""
        return "length"

    def contact(self, place: Place) -> FaceContact:  # noqa: D102
        return SlidingFace(place.turning, place.lowest, place.radius)


@dataclass(frozen=True)
class SlidingFace(FaceContact):
    """The same in numbers: the face is at y = height + s and is touched at x = s', by which rho = height + s + s''.

    Examples
    --------
    >>> SlidingFace(1.0, 0.0, 0.04).radius(Jet((0.01, 0.0, -0.01))).terms[0]
    0.03
    """

    height: float

    @property
    def lost(self) -> int:
        """One: the place on the face is a derivative."""
        return 1

    def point(self, s: Jet) -> Pair:  # noqa: D102
        return s.slope() * self.turning, s + (self.height - self.lowest)

    def normal(self, s: Jet) -> Pair:  # noqa: D102
        return s * 0.0, s * 0.0 + 1.0

    def pressure(self, s: Jet) -> Jet:
        """None."""
        return s.slope() * 0.0

    def radius(self, s: Jet) -> Jet:  # noqa: D102
        return s.slope().slope() + s + (self.height - self.lowest)

    def reach(self, s: Jet) -> Jet:
        """From the way of the slide, to the side to which the cam turns away from it."""
        return s.slope() * self.turning
