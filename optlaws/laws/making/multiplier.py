"""The multiplier method (eq. 1.6): new laws from the acceleration of a law and an even positive function."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.law import MotionLaw
from optlaws.laws.making.transform import as_polynomial
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import Segment
from optlaws.numbers import fractions
from optlaws.series import chebyshev, exact

Array = NDArray[np.float64]
Multiplier = Sequence[Any] | NDArray[Any] | Callable[[float], float]

ROUNDING = 1e-12  # of the largest value: an odd part or a negative value below it is rounding
STILL = 1e-9  # of C: a change of velocity below it is rounding


def multiplied(law: MotionLaw, y: Multiplier) -> MotionLaw:
    """The law with the acceleration s c y (eq. 1.6), s such that the stroke stays what it was (eq. 1.7).

    y is even about k = 1/2 and nowhere negative, so that the area of c wanders to the ends of the interval where y
    has its minimum in the middle, and to the middle where it has its maximum there. The velocity at the ends stays.

    Parameters
    ----------
    law
        A law whose c is odd about k = 1/2, or at least one for which c y changes the velocity by nothing in all.
    y
        Ascending powers of k, for which a polynomial law gets exact powers and polynomial pieces stay polynomials; or
        a smooth function of one k in [0, 1], which is interpolated to machine accuracy.

    Returns
    -------
    A polynomial law for a polynomial one, else a piecewise law. Pieces of powers of time keep their closed form,
    sines become polynomials to machine accuracy.

    Raises
    ------
    InputError
        If y is not even about 1/2, is negative somewhere, is zero everywhere or is not smooth; if c y would change the
        velocity or would give no stroke.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> from optlaws.laws.savin.savin import savin
    >>> multiplied(smoothstep(4), [2, -6, 6]) == savin("III", alpha=6.0)
    True
    >>> import math
    >>> multiplied(smoothstep(3), lambda k: math.exp((k - 0.5) ** 2))
    PolynomialLaw(degree=..., B=1.8..., C=..., D=..., J=...)
    """
    even = _even(y)
    if isinstance(law, PiecewiseLaw):
        return _of_pieces(law, np.array(exact.rounded(even)))
    return _of_polynomial(law if isinstance(law, PolynomialLaw) else as_polynomial(law), even)


def _even(y: Multiplier) -> list[Fraction]:
    """The Chebyshev series of y in 2k - 1, without the odd part that rounding left."""
    if callable(y):
        found = chebyshev.interpolated(lambda x: np.array([float(y(k)) for k in 0.5 * (x + 1.0)]), "y")
        given = fractions(found, "y")
    else:
        given = exact.exact_chebyshev(fractions(y, "y"))
    size = max(map(abs, given), default=Fraction(0))
    if size == 0:
        raise InputError("y must not be zero everywhere")
    odd = sum(map(abs, given[1::2]), start=Fraction(0))
    if odd > ROUNDING * size:
        raise InputError(
            f"y must be even about k = 1/2, but y(k) and y(1 - k) differ by up to {2.0 * float(odd):.3g}; "
            "write it in powers of k (1 - k)"
        )
    even = [Fraction(0) if n % 2 else value for n, value in enumerate(given)]
    low, _ = PolynomialLaw.from_chebyshev(even).extrema(0)
    if low.value < -ROUNDING * float(size):
        raise InputError(f"y must be nowhere negative, but is {low.value:.6g} at k = {low.k:.6g}")
    return even


def _of_polynomial(law: PolynomialLaw, y: Sequence[Fraction]) -> PolynomialLaw:
    powers = law.exact_powers()
    c = [n * (n - 1) * value for n, value in enumerate(powers)][2:] or [Fraction(0)]
    product = exact.times(c, exact.exact_powers(y))
    swing = [value / ((n + 1) * (n + 2)) for n, value in enumerate(product)]
    change = sum((value / (n + 1) for n, value in enumerate(product)), start=Fraction(0))
    _check_still(float(change), law)
    a0, b0 = Fraction(law.a0), Fraction(law.b0)
    scale = _scale(sum(powers, start=Fraction(0)) - a0 - b0, sum(swing, start=Fraction(0)))
    return PolynomialLaw.from_powers([a0, b0, *(scale * value for value in swing)])


def _of_pieces(law: PiecewiseLaw, y: Array) -> PiecewiseLaw:
    pairs = list(pairwise(law.breaks))
    segments: list[Segment] = []
    velocity = 0.0
    for segment, (start, end) in zip(law.segments, pairs, strict=True):
        length = end - start
        product = segment.times(length, _restricted(y, start, end))
        joined = product.scaled(length, 1.0, velocity - product.velocity(length))
        # a rest at infinite acceleration that rounding missed is a rest
        segments.append(joined.at_rest(length, ROUNDING))
        velocity = segments[-1].velocity(length, last=True)
    _check_still(velocity, law)
    swing = PiecewiseLaw(law.breaks, segments)
    b0 = law.b(0.0)
    scale = float(_scale(Fraction(law.a(1.0) - law.a0 - b0), Fraction(swing.a(1.0))))
    changed = [one.scaled(end - start, scale, b0) for one, (start, end) in zip(segments, pairs, strict=True)]
    return PiecewiseLaw(law.breaks, changed, law.a0)


def _restricted(y: Array, start: float, end: float) -> Array:
    """The series on a part of the interval: of the same degree, so that as many points fix it."""
    x = chebyshev.nodes(len(y))
    return chebyshev.from_values(chebyshev.value(y, start + end - 1.0 + (end - start) * x))


def _check_still(change: float, law: MotionLaw) -> None:
    if abs(change) > STILL * law.peak(2).value:
        raise InputError(
            f"c y would change the velocity by {change:.6g} in all; the method needs a law whose acceleration is odd "
            f"about k = 1/2, got {shortened(law)}"
        )


def _scale(needed: Fraction, given: Fraction) -> Fraction:
    if given == 0:
        raise InputError("c y gives no stroke: the law must have an acceleration, and y must not vanish where it has")
    return needed / given
