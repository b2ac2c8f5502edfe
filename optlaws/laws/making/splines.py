"""Splines of degree 5 for laws of tables: their values, those nearest some points, and the laws that they are."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.series import chebyshev

Array = NDArray[np.float64]

#: displacement to snap run through
DEGREE = 5
#: each division tried has so many times the pieces of the one before
_FINER = 1.3


class Spline(NamedTuple):
    """A spline: breaks, knots, coefficients, and how many of these were free."""

    breaks: Array
    knots: Array
    coefficients: Array
    free: int

    def __call__(self, places: Array) -> Array:
        """Its values."""
        return values(self.knots, places) @ self.coefficients

    def law(self) -> PiecewiseLaw:
        """The law of a spline, whose ends become 0 and 1."""
        first, last = self.coefficients[0], self.coefficients[-1]
        return law_of(self.breaks, self.knots, (self.coefficients - first) / (last - first))


def divisions(most: int) -> Iterator[int]:
    """Numbers of pieces to try, each larger than the one before.

    Examples
    --------
    >>> list(divisions(10))
    [1, 2, 3, 4, 5, 6, 7, 9]
    """
    count = 1
    while count <= most:
        yield count
        count = max(count + 1, int(_FINER * count))


def nearest(places: Array, heights: Array, count: int, *, rest: bool, known: bool = True) -> Spline | None:
    """The spline of even pieces nearest the points by least squares; None where the points do not determine it.

    With `rest` it begins and ends in rest; its ends are at 0 and 1 where they are known, else as the points have them.
    """
    breaks = np.linspace(0.0, 1.0, count + 1)
    knots = knots_of(breaks)
    same = 3 if rest else 1
    rows = values(knots, places)
    free = np.column_stack([rows[:, :same].sum(axis=1), rows[:, same:-same], rows[:, -same:].sum(axis=1)])
    found = np.concatenate([np.zeros(free.shape[1] - 1), [1.0]])
    inner = slice(1, -1) if known else slice(None)
    sides = heights - free[:, -1] if known else heights
    found[inner], _, rank, _ = np.linalg.lstsq(free[:, inner], sides, rcond=None)
    coefficients = np.concatenate([np.full(same, found[0]), found[1:-1], np.full(same, found[-1])])
    return Spline(breaks, knots, coefficients, rank) if rank == free[:, inner].shape[1] else None


def law_of(breaks: Array, knots: Array, coefficients: Array) -> PiecewiseLaw:
    """The law of a spline from its coefficients."""
    velocity, acceleration = (_derived(knots, coefficients, nu) for nu in (1, 2))
    x = chebyshev.nodes(DEGREE - 1)
    segments = []
    for low, high in pairwise(breaks.tolist()):
        inside = 0.5 * (low + high) + 0.5 * (high - low) * x
        c = chebyshev.from_values(values(knots[2:-2], inside, DEGREE - 2) @ acceleration)
        b = values(knots[1:-1], np.array([low]), DEGREE - 1) @ velocity
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


def derivatives(knots: Array, nu: int) -> Array:
    """Rows that give the derivatives of order 1 to nu at both ends from the coefficients of a spline."""
    columns = np.eye(len(knots) - DEGREE - 1)
    derived = [np.array([_derived(knots, column, i) for column in columns]).T for i in range(1, nu + 1)]
    return np.array([row for one_order in derived for row in (one_order[0], one_order[-1])])


def values(knots: Array, places: Array, degree: int = DEGREE) -> Array:
    """B-splines at places, a row for each place (de Boor's recursion)."""
    x = np.minimum(places, np.nextafter(1.0, 0.0))[:, None]
    splines = ((knots[:-1] <= x) & (x < knots[1:])).astype(np.float64)
    for p in range(1, degree + 1):
        spans = knots[p:] - knots[:-p]
        shares = np.divide(x - knots[:-p], spans, out=np.zeros((len(x), len(spans))), where=spans > 0.0)
        fall = np.where(spans[1:] > 0.0, 1.0 - shares[:, 1:], 0.0)
        splines = shares[:, :-1] * splines[:, :-1] + fall * splines[:, 1:]
    return splines
