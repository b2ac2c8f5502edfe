"""Flat faces on cams: the profile as the envelope of the face, and friction along it."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.curves.extremes import CamExtremes, Extreme, Undercut, enclosed_extremes
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cams.followers.contact import Contact
from optlaws.series.enclosures.interval_arrays import Interval
from optlaws.series.enclosures.jets import Jet, Term

Array = NDArray[np.float64]


class FaceContact(Contact):
    """A flat face, of which the cam's profile is the envelope."""

    @property
    def roller(self) -> float:
        """Zero: a flat face has no roller."""
        return 0.0

    @property
    def lost(self) -> int:
        """One: the place on the face is a derivative."""
        return 1

    @abstractmethod
    def radius(self, s: Jet) -> Jet:
        """The radius of curvature of the profile, by which it is free of undercut where it is above 0."""

    def profile_curvature(self, s: Jet) -> Jet:
        """One over the radius."""
        return 1.0 / self.radius(s)

    def radius_of_curvature(self, s: Jet) -> Term:
        """The radius of curvature of the profile, above 0 where it bulges outward."""
        return self.radius(s).terms[0]

    def curvature_excess(self, s: Jet, limit: float) -> Interval:
        """By how much the radius is less than it may be, m."""
        excess: Interval = -self.radius(s).terms[0] + limit
        return excess

    def least_convex_radius(self, motion: CamMotion) -> Extreme:
        """The least radius of curvature of the profile, m."""
        return enclosed_extremes(motion, self.radius, 2)[0]

    def extremes(self, motion: CamMotion) -> CamExtremes:
        """Enclosed extremes over the whole motion."""
        pressure, least = self.pressure_angles(motion), self.least_convex_radius(motion)
        # a face turns with the cam all the way, so that its envelope is convex where its radius is above 0
        return CamExtremes(pressure, least, None, Undercut.of(least, simple=motion.closed))

    @abstractmethod
    def reach(self, s: Jet) -> Jet:
        """Where the face is touched, along it."""


def sign(jet: Jet) -> Jet:
    """1 or -1; where intervals leave open which, all between.

    Examples
    --------
    >>> sign(Jet((np.array([0.5, -2.0]), np.array([1.0, 1.0])))).terms[0].tolist()
    [1.0, -1.0]
    """
    first = jet.terms[0]
    if not isinstance(first, Interval):
        return Jet((np.sign(first), *(np.zeros(np.shape(first)),) * jet.order))
    signs: Array = np.where(first.low > 0.0, 1.0, np.where(first.high < 0.0, -1.0, 0.0))
    leap = Interval(np.zeros(signs.shape), np.where(signs == 0.0, np.inf, 0.0))
    return Jet((Interval(signs, np.where(signs == 0.0, 1.0, 0.0)), *(leap,) * jet.order))
