"""The laws of run-ins and run-outs: from rest to the motion of a cycle in a given time, or in the least."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from optlaws.cycles.moves.fastest_move import AXES, FastestMove
from optlaws.cycles.moves.transition_cam import TransitionCam, TransitionKind
from optlaws.cycles.optimisation.motion_limits import Side, along_motion, greatest, of_segments
from optlaws.cycles.optimisation.objectives import CycleObjective, kind_of, limits_of_stretch
from optlaws.cycles.optimisation.optimal import scale, solved, span_problem
from optlaws.cycles.specification.joints import LawSpan, State
from optlaws.cycles.specification.programme import Programme, TimedSegment, time_of
from optlaws.cycles.specification.segments import Move, Transition
from optlaws.errors import InputError
from optlaws.motion.piece import Piece, factor, values_of_pieces
from optlaws.motion.quantities import quantity
from optlaws.motion.quantity_kinds import Kind
from optlaws.synthesis.least_time.move_limits import MoveLimits
from optlaws.synthesis.least_time.time_search import least_time
from optlaws.synthesis.least_time.timed_move import TimedMove
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.spaces.bases import Chebyshev
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.tolerances import CLOSURE, INSIDE_PIECE

_REST = State(0.0, 0.0)
_DEGREE = 15  # of Z at least, as of the motions of cycles whose ends move
_NAMES = {Kind.VELOCITY: "velocity", Kind.JERK: "jerk", Kind.SNAP: "snap"}


@dataclass(frozen=True)
class Meeting:
    """The joint of a cam and its cycle: kind of cam, time and angle in the cycle, and the cycle's motion there."""

    kind: TransitionKind
    at: float
    degrees: float
    state: tuple[float, float, float, float]

    @property
    def from_rest(self) -> tuple[float, float, float, float]:
        """The motion at the end of a law that begins at rest; the law of a run-out is reversed in time."""
        position, velocity, acceleration, jerk = self.state
        return self.state if self.kind == "run-in" else (position, -velocity, acceleration, -jerk)


def transition_cam(
    kind: TransitionKind,
    programme: Programme,
    pieces: Sequence[Piece],
    objective: CycleObjective,
    given: Transition,
) -> TransitionCam:
    """The cam from rest into a cycle, or out of it to rest, in a given time or the least within its limits."""
    meeting = _meeting(kind, programme, pieces, given.at)
    still = programme.start if given.rest is None else quantity(given.rest, programme.axis, "rest")
    way = max(abs(stretch.displacement) for stretch in programme.stretches)
    if abs(meeting.state[0] - still) <= CLOSURE * way:
        still = meeting.state[0]
    of_motion = replace(
        objective,
        minimise=objective.minimise if kind_of(objective.minimise)[0].order else "acceleration",
        order=given.order or objective.order,
        limits=of_segments(objective.limits),
        load=None,
        loaded={},
    )
    if given.over is not None:
        return _in_time(meeting, programme, of_motion, still, time_of(given.over, programme.period, "over"))
    return _soonest(meeting, programme, of_motion, still)


def _meeting(kind: TransitionKind, programme: Programme, pieces: Sequence[Piece], at: Any) -> Meeting:
    """The state of the cycle at a time or angle: after a joint for a run-in, before it for a run-out."""
    time, period = time_of(at, programme.period, "at"), programme.period
    if not 0.0 <= time <= period:
        raise InputError(f"at must be within the cycle, from 0 to 360 deg, got {at!r}")
    # what jumps at a joint has the value of the side that the cam joins
    inside, side = (time % period, 1.0) if kind == "run-in" else (time or period, -1.0)
    near = inside + side * INSIDE_PIECE * period
    places = (inside, inside, near, near)
    position, *rates = (float(values_of_pieces(pieces, np.array([at]), nu)[0]) for nu, at in enumerate(places))
    advance = sum(stretch.displacement for stretch in programme.stretches)
    position += advance * round((time - inside) / period)
    sizes = [
        max(piece.law.peak(nu).value * abs(factor(piece.stroke, piece.duration, nu)) for piece in pieces)
        for nu in (1, 2, 3)
    ]
    velocity, acceleration, jerk = (
        0.0 if abs(rate) <= CLOSURE * size else rate for rate, size in zip(rates, sizes, strict=True)
    )
    return Meeting(kind, time, 360.0 * time / period, (position, velocity, acceleration, jerk))


