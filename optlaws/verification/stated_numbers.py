"""Numbers that a file states beside its proof, compared with values computed from the law."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import inf
from typing import Any

from flint import arb, ctx, fmpq, fmpq_poly

from optlaws.errors import InputError
from optlaws.numbers import real
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.limits.rounding import rounded_down
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.spaces.bases import PolynomialBasis
from optlaws.synthesis.spaces.splines import PiecewiseBasis
from optlaws.tolerances import COEFFICIENT_ROUNDING, STATED_BOUND
from optlaws.verification.enclosing.balls import at, enclosed, rational
from optlaws.verification.enclosing.pieces import between, least_and_greatest
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.exact.sublevel_bounds import exact_limit
from optlaws.verification.reading import number
from optlaws.verification.result import Claim

_STATED_CONSTANT = 1e-11  # of a constant: what one that was computed in doubles may be off
_STATED_PLACE = 1e-7  # of a constant: what its value may be less at a place that was computed in doubles

_WHOLE = (fmpq(-1), fmpq(1))
_ORDERS = {"B": 1, "C": 2, "J": 3}


def at_most(name: str, stated: float, proven: Fraction | None, scale: float, source: str = "") -> Claim:
    """The claim that a stated bound is proven up to rounding; a bound near 0 is compared with its scale."""
    if proven is None:
        return Claim(name, proven=False, detail=f"{stated!r} stated, nothing proven")
    holds = Fraction(stated) <= proven + Fraction(STATED_BOUND) * max(Fraction(scale), abs(proven))
    return Claim(name, holds, f"{stated!r} stated, {rounded_down(proven)!r} proven{source}")


def stated_numbers(
    data: Mapping[str, Any], problem: Problem, law: ExactLaw, objective: tuple[float, float]
) -> Iterator[Claim]:
    """Objective, limit and Z of a solution."""
    if "objective" in data:
        yield near("the objective", number(data, "objective"), objective, problem.objective.scale)
    if data.get("limit") is not None:
        yield _limit(number(data, "limit"), problem)
    if data.get("z") is not None:
        yield _of_z(data["z"], problem, law)


def _limit(value: float, problem: Problem) -> Claim:
    """The claim that a limit for laws of any degree has an exact closed form, or agrees with one in doubles."""
    scale = problem.objective.scale
    claim = at_most("the limit", value, exact_limit(problem), scale, " by its closed form")
    known = known_limit(problem)
    if claim.proven or known is None:
        return claim
    agrees = value <= known + STATED_BOUND * max(scale, known)
    return Claim("the limit", proven=False, detail=f"{value!r} stated, {known!r} in doubles", checked=not agrees)


def stated_constants(data: Mapping[str, Any], law: ExactLaw) -> Iterator[Claim]:
    """B, C, D, J and rms_c with their places."""
    stated = data.get("constants", {})
    if not isinstance(stated, Mapping):
        raise InputError(f"constants must be an object, got {stated!r}")
    balls = law.constants()
    if unknown := [name for name in stated if name not in balls]:
        raise InputError(f"constants: {unknown[0]!r} is none of {', '.join(balls)}")
    for name, statement in stated.items():
        entry, key = (statement, "value") if isinstance(statement, Mapping) else (stated, name)
        # JSON knows no infinite number
        value = inf if entry.get(key, 0) is None else number(entry, key)
        yield near(name, value, enclosed(balls[name]))
        if "k" in entry and value < inf:
            yield _reached(name, value, number(entry, "k"), law)


def near(name: str, stated: float, pair: tuple[float, float], scale: float = 1.0) -> Claim:
    """The claim that a stated value is the proven one up to rounding; a value near 0 is compared with its scale."""
    low, high = pair
    room = _STATED_CONSTANT * max(scale, abs(high)) if high < inf else 0.0
    # an enclosure that is wider than what may be off proves nothing of a number in it
    narrow = low == high or high - low <= room
    return Claim(name, narrow and low - room <= stated <= high + room, f"{stated!r} stated, in [{low!r}, {high!r}]")


def _reached(name: str, value: float, k: float, law: ExactLaw) -> Claim:
    if not 0.0 <= k <= 1.0:
        return Claim(f"place of {name}", proven=False, detail=f"k = {k!r} is not in [0, 1]")
    place = Fraction(k)
    with ctx.workprec(law.precision):
        magnitudes = []
        for piece in law.pieces:
            if piece.start <= place <= piece.stop:
                b, *others = (piece.value(nu, place) for nu in (1, _ORDERS.get(name, 2)))
                magnitudes.append(abs(b * others[0]) if name == "D" else abs(others[0]))
    highest = max((enclosed(magnitude)[1] for magnitude in magnitudes), default=0.0)
    # a constant power is the same everywhere, and 0 times infinity at its end
    holds = highest >= value - _STATED_PLACE * max(1.0, value) or not all(
        magnitude.is_finite() for magnitude in magnitudes
    )
    return Claim(f"place of {name}", holds, f"{highest!r} at k = {k!r}")


def _of_z(z: object, problem: Problem, law: ExactLaw) -> Claim:
    """The claim that Z with the end conditions gives the law."""
    basis, order, conditions = problem.basis, problem.order, problem.conditions
    if not isinstance(basis, PolynomialBasis | PiecewiseBasis):
        raise InputError(f"z is given, but laws in {basis!r} have no Z")
    if not isinstance(z, list | tuple) or any(real(coefficient) is None for coefficient in z):
        raise InputError(f"z must be a list of numbers, got {z!r}")
    if len(z) != basis.size:
        return Claim("Z", proven=False, detail=f"it has {len(z)} coefficients, {basis!r} has {basis.size}")
    exact = [Fraction(coefficient) for coefficient in z]
    pieces = basis.pieces(exact) if isinstance(basis, PiecewiseBasis) else [exact]
    if len(pieces) != len(law.pieces):
        return Claim("Z", proven=False, detail=f"Z has {len(pieces)} pieces, the law {len(law.pieces)}")
    k = fmpq_poly([0, 1])
    a0, a1 = (fmpq_poly([rational(coefficient) for coefficient in part]) for part in (conditions.a0(), conditions.a1()))
    off = []
    for powers, piece in zip(pieces, law.polynomials, strict=True):
        whole = fmpq_poly([rational(Fraction(power)) for power in powers])
        if isinstance(basis, PiecewiseBasis):
            whole = whole((k - rational(piece.start)) / rational(piece.stop - piece.start))
        a = a0 + k**order * (a1 + (k - 1) ** order * whole)
        at_k = fmpq_poly([rational((piece.start + piece.stop) / 2), 1 / piece.rate])
        off.append(a(at_k) - piece.derivative(0))
    return _small("Z", off, law, COEFFICIENT_ROUNDING * (1.0 + float(sum(map(abs, exact))) / 4.0**order))


def _small(name: str, off: list[fmpq_poly], law: ExactLaw, allowed: float) -> Claim:
    """The claim that polynomials in y are small from -1 to 1."""
    with ctx.workprec(law.precision):
        # what is not small at a few places need not be enclosed everywhere
        least = max(enclosed(abs(at(polynomial, arb(y) / 4)))[0] for polynomial in off for y in range(-4, 5))
        if least > allowed:
            return Claim(name, proven=False, detail=f"off by {least:.1e} or more, {allowed:.1e} is allowed")
        by = enclosed(law.magnitude(least_and_greatest([value for part in off for value in between(part, *_WHOLE)])))[1]
    return Claim(name, by <= allowed, f"off by at most {by:.1e}, {allowed:.1e} is allowed")
