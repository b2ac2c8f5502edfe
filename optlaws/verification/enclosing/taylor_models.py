"""Extremes and integrals of polynomials, and of functions by Taylor polynomials on cells, with every error enclosed."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from typing import Any

from flint import arb, arb_mat, arb_poly, arb_series, ctx, fmpq, fmpq_poly, fmpz_poly

from optlaws.tolerances import TAYLOR_REST
from optlaws.verification.enclosing.balls import Extremes, at, ball, series_length

_ONWARD = fmpz_poly([1, 1])
#: what a step leaves of the width of a ball that the precision at work still lets narrow
_NARROWER = 0.9
#: bits with which greatest values of polynomials with coefficients in balls are enclosed
_BITS = 192
#: terms of Taylor polynomials; how short a cell is cut no further, and after how many none is
_TERMS, _LEAST, _MOST = 24, Fraction(1, 2**70), 1 << 12
#: parts between whose ends values are seen that extremes are not within
_LOOKS = 32
#: after so many an integral is not enclosed: kinks that these do not find are many times closer than they can be told
_MOST_OF_INTEGRAL = 1 << 10
#: terms that tell whether a function has a kink in a cell: it has no more of them then
_KINKED = 3
#: and that are enough on a cell beside one
_FEW = 8

#: a function by its Taylor series; coefficients beyond what it is smooth to are not finite
Smooth = Callable[[arb_series], arb_series]
Ends = tuple[Fraction, Fraction]
#: coefficients of a polynomial, and how far a function is off it at most
Taylor = tuple[list[Any], arb]


def real_roots(polynomial: fmpq_poly, low: fmpq, high: fmpq) -> list[arb]:
    """Balls that contain all real roots in a range; even and odd polynomials are solved in y².

    >>> [round(float(root), 9) for root in real_roots(fmpq_poly([0, -2, 0, 1]), fmpq(-1), fmpq(2))]
    [0.0, -1.414213562, 1.414213562]
    """
    coefficients = polynomial.numer().coeffs()
    first, *others = [n for n, value in enumerate(coefficients) if value != 0] or [0]
    step = 1 if any((n - first) % 2 for n in others) else 2
    ends = (low, high) if step == 1 else (fmpq(0), max(low * low, high * high))
    _, factors = fmpz_poly(coefficients[first::step]).factor_squarefree()
    isolated = [root for factor, _ in factors for root in _isolated(factor, *ends)]
    roots = isolated if step == 1 else [sign * square.sqrt() for square in isolated for sign in (-1, 1)]
    return [arb(0), *roots] if first else roots


def _isolated(polynomial: fmpz_poly, low: fmpq, high: fmpq) -> Iterator[arb]:
    """The roots of a polynomial that has none twice, each in a ball of its own."""
    if polynomial(high) == 0:
        yield arb(high)
    # of cells from `start` to `start + width`, the polynomial by the share of the way along them
    cells = [(fmpq_poly(polynomial)(fmpq_poly([low, high - low])).numer(), low, high - low)]
    while cells:
        cell, start, width = cells.pop()
        if cell[0] == 0:
            yield arb(start)
            cell = fmpz_poly(cell.coeffs()[1:])
        changes = _changes_of_sign(fmpz_poly(cell.coeffs()[::-1])(_ONWARD))
        if changes == 1:
            yield arb(start) + arb(width) * _enclosed(cell)
        elif changes:
            degree, half = cell.degree(), width / 2
            left = fmpz_poly([value << (degree - n) for n, value in enumerate(cell.coeffs())])
            cells += [(left, start, half), (left(_ONWARD), start + half, half)]


def _changes_of_sign(polynomial: fmpz_poly) -> int:
    signs = [value > 0 for value in polynomial.coeffs() if value != 0]
    return sum(left != right for left, right in pairwise(signs))


def _enclosed(polynomial: fmpz_poly) -> arb:
    """The single root between 0, which is no root, and 1, as narrow as the working precision permits."""
    slope, rises = polynomial.derivative(), polynomial[0] < 0
    middle, half = fmpq(1, 2), fmpq(1, 2)
    # a ball may reach a little beyond what it is to hold: in one where the slope has a sign no other root is near
    while slope(root := arb(middle, arb(half).upper())).contains(0):
        value, half = polynomial(middle), half / 2
        if value == 0:
            return arb(middle)
        middle += half if (value < 0) == rises else -half
    before = arb.pos_inf()
    while root.rad() < _NARROWER * before:
        before, centre = root.rad(), root.mid()
        there, steepness = polynomial(centre), slope(root)
        # a ball within one whose slope has a sign may be evaluated more roughly
        if not steepness.contains(0):
            root = root.intersection(centre - there / steepness)
        if 2 * root.rad() > before and not there.contains(0):
            root = root.intersection(centre.union(root.upper() if (there < 0) == rises else root.lower()))
    return root


def extremes(function: Smooth, start: Fraction, stop: Fraction) -> Extremes:
    """Balls that hold the least and the greatest value of a function between two places.

    >>> least, greatest = extremes(lambda s: s.sin(), Fraction(0), Fraction(3))
    >>> greatest.contains(1), float(greatest.rad()) < 1e-12
    (True, True)
    """
    seen = [function(arb_series([ball(start + (stop - start) * i / _LOOKS)]))[0] for i in range(_LOOKS + 1)]
    size = 1 + abs(seen[0]).max(abs(seen[-1])).upper()
    if not size.is_finite():
        return arb.nan(), arb.nan()
    least, greatest = least_and_greatest([value for value in seen if value.is_finite()])
    below, above = least.upper(), greatest.lower()  # what is taken at some of these places, or more
    most = size * max(TAYLOR_REST, 2.0 ** (8 - ctx.prec))

    def enough(rests: Sequence[arb], _: Fraction) -> bool:
        return bool(rests[0] <= most)

    def between_these(around: Sequence[arb_series]) -> bool:
        return bool(around[0][0] >= below and around[0][0] <= above)

    several = cells(lambda s: [function(s)], arb_series, (start, stop), _LEAST, by_rests=enough, left_out=between_these)
    parts = [(arb_poly(centre), rest) for _, [(centre, rest)] in several]
    return below.min(-greatest_magnitude(parts, (-1.0,))), above.max(greatest_magnitude(parts, (1.0,)))


def cells(
    functions: Callable[[Any], Sequence[Any]],
    variable: Callable[[list[Any]], Any],
    ends: Ends,
    shortest: Fraction,
    enough: Callable[[Sequence[Taylor], Fraction], bool] = lambda *_: True,
    *,
    terms: int = _TERMS,
    most: float = _MOST,
    by_rests: Callable[[Sequence[arb], Fraction], bool] | None = None,
    left_out: Callable[[Sequence[Any]], bool] | None = None,
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
    by_rests
        Whether a cell need not be cut, from how far the functions are off their polynomials alone, and its length:
        where it must be, no polynomial is computed.
    left_out
        Whether a cell does not matter, from a few terms of the functions around all of it.
    """
    # the longest first: where there are too many, all kinks are as near to being found
    left, count = deque([(*ends, False)]), 0
    while left:
        low, high, kinked = left.popleft()
        middle, half = (low + high) / 2, ball((high - low) / 2)
        where, count = [ball(low).union(ball(high)), half], count + 1
        # a part of a cell with a kink has mostly one too, or is so short that a few terms are enough
        lengths = {*((_KINKED, _FEW) if kinked or left_out is not None else ()), terms + 1}
        for length in sorted(lengths):
            with series_length(length):
                around = functions(variable(where))
            beside, rests = left_out is not None and left_out(around), [_rest(each, length - 1) for each in around]
            near = by_rests is not None and by_rests([rest for _, rest in rests], high - low)
            kinked = not any(each[_KINKED - 1].is_finite() for each in around)
            if beside or near or kinked:
                break
        if beside:
            continue
        parts, last = None, high - low < shortest or count > most
        if last or near or by_rests is None:
            with series_length(length):
                about = functions(variable([ball(middle), half]))
            parts = [_taylor(*each) for each in zip(about, around, rests, strict=True)]
        if parts is not None and (last or enough(parts, high - low)):
            yield (low, high), parts
        else:
            left += [(low, middle, kinked), (middle, high, kinked)]


