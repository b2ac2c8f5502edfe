"""Best breaks for few polynomials: the fewest pieces with the same peak acceleration as the law."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.fitting import Fitted, fitted
from optlaws.exports.polynomial_pieces import LawSection
from optlaws.laws.law import MotionLaw, motion_law
from optlaws.motion.motion import Motion
from optlaws.motion.piece import Piece
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numbers import Array, whole
from optlaws.tolerances import ACCELERATION_HIGHER, AGREEMENT, POSITION_OFF

MOST = 64
_EVALUATIONS = 150
_GRADINGS = (1.0, 0.7)


@dataclass(frozen=True)
class Tried:
    """A number of pieces: C of the run over C of the law with even breaks, and with the best breaks of the search."""

    count: int
    even: float
    best: float


@dataclass(frozen=True)
class BestBreaks:
    """The fewest Hermite polynomials of the search that run a law with its own peak of the acceleration.

    Parameters
    ----------
    breaks
        Their breaks in k.
    run
        The polynomials, dimensionless.
    ratio
        C of the run over C of the law.
    deviation
        How far the displacement is off at most, over the whole interval.
    tried
        Every number of pieces that was tried, in order: more pieces are not always better.
    """

    breaks: tuple[float, ...]
    run: PiecewiseMotion
    ratio: float
    deviation: float
    tried: tuple[Tried, ...]


class _Enough(Exception):  # noqa: N818 - no error: the search has what it looked for
    """Raised to end the search when the result is good enough."""


def best_breaks(law: MotionLaw, degree: int = 7, most: int = MOST) -> BestBreaks:
    """The fewest pieces of degree 3, 5, 7 or 9 with the law's derivatives at their breaks that run with its C.

    C of the run is to be within 0.1 % of the law's, and the displacement within 0.1 % of it. Breaks are looked for by
    Nelder and Mead from even and from graded breaks: the result is no proof that fewer will not do.

    Parameters
    ----------
    law
        The law, or what has one.
    degree
        Of the pieces, odd.
    most
        How many pieces there may be.

    Raises
    ------
    InputError
        If so many do not do, or a derivative that the pieces share at their breaks jumps within the law.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> best = best_breaks(smoothstep(5), degree=7)
    >>> len(best.breaks) - 1, abs(best.ratio - 1) <= 1e-3, [attempt.count for attempt in best.tried]
    (3, True, [1, 2, 3])
    """
    orders = (whole(degree, "degree", least=3, most=9) + 1) // 2
    if degree % 2 == 0:
        raise InputError(f"degree must be odd, for as many derivatives are met at both ends, got {degree}")
    return _best_breaks(motion_law(law), orders, whole(most, "most", least=1, most=1000))


@lru_cache(maxsize=32)
def _best_breaks(law: MotionLaw, orders: int, most: int) -> BestBreaks:
    _refuse_jumps(law, orders)
    return BreakSearch(LawSection(law, (0.0, 1.0)), orders, law.constants.C.value).fewest(most)


@dataclass(frozen=True)
class BreakSearch:
    """The search on a stretch of a law with the peak C, for breaks at which a number of derivatives is matched."""

    stretch: LawSection
    orders: int
    peak: float

    def fewest(self, most: int) -> BestBreaks:
        """The fewest pieces that will do."""
        tried: list[Tried] = []
        for count in range(1, most + 1):
            even, best, breaks = self._best(count)
            tried.append(Tried(count, even, best))
            run = self.run(breaks)
            off = self.stretch.off(run, 0)
            if abs(best - 1.0) <= ACCELERATION_HIGHER and off <= POSITION_OFF:
                return BestBreaks(tuple(breaks.tolist()), run, best, off, tuple(tried))
        raise InputError(
            f"{most} pieces of degree {2 * self.orders - 1} do not bring C within {ACCELERATION_HIGHER:.1%} of the "
            "law's: take a higher degree or more pieces"
        )

    def run(self, breaks: Array) -> PiecewiseMotion:
        """The executed polynomials between the breaks."""
        return self.stretch.hermite(breaks, self.orders)

    def ratio(self, breaks: Array) -> float:
        """C of the run over C of the law."""
        return self.run(breaks).size(2) / self.peak

    def _best(self, count: int) -> tuple[float, float, Array]:
        even = self._placed(np.ones(count))
        tried: list[tuple[float, Array]] = [(self.ratio(even), even)]
        first = tried[0][0]
        for grading in _GRADINGS if abs(first - 1.0) > ACCELERATION_HIGHER and count > 1 else ():
            self._descend(count, grading, tried)
            if abs(tried[-1][0] - 1.0) <= ACCELERATION_HIGHER:
                break
        ratio, breaks = min(tried, key=lambda pair: abs(pair[0] - 1.0))
        return first, ratio, breaks

    def _descend(self, count: int, grading: float, tried: list[tuple[float, Array]]) -> None:
        from scipy.optimize import minimize

        half = (count + 1) // 2 if self._symmetric else count

        def lengths(logarithms: Array) -> Array:
            some = np.exp(np.concatenate([[0.0], logarithms]))
            return np.concatenate([some, some[: count - half][::-1]])

        def off(logarithms: Array) -> float:
            breaks = self._placed(lengths(np.clip(logarithms, -6.0, 6.0)))
            ratio = self.ratio(breaks)
            if abs(ratio - 1.0) < abs(tried[-1][0] - 1.0) or len(tried) == 1:
                tried.append((ratio, breaks))
            if abs(ratio - 1.0) <= ACCELERATION_HIGHER:
                raise _Enough
            return abs(ratio - 1.0)

        start = -np.log(grading) * np.minimum(np.arange(1, half), np.arange(half - 1, 0, -1) + (count - half))
        if half > 1:
            with suppress(_Enough):
                minimize(off, start, method="Nelder-Mead", options={"maxfev": _EVALUATIONS})

    @staticmethod
    def _placed(lengths: Array) -> Array:
        """Breaks with gaps like the lengths."""
        breaks: Array = np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
        breaks[-1] = 1.0
        return breaks

    @property
    def _symmetric(self) -> bool:
        k = np.linspace(0.0, 1.0, 33)
        c = self.stretch.values(k, 2)
        return bool(np.abs(c + c[::-1]).max() <= AGREEMENT * self.peak)


def _refuse_jumps(law: MotionLaw, orders: int) -> None:
    for nu in range(1, orders):
        if law.jumps(nu) or not np.isfinite(law.peak(nu).value):
            raise InputError(
                f"the derivative of order {nu} of the law jumps, and pieces of degree {2 * orders - 1} share it at "
                "their breaks: take a lower degree, or the law's own breaks (points not 'best')"
            )


def fitted_best(motion: Motion, degree: int, most: int) -> Fitted:
    """Polynomials for a motion with their breaks where `best_breaks` finds them; its own where they are low enough."""

    def best(piece: Piece) -> PiecewiseMotion:
        return best_breaks(piece.law, degree - 1 + degree % 2, min(most, MOST)).run

    return fitted(motion, degree, most, laid=best)
