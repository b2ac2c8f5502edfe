"""By how much at most a law breaks the conditions of a problem."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite

from flint import arb, ctx, fmpq_poly, fmpz_poly

from optlaws.synthesis.bases import PolynomialBasis
from optlaws.synthesis.functionals import FUNCTIONALS
from optlaws.synthesis.problem import Problem
from optlaws.verification.balls import ball, rational, up, upper
from optlaws.verification.exact_law import ExactLaw

#: what an optimum may break a constraint by, in units of the constraint's bound
_TOLERANCE = 1e-9
#: what rounding of the law's coefficients can do, relative to what the derivative is made of
_ROUNDING = 2.0**-44


@dataclass(frozen=True)
class Excess:
    """By how much a condition is broken at most (0 or less: it is kept), and what rounding explains."""

    name: str
    by: float
    allowed: float

    @property
    def holds(self) -> bool:
        """Whether the condition holds but for rounding."""
        return self.by <= self.allowed


def excesses(problem: Problem, law: ExactLaw) -> list[Excess]:
    """Every condition of the problem, at the law."""
    with ctx.workprec(law.precision):
        return [
            *_ends(problem, law),
            *_velocity(problem, law),
            *(one for name in ("C", "D", "J") for one in _constant(problem, law, name)),
            *_windows(problem, law),
        ]


def _of(name: str, value: arb, scale: float = 1.0, tolerance: float = _TOLERANCE) -> Excess:
    return Excess(name, up(upper(value)) + 0.0, tolerance * max(1.0, scale))


def _ends(problem: Problem, law: ExactLaw) -> Iterator[Excess]:
    conditions = problem.conditions
    for k, wanted in ((0, conditions.start), (1, conditions.end)):
        for nu, value in enumerate(wanted):
            off = arb(abs(law.value(nu, Fraction(k)) - rational(Fraction(value))))
            yield _of(f"derivative {nu} at k = {k}", off, _size(law, nu), _ROUNDING)
    beyond = law.law.acceleration[max(2 * conditions.order + degree_of_z(problem) - 1, 0) :]
    yield _of("terms beyond the degree", arb(sum(map(abs, beyond))), _size(law, 0), _ROUNDING)
    if problem.symmetric:
        a = law.derivative(0)
        uneven = a + a(fmpq_poly([0, -1])) - 1
        value = law.magnitude(law.between(uneven, Fraction(0), Fraction(1)))
        yield _of("a(k) + a(1-k) = 1", value, _size(law, 0), _ROUNDING)


def _size(law: ExactLaw, nu: int) -> float:
    """What the derivative of order nu at the ends is made of, at most: every coefficient of c is rounded."""
    size = 1.0 + sum(map(abs, law.law.acceleration))
    top = fmpz_poly.chebyshev_t(len(law.law.acceleration))
    for _ in range(nu - 2):
        top = 2 * top.derivative()
    return size * float(top(1))


def degree_of_z(problem: Problem) -> int:
    """The degree of Z in a problem whose laws are polynomials."""
    return problem.basis.degree if isinstance(problem.basis, PolynomialBasis) else 0


def _velocity(problem: Problem, law: ExactLaw) -> Iterator[Excess]:
    wanted = problem.range("B")
    least, greatest = law.extremes(1)
    if wanted is not None:
        middle = arb(law.value(1, Fraction(1, 2)))
        if isfinite(wanted.high):
            yield _of("b <= B", greatest - ball(wanted.high), wanted.high)
            if not problem.symmetric and not problem.monotone:
                yield _of("-b <= B", -least - ball(wanted.high), wanted.high)
        if problem.symmetric and wanted.fixed:
            yield _of("b(1/2) = B", abs(middle - ball(wanted.high)), wanted.high)
        elif problem.symmetric:
            yield _of("b <= b(1/2)", greatest - middle)
        if wanted.low > 0.0:
            reached = middle if problem.boundary is None else (-least).max(greatest)
            yield _of("B at least", ball(wanted.low) - reached, wanted.low)
    if problem.monotone:
        yield _of("b >= 0", -least)


def _constant(problem: Problem, law: ExactLaw, name: str) -> Iterator[Excess]:
    wanted = problem.range(name)
    if wanted is None:
        return
    value = law.term(FUNCTIONALS[name])
    if isfinite(wanted.high):
        yield _of(f"{name} at most", value - ball(wanted.high), wanted.high)
    if wanted.low > 0.0:
        yield _of(f"{name} at least", ball(wanted.low) - value, wanted.low)


def _windows(problem: Problem, law: ExactLaw) -> Iterator[Excess]:
    for i, window in enumerate(problem.windows, 1):
        least, greatest = law.extremes(window.order, Fraction(window.start), Fraction(window.stop))
        if isfinite(window.high):
            yield _of(f"window {i}, above", greatest - ball(window.high), abs(window.high))
        if isfinite(window.low):
            yield _of(f"window {i}, below", ball(window.low) - least, abs(window.low))
