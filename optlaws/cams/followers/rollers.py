"""Rollers on slides and on arms: pitch curves and their curvature, rolling, and the limits of laws over them."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from math import acos, cos, degrees, hypot, inf, pi, sin, sqrt
from typing import ClassVar

import numpy as np

from optlaws.cams.curves.extremes import CamExtremes, EnclosedExtreme, Undercut, enclosed_extremes, widened
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cams.followers.contact import (
    PRESSURE,
    ContactState,
    CurvatureTerms,
    FollowerContact,
    LinearLimit,
    Transmission,
    bearing,
    other_leg,
    shifted,
)
from optlaws.cams.followers.follower import CamFollower, Place, positive, roller_radius, shown
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import Exact, quantity
from optlaws.numbers import Array, NumberOrQuantity
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet, Pair, Term

_NO_CROSSING = 1e-3  # the support of a profile, whose sign is all that counts


class RollerContact(FollowerContact):
    """A roller: its centre runs along the pitch curve, `along` the follower's way and `across` it.

    With p along and q across, both by the angle, tan(alpha) = p/q, and the curvature of the pitch curve, above 0 where
    it bulges outward, is (w (p² + q²) + p q' - q p')/(p² + q²)^(3/2), where w is how fast the follower's way turns
    against the cam.
    """

    lost: ClassVar[int] = 0

    @abstractmethod
    def components(self, s: Jet) -> Pair:
        """The velocity components of the centre along the follower's path and across it, relative to the cam."""

    @abstractmethod
    def rate(self, s: Jet) -> Jet | float:
        """The rotation of the follower's path relative to the cam, per radian."""

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
        excess: Interval = self.curvature(s).terms[0] - 1.0 / (limit + self.roller)
        return excess

    def pitch_curvatures(self, motion: CamMotion) -> tuple[EnclosedExtreme, EnclosedExtreme]:
        return enclosed_extremes(motion, self.curvature, 2)

    def least_convex_radius(self, motion: CamMotion) -> EnclosedExtreme:
        return self._inside(self.pitch_curvatures(motion)[1])

    def extremes(self, motion: CamMotion) -> CamExtremes:
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
class TranslatingRoller(CamFollower, kind="translating roller"):
    """A follower that slides and has a roller.

    Examples
    --------
    >>> TranslatingRoller("12 mm", offset="10 mm").axis
    'length'
    """

    radius: NumberOrQuantity = entry(Measured("length", above=0.0), "Radius of the roller.", example="12 mm")
    offset: NumberOrQuantity = entry(
        Measured("length"),
        "Distance of the slide's line from the cam's centre, above 0 on the side to which the top of a cam moves that "
        "turns clockwise. If the cam turns counterclockwise, it then reduces the pressure angle of the rise.",
        default="0 mm",
    )
    axis: ClassVar[str] = "length"
    lengths: ClassVar[tuple[str, ...]] = ("radius", "offset")
    sizing_limit: ClassVar[str | None] = PRESSURE

    def contact(self, place: Place) -> RollerContact:
        radius, offset = roller_radius(self.radius, place), quantity(self.offset, "length", "roller: offset")
        if abs(offset) >= place.radius:
            raise InputError(
                f"roller: offset {shown(offset)} is beyond the prime circle of radius {shown(place.radius)}: the roller"
                " cannot touch it: make the offset less or the prime circle larger"
            )
        height = sqrt((place.radius - abs(offset)) * (place.radius + abs(offset)))
        return SlidingRoller(place.turning, place.lowest, height, radius, offset)

    def prime_radius(self, level: float) -> float:
        """The way from the cam's centre to the roller's at a height."""
        return hypot(level, quantity(self.offset, "length", "roller: offset"))

    def from_beneath(self) -> TranslatingRoller:
        """The same follower with its offset on the other side."""
        return replace(self, offset=Exact(-quantity(self.offset, "length", "roller: offset"), "m"))


