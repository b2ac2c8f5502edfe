"""Integrals of functions times polynomials with every error enclosed: Taylor's formula with its remainder, on cells."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from flint import arb, arb_poly, arb_series, ctx, fmpq_poly

from optlaws.verification.enclosing.ball_extremes import Taylor, cells
from optlaws.verification.enclosing.balls import ball

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
