"""The least time of a single move in machine units, as `fastest` returns it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, isfinite
from typing import Any

import numpy as np

from optlaws.cycles.greatest_speed.timed_spans import least_time_of
from optlaws.cycles.specification.limits import DECELERATION, LimitTaken
from optlaws.cycles.specification.periods import best_possible_row
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText, entries_of
from optlaws.kept import former_name, kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import USUAL, catalogue
from optlaws.laws.law import LawExport
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.effort import DriveSheet, PieceEffort
from optlaws.motion.derivative_panel import DERIVATIVES, motion_panel, picture_unit
from optlaws.motion.motion import Exportable, Motion, motion_of_pieces
from optlaws.motion.piece import Piece, unit_of
from optlaws.motion.quantities import DEGREES, QUANTITIES, Exact, quantity
from optlaws.numbers import Array, Quantity, derivative, number_or_array, positive, real_times
from optlaws.numerics.roots import bisect
from optlaws.sentences import quantity_name
from optlaws.shown.curve_points import refined
from optlaws.shown.difference import Difference, Differences
from optlaws.shown.report import Panel, PanelLimit, Report, ReportSegment, ReportTable, Series
from optlaws.shown.summary import Row, Summary
from optlaws.synthesis.least_time.least_time import LeastTime
from optlaws.synthesis.least_time.motor_torque import CURVE_LIMIT
from optlaws.synthesis.least_time.move_limits import RESIDUALS
from optlaws.synthesis.least_time.time_search import least_time
from optlaws.synthesis.least_time.timed_move import TimedMove
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.spaces.bases import PolynomialBasis
from optlaws.synthesis.status import Status
from optlaws.tolerances import SAME_TIME

#: what the unit of a stroke measures
AXES = {"m": "length", "rad": "angle"}
_MORE = 0.1
_LONGEST, _TIMES = 10.0, 630  # times of a law that leaves a vibration: up to so many times the shortest, and how many
_STEPS = 241  # of a torque, to which those are added that its curve needs


class MovePlan(Exportable):
    """A plan of one law in its place, which does not repeat: call it for the motion in SI units since it began."""

    kind = "move"
    axis: str
    duration: float
    piece: Piece

    def __call__(self, time: Any, nu: int = 0) -> Any:
        """Position (nu 0), velocity, acceleration, jerk at a time in seconds since it began, in SI units.

        Raises
        ------
        InputError
            If the time is before it begins or after it ends.
        """
        times = real_times(time)
        if ((times < 0.0) | (times > self.duration)).any():
            raise InputError(f"a {self.kind} lasts from 0 to {self.duration:.9g} s, got {shortened(time)}")
        return number_or_array(self.piece.values(times, derivative(nu)))

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu, in SI units, recomputed from the law."""
        return max(abs(value) for value, _ in self.piece.extremes(derivative(nu), 0.0, self.duration))

    def motion(self, master: Quantity | None = None, unit: str | None = None) -> Motion:
        """The exact motion in machine units, as `Cycle.motion`, which does not repeat; its master begins at 0.

        The master is time in seconds unless it is given.
        """
        motion = motion_of_pieces((self.piece,), self.duration, self.axis, master=master, unit=unit)
        return replace(motion, repeats=False, proof=self._proof)

    @property
    def _proof(self) -> tuple[str, ...]:
        """What is proven of the motion, as text for files."""
        return ()


def panels_of(piece: Piece, axis: str, limits: Mapping[int, tuple[float, float]]) -> list[Panel]:
    """Position, velocity, acceleration and jerk of a law in its place, through their extremes; the snap if limited."""
    panels = []
    for nu in range(1 + max((len(QUANTITIES) - 1, *limits))):
        limited = [PanelLimit(piece.start, piece.stop, *limits[nu])] if nu in limits else ()
        extremes = piece.extremes(nu, piece.start, piece.stop)
        panels.append(motion_panel([piece], nu, picture_unit(axis, nu), extremes, limited))
    return panels