@dataclass(frozen=True)
class SlidingRoller(RollerContact):
    """A sliding roller in numbers: its centre is at x = offset, y = height + s."""

    offset: float

    @property
    def meets_axis(self) -> bool:
        return self.offset == 0.0

    def point(self, s: Jet) -> Pair:
        y = s + (self.level - self.lowest)
        return y * 0.0 + self.offset, y

    def components(self, s: Jet) -> Pair:
        return s.slope() - self.turning * self.offset, s + (self.level - self.lowest)

    def rate(self, s: Jet) -> float:  # noqa: ARG002 - what others of its kind need
        return 1.0

    def curvature_terms(self, displacement: str, slope: str) -> CurvatureTerms:
        along = f"({slope} - ({self.turning * self.offset!r}))"
        across = f"({self.level!r} + {displacement})"
        return CurvatureTerms(along, across, f"{along}^2 + {across}^2 + {along}*{slope}", across)

    def state(self, point: Pair, normal: Pair) -> ContactState:
        height = (self.square_of_centre(point, normal) - self.offset**2).root()
        return self.state_at(height + (self.lowest - self.level), point, normal)

    def transmission(self, s: Jet) -> Transmission:
        tangent = self.pressure(s)
        cosine = 1.0 / (tangent * tangent + 1.0).root()
        return Transmission(cosine, self.rolling(s), tangent * cosine * self.turning, cosine * 0.0)

    def pressure_limits(
        self,
        piece: Piece,
        limit: float,
        angle: float,
        *,
        below: bool,  # noqa: ARG002 - they are exact
    ) -> list[LinearLimit]:
        stroke, size = piece.stroke, abs(piece.stroke)
        high = (self.level - self.lowest + piece.offset) / size
        offset = self.turning * self.offset / (limit * size)
        slope = stroke / (angle * limit * size)
        return [LinearLimit((-stroke / size, sign * slope, 0.0), high + sign * offset) for sign in (1.0, -1.0)]


_LINES, _PARTS, _LOOKS = 16, 24, 2001


@declared
class OscillatingRoller(CamFollower, kind="oscillating roller"):
    """A follower that swings and has a roller.

    Examples
    --------
    >>> OscillatingRoller("12 mm", arm="90 mm", pivot_distance="120 mm").axis
    'angle'
    """

    radius: NumberOrQuantity = entry(Measured("length", above=0.0), "Radius of the roller.", example="14 mm")
    arm: NumberOrQuantity = entry(
        Measured("length", above=0.0), "From the pivot to the roller's centre.", example="110 mm"
    )
    pivot_distance: NumberOrQuantity = entry(
        Measured("length", above=0.0), "From the cam's centre to the pivot.", example="140 mm"
    )
    axis: ClassVar[str] = "angle"
    lengths: ClassVar[tuple[str, ...]] = ("radius", "arm", "pivot_distance")

    def contact(self, place: Place) -> RollerContact:
        radius, arm = roller_radius(self.radius, place), positive(self.arm, "roller: arm")
        distance = positive(self.pivot_distance, "roller: pivot_distance")
        if arm <= abs(distance - place.radius):
            raise InputError(
                f"roller: arm {shown(arm)} is too short: from a pivot {shown(distance)} away it does not reach the base"
                f" circle of radius {shown(place.radius)}: make it longer than {shown(abs(distance - place.radius))}"
            )
        if arm >= distance + place.radius:
            raise InputError(
                f"roller: arm {shown(arm)} is too long: from a pivot {shown(distance)} away it reaches beyond the base"
                f" circle of radius {shown(place.radius)}: make it shorter than {shown(distance + place.radius)}"
            )
        first = acos((distance**2 + arm**2 - place.radius**2) / (2.0 * distance * arm))
        last = first + place.highest - place.lowest
        if not half_turn(last):
            raise InputError(
                f"roller: the arm swings from {degrees(first):.6g} to {degrees(last):.6g} deg from the line to the"
                " cam's centre, through its dead centre at 180 deg: make the swing smaller or the arm longer"
            )
        return SwingingRoller(place.turning, place.lowest, first, radius, arm, distance)

    def prime_radius(self, level: float) -> float:
        """The way from the cam's centre to the roller's at an angle of the arm."""
        arm, pivot = positive(self.arm, "roller: arm"), positive(self.pivot_distance, "roller: pivot_distance")
        return sqrt(arm**2 + pivot**2 - 2.0 * arm * pivot * cos(level))


