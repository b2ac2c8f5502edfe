"""Points of tables as a target stores them, the motion that it computes from them, and the fewest that are as good."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import inf, isfinite

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.format import BEST, Request, Written
from optlaws.exports.text import rounded_column
from optlaws.kept import kept_property
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numbers import Array
from optlaws.numerics import bernstein
from optlaws.numerics.splines import Ends, hermite_powers, linear_powers, spline_powers
from optlaws.tolerances import CLOSURE

_TABLE_ROUNDING = 2.0**-46  # of a column of a table: less is printed as 0

#: by interpolations: how many derivatives points have, with the position
HERMITE = {"c1": 2, "quintic": 3, "septic": 4}
DEGREES = {1: "linear", 2: "cubic Hermite", 3: "quintic Hermite", 4: "Hermite of degree 7"}
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
        return PiecewiseMotion(self.x, self.powers)

    def written(self, text: str, model: str, notes: tuple[str, ...] = ()) -> Written:
        """The file of the table, with the executed motion."""
        return Written(text, self.run, model, len(self.x), "points", self.resolution, self.rounding_bound(), notes)


@dataclass(frozen=True)
class NumberFormat:
    """The numbers that a target holds: steps over the stroke, digits behind the decimal sign, doubles or REAL32."""

    counts: int | None = None
    digits: int | None = None
    single: bool = False

    def resolution(self, motion: Motion) -> float:
        """Step of positions in units of the slave; 0 for doubles."""
        top = max(abs(value) for value, _ in motion.extremes(0))
        return max(
            motion.stroke / self.counts if self.counts else 0.0,
            0.0 if self.digits is None else 10.0**-self.digits,
            float(np.spacing(np.float32(top))) if self.single else 0.0,
        )

    def master(self, x: Array) -> Array:
        """Ascending places of the master as the target stores them."""
        stored = self.numbers(x)
        if (np.diff(stored) <= 0.0).any():
            raise InputError(
                f"{len(x)} points of the master are closer than the digits can represent: take fewer points, more "
                "digits, or a unit that is smaller"
            )
        return stored

    def positions(self, y: Array, motion: Motion) -> Array:
        """Positions as the target stores them."""
        step = motion.stroke / self.counts if self.counts else 0.0
        return self.numbers(np.rint(y / step) * step if step else y)

    def numbers(self, values: Array) -> Array:
        """The numbers of a column as the target stores them: 15 digits of its greatest, unless their digits are given.

        >>> NumberFormat().numbers(np.array([4.0e-17, 29.999999999999996, 40.0])).tolist()
        [0.0, 30.0, 40.0]
        """
        rounded = rounded_column(values, self.digits)
        return rounded.astype(np.float32).astype(np.float64) + 0.0 if self.single else rounded


#: how many points, or the places of the master where they are
Points = int | Array


def point_table(
    motion: Motion, points: Points, numbers: NumberFormat, interpolation: str, *, ends: Ends = "clamped"
) -> PointTable:
    """Points as the target stores them and what it lays between them: linear, cubic, akima, c1, quintic or septic.

    A spline is clamped to the velocities of the motion's ends, natural, or periodic: then it ends exactly where it
    begins, as the motion does but for rounding.
    """
    if interpolation in HERMITE:
        return hermite_table(motion, points, numbers, HERMITE[interpolation])
    exact = points if isinstance(points, np.ndarray) else places(motion, points, straight=interpolation == "linear")
    x = numbers.master(exact)
    y, resolution = numbers.positions(np.asarray(motion(exact)), motion), numbers.resolution(motion)
    if interpolation != "cubic":
        powers = linear_powers(x, y) if interpolation == "linear" else akima_powers(x, y)
        return PointTable(x, y[None], powers, resolution)
    if ends == "periodic":
        y[-1] = y[0]
    slopes = end_slopes(motion, numbers)
    powers = spline_powers(x, y, ends, (float(slopes[0]), float(slopes[1])))
    return PointTable(x, y[None], powers, resolution, partial(rounding_bound, motion, x, y, slopes))


def end_slopes(motion: Motion, number_format: NumberFormat) -> Array:
    """The velocities of a motion's ends as the target stores them, 0 where rounding beside the mean has missed it."""
    slopes = np.array(motion.ends(1))
    rounding = _TABLE_ROUNDING * motion.stroke / motion.length
    return number_format.numbers(np.where(np.abs(slopes) <= rounding, 0.0, slopes))


