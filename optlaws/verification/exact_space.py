"""The laws of a problem straight from eq. 8, in exact rational arithmetic."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

from flint import arb, fmpq, fmpq_poly

from optlaws.errors import InputError
from optlaws.synthesis.bases import PolynomialBasis
from optlaws.synthesis.problem import Problem
from optlaws.verification.balls import at, rational


class Bounds(NamedTuple):
    """What the end conditions alone say of every law: b(0), b(1) - b(0) (None where they are free) and the stroke."""

    start_velocity: fmpq | None
    velocity_change: fmpq | None
    stroke: fmpq


class ExactSpace:
    """a0 + k^l [a1 + (k-1)^l Z] with Z = sum of z_i (2k-1)^i, i odd for symmetric laws; polynomials in x = 2k - 1.

    Parameters
    ----------
    problem
        Whose laws.

    Raises
    ------
    InputError
        If the laws are not polynomials.

    Examples
    --------
    >>> from optlaws.synthesis import Chebyshev
    >>> ExactSpace(Problem(B=1.6, order=1, basis=Chebyshev(1))).derivative(1)
    [3/2*x^2 + (-1/2), 1]
    """

    def __init__(self, problem: Problem) -> None:
        if not isinstance(problem.basis, PolynomialBasis):
            raise InputError(f"exact verification speaks of laws with a polynomial Z, got {problem.basis!r}")
        conditions = problem.conditions
        self.order = conditions.order
        self.symmetric = problem.symmetric
        x = fmpq_poly([0, 1])
        k = (x + 1) * fmpq(1, 2)
        a0, a1 = (fmpq_poly([rational(value) for value in part])(k) for part in (conditions.a0(), conditions.a1()))
        edge = (k * (k - 1)) ** self.order
        powers = range(1 if self.symmetric else 0, problem.basis.degree + 1, 2 if self.symmetric else 1)
        #: the free functions, then the base law
        self.functions = [*(edge * x**i for i in powers), a0 + k**self.order * a1]
        self.terms = len(self.functions) - 1
        self._derivatives = [self.functions]

    def derivative(self, nu: int) -> list[fmpq_poly]:
        """Derivatives of order nu by k."""
        while len(self._derivatives) <= nu:
            self._derivatives.append([2 * one.derivative() for one in self._derivatives[-1]])
        return self._derivatives[nu]

    @cached_property
    def chord(self) -> list[fmpq_poly]:
        """-(b(1/2) - b) / (1-2k)² of symmetric laws, whose b is even in x."""
        return [fmpq_poly(b.coeffs()[2:]) for b in self.derivative(1)]

    @cached_property
    def ratio(self) -> list[fmpq_poly]:
        """-b / (k(1-k))^(l-1), in units of the base law's."""
        weight = fmpq_poly([1, 0, -1]) ** (self.order - 1)
        base = self.derivative(1)[-1](fmpq(0))
        found = [divmod(b, weight) for b in self.derivative(1)]
        if any(rest for _, rest in found):
            raise InputError("b does not vanish with (k(1-k))^(l-1) at these end conditions")
        return [quotient / -base for quotient, _ in found]

    @cached_property
    def bounds(self) -> Bounds:
        """What the end conditions say."""
        base, slope = self.functions[-1], self.derivative(1)[-1]
        stroke = base(fmpq(1)) - base(fmpq(-1))
        if self.order == 1:
            return Bounds(None, None, stroke)
        return Bounds(slope(fmpq(-1)), slope(fmpq(1)) - slope(fmpq(-1)), stroke)

    def moments(self, nu: int) -> list[list[fmpq]]:
        """Integrals over k of the derivatives of order nu times Legendre polynomials, which are at most 1 in magnitude.

        One list for each Legendre polynomial that sees a free function.
        """
        functions = self.derivative(nu)
        degree = max((one.degree() for one in functions[:-1]), default=-1)
        found = []
        for m in range(degree + 1):
            products = [(one * fmpq_poly.legendre_p(m)).integral() for one in functions]
            row = [(p(fmpq(1)) - p(fmpq(-1))) / 2 for p in products]
            if any(row[:-1]):
                found.append(row)
        return found


def values(polynomials: list[fmpq_poly], x: arb) -> list[arb]:
    """All the polynomials' values at one place."""
    return [at(one, x) for one in polynomials]
