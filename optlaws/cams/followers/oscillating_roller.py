"""A roller on an arm that swings about a pivot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import acos, cos, degrees, hypot, pi, sqrt
from typing import ClassVar

import numpy as np

from optlaws.cams.followers.contact import ContactState, CurvatureTerms, LinearLimit, Transmission, other_leg
from optlaws.cams.followers.follower import CamFollower, Place, positive, roller_radius, shown
from optlaws.cams.followers.rollers_and_faces import RollerContact, half_turn
from optlaws.entries.declared import declared, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.motion.piece import Piece
from optlaws.numbers import Array, Quantity
from optlaws.numerics.taylor import Jet, Pair

_LINES, _PARTS, _LOOKS = 16, 24, 2001


@declared
class OscillatingRoller(CamFollower, kind="oscillating roller"):
    """A follower that swings and has a roller.

    Examples
    --------
    >>> OscillatingRoller("12 mm", arm="90 mm", pivot_distance="120 mm").axis
    'angle'
    """

    radius: Quantity = entry(Measured("length", above=0.0), "Radius of the roller.", example="14 mm")
    arm: Quantity = entry(Measured("length", above=0.0), "From the pivot to the roller's centre.", example="110 mm")
    pivot_distance: Quantity = entry(
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
        return SwingingRoller(place.turning, place.lowest, first, arm, distance, radius)

    def prime_radius(self, level: float) -> float:
        """The way from the cam's centre to the roller's at an angle of the arm."""
        arm, pivot = positive(self.arm, "roller: arm"), positive(self.pivot_distance, "roller: pivot_distance")
        return sqrt(arm**2 + pivot**2 - 2.0 * arm * pivot * cos(level))

    @property
    def pivot(self) -> Quantity:
        """The distance of the pivot from the cam's centre."""
        return self.pivot_distance


@dataclass(frozen=True)
class SwingingRoller(RollerContact):
    """A swinging roller in numbers: pivot at x = distance, the arm at psi = first + s from the line to the centre."""

    arm: float
    distance: float
    radius: float

    @property
    def roller(self) -> float:
        """The radius of the roller in metres."""
        return self.radius

    @property
    def pivot(self) -> float:
        return self.distance

    @property
    def linear(self) -> bool:
        """False, as the limit of the pressure angle is a sine of the arm's angle, with lines below and above it."""
        return False

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
