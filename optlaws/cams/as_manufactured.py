"""Cams as manufactured: the follower's motion on a profile rounded to a file's digits, or with a profile error."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import inf, pi, tau
from typing import Any, Literal

import numpy as np

from optlaws.cams.curves.approximations import Arcs, arcs, spline
from optlaws.cams.curves.cam_files import DECIMALS, POINTS, Cutting, polar
from optlaws.cams.curves.plane_curve import CurveAlongNormals, Outline, PiecewiseCurve
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.contact import FollowerContact, shifted
from optlaws.echo import unknown_key
from optlaws.entries.declared import Declared, declared, documented_by, entry
from optlaws.entries.value_types import Choice, Listed, Measured, Whole
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.laws.storage import PlainNumbers
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array, NumberOrQuantity
from optlaws.numerics.branch_and_bound import extremes_of_each
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet, Pair, turned, variable
from optlaws.tolerances import DEVIATIONS

_MANUFACTURED_PEAKS = 1e-6  # peaks of a motion as it is manufactured
_MANUFACTURED_JUMP = 1e-6  # of a derivative's greatest value: a smaller jump of a motion as manufactured is none


@dataclass(frozen=True, eq=False)
class PolarSpline(Outline):
    """The curve whose radius is the closed cubic spline through radii at even angles around the centre."""

    radii: Array

    @kept_property
    def _radius(self) -> PiecewiseCurve:
        return PiecewiseCurve.closed(np.linspace(0.0, tau, len(self.radii)), self.radii[:, None])

    @property
    def breaks(self) -> tuple[float, ...]:
        return self._radius.breaks

    def jets(self, places: Array | Interval, order: int) -> Pair:
        """Both coordinates with their Taylor terms by the angle around the centre."""
        (radius,) = self._radius.jets(places, order)
        sine, cosine = variable(places, order).waves()
        return radius * cosine, radius * sine


@dataclass(frozen=True, eq=False)
class ArcChain(Outline):
    """Arcs as a curve: its parameter grows by one along each."""

    arcs: Arcs

    @property
    def breaks(self) -> tuple[float, ...]:
        """The parameters where one arc ends and the next begins."""
        return tuple(float(i) for i in range(len(self.arcs.points) + 1))

    def jets(self, places: Array | Interval, order: int) -> Pair:
        """Both coordinates with their Taylor terms by the parameter."""
        middle = places.middle if isinstance(places, Interval) else np.asarray(places, dtype=np.float64)
        which = np.clip(np.floor(middle).astype(int), 0, len(self.arcs.points) - 1)
        share = variable(places - which.astype(np.float64), order)
        straight = (self.arcs.bulges == 0.0)[:, None]
        # a line is the way along its chord, an arc a radius that turns about its centre
        centres = np.where(straight, self.arcs.points, self.arcs.centres)
        ways, radii = np.where(straight, self.arcs.ends - self.arcs.points, 0.0), self.arcs.points - centres
        x, y = turned(
            (share * 0.0 + radii[which, 0], share * 0.0 + radii[which, 1]),
            share * (4.0 * np.arctan(self.arcs.bulges))[which],
        )
        return x + share * ways[which, 0] + centres[which, 0], y + share * ways[which, 1] + centres[which, 1]


@dataclass(frozen=True)
class WavyCurve(CurveAlongNormals):
    """A curve with a waviness along its normals: periods per turn, amplitude in m, phase in rad."""

    amplitude: float
    waves: int
    shift: float | Array  #: of all places, or of each that is looked at

    @property
    def breaks(self) -> tuple[float, ...]:
        """Breaks of the curve, and every half wave, so that each part is simple."""
        waves = np.linspace(*self.base.interval, 2 * self.waves + 1)
        return tuple(np.unique(np.concatenate([self.base.breaks, waves])).tolist())

    def jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> Pair:
        (x, y), (along_x, along_y) = self.base.frame_jets(angle, order, before=before)
        _, wave = (variable(angle, order) * float(self.waves) + self.shift).waves()
        return x + along_x * wave * self.amplitude, y + along_y * wave * self.amplitude


def spline_through(points: Array) -> PiecewiseCurve:
    """The closed cubic spline through points, m, shape (n, 2), over chord lengths, as drawing programs compute it.

    Its curvature is continuous everywhere; the last point is the first again.
    """
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return PiecewiseCurve.closed(np.append(0.0, np.cumsum(lengths)), points)


_SAMPLES = 721


@dataclass(frozen=True)
class Following:
    """A follower on a closed curve of any parameter: the cam's angle there, and the displacement.

    The follower is taken to touch the curve at one place, as it does where the curve is convex or its concave parts are
    wider than the roller. `phase` turns the cam's coordinates, rad; the curve is `outside` of the profile, m, by the
    radius of the cutter whose path it is.
    """

    contact: FollowerContact
    curve: Outline
    phase: float = 0.0
    outside: float = 0.0
    #: 1 where the curve runs counterclockwise, so that outward is to its right, else -1; by the curve unless given
    outward: Any = None

    def __post_init__(self) -> None:
        """See which side is outward."""
        if self.outward is None:
            object.__setattr__(self, "outward", _outward(self.curve))

    def at(self, places: Array, nu: int) -> tuple[Array, Array]:
        """The cam's angle at places of the curve, rad, and the derivative of order nu of the displacement by it."""
        angle, derivative = self.derivative(places, nu, 0)
        return np.asarray(angle.terms[0]), np.asarray(derivative.terms[0])

    def derivative(self, places: Array | Interval, nu: int, order: int) -> tuple[Jet, Jet]:
        """The cam's angle and the derivative of order nu by it, both with Taylor terms by the curve's parameter."""
        angle, derivative = self.jets(places, nu + order)
        pace = angle.slope()
        for _ in range(nu):
            derivative = derivative.slope() / pace
        return angle, derivative

    def jets(self, places: Array | Interval, order: int) -> tuple[Jet, Jet]:
        """The cam's angle and the displacement, by the curve's parameter."""
        point = self.curve.jets(places, order + 1)
        slopes = (point[0].slope(), point[1].slope())
        length = (slopes[0] * slopes[0] + slopes[1] * slopes[1]).root()
        normal = (slopes[1] / length * self.outward, slopes[0] / length * -self.outward)
        profile = shifted((point[0].cut(order), point[1].cut(order)), normal, -self.outside)
        state = self.contact.state(profile, normal)
        return (state.direction + self.phase - state.in_cam) * self.contact.turning, state.displacement


