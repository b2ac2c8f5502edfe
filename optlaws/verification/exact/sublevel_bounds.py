"""Bounds of constants and derivatives in laws below a claim, and limits, with every rounding enclosed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from math import inf, isfinite

from flint import arb, ctx

from optlaws.mechanisms.machine.output_constants import OutputConstant
from optlaws.synthesis.families.names import VariableName
from optlaws.synthesis.limits.closed_forms import back_velocity, best_velocity, jerk_limit, rms_limit
from optlaws.synthesis.limits.rounding import rounded_up
from optlaws.synthesis.problem.constants import Functional, PeakConstant, PowerConstant
from optlaws.synthesis.problem.expression import Expression, Maximum, Term, leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.spaces.of_basis import space_of
from optlaws.verification.enclosing.balls import ball, lower, upper
from optlaws.verification.exact.law import known
from optlaws.verification.exact.rows import ExactRows
from optlaws.verification.machines.floors import floor

#: what makes up for the rounding of a few operations in doubles
_ROUNDED = 1.0 + 2.0**-40


def never_negative(problem: Problem) -> bool:
    """Whether every constant of the objective is at least 0: a peak of one sign need not be if the velocity changes."""
    constants = [leaf for _, leaf in leaves(problem.objective)]
    if any(isinstance(leaf, Functional) and floor(leaf, problem.conditions) < 0 for leaf in constants):
        return False
    one_sided = any(isinstance(leaf, PeakConstant) and len(leaf.signs) == 1 for leaf in constants)
    return not one_sided or (problem.boundary is None and problem.order > 1)


def least_values(problem: Problem, rows: ExactRows) -> dict[str, Fraction | float]:
    """Lower bounds of the objective's constants, where they are not 0: minus infinity if nothing is known.

    The greatest c is at least its mean, the change of velocity, and so is the greatest -c.
    """
    change = rows.space.bounds.velocity_change
    least: dict[str, Fraction | float] = {}
    mean = None if change is None else Fraction(int(change.p), int(change.q))
    one_sided = not never_negative(problem)
    for _, leaf in leaves(problem.objective):
        if isinstance(leaf, PeakConstant) and len(leaf.signs) == 1 and one_sided:
            least[repr(leaf)] = -inf if mean is None or leaf.nu != 2 else mean * Fraction(leaf.signs[0])
        elif isinstance(leaf, Functional):
            value = floor(leaf, problem.conditions)
            # above 0 doubles say it, unless it is an exact one
            if value < 0 or (value > 0 and isinstance(value, Fraction)):
                least[repr(leaf)] = value
    _least_sum(problem.objective, least)
    return least


def least_objective(problem: Problem, rows: ExactRows) -> Fraction | None:
    """A lower bound of the objective by its constants' lower bounds; None if nothing is known."""
    value = _least_sum(problem.objective, least_values(problem, rows))
    return None if isinstance(value, float) else value


def _least_sum(expression: Expression, least: dict[str, Fraction | float]) -> Fraction | float:
    """A lower bound of an expression; records the lower bounds of its maxima."""
    total: Fraction | float = Fraction(0)
    for weight, term in expression.terms:
        if isinstance(term, Maximum):
            least[repr(term)] = max(_least_sum(part, least) for part in term.parts)
        total += Fraction(weight) * least.get(repr(term), Fraction(0))
    return total


def greatest_values(certificate: Certificate, rows: ExactRows, claim: float) -> dict[str, float]:
    """Greatest values of the named constants in a law whose objective is below the claim."""
    greatest: dict[str, float] = {}
    problem = certificate.problem
    if certificate.program != VIOLATION:
        _spread(problem.objective, Fraction(claim), least_values(problem, rows), greatest)
    for name in ("B", *(constant.name for constant, _ in problem.bounded)):
        limits = problem.range(name)
        if limits is not None:
            greatest[name] = min(greatest.get(name, inf), limits.high)
    if rows.power is not None and isfinite(greatest.get(rows.power.name, inf)):
        greatest[VariableName.POWER_ROOT] = rounded_up(upper(ball(greatest[rows.power.name]).sqrt()))
    start = rows.space.bounds.start_velocity
    if "B" in rows.names and not isfinite(greatest.get("B", inf)) and start is not None:
        # b is b(0) and the integral of c, which is nowhere further from its mean than the integral of |j|
        known, change = means(problem, rows, greatest), rows.space.bounds.velocity_change
        swings = [known[2]] if 2 in known else []
        swings += [known[3] + abs(ball(change))] if 3 in known and change is not None else []
        if swings:
            greatest["B"] = rounded_up(upper(abs(ball(start)) + ball(min(map(upper, swings)))))
    return greatest


def means(problem: Problem, rows: ExactRows, greatest: dict[str, float]) -> dict[int, arb]:
    """Bounds of the integral of a derivative's magnitude, by order of derivative, in every such law."""
    start, change, stroke = rows.space.bounds
    bounds: dict[int, list[arb]] = {}

    def known(nu: int, name: str, factor: float | arb = 1.0, extra: arb | None = None) -> None:
        if isfinite(greatest.get(name, inf)):
            size = arb(factor) * ball(max(greatest[name], 0.0))
            bounds.setdefault(nu, []).append(size + (arb(0) if extra is None else extra))

    for nu, name in ((2, "C"), (2, "rms_c"), (3, "J"), (3, "rms_j"), (4, "snap")):
        known(nu, name)
    if change is not None:
        # what is above 0 less what is below is the change, and one of them is at most the peak
        known(2, "C_plus", 2, -ball(change))
        known(2, "C_minus", 2, ball(change))
    known(1, "B", 2, -ball(stroke))
    if problem.monotone:
        bounds.setdefault(1, []).append(ball(stroke))
    for constant in problem.constants:
        name = VariableName.POWER_ROOT if constant == rows.power else constant.name
        for nu, factor, offset in _sizes(problem, constant, name):
            known(nu, name, factor, offset)
    plain = rows.power is not None and not rows.power.curbs()
    if plain and start is not None and change is not None and start == 0 and start + change == 0:
        # b² <= 2 D k
        known(1, VariableName.POWER_ROOT)
    return {nu: ball(min(map(upper, several))) for nu, several in bounds.items()}


def _sizes(problem: Problem, constant: Functional, name: str) -> Iterator[tuple[int, arb, arb]]:
    """Orders, factors and offsets: the mean of |a^(order)| is at most factor times the constant plus the offset."""
    if name == VariableName.POWER_ROOT or not isinstance(constant, PowerConstant | OutputConstant):
        space = space_of(problem.basis, problem.conditions, symmetric=problem.symmetric)
        # both are rounded
        for nu, factor, offset in constant.sizes(space):
            yield nu, ball(factor * _ROUNDED), ball(offset * _ROUNDED)


def _spread(
    expression: Expression, claim: Fraction, least: Mapping[str, Fraction | float], greatest: dict[str, float]
) -> None:
    """Upper bounds of the terms where the sum is below the claim and the other terms have their least values."""
    lowest = [Fraction(weight) * least.get(repr(term), Fraction(0)) for weight, term in expression.terms]
    for i, (weight, term) in enumerate(expression.terms):
        others = sum([*lowest[:i], *lowest[i + 1 :]], Fraction(0))
        if isinstance(others, float):
            continue
        value = rounded_up((claim - others) / Fraction(weight))
        greatest[repr(term)] = max(min(greatest.get(repr(term), inf), value), float(least.get(repr(term), 0)))
        if isinstance(term, Maximum):
            for part in term.parts:
                _spread(part, Fraction(value), least, greatest)


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
