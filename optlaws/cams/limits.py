"""The limits of a cam, its greatest pressure angle and its least radius of curvature, as one value."""

from __future__ import annotations

from math import degrees, pi, tan
from typing import Self

from optlaws.cams.curves.extremes import CamExtremes
from optlaws.cams.followers.contact import CURVATURE, PRESSURE
from optlaws.cams.followers.follower import shown
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.motion.quantities import in_degrees, quantity
from optlaws.numbers import Quantity
from optlaws.numerics.peaks import is_kept
from optlaws.sentences import Amount, Sentence, joined, sentence
from optlaws.tolerances import CAM_FEASIBILITY


@declared
class CamLimits(Declared, title="limits of a cam"):
    """Limits that a cam is to keep all around.

    Examples
    --------
    >>> print(CamLimits("30 deg", "5 mm"))
    a pressure angle of 30 deg and a radius of curvature of 5 mm
    """

    pressure_angle: Quantity | None = entry(
        Measured("angle"),
        "The greatest magnitude of the pressure angle.",
        default=None,
        label="pressure ≤",
        example="30 deg",
    )
    radius_of_curvature: Quantity | None = entry(
        Measured("length", least=0.0),
        "The least radius of curvature of the profile where it bulges.",
        default=None,
        label="radius ≥",
        example="15 mm",
    )

    def _check(self) -> None:
        if self.pressure is not None and not 0.0 < self.pressure < 0.5 * pi:
            raise InputError(f"pressure_angle must be above 0 and below 90 deg, got {shortened(self.pressure_angle)}")

    def of_one(self) -> Self:
        """These limits, if there is one of them at least."""
        if not self.in_si:
            raise InputError("give a limit of the cam: pressure_angle='30 deg', radius_of_curvature='5 mm', or both")
        return self

    @kept_property
    def pressure(self) -> float | None:
        """The greatest pressure angle, rad."""
        return None if self.pressure_angle is None else quantity(self.pressure_angle, "angle", "pressure_angle")

    @kept_property
    def radius(self) -> float | None:
        """The least radius of curvature, m."""
        given = self.radius_of_curvature
        return None if given is None else quantity(given, "length", "radius_of_curvature")

    @kept_property
    def in_si(self) -> dict[str, float]:
        """The tangent of the pressure angle, and the radius in metres, as contacts of followers take them."""
        pressure = {} if self.pressure is None else {PRESSURE: tan(self.pressure)}
        return pressure if self.radius is None else {**pressure, CURVATURE: self.radius}

    def broken(self, extremes: CamExtremes) -> dict[str, Sentence]:
        """What of a cam is beyond them, by the limit's name, but for the rounding of laws that reach them."""
        broken = {}
        steepest, bulging = extremes.greatest_pressure_angle, extremes.least_convex_radius
        if self.pressure is not None and not is_kept(tan(steepest.low), tan(self.pressure), CAM_FEASIBILITY):
            taken = Amount(degrees(steepest.value), "deg", 5)
            broken[PRESSURE] = sentence("the pressure angle, {} of {}", taken, self.pressure_angle)
        if self.radius is not None and not is_kept(-bulging.high, -self.radius, CAM_FEASIBILITY):
            taken = Amount(1e3 * bulging.value, "mm", 5)
            broken[CURVATURE] = sentence("the radius of curvature, {} of {}", taken, self.radius_of_curvature)
        return broken

    def proven(self, extremes: CamExtremes) -> bool:
        """Whether they are proven to be kept."""
        steepest, bulging = extremes.greatest_pressure_angle, extremes.least_convex_radius
        return (self.pressure is None or tan(steepest.high) <= tan(self.pressure)) and (
            self.radius is None or bulging.low >= self.radius
        )

    def __str__(self) -> str:
        pressure = [] if self.pressure is None else [sentence("a pressure angle of {}", in_degrees(self.pressure))]
        radius = [] if self.radius is None else [sentence("a radius of curvature of {}", shown(self.radius))]
        return joined(" and ", [*pressure, *radius])