def akima_powers(x: Array, y: Array) -> Array:
    """Akima's cubics in ascending powers, as in Modelica's tables: the acceleration jumps at each point."""
    from scipy.interpolate import Akima1DInterpolator

    return np.asarray(Akima1DInterpolator(x, y).c.T[:, ::-1])


def hermite_table(
    motion: Motion, points: Points, numbers: NumberFormat, orders: int, *, with_derivatives: bool = True
) -> PointTable:
    """Positions with derivatives for Hermite polynomials of the controller; their number or places are given.

    Where the table has no derivatives the controller computes them, and they are taken as the law's.
    """
    exact = points if isinstance(points, np.ndarray) else places(motion, points, straight=True)
    values = np.array([motion(exact, nu) for nu in range(orders)])
    # what rounding has missed 0 by
    values[np.abs(values) <= _TABLE_ROUNDING * np.abs(values).max(axis=1, keepdims=True)] = 0.0
    if not np.isfinite(values).all():
        raise InputError(
            "the law's acceleration or jerk is infinite at a point: export positions alone, or another law"
        )
    x = numbers.master(exact)
    stored = [numbers.numbers(column) if with_derivatives else column for column in values[1:]]
    values = np.vstack([numbers.positions(values[0], motion), *stored])
    return PointTable(x, values, hermite_powers(x, values), numbers.resolution(motion))


def chosen_table(
    motion: Motion,
    request: Request,
    interpolation: str,
    most: int,
    *,
    least: int = 2,
    single: bool = False,
    ends: Ends = "clamped",
) -> PointTable:
    """The table for an interpolation with the requested number of points, or with the best number."""
    numbers = NumberFormat(request.counts, request.digits, single)
    make = partial(point_table, motion, numbers=numbers, interpolation=interpolation, ends=ends)
    return chosen(motion, request, make, least=least, most=most)


def is_cyclic(motion: Motion) -> bool:
    """Whether a motion repeats itself where it began."""
    return motion.repeats and abs(motion.advance) <= CLOSURE * motion.stroke


def rounding_bound(motion: Motion, x: Array, y: Array, slopes: Array) -> float:
    """The greatest addition of roundings to the acceleration of a clamped cubic spline: 6 eps/dx², for errors of eps/2.

    The spline's accelerations at its points solve a system whose diagonal is twice the sum of what is beside it, with
    six times the second divided differences of the positions on the right; these are wrong by eps/(h_i h_i+1) at most.
    """
    exact = np.asarray(motion(np.clip(x, motion.start, motion.stop)))
    eps = 2.0 * float(np.abs(y - exact).max())
    steps = np.diff(x)
    ends = np.abs(slopes - np.array(motion.ends(1))) * 6.0 / steps[[0, -1]]
    inner = float((6.0 * eps / (steps[1:] * steps[:-1])).max(initial=0.0))
    return max(inner, float((6.0 * eps / steps[[0, -1]] ** 2 + ends).max()))


