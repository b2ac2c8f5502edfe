"""Pieces of laws that are no polynomials, in balls: sines and constant power."""

from __future__ import annotations

from fractions import Fraction
from math import prod
from typing import TypeVar

from flint import acb, arb, arb_series

from optlaws.laws.segments.constant_power import PowerSegment
from optlaws.laws.segments.sine import SineSegment
from optlaws.verification.enclosing.ball_extremes import extremes
from optlaws.verification.enclosing.balls import ball
from optlaws.verification.enclosing.pieces import ExactPiece, Extremes, least_and_greatest

Ball = TypeVar("Ball", arb, acb, arb_series)


class SinePiece(ExactPiece):
    """A sum of sine segments.

    Parameters
    ----------
    start, stop
        Where it begins and ends.
    sines
        The segments.
    """

    def __init__(self, start: Fraction, stop: Fraction, sines: tuple[SineSegment, ...]) -> None:
        super().__init__(start, stop)
        self.sines = sines

    def at(self, nu: int, s: Ball) -> Ball:
        """The derivative of order nu at the time s since the start, or its Taylor series."""
        return sum((_sine(sine, nu, s) for sine in self.sines), s * 0)

    def value(self, nu: int, k: Fraction) -> arb:
        """The derivative of order nu at k."""
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


class PowerPiece(ExactPiece):
    """A segment of constant power; c is infinite where b is 0.

    Parameters
    ----------
    start, stop
        Where it begins and ends.
    segment
        The segment.
    """

    def __init__(self, start: Fraction, stop: Fraction, segment: PowerSegment) -> None:
        super().__init__(start, stop)
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
        """At the ends: everything rises or falls throughout."""
        return least_and_greatest([self.value(nu, start), self.value(nu, stop)])

    def power(self) -> Extremes:
        """The one value of b c on the piece, twice."""
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
