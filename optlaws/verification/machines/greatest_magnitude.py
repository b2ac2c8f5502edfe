"""The greatest magnitude of functions that are polynomials but for next to nothing, by branch and bound."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce

from flint import arb, arb_poly, ctx

from optlaws.verification.enclosing.balls import ball

#: bits with which it is looked for; how narrow the value must be, of itself and of what the polynomials are made of;
#: and how short a part is cut no further
_BITS, _NARROW, _NOTHING, _SHORTEST = 192, 2.0**-70, 2.0**-110, Fraction(1, 2**60)
_WHOLE = (Fraction(-1), Fraction(1))


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
        self.signs, self.nothing = signs, size * _NOTHING
        self.least = self.greatest = -size

    def _counted(self, value: arb) -> arb:
        """The greatest of a value, its opposite or both."""
        return reduce(arb.max, (value if sign > 0.0 else -value for sign in self.signs))

    def seen(self, polynomial: arb_poly, off: arb, places: Sequence[Fraction]) -> list[arb]:
        """What there is at places, none of which the greatest is below."""
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
            elif width < (_NARROW * abs(self.least)).max(self.nothing) or half < _SHORTEST or not others:
                self.greatest = self.greatest.max(top)
            else:
                left += [(low, middle), (middle, high)]
