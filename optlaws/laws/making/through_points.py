"""Laws from tables: through points exactly, or within a tolerance of them, for tables are rounded and measured."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any
from warnings import warn

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError, NoisyTable
from optlaws.laws.making.noise import noise, of_rounding, through_noise
from optlaws.laws.making.splines import DEGREE, derivatives, divisions, knots_of, law_of, nearest, values
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.numbers import not_negative, numbers

Array = NDArray[np.float64]
Many = NDArray[Any] | Sequence[Any]

#: points through which a law may go; within a tolerance there may be more
MOST_THROUGH = 1_000
_MOST_PIECES = 400
#: a law that is asked through its points misses none by more, in shares of the stroke
_MISSED = 1e-7
#: a law follows the noise if its peak acceleration is so many times that of a law that need not
_FOLLOWS_NOISE = 1.1
#: points that scatter about splines so many times as much as their differences do are off for the joints of the law
_JOINTS = 2.0
#: points that end nearer to where they began, in shares of what they pass through, have returned
_RETURNED = 0.05


def law_through(k: Many, a: Many, tolerance: Any = None, *, rest: bool = True) -> PiecewiseLaw:  # noqa: ANN401
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
        the noise of the points, rounding included, asks for: 0 where there is none to see. The noise is estimated by
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
    >>> from optlaws.laws import smoothstep
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
        size = scatter if scatter <= _JOINTS * size else size
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
    if np.abs(law.a(places) - heights).max() > _MISSED:
        raise InputError("the steps of k differ too much for a law through all points: give a tolerance")
    return law


def _joined_at(places: Array, heights: Array, *, rest: bool) -> PiecewiseLaw:
    """The law whose pieces join at the points."""
    breaks = places if rest else np.delete(places, [1, 2, -3, -2])
    knots = knots_of(breaks)
    rows, sides = values(knots, places), heights
    if rest:
        edge = derivatives(knots, 2)
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
        f"no law of at most {_MOST_PIECES} even pieces keeps within the tolerance, {room:.3g} of the stroke, and none "
        f"goes through the points: the nearest misses one by {least:.3g}; raise the tolerance, or take one motion "
        "from rest to rest"
    )


def _ever_nearer(places: Array, heights: Array, *, rest: bool) -> Iterator[PiecewiseLaw]:
    """Laws of more and more even pieces as long as the points determine them, then that through the points."""
    # the pieces have that many coefficients more than the ends have points
    beside = -1 if rest else 3
    for count in divisions(min(_MOST_PIECES, len(places) - 2 - beside)):
        spline = nearest(places, heights, count, rest=rest)
        if spline is not None:
            yield spline.law()
    if len(places) <= MOST_THROUGH:
        yield _joined_at(places, heights, rest=rest)
