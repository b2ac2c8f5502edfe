"""The fewest certified laws of a proven front whose chords stay within a gap, and what its ends prove of all laws."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from optlaws.errors import InputError, OptlawsError
from optlaws.laws import MotionLaw
from optlaws.numbers import Array, positive, whole
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.status import measure

_STEPS = 24


class ChordSelection:
    """Certified laws above, the corners of all that is proven below, and chords that leave laws out.

    The values are of a number in which the objective, of some scale, is convex; the sides are `ProvenFront.sides`.

    Examples
    --------
    >>> from optlaws import proven_front
    >>> front = proven_front(Problem(order=4), between=(1.6, 1.9), gap=1e-5)
    >>> chords = ChordSelection(np.array(front.values), front.sides, front.problem.objective.scale)
    >>> places, gap = chords.fewest(1e-3)
    >>> len(places), len(front) > 5 * len(places), gap <= 1e-3
    (6, True, True)
    """

    def __init__(self, values: Array, sides: Array, scale: float) -> None:
        self.values, self.scale = values, scale
        self.tops, low, slopes = sides.T
        offsets = low - slopes * values
        with np.errstate(divide="ignore", invalid="ignore"):
            cross = (offsets[:-1] - offsets[1:]) / np.diff(slopes)
        inside = np.where(np.isfinite(cross), np.clip(cross, values[:-1], values[1:]), values[:-1])
        below = np.maximum(offsets[:-1] + slopes[:-1] * inside, offsets[1:] + slopes[1:] * inside)
        order = np.argsort(np.concatenate([values, inside]), kind="stable")
        self.corners = np.concatenate([values, inside])[order]
        self.below = np.concatenate([low, below])[order]

    def fewest(self, gap: float, points: int | None = None) -> tuple[list[int], float]:
        """Places of laws, each as far from its predecessor as the gap allows, and the greatest gap between them."""
        greatest = positive(gap, "gap")
        most = None if points is None else whole(points, "points", least=2)
        finest = self._places(0.0)[1]
        if finest > greatest:
            raise InputError(
                f"gap: the front is proven to {finest:.1e}, not to {greatest:g}: make it with proven_front(..., "
                f"gap={greatest:g}) or less; a finer front needs fewer laws in the table"
            )
        places, reached = self._places(greatest)
        if most is not None and len(places) > most:
            near = self._reached(most)
            raise InputError(
                f"gap: {greatest:g} needs {len(places)} laws, but points allows {most}, whose gap is {near:.2g}"
            )
        return places, reached

    def _gap(self, first: int, last: int) -> float:
        # of the chord between two laws: greatest at a corner of what is proven below
        t = self.values
        low, high = np.searchsorted(self.corners, [t[first], t[last]])
        at = slice(low, high + 1)
        share = (self.corners[at] - t[first]) / (t[last] - t[first])
        chord: Array = (1.0 - share) * self.tops[first] + share * self.tops[last]
        return float(((chord - self.below[at]) / measure(chord, self.scale)).max())

    def _places(self, gap: float) -> tuple[list[int], float]:
        places, reached, last = [0], 0.0, len(self.values) - 1
        while places[-1] < last:
            after = places[-1] + 1
            while after < last and self._gap(places[-1], after + 1) <= gap:
                after += 1
            reached = max(reached, self._gap(places[-1], after))
            places.append(after)
        return places, reached

    def _reached(self, points: int) -> float:
        low, high = 0.0, 1.0
        for _ in range(_STEPS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if len(self._places(middle)[0]) <= points else (middle, high)
        return high


def proven_ends(problem: Problem, first: MotionLaw, last: MotionLaw, gap: float) -> tuple[bool, bool]:
    """Whether the first law of a front of B is within a gap of the least B of all laws, the last of the least C.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> proven_ends(Problem(order=4), smoothstep(4), synthesize(Problem(order=4)).law, 1e-3)
    (False, True)
    """
    return (
        _least(problem, "B") >= first.constants.B.value * (1.0 - gap),
        _least(problem, "C") >= last.constants.C.value * (1.0 - gap),
    )


def _least(problem: Problem, name: str) -> float:
    try:
        return synthesize(replace(problem, minimise=name)).lower_bound
    except OptlawsError:
        return 0.0
