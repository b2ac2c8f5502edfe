"""The dwells and moves of a table of points, the standard laws nearest to these, and better laws in their places."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from math import isfinite
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from optlaws.cycles.old_tables.motion import FittedMotion, FittedMove
from optlaws.cycles.old_tables.peak_intervals import PeakInterval
from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.polynomial import smoothstep
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.bernstein import greatest_difference
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import at_most
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.spaces.bases import Chebyshev

StretchKind: TypeAlias = Literal["dwell", "rise", "return"]

#: of the master's length: what is shorter is no stretch of its own
_SHORTEST = 1.0 / 3600.0
#: of a move: breaks that are nearer to its ends are these
_APART = 1e-9
_PIECE_DEGREE = 5


@dataclass(frozen=True)
class Stretch:
    """A part of an old table.

    Attributes
    ----------
    kind
        "dwell", "rise" or "return".
    start, stop
        Where it is, in units of the table's master.
    low, high
        The positions at its start and its end, in units of the table.
    law
        Of a move: a name of the catalogue where a standard law keeps within the room, else a law through the points.
    nearest
        The standard law that is nearest.
    distance
        How far the points are from that at most, in units of the table.
    solution
        Of a better law: the solution that it is from, with its certificate.
    peaks
        Between which values the peaks of velocity, acceleration and jerk are by the table; empty for a dwell, and for a
        law in place of that of the table.
    """

    kind: StretchKind
    start: float
    stop: float
    low: float
    high: float
    law: str | MotionLaw | None = None
    nearest: str = ""
    distance: float = 0.0
    solution: Solution | None = None
    peaks: tuple[PeakInterval, ...] = ()

    @property
    def stroke(self) -> float:
        """The displacement from its start to its end."""
        return self.high - self.low


def seam_of(heights: Array, room: float) -> float:
    """The difference between the last position and the first one; 0 within the tolerance."""
    seam = float(heights[-1] - heights[0])
    return seam if abs(seam) > room else 0.0


def stretches_of(motion: FittedMotion) -> Iterator[Stretch]:
    """The dwells and moves of a fitted motion, from its first place to its last one."""
    x, y = motion.samples.places, motion.samples.heights
    least = _SHORTEST * float(np.ptp(x))
    at, level = float(x[0]), motion.moves[0].position_before(float(x[0]))
    for move in motion.moves:
        start = move.start if move.start - at > least else at
        if start > at:
            yield _between(at, start, level, move.low)
        stop = move.stop if float(x[-1]) - move.stop > least else float(x[-1])
        law = move.name or _law_of(move, x, y)
        part = Stretch(
            "rise" if move.high > move.low else "return", start, stop, move.low, move.high, law, move.nearest,
            peaks=move.peaks,
        )  # fmt: skip
        off = part if move.name or not move.nearest else replace(part, law=move.nearest)
        inside = (x >= start) & (x <= stop) & ~motion.samples.suspects
        apart = np.abs(position(off, x[inside]) - y[inside])
        yield replace(part, distance=float(apart.max(initial=0.0)))
        at, level = stop, move.high
    if float(x[-1]) > at:
        yield _between(at, float(x[-1]), level, motion.moves[-1].position_behind(float(x[-1])))


def _between(start: float, stop: float, low: float, high: float) -> Stretch:
    """A dwell, or what runs at constant velocity."""
    if low == high:
        return Stretch("dwell", start, stop, low, high)
    slope = abs((high - low) / (stop - start))
    peaks = PeakInterval(slope, slope), PeakInterval(0.0, 0.0), PeakInterval(0.0, 0.0)
    name = "constant velocity"
    return Stretch("rise" if high > low else "return", start, stop, low, high, name, name, peaks=peaks)


def _law_of(move: FittedMove, x: Array, y: Array) -> MotionLaw:
    """The law of a move that is no standard law: of its spline, or of lines between rows where these are too few."""
    length, stroke = move.stop - move.start, move.high - move.low
    if not move.fits:
        inner = (x > move.start) & (x < move.stop)
        k = np.concatenate([[0.0], (x[inner] - move.start) / length, [1.0]])
        a = np.concatenate([[0.0], (y[inner] - move.low) / stroke, [1.0]])
        slopes = np.diff(a) / np.diff(k)
        return PiecewiseLaw(k, [PolynomialSegment((), float(slope)) for slope in slopes])
    fit = move.fits[0]
    breaks = fit.breaks
    within = breaks[(breaks > move.start + _APART * length) & (breaks < move.stop - _APART * length)]
    places = np.concatenate([[move.start], within, [move.stop]])
    nodes = 0.5 * (chebyshev.nodes(_PIECE_DEGREE - 1) + 1.0)
    segments = []
    for low, high in pairwise(places.tolist()):
        c = fit.values(low + (high - low) * nodes, 2) * (length**2 / stroke)
        b = float(fit.values(np.array([low]), 1)[0]) * length / stroke
        segments.append(PolynomialSegment(tuple(chebyshev.from_values(c).tolist()), b))
    return PiecewiseLaw((places - move.start) / length, segments)


def position(part: Stretch, places: Array) -> Array:
    """The positions of a stretch at places within it."""
    k = np.clip((places - part.start) / (part.stop - part.start), 0.0, 1.0)
    return part.low + (0.0 * k if part.law is None else part.stroke * np.asarray(law_of_move(part)(k)))


_WITHIN_TOLERANCE = 1e-6  # of a tolerance: a new law that is beyond it by no more is within it, but for rounding
_AT_REST = 1e-6  # of a law's greatest velocity: at its ends it rests if it has less
_MODERNISED_JERK = 1.2  # of an old law's greatest jerk: what a law of less acceleration in its place may have

#: places of the spline that stands for the old law in the window of the new one, more where they are too few
_PLACES = (81, 161)


class MoveGain(NamedTuple):
    """The gain of a move over an old one, in units of the table.

    Attributes
    ----------
    kind
        "rise" or "return".
    start, stop
        Where it is, in units of the master.
    old, new
        The peaks of velocity, acceleration and jerk by the master; inf where one has no greatest value.
    deviation
        The greatest difference of positions, over the whole move.
    intervals
        Between which values the old peaks are by the table; empty where the old move is of no table.

    Examples
    --------
    >>> round(MoveGain("rise", 0.0, 120.0, (1.0, 2.0, 3.0), (1.0, 1.5, 3.3), 0.05).share(2), 3)
    -0.25
    """

    kind: str
    start: float
    stop: float
    old: tuple[float, float, float]
    new: tuple[float, float, float]
    deviation: float
    intervals: tuple[PeakInterval, ...] = ()

    def shares(self, nu: int) -> tuple[float, float]:
        """The least and the greatest relative change of the peak of order nu, 1 to 3, that the table leaves open.

        Examples
        --------
        >>> known = PeakInterval(0.9, 1.1), PeakInterval(1.6, 2.5), PeakInterval(2.5, float("inf"))
        >>> gain = MoveGain("rise", 0.0, 120.0, (1.0, 2.0, 3.0), (1.0, 1.5, 3.3), 0.05, known)
        >>> [round(share, 3) for share in gain.shares(2)], gain.shares(3)[0]
        ([-0.4, -0.062], -1.0)
        """
        if not self.intervals:
            return self.share(nu), self.share(nu)
        low, high = self.intervals[nu - 1]
        return self.new[nu - 1] / high - 1.0, self.new[nu - 1] / low - 1.0 if low > 0.0 else float("inf")

    def share(self, nu: int) -> float:
        """The relative change of the peak of order nu, 1 to 3; nan if the old one is infinite or 0."""
        old, new = self.old[nu - 1], self.new[nu - 1]
        return new / old - 1.0 if isfinite(old) and old > 0.0 else float("nan")


def better(part: Stretch, room: float, order: int, degree: int, start: Solution | None = None) -> Stretch:
    """A move with the law of least acceleration within a tolerance of the old law; the old law if none exists.

    The optimum is the same from whatever start, and soon found from that of nearly the same tolerance.
    """
    if part.law is None:
        return part
    old, share = law_of_move(part), room / abs(part.stroke)
    if nothing_to_better(old) or moves_at_ends(old) or share < least_distance(old, order, degree):
        return part
    for places in _PLACES:
        start = solution = _nearby(old, share, places, (order, degree), start)
        if solution is None or solution.law.constants.C.value >= old.constants.C.value:
            return part
        # between its places the spline is not the old law
        if deviation(solution.law, old) <= share * (1.0 + _WITHIN_TOLERANCE):
            return replace(part, law=solution.law, solution=solution, peaks=())
    return part


def nothing_to_better(old: MotionLaw) -> str:
    """What a law is whose acceleration or jerk is 0, so that none in its place has less; empty for any other law.

    >>> nothing_to_better(catalogue["constant velocity"].law), nothing_to_better(catalogue["cycloidal"].law)
    ('at constant velocity, without acceleration or jerk', '')
    """
    if old.constants.C.value == 0.0:
        return "at constant velocity, without acceleration or jerk"
    return "at constant acceleration, without jerk" if old.constants.J.value == 0.0 else ""


def moves_at_ends(old: MotionLaw) -> bool:
    """Whether a law begins or ends with a velocity, so that no law from rest to rest is in its place.

    >>> moves_at_ends(catalogue["constant velocity"].law), moves_at_ends(catalogue["cycloidal"].law)
    (True, False)
    """
    return max(abs(float(old.b(0.0))), abs(float(old.b(1.0)))) > _AT_REST * old.constants.B.value


def least_distance(old: MotionLaw, order: int, degree: int) -> float:
    """A lower bound of the greatest distance of laws of an order and degree from a law: the rms of the nearest one.

    The greatest difference at places is at least the rms over them, which no law makes less than that of least squares.

    >>> least_distance(smoothstep(3), 3, 4) < 1e-15 < 1e-6 < least_distance(smoothstep(6), 3, 4)
    True
    """
    k = np.linspace(0.0, 1.0, _PLACES[-1])
    rows = ((k * (1.0 - k)) ** order)[:, None] * np.polynomial.chebyshev.chebvander(2.0 * k - 1.0, degree)
    missing = np.asarray(old(k)) - np.asarray(smoothstep(order)(k))
    left = missing - rows @ np.linalg.lstsq(rows, missing, rcond=None)[0]
    return float(np.sqrt(np.mean(left**2)))


def _nearby(
    old: MotionLaw, share: float, places: int, space: tuple[int, int], start: Solution | None
) -> Solution | None:
    k = np.linspace(0.0, 1.0, places)
    points = ", ".join(f"{place:.9g}:{height:.9g}" for place, height in zip(k, old(k), strict=True))
    near = Window(f"a - spline(k, {points})", low=-share, high=share)
    jerk = _MODERNISED_JERK * old.constants.J.value
    problem = Problem(
        order=space[0], basis=Chebyshev(space[1]), symmetric=False, windows=(near,),
        J=at_most(jerk) if np.isfinite(jerk) else None,
    )  # fmt: skip
    try:
        return synthesize(problem, start=start)
    except (InfeasibleProblem, SolverFailure):
        return None


def gain(new: Stretch, old: Stretch) -> MoveGain:
    """The gain of a move over the old move in its place."""
    laws = law_of_move(new), law_of_move(old)
    size, length = abs(old.stroke), old.stop - old.start
    after, before = (
        (B.value * size / length, C.value * size / length**2, J.value * size / length**3)
        for B, C, J in ((law.constants.B, law.constants.C, law.constants.J) for law in laws)
    )
    return MoveGain(old.kind, old.start, old.stop, before, after, size * deviation(*laws), old.peaks)


def deviation(law: MotionLaw, other: MotionLaw) -> float:
    """The greatest difference of two laws over the whole of k."""
    breaks = np.unique([0.0, 1.0, *law.breaks, *other.breaks])
    return abs(float(greatest_difference(law, other, breaks)[0]))


def law_of_move(part: Stretch) -> MotionLaw:
    """The law of a move, which may be a name of the catalogue."""
    if isinstance(part.law, MotionLaw):
        return part.law
    return catalogue[str(part.law)].law
