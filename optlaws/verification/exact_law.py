"""A polynomial law as it is stored, taken exactly, and rigorous enclosures of its constants."""

from __future__ import annotations

from fractions import Fraction
from functools import reduce
from typing import Any

from flint import acb, arb, ctx, fmpq, fmpq_poly, fmpz_poly

from optlaws.errors import InputError
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.synthesis.expression import Expression, Maximum, Term
from optlaws.synthesis.functionals import Peak, Power, RootMeanSquare
from optlaws.verification.balls import at, ball, enclosure, rational


class ExactLaw:
    """The very polynomial that the law's floats describe, in x = 2k - 1 with rational coefficients.

    Parameters
    ----------
    law
        The law.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> ExactLaw(smoothstep(2)).derivative(1)
    (-3/2)*x^2 + 3/2
    """

    def __init__(self, law: PolynomialLaw) -> None:
        self.law = law
        #: bits that leave every enclosure much narrower than a float's rounding, whatever the degree
        self.precision = 256 + 6 * law.degree
        c = fmpq_poly([0])
        for n, value in enumerate(law.acceleration):
            c += rational(value) * fmpq_poly(fmpz_poly.chebyshev_t(n))
        b = _risen(c, rational(law.b0))
        self._derivatives = [_risen(b, rational(law.a0)), b, c]

    def derivative(self, nu: int) -> fmpq_poly:
        """The derivative of order nu by k, as a polynomial in x."""
        while len(self._derivatives) <= nu:
            self._derivatives.append(2 * self._derivatives[-1].derivative())
        return self._derivatives[nu]

    def value(self, nu: int, k: Fraction) -> fmpq:
        """The derivative of order nu at k, exact."""
        return self.derivative(nu)(rational(2 * k - 1))

    def extremes(self, nu: int, start: Fraction = Fraction(0), stop: Fraction = Fraction(1)) -> tuple[arb, arb]:
        """Balls that hold the least and the greatest value of the derivative of order nu between two k."""
        return self.between(self.derivative(nu), start, stop)

    def peak(self, nu: int) -> arb:
        """A ball that holds the peak of the magnitude of the derivative of order nu."""
        return self.magnitude(self.extremes(nu))

    def power(self) -> arb:
        """A ball that holds the peak of |b c|."""
        return self.magnitude(self.between(self.derivative(1) * self.derivative(2), Fraction(0), Fraction(1)))

    def rms(self, nu: int) -> arb:
        """A ball that holds the RMS of the derivative of order nu."""
        integral = (self.derivative(nu) * self.derivative(nu)).integral()
        with ctx.workprec(self.precision):
            return (arb(integral(1) - integral(-1)) / 2).sqrt()

    def term(self, term: Term) -> arb:
        """A ball that holds the value of a constant or a maximum.

        Raises
        ------
        InputError
            If it is neither a peak, a power, an RMS nor a maximum of sums of these.
        """
        if isinstance(term, Maximum):
            with ctx.workprec(self.precision):
                return reduce(arb.max, map(self.sum, term.parts))
        if isinstance(term, Power):
            return self.power()
        if isinstance(term, RootMeanSquare):
            return self.rms(term.nu)
        if isinstance(term, Peak) and len(term.signs) == 2:
            return self.peak(term.nu)
        if isinstance(term, Peak):
            least, greatest = self.extremes(term.nu)
            with ctx.workprec(self.precision):
                return greatest if term.signs[0] > 0 else -least
        raise InputError(f"there is no exact value of {term!r}: it is no peak, power or RMS")

    def sum(self, expression: Expression) -> arb:
        """A ball that holds the value of an objective."""
        with ctx.workprec(self.precision):
            total = arb(0)
            for weight, term in expression.terms:
                total += ball(weight) * self.term(term)
            return total

    def magnitude(self, extremes: tuple[arb, arb]) -> arb:
        """A ball that holds the greater magnitude of two extremes."""
        with ctx.workprec(self.precision):
            return (-extremes[0]).max(extremes[1])

    def between(self, polynomial: fmpq_poly, start: Fraction, stop: Fraction) -> tuple[arb, arb]:
        """Balls that hold the least and the greatest value of a polynomial in x between two k."""
        with ctx.workprec(self.precision):
            ends = [ball(2 * k - 1) for k in (start, stop)]
            values = [at(polynomial, x) for x in ends]
            slope = polynomial.derivative()
            roots: Any = slope.numer().complex_roots() if slope.degree() > 0 else ()
            for root, _ in roots:
                x = acb(root).real
                if not acb(root).imag.contains(0) or x < ends[0] or x > ends[1]:
                    continue
                value = at(polynomial, x)
                # a root that may lie beyond an end says no more than that end
                for end, held in zip(ends, values[:2], strict=True):
                    if x.overlaps(end):
                        value = value.union(held)
                values.append(value)
            least = greatest = values[0]
            for value in values[1:]:
                least, greatest = least.min(value), greatest.max(value)
            return least, greatest


def _risen(slope: fmpq_poly, start: fmpq) -> fmpq_poly:
    """The integral by k from k = 0."""
    found = slope.integral() * fmpq(1, 2)
    return found - found(-1) + start


def exact(law: MotionLaw) -> ExactLaw:
    """The law, exactly.

    Raises
    ------
    InputError
        If it is not a polynomial.
    """
    if not isinstance(law, PolynomialLaw):
        raise InputError(f"exact verification speaks of polynomial laws, got {type(law).__name__}")
    return ExactLaw(law)


def enclosures(law: MotionLaw) -> dict[str, tuple[float, float]]:
    """Floats below and above B, C, D, J and rms_c."""
    found = exact(law)
    balls = {"B": found.peak(1), "C": found.peak(2), "D": found.power(), "J": found.peak(3), "rms_c": found.rms(2)}
    return {name: enclosure(value) for name, value in balls.items()}