def _outward(curve: Outline) -> float:
    x, y = curve(np.linspace(curve.breaks[0], curve.breaks[-1], _SAMPLES)).T
    area = float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
    if area == 0.0:
        raise InputError("the curve encloses nothing: no follower runs on it")
    return 1.0 if area > 0.0 else -1.0


MADE_CURVES = ("profile", "pitch")
ManufacturedFormat = Literal["csv", "csv polar", "dxf spline", "svg", "dxf arcs", "g-code arcs"]
_CELLS = 128
_SHIFTS = np.array([0.0, 0.5 * pi, pi, 1.5 * pi])
WAVES = Whole(1, 100_000)
_UNREACHED = (
    "the follower does not reach all of the cam as made: it has corners, or concave parts narrower than the roller; "
    "ask for more decimals, fewer points or waves, or a lesser error"
)


class UnreachedProfileError(InputError):
    """The follower does not touch the whole manufactured profile, so that its motion does not follow the curve."""


@dataclass(frozen=True)
class AsMade(PlainNumbers):
    """The motion of a follower on a cam as manufactured, over the whole turn.

    Deviation, acceleration and jerk are enclosed, and no less than the greatest: by 1e-3 of it the first, by 1e-6 the
    others. Splines are taken as the polynomials between their knots; a jump is what it is next to where parts meet.

    Attributes
    ----------
    deviation
        Greatest difference of its displacement from the intended displacement, m or rad.
    acceleration, jerk
        Greatest second and third derivative of the displacement by the cam's angle, m or rad; at w rad/s they are
        multiplied by w² and w³.
        The jerk is infinite where the acceleration jumps.
    jump
        Greatest jump of the second derivative, m or rad; 0 where it is continuous.
    acceleration_ratio, jerk_ratio
        Those of the second and third derivative over those of the motion that was meant.

    Examples
    --------
    >>> AsMade(1e-6, 0.05, 0.4, 0.0, 1.25, 1.1).acceleration_ratio
    1.25
    """

    deviation: float
    acceleration: float
    jerk: float
    jump: float
    acceleration_ratio: float
    jerk_ratio: float


def run_against(cam: DiscCam, curve: Outline, outside: float = 0.0, *, jumps: bool = True) -> AsMade:
    """The motion of a cam's follower on a closed curve of any parameter, `outside` of the profile, m, in its place.

    With `jumps` those of the acceleration make the jerk infinite; without, it is the greatest between them.
    """
    peaks = _peaks(cam, curve, outside, jumps=jumps)
    if peaks is None:
        raise UnreachedProfileError(_UNREACHED)
    return peaks


