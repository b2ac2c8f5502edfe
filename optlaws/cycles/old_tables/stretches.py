"""The dwells and moves of a table of points, the standard laws nearest to these, and better laws in their places."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import isfinite
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.making.through_points import law_through
from optlaws.laws.polynomial import smoothstep
from optlaws.numbers import Array
from optlaws.numerics.bernstein import greatest_difference
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import at_most
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.spaces.bases import Chebyshev

_CLOSE_FIT = 1e-14  # of a fit of a law to points: what its last step changes of the sum of squares and of its ends
_ROUGH_FIT = 1e-4  # the same where laws are only ranked by how near they come

StretchKind: TypeAlias = Literal["dwell", "rise", "return"]

#: a dwell has as many points at least
_FEWEST = 3
#: and in the middle of one of as many points the motion rests indeed
_LONG = 12
#: points of a move that exclude laws far from it, and the number of laws that are compared at all points
_COARSE, _NEAREST = 40, 4
#: steps to which the ends of moves are rounded where the points allow it, in parts of the master's turn
_ROUND = (1.0 / 36.0, 1.0 / 72.0, 1.0 / 360.0, 1.0 / 720.0, 1.0 / 3600.0)


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

    @property
    def stroke(self) -> float:
        """The displacement from its start to its end."""
        return self.high - self.low


def of_standard_laws(places: Array, heights: Array, room: float) -> tuple[Stretch, ...] | None:
    """The segments of a table if all its moves are standard laws; None otherwise."""
    stretches = []
    try:
        for part in stretches_of(places, heights, room):
            if isinstance(part.law, MotionLaw):
                return None
            stretches.append(part)
    except InputError:
        return None
    return tuple(stretches)


def seam_of(heights: Array, room: float) -> float:
    """The difference between the last position and the first one; 0 within the tolerance."""
    seam = float(heights[-1] - heights[0])
    return seam if abs(seam) > room else 0.0


@dataclass(frozen=True)
class _Rest:
    """A run of points at one level."""

    first: int
    last: int
    level: float


def _rests(heights: Array, room: float) -> Iterator[_Rest]:
    """Runs of points within the tolerance of a level, and single points at which the motion turns."""
    count, i = len(heights), 0
    while i < count:
        low = high = heights[i]
        j = i
        while j + 1 < count and max(high, heights[j + 1]) - min(low, heights[j + 1]) <= 2.0 * room:
            j += 1
            low, high = min(low, heights[j]), max(high, heights[j])
        turns = i > 0 and j + 1 < count and (heights[i - 1] - heights[i]) * (heights[j + 1] - heights[j]) > 0.0
        if j - i + 1 >= _FEWEST or turns or i == 0 or j == count - 1:
            yield _Rest(i, j, _level(heights, i, j))
            i = j + 1
        else:
            i += 1


def _level(heights: Array, first: int, last: int) -> float:
    """The level of a dwell: the median of its middle; of a short one the value farthest from the moves."""
    quarter = (last - first) // 4
    if last - first + 1 >= _LONG:
        return float(np.median(heights[first + quarter : last - quarter + 1]))
    beside = [float(heights[i]) for i in (first - 1, last + 1) if 0 <= i < len(heights)]
    run = heights[first : last + 1]
    return float(run.max() if np.mean(beside) < np.mean(run) else run.min())


def _joined(rests: Sequence[_Rest], room: float) -> list[_Rest]:
    """Consecutive runs at the same level as a single run; levels that differ by less than the tolerance are equal."""
    joined: list[_Rest] = []
    longest = sorted(rests, key=lambda rest: rest.first - rest.last)
    for rest in rests:
        level = next(other.level for other in longest if abs(other.level - rest.level) <= room)
        first = joined.pop().first if joined and joined[-1].level == level else rest.first
        joined.append(_Rest(first, rest.last, level))
    return joined


def stretches_of(places: Array, heights: Array, room: float) -> Iterator[Stretch]:
    """The dwells and moves of points in their order."""
    rests = _joined(list(_rests(heights, room)), room)
    # what rises or falls through a short run does not rest there
    apart = [rests[0]]
    for rest, after in pairwise(rests[1:]):
        passes = (rest.level - apart[-1].level) * (after.level - rest.level) > 0.0
        if not passes or rest.last - rest.first + 1 >= _LONG:
            apart.append(rest)
    apart.append(rests[-1])
    moves = (_move(places, heights, first, last, room) for first, last in pairwise(apart))
    turn = float(np.ptp(places))
    at = float(places[0])
    for move, rest in zip(moves, apart, strict=False):
        if move.start - at > _ROUND[-1] * turn:
            yield Stretch("dwell", at, move.start, rest.level, rest.level)
        yield move
        at = move.stop
    if places[-1] - at > _ROUND[-1] * turn:
        yield Stretch("dwell", at, float(places[-1]), apart[-1].level, apart[-1].level)


def _move(places: Array, heights: Array, first: _Rest, last: _Rest, room: float) -> Stretch:
    """The move between two rests: by the standard law that is nearest, or by one through its points."""
    # a run between two moves is shared at its middle, so that neither reaches into the other
    low = 0 if first.first == 0 and first.last < _LONG else (first.first + first.last) // 2
    whole = last.last == len(places) - 1 and last.last - last.first < _LONG
    high = last.last if whole else (last.first + last.last) // 2
    x, y = places[low : high + 1], (heights[low : high + 1] - first.level) / (last.level - first.level)
    share = room / abs(last.level - first.level)
    some = slice(None, None, max(1, len(x) // _COARSE))
    near = sorted((_fitted(x[some], y[some], catalogue[name].law, _ROUGH_FIT)[0], name) for name in catalogue)
    distance, start, stop, name = min(
        (*_fitted(x, y, catalogue[name].law, _CLOSE_FIT), name) for _, name in near[:_NEAREST]
    )
    law = catalogue[name].law
    kind: StretchKind = "rise" if last.level > first.level else "return"
    if distance <= 1.5 * share:
        start, stop = _rounded(x, y, law, (start, stop), share)
        distance = _distance(x, y, law, start, stop)
    if distance <= share * (1.0 + 1e-9):
        return Stretch(kind, start, stop, first.level, last.level, name, name, distance * abs(last.level - first.level))
    inner = np.flatnonzero((y > share) & (y < 1.0 - share))
    begin, end = max(int(inner[0]) - 1, 0), min(int(inner[-1]) + 1, len(x) - 1)
    begin = min(begin, int(np.searchsorted(x, start, side="right")) - 1) if start > x[0] else 0
    end = max(end, int(np.searchsorted(x, stop))) if stop < x[-1] else len(x) - 1
    through = law_through(x[begin : end + 1], np.clip(y[begin : end + 1], 0.0, 1.0), tolerance=share)
    size = distance * abs(last.level - first.level)
    return Stretch(kind, float(x[begin]), float(x[end]), first.level, last.level, through, name, size)


def _distance(x: Array, y: Array, law: MotionLaw, start: float, stop: float) -> float:
    return float(np.abs(law(np.clip((x - start) / (stop - start), 0.0, 1.0)) - y).max())


def _fitted(x: Array, y: Array, law: MotionLaw, tolerance: float) -> tuple[float, float, float]:
    """The greatest deviation of the points from a law, and the law's fitted start and end, by least squares."""
    from scipy.optimize import least_squares

    k = np.linspace(0.0, 1.0, 401)
    tenth, ninth = (float(np.interp(share, law(k), k)) for share in (0.1, 0.9))
    rising = np.maximum.accumulate(y)
    first, last = (float(np.interp(share, rising, x)) for share in (0.1, 0.9))
    length = max((last - first) / (ninth - tenth), float(np.diff(x).min()))
    guess = first - tenth * length

    def missed(ends: Array) -> Array:
        start, stop = ends
        return np.asarray(law(np.clip((x - start) / max(stop - start, 1e-9 * length), 0.0, 1.0)) - y)

    stops: dict[str, Any] = {"xtol": tolerance, "ftol": tolerance, "gtol": tolerance}
    solution = least_squares(missed, [guess, guess + length], x_scale=length, **stops)
    start, stop = map(float, solution.x)
    return float(np.abs(missed(solution.x)).max()), start, stop


