"""Limits of a cam, the least prime circle that keeps them, the greatest roller, and the best offset, with proofs.

Which prime circles break a limit is shown from below: at the angle of the cam where a limit is broken worst, the prime
circle grows until it holds there, and this again until it holds all around. These angles then are witnesses: over
every range of smaller prime circles one of them is proven to break its limit, with the range itself as an enclosure.

An offset lessens the pressure angle on one way and adds to it on the other. Where both are as great the offset is best:
every other breaks the angle at one of two places of the turn, as is shown for all offsets at once by intervals of them.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from math import atan, degrees, pi, sqrt, tan
from typing import Any, NamedTuple, Self, TypeVar

import numpy as np

from optlaws.cams.curves.extremes import CamExtremes
from optlaws.cams.curves.motion_by_angle import CamMotion, as_motion
from optlaws.cams.disc import DiscCam, Turning, sense
from optlaws.cams.followers.contact import CURVATURE, PRESSURE, FollowerContact
from optlaws.cams.followers.follower import CamFollower, Place, positive, shown
from optlaws.cams.followers.rollers import TranslatingRoller
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, documented_by, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.kept import kept_property
from optlaws.motion.quantities import Exact, in_degrees, quantity
from optlaws.numbers import Array, NumberOrQuantity
from optlaws.numerics.interval import Interval, between, exact
from optlaws.numerics.peaks import is_kept
from optlaws.numerics.roots import bisect, bracketed_root, holds_throughout
from optlaws.numerics.taylor import Jet
from optlaws.sentences import Amount, Sentence, joined, sentence
from optlaws.tolerances import CAM_FEASIBILITY, ROUNDOFF, SIZE_BRACKET


@declared
class CamLimits(Declared, title="limits of a cam"):
    """Limits that a cam is to keep all around.

    Examples
    --------
    >>> print(CamLimits("30 deg", "5 mm"))
    a pressure angle of 30 deg and a radius of curvature of 5 mm
    """

    pressure_angle: NumberOrQuantity | None = entry(
        Measured("angle"),
        "The greatest magnitude of the pressure angle.",
        default=None,
        label="pressure ≤",
        example="30 deg",
    )
    radius_of_curvature: NumberOrQuantity | None = entry(
        Measured("length", least=0.0),
        "The least radius of curvature of the profile where it is convex.",
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


_SIZE_MARGIN = 1e-10  # of a radius: by how much more than needed it grows at last
_SIZE_NUDGE = 1e-9  # of a radius: a step to where a limit is proven to be kept
_SAME_ANGLE = 32.0 * ROUNDOFF  # of a limit: an angle that is the limit itself, but for its tangent's rounding
_SMALLEST_BASE = 1e-6  # of the greatest length of a mechanism: the smallest prime circle that is looked at

Kind = TypeVar("Kind", bound=FollowerContact)

_NUDGES = 6
_STEPS, _LOOKS = 60, 150
_LARGEST = 1e3


@dataclass(frozen=True)
class Witness:
    """The place where a limit is broken: which one, at which angle of the cam in rad, seen from which side."""

    limit: str
    angle: float
    sign: float
    before: bool


@dataclass(frozen=True)
class LeastPrimeCircle:
    """The least prime circle that keeps limits; with a given roller the base circle is least too.

    Attributes
    ----------
    radius
        Radius of the prime circle, m. Its cam is proven to keep the limits all around.
    too_small
        Every prime circle up to this radius breaks a limit or has no such mechanism, m; 1e-8 less, relatively.
    proven
        Whether that is proven for every smaller prime circle; if not, for `too_small` alone.
    limit, angle
        Which limit is broken first, and at which angle of the cam, rad; "mechanism" where there is none below.
    cam
        The cam with this prime circle; `cam.base_radius` is the radius of its base circle, m.
    """

    radius: float
    too_small: float
    proven: bool
    limit: str
    angle: float
    cam: DiscCam


@documented_by(CamLimits)
def least_prime_circle(
    motion: Cycle | Plan | CamMotion,
    follower: CamFollower,
    *,
    pressure_angle: NumberOrQuantity | None = None,
    radius_of_curvature: NumberOrQuantity | None = None,
    turning: Turning = "counterclockwise",
) -> LeastPrimeCircle:
    """The least prime circle under a pressure-angle limit, a least radius of curvature of the profile, or both.

    Parameters
    ----------
    motion, follower, turning
        As of a `DiscCam`.

    Raises
    ------
    InputError
        If neither limit is given, or one is out of range.
    InfeasibleProblem
        If no prime circle keeps them.

    Examples
    --------
    >>> from optlaws import TranslatingFlat
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> least = least_prime_circle(rise, TranslatingFlat(), radius_of_curvature="15 mm")
    >>> round(1e3 * least.radius, 6), least.proven, least.limit
    (36.32799, True, 'radius of curvature')
    """
    limits = CamLimits(pressure_angle, radius_of_curvature).of_one()
    sizes = _Sizes(as_motion(motion, follower.axis), follower, sense(turning), limits)
    radius = start = sizes.least
    witnesses: list[Witness] = []
    for _ in range(_STEPS):
        broken = sizes.witnesses(radius)
        if not broken:
            break
        witnesses += broken
        radius = max(radius, *(sizes.least_meeting(witness, radius) for witness in broken)) * (1.0 + _SIZE_MARGIN)
    for _ in range(_NUDGES):  # to where it is not only not broken but proven to be kept
        if not sizes.witnesses(radius, proven=True):
            break
        radius *= 1.0 + _SIZE_NUDGE
    else:
        raise InfeasibleProblem(f"no prime circle was found that keeps {limits}: give wider limits")
    cam = DiscCam(motion, Exact(radius, "m"), follower, turning=turning)
    last = witnesses[-1] if witnesses else Witness("mechanism", 0.0, 1.0, before=False)
    below = radius * (1.0 - SIZE_BRACKET)
    proven = not witnesses or below <= start or sizes.breaks_between(start, below, witnesses[::-1])
    return LeastPrimeCircle(radius, max(below, start), proven, last.limit, last.angle, cam)


@dataclass(frozen=True)
class GreatestRoller:
    """The greatest roller for a prime circle: the smaller radius is proven to be free of undercut, the larger not, m.

    Attributes
    ----------
    radius, too_large
        The bracket.
    angle
        Where the larger one cuts, rad.
    """

    radius: float
    too_large: float
    angle: float


def greatest_roller(cam: DiscCam, *, radius_of_curvature: NumberOrQuantity = "0 mm") -> GreatestRoller:
    """The greatest roller with which the profile of a cam keeps a radius of curvature; its prime circle stays.

    Parameters
    ----------
    cam
        With a roller, whose radius does not matter.
    radius_of_curvature
        The least one that the profile is to have where it bulges.

    Raises
    ------
    InputError
        If the cam has no roller, or no roller keeps the radius.

    Examples
    --------
    >>> from optlaws import TranslatingRoller
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> roller = greatest_roller(DiscCam(rise, "60 mm", TranslatingRoller("12 mm")), radius_of_curvature="5 mm")
    >>> round(1e3 * roller.radius, 6), bool(roller.too_large - roller.radius < 1e-10)
    (55.0, True)
    """
    least = quantity(radius_of_curvature, "length", "radius_of_curvature")
    greatest = cam.contact.pitch_curvatures(cam.displacement)[1]
    low, high = (1.0 / value - least for value in (greatest.high, greatest.low))
    if low <= 0.0:
        raise InputError(
            sentence(
                "radius_of_curvature: the pitch curve itself has {} at {}, so that no roller leaves {}: make the prime "
                "circle larger",
                shown(1.0 / greatest.low), in_degrees(greatest.angle), shown(least),
            )
        )  # fmt: skip
    slack = 8.0 * ROUNDOFF * (1.0 / greatest.low + abs(least))
    return GreatestRoller(low - slack, high + slack, greatest.angle)


@dataclass(frozen=True)
class _Sizes:
    """Cams that differ by their prime circle, and the limits that they keep or break."""

    motion: CamMotion
    follower: CamFollower
    turning: float
    limits: CamLimits

    @property
    def least(self) -> float:
        """The least prime circle for which the mechanism exists, m."""
        rising = self._scale * np.geomspace(_SMALLEST_BASE, _LARGEST, _LOOKS)
        fit = next((i for i, radius in enumerate(rising) if self._fits(radius)), None)
        if fit is None:
            raise InfeasibleProblem("no prime circle fits the follower: give it other sizes")
        if fit == 0:
            return float(rising[0])
        return bisect(self._fits, float(rising[fit]), float(rising[fit - 1]), 100)[0] * (1.0 + 1e-9)

    @property
    def _scale(self) -> float:
        low, high = self.motion.range
        return max(high - low if self.motion.axis == "length" else 0.0, self.follower.size)

    def _fits(self, radius: float) -> bool:
        try:
            self.contact(radius)
        except InputError:
            return False
        return True

    def contact(self, radius: float) -> FollowerContact:
        """The contact with a prime circle."""
        return self.follower.contact(Place(radius, *self.motion.range, self.motion.slopes, self.turning))

    def witnesses(self, radius: float, *, proven: bool = False) -> list[Witness]:
        """The places of the worst violations of limits; with `proven`, places where limits are not proven to hold."""
        contact, broken = self.contact(radius), []
        if self.limits.pressure is not None:
            least, greatest = contact.pressure_angles(self.motion)
            most = self.limits.pressure
            for side, sign in ((greatest, 1.0), (-least, -1.0)):
                if not is_kept(side.high if proven else side.low, most, _SAME_ANGLE):
                    broken.append(self._seen(PRESSURE, side.angle, sign, radius))
        if self.limits.radius is not None:
            margin, least_radius = contact.least_convex_radius(self.motion), self.limits.radius
            if (margin.low if proven else margin.high) < least_radius:
                broken.append(self._seen(CURVATURE, margin.angle, 1.0, radius))
        return broken

    def _seen(self, limit: str, angle: float, sign: float, radius: float) -> Witness:
        """The witness from the side of a break on which the limit is broken more."""
        sides = [Witness(limit, angle, sign, before) for before in (False, True)]
        return max(
            sides, key=lambda witness: float(self._excess(self.contact(radius), witness, self._jet(witness)).middle)
        )

    def least_meeting(self, witness: Witness, radius: float) -> float:
        """The least radius, from a given one on, for which a limit holds at a witness's angle."""
        jet = self._jet(witness)

        def excess(size: float) -> float:
            return float(self._excess(self.contact(size), witness, jet).middle)

        last = radius
        if excess(radius) <= 0.0:
            return radius
        for size in (radius + self._scale * np.geomspace(_SMALLEST_BASE, _LARGEST, _LOOKS)).tolist():
            try:
                meets = excess(size) <= 0.0
            except InputError:  # no such mechanism
                break
            if meets:
                return bracketed_root(excess, last, size)
            last = size
        raise InfeasibleProblem(
            sentence(
                "no prime circle keeps {}: at {} of the cam the {} breaks it with every one up to {}: give wider "
                "limits, or spread the motion",
                self.limits, in_degrees(witness.angle), witness.limit, shown(last),
            )
        )  # fmt: skip

    def breaks_between(self, low: float, high: float, witnesses: list[Witness]) -> bool:
        """Whether every prime circle in a range is proven to violate a limit at one of the witnesses' angles."""
        jets = [(witness, self._jet(witness)) for witness in witnesses]

        def breaks(first: float, last: float) -> bool:
            contact = _spanning(self.contact(first), self.contact(last))
            return any(bool(self._excess(contact, witness, jet).low > 0.0) for witness, jet in jets)

        return holds_throughout(breaks, low, high)

    def _jet(self, witness: Witness) -> Jet:
        return self.motion.jet(exact(witness.angle), 2, before=witness.before)

    def _excess(self, contact: FollowerContact, witness: Witness, s: Jet) -> Interval:
        """The excess over a limit, above 0 where it is broken; multiplied out, so that nothing is divided by."""
        limit = self.limits.in_si[witness.limit]
        if witness.limit == CURVATURE:
            return contact.curvature_excess(s, limit)
        excess: Interval = contact.pressure(s).terms[0] * witness.sign - limit
        return excess


