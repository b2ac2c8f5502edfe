"""The limit of a problem's own objective over laws of its order and its bounds, of any degree, where one is known."""

from __future__ import annotations

from fractions import Fraction
from math import isfinite

from optlaws.errors import InputError
from optlaws.numerics.exact import rounded_down
from optlaws.synthesis.limits.closed_forms import best_velocity, limit, power_limit
from optlaws.synthesis.problem.constants import C_minus, C_plus, Combined, Functional
from optlaws.synthesis.problem.expression import Expression, Maximum, Term
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range

_NAMES = {"C": "C", "D": "D", "J": "J", "rms_c": "RMS"}
_MEAN_VELOCITY = 1.0


def known_limit(problem: Problem) -> float | None:
    """A value that no law of the problem's order and within its bounds can beat, whatever its degree; None if unknown.

    For a sum it is the sum of the parts' limits, which no one law need reach together. It is rounded down.

    >>> known_limit(Problem(B=1.5, order=4, minimise="D"))
    2.25
    """
    if problem.boundary is not None:
        return None
    total = limit_of_sum(problem, problem.objective)
    return None if total is None else rounded_down(total)


def limited_laws(problem: Problem) -> str:
    """The set of laws for which the limit of a problem holds, in words.

    >>> limited_laws(Problem(B=1.5, order=3)), limited_laws(Problem(order=4))
    ('law of order 3 with this B', 'law of order 4')
    >>> limited_laws(Problem(order=3, B=(1.5, 1.8), J=(0, 70)))
    'law of order 3 within these bounds'
    """
    if problem.bounded or problem.windows or isinstance(problem.B, Range):
        return f"law of order {problem.order} within these bounds"
    return f"law of order {problem.order}{'' if problem.B is None else ' with this B'}"


def limit_of_sum(problem: Problem, expression: Expression, *, exact: bool = False) -> Fraction | None:
    """The sum of the limits of an expression's parts, None where one is unknown.

    Where `exact`, the closed forms alone count, and all else is at least 0.
    """
    known: list[Fraction] = []
    for weight, term in expression.terms:
        part = _of_term(problem, term, exact=exact)
        if part is not None:
            known.append(part if weight == 1.0 else Fraction(weight) * part)
        elif not exact:
            return None
    return known[0] if len(known) == 1 else sum(known, Fraction(0))


def _of_term(problem: Problem, term: Term, *, exact: bool) -> Fraction | None:
    if isinstance(term, Maximum):
        parts = [limit_of_sum(problem, part, exact=exact) for part in term.parts]
        return max((part for part in parts if part is not None), default=None)
    if not isinstance(term, Functional):
        return None
    if term in (C_plus, C_minus) and problem.symmetric:
        return _of_constant(problem, "C")
    if isinstance(term, Combined):
        return Fraction(term.least(problem.order))
    if term.name in _NAMES:
        return _of_constant(problem, _NAMES[term.name])
    return None if exact else term.limit(problem)


def _of_constant(problem: Problem, constant: str) -> Fraction | None:
    if problem.inflexion not in {None, 0.5} or _raised_anywhere(problem, constant):
        return _uneven(problem, constant)
    B = _best(problem.range("B"), constant, problem.order)
    if problem.order == 1 and B is None:
        return None  # uniform motion has C = 0
    jerk = problem.range("J")
    try:
        if constant == "C" and jerk is not None and problem.order > 2 and isfinite(jerk.high) and B is not None:
            return Fraction(limit("C", B, order=problem.order, monotone=problem.monotone, J=jerk.high))
    except InputError:
        pass  # at this B no law has so small a jerk: the limit without it still holds
    try:
        return Fraction(limit(constant, B, order=problem.order, monotone=problem.monotone))
    except InputError:
        return None


def _uneven(problem: Problem, constant: str) -> Fraction | None:
    """The limit for laws with the peak velocity anywhere: the least at any B, and what B and the place add to C, D.

    The middle is the place that requires least of them.
    """
    if problem.order == 1:
        return None
    least = Fraction(limit(constant, None, order=problem.order))
    if constant not in {"C", "D"}:
        return least
    k, limits = Fraction(problem.inflexion or 0.5), problem.range("B") or Range()
    # the greatest b is at least the mean velocity
    peak = Fraction(max(limits.low, _MEAN_VELOCITY))
    if constant == "D":
        # b²/2 rises from 0 to B²/2 in the time k, and falls back in 1 - k
        rise = peak**2 / (2 * min(k, 1 - k))
        best = min(max(limits.low, 1.5), limits.high)
        forth = Fraction(power_limit(best, monotone=True)) if problem.monotone else Fraction(0)
        B = Fraction(best)
        return max(least, rise, forth, B**3 / (3 * (B - 1)))
    # c takes b from 0 to B in the time k, and back in 1 - k
    slopes = peak / min(k, 1 - k)
    # with no more time at B than there is, a <= B - B² / C
    B = Fraction(min(max(limits.low, 2.0), limits.high))
    return max(least, slopes, B * B / (B - 1))


def _raised_anywhere(problem: Problem, constant: str) -> bool:
    """Whether a bound raises B above its best value at an unspecified place, where it may cost less than at 1/2."""
    limits = problem.range("B")
    if limits is None or limits.fixed or problem.inflexion is not None:
        return False
    return limits.low > (_MEAN_VELOCITY if problem.order == 1 else best_velocity(constant, problem.order))


def _best(limits: Range | None, constant: str, order: int) -> float | None:
    """The B of the range at which the limit is least: it falls up to one B and rises beyond."""
    if limits is None:
        return None
    if order == 1:
        return limits.low if limits.low > _MEAN_VELOCITY else None
    return min(max(limits.low, best_velocity(constant, order)), limits.high)
