"""How a follower touches a cam, in numbers: all that the rest of a cam asks of a follower, whatever its kind."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from optlaws.cams.curves.extremes import CamExtremes, Extreme, angle_of_tangent, enclosed_extremes
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cams.followers.linear_limit import CURVATURE, PRESSURE, LinearLimit
from optlaws.cams.followers.transmission import Transmission
from optlaws.errors import InputError
from optlaws.motion.piece import Piece
from optlaws.series.enclosures.interval_arrays import Interval
from optlaws.series.enclosures.jets import Jet, Pair, Term


class ContactState(NamedTuple):
    """Where a follower is that touches a curve, as jets of the curve's own parameter.

    Attributes
    ----------
    displacement
        Of the follower, m or rad.
    direction
        Of its roller's centre, or of the normal of its face, in its frame, rad.
    in_cam
        The same direction in the cam's coordinates, rad.
    """

    displacement: Jet
    direction: Jet
    in_cam: Jet


class CurvatureTerms(NamedTuple):
    """Texts of the velocities of a roller's centre, of the cubed speed times the curvature, and of what s'' takes."""

    along: str
    across: str
    turned: str
    factor: str


@dataclass(frozen=True)
class Contact(ABC):
    """A follower of a cam, in metres and radians, beside which the cam turns; its displacement s comes as a jet.

    Parameters
    ----------
    turning
        1 where the cam turns counterclockwise, else -1.
    lowest
        The displacement of the motion at which the follower is at the base circle.
    level
        Where the follower is there: height above the cam's centre, or angle from the line from pivot to centre.
    """

    turning: float
    lowest: float
    level: float

    @property
    @abstractmethod
    def roller(self) -> float:
        """The roller's radius; 0 for a face."""

    @property
    def pivot(self) -> float | None:
        """How far the pivot is from the cam's centre; None on a slide."""
        return None

    @property
    def linear(self) -> bool:
        """Whether its linear limits are the limits themselves, and not lines beside them."""
        return True

    @property
    @abstractmethod
    def lost(self) -> int:
        """By how many orders the jet of a point is shorter than that of the displacement."""

    @abstractmethod
    def point(self, s: Jet) -> Pair:
        """The roller's centre, or where the face touches."""

    @abstractmethod
    def pressure(self, s: Jet) -> Jet:
        """The tangent of the pressure angle, above 0 where the cam pushes the follower along its turning in a rise."""

    @abstractmethod
    def profile_curvature(self, s: Jet) -> Jet:
        """The curvature of the profile, above 0 where it bulges outward."""

    @abstractmethod
    def radius_of_curvature(self, s: Jet) -> Term:
        """The radius of curvature of the profile, above 0 where it bulges outward."""

    @abstractmethod
    def curvature_excess(self, s: Jet, limit: float) -> Interval:
        """By how much a least radius of curvature is broken, above 0; of either dimension."""

    def normal(self, s: Jet) -> Pair | None:  # noqa: ARG002 - None unless a face has it
        """The normal away from the cam where it is that of a face; None where it is that of the curve."""
        return None

    def pressure_angles(self, motion: CamMotion) -> tuple[Extreme, Extreme]:
        """The least and the greatest pressure angle of a cam, rad."""
        low, high = enclosed_extremes(motion, self.pressure, 1)
        return angle_of_tangent(low), angle_of_tangent(high)

    @abstractmethod
    def least_convex_radius(self, motion: CamMotion) -> Extreme:
        """The least radius of curvature of the profile where it bulges, m."""

    @abstractmethod
    def extremes(self, motion: CamMotion) -> CamExtremes:
        """Enclosed extremes over the whole motion."""

    def pitch_curvatures(self, motion: CamMotion) -> tuple[Extreme, Extreme]:  # noqa: ARG002 - of rollers
        """The least and the greatest curvature of the pitch curve, 1/m.

        Raises
        ------
        InputError
            If the follower has no roller.
        """
        raise InputError("follower: a flat face has no roller: take a TranslatingRoller or an OscillatingRoller")

    @abstractmethod
    def state(self, point: Pair, normal: Pair) -> ContactState:
        """Where the follower is that touches a profile at a point with a normal away from it, in cam coordinates."""

    @abstractmethod
    def transmission(self, s: Jet) -> Transmission:
        """How the follower takes the force of its cam; s with two derivatives by the cam's angle."""

    def linear_limits(
        self, piece: Piece, limits: Mapping[str, float], angle: float, *, below: bool
    ) -> list[LinearLimit]:
        """Limits of a cam as linear limits of a law.

        Parameters
        ----------
        piece
            With its displacement; its law guides where lines touch limits that are not convex.
        limits
            As `read_cam_limits` gives them; those that are not convex and have no lines are left out.
        angle
            Of the cam, over which the piece goes, rad.
        below
            Whether lines are on the side where the limits are kept, or where they are broken.
        """
        pressure, radius = limits.get(PRESSURE), limits.get(CURVATURE)
        lines = [] if pressure is None else self.pressure_limits(piece, pressure, angle, below=below)
        return lines if radius is None else [*lines, *self.radius_limits(piece, radius, angle)]

    def pressure_limits(self, piece: Piece, limit: float, angle: float, *, below: bool) -> list[LinearLimit]:  # noqa: ARG002
        """The greatest tangent of the pressure angle as linear limits of a law; none unless there are such."""
        return []

    def radius_limits(self, piece: Piece, limit: float, angle: float) -> list[LinearLimit]:  # noqa: ARG002
        """The least radius of curvature as linear limits of a law; none unless there are such."""
        return []

    def curvature_terms(self, displacement: str, slope: str) -> CurvatureTerms | None:  # noqa: ARG002 - of rollers
        """The curvature of the pitch curve as texts of the displacement above the lowest and of s'; None of a face."""
        return None


def bearing(x: Jet, y: Jet) -> Jet:
    """The direction of a vector, rad.

    Examples
    --------
    >>> turn = bearing(Jet((0.0, -1.0)), Jet((2.0, 0.0)))
    >>> round(float(turn.terms[0]), 6), float(turn.terms[1])
    (1.570796, 0.5)
    """
    first = np.arctan2(y.terms[0], x.terms[0])
    if x.order == 0:
        return Jet((first,))
    rates = ((x * y.slope() - y * x.slope()) / (x * x + y * y)).terms
    return Jet((first, *(rate / (i + 1) for i, rate in enumerate(rates))))


def shifted(point: Pair, normal: Pair, distance: float) -> Pair:
    """A point moved along a normal."""
    return point[0] + normal[0] * distance, point[1] + normal[1] * distance


def other_leg(sine: Jet) -> Jet:
    """The cosine of an angle within a right one whose sine is known, or the other way around."""
    return (sine * sine * -1.0 + 1.0).root()
