"""Integrals of functions times polynomials with every error enclosed: Taylor's formula with its remainder, on cells."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

from flint import arb, arb_poly, arb_series, ctx, fmpq_poly

from optlaws.verification.enclosing.balls import ball, series_length

#: functions of k by their Taylor series; coefficients beyond what they are smooth to are not finite
Functions = Callable[[arb_series], Sequence[arb_series]]
#: what stands for them on a cell that is next to nothing
Rough = Callable[[arb], Sequence[arb]]

#: so many cells and no more: beyond, nothing is known
_MOST_CELLS = 1 << 13
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
        half = ball((high - low) / 2)
        wide = [[arb_poly(term) for term in column] for column in columns]
        for cell, series, left in _cells(functions, ends, bits, rough):
            for i, column in enumerate(wide):
                sums[i] += sum(map(_product, column, series, left, [cell] * len(series)), arb(0))
        return [value * half for value in sums]


def _product(polynomial: arb_poly, series: arb_poly, left: arb, cell: tuple[arb, arb]) -> arb:
    """The integral over a cell of a polynomial times a Taylor series with what is left of it."""
    centre, reach = cell
    local = polynomial(arb_poly([centre, reach]))
    whole = (local * series).integral()
    value = whole(arb(1)) - whole(arb(-1))
    if not left.is_zero():
        value += 2 * local(_BALL) * left * _BALL
    return value * reach


def _cells(
    functions: Functions, ends: tuple[Fraction, Fraction], bits: int, rough: Rough | None
) -> Iterator[tuple[tuple[arb, arb], list[arb_poly], list[arb]]]:
    """Cells, by centre and reach in what runs from -1 to 1, with Taylor series there and what is left of each."""
    terms, narrow = max(8, bits // 2), Fraction(1, 2**bits)
    middle, half = (ends[0] + ends[1]) / 2, (ends[1] - ends[0]) / 2
    with series_length(terms + 1):
        size = 1 + sum((abs(value[0]) for value in _finite(functions(_place(middle, half, arb(0))))), arb(0))
        cells = [(Fraction(0), Fraction(1))]
        for _ in range(_MOST_CELLS):
            if not cells:
                return
            centre, reach = cells.pop()
            k, width = middle + half * centre, half * reach
            around = list(functions(_place(k, width, _BALL)))
            left = [value[terms] for value in around]
            worst = sum(map(abs, left), arb(0)) * ball(reach)
            if worst.is_finite() and worst < size * ball(narrow):
                series = [arb_poly(function.coeffs()[:terms]) for function in functions(_place(k, width, arb(0)))]
                yield (ball(centre), ball(reach)), series, left
            elif reach < narrow:
                place = ball(k) + ball(width) * _BALL
                left = list(rough(place)) if rough is not None else [value[0] for value in around]
                yield (ball(centre), ball(reach)), [arb_poly()] * len(left), left
            else:
                cells += [(centre + reach * side / 2, reach / 2) for side in (-1, 1)]
    nothing = [arb.nan()] * len(around)
    yield (arb(0), arb(1)), [arb_poly()] * len(around), nothing


def _place(centre: Fraction, reach: Fraction, off: arb) -> arb_series:
    """The series of k in what runs from -1 to 1 over a cell, about one place of it or about all."""
    width = ball(reach)
    return arb_series([ball(centre) + width * off, width])


def _finite(series: Sequence[arb_series]) -> list[arb_series]:
    return [value for value in series if value[0].is_finite()]
