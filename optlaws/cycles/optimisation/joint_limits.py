"""Velocities and forces at joints where the motion is known: no law changes them, so that limits must allow them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import accumulate
from math import copysign
from operator import itemgetter

from optlaws.cycles.optimisation.objectives import CycleObjective
from optlaws.cycles.optimisation.optimal import solve
from optlaws.cycles.optimisation.span_values import size_of
from optlaws.cycles.specification.joints import LawSpan, Layout, State
from optlaws.cycles.specification.limits import DECELERATION, SPEEDING_UP, Side, Sides, in_units, tightest
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import Kind, in_small_units
from optlaws.sentences import Amount, sentence
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import AGREEMENT

_ACCELERATION_KNOWN = 3
_FORCE = Side(Kind.FORCE)

Solved = tuple[tuple[Piece, Solution], ...]


@dataclass(frozen=True)
class _End:
    """An end of a stretch with an optimised law, where velocity and acceleration are known."""

    limits: Sides
    name: str
    time: float
    position: float
    state: State
    direction: float

    def demand(self, objective: CycleObjective, kind: Kind) -> float:
        """The velocity or the force there, in SI units; 0 where it is not known."""
        if kind is Kind.VELOCITY:
            return abs(self.state.velocity)
        drive = objective.drive
        if kind is not Kind.FORCE or drive is None:
            return 0.0
        if (drive.linear is None or drive.linear.inertia) and objective.order < _ACCELERATION_KNOWN:
            return 0.0
        velocity = self.state.velocity
        way = copysign(1.0, velocity) if velocity else self.direction
        return abs(float(drive.torque(self.position, *self.state, direction=way, time=self.time)))


def check_limits_at_joints(layout: Layout, objective: CycleObjective, period: float) -> None:
    """Refuse a limit that no law keeps: of slowing down where it turns, of force less than a joint takes."""
    for span in layout.spans:
        _check_direction(span, objective)
        for end in _ends(span, objective):
            needed = end.demand(objective, Kind.FORCE)
            most = end.limits.get(_FORCE, needed)
            if needed > most * (1.0 + AGREEMENT):
                taken, allowed = (in_units(_FORCE, force, objective.axis) for force in (needed, most))
                raise InfeasibleProblem(
                    sentence(
                        "{}, at {} and {} of the master, every law takes {}, but its limit is {}: allow more, or "
                        "change the drive's spring, preload, gravity or friction",
                        end.name, in_small_units(end.position, objective.axis),
                        Amount(360.0 * end.time / period, "deg"), taken, allowed,
                    )
                )  # fmt: skip


def _check_direction(span: LawSpan, objective: CycleObjective) -> None:
    """Refuse a limit of slowing down where the velocities at the ends turn the motion back."""
    keys = [key for limits in span.sides(objective.limits) for key in limits or ()]
    against = any(state.velocity * span.displacement < 0.0 for state in (span.first, span.last))
    if against and any(key.kind is Kind.VELOCITY_ALONG for key in keys):
        raise InfeasibleProblem(
            f"{span.where} begins or ends against its way, so that it turns back, which its velocity must not"
        )
    if span.may_turn and any(key.name in {DECELERATION, SPEEDING_UP} for key in keys):
        raise InputError(
            f"{span.where} begins or ends against its way, so that slowing down is of no one direction: give its "
            "acceleration as the least and the greatest, such as ('-8 m/s^2', '12 m/s^2'), in place of a deceleration"
        )


def _ends(span: LawSpan, objective: CycleObjective) -> Iterator[_End]:
    """The ends of stretches of a span at which its motion is known."""
    inner = (None,) * (len(span.stretches) - 1)
    states = (*span.states, span.states[0]) if span.turns else (span.first, *inner, span.last)
    positions = list(accumulate((stretch.displacement for stretch in span.stretches), initial=span.offset))
    times = (*span.starts, span.stop)
    direction = 0.0 if span.may_turn else 1.0 if span.displacement > 0.0 else -1.0
    for i, limits in enumerate(span.sides(objective.limits)):
        for j, name in ((i, "start"), (i + 1, "end")) if limits is not None else ():
            where, state = f"{span.stretches[i].where}: at its {name}", states[j]
            if state is not None:
                yield _End(limits or {}, where, times[j], positions[j], state, direction)


def ties_broken(
    layout: Layout, objective: CycleObjective, laws: Solved, period: float
) -> tuple[Solved, tuple[str, ...]]:
    """The laws of least acceleration among laws of least peak, where the peak is at a joint or in a given segment.

    There no law changes the peak of the velocity or force, so that many take no more elsewhere. Beside the laws: a
    remark that says so.
    """
    kind = objective.kind
    if objective.mean or kind not in {Kind.VELOCITY, Kind.FORCE} or not laws:
        return laws, ()
    known = [(size_of(piece, kind, objective.drive), piece.start) for piece in layout.pieces]
    known += [(end.demand(objective, kind), end.time) for span in layout.spans for end in _ends(span, objective)]
    greatest, time = max(known, key=itemgetter(0), default=(0.0, 0.0))
    if max(size_of(piece, kind, objective.drive) for piece, _ in laws) > greatest * (1.0 + AGREEMENT):
        return laws, ()
    limits = tightest(objective.limits, {kind: (-greatest, greatest)})
    calm = replace(objective, minimise="acceleration", limits=limits)
    remark = sentence(
        "the {} is greatest at {} of the master, where no law changes it: of the laws that take no more elsewhere, "
        "those of least acceleration",
        objective.minimise, Amount(360.0 * time / period, "deg"),
    )  # fmt: skip
    return tuple(_calmer(span, calm, law) for span, law in zip(layout.spans, laws, strict=True)), (remark,)


def _calmer(span: LawSpan, calm: CycleObjective, law: tuple[Piece, Solution]) -> tuple[Piece, Solution]:
    try:
        return solve(span, calm)
    except (InfeasibleProblem, SolverFailure):
        return law
