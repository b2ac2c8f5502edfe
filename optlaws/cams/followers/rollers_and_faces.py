"""Rollers and flat faces on cams: pitch curves and envelopes, their curvature, rolling and sliding."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field, replace
from math import atan, cos, degrees, inf, pi, sin, tan

import numpy as np

from optlaws.cams.curves.extremes import (
    CamExtremes,
    EnclosedExtreme,
    FollowerSize,
    Undercut,
    enclosed_extremes,
    widened,
)
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cams.followers.contact import (
    ContactState,
    CurvatureTerms,
    Drag,
    FollowerContact,
    LinearLimit,
    Transmission,
    bearing,
    shifted,
)
from optlaws.cams.followers.follower import CamFollower, Place
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array, Quantity
from optlaws.numerics.interval import Interval
from optlaws.numerics.peaks import is_kept
from optlaws.numerics.taylor import Jet, Pair, Term
from optlaws.tolerances import CAM_FEASIBILITY

_NO_CROSSING = 1e-3  # the support of a profile, whose sign is all that counts


class RollerContact(FollowerContact):
    """A roller: its centre runs along the pitch curve, `along` the follower's way and `across` it.

    With p along and q across, both by the angle, tan(alpha) = p/q, and the curvature of the pitch curve, above 0 where
    it bulges outward, is (w (p² + q²) + p q' - q p')/(p² + q²)^(3/2), where w is how fast the follower's way turns
    against the cam.
    """

    @abstractmethod
    def components(self, s: Jet) -> Pair:
        """The velocity components of the centre along the follower's path and across it, relative to the cam."""

    @abstractmethod
    def rate(self, s: Jet) -> Jet | float:
        """The rotation of the follower's path relative to the cam, per radian."""

    @abstractmethod
    def curvature_terms(self, displacement: str, slope: str) -> CurvatureTerms:
        """The curvature of the pitch curve as texts of the displacement above the lowest and of s'."""

    @property
    def lost(self) -> int:
        """Zero: a point of the profile takes no derivative of the displacement."""
        return 0

    def pressure(self, s: Jet) -> Jet:
        """The tangent of the pressure angle: velocity along the follower's way over velocity across it."""
        along, across = self.components(s)
        return along / across

    def curvature(self, s: Jet) -> Jet:
        """The curvature of the pitch curve."""
        p, q = self.components(s)
        square = p * p + q * q
        turned = p * q.slope() - q * p.slope()
        return (square * self.rate(s) + turned) / (square * square.root())

    def profile_curvature(self, s: Jet) -> Jet:
        """Curvature of the profile, the parallel curve of the pitch curve at the roller's radius inward."""
        curvature = self.curvature(s)
        return curvature / (curvature * -self.roller + 1.0)

    def radius_of_curvature(self, s: Jet) -> Term:
        """Radius of curvature of the pitch curve less the roller's radius; infinite where the curve is straight."""
        with np.errstate(divide="ignore"):
            return 1.0 / self.curvature(s).terms[0] - self.roller

    def curvature_excess(self, s: Jet, limit: float) -> Interval:
        """The excess of the curvature of the pitch curve over its limit, 1/m."""
        excess: Interval = self.curvature(s).terms[0] - 1.0 / (limit + self.roller)
        return excess

    def pitch_curvatures(self, motion: CamMotion) -> tuple[EnclosedExtreme, EnclosedExtreme]:
        """The least and the greatest curvature of the pitch curve, 1/m."""
        return enclosed_extremes(motion, self.curvature, 2)

    def least_convex_radius(self, motion: CamMotion) -> EnclosedExtreme:
        """The least radius of curvature of the profile where it bulges, m."""
        return self._inside(self.pitch_curvatures(motion)[1])

    def extremes(self, motion: CamMotion) -> CamExtremes:
        """Enclosed extremes over the whole motion."""
        pressure = self.pressure_angles(motion)
        least, greatest = self.pitch_curvatures(motion)
        roller, convex = self.roller, self._inside(greatest)
        concave = None
        if least.low < 0.0:
            nearest = -1.0 / least.low + roller
            farthest = -1.0 / least.high + roller if least.high < 0.0 else inf
            concave = widened(nearest, farthest, least.angle, nearest)
        simple = motion.closed and convex.low > 0.0 and self._is_star(motion)
        return CamExtremes(pressure, convex, concave, Undercut.of(convex, simple=simple))

    def _inside(self, curvature: EnclosedExtreme) -> EnclosedExtreme:
        """The radius of curvature of the profile where the pitch curve bulges most."""
        low, high = 1.0 / curvature.high, 1.0 / curvature.low
        return widened(low - self.roller, high - self.roller, curvature.angle, high)

    def _is_star(self, motion: CamMotion) -> bool:
        """Whether pitch curve and profile are proven to run around the centre without turning back.

        Both then are simple closed curves, and so is no place met twice by the parallel curves between them: the roller
        cuts the profile nowhere else.
        """

        def support(s: Jet) -> Jet:
            x, y = self.point(s)
            turning = self.turning
            return (y * (x.slope() + y * turning) - x * (y.slope() - x * turning)) / self._speed(s) * turning

        # the distance of the tangent from the centre; that of the profile's is less by the roller's radius
        return enclosed_extremes(motion, support, 1, _NO_CROSSING)[0].low > self.roller

    def _speed(self, s: Jet) -> Jet:
        along, across = self.components(s)
        return (along * along + across * across).root()

    def rolling(self, s: Jet) -> Jet:
        """How fast the roller's surface runs past its centre: the centre's own way, less the cam's turning with it."""
        return (self._speed(s) - self.roller).magnitude()

    def state_at(self, displacement: Jet, point: Pair, normal: Pair) -> ContactState:
        """The state whose displacement is known: seen from either side it is about the roller's centre."""
        in_cam = bearing(*shifted(point, normal, self.roller))
        return ContactState(displacement, bearing(*self.point(displacement)), in_cam)

    def square_of_centre(self, point: Pair, normal: Pair) -> Jet:
        """The squared distance between the roller's centre and the cam's centre, where the roller touches a profile."""
        x, y = shifted(point, normal, self.roller)
        return x * x + y * y


