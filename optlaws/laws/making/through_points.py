"""Laws from tables: through points exactly, or within a tolerance of them, for tables are rounded and measured."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import inf, sqrt
from typing import Any, NamedTuple
from warnings import warn

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from optlaws.errors import InputError, NoisyTable
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array, not_negative, numbers
from optlaws.numerics import chebyshev

_THROUGH_POINTS = 1e-7  # of the stroke, by which a law misses its points

#: displacement to snap run through
DEGREE = 5
#: each division tried has so many times the pieces of the one before
_FINER = 1.3


class LawSpline(NamedTuple):
    """A spline: breaks, knots, coefficients, and how many of these were free."""

    breaks: Array
    knots: Array
    coefficients: Array
    free: int

    def __call__(self, places: Array) -> Array:
        """The values of the spline at places."""
        return spline_values(self.knots, places) @ self.coefficients

    def law(self) -> PiecewiseLaw:
        """The law of a spline, whose ends become 0 and 1."""
        first, last = self.coefficients[0], self.coefficients[-1]
        return law_of(self.breaks, self.knots, (self.coefficients - first) / (last - first))


def divisions(most: int) -> Iterator[int]:
    """Numbers of pieces to try, in ascending order.

    Examples
    --------
    >>> list(divisions(10))
    [1, 2, 3, 4, 5, 6, 7, 9]
    """
    count = 1
    while count <= most:
        yield count
        count = max(count + 1, int(_FINER * count))


def nearest_spline(places: Array, heights: Array, count: int, *, rest: bool, known: bool = True) -> LawSpline | None:
    """The spline of even pieces nearest the points by least squares; None where the points do not determine it.

    With `rest` it begins and ends in rest; its ends are at 0 and 1 where they are known, else as the points have them.
    """
    breaks = np.linspace(0.0, 1.0, count + 1)
    knots = knots_of(breaks)
    same = 3 if rest else 1
    rows = spline_values(knots, places)
    free = np.column_stack([rows[:, :same].sum(axis=1), rows[:, same:-same], rows[:, -same:].sum(axis=1)])
    solution = np.concatenate([np.zeros(free.shape[1] - 1), [1.0]])
    inner = slice(1, -1) if known else slice(None)
    sides = heights - free[:, -1] if known else heights
    solution[inner], _, rank, _ = np.linalg.lstsq(free[:, inner], sides, rcond=None)
    coefficients = np.concatenate([np.full(same, solution[0]), solution[1:-1], np.full(same, solution[-1])])
    return LawSpline(breaks, knots, coefficients, rank) if rank == free[:, inner].shape[1] else None


def law_of(breaks: Array, knots: Array, coefficients: Array) -> PiecewiseLaw:
    """The law of a spline from its coefficients."""
    velocity, acceleration = (_derived(knots, coefficients, nu) for nu in (1, 2))
    x = chebyshev.nodes(DEGREE - 1)
    segments = []
    for low, high in pairwise(breaks.tolist()):
        inside = 0.5 * (low + high) + 0.5 * (high - low) * x
        c = chebyshev.from_values(spline_values(knots[2:-2], inside, DEGREE - 2) @ acceleration)
        b = spline_values(knots[1:-1], np.array([low]), DEGREE - 1) @ velocity
        segments.append(PolynomialSegment(tuple(c.tolist()), float(b[0])))
    return PiecewiseLaw(breaks, segments)


def knots_of(breaks: Array) -> Array:
    """Knots of splines that pass breaks with four derivatives, and end in them."""
    return np.concatenate([np.zeros(DEGREE), breaks, np.ones(DEGREE)])


def _derived(knots: Array, coefficients: Array, nu: int) -> Array:
    """Coefficients of the derivative of order nu of a spline."""
    for i in range(nu):
        degree = DEGREE - i
        inner = knots[i : len(knots) - i]
        coefficients = degree * np.diff(coefficients) / (inner[degree + 1 : -1] - inner[1 : -degree - 1])
    return coefficients


def end_derivatives(knots: Array, nu: int) -> Array:
    """Rows that give the derivatives of order 1 to nu at both ends from the coefficients of a spline."""
    columns = np.eye(len(knots) - DEGREE - 1)
    derived = [np.array([_derived(knots, column, i) for column in columns]).T for i in range(1, nu + 1)]
    return np.array([row for one_order in derived for row in (one_order[0], one_order[-1])])


def spline_values(knots: Array, places: Array, degree: int = DEGREE) -> Array:
    """B-splines at places, a row for each place (de Boor's recursion)."""
    x = np.minimum(places, np.nextafter(1.0, 0.0))[:, None]
    splines = ((knots[:-1] <= x) & (x < knots[1:])).astype(np.float64)
    for p in range(1, degree + 1):
        spans = knots[p:] - knots[:-p]
        shares = np.divide(x - knots[:-p], spans, out=np.zeros((len(x), len(spans))), where=spans > 0.0)
        fall = np.where(spans[1:] > 0.0, 1.0 - shares[:, 1:], 0.0)
        splines = shares[:, :-1] * splines[:, :-1] + fall * splines[:, 1:]
    return splines


#: orders of the differences: high enough to hide a smooth law, and few enough points for its joints not to fill them
_ORDERS = range(4, 9)
#: fewer points tell no noise from the joints of a law's pieces
_FEWEST = 31
#: noise that changes the acceleration of a law through the points by less is none, in units of stroke over time squared
_UNSEEN = 0.1
#: the mean of the lower half of the sizes of normal deviates
_LOWER_HALF = 0.324672
#: pieces of the splines to which the points are compared, and numbers in their matrices
_MOST_COMPARED = 200
_LARGEST = 2_000_000
#: by how much, times the number of points to the power -1/2, the square of the estimate passes that of rounding in one
#: of a thousand rounded tables (65 to 1,000 points simulated: 20 to 25)
_BEYOND_ROUNDING = 25.0
#: times the number of points to the power -1/2: splines that scatter no more above the best are as good
_AS_GOOD = 1.5


def noise(places: Array, heights: Array) -> float:
    """The standard deviation of the points' scatter; 0 where it is zero, or there are too few points.

    Divided differences of points on a smooth law become small as their order rises, those of white noise do not; joints
    of the law may show in them as noise.

    Examples
    --------
    >>> k = np.linspace(0.0, 1.0, 361)
    >>> exact = k**3 * (10 - 15 * k + 6 * k**2)
    >>> noise(k, exact), round(noise(k, exact + np.random.default_rng(1).normal(0.0, 1e-4, 361)), 5)
    (0.0, 0.0001)
    """
    if len(places) < _FEWEST:
        return 0.0
    scatters = [_scatter(places, heights, order) for order in _ORDERS]
    steps = _step_of_rounding(heights) / sqrt(12.0)
    if 6.0 * max(steps, min(scatters)) <= _UNSEEN * float(np.median(np.diff(places))) ** 2:
        return 0.0
    return max(steps, float(np.median(scatters[-3:])))


def of_rounding(size: float, unit: float, count: int) -> bool:
    """Whether noise of a size, estimated from a number of points, may be rounding to a unit alone.

    Examples
    --------
    >>> of_rounding(0.003, 0.01, 361), of_rounding(0.005, 0.01, 361)
    (True, False)
    """
    return size**2 <= unit**2 / 12.0 * (1.0 + _BEYOND_ROUNDING / sqrt(count))


def through_noise(places: Array, heights: Array, *, rest: bool) -> tuple[float, LawSpline]:
    """The scatter about the spline that best predicts left-out points, and the simplest spline as good.

    The first is that of generalised cross-validation (Craven and Wahba); of the others that scatter no more than
    chance explains the one of fewest pieces is taken. Its ends are free, for the first and the last point scatter too.
    """
    count = len(places)
    best, splines = (inf, inf), []
    for pieces in divisions(max(1, min(_MOST_COMPARED, count // 2, _LARGEST // count))):
        spline = nearest_spline(places, heights, pieces, rest=rest, known=False)
        if spline is not None:
            squares = float(((spline(places) - heights) ** 2).sum())
            splines.append((sqrt(squares / (count - spline.free)), spline))
            best = min(best, (squares / (count - spline.free) ** 2, splines[-1][0]))
    enough = best[1] * (1.0 + _AS_GOOD / sqrt(count))
    return best[1], next(spline for scatter, spline in splines if scatter <= enough)


def _scatter(places: Array, heights: Array, order: int) -> float:
    """The size of white noise whose divided differences are as large as the points' divided differences."""
    k, a = sliding_window_view(places / np.median(np.diff(places)), order + 1), sliding_window_view(heights, order + 1)
    apart = k[:, :, None] - k[:, None, :] + np.eye(order + 1)
    weights = 1.0 / apart.prod(axis=2)
    sizes = np.sort(np.abs((weights * a).sum(axis=1)) / np.sqrt((weights**2).sum(axis=1)))
    # the larger half may be those of the law's joints
    return float(sizes[: (len(sizes) + 1) // 2].mean()) / _LOWER_HALF


def _step_of_rounding(heights: Array) -> float:
    """The unit of heights so coarse that most of them come more than once; else 0."""
    levels = np.unique(heights)
    return float(np.diff(levels).min()) if 2 * len(levels) <= len(heights) else 0.0


Many = NDArray[Any] | Sequence[Any]

#: points through which a law may go; within a tolerance there may be more
MOST_THROUGH = 1_000
_MOST_PIECES = 400
#: a law follows the noise if its peak acceleration is so many times that of a law that need not
_FOLLOWS_NOISE = 1.1
#: points that end nearer to where they began, in shares of what they pass through, have returned
_RETURNED = 0.05


def law_through(k: Many, a: Many, tolerance: Any = None, *, rest: bool = True) -> PiecewiseLaw:
    """The law of a table: of pieces of degree 5, through its points or within a tolerance of them.

    Without a tolerance the pieces join at the points. With one they are even, as few as keep every point within it by
    least squares; this is for tables that are rounded or measured, for a law through rounded points has the wrong
    acceleration: 6 times the rounding over the square of the step. Displacement to snap have no jumps inside.

    Parameters
    ----------
    k
        Times or angles of the points, increasing, in any unit; the first becomes k = 0, the last k = 1.
    a
        Displacements there, in any unit; the first becomes 0, the last 1.
    tolerance
        How far the law may be off a point, in the unit of `a`; 0 for a law through the points. Unless given it is what
        the noise of the points, rounding included, requires: 0 where there is none to see. The noise is estimated by
        the higher differences of 31 points or more, and fewer are taken as exact.
    rest
        Whether velocity and acceleration are 0 at both ends; else they are what the points make of them.

    Warns
    -----
    NoisyTable
        If no tolerance is given and the points are noisy.

    Raises
    ------
    InputError
        If the points are fewer than 6, or more than 1,000 without a tolerance, do not increase in k, end where they
        began, or more than 1,000 points are farther from all laws of 400 even pieces than the tolerance.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> degrees = np.linspace(0, 120, 61)
    >>> table = np.round(35 * smoothstep(5)(degrees / 120), 2)  # mm, of a law with C = 9.371976
    >>> law_through(degrees, table, tolerance=0.01)
    PiecewiseLaw(segments=7, B=2.46121, C=9.39748, D=15.363, J=79.3892)
    >>> round(law_through(degrees, table, tolerance=0).constants.C.value, 2)  # through the rounded points
    10.16
    """
    if tolerance is None:
        return law_of_table(k, a, rest=rest)
    places, heights, stroke = _points(k, a)
    return _near(places, heights, not_negative(tolerance, "tolerance") / stroke, rest=rest)


def law_of_table(
    k: Many, a: Many, unit: float = 0.0, *, rest: bool = True, lines: Sequence[int] | None = None
) -> PiecewiseLaw:
    """The law of a table as exact as its last digit, or only as its noise lets it be, which is then warned of.

    Parameters
    ----------
    k, a, rest
        As of `law_through`.
    unit
        That of the last digit, in the unit of `a`; 0 where the digits are as many as floats have.
    lines
        Where the points stand in a file, for errors.

    Warns
    -----
    NoisyTable
        If a law as near as the digits suggest would follow the noise.

    Raises
    ------
    InputError
        If the points make no law.
    """
    places, heights, stroke = _points(k, a, lines)
    room, count = unit / stroke, len(places)
    size = noise(places, heights)
    if size > 0.0:
        scatter, spline = through_noise(places, heights, rest=rest)
        # joints of the law, and ends not in rest, show in either as noise
        size = min(size, scatter)
    if of_rounding(size, room, count):
        return _near(places, heights, room, rest=rest)
    smooth = spline.law()
    if count <= MOST_THROUGH:
        exact = _near(places, heights, room, rest=rest)
        if exact.constants.C.value <= _FOLLOWS_NOISE * smooth.constants.C.value:
            return exact
    missed = float(np.abs(spline(places) - heights).max())
    warn(
        f"the points scatter by {size * stroke:.2g} (standard deviation) about any smooth law: this one keeps within "
        f"{missed * stroke:.2g} of them; give a tolerance for another, 0 for the law through all points",
        NoisyTable,
        stacklevel=3,
    )
    return smooth


def _points(k: Many, a: Many, lines: Sequence[int] | None = None) -> tuple[Array, Array, float]:
    """The points of a law from 0 to 1, and the stroke that they had."""
    times, positions = np.array(numbers(k, "k")), np.array(numbers(a, "a"))
    if times.shape != positions.shape or len(times) <= DEGREE:
        raise InputError(f"a law goes through at least 6 points, as many k as a, got {len(times)} and {len(positions)}")
    called, at = ("points", range(len(times))) if lines is None else ("lines", lines)
    if (falls := np.flatnonzero(np.diff(times) <= 0.0)).size:
        i = int(falls[0])
        raise InputError(
            f"k must increase from point to point, got {times[i]:g} and then {times[i + 1]:g} ({called} {at[i]} and "
            f"{at[i + 1]}): sort them by k, and keep one where several have the same"
        )
    stroke = positions[-1] - positions[0]
    if abs(stroke) <= _RETURNED * np.ptp(positions):
        far = np.abs(positions - positions[0])
        top = np.flatnonzero(far == far.max())
        raise InputError(
            f"a law ends elsewhere than it begins, and these points return to {positions[-1]:g}: they turn at "
            f"k = {times[top[0]]:g}, a = {positions[top[0]]:g}; give the rise and the return by themselves, {called} "
            f"{at[0]} to {at[top[0]]} and {at[top[-1]]} to {at[-1]}"
        )
    return (times - times[0]) / (times[-1] - times[0]), (positions - positions[0]) / stroke, abs(float(stroke))


def _near(places: Array, heights: Array, room: float, *, rest: bool) -> PiecewiseLaw:
    return _through(places, heights, rest=rest) if room == 0.0 else _within(places, heights, room, rest=rest)


def _through(places: Array, heights: Array, *, rest: bool) -> PiecewiseLaw:
    if len(places) > MOST_THROUGH:
        raise InputError(
            f"a law goes through at most {MOST_THROUGH} points: give a tolerance, got {len(places)} points"
        )
    law = _joined_at(places, heights, rest=rest)
    if np.abs(law.a(places) - heights).max() > _THROUGH_POINTS:
        raise InputError("the steps of k differ too much for a law through all points: give a tolerance")
    return law


def _joined_at(places: Array, heights: Array, *, rest: bool) -> PiecewiseLaw:
    """The law whose pieces join at the points."""
    breaks = places if rest else np.delete(places, [1, 2, -3, -2])
    knots = knots_of(breaks)
    rows, sides = spline_values(knots, places), heights
    if rest:
        edge = end_derivatives(knots, 2)
        rows, sides = np.vstack([rows, edge]), np.concatenate([sides, np.zeros(len(edge))])
    return law_of(breaks, knots, np.asarray(np.linalg.solve(rows, sides), dtype=np.float64))


def _within(places: Array, heights: Array, room: float, *, rest: bool) -> PiecewiseLaw:
    least = np.inf
    for law in _ever_nearer(places, heights, rest=rest):
        missed = float(np.abs(law.a(places) - heights).max())
        if missed <= room:
            return law
        least = min(least, missed)
    raise InputError(
        f"no law of at most {_MOST_PIECES} equal pieces is within the tolerance, {room:.3g} of the stroke, and none "
        f"goes through the points: the nearest deviates by {least:.3g}; raise the tolerance, or take one motion "
        "from rest to rest"
    )


def _ever_nearer(places: Array, heights: Array, *, rest: bool) -> Iterator[PiecewiseLaw]:
    """Laws of more and more even pieces as long as the points determine them, then that through the points."""
    # the pieces have that many coefficients more than the ends have points
    beside = -1 if rest else 3
    for count in divisions(min(_MOST_PIECES, len(places) - 2 - beside)):
        spline = nearest_spline(places, heights, count, rest=rest)
        if spline is not None:
            yield spline.law()
    if len(places) <= MOST_THROUGH:
        yield _joined_at(places, heights, rest=rest)
