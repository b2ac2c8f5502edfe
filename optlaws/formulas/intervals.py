"""Between which values a formula stays while its names stay between theirs: interval arithmetic, many boxes at once.

Intervals are known by their ends, since boxes may have no bound on one side; functions in narrow cells have the
middles and radii of `optlaws.numerics.interval`. Every operation is rounded outward by itself: terms that cancel each
other would else leave less than what they are rounded by.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import reduce
from math import pi

import numpy as np

from optlaws.formulas.arithmetic import pieces
from optlaws.formulas.functions import SMOOTH_FUNCTIONS
from optlaws.formulas.slopes import constant
from optlaws.formulas.tree import Call, Exponentiation, Formula, Name, Negative, Number, Product, Reciprocal, Sum, Table
from optlaws.numbers import Array
from optlaws.tolerances import OPERATIONS_ROUNDING

_MOST_ANGLE = 2.0**24


@dataclass(frozen=True, eq=False)
class Endpoints:
    """Least and greatest values, an array of each."""

    low: Array
    high: Array

    def __neg__(self) -> Endpoints:
        return Endpoints(-self.high, -self.low)

    def __add__(self, other: Endpoints) -> Endpoints:
        return Endpoints(self.low + other.low, self.high + other.high).outward()

    def __mul__(self, other: Endpoints) -> Endpoints:
        with np.errstate(invalid="ignore"):
            ends = [low * two for low in (self.low, self.high) for two in (other.low, other.high)]
        # nothing times whatever is nothing
        ends = [np.where(np.isnan(end), 0.0, end) for end in ends]
        return Endpoints(np.minimum.reduce(ends), np.maximum.reduce(ends)).outward()

    def outward(self) -> Endpoints:
        """A little wider, for the rounding of an operation; a sum or a product that is 0 is exact, and stays."""
        less, more = 1.0 - OPERATIONS_ROUNDING, 1.0 + OPERATIONS_ROUNDING
        below, above = np.where(self.low > 0.0, less, more), np.where(self.high > 0.0, more, less)
        return Endpoints(self.low * below, self.high * above)

    def through(self, function: Callable[[Array], Array]) -> Endpoints:
        """The image under a rising function."""
        with np.errstate(all="ignore"):
            return Endpoints(np.asarray(function(self.low)), np.asarray(function(self.high)))


def between(value: Array | float) -> Endpoints:
    """The intervals that hold a single number each."""
    return Endpoints(np.array(value), np.array(value))


def enclosed(formula: Formula, names: Mapping[str, Endpoints]) -> Endpoints:
    """Bounds of a formula over boxes; NaN where it has no value in a part of one.

    >>> from optlaws.formulas.reading import read
    >>> values = enclosed(read("(1 + k)^2"), {"k": Endpoints(np.array(0.0), np.array(1.0))})
    >>> round(float(values.low), 9), round(float(values.high), 9)
    (1.0, 4.0)
    """
    if isinstance(formula, Number):
        return between(formula.value)
    if isinstance(formula, Name):
        return between(pi).outward() if formula.name == "pi" and "pi" not in names else names[formula.name]
    parts = [enclosed(part, names) for part in formula.parts]
    if isinstance(formula, Negative):
        return -parts[0]
    if isinstance(formula, Sum):
        return reduce(lambda total, other: total + other, parts)
    if isinstance(formula, Product):
        return reduce(lambda product, other: product * other, parts)
    if isinstance(formula, Reciprocal):
        return _reciprocal(parts[0])
    if isinstance(formula, Exponentiation):
        return _power(parts[0], parts[1], constant(formula.exponent)).outward()
    if isinstance(formula, Table):
        return _table(formula, parts[0]).outward()
    assert isinstance(formula, Call)  # noqa: S101 - there are no others
    return _call(formula.function, parts).outward()


def _reciprocal(of: Endpoints) -> Endpoints:
    crossing = (of.low < 0.0) & (of.high > 0.0)
    with np.errstate(divide="ignore"):
        low = np.where(of.high == 0.0, -np.inf, 1.0 / of.high)
        high = np.where(of.low == 0.0, np.inf, 1.0 / of.low)
    return Endpoints(np.where(crossing, -np.inf, low), np.where(crossing, np.inf, high)).outward()


def _power(base: Endpoints, exponent: Endpoints, known: float | None) -> Endpoints:
    if known is not None and known == int(known):
        whole = int(known)
        with np.errstate(all="ignore"):
            ends = [base.low ** float(abs(whole)), base.high ** float(abs(whole))]
        low, high = np.minimum(*ends), np.maximum(*ends)
        if whole % 2 == 0:
            low = np.where((base.low <= 0.0) & (base.high >= 0.0), 0.0, low)
        interval = Endpoints(low, high)
        return interval if whole >= 0 else _reciprocal(interval)
    with np.errstate(all="ignore"):
        ends = [np.power(x, y) for x in (base.low, base.high) for y in (exponent.low, exponent.high)]
    return Endpoints(np.minimum.reduce(ends), np.maximum.reduce(ends))


def _table(table: Table, at: Endpoints) -> Endpoints:
    """The bounds of a table: the bounds of each piece over the part of the argument's range in it."""
    places, rows = np.array(table.places), pieces(table)
    # the first and the last piece go on beyond the table
    starts, stops = np.array([-np.inf, *places[1:-1]]), np.array([*places[1:-1], np.inf])
    first, last = np.searchsorted(stops[:-1], at.low), np.searchsorted(starts[1:], at.high, side="right")
    lows, highs = np.full(np.shape(at.low), np.inf), np.full(np.shape(at.low), -np.inf)
    # narrow ranges lie in few pieces: the next one of each, until all are through
    for further in range(int(np.max(last - first, initial=-1)) + 1):
        met = first + further <= last
        i = (first + further)[met]
        s = Endpoints(np.maximum(at.low[met], starts[i]), np.minimum(at.high[met], stops[i])) + between(-places[i])
        total = reduce(lambda sum_, column: between(column) + sum_ * s, rows[i].T[::-1], between(0.0))
        lows[met], highs[met] = np.minimum(lows[met], total.low), np.maximum(highs[met], total.high)
    return Endpoints(lows, highs)


