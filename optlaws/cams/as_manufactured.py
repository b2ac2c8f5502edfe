"""Cams as manufactured: the follower's motion on a profile rounded to a file's digits, or with a profile error."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import inf, pi, tau
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.curves.arcs_and_chords import Arcs, arcs
from optlaws.cams.curves.cam_files import polar
from optlaws.cams.curves.file_options import Cutting
from optlaws.cams.curves.outline import Outline
from optlaws.cams.curves.plane_curve import CurveAlongNormals, CurveAtEachPlace, CurveByJets, PiecewiseCurve
from optlaws.cams.curves.spline import spline
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.contact import FollowerContact, shifted
from optlaws.entries.value_types import Whole
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws.storage import PlainNumbers
from optlaws.motion.quantities import positive_quantity, quantity
from optlaws.numbers import Array, Quantity
from optlaws.numerics.branch_and_bound import extremes_of_each
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet, Pair, turned, variable
from optlaws.suggest import unknown_key
from optlaws.tolerances import DEVIATIONS

_MANUFACTURED_PEAKS = 1e-6  # peaks of a motion as it is manufactured
_MANUFACTURED_JUMP = 1e-6  # of a derivative's greatest value: a smaller jump of a motion as manufactured is none


@dataclass(frozen=True, eq=False)
class PolarSpline(CurveByJets):
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
class ArcChain(CurveByJets):
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
    """A curve with a waviness along its normals: periods per turn, amplitude in m, phase in rad.

    Periods and shifts may be those of each place at which several such curves are looked at together.
    """

    amplitude: float
    waves: int | NDArray[np.int_]
    shift: float | Array

    @property
    def breaks(self) -> tuple[float, ...]:
        """Breaks of the curve, and every half wave, so that each part is simple."""
        waves = np.linspace(*self.base.interval, 2 * int(self.waves) + 1)
        return tuple(np.unique(np.concatenate([self.base.breaks, waves])).tolist())

    def jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> Pair:
        (x, y), (along_x, along_y) = self._frame(angle, order, before=before)
        _, wave = (variable(angle, order) * np.asarray(self.waves, dtype=np.float64) + self.shift).waves()
        return x + along_x * wave * self.amplitude, y + along_y * wave * self.amplitude

    def _frame(self, angle: Array | Interval, order: int, *, before: bool) -> tuple[Pair, Pair]:
        """Points and normals of the curve without the error, of places that are looked at for several shifts once."""
        if isinstance(self.shift, float) or not isinstance(angle, Interval):
            return self.base.frame_jets(angle, order, before=before)
        _, first, back = np.unique(angle.middle + 1j * angle.radius, return_index=True, return_inverse=True)
        point, normal = self.base.frame_jets(angle[first], order, before=before)
        return _at(point, back), _at(normal, back)


def _at(pair: Pair, which: NDArray[np.intp]) -> Pair:
    """A pair of jets at some of its places, in some order."""
    x, y = (Jet(tuple(term[which] for term in jet.terms)) for jet in pair)
    return x, y


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

    The follower is taken to touch the curve at one place, as it does where the curve bulges outward or its hollows are
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
_SHIFTS = (0.0, 0.5 * pi, pi, 1.5 * pi)
WAVES = Whole(1, 100_000)
_UNREACHED = (
    "the follower does not reach all of the cam as made: it has corners or hollows narrower than the roller; "
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
    following = _following(cam, curve, outside)
    return _reached(_runs(cam, [following], lambda _: following, jumps=jumps)[0])


def _reached(peaks: AsMade | None) -> AsMade:
    if peaks is None:
        raise UnreachedProfileError(_UNREACHED)
    return peaks


def _following(cam: DiscCam, curve: Outline, outside: float = 0.0) -> Following:
    if not cam.displacement.closed:
        raise InputError(
            "a manufactured cam is evaluated over a whole turn: build it from a Cycle, with dwells and the return"
        )
    return Following(cam.contact, curve, quantity(cam.phase, "angle", "phase"), outside)


def _runs(
    cam: DiscCam, followings: Sequence[Following], at: Callable[[NDArray[np.intp]], Following], *, jumps: bool
) -> list[AsMade | None]:
    """The follower's motions on similar curves; `at` gives the motion of each place by the index of its curve.

    None for a curve that the follower does not reach all of. A step of the search takes as long for a thousand places
    as for one: all curves share it.
    """
    edges = [np.array(following.curve.breaks) for following in followings]

    def greatest(pairs: Sequence[tuple[int, int]]) -> dict[tuple[int, int], float]:
        orders, curves = np.array(pairs, dtype=np.intp).reshape(-1, 2).T
        terms = _MotionTerms(cam, at)
        known_extremes = extremes_of_each(
            lambda places, order, which: terms.of_each(places, order, orders[which], curves[which]),
            [edges[i] for i in curves],
            share=[_MANUFACTURED_PEAKS if nu else DEVIATIONS for nu in orders],
            parts=[max(1, _CELLS // len(edges[i])) for i in curves],
            magnitude=True,
        )
        return {pair: each.bound for pair, each in zip(pairs, known_extremes, strict=True)}

    known = [i for i, reached in enumerate(_reached_each(edges, at)) if reached]
    beside = dict(zip(known, _jumps(known, edges, at), strict=True))
    smooth = [i for i in known if not jumps or beside[i][0] <= _MANUFACTURED_JUMP * beside[i][1]]
    bounds = greatest([(0, i) for i in known] + [(2, i) for i in known] + [(3, i) for i in smooth])
    known = [i for i in known if max(bounds[0, i], bounds[2, i]) < inf]
    jumping = {i: jump if jump > _MANUFACTURED_JUMP * bounds[2, i] else 0.0 for i in known for jump in beside[i][:1]}
    endless = [i for i in known if jumps and jumping[i]]
    bounds |= greatest([(3, i) for i in known if (3, i) not in bounds and i not in endless])
    jerks = {i: inf if i in endless else bounds[3, i] for i in known if i in endless or bounds[3, i] < inf}
    means = [_meant(cam, nu) for nu in (2, 3)] if jerks else []
    cases: list[AsMade | None] = [None] * len(edges)
    for i, jerk in jerks.items():
        ratios = bounds[2, i] / means[0], jerk / means[1]
        cases[i] = AsMade(bounds[0, i], bounds[2, i], jerk, jumping[i], *ratios)
    return cases


@dataclass(frozen=True)
class _MotionTerms:
    """Deviations and derivatives of motions on similar curves at places that searches for their extremes look at."""

    cam: DiscCam
    at: Callable[[NDArray[np.intp]], Following]

    def of_each(self, places: Interval, order: int, orders: NDArray[np.intp], curves: NDArray[np.intp]) -> Jet:
        """The deviation where the order of a derivative is 0, else that derivative; places come by these orders."""
        off, second, third = (np.flatnonzero(orders == nu) for nu in (0, 2, 3))
        alike = [_same(places, curves, second, other) for other in (third, off)]
        parts = [] if alike[1] or not len(off) else [self._off(*self._motion(places, order, curves, off), order)]
        looked = second if alike[0] else np.concatenate([second, third])
        if len(looked):
            angle, displacement = self._motion(places, order + 3 if len(third) else order + 2, curves, looked)
            if alike[1]:
                parts.append(self._off(angle.cut(order), displacement.cut(order), order))
            derivative, pace = displacement, angle.slope()
            for nu in (1, 2):
                derivative = derivative.slope() / pace
                if nu == 2 and len(second):
                    parts.append(_some(derivative.cut(order), slice(len(second))))
            if len(third):
                rest = slice(0 if alike[0] else len(second), None)
                parts.append(_some(derivative, rest).slope() / _some(pace, rest))
        return _one_after_another(parts)

    def _motion(
        self, places: Interval, order: int, curves: NDArray[np.intp], here: NDArray[np.intp]
    ) -> tuple[Jet, Jet]:
        return self.at(curves[here]).jets(places[here], order)

    def _off(self, angle: Jet, displacement: Jet, order: int) -> Jet:
        return (displacement - self.cam.displacement.along(angle)).cut(order)


def _same(places: Interval, curves: NDArray[np.intp], some: NDArray[np.intp], others: NDArray[np.intp]) -> bool:
    """Whether some of the places are the others too, as when a search begins."""
    values = places.middle, places.radius, curves
    return len(some) > 0 and all(np.array_equal(each[some], each[others]) for each in values)


def _some(jet: Jet, places: Any) -> Jet:
    return Jet([term[places] for term in jet.terms])


def _one_after_another(jets: Sequence[Jet]) -> Jet:
    """A jet at the places of all jets."""
    columns = zip(*(jet.terms for jet in jets), strict=True)
    return Jet(
        [
            Interval(*(np.concatenate([getattr(term, name) for term in column]) for name in ("middle", "radius")))
            for column in columns
        ]
    )


def _reached_each(edges: Sequence[Array], at: Callable[[NDArray[np.intp]], Following]) -> list[bool]:
    """Whether the follower does not turn back along each curve, as a roller does in hollows narrower than itself."""
    shares = np.linspace(0.1, 0.9, 5)
    places = [(each[:-1, None] + np.multiply.outer(np.diff(each), shares)).ravel() for each in edges]
    rates = np.asarray(at(_curves(range(len(edges)), places)).jets(np.concatenate(places), 1)[0].terms[1])
    ends = np.cumsum([len(each) for each in places])[:-1]
    return [bool(each.min() * each.max() > 0.0) for each in np.split(rates, ends)]


def _jumps(
    known: Sequence[int], edges: Sequence[Array], at: Callable[[NDArray[np.intp]], Following]
) -> list[tuple[float, float]]:
    """Of known curves the greatest jump of the second derivative where parts meet, and its greatest magnitude there."""
    if not known:
        return []
    steps = [1e-9 * np.diff(edges[i]) for i in known]
    places = [[edges[i][1:] - step for i, step in zip(known, steps, strict=True)]]
    places += [[edges[i][:-1] + step for i, step in zip(known, steps, strict=True)]]
    following, ends = at(_curves(known, steps)), np.cumsum([len(step) for step in steps])[:-1]
    sides = [np.split(following.at(np.concatenate(side), 2)[1], ends) for side in places]
    return [
        (float(np.abs(np.roll(after, -1) - before).max()), float(np.abs([before, after]).max()))
        for before, after in zip(*sides, strict=True)
    ]


def _curves(which: Sequence[int], places: Sequence[Array]) -> NDArray[np.intp]:
    """The curve of each place, one after the other."""
    return np.repeat(np.array(which, dtype=np.intp), [len(each) for each in places])


def _meant(cam: DiscCam, nu: int) -> float:
    return max(abs(value) for stretch in cam.displacement.stretches for value in stretch.extremes(nu))


def as_made(
    cam: DiscCam,
    form: ManufacturedFormat = "csv",
    *,
    curve: Literal["profile", "pitch"] = "profile",
    points: int = 721,
    decimals: int = 6,
    tolerance: Quantity = "1 um",
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
    points, decimals
        Of tables: how many points over the turn, and how many decimals of a millimetre.
    tolerance, degree
        Of splines and arcs, as in `DiscCam.export`.

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


def manufactured_tables(cam: DiscCam, curve: str, tables: Sequence[Cutting]) -> list[AsMade | None]:
    """What `as_made` finds of tables of points, by their points and decimals; None of those that it refuses to run."""
    outline, outside = _cut(cam, curve)
    curves = tuple(_points(outline, table) for table in tables)
    followings = [_following(cam, each, outside) for each in curves]
    outward = np.array([following.outward for following in followings])

    def at(which: NDArray[np.intp]) -> Following:
        return replace(followings[0], curve=CurveAtEachPlace(curves, which), outward=outward[which])

    return _runs(cam, followings, at, jumps=True)


def _cut(cam: DiscCam, curve: str) -> tuple[Outline, float]:
    """The curve of the cam that its files describe, and how far it is outside of the profile, m."""
    if curve not in MADE_CURVES:
        raise InputError(unknown_key(curve, MADE_CURVES, "curve"))
    return (cam.profile, 0.0) if curve == "profile" else (cam.pitch_curve, cam.contact.roller)


def with_profile_error(cam: DiscCam, error: Quantity, waves: Any) -> AsMade:
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
    return _reached(profile_errors(cam, error, [waves])[0])


def profile_errors(cam: DiscCam, error: Quantity, waves: Sequence[Any]) -> list[AsMade | None]:
    """What `with_profile_error` finds of so many waves each; None where the follower does not reach all of the cam."""
    amplitude = positive_quantity(error, "length", "error")
    counts = [WAVES.read(count, "waves") for count in waves]
    curves = [WavyCurve(cam.profile, amplitude, count, shift) for count in counts for shift in _SHIFTS]
    followings = [_following(cam, curve) for curve in curves]
    numbers, shifts, outward = (
        np.array([getattr(each, name) for each in some])
        for some, name in ((curves, "waves"), (curves, "shift"), (followings, "outward"))
    )

    def at(which: NDArray[np.intp]) -> Following:
        curve = replace(curves[0], waves=numbers[which], shift=shifts[which])
        return replace(followings[0], curve=curve, outward=outward[which])

    cases, each = _runs(cam, followings, at, jumps=False), len(_SHIFTS)
    return [_greatest(cases[i : i + each]) for i in range(0, len(cases), each)]


def _greatest(cases: Sequence[AsMade | None]) -> AsMade | None:
    """The greatest peaks of several cases; None where one of them has none."""
    known = [case for case in cases if case is not None]
    if len(known) < len(cases):
        return None
    return AsMade(*(max(getattr(case, name) for case in known) for name in AsMade.__dataclass_fields__))


def _points(outline: Outline, options: Cutting) -> PiecewiseCurve:
    return spline_through(_rounded(outline(np.linspace(0.0, tau, options.points)), options.decimals))


def _radii(outline: Outline, options: Cutting) -> Outline:
    return PolarSpline(_rounded(polar(outline, options.points), options.decimals))


def _splined(outline: Outline, options: Cutting) -> Outline:
    return spline(outline, options.metres, options.degree)


def _chain(outline: Outline, options: Cutting) -> Outline:
    cases = arcs(outline, options.metres)
    return ArcChain(Arcs(cases.points, cases.bulges, cases.deviation))


def _rounded(values: Array, decimals: int) -> Array:
    """Points or radii of a turn with so many decimals of a millimetre; the last is the first again."""
    rounded = 1e-3 * np.round(1e3 * values, decimals)
    rounded[-1] = rounded[0]
    return np.asarray(rounded)


_CURVES_OF: dict[str, Callable[[Outline, Cutting], Outline]] = {
    "csv": _points,
    "csv polar": _radii,
    "dxf spline": _splined,
    "svg": _splined,
    "dxf arcs": _chain,
    "g-code arcs": _chain,
}
