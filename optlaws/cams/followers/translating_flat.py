"""A flat face on a slide, square to its way."""

from __future__ import annotations

from typing import ClassVar

from optlaws.cams.followers.contact import CURVATURE
from optlaws.cams.followers.follower import Place
from optlaws.cams.followers.rollers_and_faces import FaceContact, FlatFollower, SlidingFace
from optlaws.entries.declared import declared


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
        return SlidingFace(place.turning, place.lowest, place.radius, 0.0)

    def prime_radius(self, level: float) -> float:
        """The height of the face."""
        return level
