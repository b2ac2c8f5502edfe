"""Extremes and integrals of functions with every error enclosed: Taylor polynomials with their remainders on cells."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import reduce
from typing import Any

from flint import arb, arb_mat, arb_poly, arb_series, ctx, fmpq_poly

from optlaws.tolerances import TAYLOR_REST
from optlaws.verification.enclosing.balls import Extremes, ball, series_length

_GREATEST_ENCLOSED = 2.0**-70  # of a greatest value: how narrow its ball must be
_GREATEST_NEGLIGIBLE = 2.0**-110  # of what a function is made of: a greatest value that is less is enclosed well enough

#: bits with which the greatest value is searched, and how short a part is cut no further
_BITS, _SHORTEST = 192, Fraction(1, 2**60)
_WHOLE = (Fraction(-1), Fraction(1))
#: terms of Taylor polynomials; how short a cell is cut no further, and after how many none is
_TERMS, _LEAST, _MOST = 24, Fraction(1, 2**70), 1 << 12

#: a function by its Taylor series; coefficients beyond what it is smooth to are not finite
Smooth = Callable[[arb_series], arb_series]
Ends = tuple[Fraction, Fraction]
#: coefficients of a polynomial, and how far a function is off it at most
Taylor = tuple[list[Any], arb]


def extremes(function: Smooth, start: Fraction, stop: Fraction) -> Extremes:
    """Balls that hold the least and the greatest value of a function between two places.

    >>> least, greatest = extremes(lambda s: s.sin(), Fraction(0), Fraction(3))
    >>> greatest.contains(1), float(greatest.rad()) < 1e-12
    (True, True)
    """
    first, last = (function(arb_series([ball(k)]))[0] for k in (start, stop))
    size = 1 + abs(first).max(abs(last)).upper()
    if not size.is_finite():
        return arb.nan(), arb.nan()
    most = size * max(TAYLOR_REST, 2.0 ** (8 - ctx.prec))

    def enough(parts: Sequence[Taylor], _: Fraction) -> bool:
        return bool(parts[0][1] <= most)

    several = cells(lambda s: [function(s)], arb_series, (start, stop), _LEAST, enough)
    parts = [(arb_poly(centre), rest) for _, [(centre, rest)] in several]
    return -greatest_magnitude(parts, (-1.0,)), greatest_magnitude(parts, (1.0,))


def cells(
    functions: Callable[[Any], Sequence[Any]],
    variable: Callable[[list[Any]], Any],
    ends: Ends,
    shortest: Fraction,
    enough: Callable[[Sequence[Taylor], Fraction], bool],
    *,
    terms: int = _TERMS,
    most: float = _MOST,
) -> Iterator[tuple[Ends, list[Taylor]]]:
    """Many cells with Taylor polynomials of functions there, and their greatest errors.

    A polynomial is of what runs from -1 to 1 over the cell, and has as many terms as the function is smooth; where that
    is none, it is a number.

    Parameters
    ----------
    functions, variable
        The functions of a series, and what makes a series of its coefficients.
    ends
        From where to where.
    shortest
        A cell that is shorter is cut no further.
    enough
        Whether a cell need not be cut, from the polynomials and its length.
    terms
        How many terms there are at most.
    most
        After how many cells none is cut.
    """
    left, count = [ends], 0
    while left:
        low, high = left.pop()
        middle, half = (low + high) / 2, ball((high - low) / 2)
        with series_length(terms + 1):
            places = ball(middle), ball(low).union(ball(high))
            pairs = zip(*(functions(variable([place, half])) for place in places), strict=True)
            parts = [_taylor(about, around, terms) for about, around in pairs]
        count += 1
        if high - low < shortest or count > most or enough(parts, high - low):
            yield (low, high), parts
        else:
            left += [(low, middle), (middle, high)]


def _taylor(about: Any, around: Any, terms: int) -> Taylor:
    smooth = next((i for i in range(terms, 0, -1) if around[i].is_finite()), 0)
    centre = [about[i] for i in range(smooth)]
    if smooth and all(value.is_finite() for value in centre):
        return centre, abs(around[smooth]).upper()
    return [around[0].mid()], around[0].rad()


def greatest_magnitude(parts: Sequence[tuple[arb_poly, arb]], signs: Sequence[float] = (1.0, -1.0)) -> arb:
    """A ball that holds the greatest magnitude of several functions on [-1, 1], or the greatest value of one sign.

    Parameters
    ----------
    parts
        Polynomials, and for each how far the function may be from it.
    signs
        1 for the greatest value, -1 for the greatest opposite, both for the greatest magnitude.

    Examples
    --------
    >>> waves = [(arb_poly([0, 1, 0, -1]), arb(0)), (arb_poly([0.25]), arb(0))]
    >>> peak = greatest_magnitude(waves)
    >>> peak.overlaps(2 / arb(27).sqrt()), float(peak.rad()) < 1e-20
    (True, True)
    >>> greatest_magnitude(waves[1:], (-1.0,))
    -0.250000000000000
    """
    with ctx.workprec(_BITS):
        size = sum((sum(map(abs, polynomial.coeffs()), off) for polynomial, off in parts), arb(0))
        climb = _BranchAndBound(signs, size.upper())
        for polynomial, off in parts:
            climb.seen(polynomial, off, [*_WHOLE, Fraction(0)])
        for polynomial, off in parts:
            climb.over(polynomial, off)
        return climb.least.union(climb.greatest.max(climb.least))


class _BranchAndBound:
    """Bounds of the greatest value so far, from below and from above."""

    def __init__(self, signs: Sequence[float], size: arb) -> None:
        self.signs, self.nothing = signs, size * _GREATEST_NEGLIGIBLE
        self.least = self.greatest = -size

    def _counted(self, value: arb) -> arb:
        """The greatest of a value, its opposite or both."""
        return reduce(arb.max, (value if sign > 0.0 else -value for sign in self.signs))

    def seen(self, polynomial: arb_poly, off: arb, places: Sequence[Fraction]) -> list[arb]:
        """Values at places, lower bounds of the greatest value."""
        counted = [self._counted(polynomial(ball(place))) for place in places]
        self.least = reduce(arb.max, ((value - off).lower() for value in counted), self.least)
        return counted

    def over(self, polynomial: arb_poly, off: arb) -> None:
        """Take one more function into account."""
        left = [_WHOLE]
        while left:
            low, high = left.pop()
            middle, half = (low + high) / 2, (high - low) / 2
            centre, *others = polynomial(arb_poly([ball(middle), ball(half)])).coeffs() or [arb(0)]
            sizes = [abs(value) for value in others]
            width = sum(sizes, arb(0))
            top = (self._counted(centre) + width + off).upper()
            if top < self.least:
                continue
            ends = self.seen(polynomial, off, [low, high])
            if others and sizes[0] > sum((m * size for m, size in enumerate(sizes[1:], 2)), arb(0)):
                # it rises or falls throughout
                self.greatest = reduce(arb.max, ((end + off).upper() for end in ends), self.greatest)
            elif width < (_GREATEST_ENCLOSED * abs(self.least)).max(self.nothing) or half < _SHORTEST or not others:
                self.greatest = self.greatest.max(top)
            else:
                left += [(low, middle), (middle, high)]


#: functions of k by their Taylor series; coefficients beyond what they are smooth to are not finite
Functions = Callable[[arb_series], Sequence[arb_series]]
#: what stands for them on a cell that is next to nothing
Rough = Callable[[arb], Sequence[arb]]

#: binary places beside those that count and as many again, which polynomials may lose
_SPARE = 64
_BALL = arb(0, 1)


def integrals(
    functions: Functions,
    columns: Sequence[Sequence[fmpq_poly]],
    ends: tuple[Fraction, Fraction],
    bits: int,
    rough: Rough | None = None,
) -> list[arb]:
    """Balls that hold, for each column, the integral over k of the sum of the functions times its polynomials.

    Parameters
    ----------
    functions
        Of k.
    columns
        Each has a polynomial for each function, in what runs from -1 to 1 between the ends.
    ends
        From which k to which.
    bits
        How many binary places of the functions' size count.
    rough
        Values that may stand for the functions together on cells too small to matter, where they are not smooth.

    Examples
    --------
    >>> [integral] = integrals(lambda k: [k.exp()], [[fmpq_poly([1])]], (Fraction(0), Fraction(1)), 64)
    >>> integral.contains(arb(1).exp() - 1), float(integral.rad()) < 1e-12
    (True, True)
    """
    low, high = ends
    sums = [arb(0)] * len(columns)
    with ctx.workprec(min(ctx.prec, 2 * bits + _SPARE)):
        half, middle = ball((high - low) / 2), (low + high) / 2
        here = [value[0] for value in functions(arb_series([ball(middle)]))]
        small = (1 + sum((abs(value) for value in here if value.is_finite()), arb(0))) * ball(Fraction(1, 2**bits))

        def enough(parts: Sequence[Taylor], length: Fraction) -> bool:
            return bool(sum((rest for _, rest in parts), arb(0)) * ball(length / (high - low)) < small)

        wide = [[arb_poly(term) for term in column] for column in columns]
        shortest = (high - low) / 2**bits
        for (start, stop), parts in cells(functions, arb_series, ends, shortest, enough, terms=max(8, bits // 2)):
            cell = ball((start + stop - 2 * middle) / (high - low)), ball((stop - start) / (high - low))
            known = parts
            if rough is not None and not all(rest.is_finite() for _, rest in parts):
                known = [([value.mid()], value.rad()) for value in rough(ball(start).union(ball(stop)))]
            for i, column in enumerate(wide):
                sums[i] += sum((_product(term, part, cell) for term, part in zip(column, known, strict=True)), arb(0))
        return [value * half for value in sums]


def _product(polynomial: arb_poly, part: Taylor, cell: tuple[arb, arb]) -> arb:
    """The integral over a cell of a polynomial times a function, by its Taylor polynomial there."""
    centre, reach = cell
    local = polynomial(arb_poly([centre, reach]))
    whole = (local * arb_poly(part[0])).integral()
    value = whole(arb(1)) - whole(arb(-1))
    if not part[1].is_zero():
        value += 2 * local(_BALL) * part[1] * _BALL
    return value * reach


def integrals_of_products(factors: Sequence[Taylor], parts: Sequence[Taylor]) -> arb_mat:
    """Balls that hold the integrals from -1 to 1 of products of functions, all with as many terms; a row a factor."""
    first, other = (arb_mat([centre for centre, _ in several]) for several in (factors, parts))
    means = [arb(2) / (n + 1) if n % 2 == 0 else arb(0) for n in range(first.ncols() + other.ncols())]
    exact = first * arb_mat([means[i : i + other.ncols()] for i in range(first.ncols())]) * other.transpose()
    known = [[(sum(map(abs, centre), arb(0)), off) for centre, off in several] for several in (factors, parts)]
    rooms = [[size * rest + away * (most + rest) for most, rest in known[1]] for size, away in known[0]]
    return exact + arb_mat([[arb(0, (2 * room).upper()) for room in row] for row in rooms])