def half_turn(angle: float) -> bool:
    """Whether an angle is strictly within half a turn, where its sine is above 0."""
    return 0.0 < angle < pi and sin(angle) > 0.0


@declared
class FlatFollower(CamFollower, title="a flat follower"):
    """A follower with a flat face."""

    face_length: Quantity | None = entry(
        Measured("length", above=0.0),
        "Of the face: no less than the way of the contact along it, which is reported beside it.",
        default=None,
        kw_only=True,
        example="60 mm",
    )

    @abstractmethod
    def face(self, place: Place) -> FaceContact:
        """How its face touches a cam, however long it is."""

    def contact(self, place: Place) -> FaceContact:
        given = self.face_length
        length = None if given is None else quantity(given, "length", "face: face_length")
        return replace(self.face(place), length=length)


@dataclass(frozen=True)
class FaceContact(FollowerContact):
    """A flat face, of which the cam's profile is the envelope; its length in m where it is known."""

    length: float | None = field(default=None, kw_only=True)

    @property
    def roller(self) -> float:
        """Zero, as a flat face has no roller."""
        return 0.0

    @property
    def lost(self) -> int:
        """One: the point of contact on the face is a derivative of the displacement."""
        return 1

    @abstractmethod
    def radius(self, s: Jet) -> Jet:
        """Radius of curvature of the profile; there is no undercut where it is above 0."""

    def profile_curvature(self, s: Jet) -> Jet:
        """Curvature of the profile, the reciprocal of its radius of curvature."""
        return 1.0 / self.radius(s)

    def radius_of_curvature(self, s: Jet) -> Term:
        """The radius of curvature of the profile, above 0 where it bulges outward."""
        return self.radius(s).terms[0]

    def curvature_excess(self, s: Jet, limit: float) -> Interval:
        """The excess of the least radius over the radius of the profile, m."""
        excess: Interval = -self.radius(s).terms[0] + limit
        return excess

    def least_convex_radius(self, motion: CamMotion) -> EnclosedExtreme:
        """The least radius of curvature of the profile, m."""
        return enclosed_extremes(motion, self.radius, 2)[0]

    def extremes(self, motion: CamMotion) -> CamExtremes:
        """Enclosed extremes over the whole motion."""
        pressure, least = self.pressure_angles(motion), self.least_convex_radius(motion)
        # a face turns with the cam all the way, so that its envelope is convex where its radius is above 0
        undercut = Undercut.of(least, simple=motion.closed)
        return CamExtremes(pressure, least, None, undercut, () if self.length is None else self._along(motion))

    def _along(self, motion: CamMotion) -> tuple[FollowerSize, ...]:
        """The places of the contact along the face, from the foot of the shaft or the pivot, and their length."""
        first, last = enclosed_extremes(motion, self.reach, 1)
        ends = last.low - first.high, last.high - first.low
        needed = widened(*ends, last.angle, max(abs(first.low), abs(last.high)))
        places = {"contact along the face, least": first, "contact along the face, greatest": last}
        return *(FollowerSize(name, place) for name, place in places.items()), FollowerSize(
            "length of face", needed, self.length
        )

    @abstractmethod
    def reach(self, s: Jet) -> Jet:
        """The place along the face where it is touched."""


