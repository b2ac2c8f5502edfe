"""Motions of a cycle at any scale of their time: their limits, the least scale within these, and its proof.

A motion that is run `scale` times slower has its velocity divided by the scale, its acceleration by the square of it. A
derivative of order nu so falls with the power nu of the scale, whatever the law: a law that keeps such a limit keeps it
at every lower speed. Of force it takes what it takes at rest in its positions, the static force F_0, and the rest
divided by the square of the scale. With u = 1/scale² that is (1 - u) F_0 + u F: between two forces that keep the limit,
where the static one does. With viscous friction, below a motor's curve and of power this follows between rests where
inertia and static force are constant: docs/how-to/cycle.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby
from math import exp, inf, log
from operator import itemgetter
from typing import Any

import numpy as np

from optlaws.cycles.optimisation.objectives import CycleObjective, torque_at_rest
from optlaws.cycles.optimisation.span_values import SpanValue, known_drive, limited_value, span_value
from optlaws.cycles.specification.limits import Side, Sides, in_units, name_of
from optlaws.cycles.specification.programme import LawSpan
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.formulas.tree import Number, table_places
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.quantities import Kind, in_small_units
from optlaws.motion.smooth_parts import SmoothParts
from optlaws.numbers import Array
from optlaws.numerics.roots import falling_root
from optlaws.sentences import sentence
from optlaws.synthesis.functionals.makers import PeakSide, peak
from optlaws.synthesis.least_time.least_time import LeastTime
from optlaws.synthesis.least_time.move_limits import MoveLimits, SpanLimit, derivative_limit, scale_of_any_law
from optlaws.synthesis.least_time.time_search import least_time
from optlaws.synthesis.least_time.timed_move import Timed
from optlaws.synthesis.problem.constants import B, C, C_minus, C_plus, D, Functional, J, meant, snap
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.solve import synthesize
from optlaws.tolerances import AGREEMENT, BINDING_LIMIT, FASTER, LEAST_SHARE, SAME_TIME

#: of the logarithm of a scale: one that is so far from 1 is none
_SLOWEST = 40.0
#: about what constants of laws from rest to rest are, from which a first scale is taken
_USUAL = {1: 1.6, 2: 5.0, 3: 40.0, 4: 600.0}


@dataclass(frozen=True)
class TimedSpan(Timed):
    """A motion of the cycle with its duration where it was looked at, whose least scale of this time is sought.

    Attributes
    ----------
    span, duration
        The motion, and its duration in seconds.
    along
        Its limits over the scale of its time.
    problem
        The problem without its limits, None for a law that is given.
    given
        The law that is given, if any.
    """

    span: LawSpan
    duration: float
    along: tuple[SpanLimit, ...] = ()
    problem: Any = None
    given: MotionLaw | None = None

    @property
    def begin(self) -> float:
        """Between rests the scale that no law is faster than, else the greatest at which a usual law takes a limit."""
        usual = ((_USUAL.get(limit.nu, 1.0) / limit.rate) ** (1.0 / (limit.nu or 2)) for limit in self.along)
        return (self.best_possible if self.problem.boundary is None else None) or max(usual)

    @property
    def where(self) -> str:
        return self.span.where

    @property
    def places(self) -> tuple[int, ...]:
        return tuple(stretch.number - 1 for stretch in self.span.stretches)

    @property
    def needed(self) -> float:
        """The least duration that the motion needs, in seconds."""
        return self.duration * self.scale

    @kept_property
    def scale(self) -> float:
        """The least scale of the time at which a law keeps the limits, or the law that is given does; 0 without any."""
        if self.problem is not None:
            return self._least.duration
        return 0.0 if self.given is None else least_time_of(self.given, self.along)

    @property
    def law(self) -> MotionLaw | None:
        """The law that has the least scale; None where nothing limits it."""
        return self.given if self.problem is None else self._least.law

    @kept_property
    def _least(self) -> LeastTime[TimedSpan]:
        try:
            return least_time(self)
        except SolverFailure as error:
            raise SolverFailure(
                f"{self.where}: no least time was found: widen its limits a little, or give it another degree",
                problem=self.problem,
            ) from error

    @kept_property
    def best_possible(self) -> float | None:
        """The scale that no law of any degree is faster than, or that of a given law; None where it is not known."""
        if self.problem is None:
            return self.scale
        ends = self.problem.conditions
        rates = (ends.start[1], ends.end[1]) if self.problem.order > 1 else (0.0, 0.0)
        if (ends.start[0], ends.end[0]) != (0.0, 1.0) or any((*ends.start[2:], *ends.end[2:])):
            return None
        most: dict[Functional, float] = {}
        for constant, rate in (limit.term(1.0) for limit in self.rates):
            most[constant] = min(rate, most.get(constant, inf))
        up, down = (most.get(side, most.get(C)) for side in (C_plus, C_minus))
        limits = MoveLimits(most.get(B), up, down, most.get(J), most.get(snap))
        return scale_of_any_law(limits, self.problem.order, rates)

    @property
    def binding(self) -> tuple[SpanLimit, ...]:
        """The limits that the law takes to the full."""
        law, least = self.law, self.scale * (1.0 - BINDING_LIMIT)
        return () if law is None else tuple(limit for limit in self.along if least_scale(limit, law) >= least)

    @kept_property
    def proof(self) -> Certificate | None:
        """Proof that no law satisfies the limits in `FASTER` less time; None for a given law, or if no proof is known.

        It is a contradiction or, of the power of an inertia, a bound of the least power that is above its limit.
        """
        if self.problem is None or self._least.proofs:
            return self._least.proofs[-1].certificate if self.problem else None
        faster = self.scale * (1.0 - FASTER)
        allowed = min((limit.bound for limit in self.limits_in(faster) if limit.constant == D), default=None)
        if allowed is None:
            return None
        others = replace(self, along=tuple(limit for limit in self.along if limit.term(1.0)[0] != D))
        try:
            with meant():
                solution = synthesize(replace(others.within(faster), minimise="D"), bound="tight")
        except InfeasibleProblem as error:
            proof = error.proof
            return proof if isinstance(proof, Certificate) and proof.proves_infeasible else None
        except SolverFailure:
            return None
        bound = solution.power_certificate
        return bound if bound is not None and bound.bound > allowed else None


def least_time_of(law: MotionLaw, limits: Sequence[SpanLimit]) -> float:
    """The least time, or scale of it, from which on a law satisfies limits; infinite if none does, 0 if all do."""
    return max((least_scale(limit, law) for limit in limits), default=0.0)


def least_scale(limit: SpanLimit, law: MotionLaw) -> float:
    """The least scale from which on a law satisfies a limit; infinite if no scale does, 0 if all do."""
    if limit.nu:
        return float(max(limit.at(1.0).share(law), 0.0) ** (1.0 / limit.nu))

    def excess(logarithm: float) -> float:
        return log(max(limit.at(exp(logarithm)).share(law), LEAST_SHARE))

    logarithm = falling_root(excess, 0.0, log(2.0), SAME_TIME, _SLOWEST)
    return exp(logarithm) if logarithm > -0.5 * _SLOWEST else 0.0


def slower(span: LawSpan, scale: float) -> LawSpan:
    """The span slowed down by a factor: its times are longer, its velocities and accelerations smaller.

    >>> from optlaws.cycles.specification.programme import State
    >>> span = LawSpan((), (0.5,), 1.0, 0.0, 0.1, State(1.0, 8.0), State(0.0, 0.0), ((0.75, 0.05),))
    >>> slower(span, 2.0).stop, slower(span, 2.0).first, slower(span, 2.0).via
    (2.0, State(velocity=0.5, acceleration=2.0), ((1.5, 0.05),))
    """
    first, last, *states = (
        state and state._replace(velocity=state.velocity / scale, acceleration=state.acceleration / scale**2)
        for state in (span.first, span.last, *span.states)
    )
    assert first is not None  # noqa: S101 - both are known
    assert last is not None  # noqa: S101 - as above
    return replace(
        span,
        starts=tuple(start * scale for start in span.starts),
        stop=span.stop * scale,
        first=first,
        last=last,
        via=tuple((time * scale, position) for time, position in span.via),
        states=tuple(states),
    )


def limits_of_span(span: LawSpan, limits: Sequence[Sides], objective: CycleObjective) -> list[SpanLimit]:
    """The limits of a span, from the limits of each of its segments."""
    parts = list[tuple[tuple[float, float], Sides]]()
    for given, of_part in groupby(zip(limits, span.timed, strict=True), key=itemgetter(0)):
        times = [time for _, (_, *ends) in of_part for time in ends]
        parts.append(((span.place(times[0]), span.place(times[-1])), given))
    rows: list[SpanLimit] = []
    for key in dict.fromkeys(key for _, of_part in parts for key in of_part):
        if key.kind is Kind.VELOCITY_ALONG:
            continue  # of the laws that are looked for, at every speed
        limited = [(ends, of_part[key]) for ends, of_part in parts if key in of_part]
        first, everywhere = limited[0][1], len(limited) == len(parts)
        alike = everywhere and all(most == first for _, most in limited)
        if key.kind.is_driven:
            if not alike:
                raise InputError(f"{span.where} are one law: give the force or power of all of them the same limit")
            rows += _of_drive(key, first, span, known_drive(objective.drive), objective.axis)
            continue
        known, nu = limited_value(span, objective.drive, key), key.kind.order
        side: PeakSide = "both" if not key.sign else "high" if key.sign * span.stroke > 0.0 else "low"
        # those of the snap are of whole spans
        of_law = [
            (peak("abcj"[nu], side=side, start=start, stop=stop), most)
            for (start, stop), most in ([] if alike else limited)
        ]
        if everywhere:
            # beside those of parts it says nothing new, but bounds laws as wholes, without which nothing is proven
            of_law.append((known.constants[0], max(most for _, most in limited)))
        rows += [
            derivative_limit(name_of(key, objective.axis), most, of, nu, most / known.unit, key) for of, most in of_law
        ]
    return rows


def _of_drive(key: Side, most: float, span: LawSpan, drive: Drive, axis: str) -> list[SpanLimit]:
    if key.kind in {Kind.FORCE, Kind.CURVE}:
        position, force = static_force(span, drive)
        allowed_at_rest = most * (torque_at_rest(drive) if key.kind is Kind.CURVE else 1.0)
        if force > allowed_at_rest * (1.0 + AGREEMENT):
            taken, allowed = (in_units(Side(Kind.FORCE), value, axis) for value in (force, allowed_at_rest))
            raise InfeasibleProblem(
                sentence(
                    "{}: at {} the static load needs {}, so that no speed keeps {}: allow more, or change the drive's "
                    "spring, preload, gravity or friction",
                    span.where, in_small_units(position, axis), taken, allowed,
                )
            )  # fmt: skip

    def term(part: int, scale: float) -> tuple[Functional, float]:
        known = span_value(slower(span, scale), drive, key.kind)
        return known.constants[part], most / known.unit

    known = span_value(span, drive, key.kind)
    scales = _scales(key.kind, span, drive, known)
    return [
        SpanLimit(name_of(key, axis), most, partial(term, part), 0, scales, key) for part in range(len(known.constants))
    ]


def _scales(kind: Kind, span: LawSpan, drive: Drive, driven: SpanValue) -> bool:
    """Whether the limit is the original one, so that a law which keeps it keeps it at every lower speed."""
    resting = not any((span.first.velocity, span.last.velocity))
    force = drive.linear
    if force is None or kind is Kind.CURVE:
        # a torque that keeps its limit keeps it at every lower speed where the static one does, which is one
        mechanism = drive.mechanism
        if not driven.exact or kind is Kind.POWER or not isinstance(mechanism.load_formula, Number):
            return False
        frictionless = kind is Kind.FORCE and not mechanism.viscous and not drive.train.viscous
        return frictionless or (resting and isinstance(mechanism.inertia_formula, Number))
    plain = resting and force.stiffness == 0.0
    if kind is Kind.FORCE:
        return force.viscous == 0.0 or plain
    static = force.dry + (force.constant if span.displacement > 0.0 else -force.constant)
    if force.stiffness == force.constant == force.dry == 0.0:
        return force.viscous == 0.0 or plain
    # dry friction is of laws that never turn back
    return plain and force.dry > 0.0 and (force.viscous == 0.0 or static >= 0.0)


def static_force(span: LawSpan, drive: Drive) -> tuple[float, float]:
    """The position of the greatest static force of a motion, and this force: spring, weight and dry friction."""
    direction = -1.0 if span.displacement < 0.0 else 1.0

    def force(x: Array) -> Array:
        return np.asarray(np.abs(drive.torque(x, 0.0 * x, 0.0 * x, direction=direction, time=span.start)))

    ends = np.array([span.offset, *(position for _, position in span.via), span.offset + span.displacement])
    if drive.linear is not None:
        return max(zip(ends.tolist(), force(ends).tolist(), strict=True), key=lambda place: place[1])
    corners = [place for place in table_places(drive.mechanism.load_formula, "x") if ends.min() < place < ends.max()]
    return SmoothParts.between(ends.min(), ends.max(), breaks=corners).greatest(force)[::-1]
