"""Pieces of laws, exact or in balls: values, extremes and squares."""

from __future__ import annotations

from abc import ABC, abstractmethod
from fractions import Fraction
from typing import Any

from flint import acb, arb, fmpq, fmpq_poly, fmpz_poly

from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.verification.enclosing.balls import at, ball, rational

Extremes = tuple[arb, arb]


class ExactPiece(ABC):
    """A law between two k, at the precision at work.

    Parameters
    ----------
    start, stop
        Where it begins and ends.
    """

    def __init__(self, start: Fraction, stop: Fraction) -> None:
        self.start, self.stop = start, stop

    @abstractmethod
    def value(self, nu: int, k: Fraction) -> arb:
        """A ball that holds the derivative of order nu at k; for nu = 0 the displacement since the start."""

    @abstractmethod
    def extremes(self, nu: int, start: Fraction, stop: Fraction) -> Extremes:
        """Balls that hold the least and the greatest value of the derivative of order nu between two k."""

    @abstractmethod
    def power(self) -> Extremes:
        """Balls that hold the least and the greatest value of b c."""

    @abstractmethod
    def square(self, nu: int) -> arb:
        """A ball that holds the integral over k of the square of the derivative of order nu."""


class PolynomialPiece(ExactPiece):
    """A polynomial in y from -1 at the start to 1 at the end, with rational coefficients.

    Examples
    --------
    >>> piece = PolynomialPiece(Fraction(0), Fraction(1), PolynomialSegment([0.0, -6.0]))
    >>> piece.derivative(1)
    (-3/2)*x^2 + 3/2
    """

    def __init__(self, start: Fraction, stop: Fraction, segment: PolynomialSegment, a0: float = 0.0) -> None:
        super().__init__(start, stop)
        #: as they are stored: what rounding is judged by
        self.stored = segment.acceleration
        self.rate = rational(2 / (stop - start))
        c = fmpq_poly([0])
        for n, value in enumerate(segment.acceleration):
            c += rational(value) * fmpq_poly(fmpz_poly.chebyshev_t(n))
        b = self._risen(c, rational(segment.b0))
        self._derivatives = [self._risen(b, rational(a0)), b, c]

    def _risen(self, slope: fmpq_poly, start: fmpq) -> fmpq_poly:
        integral = slope.integral() / self.rate
        return integral - integral(-1) + start

    def raised(self, by: fmpq) -> None:
        """Raise the displacement of the whole piece by a number."""
        self._derivatives[0] += by

    def derivative(self, nu: int) -> fmpq_poly:
        """The derivative of order nu by k, as a polynomial in y."""
        while len(self._derivatives) <= nu:
            self._derivatives.append(self.rate * self._derivatives[-1].derivative())
        return self._derivatives[nu]

    def local(self, k: Fraction) -> fmpq:
        """The place y of a k, which runs from -1 to 1 over the piece."""
        return self.rate * rational(k - self.start) - 1

    def exact(self, nu: int, k: Fraction) -> fmpq:
        """The derivative of order nu at k."""
        return self.derivative(nu)(self.local(k))

    def value(self, nu: int, k: Fraction) -> arb:
        """The derivative of order nu at k."""
        return arb(self.exact(nu, k))

    def extremes(self, nu: int, start: Fraction, stop: Fraction) -> Extremes:
        """The extremes among the ends and all stationary points, which are isolated."""
        return between(self.derivative(nu), self.local(start), self.local(stop))

    def power(self) -> Extremes:
        """The extremes of b c, by the stationary points of the product."""
        return self.combined_power((Fraction(1),))

    def combination(self, nu: int, weights: tuple[Fraction, ...]) -> fmpq_poly:
        """The sum w0 a^(nu) + w1 a^(nu+1) + ..., as a polynomial in y."""
        return sum((rational(w) * self.derivative(nu + i) for i, w in enumerate(weights)), fmpq_poly([0]))

    def combined(self, nu: int, weights: tuple[Fraction, ...]) -> Extremes:
        """Balls that hold the least and the greatest value of a combination."""
        return between(self.combination(nu, weights), fmpq(-1), fmpq(1))

    def combined_power(self, weights: tuple[Fraction, ...]) -> Extremes:
        """Balls that hold the least and the greatest product of w0 b + w1 c + ... and its derivative."""
        return between(self.combination(1, weights) * self.combination(2, weights), fmpq(-1), fmpq(1))

    def square(self, nu: int) -> arb:
        """The exact integral of the square of a derivative."""
        integral = (self.derivative(nu) * self.derivative(nu)).integral()
        return arb((integral(1) - integral(-1)) / self.rate)


def between(polynomial: fmpq_poly, start: fmpq, stop: fmpq) -> Extremes:
    """Balls that hold the least and the greatest value of a polynomial between two places."""
    ends = [ball(start), ball(stop)]
    values = [at(polynomial, x) for x in ends]
    for x in real_roots(polynomial.derivative()):
        if x < ends[0] or x > ends[1]:
            continue
        value = at(polynomial, x)
        # a root that may lie beyond an end says no more than that end
        for end, held in zip(ends, values[:2], strict=True):
            if x.overlaps(end):
                value = value.union(held)
        values.append(value)
    return least_and_greatest(values)


def real_roots(polynomial: fmpq_poly) -> list[arb]:
    """Balls that hold all real roots of a polynomial, perhaps among others; an even or odd one is one of y²."""
    numerator = polynomial.numer()
    first, *others = [n for n, value in enumerate(numerator.coeffs()) if value != 0] or [0]
    if not others:
        return [arb(0)] if first else []
    roots = [arb(0)] if first else []
    if any((n - first) % 2 for n in others):
        return roots + _real(fmpz_poly(numerator.coeffs()[first:]))
    for square in _real(fmpz_poly(numerator.coeffs()[first::2])):
        if square > 0:
            root = square.sqrt()
            roots += [-root, root]
        elif not square < 0:
            roots.append(arb(0, (abs(square)).upper().sqrt().upper()))
    return roots


def _real(polynomial: fmpz_poly) -> list[arb]:
    """Balls that hold the real roots of a polynomial that does not vanish at 0."""
    roots: Any = polynomial.complex_roots()
    return [acb(root).real for root, _ in roots if acb(root).imag.contains(0)]


def least_and_greatest(balls: list[arb]) -> Extremes:
    """Balls that hold the least and the greatest of numbers in balls."""
    least = greatest = balls[0]
    for value in balls[1:]:
        least, greatest = least.min(value), greatest.max(value)
    return least, greatest
