"""Better moves in place of old ones: least acceleration within a tolerance, and the resulting gain."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import isfinite
from typing import NamedTuple

import numpy as np

from optlaws.cycles.old_tables.stretches import Stretch
from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.polynomial import smoothstep
from optlaws.numerics.bernstein import greatest_difference
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import at_most
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.spaces.bases import Chebyshev

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
    peaks = (
        tuple(size / length**nu * getattr(law.constants, name).value for nu, name in enumerate("BCJ", start=1))
        for law in laws
    )
    after, before = peaks
    return MoveGain(old.kind, old.start, old.stop, _three(before), _three(after), size * deviation(*laws))


def deviation(law: MotionLaw, other: MotionLaw) -> float:
    """The greatest difference of two laws over the whole of k."""
    breaks = np.unique([0.0, 1.0, *law.breaks, *other.breaks])
    return abs(float(greatest_difference(law, other, breaks)[0]))


def law_of_move(part: Stretch) -> MotionLaw:
    """The law of a move, which may be a name of the catalogue."""
    if isinstance(part.law, MotionLaw):
        return part.law
    return catalogue[str(part.law)].law


def _three(peaks: Sequence[float]) -> tuple[float, float, float]:
    velocity, acceleration, jerk = peaks
    return velocity, acceleration, jerk
