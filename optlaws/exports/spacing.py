"""Points of tables: their places, and the smallest number whose executed motion is as good as any tried."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import inf, isfinite
from typing import NamedTuple

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.format import BEST, Request, Written
from optlaws.kept import kept_property
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numbers import Array
from optlaws.numerics import bernstein

_AS_GOOD = 1e-3  # ranks of tables nearer to each other are as good
_RUN_OFF = 1e-4  # of the stroke: a run may be so far from the law for the sake of its peak

MOST_TRIED = 1001
_RATIO = 1.12
_NEAR = 12
_EACH = 64
_DIGITS = 12
_BETWEEN = 0.4  # share of a step; halfway, symmetric curves cross


@dataclass(frozen=True, eq=False)
class PointTable:
    """Points as the target stores them, and the polynomials that the controller lays between them.

    `x` of the master has the shape (n,), `values` (y, V, A, ... of the slave) (m, n), ascending `powers` a row for each
    polynomial; `resolution` is the step of positions, `rounding_bound` computes what they may add to C.
    """

    x: Array
    values: Array
    powers: Array
    resolution: float
    rounding_bound: Callable[[], float] = float

    @kept_property
    def run(self) -> PiecewiseMotion:
        """The motion that the controller computes from the points."""
        return PiecewiseMotion(self.x, self.powers)

    def written(self, text: str, model: str, notes: tuple[str, ...] = ()) -> Written:
        """The file of the table, with the executed motion."""
        return Written(text, self.run, model, len(self.x), "points", self.resolution, self.rounding_bound(), notes)


def places(motion: Motion, count: int, *, straight: bool = False) -> Array:
    """A given number of points with equal steps between the breaks of a motion, which are points themselves.

    With `straight` dwells and uniform motions need no point inside, as where the file has V and A.
    """
    breaks = np.array(motion.breaks)
    shares = _shares(np.diff(breaks), count - 1, _needs(motion) if straight else np.ones(len(breaks) - 1))
    digits = _DIGITS - int(np.ceil(np.log10(motion.length)))
    parts = [_between(low, high, n, digits) for (low, high), n in zip(pairwise(breaks), shares, strict=True)]
    return np.concatenate([*parts, breaks[-1:]])


def _between(low: float, high: float, steps: int, digits: int) -> Array:
    """Equal steps without the end, rounded far below the file's digits, so that a file contains 0.075 exactly."""
    inside = np.linspace(low, high, steps + 1)[:-1]
    inside[1:] = np.round(inside[1:], digits)
    return inside


def chosen(motion: Motion, request: Request, make: Callable[[int], PointTable], least: int, most: int) -> PointTable:
    """The table with the requested number of points, or with the best executed motion that the target can store."""
    fewest = max(least, len(motion.breaks))  # one at every break
    if fewest > most:
        raise InputError(f"the motion has {fewest} breaks, and the target holds {most} points: export its parts")
    if request.points not in {None, BEST}:
        count = int(request.points or 0)
        if not fewest <= count <= most:
            raise InputError(f"points must be from {fewest} (one at every break of the motion) to {most}, got {count}")
        return make(count)
    return best(motion, make, fewest, min(most, max(MOST_TRIED, fewest)))


def best(motion: Motion, make: Callable[[int], PointTable], least: int, most: int) -> PointTable:
    """The table with the number of points whose run is best, tried up to 64 one by one, then over the range.

    Runs count that are within 1e-4 of the stroke of the law, or within the resolution, or as near as any. The best of
    them has the least peak of the acceleration (where straight lines jump in velocity, the least jump); what is below
    the law's own peak is no gain. Among numbers as good to a thousandth those count whose acceleration jumps
    least further than the law's, at points and at the ends, to a thousandth of the peak, and of these the least.
    """
    rank_of, tried = _ranking(motion), dict[int, tuple[Rank, PointTable]]()

    def attempt(counts: set[int]) -> None:
        for count in sorted(counts - tried.keys()):
            table = make(count)
            tried[count] = (rank_of(table), table)

    rough = least * _RATIO ** np.arange(1 + int(np.log(most / least) / np.log(_RATIO)))
    attempt({*range(least, min(most, _EACH) + 1), *(int(guess) for guess in rough), most})
    top = min(tried, key=lambda count: tried[count][0])
    near = np.linspace(max(least, top / _RATIO), min(most, top * _RATIO), 2 * _NEAR + 1)
    attempt({int(guess) for guess in near})
    return tried[_fewest({count: rank for count, (rank, _) in tried.items()})][1]


