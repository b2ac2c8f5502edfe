"""The part of a law between two of its breaks, as a law of its own."""

from __future__ import annotations

from optlaws.errors import InputError
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment


def section(law: PiecewiseLaw, first: int, last: int) -> PiecewiseLaw:
    """What a law of polynomials does between two of its breaks, its displacement made 1 and its duration 1.

    Parameters
    ----------
    law
        Made of polynomial segments.
    first, last
        The numbers of the breaks.

    Raises
    ------
    InputError
        If a segment is no polynomial, or it ends where it begins.

    Examples
    --------
    >>> law = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment([4.0]), PolynomialSegment([-4.0], b0=2.0)])
    >>> half = section(law, 0, 1)
    >>> half(1.0), half(1.0, 1), half(0.0, 2)
    (1.0, 2.0, 2.0)
    """
    start, stop = law.breaks[first], law.breaks[last]
    moved = float(law(stop)) - float(law(start))
    length = stop - start
    if moved == 0.0:
        raise InputError(f"the part of the law from {start:g} to {stop:g} ends where it begins")
    parts = []
    for segment in law.segments[first:last]:
        if not isinstance(segment, PolynomialSegment):
            raise InputError("a part can be taken of a law of polynomial segments only")
        bent = tuple(length * length / moved * value for value in segment.acceleration)
        parts.append(PolynomialSegment(bent, length / moved * segment.b0))
    inner = [(place - start) / length for place in law.breaks[first + 1 : last]]
    return PiecewiseLaw([0.0, *inner, 1.0], parts)