def places(motion: Motion, count: int, *, straight: bool = False) -> Array:
    """A given number of points with equal steps between the breaks of a motion, which are points themselves.

    With `straight` dwells and uniform motions need no point inside, as where the file has V and A.
    """
    breaks, weights = np.array(motion.breaks), np.ones(len(motion.breaks) - 1)
    if straight:
        starts = [piece.start for piece in motion.pieces[1:]]
        pieces = [motion.pieces[i] for i in np.searchsorted(starts, 0.5 * (breaks[:-1] + breaks[1:]), side="right")]
        weights = np.array([float(piece.stroke != 0.0 and piece.law.peak(2).value > 0.0) for piece in pieces])
    shares = _shares(np.diff(breaks), count - 1, weights)
    digits = _DIGITS - int(np.ceil(np.log10(motion.length)))
    parts = []
    for (low, high), n in zip(pairwise(breaks), shares, strict=True):
        # rounded far below the file's digits, so that a file contains 0.075 exactly
        parts += [[low], np.round(np.linspace(low, high, n + 1)[1:-1], digits)]
    return np.concatenate([*parts, breaks[-1:]])


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
    tried: dict[int, tuple[Rank, PointTable]] = {}

    def attempt(counts: set[int]) -> None:
        for count in sorted(counts - tried.keys()):
            table = make(count)
            tried[count] = (_rank(motion, table), table)

    rough = least * _RATIO ** np.arange(1 + int(np.log(most / least) / np.log(_RATIO)))
    attempt({*range(least, min(most, _EACH) + 1), *(int(guess) for guess in rough), most})
    top = min(tried, key=lambda count: tried[count][0])
    near = np.linspace(max(least, top / _RATIO), min(most, top * _RATIO), 2 * _NEAR + 1)
    attempt({int(guess) for guess in near})
    # those that are as good as any, one criterion after the other
    as_good = {count: rank for count, (rank, _) in tried.items()}
    for criterion in range(3):
        lowest = min(rank[criterion] for rank in as_good.values())
        allowed = lowest * (1.0 + _AS_GOOD) if criterion < 2 else lowest + _AS_GOOD
        as_good = {count: rank for count, rank in as_good.items() if rank[criterion] <= allowed}
    return tried[min(as_good)][1]


#: of a run: how far it is off over what it may be, its peak over the law's, and what it jumps further over that peak
Rank = tuple[float, float, float]


def _rank(motion: Motion, table: PointTable) -> Rank:
    """The rank of the run of a table beside the motion, by peaks of velocity and acceleration and jumps of that."""
    powers, steps, highest = table.powers, np.diff(table.x), motion.peak(2)
    after = _BETWEEN * steps  # where it is typically furthest off
    run = (powers * after[:, None] ** np.arange(powers.shape[1])).sum(axis=1)
    apart = float(np.abs(run - motion(np.clip(table.x[:-1] + after, motion.start, motion.stop))).max())
    off = max(apart / max(_RUN_OFF * motion.stroke, table.resolution), 1.0)
    nu = 1 if highest in {0.0, inf} or powers.shape[1] == 2 else 2
    slopes = np.asarray(np.polynomial.polynomial.polyder(powers, nu, axis=1), dtype=np.float64)
    sized = slopes * steps[:, None] ** np.arange(slopes.shape[1])
    first, last = slopes[:, 0], sized.sum(axis=1)
    jump = float(np.abs(first[1:] - last[:-1]).max(initial=0.0))
    at_ends = _change(motion, float(first[0]), float(last[-1]))
    if nu == 1:
        return off, 1.0 + max(jump, at_ends) / motion.peak(1), 0.0
    beyond = max(jump - motion.jump(2)[0], 0.0) + max(at_ends - _change(motion, *motion.ends(2)), 0.0)
    if powers.shape[1] <= 4:  # straight between points
        peak = float(max(np.abs(first).max(), np.abs(last).max()))
    else:
        control = bernstein.from_powers(sized)
        peak = bernstein.top(np.concatenate([control, -control])).value
    return off, max(peak / highest, 1.0), beyond / highest


def _change(motion: Motion, first: float, last: float) -> float:
    """The jump from the last value to the first where a motion repeats, else at its ends."""
    return abs(last - first) if motion.repeats else max(abs(first), abs(last))


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