class Rank(NamedTuple):
    """The quality of an executed motion; every value is at least the law's own.

    How far it is off, over what it may be; its peak over the law's; what it jumps further, over the law's peak.
    """

    off: float
    peak: float
    jump: float


def _fewest(ranks: dict[int, Rank]) -> int:
    """The least number of points of those that are as good as any, one criterion after the other."""
    nearest = min(rank.off for rank in ranks.values()) * (1.0 + _AS_GOOD)
    near = {count: rank for count, rank in ranks.items() if rank.off <= nearest}
    lowest = min(rank.peak for rank in near.values()) * (1.0 + _AS_GOOD)
    low = {count: rank.jump for count, rank in near.items() if rank.peak <= lowest}
    smoothest = min(low.values()) + _AS_GOOD
    return min(count for count, jump in low.items() if jump <= smoothest)


def _ranking(motion: Motion) -> Callable[[PointTable], Rank]:
    """What ranks the runs of tables of a motion, by its peaks of velocity and acceleration and its jumps of that."""
    fastest, highest, jumping, ending = (
        motion.peak(1),
        motion.peak(2),
        motion.jump(2)[0],
        _change(motion, *motion.ends(2)),
    )

    def rank(table: PointTable) -> Rank:
        powers, steps = table.powers, np.diff(table.x)
        nu = 1 if highest in {0.0, inf} or powers.shape[1] == 2 else 2
        first, last = _ends(powers, steps, nu)
        jump = float(np.abs(first[1:] - last[:-1]).max(initial=0.0))
        at_ends = _change(motion, float(first[0]), float(last[-1]))
        off = _off(motion, table)
        if nu == 1:
            return Rank(off, 1.0 + max(jump, at_ends) / fastest, 0.0)
        beyond = max(jump - jumping, 0.0) + max(at_ends - ending, 0.0)
        return Rank(off, max(_peak(powers, steps, first, last) / highest, 1.0), beyond / highest)

    return rank


def _change(motion: Motion, first: float, last: float) -> float:
    """The jump from the last value to the first where a motion repeats, else from and to rest."""
    return abs(last - first) if motion.repeats else max(abs(first), abs(last))


def _off(motion: Motion, table: PointTable) -> float:
    """The deviation of the polynomials from the motion between points, where it is typically greatest."""
    after = _BETWEEN * np.diff(table.x)
    run = (table.powers * after[:, None] ** np.arange(table.powers.shape[1])).sum(axis=1)
    at = np.clip(table.x[:-1] + after, motion.start, motion.stop)
    apart = float(np.abs(run - motion(at)).max())
    return max(apart / max(_RUN_OFF * motion.stroke, table.resolution), 1.0)


def _ends(powers: Array, steps: Array, nu: int) -> tuple[Array, Array]:
    """The derivative of order nu just after the start and just before the end of each piece."""
    table = np.asarray(np.polynomial.polynomial.polyder(powers, nu, axis=1), dtype=np.float64)
    return table[:, 0], (table * steps[:, None] ** np.arange(table.shape[1])).sum(axis=1)


def _peak(powers: Array, steps: Array, first: Array, last: Array) -> float:
    """The greatest magnitude of the acceleration: at points where it is straight between them."""
    if powers.shape[1] <= 4:
        return float(max(np.abs(first).max(), np.abs(last).max()))
    table = np.polynomial.polynomial.polyder(powers, 2, axis=1)
    control = bernstein.from_powers(table * steps[:, None] ** np.arange(table.shape[1]))
    return bernstein.top(np.concatenate([control, -control])).value


def _needs(motion: Motion) -> Array:
    """1 for curved stretches between breaks, 0 for straight ones."""
    middles = [0.5 * (low + high) for low, high in pairwise(motion.breaks)]
    which = np.searchsorted(motion.joints[1:-1], middles, side="right")
    curved = [motion.pieces[i].stroke != 0.0 and motion.pieces[i].law.peak(2).value > 0.0 for i in which]
    return np.array(curved, dtype=np.float64)


def _shares(lengths: Array, steps: int, weights: Array) -> list[int]:
    """The number of steps of each stretch: at least one, the rest in proportion to its length."""
    if steps < len(lengths):
        raise InputError(f"{steps + 1} points are too few: the motion has {len(lengths) + 1} breaks")
    sized = lengths * weights
    total = float(sized.sum())
    if total == 0.0 or not isfinite(total):
        sized, total = lengths, float(lengths.sum())
    # each step is given where it is longest so far, so that steps are as equal as they can be
    shares = np.maximum(1, np.floor(sized / total * (steps - len(lengths)))).astype(int)
    for _ in range(steps - int(shares.sum())):
        shares[int(np.argmax(sized / shares))] += 1
    return [int(share) for share in shares]
