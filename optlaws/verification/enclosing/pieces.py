"""Pieces of laws, polynomials exactly, sines and constant power in balls: values, extremes and squares."""

from __future__ import annotations

from fractions import Fraction
from math import prod
from typing import TypeAlias, TypeVar

from flint import acb, arb, arb_series, fmpq, fmpq_poly, fmpz_poly

from optlaws.laws.segments.fractional import PowerSegment
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.laws.segments.sine import SineSegment
from optlaws.verification.enclosing.balls import Extremes, ball, rational
from optlaws.verification.enclosing.taylor_models import between, extremes, least_and_greatest


class PolynomialPiece:
    """A polynomial in y from -1 at the start to 1 at the end, with rational coefficients.

    >>> piece = PolynomialPiece(Fraction(0), Fraction(1), PolynomialSegment([0.0, -6.0]))
    >>> piece.derivative(1)
    (-3/2)*x^2 + 3/2
    """

    def __init__(self, start: Fraction, stop: Fraction, segment: PolynomialSegment) -> None:
        self.start, self.stop = start, stop
        #: as they are stored: what rounding is judged by
        self.stored = segment.acceleration
        self.rate = rational(2 / (stop - start))
        c = fmpq_poly([0])
        for n, value in enumerate(segment.acceleration):
            c += rational(value) * fmpq_poly(fmpz_poly.chebyshev_t(n))
        b = self._risen(c, rational(segment.b0))
        self._derivatives = [self._risen(b, fmpq(0)), b, c]

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
        """A ball that holds the derivative of order nu at k; for nu = 0 the displacement since the start."""
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


Ball = TypeVar("Ball", arb, acb, arb_series)


class SinePiece:
    """A sum of sine segments."""

    def __init__(self, start: Fraction, stop: Fraction, sines: tuple[SineSegment, ...]) -> None:
        self.start, self.stop = start, stop
        self.sines = sines

    def at(self, nu: int, s: Ball) -> Ball:
        """The derivative of order nu at the time s since the start, or its Taylor series."""
        return sum((_sine(sine, nu, s) for sine in self.sines), s * 0)

    def value(self, nu: int, k: Fraction) -> arb:
        """The derivative of order nu at k, by sines in balls."""
        return self.at(nu, ball(k - self.start))

    def extremes(self, nu: int, start: Fraction, stop: Fraction) -> Extremes:
        """The extremes of Taylor polynomials on short cells."""
        return extremes(lambda s: self.at(nu, s), start - self.start, stop - self.start)

    def power(self) -> Extremes:
        """The extremes of Taylor polynomials of the product b c."""
        return extremes(lambda s: self.at(1, s) * self.at(2, s), Fraction(0), self.stop - self.start)

    def square(self, nu: int) -> arb:
        """The integral of the square by rigorous quadrature."""

        def squared(s: acb, _: bool) -> acb:  # noqa: FBT001 - how FLINT calls it
            value = sum((_sine(sine, nu, s) for sine in self.sines), acb(0))
            return value * value

        return acb.integral(squared, acb(0), acb(ball(self.stop - self.start))).real


def _sine(sine: SineSegment, nu: int, s: Ball) -> Ball:
    """The derivative of order nu of one segment, for balls and complex balls."""
    A, w, phase = (ball(value) for value in (sine.amplitude, sine.frequency, sine.phase))
    total = s * 0
    for i, p in enumerate(sine.powers):
        power = i + 2 - nu
        if power >= 0:
            # s^i twice integrated, differentiated nu times
            total = total + s**power * ball(Fraction(p) * _factor(i, nu))
    angle = s * w + phase
    if nu >= 2:
        turned = (angle.sin(), angle.cos(), -angle.sin(), -angle.cos())[(nu - 2) % 4]
        return total + turned * (A * w ** (nu - 2))
    if nu == 1:
        return total + ball(sine.b0) + (phase.cos() - angle.cos()) * (A / w)
    return total + s * ball(sine.b0) + (s * phase.cos() - (angle.sin() - phase.sin()) / w) * (A / w)


def _factor(i: int, nu: int) -> Fraction:
    """The factor of s^i, differentiated nu - 2 times (integrated if below 2)."""
    if nu >= 2:
        return Fraction(prod(range(i - nu + 3, i + 1)))
    return Fraction(1, i + 1) if nu == 1 else Fraction(1, (i + 1) * (i + 2))


class PowerPiece:
    """A segment of constant power; c is infinite where b is 0."""

    def __init__(self, start: Fraction, stop: Fraction, segment: PowerSegment) -> None:
        self.start, self.stop = start, stop
        self.first, self.last = Fraction(segment.b0) ** 2, Fraction(segment.b1) ** 2
        self.rate = (self.last - self.first) / (stop - start)
        self.sign = 1 if segment.b0 + segment.b1 > 0 else -1

    def value(self, nu: int, k: Fraction) -> arb:
        """The derivative of order nu at k, by powers of b²."""
        square = self.first + self.rate * (k - self.start)
        b, first = ball(square).sqrt(), ball(self.first).sqrt()
        if nu == 0:
            # the integral of the root of what runs straight
            mean = (first**2 + first * b + b**2) / (first + b) if square or self.first else arb(0)
            return self.sign * ball(k - self.start) * 2 / 3 * mean
        if nu == 1:
            return self.sign * b
        factor = self.sign * ball(prod((Fraction(1, 2) - i for i in range(nu - 1)), start=Fraction(1)))
        if not self.rate:
            return arb(0)
        factor *= ball(self.rate) ** (nu - 1)
        return factor / b ** (2 * nu - 3) if square else (arb.pos_inf() if factor > 0 else arb.neg_inf())

    def extremes(self, nu: int, start: Fraction, stop: Fraction) -> Extremes:
        """Extremes at the ends, for functions that are monotone on the piece."""
        return least_and_greatest([self.value(nu, start), self.value(nu, stop)])

    def power(self) -> Extremes:
        """The constant value of b c on the piece, twice."""
        return ball(self.rate / 2), ball(self.rate / 2)

    def square(self, nu: int) -> arb:
        """The integral of the square in closed form."""
        m, rate = nu - 1, ball(self.rate)
        if not m:
            return ball((self.first + self.last) / 2 * (self.stop - self.start))
        if not self.rate:
            return arb(0)
        if not self.first or not self.last:
            return arb.pos_inf()
        factor = ball(prod((Fraction(1, 2) - i for i in range(m)), start=Fraction(1)) ** 2) * rate ** (2 * m - 1)
        if m == 1:
            return factor * ball(self.last / self.first).log()
        return factor * (ball(self.last) ** (2 - 2 * m) - ball(self.first) ** (2 - 2 * m)) / (2 - 2 * m)


#: a law between two k, at the precision at work
ExactPiece: TypeAlias = PolynomialPiece | SinePiece | PowerPiece
