"""Laws from tables: through points exactly, or within a tolerance of them, for tables are rounded and measured."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import not_negative, numbers
from optlaws.series import chebyshev

Array = NDArray[np.float64]
Many = NDArray[Any] | Sequence[Any]

#: pieces are of this degree: displacement to snap run through
_DEGREE = 5
#: points through which a law may go; within a tolerance there may be more
MOST_THROUGH = 1_000
_MOST_PIECES = 400
#: each division tried has so many times the pieces of the one before
_FINER = 1.3
#: a law that is asked through its points misses none by more, in shares of the stroke
_MISSED = 1e-7


def law_through(k: Many, a: Many, tolerance: Any = 0.0, *, rest: bool = True) -> PiecewiseLaw:  # noqa: ANN401
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
        How far the law may be off a point, in the unit of `a`.
    rest
        Whether velocity and acceleration are 0 at both ends; else they are what the points make of them.

    Raises
    ------
    InputError
        If the points are fewer than 6, or more than 1,000 without a tolerance, do not increase in k, end where they
        began, or no division into at most 400 pieces keeps within the tolerance.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> degrees = np.linspace(0, 120, 61)
    >>> table = np.round(35 * smoothstep(5)(degrees / 120), 2)  # mm, of a law with C = 9.371976
    >>> law_through(degrees, table, tolerance=0.01)
    PiecewiseLaw(segments=7, B=2.46121, C=9.39748, D=15.363, J=79.3892)
    >>> round(law_through(degrees, table).constants.C.value, 2)  # through the rounded points
    10.16
    """
    places, heights, stroke = _points(k, a)
    room = not_negative(tolerance, "tolerance") / stroke
    return _through(places, heights, rest=rest) if room == 0.0 else _within(places, heights, room, rest=rest)


def _points(k: Many, a: Many) -> tuple[Array, Array, float]:
    """The points of a law from 0 to 1, and the stroke that they had."""
    times, positions = np.array(numbers(k, "k")), np.array(numbers(a, "a"))
    if times.shape != positions.shape or len(times) <= _DEGREE:
        raise InputError(f"a law goes through at least 6 points, as many k as a, got {len(times)} and {len(positions)}")
    if (falls := np.flatnonzero(np.diff(times) <= 0.0)).size:
        i = int(falls[0])
        raise InputError(f"k must increase from point to point, got {times[i]:g} and then {times[i + 1]:g}")
    stroke = positions[-1] - positions[0]
    if stroke == 0.0:
        raise InputError("a law ends elsewhere than it begins: give the rise and the return by themselves")
    return (times - times[0]) / (times[-1] - times[0]), (positions - positions[0]) / stroke, abs(float(stroke))


def _through(places: Array, heights: Array, *, rest: bool) -> PiecewiseLaw:
    if len(places) > MOST_THROUGH:
        raise InputError(
            f"a law goes through at most {MOST_THROUGH} points: give a tolerance, got {len(places)} points"
        )
    breaks = places if rest else np.delete(places, [1, 2, -3, -2])
    knots = _knots(breaks)
    rows, sides = _values(knots, places), heights
    if rest:
        edge = _weights(knots, 2)
        rows, sides = np.vstack([rows, edge]), np.concatenate([sides, np.zeros(len(edge))])
    law = _law(breaks, knots, np.asarray(np.linalg.solve(rows, sides), dtype=np.float64))
    if np.abs(law.a(places) - heights).max() > _MISSED:
        raise InputError("the steps of k differ too much for a law through all points: give a tolerance")
    return law


def _within(places: Array, heights: Array, room: float, *, rest: bool) -> PiecewiseLaw:
    nearest, pieces = np.inf, 0
    for count in _divisions(min(_MOST_PIECES, len(places) - _DEGREE)):
        breaks = np.linspace(0.0, 1.0, count + 1)
        knots = _knots(breaks)
        law = _law(breaks, knots, _least_squares(_values(knots, places), heights, rest=rest))
        missed = float(np.abs(law.a(places) - heights).max())
        if missed <= room:
            return law
        nearest, pieces = min((nearest, pieces), (missed, count))
    raise InputError(
        f"no law of at most {_MOST_PIECES} pieces keeps within the tolerance, {room:.3g} of the stroke: with {pieces} "
        f"it misses a point by {nearest:.3g}; raise the tolerance, or take one motion from rest to rest"
    )


def _divisions(most: int) -> Iterator[int]:
    count = 1
    while count <= most:
        yield count
        count = max(count + 1, int(_FINER * count))


def _least_squares(rows: Array, heights: Array, *, rest: bool) -> Array:
    """Coefficients of splines nearest the points; the first and the last of them are the ends."""
    held = 3 if rest else 1
    coefficients = np.concatenate([np.zeros(held), np.zeros(rows.shape[1] - 2 * held), np.ones(held)])
    free = slice(held, rows.shape[1] - held)
    coefficients[free] = np.linalg.lstsq(rows[:, free], heights - rows @ coefficients, rcond=None)[0]
    return coefficients


def _law(breaks: Array, knots: Array, coefficients: Array) -> PiecewiseLaw:
    velocity, acceleration = (_derived(knots, coefficients, nu) for nu in (1, 2))
    x = chebyshev.nodes(_DEGREE - 1)
    segments = []
    for low, high in pairwise(breaks.tolist()):
        inside = 0.5 * (low + high) + 0.5 * (high - low) * x
        c = chebyshev.from_values(_values(knots[2:-2], inside, _DEGREE - 2) @ acceleration)
        b = _values(knots[1:-1], np.array([low]), _DEGREE - 1) @ velocity
        segments.append(PolynomialSegment(tuple(c.tolist()), float(b[0])))
    return PiecewiseLaw(breaks, segments)


def _knots(breaks: Array) -> Array:
    return np.concatenate([np.zeros(_DEGREE), breaks, np.ones(_DEGREE)])


def _derived(knots: Array, coefficients: Array, nu: int) -> Array:
    """Coefficients of the derivative of order nu of a spline."""
    for i in range(nu):
        degree = _DEGREE - i
        inner = knots[i : len(knots) - i]
        coefficients = degree * np.diff(coefficients) / (inner[degree + 1 : -1] - inner[1 : -degree - 1])
    return coefficients


def _weights(knots: Array, nu: int) -> Array:
    """Rows that give the derivatives of order 1 to nu at both ends from the coefficients of a spline."""
    columns = np.eye(len(knots) - _DEGREE - 1)
    derived = [np.array([_derived(knots, column, i) for column in columns]).T for i in range(1, nu + 1)]
    return np.array([row for one_order in derived for row in (one_order[0], one_order[-1])])


def _values(knots: Array, places: Array, degree: int = _DEGREE) -> Array:
    """B-splines at places, a row for each place (de Boor's recursion)."""
    x = np.minimum(places, np.nextafter(1.0, 0.0))[:, None]
    values = ((knots[:-1] <= x) & (x < knots[1:])).astype(np.float64)
    for p in range(1, degree + 1):
        spans = knots[p:] - knots[:-p]
        shares = np.divide(x - knots[:-p], spans, out=np.zeros((len(x), len(spans))), where=spans > 0.0)
        values = shares[:, :-1] * values[:, :-1] + np.where(spans[1:] > 0.0, 1.0 - shares[:, 1:], 0.0) * values[:, 1:]
    return values
