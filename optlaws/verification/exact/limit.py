"""A lower bound of what is minimised, for all laws of any degree, by closed forms with every rounding enclosed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction

from flint import ctx

from optlaws.synthesis.limits.closed_forms import back_velocity, best_velocity, jerk_limit, rms_limit
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.expression import Expression, Maximum, Term, leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.verification.enclosing.balls import ball, lower
from optlaws.verification.exact.law import known
from optlaws.verification.machines.floors import floor

_BITS = 192
#: a cam moves from rest to rest too, with whatever B
_LEAST_OF_CAMS = {"C_cam(": Fraction(4), "D_cam(": Fraction(9, 4)}
_SLIGHTLY_LESS = 1 - Fraction(1, 10**13)


def exact_limit(problem: Problem) -> Fraction | None:
    """A lower bound of the objective for all laws of the problem; None where no closed form exists.

    Only C, D, J and the RMS of c count, and C and D of its cam; every other constant is to be at least 0.

    >>> exact_limit(Problem(B=1.5, order=4, minimise="D"))
    Fraction(9, 4)
    """
    if problem.boundary is not None or problem.order == 1:
        return None
    constants = [leaf for _, leaf in leaves(problem.objective) if isinstance(leaf, Functional)]
    if any(floor(constant, problem.conditions) < 0 for constant in constants):
        return None
    total = _sum(problem, problem.objective)
    return total if total > 0 else None


def _sum(problem: Problem, expression: Expression) -> Fraction:
    return sum((Fraction(weight) * _term(problem, term) for weight, term in expression.terms), Fraction(0))


def _term(problem: Problem, term: Term) -> Fraction:
    if isinstance(term, Maximum):
        return max(_sum(problem, part) for part in term.parts)
    name = repr(term)
    if name.startswith(tuple(_LEAST_OF_CAMS)):
        known(term)
        return _LEAST_OF_CAMS[name[: name.index("(") + 1]]
    if name not in {"C", "D", "J", "rms_c"}:
        return Fraction(0)
    limits, best = problem.range("B"), best_velocity(name, problem.order)
    if limits is None or problem.inflexion is not None:
        B = Fraction(best)
    elif limits.fixed:
        B = Fraction(limits.high)
    else:
        # up to the best of all it falls, so that of smaller ones the greatest has the least
        B = Fraction(min(best, limits.high))
    return _EXACT[name](B, problem)


def _jerk(B: Fraction, problem: Problem) -> Fraction:
    # beyond the best B of laws whose acceleration jumps at their ends it is a root, which is not enclosed
    beyond = problem.order == 2 and Fraction(3, 2) < B and not (problem.monotone and B >= 2)
    return Fraction(jerk_limit(1.5 if beyond else float(B), monotone=problem.monotone, order=problem.order))


_EXACT: Mapping[str, Callable[[Fraction, Problem], Fraction]] = {
    "C": lambda B, problem: _acceleration(B, monotone=problem.monotone),
    "D": lambda B, problem: _power(B, monotone=problem.monotone),
    "J": _jerk,
    "rms_c": lambda B, problem: Fraction(rms_limit(float(B), monotone=problem.monotone)),
}


def _acceleration(B: Fraction, *, monotone: bool) -> Fraction:
    if B <= 2:
        return B * B / (B - 1)
    if monotone:
        return B * B
    with ctx.workprec(_BITS):
        back = ball(B - 2)
        return lower(2 * (back + (back * back + ball(B * B)).sqrt()))


def _power(B: Fraction, *, monotone: bool) -> Fraction:
    if 2 * B <= 3:
        return B**3 / (3 * (B - 1))
    if monotone:
        return 2 * B**3 / 3
    u = max(Fraction(back_velocity(float(B))) * _SLIGHTLY_LESS, Fraction(0))
    # 2u³ + 3u² rises with u: this u is not above the root
    below = 2 * u**3 + 3 * u**2 <= B * B * (B - Fraction(3, 2))
    return B * B + (2 * u * u if below else 0)
