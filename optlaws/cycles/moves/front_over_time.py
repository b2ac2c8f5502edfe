"""The entry to fronts over the time of a move: the least value of a quantity in machine units, for each time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from optlaws.cycles.moves.fastest_move import FastestMove
from optlaws.cycles.moves.time_front import MOST_POINTS, TimeFront
from optlaws.cycles.moves.torque_limits import motor_torque
from optlaws.cycles.moves.vibration_limits import read_follower
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, documented_by, entry
from optlaws.entries.value_types import Listed, Measured, Text, Whole
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.quantities import positive_quantity
from optlaws.motion.quantity_kinds import Kind
from optlaws.numbers import NumberOrQuantity, Quantity
from optlaws.suggest import unknown_key
from optlaws.synthesis.least_time.follower_residual import RESIDUAL, FollowerResidual
from optlaws.synthesis.least_time.move_objective import AT_MOTOR, OBJECTIVES, MoveObjective
from optlaws.synthesis.least_time.timed_move import TimedMove
from optlaws.synthesis.problem.constants import meant
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.tolerances import LEAST_TIME_GAP

_LONGEST = 2.0
_POINTS = Whole(2, MOST_POINTS)


@declared
class FrontOverTime(Declared, title="a front"):
    """Fronts over the time: what is least, how long the longest time is, and how many points there are."""

    minimise: tuple[str, ...] = entry(
        Listed(Text(), least=1, most=6), "What is least, each with a front.", example=["rms acceleration"]
    )
    longest: Quantity | None = entry(
        Measured("time", above=0.0), "The longest time; twice the least unless given.", default=None, example="0.3 s"
    )
    points: int = entry(_POINTS, "How many there are, each the same share longer than the last.", default=17)

    def _check(self) -> None:
        if len(set(self.minimise)) < len(self.minimise):
            raise InputError(f"minimise names one of them twice: {', '.join(self.minimise)}")


@documented_by(FrontOverTime)
def time_front(
    move: FastestMove,
    minimise: str,
    *,
    longest: Quantity | None = None,
    points: int = 17,
    drive: Drive | None = None,
    start: NumberOrQuantity = 0.0,
    follower: Mapping[str, Any] | None = None,
) -> TimeFront:
    """The least objective of a move over its time within limits, with a law and a proof at each point.

    Parameters
    ----------
    move
        The least time of the move with its limits, from which the front goes on.
    minimise
        "velocity", "acceleration", "jerk", "snap" or the "rms acceleration", "rms jerk", "rms snap"; with a drive the
        "torque", "rms torque" or "energy" at its motor; with a follower the "residual acceleration".
    drive, start
        The motor, and the position of its mechanism where the move begins, as `fastest` takes them. Unless given they
        are those of the move, whose laws then never turn back; an energy needs them.
    follower
        What vibrates, as `fastest` takes it; that of the move unless given.

    Returns
    -------
    TimeFront
        Its points, which are `optimal` where the objective is convex in the law. The energy, cranks and loads over the
        position are not: their points are `local`, with a bound.

    Raises
    ------
    InputError
        If the name is unknown, what it needs is missing, or the longest time is not above the least.
    SolverFailure
        If the search fails in a time; the error names it.

    Examples
    --------
    >>> import optlaws
    >>> motor = optlaws.Motor("3e-4 kg m^2", peak_torque="4 N m", greatest_speed="900 rpm")
    >>> table = optlaws.Drive(optlaws.Mechanism("0.8 kg m^2", "20 N m"), motor, ratio=20)
    >>> turn = optlaws.fastest(optlaws.Problem(order=3), stroke="45 deg", limits={}, drive=table)
    >>> time_front(turn, "rms torque", points=3)
    TimeFront(rms torque, 3 points from 0.23167 s with 2.73454 N m to 0.46334 s with 1.16182 N m, status='optimal')
    """
    if not isinstance(move, FastestMove):
        raise InputError(f"a front over the time is that of a FastestMove, got {type(move).__name__}")
    objective = _objective(minimise, move, drive, start, follower)
    least = move.duration * (1.0 + LEAST_TIME_GAP)
    last = _LONGEST * move.duration if longest is None else positive_quantity(longest, "time", "longest")
    if not last > least * (1.0 + LEAST_TIME_GAP):
        raise InputError(f"longest must be above the least time, {move.duration:.9g} s, got {shortened(longest)}")
    durations = tuple(np.geomspace(least, last, _POINTS.read(points, "points")).tolist())
    return TimeFront(move, objective, durations, tuple(_least_in(move, objective, time) for time in durations))


def _least_in(move: FastestMove, objective: MoveObjective, duration: float) -> Solution:
    """The law of the least objective in a time."""
    try:
        with meant():
            return synthesize(objective.problem(move.least.move, duration))
    except (InfeasibleProblem, SolverFailure) as error:
        raise SolverFailure(
            f"no law of the least {objective.name} was found in {duration:.9g} s: {error.args[0]}",
            problem=move.least.move.problem,
        ) from None


def _objective(
    name: str, move: FastestMove, drive: Drive | None, start: NumberOrQuantity, follower: Mapping[str, Any] | None
) -> MoveObjective:
    """The objective of a move; drive and follower default to the move's own."""
    if name not in OBJECTIVES:
        raise InputError(f"minimise: {unknown_key(name, OBJECTIVES, 'objective of a move')}")
    if drive is not None and name not in AT_MOTOR:
        raise InputError(f"drive: the {name} is of no motor: leave it out")
    if follower is not None and name != RESIDUAL:
        raise InputError(f"follower: the {name} is of no follower: leave it out")
    timed = move.least.move
    if name in AT_MOTOR:
        return _at_motor(name, timed, drive, start)
    return MoveObjective(name, residual=_left(timed, follower) if name == RESIDUAL else None)