def _rounded(x: Array, y: Array, law: MotionLaw, ends: tuple[float, float], room: float) -> tuple[float, float]:
    """The ends of a move rounded as much as the points allow, and within them."""
    turn = 360.0 if float(np.ptp(x)) > 12.0 else 1.0
    for share in _ROUND:
        step = share * turn
        start, stop = (max(min(round(end / step) * step, float(x[-1])), float(x[0])) for end in ends)
        if start < stop and _distance(x, y, law, start, stop) <= room:
            return start, stop
    return max(ends[0], float(x[0])), min(ends[1], float(x[-1]))


_WITHIN_TOLERANCE = 1e-6  # of a tolerance: a new law that is beyond it by no more is within it, but for rounding
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
    if nothing_to_better(old) or share < least_distance(old, order, degree):
        return part
    for places in _PLACES:
        start = solution = _nearby(old, share, places, (order, degree), start)
        if solution is None or solution.law.constants.C.value >= old.constants.C.value:
            return part
        # between its places the spline is not the old law
        if deviation(solution.law, old) <= share * (1.0 + _WITHIN_TOLERANCE):
            return replace(part, law=solution.law, solution=solution)
    return part


def nothing_to_better(old: MotionLaw) -> str:
    """What a law is whose acceleration or jerk is 0, so that none in its place has less; empty for any other law.

    >>> nothing_to_better(catalogue["constant velocity"].law), nothing_to_better(catalogue["cycloidal"].law)
    ('at constant velocity, without acceleration or jerk', '')
    """
    if old.constants.C.value == 0.0:
        return "at constant velocity, without acceleration or jerk"
    return "at constant acceleration, without jerk" if old.constants.J.value == 0.0 else ""


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
    return MoveGain(old.kind, old.start, old.stop, before, after, size * deviation(*laws))


def deviation(law: MotionLaw, other: MotionLaw) -> float:
    """The greatest difference of two laws over the whole of k."""
    breaks = np.unique([0.0, 1.0, *law.breaks, *other.breaks])
    return abs(float(greatest_difference(law, other, breaks)[0]))


def law_of_move(part: Stretch) -> MotionLaw:
    """The law of a move, which may be a name of the catalogue."""
    if isinstance(part.law, MotionLaw):
        return part.law
    return catalogue[str(part.law)].law