def _call(function: str, parts: list[Endpoints]) -> Endpoints:
    first = parts[0]
    if function == "max":
        return reduce(lambda p, q: Endpoints(np.maximum(p.low, q.low), np.maximum(p.high, q.high)), parts)
    if function == "min":
        return reduce(lambda p, q: Endpoints(np.minimum(p.low, q.low), np.minimum(p.high, q.high)), parts)
    if function == "norm":
        squares = [_power(part, part, 2.0) for part in parts]
        return reduce(lambda total, other: total + other, squares).through(np.sqrt)
    if function == "abs":
        return Endpoints(np.maximum(np.maximum(first.low, -first.high), 0.0), np.maximum(-first.low, first.high))
    known = SMOOTH_FUNCTIONS[function]
    if known.rising:
        # where it has no value it says nothing
        return first.through(lambda x: known.numpy(np.maximum(x, 0.0) if known.from_zero else x))
    if function == "tan":
        # a pole lies where the half turns differ
        same = np.floor(first.low / pi + 0.5) == np.floor(first.high / pi + 0.5)
        tangents = first.through(np.tan)
        return Endpoints(np.where(same, tangents.low, -np.inf), np.where(same, tangents.high, np.inf))
    return _cosine(first + -between(pi / 2.0).outward() if function == "sin" else first)


def _cosine(turn: Endpoints) -> Endpoints:
    """The range of a cosine; of so large an angle that its turns are rounded nothing is known."""
    with np.errstate(invalid="ignore"):
        ends = [np.cos(turn.low), np.cos(turn.high)]
    top = np.floor(turn.high / (2 * pi)) * 2 * pi >= turn.low
    bottom = np.floor((turn.high - pi) / (2 * pi)) * 2 * pi + pi >= turn.low
    large = np.maximum(np.abs(turn.low), np.abs(turn.high)) > _MOST_ANGLE
    return Endpoints(np.where(bottom | large, -1.0, np.minimum(*ends)), np.where(top | large, 1.0, np.maximum(*ends)))
