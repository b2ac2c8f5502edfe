"""What is extreme of a cam: pressure angles, radii of curvature, and whether the follower undercuts it, all proven."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, degrees, inf, nextafter

from optlaws.cams.curves.jets import Jet
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cams.extremes.bounding import Extreme, enclosed_extremes
from optlaws.cams.extremes.enclosure import ROUNDING
from optlaws.cams.followers.contact import Contact, FaceContact, RollerContact

_COARSE = 1e-3

FREE, UNDERCUT, UNDECIDED = "free", "undercut", "undecided"


@dataclass(frozen=True)
class Undercut:
    """Whether a follower undercuts its cam, and what is proven of it.

    Attributes
    ----------
    status
        "free" where the profile is proven to have a radius of curvature above 0 wherever it bulges, so that it has no
        cusp and no loop; "undercut" where it is proven not to; "undecided" where the enclosure holds the limit.
    simple
        Whether it is proven besides that the profile does not cross itself and that the follower, where it touches,
        cuts it nowhere else; never of a motion over a part of the turn.
    margin
        The least radius of curvature of the profile where it bulges, m; below 0 by how much the roller is too large.
    """

    status: str
    simple: bool
    margin: Extreme

    @property
    def free(self) -> bool:
        """Whether it is proven that there is no undercut."""
        return self.status == FREE

    def __str__(self) -> str:
        if self.status == UNDERCUT:
            return (
                f"undercut at {degrees(self.margin.angle):.6g} deg: the radius of curvature of the profile would be "
                f"{1e3 * self.margin.value:.6g} mm there: make the base circle larger"
                " or a roller smaller, or spread the motion over more of the turn"
            )
        if self.status == UNDECIDED:
            width = 1e3 * (self.margin.high - self.margin.low)
            return f"undecided: the least radius of curvature is 0 to within {width:.3g} mm"
        return "no undercut" + (", and the profile does not cross itself" if self.simple else ", locally")


@dataclass(frozen=True)
class CamExtremes:
    """Enclosed extremes over the whole interval of a cam's motion; radians and metres.

    Attributes
    ----------
    pressure_angles
        The least and the greatest pressure angle, with their signs.
    bulging_radius
        The least radius of curvature of the profile where it bulges.
    hollow_radius
        The least radius where it is hollow, as a positive number; None where it is proven to be hollow nowhere. A
        cutter must be smaller.
    undercut
        What is proven of undercut.
    """

    pressure_angles: tuple[Extreme, Extreme]
    bulging_radius: Extreme
    hollow_radius: Extreme | None
    undercut: Undercut

    @property
    def greatest_pressure_angle(self) -> Extreme:
        """The greatest magnitude of the pressure angle."""
        least, greatest = self.pressure_angles
        return greatest if greatest.value >= -least.value else -least


def cam_extremes(motion: CamMotion, contact: Contact) -> CamExtremes:
    """The enclosed extremes of a cam.

    Examples
    --------
    >>> from optlaws.cams.followers.translating_roller import SlidingRoller
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> extremes = cam_extremes(rise, SlidingRoller(1.0, 0.0, 0.08, 0.0, 0.012))
    >>> round(degrees(extremes.greatest_pressure_angle.value), 6), extremes.undercut.free
    (21.223026, True)
    """
    pressure = pressure_angles(motion, contact)
    if isinstance(contact, RollerContact):
        return _under_roller(motion, contact, pressure)
    least = bulging_radius(motion, contact)
    # a face turns with the cam all the way, so that its envelope is convex where its radius is above 0
    return CamExtremes(pressure, least, None, Undercut(_status(least), motion.closed and least.low > 0.0, least))


def pressure_angles(motion: CamMotion, contact: Contact) -> tuple[Extreme, Extreme]:
    """The least and the greatest pressure angle of a cam, rad.

    Examples
    --------
    >>> from optlaws.cams.followers.translating_flat import SlidingFace
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> [abs(angle.value) < 1e-200 for angle in pressure_angles(rise, SlidingFace(1.0, 0.0, 0.08))]
    [True, True]
    """
    low, high = enclosed_extremes(motion, contact.pressure, 1)
    return angle_of_tangent(low), angle_of_tangent(high)


def pitch_curvatures(motion: CamMotion, contact: RollerContact) -> tuple[Extreme, Extreme]:
    """The least and the greatest curvature of the pitch curve, 1/m.

    Examples
    --------
    >>> from optlaws.cams.followers.translating_roller import SlidingRoller
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> [round(curvature.value, 6) for curvature in pitch_curvatures(rise, SlidingRoller(1.0, 0.0, 0.08, 0.0, 0.012))]
    [4.471807, 12.867777]
    """
    return enclosed_extremes(motion, contact.curvature, 2)


def bulging_radius(motion: CamMotion, contact: Contact) -> Extreme:
    """The least radius of curvature of the profile where it bulges, m.

    Examples
    --------
    >>> from optlaws.cams.followers.translating_flat import SlidingFace
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> round(bulging_radius(rise, SlidingFace(1.0, 0.0, 0.08)).value, 6)
    0.058672
    """
    if isinstance(contact, RollerContact):
        return _inside(pitch_curvatures(motion, contact)[1], contact.roller)
    assert isinstance(contact, FaceContact)  # noqa: S101 - there are no others
    return enclosed_extremes(motion, contact.radius, 2)[0]


def _inside(curvature: Extreme, roller: float) -> Extreme:
    """The radius of curvature of the profile where the pitch curve bulges most."""
    low, high = 1.0 / curvature.high, 1.0 / curvature.low
    return _outward(low - roller, high - roller, curvature.angle, high)


def _under_roller(motion: CamMotion, contact: RollerContact, pressure: tuple[Extreme, Extreme]) -> CamExtremes:
    least, greatest = pitch_curvatures(motion, contact)
    roller, bulging = contact.roller, _inside(greatest, contact.roller)
    hollow = None
    if least.low < 0.0:
        nearest = -1.0 / least.low + roller
        farthest = -1.0 / least.high + roller if least.high < 0.0 else inf
        hollow = _outward(nearest, farthest, least.angle, nearest)
    status = _status(bulging)
    simple = motion.closed and status == FREE and _is_star(motion, contact)
    return CamExtremes(pressure, bulging, hollow, Undercut(status, simple, bulging))


def _is_star(motion: CamMotion, contact: RollerContact) -> bool:
    """Whether pitch curve and profile are proven to run around the centre without turning back.

    Both then are simple closed curves, and so is no place met twice by the parallel curves between them: the roller
    cuts the profile nowhere else.
    """

    def support(s: Jet) -> Jet:
        x, y = contact.point(s)
        along, across = contact.components(s)
        length = (along * along + across * across).root()
        return (
            (y * (x.slope() + y * contact.turning) - x * (y.slope() - x * contact.turning)) / length * contact.turning
        )

    # the distance of the tangent from the centre; that of the profile's is less by the roller's radius
    return enclosed_extremes(motion, support, 1, _COARSE)[0].low > contact.roller


def _status(margin: Extreme) -> str:
    if margin.low > 0.0:
        return FREE
    return UNDERCUT if margin.high < 0.0 else UNDECIDED


def angle_of_tangent(tangent: Extreme) -> Extreme:
    """The enclosed angle of an enclosed tangent, rad.

    Examples
    --------
    >>> round(angle_of_tangent(Extreme(1.0, 1.0, 0.0)).value, 9)
    0.785398163
    """
    return _outward(atan(tangent.low), atan(tangent.high), tangent.angle, 1.0)


def _outward(low: float, high: float, angle: float, size: float) -> Extreme:
    """An enclosure, a little wider for the roundings of a few operations."""
    slack = 8.0 * ROUNDING * abs(size)
    return Extreme(nextafter(low - slack, -inf), nextafter(high + slack, inf), angle)
