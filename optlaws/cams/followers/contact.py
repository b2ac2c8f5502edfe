"""How a follower touches a cam, in numbers: where, under which pressure angle, and with which curvature."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import pi, sin, sqrt

from optlaws.cams.curves.jets import Jet, Pair


@dataclass(frozen=True)
class Contact(ABC):
    """A follower of a cam, in metres and radians, beside which the cam turns; its displacement s comes as a jet.

    Parameters
    ----------
    turning
        1 where the cam turns counterclockwise, else -1.
    lowest
        The displacement of the motion at which the follower is at the base circle.
    """

    turning: float
    lowest: float

    @property
    @abstractmethod
    def roller(self) -> float:
        """The roller's radius; 0 for a face."""

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

    def normal(self, s: Jet) -> Pair | None:  # noqa: ARG002 - None unless a face has it
        """The normal away from the cam where it is that of a face; None where it is that of the curve."""
        return None


class RollerContact(Contact):
    """A roller: its centre runs along the pitch curve, `along` the follower's way and `across` it.

    With p along and q across, both by the angle, tan(alpha) = p/q, and the curvature of the pitch curve, above 0 where
    it bulges outward, is (w (p² + q²) + p q' - q p')/(p² + q²)^(3/2), where w is how fast the follower's way turns
    against the cam.
    """

    @abstractmethod
    def components(self, s: Jet) -> Pair:
        """How fast the centre goes along the follower's way and across it, seen from the cam."""

    @abstractmethod
    def rate(self, s: Jet) -> Jet | float:
        """How fast the follower's way turns against the cam."""

    @property
    def lost(self) -> int:
        """None."""
        return 0

    def pressure(self, s: Jet) -> Jet:
        """Along through across."""
        along, across = self.components(s)
        return along / across

    def curvature(self, s: Jet) -> Jet:
        """The curvature of the pitch curve."""
        p, q = self.components(s)
        square = p * p + q * q
        turned = p * q.slope() - q * p.slope()
        return (square * self.rate(s) + turned) / (square * square.root())


class FaceContact(Contact):
    """A flat face, of which the cam's profile is the envelope."""

    @property
    def roller(self) -> float:
        """None."""
        return 0.0

    @abstractmethod
    def radius(self, s: Jet) -> Jet:
        """The radius of curvature of the profile, by which it is free of undercut where it is above 0."""

    @abstractmethod
    def reach(self, s: Jet) -> Jet:
        """Where the face is touched, along it."""


def side_of(long: float, short: float) -> float:
    """The other leg of a right triangle.

    Examples
    --------
    >>> side_of(5.0, 3.0)
    4.0
    """
    return sqrt((long - short) * (long + short))


def half_turn(angle: float) -> bool:
    """Whether an angle is strictly within half a turn, where its sine is above 0.

    Examples
    --------
    >>> half_turn(1.0), half_turn(-0.1)
    (True, False)
    """
    return 0.0 < angle < pi and sin(angle) > 0.0
