"""The problem file of the job "fastest": moves with their limits and machines, every number with its unit."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import msgspec

from optlaws.cycles.moves.fastest_move import FastestMove
from optlaws.cycles.moves.front_over_time import time_front
from optlaws.cycles.moves.time_front import TimeFront
from optlaws.cycles.moves.timed_moves import fastest, fastest_moves
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure, located
from optlaws.files.problem_file import Text
from optlaws.jobs.axes.drive_entries import drive_of
from optlaws.jobs.job import JobFile
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.studies.problem_entries import ProblemEntries, problem
from optlaws.synthesis.least_time.follower_residual import RESIDUAL
from optlaws.synthesis.least_time.move_objective import AT_MOTOR
from optlaws.synthesis.problem.problem import Problem

Strokes = Annotated[list[str], msgspec.Meta(min_length=2, max_length=1000)]


class FrontOverTimeEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Fronts over the time: what is least, how long the longest time is, and how many points there are."""

    minimise: Annotated[list[str], msgspec.Meta(min_length=1, max_length=6)]
    longest: str | None = None
    points: Annotated[int, msgspec.Meta(ge=2, le=200)] = 17


class VibratingEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Elastic load of a move: its natural frequency, or the least and the greatest, and its damping ratio."""

    frequency: str | list[str]
    damping: float = 0.0


class MoveEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A move, or moves of several strokes, within the limits of a machine."""

    name: Text
    stroke: str | Strokes
    limits: dict[str, str | list[str]] = {}
    start_velocity: str | None = None
    end_velocity: str | None = None
    mechanism: dict[str, Any] | None = None
    drive: dict[str, Any] | None = None
    start: str | None = None
    follower: VibratingEntries | None = None
    front: FrontOverTimeEntries | None = None


class FastestProblemFile(JobFile, kw_only=True, forbid_unknown_fields=True):
    """The problem file of least times."""

    move: Annotated[list[MoveEntries], msgspec.Meta(min_length=1, max_length=8)]
    problem: ProblemEntries | None = None


@dataclass(frozen=True)
class SoughtMove:
    """A move of a file with its least times, one for each stroke, and the fronts over its time."""

    name: str
    moves: tuple[FastestMove, ...]
    fronts: tuple[TimeFront, ...]


def sought(spec: FastestProblemFile, file: Path) -> list[SoughtMove]:
    """The least times and the fronts of the moves of a file.

    Raises
    ------
    InputError, InfeasibleProblem, SolverFailure
        If an entry is wrong, or a move has no law; the error names the move.
    """
    space = problem("problem", {"order": 3}, {} if spec.problem is None else spec.problem.given())
    moves = []
    for move in spec.move:
        try:
            with located(f"move {move.name}"):
                moves.append(_sought(move, space, file.parent))
        except (InfeasibleProblem, SolverFailure) as error:
            raise InputError(f"move {move.name}: {error.args[0]}") from error
    return moves


def _sought(move: MoveEntries, space: Problem, folder: Path) -> SoughtMove:
    """The least times and the fronts of one move."""
    given = arguments_of(move, folder)
    if not isinstance(move.stroke, str):
        if move.front is not None:
            raise InputError("front: it is that of one stroke: give the strokes to a move of another name")
        return SoughtMove(move.name, fastest_moves(space, strokes=move.stroke, **given), ())
    minimise = [] if move.front is None else move.front.minimise
    if len(set(minimise)) < len(minimise):
        raise InputError(f"front: minimise names one of them twice: {', '.join(minimise)}")
    if move.follower is not None and "follower" not in given and RESIDUAL not in minimise:
        raise InputError(f'follower: give a limit or a front of the "{RESIDUAL}", or leave the follower out')
    quickest, fronts = fastest(space, stroke=move.stroke, **given), []
    for name in minimise:
        assert move.front is not None  # noqa: S101 - as it names what is least
        with located("front"):
            fronts.append(front_of(quickest, move, name, given, (move.front.longest, move.front.points)))
    return SoughtMove(move.name, (quickest,), tuple(fronts))


def arguments_of(move: MoveEntries, folder: Path) -> dict[str, Any]:
    """The arguments of `fastest` besides a move's laws and its stroke.

    Examples
    --------
    >>> arguments_of(MoveEntries(name="slide", stroke="100 mm", limits={"jerk": "300 m/s^3"}), Path())["limits"]
    {'jerk': '300 m/s^3'}
    """
    given: dict[str, Any] = {"limits": move.limits}
    given |= {"start_velocity": move.start_velocity, "end_velocity": move.end_velocity}
    motor = _motor(move, folder)
    if motor is not None:
        given |= {"drive": motor, "start": move.start or 0.0}
    if move.follower is not None and RESIDUAL in move.limits:
        given["follower"] = msgspec.structs.asdict(move.follower)
    return given


def front_of(
    quickest: FastestMove, move: MoveEntries, minimise: str, given: dict[str, Any], extent: tuple[str | None, int]
) -> TimeFront:
    """The front of a move over its time, up to the longest time; `given` holds its `arguments_of`."""
    machine: dict[str, Any] = {}
    if minimise in AT_MOTOR and "drive" in given:
        machine = {"drive": given["drive"], "start": given["start"]}
    elif minimise == RESIDUAL:
        machine = {"follower": None if move.follower is None else msgspec.structs.asdict(move.follower)}
    longest, points = extent
    return time_front(quickest, minimise, longest=longest, points=points, **machine)


def _motor(move: MoveEntries, folder: Path) -> Drive | None:
    """The motor of a move and the mechanism that it drives."""
    driven = drive_of(move.mechanism, move.drive, folder)
    if driven is None and move.start is not None:
        raise InputError("start: it is the position of a mechanism: give the move its mechanism and drive")
    if driven is not None and not isinstance(driven, Drive):
        raise InputError(
            "drive: a move within torques has a motor and a mechanism, such as drive = { motor = { inertia = "
            "'3e-4 kg m^2', peak_torque = '6 N m' }, ratio = 20 }"
        )
    return driven
