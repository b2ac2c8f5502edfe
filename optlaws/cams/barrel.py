"""Barrel cams: a groove around a cylinder that moves a roller along the axis, with exact flanks in space.

The roller turns about a radial axis. Seen from the cam, at the distance r from the axis of the shaft, the roller's axis
goes s' along the shaft and r around it, so that tan(alpha) = s'/r; the flanks are R to both sides, square to that.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import nextafter
from typing import Any, Literal

import numpy as np

from optlaws.cams.curves.extremes import (
    FREE,
    UNDECIDED,
    UNDERCUT,
    EnclosedExtreme,
    angle_of_tangent,
    enclosed_extremes,
    first_least,
)
from optlaws.cams.curves.motion_by_angle import CamMotion, as_motion
from optlaws.cams.curves.plane_curve import CurveByAngle
from optlaws.cams.disc import Turning, sense
from optlaws.cams.followers.follower import positive, shown
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.entries.declared import Declared, declared, documented_by, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.numbers import Array, NumberOrQuantity, derivative, number_or_array, real_times
from optlaws.numerics.taylor import Jet, variable

LENGTH = Measured("length", above=0.0)
Side = Literal["upper", "lower"]
SIDES: dict[Side, float] = {"upper": 1.0, "lower": -1.0}


@declared
class Groove(Declared, title="a barrel"):
    """A cylinder with a groove, and the roller in it."""

    outer_radius: NumberOrQuantity = entry(LENGTH, "Of the cylinder.", example="60 mm")
    depth: NumberOrQuantity = entry(LENGTH, "Of the groove.", example="12 mm")
    roller_radius: NumberOrQuantity = entry(LENGTH, "Of the roller.", example="8 mm")

    @property
    def radii(self) -> tuple[float, float]:
        """Radius of the cylinder, and of the bottom of the groove, m."""
        outer = positive(self.outer_radius, "outer_radius")
        return outer, outer - positive(self.depth, "depth")

    def _check(self) -> None:
        outer, inner = self.radii
        if inner <= 0.0:
            raise InputError(
                f"depth must be less than the radius of the cylinder, {shown(outer)}, got {shown(outer - inner)}:"
                " make the groove shallower or the cylinder larger"
            )
        roller = positive(self.roller_radius, "roller_radius")
        if roller >= inner:
            raise InputError(
                f"roller_radius {shown(roller)} is not less than the radius at the bottom of the groove,"
                f" {shown(inner)}: make the roller smaller or the cylinder larger"
            )


@documented_by(Groove)
@dataclass(frozen=True)
class BarrelCam:
    """A groove around a cylinder with a cylindrical roller; metres and radians, derivatives by the cam's angle.

    Parameters
    ----------
    motion
        A `Cycle`, which is a turn of the cam, or the law of a part of the turn.
    turning
        "counterclockwise" or "clockwise", seen against the axis along which the roller moves forwards.

    Raises
    ------
    InputError
        If there is no such groove, or an argument of a method is none; the error states the remedy.

    Examples
    --------
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> cam = BarrelCam(rise, outer_radius="60 mm", depth="12 mm", roller_radius="8 mm")
    >>> round(float(np.degrees(cam.pressure_angle(1.0))), 6), cam.flank("upper")(1.0).shape, cam.undercut
    (38.37193, (3,), 'free')
    """

    motion: Cycle | Plan | CamMotion
    outer_radius: NumberOrQuantity
    depth: NumberOrQuantity
    roller_radius: NumberOrQuantity
    turning: Turning = field(default="counterclockwise", kw_only=True)

    def __post_init__(self) -> None:
        sense(self.turning)
        self.radii  # noqa: B018 - a groove that is none is refused at once
        self.displacement  # noqa: B018 - a motion of another kind is refused at once

    @kept_property
    def displacement(self) -> CamMotion:
        """The displacement of the roller along the axis, by the cam's angle."""
        motion = self.motion
        if isinstance(motion, Cycle | Plan) and (motion.axis == "angle" or motion.programme.advance):
            raise InputError(
                "motion: a table or turret that advances in each turn has several rollers on a circle; this barrel cam "
                "has one, which slides along the shaft and comes back: end its motion with a return, or run the motion "
                "of the table as a cycle and export it to the program that makes indexing cams"
            )
        return as_motion(motion, "length")

    @kept_property
    def radii(self) -> tuple[float, float]:
        """Radius of the cylinder, and of the bottom of the groove."""
        return Groove(self.outer_radius, self.depth, self.roller_radius).radii

    @kept_property
    def roller(self) -> float:
        """The radius of the roller in metres."""
        return positive(self.roller_radius, "roller_radius")

    @property
    def pitch_curve(self) -> SpaceCurve:
        """The way of the roller's axis on the cylinder."""
        return SpaceCurve(self.displacement, self.radii[0], 0.0, sense(self.turning))

    def flank(self, side: Side, radius: float | None = None) -> SpaceCurve:
        """The curve along which the roller touches a flank, at a distance from the axis of the shaft.

        Parameters
        ----------
        side
            "upper", which pushes the roller back, or "lower", which pushes it forwards.
        radius
            The distance in metres; that of the cylinder unless given.
        """
        check_names([side], SIDES, "side")
        return SpaceCurve(self.displacement, self._within(radius), SIDES[side] * self.roller, sense(self.turning))

    def cutter_path(
        self, cutter_radius: NumberOrQuantity, side: Side = "upper", radius: float | None = None
    ) -> SpaceCurve:
        """The path of the axis of a cutter, radial like the roller's axis, that cuts a flank; exact at one radius.

        A cutter as large as the roller makes both flanks all over; a smaller one leaves them exact at the radius given.

        Raises
        ------
        InputError
            If the cutter is larger than the roller, or there is no such side or radius.
        """
        cutter, curve = positive(cutter_radius, "cutter_radius"), self.flank(side, radius)
        if cutter > self.roller:
            raise InputError(
                f"cutter_radius {shown(cutter)} is more than that of the roller, {shown(self.roller)}: take a smaller"
                " one"
            )
        return SpaceCurve(curve.motion, curve.radius, SIDES[side] * (self.roller - cutter), curve.turning)

    def pressure_angle(self, angle: Any, nu: int = 0, radius: float | None = None) -> Any:
        """The pressure angle at a distance from the shaft's axis, the bottom of the groove unless given, rad."""
        nu = derivative(nu)
        at = self.radii[1] if radius is None else self._within(radius)
        slope = self.displacement.jet(real_times(angle), nu + 1).slope()
        return number_or_array((slope * (1.0 / at)).arctangent().derivative(nu))

    @kept_property
    def pressure_angles(self) -> tuple[EnclosedExtreme, EnclosedExtreme]:
        """The least and the greatest pressure angle, at the bottom of the groove, where it is greatest; enclosed."""
        least, greatest = enclosed_extremes(self.displacement, lambda s: s.slope() * (1.0 / self.radii[1]), 1)
        return angle_of_tangent(least), angle_of_tangent(greatest)

    @kept_property
    def margin(self) -> EnclosedExtreme:
        """The least of v - R r |s''|/v² - R² s'²/v³ at the bottom of the groove, v² = r² + s'², in m; enclosed.

        The advance of a flank per radian; where it is not above 0, the flank has a cusp.
        """
        return self._rest(steep=False)

    def _rest(self, *, steep: bool) -> EnclosedExtreme:
        """The least of it, or of v - R |s''|/v - R² s'²/v³ at the bottom, which is no more than it is at any depth."""
        radius, roller = self.radii[1], self.roller

        def rest(sign: float) -> EnclosedExtreme:
            def speed(s: Jet) -> Jet:
                slope, bend = s.slope(), s.slope().slope()
                square = slope * slope + radius * radius
                way = square.root()
                turned = bend / way if steep else bend / square * radius
                return way - turned * (sign * roller) - slope * slope / (square * way) * roller**2

            return enclosed_extremes(self.displacement, speed, 2)[0]

        return first_least(rest(1.0), rest(-1.0))

    @property
    def undercut(self) -> str:
        """Whether flanks are proven to have no cusp at any depth, "free", or one, "undercut"; or "undecided"."""
        steepest = max(abs(angle) for extreme in self.pressure_angles for angle in (extreme.low, extreme.high))
        if self.margin.high < 0.0:
            return UNDERCUT
        if self.margin.low <= 0.0:
            return UNDECIDED
        # below 45 deg what is at the bottom of the groove is worst; r/v² is nowhere more than 1/v at the bottom
        level = steepest < nextafter(0.25 * np.pi, 0.0)
        return FREE if level or self._rest(steep=True).low > 0.0 else UNDECIDED

    def _within(self, radius: float | None) -> float:
        outer, inner = self.radii
        at = outer if radius is None else float(real_times(radius))
        if not inner * (1.0 - 1e-12) <= at <= outer * (1.0 + 1e-12):
            raise InputError(f"radius must be within the groove, {inner:g} to {outer:g} m, got {at:g}")
        return at


@dataclass(frozen=True)
class SpaceCurve(CurveByAngle):
    """A curve on a barrel cam as a function of the cam's angle: x, y square to the shaft and z along it, m.

    Parameters
    ----------
    motion
        Of the roller along the shaft.
    radius
        Distance of the place on the roller's axis from that of the shaft.
    beside
        How far the curve is from the roller's axis, square to its way seen from the cam.
    turning
        1 where the cam turns counterclockwise, else -1.
    """

    motion: CamMotion
    radius: float
    beside: float
    turning: float

    @property
    def breaks(self) -> tuple[float, ...]:
        return self.motion.breaks

    def jets(self, angle: Array, order: int, *, before: bool = False) -> tuple[Jet, Jet, Jet]:
        s = self.motion.jet(angle, order + 1, before=before)
        slope = s.slope()
        way = (slope * slope + self.radius**2).root()
        around = slope / way * (-self.turning * self.beside)
        along = s + (way * 0.0 + self.radius) / way * self.beside
        sine, cosine = (variable(self.motion.within(angle), order) * self.turning).waves()
        # the cam turns away under the roller, which is at the top at the angle 0
        return (
            sine * self.radius + cosine * around,
            cosine * self.radius - sine * around,
            along.cut(order),
        )