@dataclass(frozen=True, repr=False)
class FastestMove(LawExport, MovePlan, JsonText):  # type: ignore[misc] # its export places a law in a machine
    """The plan of the least time of a single move within limits: its law, and the proof that none is faster.

    Attributes
    ----------
    least
        The same in SI units, with the move and the proofs.
    unit
        That of the stroke, "m" or "rad".
    duration, stroke, law
        The least time in s, how far the move goes in m or rad, and the law that takes it.
    limit
        The time that no law of any degree is faster than, s; None where no closed form is known. Under limits of
        velocity, acceleration and jerk it is that of the seven segments, whose ends have the move's velocities. A limit
        of the snap adds a bound of its own from rest to rest: then laws need not come near, nor at order 2 with a limit
        of the jerk where an end moves.
    limit_breaks
        Breaks of `Pieces(breaks, degree=3, continuity=2)` that reach it; empty where none are known.
    price
        The share by which laws of the problem's space are slower than all laws; None where `best_possible` is.
    none_below, gap
        The time up to which it is proven that no law of the space keeps the limits, s, and its relative difference.
    status
        `optimal` where the least time is proven, `local` where a torque is not convex in the law.
    binding
        The limits that the law reaches and that keep it from being faster.

    Examples
    --------
    >>> import optlaws
    >>> move = optlaws.fastest(
    ...     optlaws.Problem(order=3), stroke="100 mm", limits={"acceleration": "8 m/s^2", "jerk": "300 m/s^3"}
    ... )
    >>> round(move.duration, 6), round(move.best_possible, 6), move.binding
    (0.255736, 0.251858, ('acceleration', 'jerk'))
    """

    least: LeastTime[TimedMove]
    unit: str = "m"

    _json_name = "a fastest move"

    duration = kept_property[float](lambda move: move.least.duration)
    stroke = kept_property[float](lambda move: move.least.move.stroke)
    law = kept_property[MotionLaw](lambda move: move.least.law)
    best_possible = kept_property[float | None](lambda move: move.least.best_possible)
    limit = former_name("limit", "best_possible")
    limit_breaks = kept_property[tuple[float, ...]](lambda move: move.least.move.limit_breaks)
    price = kept_property[float | None](lambda move: move.least.price)
    none_below = kept_property[float](lambda move: move.least.none_below)
    gap = kept_property[float](lambda move: move.least.gap)
    status = kept_property[Status](lambda move: move.least.status)
    binding = kept_property[tuple[str, ...]](lambda move: move.least.binding)
    axis = kept_property[str](lambda move: AXES[move.unit])
    piece = kept_property[Piece](lambda move: Piece(0.0, move.duration, 0.0, move.stroke, move.law))

    def gains(self, more: float = _MORE) -> dict[str, float]:
        """The share of the time that a share more of each limit saves: the least time with it is computed again.

        Empty where a torque or what vibrates is limited.

        Examples
        --------
        >>> import optlaws
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> round(move.gains(0.1)["jerk"], 6), round(1 - 1.1 ** (-1 / 3), 6)
        (0.03127, 0.03127)
        """
        more = positive(more, "more")
        if more not in self._gains:
            move, gains = self.least.move, dict.fromkeys(self.least.slopes, 0.0)
            for name in gains.keys() & {*self.binding}:
                raised = replace(move, limits=move.limits.scaled(name, 1.0 + more))
                gains[name] = 1.0 - least_time(raised, self.least).duration / self.duration
            self._gains[more] = gains
        return dict(self._gains[more])

    @kept_property
    def _gains(self) -> dict[float, dict[str, float]]:
        return {}

    def within(self, duration: Quantity) -> Problem:
        """The problem of the laws that keep every limit in a longer time, such as "0.3 s", to minimise something else.

        Raises
        ------
        InputError
            If it is no time, or shorter than the least.

        Examples
        --------
        >>> from dataclasses import replace
        >>> import optlaws
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> slower = optlaws.synthesize(replace(move.within("0.3 s"), minimise="rms_c"))
        >>> round(slower.objective * move.stroke / 0.3**2, 6)
        4.202626
        """
        time = quantity(duration, "time", "duration", above=0.0)
        if time < self.duration * (1.0 - SAME_TIME):
            raise InputError(
                f"duration must be at least the least time, {self.duration:.9g} s, got {shortened(duration)}"
            )
        return self.least.move.within(max(time, self.duration))

    @property
    def notes(self) -> tuple[str, ...]:
        """The active limits, and the time that a tenth more of each would save, in words."""
        gains = self.gains()
        return tuple(
            f"{name}: 10 % more saves {100.0 * gains[name]:.2g} % of the time"
            if name in gains
            else f"{quantity_name(name)} binds"
            for name in self.binding
        )

    @kept_property
    def beside(self) -> Differences | None:
        """The move beside modified sine within the same limits: both least times, and what the laws take in them.

        None where an end moves, or no time of modified sine keeps the limits.

        Examples
        --------
        >>> import optlaws
        >>> limits = {"velocity": "1 m/s", "acceleration": "12 m/s^2", "jerk": "300 m/s^3"}
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits=limits)
        >>> [(each.name, each.text) for each in move.beside.values][:2]
        [('least time', '-19.0 %'), ('velocity', '+39.1 %')]
        """
        usual = catalogue[USUAL].law
        time = _time_of(usual, self.least.move)
        if not 0.0 < time < inf:
            return None
        both = (MoveReport(self, usual, time), MoveReport(self, self.law, self.duration))
        values = [Difference("least time", "s", time, self.duration)]
        for nu, name in enumerate(QUANTITIES[1:], 1):
            sizes = [max(abs(value) for value, _ in each.piece.extremes(nu, 0.0, each.duration)) for each in both]
            values.append(Difference(name, unit_of(self.axis, nu), *sizes))
        for first, second in zip(*(each.limits_taken for each in both), strict=True):
            if first.name not in (*DERIVATIVES, DECELERATION):
                values.append(Difference(first.name, first.unit, first.value, second.value))
        return Differences(USUAL, values, "least time")

    def proof_rows(self) -> Summary:
        """The least time and the best possible time, with what is proven of them."""
        rows = [Row("least time", self.duration, "s", note=self._proven)]
        laws = "of any degree" if self.least.move.torque is None else "that never turns back"
        return Summary([*rows, best_possible_row(self.best_possible, self.duration, laws)])

    def _exported(self) -> tuple[MotionLaw, tuple[str, ...]]:
        return self.law, self._proof

    @property
    def _in_machine(self) -> tuple[Quantity, Quantity]:  # type: ignore[override] # which laws have not
        unit, factor = ("mm", 1e3) if self.unit == "m" else ("deg", DEGREES)
        return Exact(factor * self.stroke, unit), Exact(self.duration, "s")

    @property
    def _proof(self) -> tuple[str, ...]:
        return (f"law: least time {self.duration:.9g} s within the limits, {self._proven}",)

    @property
    def _proven(self) -> str:
        """How far the least time is proven, and the statement on all laws of the space that is."""
        word = "proven" if self.status is Status.OPTIMAL else "a local optimum; proven"
        space = self.least.move.problem
        basis = space.basis
        among = f"with Z of degree {basis.degree}" if isinstance(basis, PolynomialBasis) else f"in {basis!r}"
        return f"{word}: laws of order {space.order} {among} take more than {self.none_below:.9g} s"

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict in SI units: law and proofs in one, which `optlaws verify` checks."""
        return {"unit": self.unit, **self.least.to_dict()}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> FastestMove:
        """Read the output of `to_dict`; the law and the proofs are checked against the move and its limits.

        Raises
        ------
        InputError
            If an entry is missing or wrong, or states what does not follow from the law and the proofs.
        """
        if entries_of(data, ["unit"], cls._json_name)["unit"] not in tuple(AXES):
            raise InputError(f"{cls._json_name} has a unit, 'm' or 'rad', got {shortened(data)}")
        return cls(LeastTime.from_dict({key: data[key] for key in data if key != "unit"}), data["unit"])

    def report(self) -> Report:
        """The facts of the move, and its motion over time within its limits.

        Examples
        --------
        >>> import optlaws
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> [(panel.title, round(panel.peak, 6)) for panel in move.report().panels][3]
        ('jerk, m/s³', 300.0)
        """
        return MoveReport(self, self.law, self.duration)

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw position, velocity, acceleration and jerk over time, with their limits; return the artists.

        `ax` are four axes of matplotlib, new ones unless given; `style` is what `Axes.plot` takes, for the curves.

        Examples
        --------
        >>> import optlaws
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> [artist.axes.get_ylabel() for artist in move.plot()][2]
        'acceleration, m/s²'
        """
        from optlaws.plots.moves import draw_move

        return draw_move(self, ax, **style)

    def __repr__(self) -> str:
        best = "" if self.best_possible is None else f", best_possible={self.best_possible:.9g}"
        return f"FastestMove(duration={self.duration:.9g}{best}, binding={self.binding!r})"


