"""The piecewise law of eq. 8 with a piecewise polynomial Z, built in exact arithmetic and rounded once."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import fractions
from optlaws.numerics.exact import Polynomial, chebyshev_from_powers, edge, plus, shifted, times


def piecewise_law(
    base: Polynomial, order: int, breaks: Sequence[float], pieces: Sequence[Sequence[Any]]
) -> PiecewiseLaw:
    """The law base(k) + k^l (k-1)^l Z(k).

    Parameters
    ----------
    base
        Ascending powers of k of the law with Z = 0.
    order
        The order l.
    breaks
        Where the pieces of Z begin and end.
    pieces
        Z on each piece, ascending powers of (k - start) / length.

    Examples
    --------
    >>> from fractions import Fraction
    >>> law = piecewise_law([Fraction(n) for n in (0, 0, 3, -2)], 2, (0.0, 0.5, 1.0), [[0, 8], [8, -8]])
    >>> len(law.segments), law.a(0.5), law.c(0.0)
    (2, 1.0, 6.0)
    """
    segments = []
    for (low, high), z in zip(pairwise(fractions(breaks, "breaks")), pieces, strict=True):
        length = high - low
        around, local = (
            [value * length**i for i, value in enumerate(shifted(coefficients, low))]
            for coefficients in (edge(order), base)
        )
        a = plus(local, times(around, fractions(z, "Z")))
        c = [(i + 1) * (i + 2) * value / length**2 for i, value in enumerate(a[2:])]
        segments.append(PolynomialSegment(chebyshev_from_powers(c), b0=float(a[1] / length)))
    return PiecewiseLaw(breaks, segments, a0=float(base[0]))
