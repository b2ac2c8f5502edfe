"""Pieces of laws that are no polynomials, in balls: sines and constant power."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import comb, prod
from typing import TypeVar

from flint import acb, arb, ctx

from optlaws.laws.segments.constant_power import PowerSegment
from optlaws.laws.segments.sine import SineSegment
from optlaws.verification.enclosing.balls import ball
from optlaws.verification.enclosing.pieces import ExactPiece, Extremes, least_and_greatest

#: when a ball is narrow enough, and after how many tries it is taken as it is
_NARROW, _MOST = 2.0**-70, 1 << 12
#: how many terms Taylor's formula takes beside its rest
_TERMS = 6

Ball = TypeVar("Ball", arb, acb)
Derivative = Callable[[int, arb], arb]


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

    def at(self, nu: int, s: arb) -> arb:
        """The derivative of order nu at the time s since the start."""
        return sum((_sine(sine, nu, s) for sine in self.sines), arb(0))

    def value(self, nu: int, k: Fraction) -> arb:
        """The derivative of order nu at k."""
        return self.at(nu, ball(k - self.start))

    def extremes(self, nu: int, start: Fraction, stop: Fraction) -> Extremes:
        """By bisection until the slope has one sign, or next to nothing is left."""
        return bisected(lambda i, s: self.at(nu + i, s), start - self.start, stop - self.start)

    def power(self) -> Extremes:
        """By bisection, with the derivatives of b c by Leibniz's rule."""

        def product(i: int, s: arb) -> arb:
            return sum((comb(i, j) * self.at(1 + j, s) * self.at(2 + i - j, s) for j in range(i + 1)), arb(0))

        return bisected(product, Fraction(0), self.stop - self.start)

    def square(self, nu: int) -> arb:
        """By rigorous quadrature."""

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
        """It is constant."""
        return ball(self.rate / 2), ball(self.rate / 2)

    def square(self, nu: int) -> arb:
        """In closed form."""
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


def bisected(derivative: Derivative, start: Fraction, stop: Fraction) -> Extremes:
    """Balls that hold the least and the greatest value of a function, given with its derivatives of any order.

    Examples
    --------
    >>> waves = (lambda s: s.sin(), lambda s: s.cos(), lambda s: -s.sin(), lambda s: -s.cos())
    >>> least, greatest = bisected(lambda i, s: waves[i % 4](s), Fraction(0), Fraction(3))
    >>> greatest.contains(1), float(greatest.rad()) < 1e-12
    (True, True)
    """
    values = [derivative(0, ball(start)), derivative(0, ball(stop))]
    size = 1.0 + max(float(abs(value).upper()) for value in values)
    narrow = size * max(_NARROW, 2.0 ** (8 - ctx.prec))
    left = [(start, stop)]
    for count in range(1 << 20):
        if not left:
            break
        low, high = left.pop()
        middle = (low + high) / 2
        x, centre = ball(low).union(ball(high)), ball(middle)
        # Taylor's formula about the middle: sharp where several derivatives vanish together
        order, rest = _bounded(derivative, x)
        jet = [derivative(i, centre) for i in range(order)]
        if jet and not _taylor([*jet[1:], rest], x - centre).contains(0):
            continue
        whole = _taylor([*jet, rest], x - centre)
        if float(whole.rad()) < narrow or count > _MOST:
            values.append(whole)
        else:
            left += [(low, middle), (middle, high)]
    return least_and_greatest(values)


def _bounded(derivative: Derivative, x: arb) -> tuple[int, arb]:
    """The highest derivative that counts and is bounded over a ball, and its values; beside a kink few are."""
    for order in range(_TERMS, 0, -1):
        rest = derivative(order, x)
        if rest.is_finite():
            return order, rest
    return 0, derivative(0, x)


def _taylor(derivatives: list[arb], off: arb) -> arb:
    total = arb(0)
    for i, derivative in reversed(list(enumerate(derivatives))):
        total = derivative + total * off / (i + 1)
    return total