@dataclass(frozen=True)
class SlidingFace(FaceContact):
    """A face on a slide, square to its way where the angle is 0: at y = height + s on the way, rho = (y + s'') cos."""

    angle: float

    def point(self, s: Jet) -> Pair:
        far, reach = self._far(s), self.reach(s)
        return reach * cos(self.angle) - far * sin(self.angle), reach * sin(self.angle) + far * cos(self.angle)

    def normal(self, s: Jet) -> Pair:
        return s * 0.0 - sin(self.angle), s * 0.0 + cos(self.angle)

    def pressure(self, s: Jet) -> Jet:
        """The tangent of the inclination, the same everywhere."""
        return s.slope() * 0.0 + self.turning * tan(self.angle)

    def radius(self, s: Jet) -> Jet:
        return s.slope().slope() * cos(self.angle) + self._far(s)

    def reach(self, s: Jet) -> Jet:
        """The distance from the foot of the cam's centre, to the side to which the cam turns away from it."""
        return s.slope() * (self.turning * cos(self.angle))

    def _far(self, s: Jet) -> Jet:
        """The distance of the face from the cam's centre."""
        return (s + (self.level - self.lowest)) * cos(self.angle)

    def state(self, point: Pair, normal: Pair) -> ContactState:
        far = point[0] * normal[0] + point[1] * normal[1]
        height = far / cos(self.angle)
        return ContactState(height + (self.lowest - self.level), far * 0.0 + (0.5 * pi + self.angle), bearing(*normal))

    def transmission(self, s: Jet) -> Transmission:
        aside, _ = self.point(s)
        sine, cosine, none = sin(self.angle), cos(self.angle), aside * 0.0
        sliding = self._far(s) + s.slope() * (self.turning * sine)
        # the cam's surface runs past along the face, away from its turning unless it is touched below the shaft
        past = sign(sliding) * -self.turning
        drag = Drag(past * sine, past * cosine, aside * past * sine)
        return Transmission(none + cosine, sliding.magnitude(), none - sine, aside * cosine, drag)

    def radius_limits(self, piece: Piece, limit: float, angle: float) -> list[LinearLimit]:
        stroke, size = piece.stroke, abs(piece.stroke)
        high = (self.level - self.lowest + piece.offset - limit / cos(self.angle)) / size
        return [LinearLimit((-stroke / size, 0.0, -stroke / (size * angle**2)), high)]

    def pressure_limits(self, piece: Piece, limit: float, angle: float, *, below: bool) -> list[LinearLimit]:
        """No limits: either every law keeps a greatest pressure angle, or none does, which is refused."""
        del piece, angle, below
        if not is_kept(abs(tan(self.angle)), limit, CAM_FEASIBILITY):
            raise InputError(
                f"pressure_angle: it is that of the face, {degrees(abs(self.angle)):.6g} deg, whatever the law: give a"
                f" limit above {degrees(atan(limit)):.6g} deg, or a face that is less inclined"
            )
        return []


def sign(jet: Jet) -> Jet:
    """1 or -1; where intervals leave open which, all between."""
    first = jet.terms[0]
    if not isinstance(first, Interval):
        return Jet((np.sign(first), *(np.zeros(np.shape(first)),) * jet.order))
    signs: Array = np.where(first.low > 0.0, 1.0, np.where(first.high < 0.0, -1.0, 0.0))
    jump = Interval(np.zeros(signs.shape), np.where(signs == 0.0, np.inf, 0.0))
    return Jet((Interval(signs, np.where(signs == 0.0, 1.0, 0.0)), *(jump,) * jet.order))
