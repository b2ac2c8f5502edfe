"""Fronts over the time of a move: the least of a quantity in each time, with a law and a proof at every point."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf
from typing import Any, NamedTuple

import numpy as np

from optlaws.cycles.moves.fastest_move import AXES, FastestMove
from optlaws.cycles.moves.timed_moves import fastest, motor_torque, read_follower
from optlaws.cycles.optimisation.objectives import check_rating
from optlaws.cycles.specification.limits import MOTOR
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.specification.segments import Move
from optlaws.echo import shortened, unknown_key
from optlaws.entries.declared import Declared, declared, documented_by, entry
from optlaws.entries.value_types import Listed, Measured, Text, Whole
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.files.reading import JsonText, entries_of
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import Exact, Kind, quantity
from optlaws.numbers import NumberOrQuantity, Quantity, bounded, listed, positive, real
from optlaws.sentences import quantity_name
from optlaws.spelling import either_spelling
from optlaws.synthesis.least_time.move_limits import RESIDUAL, RESIDUALS, TimedLimit, power
from optlaws.synthesis.least_time.timed_move import AT_MOTOR, OBJECTIVES, MoveObjective, TimedMove
from optlaws.synthesis.problem.constants import meant
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.spaces.bases import Chebyshev
from optlaws.synthesis.status import Status, measure
from optlaws.tolerances import LEAST_TIME_GAP, STORED_VALUE

_KEYS = ("fastest", "minimise", "points")
_POINT_KEYS = ("duration", "value", "lower_bound", "solution")
_MOST = 1000
_LONGEST = 2.0
_POINTS = Whole(2, _MOST)


class TimePoint(NamedTuple):
    """A law of a front over the time.

    Attributes
    ----------
    duration
        The time of the move, s.
    law
        A law that keeps the limits in it.
    value
        What is minimised, of this law, in SI units.
    lower_bound
        No law of the space that keeps the limits in this time takes less.
    gap
        (value - lower bound) / value; as a share of the objective's scale where the value is 0 but for rounding.
    """

    duration: float
    law: MotionLaw
    value: float
    lower_bound: float
    gap: float


@dataclass(frozen=True, repr=False)
class TimeFront(JsonText):
    """Least objectives of a move over its time within limits, from its least time on, with laws and proofs.

    Where a longer time never needs more, calling it with a time between the points gives a law and a bound there too.

    Attributes
    ----------
    fastest
        The least time, below which the proofs leave no law.
    objective
        What is least.
    durations
        The times of the points, s, ascending.
    solutions
        The laws of the points with their proofs.

    Raises
    ------
    InputError
        If a point is of another problem, or times do not ascend.

    Examples
    --------
    >>> import optlaws
    >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
    >>> front = optlaws.time_front(move, "rms acceleration", points=5)
    >>> [(round(point.duration, 4), round(point.value, 3)) for point in front][::2]
    [(0.2253, 8.918), (0.3187, 3.671), (0.4507, 1.756)]
    >>> between = front(0.3)
    >>> between.lower_bound <= between.value, round(between.value, 2), round(between.gap, 2)
    (True, 4.39, 0.06)
    """

    fastest: FastestMove
    objective: MoveObjective
    durations: tuple[float, ...]
    solutions: tuple[Solution, ...]

    _json_name = "a front over the time"

    def __post_init__(self) -> None:
        if not self.solutions or len(self.durations) != len(self.solutions):
            raise InputError(f"{self._json_name} has points, each with a time and a solution")
        if self.durations[0] < self.fastest.duration or not all(
            first < second for first, second in pairwise(self.durations)
        ):
            raise InputError(f"{self._json_name} has ascending times, none below the least time")
        for duration, solution in zip(self.durations, self.solutions, strict=True):
            if solution.problem != self.objective.problem(self.fastest.least.move, duration):
                raise InputError(f"{self._json_name}: the law at {duration!r} s is not of the move in this time")

    @property
    def minimise(self) -> str:
        """The name of the objective."""
        return self.objective.name

    @property
    def unit(self) -> str:
        """The unit of the objective."""
        nu = 2 if self.minimise == RESIDUAL else self.objective.nu  # that of a displacement is 0
        return AT_MOTOR.get(self.minimise) or unit_of(AXES[self.fastest.unit], nu)

    @property
    def values(self) -> tuple[float, ...]:
        """The least objective at each point, recomputed from its law, in SI units."""
        return tuple(point.value for point in self)

    @property
    def lower_bounds(self) -> tuple[float, ...]:
        """Lower bounds of the objective for all laws of the space, at each point, in SI units."""
        return tuple(point.lower_bound for point in self)

    @property
    def gap(self) -> float:
        """The greatest gap of a point."""
        return max(point.gap for point in self)

    @property
    def status(self) -> Status:
        """`optimal` where every point is proven."""
        optimal = all(solution.status is Status.OPTIMAL for solution in self.solutions)
        return Status.OPTIMAL if optimal else Status.LOCAL

    @property
    def falls(self) -> bool:
        """Whether a longer time provably never needs more, so that the front is known between its points too."""
        return self.objective.falls(self.fastest.least.move)

    def __call__(self, duration: Quantity | float) -> TimePoint:
        """A law in a time, in s or such as "0.3 s", and a bound of what any law takes; between points by convexity.

        The law is that of the point before, played more slowly: it keeps every limit. The bound is that of the point
        after: what a law takes in less time, it takes at most in more.

        Raises
        ------
        InputError
            If the time is beyond the ends, or between points where nothing is known.
        """
        time = real(duration)
        time = quantity(duration, "time", "duration", above=0.0) if time is None else time
        first, last = self.durations[0], self.durations[-1]
        if not first <= time <= last:
            raise InputError(f"the front goes from {first:.9g} s to {last:.9g} s, got {shortened(duration)}")
        i = bisect_right(self.durations, time) - 1
        before = self[i]
        if before.duration == time:
            return before
        if not self.falls:
            raise InputError(
                f"the {quantity_name(self.minimise)} may rise with the time, so there is no bound between the points "
                f"of the front; the nearest are at {before.duration:.9g} s and {self.durations[i + 1]:.9g} s"
            )
        after, nu = self[i + 1], self.objective.nu
        slower = power(after.duration / time, nu) if nu else 1.0
        return self._point(time, before.law, after.lower_bound * slower)

    @kept_property
    def points(self) -> tuple[TimePoint, ...]:
        """The points, their values recomputed from the laws."""
        return tuple(
            self._point(time, each.law, each.lower_bound / self._unit(time).bound)
            for time, each in zip(self.durations, self.solutions, strict=True)
        )

    def _unit(self, duration: float) -> TimedLimit:
        return self.objective.in_time(duration, self.fastest.stroke)

    def _point(self, duration: float, law: MotionLaw, bound: float) -> TimePoint:
        least = self._unit(duration)
        value = least.share(law)
        gap = (value - bound) / measure(value, least.constant.scale / least.bound)
        return TimePoint(duration, law, value, bound, gap)

    def __getitem__(self, place: int) -> TimePoint:
        return self.points[place]

    def __len__(self) -> int:
        return len(self.durations)

    def __iter__(self) -> Iterator[TimePoint]:
        return iter(self.points)

    @property
    def headings(self) -> tuple[str, ...]:
        """Headings of the columns of `rows`."""
        return ("time, s", f"{quantity_name(self.minimise)}, {self.unit}", f"lower bound, {self.unit}", "gap", "status")

    @property
    def rows(self) -> list[list[float | str]]:
        """Values of the columns that `headings` name, with a row for each point."""
        return [
            [point.duration, point.value, point.lower_bound, point.gap, solution.status.value]
            for point, solution in zip(self, self.solutions, strict=True)
        ]

    def to_csv(self) -> str:
        """The rows and their headings as CSV."""
        from optlaws.files.tables import to_csv

        return to_csv(
            self.headings, self.rows, about=f"least {quantity_name(self.minimise)} over the time of a move", digits=12
        )

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the front with its proven lower bound into matplotlib's axes, new ones by default; returns the artists.

        Examples
        --------
        >>> import optlaws
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> [artist.get_label() for artist in optlaws.time_front(move, "velocity", points=2).plot()]
        ['velocity', 'lower bound', 'least time']
        """
        from optlaws.plots.front import draw_time_front

        return draw_time_front(self, ax, **style)

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict in SI units: laws and proofs in one, which `optlaws verify` checks."""
        rows = [(point.duration, point.value, bounded(point.lower_bound)) for point in self]
        solutions = [solution.to_dict() for solution in self.solutions]
        points = [dict(zip(_POINT_KEYS, (*row, each), strict=True)) for row, each in zip(rows, solutions, strict=True)]
        return {"minimise": self.objective.to_dict(), "fastest": self.fastest.to_dict(), "points": points}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> TimeFront:
        """Read the output of `to_dict`; laws and proofs are checked against the move, numbers against the laws.

        Raises
        ------
        InputError
            If an entry is missing or wrong, or states what does not follow from laws and proofs.
        """
        entries = entries_of(data, _KEYS, cls._json_name, alone=True)
        rows = [
            entries_of(row, _POINT_KEYS, f"points[{i}]", alone=True)
            for i, row in enumerate(listed(entries["points"], "points", _MOST))
        ]
        with meant():
            solutions = tuple(Solution.from_dict(row["solution"]) for row in rows)
        front = cls(
            FastestMove.from_dict(entries["fastest"]),
            MoveObjective.from_dict(entries["minimise"]),
            tuple(positive(row["duration"], "duration") for row in rows),
            solutions,
        )
        for i, (row, point) in enumerate(zip(rows, front, strict=True)):
            least = front._unit(point.duration)
            size = max(abs(point.value), least.constant.scale / least.bound)
            for name, known in (("value", point.value), ("lower_bound", point.lower_bound)):
                stated = -inf if row[name] is None and name == "lower_bound" else real(row[name])
                if stated is None or (stated != known and abs(stated - known) > STORED_VALUE * size):
                    raise InputError(f"points[{i}]: {name} is {shortened(row[name])}, but its law gives {known!r}")
        return front

    def _repr_html_(self) -> str:
        from optlaws.shown.showing import drawing, page, table

        curve = drawing(f"{quantity_name(self.minimise)}, {self.unit}", self.durations, self.values)
        cells = [[f"{cell:.7g}" if isinstance(cell, float) else cell for cell in row] for row in self.rows]
        return page("TimeFront", table(self.headings, cells), curve)

    def __repr__(self) -> str:
        first, last = self[0], self[-1]
        return (
            f"TimeFront({self.minimise}, {len(self)} points from {first.duration:.6g} s with {first.value:.6g} "
            f"{self.unit} to {last.duration:.6g} s with {last.value:.6g} {self.unit}, status={self.status.value!r})"
        )


@declared
class FrontOverTime(Declared, title="a front"):
    """Fronts over the time: what is least, how long the longest time is, and how many points there are."""

    minimise: tuple[str, ...] = entry(
        Listed(Text(), least=1, most=6),
        "The quantities that are minimised, each with a front.",
        example=["rms acceleration"],
    )
    longest: NumberOrQuantity | None = entry(
        Measured("time", above=0.0),
        "The longest time; unless given twice the least, or in a file the first time without residual vibration.",
        default=None,
        example="0.3 s",
    )
    points: int = entry(_POINTS, "How many points; the times are a geometric sequence.", default=17)

    def _check(self) -> None:
        if len(set(self.minimise)) < len(self.minimise):
            raise InputError(f"minimise names one of them twice: {', '.join(self.minimise)}")


@either_spelling
@documented_by(FrontOverTime)
def time_front(
    move: FastestMove,
    minimise: str,
    *,
    longest: NumberOrQuantity | None = None,
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
        "torque", "rms torque" or "energy" at its motor; with a follower the "residual acceleration"
        or "residual displacement".
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
    last = _LONGEST * move.duration if longest is None else quantity(longest, "time", "longest", above=0.0)
    if not last > least * (1.0 + LEAST_TIME_GAP):
        raise InputError(f"longest must be above the least time, {move.duration:.9g} s, got {shortened(longest)}")
    durations = tuple(np.geomspace(least, last, _POINTS.read(points, "points")).tolist())
    solutions = list[Solution]()
    for time in durations:
        try:
            with meant():
                solutions.append(synthesize(objective.problem(move.least.move, time)))
        except (InfeasibleProblem, SolverFailure) as error:
            raise SolverFailure(
                f"no law of the least {objective.name} was found in {time:.9g} s: {error.args[0]}",
                problem=move.least.move.problem,
            ) from None
    return TimeFront(move, objective, durations, tuple(solutions))


def front_of_cycle(cycle: Any, minimise: str, *, follower: Any, **options: Any) -> TimeFront:
    """The front over the time of a cycle of one move, within the limits of the move."""
    given, axis = cycle.segments[0], cycle.axis
    if len(cycle.segments) > 1 or not isinstance(given, Move) or not is_optimal(given):
        raise InputError("a front over the time is that of a cycle of one move whose law is optimal")
    check_rating(cycle.limits, cycle.in_si.drive)
    if twice := cycle.limits.keys() & given.limits.keys():
        raise InputError(f"limits: {min(twice)} is that of the cycle and of its move: give it once")
    limits = {name: most for name, most in {**cycle.limits, **given.limits}.items() if name != MOTOR}
    if cycle.limits.get(MOTOR) and cycle.in_si.mean_force is not None:
        limits["rms torque"] = Exact(cycle.in_si.mean_force, "N m")
    moved: dict[str, Any] = (
        {"drive": cycle.drive, "start": cycle.start or 0.0} if isinstance(cycle.drive, Drive) else {}
    )
    least = fastest(
        Problem(order=cycle.order, basis=Chebyshev(cycle.degree)),
        stroke=Exact(cycle.programme.stretches[0].displacement, unit_of(axis)),
        limits=limits,
        start_velocity=given.start_velocity,
        end_velocity=given.end_velocity,
        follower=follower if any(name in limits for name in RESIDUALS) else None,
        **moved,
    )
    at_motor = moved if minimise in AT_MOTOR else {}
    return time_front(least, minimise, follower=follower if minimise in RESIDUALS else None, **at_motor, **options)


def _objective(
    name: str, move: FastestMove, drive: Drive | None, start: NumberOrQuantity, follower: Mapping[str, Any] | None
) -> MoveObjective:
    if name not in OBJECTIVES:
        raise InputError(f"minimise: {unknown_key(name, OBJECTIVES, 'objective of a move')}")
    if drive is not None and name not in AT_MOTOR:
        raise InputError(f"drive: the {name} is of no motor: leave it out")
    if follower is not None and name not in RESIDUALS:
        raise InputError(f"follower: the {name} is of no follower: leave it out")
    timed = move.least.move
    if name in AT_MOTOR:
        return _at_motor(name, timed, drive, start)
    if name not in RESIDUALS:
        return MoveObjective(name)
    if not timed.at_rest:
        raise InputError("minimise: what is left vibrating is that of a move from rest to rest")
    residual = timed.residual if follower is None else read_follower(follower)
    if residual is None:
        raise InputError(f"minimise: the {name} is that of a follower: give the follower")
    known, given = (
        each and replace(each, most=1.0, of=name.removeprefix("residual ")) for each in (timed.residual, residual)
    )
    if known not in {None, given}:
        raise InputError("follower: it is another than that of the move")
    return MoveObjective(name, residual=given)


def _at_motor(name: str, move: TimedMove, drive: Drive | None, start: NumberOrQuantity) -> MoveObjective:
    torque = move.torque if drive is None else motor_torque(drive, start, move.stroke, {Kind.RMS_FORCE: (-1.0, 1.0)})
    if torque is None or (drive is None and name == "energy"):
        raise InputError(f"minimise: the {quantity_name(name)} is that of a motor: give its drive")
    if name == "torque" and torque.gear is not None:
        raise InputError(
            "minimise: the least peak torque behind a gear that loses power is not known: minimise the RMS torque or "
            "the energy, or leave out the efficiency"
        )
    if not (move.at_rest and move.problem.monotone):
        raise InputError(
            f"minimise: the {quantity_name(name)} at a motor is that of laws from rest to rest which never turn back: "
            'limit the velocity from 0, as in {"velocity": ("0 rad/s", "1 rad/s")}, or give fastest the drive'
        )
    free = replace(torque, peak=None, rms=1.0)
    if move.torque is not None and free != replace(move.torque, peak=None, rms=1.0):
        raise InputError("drive: it is another than that of the move, or begins at another position")
    if drive is None or name != "energy":
        return MoveObjective(name, torque=free)
    return MoveObjective(name, free, drive.ratio * move.stroke, drive.regeneration)
