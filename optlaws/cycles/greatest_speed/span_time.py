"""The least time of a span of a cycle: a motion whose ends and points on the way turn with the master."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from optlaws.cycles.greatest_speed.scaling import SpanLimit
from optlaws.cycles.greatest_speed.span_limits import least_scale
from optlaws.cycles.optimisation.motion_limits import name_of
from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.synthesis.least_time.move_limits import MoveLimits, RateLimit, TimedLimit
from optlaws.synthesis.least_time.segment_times import time_of_any_law
from optlaws.synthesis.least_time.time_search import fastest_law
from optlaws.synthesis.least_time.timed import Timed
from optlaws.synthesis.problem.constants import B, C, C_minus, C_plus, D, J, meant, snap
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.solve import synthesize
from optlaws.tolerances import BINDING_LIMIT, FASTER

#: about what constants of laws from rest to rest are, from which a first scale is taken
_USUAL = {1: 1.6, 2: 5.0, 3: 40.0, 4: 600.0}


@dataclass(frozen=True)
class TimedProblem(Timed):
    """The laws of a span, with limits that depend on the scale of its time alone."""

    problem: Problem
    limits: tuple[SpanLimit, ...]

    @property
    def of_rates(self) -> bool:
        """Whether all limits are those of derivatives."""
        return all(limit.key.kind.order for limit in self.limits)

    @property
    def rates(self) -> tuple[RateLimit, ...]:
        """The limits of derivatives, in units of the law at the scale 1."""
        terms = ((limit.key.kind.order, *limit.term(1.0)) for limit in self.limits)
        return tuple(RateLimit("", constant, nu, 1.0 / weight) for nu, constant, weight in terms if nu)

    @property
    def stays_possible(self) -> bool:
        """Whether a law that keeps all limits keeps them at every lower speed."""
        return all(limit.scales for limit in self.limits)

    @kept_property
    def limit(self) -> float | None:
        """The scale that no law of any degree is faster than, from rest to rest; None where none is known."""
        if self.problem.boundary is not None:
            return None
        most = {limit.constant: limit.rate for limit in sorted(self.rates, key=lambda each: -each.rate)}
        up, down = (most.get(side, most.get(C)) for side in (C_plus, C_minus))
        limits = MoveLimits(most.get(B), up, down, most.get(J), most.get(snap))
        return time_of_any_law(1.0, limits, self.problem.order)

    @property
    def begin(self) -> float:
        """The scale that no law is faster than, or the greatest at which a usual law takes a limit to the full."""
        return self.limit or max(map(_usual_scale, self.limits))

    def limits_in(self, duration: float) -> tuple[TimedLimit, ...]:
        """Every limit at a scale of the time."""
        terms = [(name_of(limit.key, "length"), *limit.term(duration)) for limit in self.limits]
        return tuple(TimedLimit(name, constant, 1.0 / weight) for name, constant, weight in terms)


@dataclass(frozen=True)
class SpanTime:
    """The least scale of the time of a span, the law that has it, and why no law is faster.

    `base` is the problem without its limits, None for a law that is given; `certificate` is of `FASTER` less time.
    """

    scale: float
    law: MotionLaw | None
    rows: tuple[SpanLimit, ...]
    base: Problem | None = None
    certificate: Certificate | None = None

    @kept_property
    def proof(self) -> Certificate | None:
        """Proof that no law satisfies the limits in `FASTER` less time; None for a given law, or if no proof is known.

        It is a contradiction or, of the power of an inertia, a bound of the least power that is above its limit.
        """
        if self.base is None or self.certificate is not None:
            return self.certificate
        faster = TimedProblem(self.base, self.rows).limits_in(self.scale * (1.0 - FASTER))
        allowed = min((limit.bound for limit in faster if limit.constant == D), default=None)
        return None if allowed is None else self._proof_of_power(self.base, allowed)

    def _proof_of_power(self, base: Problem, allowed: float) -> Certificate | None:
        """Proof that no law within the other limits has as little power as is allowed, or that none satisfies these."""
        others = tuple(row for row in self.rows if row.term(1.0)[0] != D)
        within = TimedProblem(base, others).within(self.scale * (1.0 - FASTER))
        try:
            with meant():
                solution = synthesize(replace(within, minimise="D"), bound="tight")
        except InfeasibleProblem as error:
            proof = error.proof
            return proof if isinstance(proof, Certificate) and proof.proves_infeasible else None
        except SolverFailure:
            return None
        bound = solution.power_certificate
        return bound if bound is not None and bound.bound > allowed else None

    @property
    def limit(self) -> float | None:
        """The scale that no law of any degree is faster than, or that of a given law; None where it is not known."""
        return self.scale if self.base is None else TimedProblem(self.base, self.rows).limit

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
    try:
        scale, solution, proofs = fastest_law(TimedProblem(base, tuple(rows)))
    except SolverFailure as error:
        raise SolverFailure(
            f"{where}: no least time was found: widen its limits a little, or give it another degree",
            problem=base,
        ) from error
    certificate = proofs[-1].certificate if proofs else None
    return SpanTime(scale, solution.law, tuple(rows), base, certificate)


def _usual_scale(limit: SpanLimit) -> float:
    """A scale at which a usual law takes a limit to the full."""
    nu = limit.key.kind.order
    usual = _USUAL.get(nu, 1.0) * limit.term(1.0)[1]
    return float(usual ** (1.0 / (nu or 2)))