def _at_motor(name: str, move: TimedMove, drive: Drive | None, start: NumberOrQuantity) -> MoveObjective:
    """The torque or the energy at the motor of a move."""
    torque = move.torque if drive is None else motor_torque(drive, start, move.stroke, {Kind.RMS_FORCE: (-1.0, 1.0)})
    if torque is None or (drive is None and name == "energy"):
        raise InputError(f"minimise: the {name} is that of a motor: give its drive")
    if name == "torque" and torque.gear is not None:
        raise InputError(
            "minimise: the least peak torque behind a gear that loses power is not known: minimise the rms torque or "
            "the energy, or leave out the efficiency"
        )
    if not (move.at_rest and move.problem.monotone):
        raise InputError(
            f"minimise: the {name} at a motor is that of laws from rest to rest which never turn back: limit the "
            'velocity from 0, as in {"velocity": ("0 rad/s", "1 rad/s")}, or give fastest the drive'
        )
    free = replace(torque, peak=None, rms=1.0)
    if move.torque is not None and free != replace(move.torque, peak=None, rms=1.0):
        raise InputError("drive: it is another than that of the move, or begins at another position")
    if drive is None or name != "energy":
        return MoveObjective(name, torque=free)
    return MoveObjective(name, free, drive.ratio * move.stroke, drive.regeneration)


def _left(move: TimedMove, follower: Mapping[str, Any] | None) -> FollowerResidual:
    """The follower of which what is left is least, with the limit 1."""
    if not move.at_rest:
        raise InputError("minimise: what is left vibrating is that of a move from rest to rest")
    known = None if move.residual is None else replace(move.residual, most=1.0)
    if follower is not None:
        given = read_follower(follower)
        if known is not None and given != known:
            raise InputError("follower: it is another than that of the move")
        return given
    if known is None:
        raise InputError(f"minimise: the {RESIDUAL} is that of a follower: give the follower")
    return known