def _rest(around: Any, terms: int) -> tuple[int, arb]:
    """How many terms a function has on a cell, by its series there, and how far it is off them at most."""
    smooth = next((i for i in range(terms, 0, -1) if around[i].is_finite()), 0)
    return smooth, abs(around[smooth]).upper() if smooth else around[0].rad()


def _taylor(about: Any, around: Any, known: tuple[int, arb]) -> Taylor:
    smooth, rest = known
    centre = [about[i] for i in range(smooth)]
    if smooth and all(value.is_finite() for value in centre):
        return centre, rest
    return [around[0].mid()], around[0].rad()


def between(polynomial: fmpq_poly, start: fmpq, stop: fmpq) -> Extremes:
    """Balls that hold the least and the greatest value of a polynomial between two places."""
    ends = [ball(start), ball(stop)]
    values = [at(polynomial, x) for x in ends]
    for x in real_roots(polynomial.derivative(), start, stop):
        if x < ends[0] or x > ends[1]:
            continue
        value = at(polynomial, x)
        # a root that may lie beyond an end says no more than that end
        for end, value_there in zip(ends, values[:2], strict=True):
            if x.overlaps(end):
                value = value.union(value_there)
        values.append(value)
    return least_and_greatest(values)


def least_and_greatest(balls: list[arb]) -> Extremes:
    """Balls that hold the least and the greatest of numbers in balls."""
    least = greatest = balls[0]
    for value in balls[1:]:
        least, greatest = least.min(value), greatest.max(value)
    return least, greatest


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

    def counted(least: arb, greatest: arb) -> arb:
        return reduce(arb.max, (greatest if sign > 0.0 else -least for sign in signs))

    with ctx.workprec(_BITS):
        tops = []
        for polynomial, off in parts:
            centre, *others = polynomial.coeffs() or [arb(0)]
            width = sum(map(abs, others), off)
            tops.append(counted(centre - width, centre + width).upper())
        if not all(top.is_finite() for top in tops):
            return arb.nan()
        greatest = arb.neg_inf()
        for top, (polynomial, off) in sorted(zip(tops, parts, strict=True), key=lambda part: -float(part[0])):
            if top < greatest:
                break
            middles = fmpq_poly([_dyadic(value.mid()) for value in polynomial.coeffs()])
            away = sum((value.rad() for value in polynomial.coeffs()), off).upper()
            greatest = greatest.max(counted(*between(middles, fmpq(-1), fmpq(1))) + arb(0, away))
        return greatest


def _dyadic(value: arb) -> fmpq:
    mantissa, exponent = value.man_exp()
    return fmpq(mantissa) * fmpq(2) ** int(exponent)


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

        def enough(rests: Sequence[arb], length: Fraction) -> bool:
            return bool(sum(rests, arb(0)) * ball(length / (high - low)) < small)

        wide = [[arb_poly(term) for term in column] for column in columns]
        shortest = (high - low) / 2**bits
        most, count = _MOST_OF_INTEGRAL, max(8, bits // 2)
        several = cells(functions, arb_series, ends, shortest, terms=count, most=most, by_rests=enough)
        # sums of the shortest cells first lose least by rounding
        for (start, stop), parts in reversed(list(several)):
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