def _spanning(smaller: Kind, larger: Kind) -> Kind:
    """A contact whose prime circle is anywhere between two."""
    changed: dict[str, Any] = {}
    for name in (field.name for field in fields(smaller)):
        first, last = getattr(smaller, name), getattr(larger, name)
        if first != last:
            middle = 0.5 * (first + last)
            radius = 0.5 * abs(last - first) + 16.0 * ROUNDOFF * (abs(first) + abs(last))
            changed[name] = Interval(np.array(middle), np.array(radius))
    return replace(smaller, **changed)


_OFFSET_SETTLED = 1e-12  # of a pressure angle: at the places that an offset is sought by it is the greatest to so much

_OFFSET_PLACES, _OFFSET_STEPS = 361, 30


class _Offsets(NamedTuple):
    """Offsets of a slide over a prime circle, and the tangents of pressure angles at places with them."""

    radius: float
    lowest: float
    turning: float

    def tangents(self, offset: float, s: Array, slope: Array) -> Array:
        """The tangents of the pressure angle at offsets, where the follower has a displacement and a slope."""
        level = sqrt((self.radius - abs(offset)) * (self.radius + abs(offset)))
        return np.asarray((slope - self.turning * offset) / (level + s - self.lowest))

    def beyond(self, tangent: float, s: Interval, slope: Interval, low: float, high: float) -> bool:
        """Whether every offset in a range is proven to exceed a tangent of the pressure angle somewhere."""
        least, most = (0.0 if low <= 0.0 <= high else min(abs(low), abs(high))), max(abs(low), abs(high))
        levels = (sqrt((self.radius - size) * (self.radius + size)) for size in (most, least))
        lower, upper = (level * (1.0 + way * 8.0 * ROUNDOFF) for level, way in zip(levels, (-1.0, 1.0), strict=True))
        along = slope - between(np.array(low), np.array(high)) * self.turning
        across = (s - self.lowest + between(np.array(lower), np.array(upper))) * tangent
        return bool(np.any((along - across).low > 0.0) or np.any((-along - across).low > 0.0))