@dataclass(frozen=True)
class SwingingRoller(RollerContact):
    """A swinging roller in numbers: pivot at x = distance, the arm at psi = first + s from the line to the centre."""

    arm: float
    distance: float
    #: the limit of the pressure angle is a sine of the arm's angle, with lines below and above it
    linear: ClassVar[bool] = False

    def point(self, s: Jet) -> Pair:
        sine, cosine = self._psi(s).waves()
        return cosine * -self.arm + self.distance, sine * self.arm

    def components(self, s: Jet) -> Pair:
        sine, cosine = self._psi(s).waves()
        along = s.slope() * self.arm + (cosine * -self.distance + self.arm) * self.turning
        return along, sine * self.distance

    def rate(self, s: Jet) -> Jet:
        return s.slope() * self.turning + 1.0

    def curvature_terms(self, displacement: str, slope: str) -> CurvatureTerms:
        arm, distance, turning = self.arm, self.distance, self.turning
        psi = f"({self.level!r} + {displacement})"
        along = f"({arm!r}*({slope} + ({turning!r})) - ({turning * distance!r})*cos({psi}))"
        across = f"({distance!r}*sin({psi}))"
        turned = f"(1 + ({turning!r})*{slope})*({along}^2 + {across}^2)"
        swung = f"({distance!r}*{along}*cos({psi}) - ({turning * distance!r})*sin({psi})*{across})*{slope}"
        return CurvatureTerms(along, across, f"{turned} + {swung}", f"({arm!r}*{across})")

    def state(self, point: Pair, normal: Pair) -> ContactState:
        square = self.square_of_centre(point, normal)
        cosine = (square - (self.distance**2 + self.arm**2)) / (-2.0 * self.distance * self.arm)
        psi = (cosine / other_leg(cosine)).arctangent() * -1.0 + 0.5 * pi
        return self.state_at(psi + (self.lowest - self.level), point, normal)

    def transmission(self, s: Jet) -> Transmission:
        tangent = self.pressure(s)
        lever = self.arm / (tangent * tangent + 1.0).root()
        return Transmission(lever, self.rolling(s), lever * 0.0, lever * 0.0)

    def pressure_limits(self, piece: Piece, limit: float, angle: float, *, below: bool) -> list[LinearLimit]:
        return [line for sign in (1.0, -1.0) for line in self._lines(piece, limit, angle, sign=sign, below=below)]

    def _lines(self, piece: Piece, limit: float, angle: float, *, sign: float, below: bool) -> Iterator[LinearLimit]:
        """Lines that bound the region of the pressure angle, sign s' <= G(psi), over the piece's swing.

        Where G is hollow its chords are as good as it is. Where it bulges, a line below it is good at one psi, and
        there is one for every part of the time, at the psi that the piece's law has then; a single one is above it.
        """
        start, size = self.level - self.lowest + piece.offset, abs(piece.stroke)
        sine = _Sine(limit * self.distance / self.arm, sign * self.turning * self.distance / self.arm)
        low, high = sorted((start, start + piece.stroke))
        times = np.linspace(0.0, 1.0, _PARTS + 1).tolist()
        if sine.hollow(low, high):
            lines = [(*line, 0.0, 1.0) for line in sine.chords(low, high, below=below)]
        elif below:
            psi = [start + piece.stroke * float(piece.law.a(0.5 * sum(pair))) for pair in pairwise(times)]
            slopes = [sine.slope(at) for at in psi]
            shifts = [sine.shift(slope, low, high, below=True) for slope in slopes]
            lines = list(zip(slopes, shifts, times, times[1:], strict=False))
        else:
            slope = sine.chord(low, high)
            lines = [(slope, sine.shift(slope, low, high, below=False), 0.0, 1.0)]
        for slope, shift, first, last in lines:
            # sign stroke b / angle - slope stroke a <= slope start + shift - sign turning
            factors = (-slope * piece.stroke / size, sign * piece.stroke / (angle * size), 0.0)
            yield LinearLimit(factors, (slope * start + shift - sign * self.turning) / size, first, last)

    def _psi(self, s: Jet) -> Jet:
        return s + (self.level - self.lowest)


@dataclass(frozen=True)
class _Sine:
    """G = sine sin psi + cosine cos psi."""

    sine: float
    cosine: float

    def value(self, psi: Array) -> Array:
        """The limit G of the slope at angles of the arm."""
        return np.asarray(self.sine * np.sin(psi) + self.cosine * np.cos(psi))

    def slope(self, psi: float) -> float:
        """The derivative of G at an angle of the arm."""
        return float(self.sine * np.cos(psi) - self.cosine * np.sin(psi))

    def chord(self, first: float, last: float) -> float:
        """The slope of a chord."""
        ends = self.value(np.array([first, last]))
        return float((ends[1] - ends[0]) / (last - first))

    def hollow(self, low: float, high: float) -> bool:
        """Whether the function is above its chords between two angles less than half a turn apart."""
        return bool((self.value(np.linspace(low, high, _LOOKS)) >= 0.0).all())

    def shift(self, slope: float, low: float, high: float, *, below: bool) -> float:
        """The offset of a line of given slope that lies below the limit, or above it, between two angles."""
        looks = np.linspace(low, high, _LOOKS)
        off = self.value(looks) - slope * looks
        # between two looks it goes beyond these by less than this
        slack = hypot(self.sine, self.cosine) * float(looks[1] - looks[0]) ** 2
        return float(off.min()) - slack if below else float(off.max()) + slack

    def chords(self, low: float, high: float, *, below: bool) -> list[tuple[float, float]]:
        """Slopes and shifts of lines of which the least is near it where it is hollow, on one side of it."""
        lines = []
        for first, last in pairwise(np.linspace(low, high, _LINES + 1).tolist()):
            slope = self.chord(first, last)
            under = float(self.value(np.array(first))) - slope * first
            lines.append((slope, under if below else self.shift(slope, low, high, below=False)))
        return lines
