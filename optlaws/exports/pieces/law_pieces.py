"""Laws as polynomials of time in machine units, exact where a law is made of polynomials."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from math import comb, inf

from optlaws.errors import InputError
from optlaws.laws.law import MotionLaw
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.motion.polynomials import PiecewiseMotion, from_exact
from optlaws.numbers import finite, positive
from optlaws.series import exact

#: a stretch of a law: its first and its last k, and powers of k less the first
Stretch = tuple[Fraction, Fraction, Sequence[Fraction]]

_SHORTEST = Fraction(1, 4096)


def is_polynomial(law: MotionLaw) -> bool:
    """Whether a law is made of polynomials alone, so that controllers can run it without loss.

    Examples
    --------
    >>> from optlaws import catalogue, smoothstep
    >>> is_polynomial(smoothstep(3)), is_polynomial(catalogue["cycloidal"].law)
    (True, False)
    """
    if isinstance(law, PiecewiseLaw):
        return all(isinstance(segment, PolynomialSegment) for segment in law.segments)
    return isinstance(law, PolynomialLaw)


def polynomials_of_law(
    law: MotionLaw, stroke: float = 1.0, time: float = 1.0, *, cancelled: float = inf
) -> PiecewiseMotion:
    """A law of polynomials with its stroke and duration: the same pieces, every coefficient rounded once.

    Parameters
    ----------
    law
        The law.
    stroke, time
        What multiplies its displacement and its time.
    cancelled
        How large the terms of a piece may be in sum, over the stroke: high powers cancel each other, and with them
        the digits of whoever evaluates them. Pieces whose terms are larger are halved, which changes no value.

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
    tame = [part for stretch in stretches(law) for part in _tame(stretch, cancelled)]
    rows = [[height * a / duration**n for n, a in enumerate(powers)] for _, _, powers in tame]
    return from_exact([duration * k for k in (tame[0][0], *(last for _, last, _ in tame))], rows)


def _tame(stretch: Stretch, cancelled: float) -> Iterator[Stretch]:
    """The stretch in parts whose terms are no larger in sum."""
    low, high, powers = stretch
    length = high - low
    if high - low <= _SHORTEST or sum(abs(float(a * length**n)) for n, a in enumerate(powers)) <= cancelled:
        yield stretch
        return
    middle = (low + high) / 2
    yield from _tame((low, middle, powers), cancelled)
    yield from _tame((middle, high, _moved(powers, middle - low)), cancelled)


def _moved(powers: Sequence[Fraction], by: Fraction) -> list[Fraction]:
    """Powers about a later place."""
    count = len(powers)
    return [sum((powers[m] * comb(m, n) * by ** (m - n) for m in range(n, count)), Fraction(0)) for n in range(count)]


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
        for segment, ends in zip(law.segments, pairwise(map(Fraction, law.breaks)), strict=True):
            assert isinstance(segment, PolynomialSegment)  # noqa: S101 - said above
            powers = _powers(segment, ends[1] - ends[0], height)
            yield *ends, powers
            height = sum((a * (ends[1] - ends[0]) ** n for n, a in enumerate(powers)), Fraction(0))


def _powers(segment: PolynomialSegment, length: Fraction, height: Fraction) -> list[Fraction]:
    """Powers of k less the segment's start, of the displacement."""
    acceleration = exact.exact_powers([Fraction(coefficient) for coefficient in segment.acceleration])
    steps = [power / (length**n * (n + 1) * (n + 2)) for n, power in enumerate(acceleration)]
    return [height, Fraction(segment.b0), *steps]
