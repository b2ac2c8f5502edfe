"""The least time of a span: Newton's method on the least greatest share of its limits, and the proof by multipliers.

At a scale of the time the law is sought whose greatest share of a limit is least. At the least scale that share is 1.
By the envelope theorem its logarithm falls with that of the scale by the mean of the limits' powers, weighted with
their multipliers, so that some four convex problems lead there. The same multipliers show that a little faster no law
keeps the limits: their sum is affine in what the limits allow.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, sqrt

from optlaws.cycles.greatest_speed.scaling import SpanLimit
from optlaws.cycles.greatest_speed.span_limits import least_scale
from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.synthesis.problem.constants import D, meant
from optlaws.synthesis.problem.expression import maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.tolerances import BINDING_LIMIT, FASTER, LEAST_SCALE_MET, LEAST_SHARE

_ROUNDS = 20
#: about what constants of laws from rest to rest are, from which a first scale is taken
_USUAL = {1: 1.6, 2: 5.0, 3: 40.0, 4: 600.0}
_LEVEL = 0.2  # a slope below it is that of a force that is mostly static
_PART = re.compile(r"part (\d+) of ")


@dataclass(frozen=True)
class SpanTime:
    """The least scale of the time of a span, the law that has it, and why no law is faster.

    `shares` are the multipliers of the limits, which sum to 1: a limit that is raised by a little shortens the time by
    its multiplier over the mean power. `base` is the problem without its limits, None for a law that is given, and
    `last` the solution whose multipliers may prove the most.
    """

    scale: float
    law: MotionLaw | None
    rows: tuple[SpanLimit, ...]
    shares: tuple[float, ...] = ()
    solution: Solution | None = None
    base: Problem | None = None
    last: Solution | None = None

    @kept_property
    def proof(self) -> Certificate | None:
        """Proof that no law satisfies the limits in `FASTER` less time; None for a given law, or if no proof is known.

        It is a contradiction or, of the power of an inertia, a bound of the least power that is above its limit.
        """
        if self.base is None or self.last is None:
            return None
        faster = self.scale * (1.0 - FASTER)
        allowed = _allowed_power(self.rows, faster)
        if allowed is not None:
            return _proof_of_power(self.base, self.rows, faster, allowed)
        proof = _proof(self.base, self.rows, faster, self.last)
        return proof or _proof(self.base, self.rows, faster, _least_share(self.base, self.rows, faster, self.last))

    @property
    def binding(self) -> tuple[SpanLimit, ...]:
        """The limits that the law takes to the full."""
        if self.law is None:
            return ()
        used = [(row, row.least_scale(self.law)) for row in self.rows]
        return tuple(row for row, scale in used if scale >= self.scale * (1.0 - BINDING_LIMIT))


def least_time_of_law(law: MotionLaw, rows: Sequence[SpanLimit]) -> SpanTime:
    """The least scale of a law that is given, in closed form."""
    return SpanTime(least_scale(rows, law), law, tuple(rows))


def least_time(base: Problem, rows: Sequence[SpanLimit], where: str) -> SpanTime:
    """The least scale of the time at which a law of a problem keeps all limits, with the law and the proof.

    Raises
    ------
    SolverFailure
        If the scale is not met.
    """
    scale = max(_first_scale(row) for row in rows)
    best, short = inf, 0.0
    previous: Solution | None = None
    fastest: Solution | None = None
    for _ in range(_ROUNDS):
        solution = _least_share(base, rows, scale, previous)
        reached = least_scale(rows, solution.law)
        if reached < best:
            best, fastest = reached, solution
        if best < inf and _proof(base, rows, best * (1.0 - LEAST_SCALE_MET), solution) is not None:
            break
        if solution.lower_bound > 1.0:
            short = max(short, scale)
        following = _following(scale, solution.objective, _mean_slope(rows, solution, scale), (short, best))
        if abs(following - scale) <= LEAST_SCALE_MET * scale:
            break
        scale, previous = following, solution
    if fastest is None:
        raise SolverFailure(f"{where}: no least time was found: widen its limits a little, or give it another degree")
    return SpanTime(best, fastest.law, tuple(rows), _shares(rows, solution, scale), fastest, base, solution)


def _following(scale: float, share: float, slope: float, ends: tuple[float, float]) -> float:
    """The scale at which the share is 1 by its slope; between the ends, in ratio, where it is level or leads out."""
    short, best = ends
    if slope > _LEVEL:
        following = float(scale * max(share, LEAST_SHARE) ** (1.0 / slope))
        if short <= following <= best * (1.0 + LEAST_SCALE_MET):
            return following
    return sqrt(short * best) if short and best < inf else 2.0 * scale if best == inf else 0.6 * best


def _first_scale(row: SpanLimit) -> float:
    """A scale at which a usual law takes a limit to the full."""
    _, weight = row.term(1.0)
    nu = row.key.kind.order
    return float((_USUAL.get(nu, 1.0) * weight) ** (1.0 / (nu or 2)))


def _least_share(base: Problem, rows: Sequence[SpanLimit], scale: float, start: Solution | None) -> Solution:
    """The law that minimises its greatest use of a limit."""
    terms = [weight * constant for constant, weight in (row.term(scale) for row in rows)]
    problem = replace(base, minimise=terms[0] if len(terms) == 1 else maximum(*terms))
    with meant():
        return synthesize(problem, start=start)


def limited(base: Problem, rows: Sequence[SpanLimit], scale: float) -> Problem:
    """The problem of laws that keep all limits at a scale of the time; it minimises the first limited constant."""
    terms = [row.term(scale) for row in rows]
    bounds: dict[object, Range] = {}
    for constant, weight in terms:
        known = bounds.get(constant)
        bounds[constant] = Range(0.0, 1.0 / weight if known is None else min(known.high, 1.0 / weight))
    return replace(base, minimise=terms[0][0].expression(), bounds=bounds)


def _proof(base: Problem, rows: Sequence[SpanLimit], scale: float, solution: Solution) -> Certificate | None:
    """Proof that no law satisfies the limits at a scale, by the multipliers of the least share at another scale."""
    contacts = [contact for contact in solution.certificate.contacts if not _PART.match(contact.constraint)]
    proof = Certificate.of_leaf(limited(base, rows, scale), contacts, solution.certificate.equations, VIOLATION)
    return proof if proof.proves_infeasible else None


def _allowed_power(rows: Sequence[SpanLimit], scale: float) -> float | None:
    """The greatest D that limits of the power of an inertia allow at a scale; None without such limits."""
    terms = (row.term(scale) for row in rows)
    return min((1.0 / weight for constant, weight in terms if constant == D), default=None)


def _proof_of_power(base: Problem, rows: Sequence[SpanLimit], scale: float, allowed: float) -> Certificate | None:
    """Proof that no law within the other limits has as little power as is allowed, or that no law satisfies these."""
    within = limited(base, rows, scale)
    others = {constant: bound for constant, bound in within.bounds.items() if constant != D}
    try:
        with meant():
            solution = synthesize(replace(within, minimise="D", bounds=others, D=None), bound="tight")
    except InfeasibleProblem as error:
        proof = error.proof
        return proof if isinstance(proof, Certificate) and proof.proves_infeasible else None
    except SolverFailure:
        return None
    bound = solution.power_certificate
    return bound if bound is not None and bound.bound > allowed else None


def _shares(rows: Sequence[SpanLimit], solution: Solution, scale: float) -> tuple[float, ...]:
    """The multipliers of the limits, which sum to 1."""
    shares = [0.0] * len(rows)
    for contact in solution.certificate.contacts:
        part = _PART.match(contact.constraint)
        if part is not None:
            shares[int(part[1]) - 1] += max(contact.multiplier, 0.0)
    if not any(shares):
        # one limit alone, or a law without a proof: those that it takes most of share alike
        sizes = [constant.value(solution.law) * weight for constant, weight in (row.term(scale) for row in rows)]
        shares = [float(size >= max(sizes) * (1.0 - BINDING_LIMIT)) for size in sizes]
    return tuple(share / sum(shares) for share in shares)


def _mean_slope(rows: Sequence[SpanLimit], solution: Solution, scale: float) -> float:
    """The power by which the least share falls with the scale."""
    shares = _shares(rows, solution, scale)
    return sum(share * row.slope(solution.law, scale) for row, share in zip(rows, shares, strict=True) if share)