def _in_time(
    meeting: Meeting, programme: Programme, objective: CycleObjective, rest: float, duration: float
) -> TransitionCam:
    """The best law in a given time."""
    position, *rates = meeting.from_rest
    if position == rest and rates[0] == 0.0:
        raise InputError(
            f"the cycle is in the place of rest at {_shown(meeting)}, and rests: it needs no {meeting.kind}"
        )
    stretch = _stretch(meeting, position - rest, duration)
    span = LawSpan((stretch,), (0.0,), duration, rest, position - rest, _REST, State(*rates[:2]), ())
    stroke = scale(span)
    ends = tuple(rate / factor(stroke, duration, nu) for nu, rate in enumerate(rates, start=1))
    count = objective.order - 1
    still = (0.0,) * count
    problem = replace(
        span_problem(span, objective, programme.axis, stroke),
        basis=Chebyshev(max(objective.degree, _DEGREE)),
        symmetric=False,
        boundary=BoundaryConditions(
            (0.0, *still), (span.displacement / stroke, *(ends + still)[: objective.order - 1])
        ),
    )
    solution = solved(problem, span)
    return _cam(meeting, programme, rest, duration, solution)


def _soonest(meeting: Meeting, programme: Programme, objective: CycleObjective, rest: float) -> TransitionCam:
    """The law that takes the least time within the limits, with its proof."""
    position, *rates = meeting.from_rest
    moved = position - rest
    if moved == 0.0:
        raise InputError(
            f"the place of rest is that of the cycle at {_shown(meeting)}: its least time is not sought; "
            "give `over`, or another place"
        )
    limits = limits_of_stretch(_stretch(meeting, moved, programme.period), objective, programme.axis)
    sign = 1.0 if moved > 0.0 else -1.0
    known = _move_limits(limits, sign)
    velocity, acceleration, jerk = (sign * rate for rate in rates)
    problem = Problem(
        order=objective.order,
        basis=Chebyshev(max(objective.degree, _DEGREE)),
        symmetric=False,
        monotone=along_motion(limits),
    )
    move = TimedMove(
        problem,
        abs(moved),
        known,
        end_velocity=velocity,
        end_acceleration=acceleration if objective.order > 2 else 0.0,
        end_jerk=jerk if objective.order > 3 else 0.0,
    )
    least = least_time(move)
    unit = next(unit for unit, axis in AXES.items() if axis == programme.axis)
    return _cam(meeting, programme, rest, least.duration, least.solution, FastestMove(least, unit))


def _cam(
    meeting: Meeting,
    programme: Programme,
    rest: float,
    duration: float,
    solution: Any,
    least: FastestMove | None = None,
) -> TransitionCam:
    return TransitionCam(
        meeting.kind, programme.axis, programme.period, meeting.at, rest, meeting.state, duration, solution, least
    )


def _stretch(meeting: Meeting, moved: float, duration: float) -> TimedSegment:
    """The cam as a segment, under the name that errors give it; a run-out moves the other way than its law."""
    return TimedSegment(1, Move(name=meeting.kind), duration, duration, moved if meeting.kind == "run-in" else -moved)


def _shown(meeting: Meeting) -> str:
    return f"{meeting.degrees:.6g} deg"


def _move_limits(limits: Mapping[Side, float], sign: float) -> MoveLimits:
    """The limits of a move whose stroke has a sign."""
    for key, most in limits.items():
        if not key.kind.order:
            raise InputError("the least time is sought within limits of the motion, not of a drive: give `over`")
        one_sided = key.sign and key.kind not in {Kind.ACCELERATION, Kind.VELOCITY_ALONG}
        if one_sided and greatest(limits, key.kind, -key.sign) != most:
            raise InputError(f"limits: the {_NAMES[key.kind]} has two sides: the least time takes one limit of both")
    if not limits:
        raise InputError("nothing limits the least time: give the cycle limits, or say the time or angle as `over`")
    both = {name: greatest(limits, kind, 1.0) for kind, name in _NAMES.items()}
    names = (("acceleration", sign), ("deceleration", -sign))
    sides = {name: greatest(limits, Kind.ACCELERATION, side) for name, side in names}
    return MoveLimits(**{name: most for name, most in (both | sides).items() if most < inf})