@dataclass(frozen=True)
class BestOffset:
    """The offset of a slide with the least greatest pressure angle.

    Attributes
    ----------
    offset
        As of a `TranslatingRoller`, m.
    pressure_angle
        The greatest magnitude over the turn, enclosed from above, rad.
    lower_bound
        No offset has less, rad.
    proven
        Whether that is proven for every one of them.
    angles
        Angles of the cam at which the pressure angle is greatest and least, rad.
    cam
        The cam with the offset.
    """

    offset: float
    pressure_angle: float
    lower_bound: float
    proven: bool
    angles: tuple[float, float]
    cam: DiscCam


def best_offset(
    motion: Cycle | Plan | CamMotion,
    prime_radius: NumberOrQuantity,
    follower: TranslatingRoller,
    *,
    turning: Turning = "counterclockwise",
) -> BestOffset:
    """The offset, or eccentricity, with which the pressure angle is as great on the way up as on the way back.

    No other one has a smaller greatest pressure angle over the whole motion.

    Parameters
    ----------
    motion, prime_radius, turning
        As of a `DiscCam`: the prime circle keeps its radius.
    follower
        A roller on a slide, whose own offset does not matter.

    Raises
    ------
    InputError
        If the follower is of another kind, or there is no such cam.

    Examples
    --------
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> best = best_offset(rise, "60 mm", TranslatingRoller("12 mm"))
    >>> round(1e3 * best.offset, 4), round(float(np.degrees(best.pressure_angle)), 4), best.proven
    (16.4239, 15.8865, True)
    """
    if not isinstance(follower, TranslatingRoller):
        raise InputError(f"follower must be a TranslatingRoller, whose slide has an offset, got {shortened(follower)}")
    radius, course = positive(prime_radius, "prime_radius"), as_motion(motion, follower.axis)
    offsets = _Offsets(radius, course.range[0], sense(turning))
    angles = np.unique([*np.linspace(*course.interval, _OFFSET_PLACES), *course.monotone_edges])
    last = np.inf
    for _ in range(_OFFSET_STEPS):
        s, slope = (np.asarray(term) for term in course.jet(angles, 1).terms)
        offset = _balanced(offsets, s, slope)
        cam = DiscCam(motion, prime_radius, replace(follower, offset=Exact(offset, "m")), turning=turning)
        ends = cam.extremes.pressure_angles
        reached, greatest = float(np.abs(offsets.tangents(offset, s, slope)).max()), max(-ends[0].low, ends[1].high)
        if greatest <= atan(reached) * (1.0 + _OFFSET_SETTLED) or abs(offset - last) <= ROUNDOFF * radius:
            break
        last, angles = offset, np.append(angles, [end.angle for end in ends])
    tangents = offsets.tangents(offset, s, slope)
    worst = angles[[int(np.argmax(tangents)), int(np.argmin(tangents))]]
    bound = reached * (1.0 - SIZE_BRACKET)
    at = course.jet(exact(worst), 1).terms
    proven = reached == 0.0 or holds_throughout(
        lambda low, high: offsets.beyond(bound, at[0], at[1], low, high), -radius, radius
    )
    return BestOffset(offset, greatest, atan(bound), proven, (float(worst[0]), float(worst[1])), cam)


def _balanced(offsets: _Offsets, s: Array, slope: Array) -> float:
    """The offset with which tangents at some places are as great to both sides."""

    def leaning(offset: float) -> float:
        tangents = offsets.tangents(offset, s, slope)
        return float(tangents.max() + tangents.min())

    most = offsets.radius * (1.0 - SIZE_BRACKET)
    return bracketed_root(leaning, -most, most)
