"""Curves of stated functions, polynomials and standard laws between points, and the law of several of them.

The points of a table stand with the functions between them, whatever the layout of its file.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import dataclass
from itertools import pairwise, zip_longest
from math import factorial, perm
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.polynomial import polyval

from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.law import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array
from optlaws.numerics import chebyshev

#: of the positions: by how much pieces may be apart where they meet, as REAL32 leaves them
APART = 1e-6
#: of a number in single precision: its last digit
REAL32 = 2.0**-23

_JOINED = range(3)  # the orders of the derivatives in which pieces are made to meet

_POLYNOMIAL = re.compile(r"POLY(?:NOM(?:IAL)?)?_?([1357])(?:_MM)?", re.IGNORECASE)
_DEGREES = {"linear": 1, "line": 1, "dwell": 1, "polyfive": 5}
#: profiles after the last point, which run nowhere
_NONE = ("notdef", "undefined", "nonextsegment")


class CurvePiece(NamedTuple):
    """A piece of a curve between two places.

    Attributes
    ----------
    start, stop
        Where it begins and ends.
    values
        Coefficients of ascending powers of u, which goes from 0 to 1; of a standard law its first position and stroke.
    law
        The name of a standard law; empty for a polynomial.
    """

    start: float
    stop: float
    values: tuple[float, ...]
    law: str = ""

    @property
    def length(self) -> float:
        """From its start to its stop."""
        return self.stop - self.start

    @property
    def ends(self) -> tuple[float, float]:
        """The positions where it begins and ends."""
        return self.values[0], sum(self.values)

    def at(self, u: Array, nu: int = 0) -> Array:
        """The derivative of order nu by the place, 0 for positions, at places from 0 to 1 within it.

        >>> CurvePiece(10.0, 12.0, (1.0, 0.0, 2.0)).at(np.array([0.0, 1.0])).tolist()
        [1.0, 3.0]
        """
        if self.law:
            values = (0.0 if nu else self.values[0]) + self.values[1] * np.asarray(catalogue[self.law].law(u, nu))
        else:
            values = np.asarray(
                polyval(u, [perm(n, nu) * value for n, value in enumerate(self.values)][nu:] or [0.0]), np.float64
            )
        return np.asarray(values / self.length**nu)

    def between(self, low: float, high: float) -> CurvePiece:
        """The part of a polynomial between two of its places from 0 to 1."""
        part = Polynomial(self.values)(Polynomial([low, high - low]))
        ends = (self.start + low * self.length, self.stop if high == 1.0 else self.start + high * self.length)
        return CurvePiece(*ends, tuple(np.atleast_1d(part.coef).tolist()))

    def scaled(self, length: float, size: float) -> CurvePiece:
        """The piece in other units of places and of positions."""
        return self._replace(
            start=length * self.start, stop=length * self.stop, values=tuple(size * value for value in self.values)
        )


def powers(start: float, stop: float, coefficients: Sequence[float]) -> CurvePiece:
    """The piece of ascending powers of the distance from where it begins.

    >>> powers(10.0, 12.0, [1.0, 0.0, 0.5])
    CurvePiece(start=10.0, stop=12.0, values=(1.0, 0.0, 2.0), law='')
    """
    length = _length(start, stop)
    return CurvePiece(start, stop, tuple(value * length**n for n, value in enumerate(coefficients)))


def hermite(start: float, stop: float, first: Sequence[float], last: Sequence[float]) -> CurvePiece:
    """The polynomial with a position and derivatives at each end, as many as are given there.

    >>> hermite(0.0, 2.0, [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]).at(np.array([0.5]))
    array([0.5])
    """
    length = _length(start, stop)
    known = [value * length**i / factorial(i) for i, value in enumerate(first)]
    orders, count = len(last), len(first) + len(last)
    rows = np.array([[perm(n, i) for n in range(count)] for i in range(orders)], dtype=np.float64)
    sides = [value * length**i for i, value in enumerate(last)] - rows[:, : len(known)] @ known
    return CurvePiece(start, stop, (*known, *np.linalg.solve(rows[:, len(known) :], sides).tolist()))


def degree_of(profile: str) -> int | None:
    """The degree of the polynomials that a profile means by its name; None of another one.

    >>> degree_of("POLYNOM5_MM"), degree_of("Linear"), degree_of("SINUSLINIE")
    (5, 1, None)
    """
    match = _POLYNOMIAL.fullmatch(profile)
    return int(match[1]) if match else _DEGREES.get(profile.lower())


def of_profile(
    profile: str | None, places: tuple[float, float], first: Sequence[float], last: Sequence[float]
) -> CurvePiece:
    """The piece of a profile by its name, between two places with the position and its derivatives at each.

    It is a polynomial ("POLYNOM5_MM", "Polynomial5", "Linear"), or a law of the catalogue between two rests; None is
    the polynomial of all that is given.
    """
    known = min(len(first), len(last))
    if profile is None or profile.lower() in _NONE:
        return hermite(*places, first[:known], last[:known])
    degree = degree_of(profile)
    if degree is not None:
        orders = (degree + 1) // 2
        if known < orders:
            raise InputError(f"{profile} needs the position and {orders - 1} derivatives at both ends")
        return hermite(*places, first[:orders], last[:orders])
    if profile not in catalogue:
        raise InputError(f"there is no profile {shortened(profile)} that is known here")
    if any(first[1:2]) or any(last[1:2]):
        raise InputError(f"{profile} goes from rest to rest, and a velocity is given at an end: it is not known here")
    _length(*places)
    return CurvePiece(*places, (first[0], last[0] - first[0]), catalogue[profile].name)


def pieces_between(
    points: Sequence[Sequence[float]], profiles: Sequence[str | None], lines: Sequence[int], *, endless: bool = False
) -> list[CurvePiece]:
    """The pieces between points of a place, a position and derivatives, by the profile behind each point.

    A polynomial beside a straight line begins or ends with its slope, and without acceleration, where a point gives no
    velocity; the last piece of an endless table is beside the first one.

    >>> pieces = pieces_between([[0.0, 0.0], [1.0, 1.0], [3.0, 1.0, 0.0, 0.0]], ["line", "polyfive"], [1, 2, 3])
    >>> [float(piece.at(np.array([0.0]), 1)[0]) for piece in pieces]
    [1.0, 1.0]
    """
    count = len(points) - 1
    straight = [profile is not None and degree_of(profile) == 1 for profile in profiles[:count]]
    slopes = [(b[1] - a[1]) / (b[0] - a[0]) if b[0] != a[0] else 0.0 for a, b in pairwise(points)]

    def conditions(place: int, beside: int) -> Sequence[float]:
        """Position and derivatives at a point, of the line beside it where it gives no velocity."""
        known = points[place][1:]
        goes_on = len(known) == 1 and (endless or 0 <= beside < count) and straight[beside % count]
        return [known[0], slopes[beside % count], 0.0] if goes_on else known

    pieces = []
    for i in range(count):
        with located(f"line {lines[i]}"):
            ends = conditions(i, i - 1), conditions(i + 1, i + 1)
            pieces.append(of_profile(profiles[i], (points[i][0], points[i + 1][0]), *ends))
    return pieces


def check_joints(pieces: Sequence[CurvePiece], lines: Sequence[int]) -> None:
    """Refuse pieces that do not follow each other; they begin in these lines of their file."""
    size = max(abs(value) for piece in pieces for value in piece.ends)
    for line, (before, after) in zip(lines[1:], pairwise(pieces), strict=False):
        stop, start = before.ends[1], after.ends[0]
        if before.stop != after.start or abs(stop - start) > APART * size:
            raise InputError(
                f"line {line}: a piece ends at {before.stop:.9g} with the position {stop:.9g} and the next begins at "
                f"{after.start:.9g} with {start:.9g}: the pieces do not follow each other, mend one"
            )


def joined(pieces: Sequence[CurvePiece]) -> list[CurvePiece]:
    """Pieces without the differences that single precision leaves where they meet, also the last one and the first one.

    Positions, velocities and accelerations that differ by no more than rounding of their coefficients and places are
    made equal, by polynomials of degree 5 that are as small; other jumps stay.

    >>> parts = joined([powers(0.0, 1.0, [0.0, 0.0, 1.0]), powers(1.0, 2.0, [1.0, 2.0000001])])
    >>> parts[0].at(np.array([1.0]), 1) == parts[1].at(np.array([0.0]), 1)
    array([ True])
    """
    ends = [[[float(piece.at(np.array([u]), nu)[0]) for nu in _JOINED] for u in (0.0, 1.0)] for piece in pieces]
    common = deepcopy(ends)
    for i, before in enumerate(pieces):
        j = (i + 1) % len(pieces)
        for nu in _JOINED[1:] if j == 0 else _JOINED:  # a turn may end elsewhere than it begins
            sides = ends[i][1][nu], ends[j][0][nu]
            room = _rounding(before, nu) + _rounding(pieces[j], nu)
            if abs(sides[0] - sides[1]) > room:
                continue
            exact = [side for side, piece in zip(sides, (before, pieces[j]), strict=True) if not _is_curve(piece)]
            level = exact[0] if exact else 0.0 if nu and max(map(abs, sides)) <= room else sides[1]
            common[i][1][nu] = common[j][0][nu] = level
    return [
        piece._replace(values=_moved(piece, old, new)) if old != new and _is_curve(piece) else piece
        for piece, old, new in zip(pieces, ends, common, strict=True)
    ]


def _is_curve(piece: CurvePiece) -> bool:
    """Whether it is a polynomial that is not constant."""
    return not piece.law and any(piece.values[1:])


def _rounding(piece: CurvePiece, nu: int) -> float:
    """What single precision of its coefficients and of the places of its ends may change in a derivative."""
    sizes = [
        sum(perm(n, order) * abs(value) for n, value in enumerate(piece.values)) / piece.length**order
        for order in (nu, nu + 1)
    ]
    return REAL32 * (sizes[0] + sizes[1] * max(abs(piece.start), abs(piece.stop)))


def _moved(piece: CurvePiece, old: Sequence[Sequence[float]], new: Sequence[Sequence[float]]) -> tuple[float, ...]:
    """The coefficients of a piece with other values and derivatives at its ends."""
    changes = [[b - a for a, b in zip(*each, strict=True)] for each in zip(old, new, strict=True)]
    change = hermite(piece.start, piece.stop, *changes).values
    return tuple(a + b for a, b in zip_longest(piece.values, change, fillvalue=0.0))


def law_of_pieces(pieces: Sequence[CurvePiece]) -> MotionLaw:
    """The law of pieces that follow each other, from their first position to their last one.

    >>> law_of_pieces([powers(0.0, 2.0, [5.0, 0.0, 1.0]), powers(2.0, 4.0, [9.0, 4.0, -1.0])]).constants.C
    Peak(value=4.0, k=0.0)
    """
    if len(pieces) == 1 and pieces[0].law:
        return catalogue[pieces[0].law].law
    breaks, stroke = [*(piece.start for piece in pieces), pieces[-1].stop], pieces[-1].ends[1] - pieces[0].ends[0]

    def at(place: Array, i: int, nu: int) -> Array:
        return pieces[i].at((place - pieces[i].start) / pieces[i].length, nu)

    return law_of_curve(breaks, stroke, [len(piece.values) - 1 for piece in pieces], at)


def law_of_curve(
    breaks: Sequence[float], stroke: float, degrees: Sequence[int], derivative: Callable[[Array, int, int], Array]
) -> MotionLaw:
    """The law of polynomials between breaks, by their derivatives at places, with their number and the order.

    >>> law_of_curve([0.0, 2.0], 4.0, [2], lambda x, i, nu: 2.0 * x ** (2 - nu)).constants.C
    Peak(value=2.0, k=0.0)
    """
    start, length, segments = breaks[0], breaks[-1] - breaks[0], []
    for i, ((low, high), degree) in enumerate(zip(pairwise(breaks), degrees, strict=True)):
        places = low + 0.5 * (high - low) * (chebyshev.nodes(max(degree - 1, 1)) + 1.0)
        acceleration = chebyshev.from_values(derivative(places, i, 2) * (length**2 / stroke))
        slope = float(derivative(np.array([low]), i, 1)[0]) * length / stroke
        segments.append(PolynomialSegment(tuple(acceleration.tolist()), slope))
    return PiecewiseLaw([0.0, *((place - start) / length for place in breaks[1:-1]), 1.0], segments)


def _length(start: float, stop: float) -> float:
    if not stop > start:
        raise InputError(
            f"the master goes from {start:.9g} to {stop:.9g}: places must increase, and a file hold one cam"
        )
    return stop - start


class TableUnits(NamedTuple):
    """The units of the master and of positions; empty where they are not known."""

    master: str = ""
    slave: str = ""


NO_UNITS = TableUnits()


@dataclass(frozen=True)
class TablePoints:
    """The points of a table, and the functions between them where it states these.

    Attributes
    ----------
    places, heights
        Times, angles or lengths, and positions, as the table has them, arrays of shape (n,).
    digit
        The unit of the last digit of the positions; 0 where functions are stated.
    layout
        What the file is.
    pieces
        What runs between the points; empty where that is not stated.
    units
        Where the layout says them; of columns the headings.
    lines
        Where the points stand in the file.
    rate
        How many units of the master go by in a second, where the file says it.
    """

    places: Array
    heights: Array
    digit: float
    layout: str
    pieces: tuple[CurvePiece, ...] = ()
    units: TableUnits = NO_UNITS
    lines: Sequence[int] = ()
    rate: float | None = None

    @classmethod
    def of_pieces(
        cls, pieces: Sequence[CurvePiece], layout: str, lines: Sequence[int], units: TableUnits = NO_UNITS
    ) -> TablePoints:
        """Pieces that follow each other, with the points where they meet."""
        check_joints(pieces, lines)
        pieces = joined(pieces)
        places = [*(piece.start for piece in pieces), pieces[-1].stop]
        heights = [*(piece.ends[0] for piece in pieces), pieces[-1].ends[1]]
        return cls(np.array(places), np.array(heights), 0.0, layout, tuple(pieces), units, lines)


def resolution_of(texts: Sequence[str], values: Sequence[float] | Array) -> float:
    """The unit of the last digit of the large values: small values have more decimals, round ones fewer.

    >>> resolution_of(["0.0001", "12.5", "30.25"], [0.0001, 12.5, 30.25])
    0.01
    """
    large = 0.1 * max(map(abs, values))
    return min(_last_digit(text) for text, value in zip(texts, values, strict=True) if abs(value) >= large)


def _last_digit(text: str) -> float:
    digits, _, exponent = text.replace(",", ".").lower().partition("e")
    return float(f"1e{int(exponent or 0) - len(digits.partition('.')[2])}")
