"""Laws as polynomials of time in machine units, exact where a law is made of polynomials."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise

from optlaws.errors import InputError
from optlaws.exports.polynomials import PiecewiseMotion, from_exact
from optlaws.laws.law import MotionLaw
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import finite, positive
from optlaws.series import exact

#: a stretch of a law: its first and its last k, and powers of k less the first
Stretch = tuple[Fraction, Fraction, Sequence[Fraction]]


def is_polynomial(law: MotionLaw) -> bool:
    """Whether a law is made of polynomials alone, so that controllers can run it without loss.

    Examples
    --------
    >>> from optlaws import catalogue, smoothstep
    >>> is_polynomial(smoothstep(3)), is_polynomial(catalogue["cycloidal"].law)
    (True, False)
    """
    if isinstance(law, PiecewiseLaw):
        return all(isinstance(one, PolynomialSegment) for one in law.segments)
    return isinstance(law, PolynomialLaw)


def polynomials_of_law(law: MotionLaw, stroke: float = 1.0, time: float = 1.0) -> PiecewiseMotion:
    """A law of polynomials with its stroke and duration: the same pieces, every coefficient rounded once.

    Raises
    ------
    InputError
        If the law is not made of polynomials, or the duration is not above 0.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> polynomials_of_law(smoothstep(2), stroke=0.5, time=2.0).coefficients
    ((0.0, 0.0, 0.375, -0.125),)
    """
    height, duration = Fraction(finite(stroke, "stroke")), Fraction(positive(time, "time"))
    found = list(stretches(law))
    rows = [[height * a / duration**n for n, a in enumerate(powers)] for _, _, powers in found]
    return from_exact([duration * k for k in (found[0][0], *(last for _, last, _ in found))], rows)


def stretches(law: MotionLaw) -> Iterator[Stretch]:
    """The polynomials of a law in exact arithmetic.

    Raises
    ------
    InputError
        If the law is not made of polynomials.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> [list(map(str, powers)) for _, _, powers in stretches(smoothstep(2))]
    [['0', '0', '3', '-2']]
    """
    if not is_polynomial(law):
        raise InputError("the law is not made of polynomials: approximate it by pieces within a stated deviation")
    if isinstance(law, PolynomialLaw):
        yield Fraction(0), Fraction(1), law.exact_powers()
    if isinstance(law, PiecewiseLaw):
        height = Fraction(law.a0)
        for one, ends in zip(law.segments, pairwise(map(Fraction, law.breaks)), strict=True):
            assert isinstance(one, PolynomialSegment)  # noqa: S101 - said above
            powers = _powers(one, ends[1] - ends[0], height)
            yield *ends, powers
            height = sum((a * (ends[1] - ends[0]) ** n for n, a in enumerate(powers)), Fraction(0))


def _powers(segment: PolynomialSegment, length: Fraction, height: Fraction) -> list[Fraction]:
    """Powers of k less the segment's start, of the displacement."""
    acceleration = exact.exact_powers([Fraction(one) for one in segment.acceleration])
    steps = [one / (length**n * (n + 1) * (n + 2)) for n, one in enumerate(acceleration)]
    return [height, Fraction(segment.b0), *steps]
