"""A flat face on a slide, inclined to the square of its way."""

from __future__ import annotations

from math import cos, pi
from typing import ClassVar

from optlaws.cams.followers.contact import CURVATURE
from optlaws.cams.followers.follower import Place
from optlaws.cams.followers.rollers_and_faces import FaceContact, FlatFollower, SlidingFace
from optlaws.echo import shortened
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.motion.quantities import quantity
from optlaws.numbers import Quantity


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

    inclination: Quantity = entry(
        Measured("angle"),
        "Between the face and the square of the way, above 0 where the face rises to the side to which the cam's top "
        "moves when it turns clockwise; less than 90 deg.",
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
        return SlidingFace(place.turning, place.lowest, place.radius / cos(self.angle), self.angle)

    def prime_radius(self, level: float) -> float:
        """The distance of a face that meets the slide's way at a height."""
        return level * cos(self.angle)