def _peaks(
    cam: DiscCam, curve: Outline, outside: float = 0.0, shifts: Array | None = None, *, jumps: bool = True
) -> AsMade | None:
    """The same, or the greatest of a wavy curve with each of several shifts; None where not all of it is reached."""
    if not cam.displacement.closed:
        raise InputError(
            "a manufactured cam is evaluated over a whole turn: build it from a Cycle, with dwells and the return"
        )
    first = Following(cam.contact, curve, quantity(cam.phase, "angle", "phase"), outside)
    edges, count = np.array(curve.breaks), 1 if shifts is None else len(shifts)

    def at(which: Any) -> Following:
        wavy: Any = curve
        return first if shifts is None else replace(first, curve=replace(wavy, shift=shifts[which]))

    inside = edges[:-1, None] + np.multiply.outer(np.diff(edges), np.linspace(0.1, 0.9, 5))
    beside = 1e-9 * np.diff(edges)
    jump = 0.0
    for following in map(at, range(count)):
        rates = np.asarray(following.jets(inside.ravel(), 1)[0].terms[1])
        if rates.min() * rates.max() <= 0.0:  # it turns back, as a roller does in hollows narrower than itself
            return None
        before, after = (following.at(places, 2)[1] for places in (edges[1:] - beside, edges[:-1] + beside))
        jump = max(jump, float(np.abs(np.roll(after, -1) - before).max()))

    def greatest(nu: int) -> float:
        def size(places: Interval, order: int, which: Any) -> Jet:
            angle, derivative = at(which).derivative(places, nu, order)
            return derivative if nu else (derivative - cam.displacement.along(angle)).cut(order)

        share, parts = _MANUFACTURED_PEAKS if nu else DEVIATIONS, max(1, _CELLS // len(edges))
        known = extremes_of_each(size, [edges] * count, share=share, parts=[parts] * count, magnitude=True)
        return max(each.bound for each in known)

    deviation, acceleration = greatest(0), greatest(2)
    if max(deviation, acceleration) == inf:
        return None
    jump = jump if jump > _MANUFACTURED_JUMP * acceleration else 0.0
    jerk = inf if jumps and jump else greatest(3)
    if jerk == inf and not (jumps and jump):
        return None
    return AsMade(deviation, acceleration, jerk, jump, acceleration / _meant(cam, 2), jerk / _meant(cam, 3))


def _meant(cam: DiscCam, nu: int) -> float:
    return max(abs(value) for stretch in cam.displacement.stretches for value in stretch.extremes(nu))


@documented_by(Cutting)
def as_made(
    cam: DiscCam,
    form: ManufacturedFormat = "csv",
    *,
    curve: Literal["profile", "pitch"] = "profile",
    points: int = 721,
    decimals: int = 6,
    tolerance: NumberOrQuantity = "1 um",
    degree: int = 3,
) -> AsMade:
    """The motion of a cam's follower if the cam is cut from a file with the rounding and tolerance of its entries.

    Points of a table are joined by the cubic spline with continuous curvature that drawing programs draw, radii of a
    polar table by such a spline over the angle. A spline is cut as it is in the file, and so are arcs, under which the
    acceleration jumps from arc to arc.

    Parameters
    ----------
    cam
        The cam.
    form
        The format: "csv", "csv polar", "dxf spline", "svg", "dxf arcs" or "g-code arcs".
    curve
        "profile", or "pitch", whose points a machine is given that offsets them itself.

    Raises
    ------
    InputError
        If the format is unknown or makes corners, where a follower's velocity jumps.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Return, Rise
    >>> from optlaws import TranslatingRoller
    >>> moves = [Rise("40 mm", "120 deg", law="3-4-5"), Dwell("60 deg"), Return(law="3-4-5")]
    >>> cam = DiscCam(Cycle(moves, speed="200 rpm"), prime_radius="80 mm", follower=TranslatingRoller("12 mm"))
    >>> [round(as_made(cam, points=361, decimals=decimals).acceleration_ratio, 3) for decimals in (3, 4)]
    [1.188, 1.026]
    """
    if form not in _CURVES_OF:
        raise InputError(
            f"{unknown_key(form, _CURVES_OF, 'format')}; polygons have corners, where the follower's velocity jumps"
        )
    outline, outside = _cut(cam, curve)
    return run_against(cam, _CURVES_OF[form](outline, Cutting(tolerance, decimals, points, degree)), outside)


@declared
class PeaksAsMade(Declared, title="peaks as made"):
    """The files whose executed motion is reported: tables of a number of points and decimals, and profile errors."""

    points: tuple[int, ...] = entry(Listed(POINTS, most=10), "Numbers of points of the tables.", default=(361, 721))
    decimals: tuple[int, ...] = entry(
        Listed(DECIMALS, most=10), "Decimals of a millimetre in the tables.", default=(3, 4, 6)
    )
    curve: str = entry(Choice(*MADE_CURVES), "Of the tables.", default="profile")
    error: NumberOrQuantity | None = entry(
        Measured("length", above=0.0), "Of the profile: the amplitude of its waves.", default=None, example="0.01 mm"
    )
    waves: tuple[int, ...] = entry(Listed(WAVES, most=10), "Of the error, in a turn.", default=(3, 12))

    def of(self, cam: DiscCam) -> dict[str, AsMade | None]:
        """Peaks of a cam by what it is cut from; None where its follower does not reach all of it."""
        outline, outside = _cut(cam, self.curve)
        tables = [Cutting(points=points, decimals=decimals) for points in self.points for decimals in self.decimals]
        names = (f"{each.points} points of the {self.curve}, {each.decimals} decimals of a mm" for each in tables)
        peaks = {name: _peaks(cam, _points(outline, each), outside) for name, each in zip(names, tables, strict=True)}
        if self.error is not None:
            names = (f"error of {self.error}, {count} waves a turn" for count in self.waves)
            peaks |= zip(names, profile_errors(cam, self.error, self.waves), strict=True)
        return peaks


def _cut(cam: DiscCam, curve: str) -> tuple[Outline, float]:
    """The curve of the cam that its files describe, and how far it is outside of the profile, m."""
    check_names([curve], MADE_CURVES, "curve")
    return (cam.profile, 0.0) if curve == "profile" else (cam.pitch_curve, cam.contact.roller)


def with_profile_error(cam: DiscCam, error: NumberOrQuantity, waves: Any) -> AsMade:
    """The motion of a cam's follower if the profile is off by waves of an amplitude along its normals.

    Of four phases of the wave, the greatest values. A wave with n periods in a turn adds about n² times its amplitude
    to the second derivative by the cam's angle, and n³ times to the third. The jerk is the greatest between places
    where the cam's own jumps, at which the error makes the acceleration jump a little.

    Parameters
    ----------
    cam
        The cam.
    error
        The amplitude, such as "0.1 mm" where the profile is within ±0.1 mm.
    waves
        Periods over the turn.

    Raises
    ------
    InputError
        If the error is no length above 0.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Return, Rise
    >>> from optlaws import TranslatingRoller
    >>> moves = [Rise("40 mm", "120 deg", law="3-4-5"), Dwell("60 deg"), Return(law="3-4-5")]
    >>> cam = DiscCam(Cycle(moves, speed="200 rpm"), prime_radius="80 mm", follower=TranslatingRoller("12 mm"))
    >>> round(with_profile_error(cam, "0.01 mm", waves=3).acceleration_ratio, 3)
    1.002
    """
    (peaks,) = profile_errors(cam, error, [waves])
    if peaks is None:
        raise UnreachedProfileError(_UNREACHED)
    return peaks


def profile_errors(cam: DiscCam, error: NumberOrQuantity, waves: Sequence[Any]) -> list[AsMade | None]:
    """What `with_profile_error` finds of so many waves each; None where the follower does not reach all of the cam."""
    amplitude = quantity(error, "length", "error", above=0.0)
    curves = (WavyCurve(cam.profile, amplitude, WAVES.read(count, "waves"), 0.0) for count in waves)
    return [_peaks(cam, curve, shifts=_SHIFTS, jumps=False) for curve in curves]


def _points(outline: Outline, options: Cutting) -> PiecewiseCurve:
    return spline_through(_rounded(outline(np.linspace(0.0, tau, options.points)), options.decimals))


def _rounded(values: Array, decimals: int) -> Array:
    """Points or radii of a turn with so many decimals of a millimetre; the last is the first again."""
    rounded = 1e-3 * np.round(1e3 * values, decimals)
    rounded[-1] = rounded[0]
    return np.asarray(rounded)


def _splined(outline: Outline, options: Cutting) -> Outline:
    return spline(outline, options.metres, options.degree)


_CURVES_OF: dict[str, Callable[[Outline, Cutting], Outline]] = {
    "csv": _points,
    "csv polar": lambda outline, options: PolarSpline(_rounded(polar(outline, options.points), options.decimals)),
    "dxf spline": _splined,
    "svg": _splined,
    "dxf arcs": lambda outline, options: ArcChain(arcs(outline, options.metres)),
    "g-code arcs": lambda outline, options: ArcChain(arcs(outline, options.metres)),
}