def _time_of(law: MotionLaw, move: TimedMove) -> float:
    """The least time in which a law whose snap jumps keeps the limits of a move; infinite where none is known."""
    if not move.at_rest or move.limits.snap is not None:
        return inf
    time, left = least_time_of(law, move.without_residual.along), move.residual
    if left is None or not 0.0 < time < inf:
        return time

    def calm(duration: float) -> bool:
        return left.limit_in(duration, move.stroke).share(law) <= 1.0

    # a vibration need not fall as the time grows: the first time that keeps its limit
    for before, after in pairwise([time, *np.geomspace(time, _LONGEST * time, _TIMES).tolist()]):
        if calm(after):
            return bisect(calm, after, before)[0]
    return inf


@dataclass(frozen=True)
class MoveReport:
    """The report of a least time, with its law or another one in a longer time.

    Attributes
    ----------
    move
        The least time.
    law, duration
        The law and its time, s.
    drive, start
        The motor whose torque is shown, if any, and the position of its mechanism's input where the move begins, rad.
    """

    move: FastestMove
    law: MotionLaw
    duration: float
    drive: Drive | None = None
    start: float = 0.0

    segments: tuple[ReportSegment, ...] = ()

    @property
    def tables(self) -> tuple[ReportTable, ...]:
        """The move beside modified sine."""
        return () if self.move.beside is None else (self.move.beside.table,)

    @property
    def facts(self) -> Summary:
        """The least time with its proof, and the use of each limit with the time that a higher one saves."""
        rows = (
            Row(quantity_name(each.name), each.value, each.unit, note=self._note(each)) for each in self.limits_taken
        )
        beside = self.move.beside
        worse = [] if beside is None else beside.remark_rows
        return Summary([*self.move.proof_rows(), *rows, *worse])

    def _note(self, taken: LimitTaken) -> str:
        if taken.name not in self.move.binding:
            return f"{100.0 * taken.share:.3g} % of the limit"
        gain = self.move.gains().get(taken.name)
        return "binds" if gain is None else f"binds: 10 % more saves {100.0 * gain:.2g} % of the time"

    @property
    def data(self) -> dict[str, Any]:
        """The move with its proofs."""
        return self.move.to_dict()

    @kept_property
    def piece(self) -> Piece:
        """The law in its place."""
        return Piece(0.0, self.duration, self.start, self.move.stroke, self.law)

    @kept_property
    def limits(self) -> dict[int, tuple[float, float]]:
        """The least and the greatest allowed value of each derivative with a limit, by its order, in SI units."""
        known = self.move.least.move.limits
        sides = {1: (known.velocity,) * 2, 2: (known.deceleration, known.acceleration), 3: (known.jerk,) * 2}
        sides[4] = (known.snap,) * 2
        return {
            nu: (-inf if low is None else -low, inf if high is None else high)
            for nu, (low, high) in sides.items()
            if low is not None or high is not None
        }

    @kept_property
    def limits_taken(self) -> tuple[LimitTaken, ...]:
        """The use of each limit of the move, in SI units."""
        axis, others = self.move.axis, {CURVE_LIMIT: ""}
        others |= {name: unit_of(axis, nu) for name, nu in zip(RESIDUALS, (2, 0), strict=True)}
        return tuple(
            LimitTaken(
                limit.name,
                "",
                limit.at(self.duration).share(self.law) * limit.most,
                limit.most,
                "",
                unit=unit_of(axis, limit.nu) if limit.nu else others.get(limit.name, "N m"),
            )
            for limit in self.move.least.move.along
        )

    def shares(self, times: Array) -> dict[str, Array]:
        """The share of each limit of the motion and of the motor that is taken at each time, 0 to 1."""
        taken, torque = {}, self.move.least.move.torque
        for nu, (low, high) in self.limits.items():
            values, name = self.piece.values(times, nu), DERIVATIVES[nu]
            if low == -high:
                taken[name] = np.abs(values) / high
            else:
                sides = {name: high, "deceleration": low}
                taken |= {side: np.maximum(values / end, 0.0) for side, end in sides.items() if isfinite(end)}
        if self.drive is not None and self._along is not None and torque is not None:
            torques = np.abs(self._along.force(times))
            if torque.peak is not None:
                taken["torque"] = torques / torque.peak
            if torque.curve:
                taken[CURVE_LIMIT] = self._along.use(times)
        return taken

    @property
    def demands(self) -> list[Row]:
        """What the move takes of its motor; nothing without one."""
        return [] if self.sheet is None else list(self.sheet.summary())

    @kept_property
    def sheet(self) -> DriveSheet | None:
        """What the move takes of its motor; None without one."""
        if self.drive is None:
            return None
        return self.drive.sheet(self.law, self.start, self.move.stroke, self.duration)

    @kept_property
    def panels(self) -> tuple[Panel, ...]:
        """Position, velocity, acceleration and jerk; the snap where it is limited, and the torque of a motor."""
        panels = panels_of(replace(self.piece, offset=0.0), self.move.axis, self.limits)
        return (*panels, *self._torque_panel())

    @kept_property
    def _along(self) -> PieceEffort | None:
        return None if self.drive is None else PieceEffort(self.drive, self.piece)

    def _torque_panel(self) -> tuple[Panel, ...]:
        """The torque at the motor through its peak, and within its limit."""
        if self._along is None or self.sheet is None:
            return ()
        torque, law, limited = self._along.force, self.law, self.move.least.move.torque
        marks = self.duration * np.array([self.sheet.peak_torque_at, self.sheet.curve_use_at])
        times = np.unique(self.duration * np.array([*np.linspace(0.0, 1.0, _STEPS), *law.breaks]))
        times, (values,) = refined(times, [torque(times)], [torque], marks)
        most = None if limited is None else limited.peak
        limits = () if most is None else (PanelLimit(0.0, self.duration, -most, most),)
        peaks = ((float(marks[0]), float(torque(marks[:1])[0])),)
        return (Panel("torque", "N m", (Series(times, values),), limits, peaks),)
