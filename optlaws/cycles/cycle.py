"""A whole cycle of a machine: its segments in machine units, evaluated, peaked, driven, and optimal as a whole."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import KW_ONLY, replace
from functools import partial
from math import sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cycles.interchange import CycleInterchange
from optlaws.cycles.jerk_comparison import jerk_limit, usual_jerk
from optlaws.cycles.kinematics import SegmentPeaks, TimedCycle
from optlaws.cycles.limit_rows import limits_taken, refuse_beyond
from optlaws.cycles.optimisation.bounds import bound_of, is_exact
from optlaws.cycles.optimisation.drive_formulas import known_drive
from optlaws.cycles.optimisation.durations import durations
from optlaws.cycles.optimisation.joint_limits import check_limits_at_joints
from optlaws.cycles.optimisation.motion_limits import LimitTaken, both_sides, read_limits, tightest
from optlaws.cycles.optimisation.motor_limits import MOTOR, motor_limits
from optlaws.cycles.optimisation.objectives import (
    OBJECTIVES,
    SUMS,
    CycleObjective,
    check_objective,
    kind_of,
    limits_of_stretch,
    read_load_limits,
)
from optlaws.cycles.optimisation.search_spaces import remark_on_degrees, search_space
from optlaws.cycles.optimisation.shared_limits import Best, best_of
from optlaws.cycles.optimisation.sums import total
from optlaws.cycles.specification.drive import CONSTANTS, read_drive
from optlaws.cycles.specification.frozen import FrozenTable, frozen, thawed
from optlaws.cycles.specification.joints import LawSpan, Layout, layout
from optlaws.cycles.specification.limit_entries import LIMITS_OF_CYCLE
from optlaws.cycles.specification.load import LOAD, ElasticLoad, Load, read_load
from optlaws.cycles.specification.process import is_process, read_process
from optlaws.cycles.specification.programme import Programme, is_optimal, period_of, programme
from optlaws.cycles.specification.segments import SEGMENTS, CycleSegment, Dwell, Transition
from optlaws.entries.declared import ValueOf, declared, documented_by, entry
from optlaws.entries.value_types import Measured, ReadBy, Text, Whole
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.effort import Effort, PieceEffort, SegmentEffort, effort
from optlaws.mechanisms.drives.motor import OF_TORQUE, Motor
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.mechanisms.machine.machine import Machine
from optlaws.mechanisms.machine.over_time import RepeatedMotion
from optlaws.motion.piece import Piece, by_pieces
from optlaws.motion.quantities import TURN, quantity
from optlaws.motion.quantity_kinds import Kind
from optlaws.numbers import MOST_DEGREE, Array, Quantity, derivative, number_or_array, real_times
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.status import Status
from optlaws.tolerances import CYCLE_OPTIMALITY

if TYPE_CHECKING:
    from optlaws.cycles.fastest_cycle import FastestCycle
    from optlaws.cycles.moves.transition_cam import TransitionCam, TransitionKind
    from optlaws.mechanisms.drives.sheet import CycleSheet


_JERK = 3
_STRICTER = (
    "the gear loses power and a load acts: where the motor brakes, its torque is counted as that of power that flows "
    "back, which may be more than it is, so that nothing is proven of it"
)


class Objective(Text):
    """What is least of a cycle: one of `OBJECTIVES`, or an output of its load."""

    def form(self) -> dict[str, Any]:
        return {"choices": list(OBJECTIVES)}


def _read_drive(value: Any) -> Any:
    stored = isinstance(value, Mapping)
    if stored and "mechanism" in value:
        return Drive.from_dict(value)
    return Mechanism.from_dict(value) if stored and "axis" in value else frozen(value)


class DriveTable(ReadBy):
    """Constants of a drive, which stay a table, or a `Mechanism` or `Drive`."""

    def schema(self) -> dict[str, Any]:
        mechanism = {"type": "object", "required": ["axis", "inertia"]}
        return {"anyOf": [*(table.schema() for table in CONSTANTS.values()), mechanism, Drive.json_schema()]}


class LoadTable(ValueOf):
    """An elastic load or a process force, which stays a table, or a `Machine`."""

    def read(self, value: Any, name: str) -> Any:
        if isinstance(value, Machine) or (isinstance(value, Mapping) and "A" in value):
            return value if isinstance(value, Machine) else Machine.from_dict(value)
        if not is_process(value):
            super().read(value, name)
        return frozen(value)

    def plain(self, value: Any) -> Any:
        return _plain(value)


def _plain(value: Any) -> Any:
    """A drive or a load as plain data."""
    if isinstance(value, Machine | Mechanism | Drive):
        return value.to_dict()
    return thawed(value)


@declared
class Cycle(CycleInterchange):
    """A cycle that repeats: segments and the speed of the master; call it for motion in SI units over time.

    Positions are lengths or angles, whichever the first displacement is. Laws that are to be optimal are looked for
    when they are first needed; between joints that are known the cycle decouples, and each law is proven by itself.

    Raises
    ------
    InputError
        If durations do not sum, positions do not close or velocities do not meet; the error states the remedy, as it
        does where a method is given what is no time, speed or angle, or needs a load or drive that the cycle has not.
    InfeasibleProblem
        If a joint takes more force than a limit allows. A limit that a given law breaks, or no law satisfies, is
        reported when the motion is first needed; `fastest` finds the speed that keeps them all.

    Examples
    --------
    >>> from optlaws import Dwell, Return, Rise
    >>> rise, back = Rise("35 mm", "120 deg"), Return("35 mm", "100 deg")
    >>> cycle = Cycle([rise, Dwell("90 deg"), back, Dwell()], speed="200 rpm")
    >>> cycle.status.value, round(cycle.objective, 6), round(float(cycle(0.1)), 9)
    ('optimal', 21.883840, 0.035000)
    """

    segments: Sequence[CycleSegment] = entry(
        SEGMENTS, "What happens, in order: `Rise`, `Return`, `Move`, `Dwell`, `ConstantVelocity`, `Free`."
    )
    _: KW_ONLY
    speed: Quantity | None = entry(
        Measured("angular velocity", above=0.0),
        "Speed of the master; give it or the period.",
        default=None,
        example="200 rpm",
    )
    period: Quantity | None = entry(
        Measured("time", above=0.0), "The duration of the cycle; it or the speed.", default=None, example="0.3 s"
    )
    minimise: str = entry(
        Objective(),
        '"acceleration", "velocity", "jerk", "rms acceleration", "rms jerk", "rms snap" of optimal segments, or of the '
        'drive "force", "rms force" (of a table "torque", "rms torque"), "power", "energy" and, of a `Drive` whose '
        'motor has a motor constant, "heat": what its winding and its brake resistor burn.',
        default="acceleration",
        label="least",
    )
    limits: Mapping[str, Any] = entry(
        LIMITS_OF_CYCLE,
        'Of all segments, by optimal laws and by given ones: `{"velocity": "616 mm/s", "power": "400 W"}`, of '
        'derivatives up to the "snap". Of two quantities, as ("-8 m/s^2", "12 m/s^2"), the first is the least value; a '
        '"deceleration" is of moves that slow down. "rms force", "rms torque" and "energy" are of the whole cycle, as '
        'motors are rated; `{"motor": True}` are all those of the motor of a `Drive`.',
        default=FrozenTable(),
        example={"velocity": "616 mm/s"},
    )
    start: Quantity | None = entry(
        Measured("length", "angle"), "Position at the start, 0 unless given.", default=None, example="0 mm"
    )
    advance: Quantity | None = entry(
        Measured("length", "angle"),
        "The advance of each cycle over the previous one, 0 unless given.",
        default=None,
        example="45 deg",
    )
    drive: Mapping[str, Any] | Mechanism | Drive | None = entry(
        DriveTable(_read_drive, "a table of constants, a `Mechanism` or a `Drive`", _plain),
        'What the motion drives: `{"mass": "2 kg", "stiffness": "3 N/mm", "viscous": ..., "dry": ..., "gravity": '
        "...}`, with inertia in place of mass for tables; a `Mechanism` whose input moves as the cycle does, or the "
        "`Drive` of its motor. Objectives and limits are then of the torque at the input, or at the motor.",
        default=None,
        example={"mass": "2 kg"},
    )
    load: Any = entry(
        LoadTable(ElasticLoad),
        'What the motion drives elastically, over the whole cycle: `{"period": "20 ms", "damping": 0.05, "mass": "2 '
        "kg\"}` for a follower's mass on its spring, the damping as its ratio to the critical one, between mass and "
        'ground; or a `Machine` in seconds and SI units. Its outputs may be minimised and bounded: "load '
        'acceleration", "rms load deflection", "load force"; the cycle is then one problem. Or a process force on the '
        'mechanism of the drive, `{"force": {"0 deg": "0 N", "360 deg": "-400 N"}, "over": "master", "on": '
        '"slider"}`: a table or formula over the "time", the "master" or the position of the "driven" link or of the '
        '"input", above 0 where it pushes to greater positions.',
        default=None,
        example={"period": "20 ms", "damping": 0.05},
    )
    order: int = entry(Whole(2, 10), "Number of end conditions of optimal laws.", default=3)
    degree: int = entry(
        Whole(0, MOST_DEGREE),
        "Of their Z, at least 15 where a velocity is given at an end; order and degree make the laws that are "
        "compared: `search_space` says which.",
        default=9,
    )
    __repr__ = CycleInterchange.__repr__

    def _check(self) -> None:
        check_objective(self.minimise, self._load)
        self._check_order_of_limits()  # limits and drives that are wrong are refused at once
        if all(stretch.fixed for stretch in self.programme.stretches):
            # and so are velocities that do not meet, and forces at joints beyond their limits
            check_limits_at_joints(self._layout, self._cycle_objective, self.axis, self.duration)

    def _check_order_of_limits(self) -> None:
        """Refuse a jerk limit of laws whose acceleration may jump where they begin or end."""
        for stretch, limits in zip(self.programme.stretches, self.limits_of_segments, strict=True):
            if self.order < _JERK and _JERK in limits and is_optimal(stretch.given):
                raise InputError(
                    f"{stretch.where}: its jerk is limited, but laws of order {self.order} may jump in acceleration "
                    "where they begin or end: take order 3, or leave the limit of the jerk out"
                )

    @kept_property
    def programme(self) -> Programme:
        """The cycle as numbers in SI units."""
        return programme(self.segments, period_of(self.speed, self.period), self.start, self.advance)

    @property
    def axis(self) -> str:
        """Whether positions are a "length" or an "angle"."""
        return self.programme.axis

    @property
    def duration(self) -> float:
        """Duration of the cycle in seconds."""
        return self.programme.period

    @kept_property
    def durations(self) -> tuple[float, ...]:
        """Durations of the segments in seconds; optimal ones where they are free."""
        return durations(self.programme, self._cycle_objective)

    @kept_property
    def solutions(self) -> tuple[Solution, ...]:
        """The solution of each optimised motion, in order, with its proof; dimensionless."""
        return tuple(solution for _, solution in self._best.laws)

    @kept_property
    def pieces(self) -> tuple[Piece, ...]:
        """The laws in their places, in order.

        Raises
        ------
        InfeasibleProblem
            If a given law breaks a limit, or no law keeps one.
        """
        pieces = [*self._layout.pieces, *(piece for piece, _ in self._best.laws)]
        return tuple(sorted(pieces, key=lambda piece: piece.start))

    @property
    def status(self) -> Status:
        """The worst status of the solutions; optimal where no motion is optimised.

        Infeasible where a limit is broken, of a cycle that is `unchecked`: others are refused.
        """
        if self._reports and not all(taken.is_kept for taken in self.limits_taken):
            return Status.INFEASIBLE
        ranks = (Status.OPTIMAL, Status.LOCAL, Status.INACCURATE)
        worst = max((solution.status for solution in self.solutions), key=ranks.index, default=Status.OPTIMAL)
        if self.solutions and worst == Status.OPTIMAL and self.lower_bound is not None:
            return Status.OPTIMAL if self.objective <= self.lower_bound * (1.0 + CYCLE_OPTIMALITY) else Status.LOCAL
        return worst

    @kept_property
    def objective(self) -> float:
        """The value of the objective over the whole cycle, in SI units; recomputed from the laws."""
        return self.value(self.minimise)

    def value(self, name: str) -> float:
        """The value of whatever may be minimised over the whole cycle, in SI units; recomputed from the laws.

        Raises
        ------
        InputError
            If nothing of this name can be minimised, or it is of a drive or load that is not there.

        Examples
        --------
        >>> from optlaws.cycles.specification.segments import Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> round(cycle.value("acceleration"), 6), round(cycle.value("rms acceleration"), 6)
        (21.991149, 9.522447)
        """
        check_objective(name, self._load)
        kind, mean = kind_of(name)
        if kind is Kind.LOAD:
            output = name.removeprefix("rms ").removeprefix(LOAD)
            return self.load_motion.rms(output) if mean else self.load_motion.peak(output).value
        if kind is Kind.POWER:
            return self.effort.peak_power
        if kind is Kind.FORCE:
            return self.effort.rms_force if mean else self.effort.peak_force
        if kind in SUMS:
            return total(self.pieces, kind, known_drive(self._drive))
        if not mean:
            return max(peak.peak(kind.order) for peak in self.peaks)
        return sqrt(sum(piece.duration * piece.mean_square(kind.order) for piece in self.pieces) / self.duration)

    @property
    def limits_taken(self) -> tuple[LimitTaken, ...]:
        """The use of every limit, by the segment that takes most of it; of a motor, those of the `sheet`.

        Examples
        --------
        >>> from optlaws import Return, Rise
        >>> moves = [Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")]
        >>> cycle = Cycle(moves, period="0.25 s", limits={"velocity": "1 m/s", "acceleration": "25 m/s^2"})
        >>> [(taken.name, round(taken.share, 4)) for taken in cycle.limits_taken]
        [('velocity', 0.7), ('acceleration', 0.8796)]
        """
        return limits_taken(self)

    def unchecked(self) -> Cycle:
        """The same cycle, of which given laws that break limits are not refused but reported.

        Its `status` is then infeasible, and `limits_taken` names them.

        Examples
        --------
        >>> from optlaws import Return, Rise
        >>> moves = [Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")]
        >>> cycle = Cycle(moves, period="0.25 s", limits={"velocity": "616 mm/s"})
        >>> cycle.peak(1)
        Traceback (most recent call last):
        optlaws.errors.InfeasibleProblem: segment 1 (Rise): it takes the velocity 700 mm/s at 72 deg of the master, ...
        >>> shown = cycle.unchecked()
        >>> shown.status.value, round(shown.peak(1), 9)
        ('infeasible', 0.7)
        """
        other = copy(self)
        vars(other)["_reports"] = True
        return other

    @kept_property
    def lower_bound(self) -> float | None:
        """The lower bound of laws of the `search_space` in the same times; with friction, that never turn back.

        Laws that are not in it may be below: of a higher degree, of a lower order, of more pieces.
        """
        if not self._layout.spans:
            return bound_of(self._layout, (), self._cycle_objective, self.duration)
        return self._best.bound

    @property
    def search_space(self) -> str | None:
        """The laws, in words, of which none is below the `lower_bound` nor, where the status is optimal, better.

        None where no law was looked for. "All motions through the joints" are all whose derivatives before the one that
        is minimised are continuous.

        Examples
        --------
        >>> from optlaws import Free
        >>> ways = [Free("30 mm", "0.2 s"), Free("-30 mm")]
        >>> [Cycle(ways, period="0.5 s", minimise=what).search_space for what in ("rms jerk", "jerk")]
        ['all motions through the joints', 'splines of degree 3 in 48 pieces']
        """
        laws = zip(self._problems, self._best.laws, strict=True)
        spaces = []
        for (span, problem), (piece, _) in laws:
            fastest = max(abs(velocity) for velocity, _ in piece.extremes(1, piece.start, piece.stop))
            spaces.append(search_space(problem, span, self.order, fastest))
        return "; ".join(dict.fromkeys(spaces)) or None

    @property
    def remarks(self) -> tuple[str, ...]:
        """The choices beyond the request: a raised degree, or the selection among several optimal laws.

        Examples
        --------
        >>> from optlaws import ConstantVelocity, Return
        >>> Cycle([ConstantVelocity("1.5 m/s", "80 ms"), Return()], period="400 ms").remarks
        ('segment 2 (Return): Z has the degree 15, not 9, for the velocities at its ends',)
        """
        stricter = not all(is_exact(span, self._cycle_objective) for span in self._layout.spans)
        of_gear = (_STRICTER,) if stricter else ()
        return (*remark_on_degrees(self._problems, self.degree), *self._best.remarks, *of_gear)

    @kept_property
    def peaks(self) -> tuple[SegmentPeaks, ...]:
        """Least and greatest values in every segment."""
        return self._timed.peaks()

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu over the cycle, up to the jerk, in SI units."""
        nu = derivative(nu)
        if nu > 3:
            raise InputError(f"nu must be at most 3, the jerk, got {nu}")
        return max(peak.peak(nu) for peak in self.peaks)

    @kept_property
    def modified_sine_jerk(self) -> float | None:
        """The greatest peak jerk that modified sine has in the same optimal motions, in SI units.

        A law of least acceleration has some four to five times as much. None unless the acceleration is minimised, no
        limit bounds the jerk or the snap, and every optimal motion goes from rest to rest.

        Examples
        --------
        >>> from optlaws import Dwell, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "120 deg"), Dwell("90 deg"), Return(), Dwell("50 deg")], speed="200 rpm")
        >>> round(cycle.modified_sine_jerk, 3), round(cycle.peak(3) / cycle.modified_sine_jerk, 6)
        (4201.325, 4.145892)
        """
        return usual_jerk(self._layout.spans, self._cycle_objective, self.axis)

    def with_modified_sine_jerk(self) -> Cycle:
        """The cycle of least acceleration among cycles whose jerk is at most modified sine's jerk.

        Raises
        ------
        InputError
            If there is no such jerk: see `modified_sine_jerk`.

        Examples
        --------
        >>> from optlaws import Dwell, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "120 deg"), Dwell("90 deg"), Return(), Dwell("50 deg")], speed="200 rpm")
        >>> gentle = cycle.with_modified_sine_jerk()
        >>> gentle.limits, [round(each.objective, 3) for each in (cycle, gentle)]
        ({'jerk': '4201.33 m/s^3'}, [21.884, 24.766])
        """
        if self.modified_sine_jerk is None:
            raise InputError(
                "modified sine's jerk is that of motions from rest to rest whose acceleration is minimised without a"
                " limit of the jerk or the snap: give the cycle such motions, or limits={'jerk': ...} of your own"
            )
        limit = jerk_limit(self.modified_sine_jerk, self.axis)
        return replace(self, limits={**self.limits, "jerk": limit})

    @property
    def joints(self) -> tuple[dict[str, Any], ...]:
        """Every joint: its time, and the jumps of velocity, acceleration and jerk there; 0 where continuous."""
        return self._timed.jumps([self.peak(nu) for nu in (1, 2, 3)])

    @kept_property
    def load_motion(self) -> RepeatedMotion:
        """The steady motion of the load over time in seconds: its outputs by their names, in SI units.

        Raises
        ------
        InputError
            If the cycle has no load, or it is in resonance with the cycle.

        Examples
        --------
        >>> from optlaws import Dwell, Return, Rise
        >>> segments = [Rise("30 mm", "120 deg", law="modified sine"), Dwell("60 deg"), Return(law="modified sine")]
        >>> cycle = Cycle(segments, speed="300 rpm", load={"period": "20 ms", "damping": 0.05})
        >>> cycle.load_motion.peak("acceleration").value, cycle.peak(2)
        (70.889663, 37.313710)
        """
        if self._load is None:
            raise InputError("the cycle has no load: give one, such as load={'period': '20 ms', 'damping': 0.05}")
        return self._load.motion(self.pieces)

    @kept_property
    def effort(self) -> Effort:
        """Force or torque and power that the drive takes."""
        if self._drive is None:
            raise InputError("the cycle has no drive: give one, such as drive={'mass': '2 kg', 'gravity': '20 N'}")
        return effort(self._along, self.duration)

    @property
    def geared_motor(self) -> Drive:
        """The drive, if it has a motor.

        Raises
        ------
        InputError
            If it has none.
        """
        if not isinstance(self.drive, Drive):
            raise InputError("the cycle has no motor: give one, as drive=Drive(mechanism, Motor(...), ratio=20)")
        return self.drive

    @kept_property
    def sheet(self) -> CycleSheet:
        """The motor sheet of the cycle: torques, speed, powers, energies, and margins to the motor's limits.

        Raises
        ------
        InputError
            If the drive is no `Drive` with a motor.
        """
        from optlaws.mechanisms.drives.sheet import sheet_of

        self.geared_motor  # noqa: B018 - a drive without one has no sheet
        return sheet_of(self._along, self.duration)

    @kept_property
    def efforts(self) -> tuple[SegmentEffort, ...]:
        """Peaks of force and power, the RMS force and the energies of every segment, in SI units."""
        drive, pieces = known_drive(self._drive), self.pieces
        spans = [(next(p for p in reversed(pieces) if p.start <= each.start), each) for each in self.peaks]
        return tuple(
            PieceEffort(drive, piece, (each.start, each.start + each.duration)).of_segment(each.name)
            for piece, each in spans
        )

    def force(self, time: Any) -> Any:
        """Force or torque of the drive at a time in seconds: at the follower or table, the input or the motor."""
        return self._of_drive(time, PieceEffort.force)

    def power(self, time: Any) -> Any:
        """Power of the drive at a time in seconds, W: above 0 where it drives, below where it brakes."""
        return self._of_drive(time, PieceEffort.power)

    @kept_property
    def smooth_times(self) -> Array:
        """Times between which force and power of the drive are smooth and of one sign, s."""
        return np.unique(np.concatenate([each.parts.edges for each in self._along]))

    def _of_drive(self, time: Any, function: Callable[[PieceEffort, Array], Array]) -> Any:
        places = np.mod(real_times(time), self.duration)
        along = [partial(function, each) for each in self._along]
        return number_or_array(by_pieces(self.pieces, along, places))

    def __call__(self, time: Any, nu: int = 0) -> Any:
        """Position (nu 0), velocity, acceleration, jerk at a time in seconds, in SI units; the cycle repeats."""
        return number_or_array(self._timed.values(real_times(time), derivative(nu)))

    def at_angle(self, degrees: Any, nu: int = 0) -> Any:
        """The motion at an angle of the master, in degrees or a text such as "0.5 rad"; derivatives are by time."""
        turns = quantity(degrees, "angle", "angle") / TURN if isinstance(degrees, str) else real_times(degrees) / 360.0
        return self(turns * self.duration, nu)

    def at(self, speed: Quantity) -> Cycle:
        """The same motion at another speed of the master: laws are unchanged, durations scale in proportion.

        Examples
        --------
        >>> from optlaws import Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm")
        >>> fast = cycle.at("400 rpm")
        >>> fast.duration, round(fast.peak(2) / cycle.peak(2), 9)
        (0.15, 4.0)
        """
        period = period_of(speed, None)
        segments = self._timed.at_speed(period / self.duration)
        # laws that are known leave nothing of a load to look for
        minimise = "acceleration" if kind_of(self.minimise)[0] is Kind.LOAD else self.minimise
        return replace(self, segments=segments, speed=None, period=f"{period!r} s", minimise=minimise, limits={})

    def with_solutions(self, solutions: Sequence[Solution]) -> Cycle:
        """The same cycle with other solutions of its motions, such as solutions of problems with further bounds.

        Objective, bound and status are recomputed from them.

        Parameters
        ----------
        solutions
            One in the place of each of `solutions`.

        Raises
        ------
        InputError
            If they are more or fewer.

        Examples
        --------
        >>> from optlaws import Return, Rise, at_most, synthesize
        >>> cycle = Cycle([Rise("35 mm", "0.1 s"), Return(law="cycloidal")], period="0.3 s")
        >>> (solution,) = cycle.solutions
        >>> smooth = cycle.with_solutions([synthesize(replace(solution.problem, J=at_most(60)))])
        >>> [[round(each.peaks[0].peak(nu), 3) for nu in (2, 3)] for each in (cycle, smooth)]
        [[14.537, 20353.531], [17.073, 2100.0]]
        """
        laws = self._best.laws
        if len(solutions) != len(laws):
            raise InputError(f"the cycle has {len(laws)} optimised motions, got {len(solutions)} solutions")
        placed = tuple(
            (replace(piece, law=solution.law), solution) for (piece, _), solution in zip(laws, solutions, strict=True)
        )
        objective = self._cycle_objective
        bound = None if objective.shares else bound_of(self._layout, placed, objective, self.duration)
        other = replace(self)
        known = {"durations": self.durations, "_layout": self._layout, "_reports": self._reports}
        vars(other).update(known | {"_best": Best(placed, (), bound)})
        return other

    def with_motor(self, motor: Motor) -> Cycle:
        """The same laws by a motor with other limits: torques and proofs stay, the margins of its sheet are new.

        Raises
        ------
        InputError
            If the cycle has no motor, its laws keep the limits of the motor, or the other motor has another inertia,
            friction or motor constant, so that other laws may be optimal.

        Examples
        --------
        >>> from optlaws import Drive, Dwell, Mechanism, Motor, Rise
        >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", rated_torque="2 N m"), ratio=20)
        >>> moves = [Rise("45 deg", "0.25 s", law="modified sine"), Dwell()]
        >>> cycle = Cycle(moves, period="0.6 s", advance="45 deg", drive=drive)
        >>> weak = cycle.with_motor(Motor("3e-4 kg m^2", rated_torque="1 N m"))
        >>> [round(each.sheet.margins[0].use, 6) for each in (cycle, weak)]
        [0.729259, 1.458518]
        """
        source = self.geared_motor
        if self.limits.get(MOTOR):
            raise InputError("the laws keep the limits of the motor: make the cycle anew with the other motor")
        if any(getattr(motor, name) != getattr(source.motor, name) for name in OF_TORQUE):
            raise InputError(
                f"the motor has another {', '.join(OF_TORQUE[:-1])} or {OF_TORQUE[-1]}: make the cycle anew"
            )
        other = replace(self, drive=replace(source, motor=motor))
        same = ("durations", "_layout", "_best", "_reports", "pieces", "_timed", "peaks", "effort")
        vars(other).update({name: getattr(self, name) for name in same})
        return other

    def fastest(self) -> FastestCycle:
        """The greatest speed at which the cycle keeps all its limits, with the proof that none is greater.

        Angles turn with the master and durations in seconds stay; free motions take their least times. Limits are of
        all segments, of laws that are given and of constant velocities too, which turn with the master.

        Raises
        ------
        InputError
            If nothing bounds the speed: no limit, durations that leave nothing free, or a free dwell that may vanish.
        InfeasibleProblem
            If no speed keeps a limit.

        Examples
        --------
        >>> from optlaws import Dwell, Return, Rise
        >>> segments = [Rise("35 mm"), Dwell("50 ms"), Return(), Dwell("90 deg")]
        >>> slide = Cycle(segments, speed="60 rpm", limits={"acceleration": "20 m/s^2", "jerk": "2000 m/s^3"})
        >>> slide.fastest()
        FastestCycle(186.397 rpm, period=0.321894 s, status='optimal', binding=('segment 1 (Rise): acceleration 20 ...
        """
        from optlaws.cycles.fastest_cycle import fastest_cycle

        return fastest_cycle(self, self._cycle_objective)

    @documented_by(Transition)
    def run_in(
        self, at: Quantity, *, rest: Quantity | None = None, over: Quantity | None = None, order: int | None = None
    ) -> TransitionCam:
        """The start cam: from rest into the cycle while the master turns, met at an angle, as after a joint there.

        Raises
        ------
        InputError
            If a quantity is wrong, nothing is to move, or nothing limits the least time.
        InfeasibleProblem
            If no law keeps the limits.

        Examples
        --------
        >>> from optlaws import Return, Rise
        >>> limits = {"velocity": "0.5 m/s", "acceleration": "4 m/s^2", "jerk": "100 m/s^3"}
        >>> cycle = Cycle([Rise("35 mm", "180 deg"), Return()], speed="90 rpm", limits=limits)
        >>> start = cycle.run_in("60 deg", rest="-20 mm")
        >>> start.status.value, round(start.duration, 6), start.least.binding
        ('optimal', 0.2, ('acceleration', 'jerk'))
        """
        return self._transition("run-in", Transition(at, rest, over, order))

    def run_out(
        self, at: Quantity, *, rest: Quantity | None = None, over: Quantity | None = None, order: int | None = None
    ) -> TransitionCam:
        """The stop cam: out of the cycle to rest while the master turns, from an angle on.

        `at` is the angle of the master, or time, at which it leaves the cycle, as before a joint there; the others are
        those of `run_in`.

        Examples
        --------
        >>> from optlaws import Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "180 deg", law="cycloidal"), Return(law="cycloidal")], speed="90 rpm")
        >>> stop = cycle.run_out("270 deg", rest="0 mm", over="100 deg")
        >>> stop, round(stop(0.0, 1), 9), stop(stop.duration, 1)
        (TransitionCam('run-out', 270 to 370 deg of the master, 0.185185 s, status='optimal'), -0.21, 0.0)
        """
        return self._transition("run-out", Transition(at, rest, over, order))

    def _transition(self, kind: TransitionKind, given: Transition) -> TransitionCam:
        from optlaws.cycles.moves.transitions import transition_cam

        return transition_cam(kind, self.programme, self.pieces, self._cycle_objective, given)

    def per_angle(self, degrees: Any, nu: int = 0) -> Any:
        """Derivatives by the master's angle in radians, as cams and controllers take them."""
        return self.at_angle(degrees, nu) * (self.duration / TURN) ** nu

    def cam(self, period: Quantity, damping: float = 0.0) -> Cycle:
        """The cycle of the cam with which an elastic follower's mass executes this cycle (1.27).

        Each move is corrected by the follower's frequency over its own duration: nu = 2 pi T / T_k. The mass comes to
        rest with each move, so that nothing vibrates in the dwells.

        Parameters
        ----------
        period
            The period T_k of the follower's free vibration, such as "12 ms".
        damping
            Its damping ratio: the share of the critical damping, between mass and ground, as of `Follower`.

        Raises
        ------
        InputError
            If a move is not from rest to rest by a law whose jerk is continuous and 0 at both ends (order 4).

        Examples
        --------
        >>> from optlaws import Dwell, Move
        >>> moves = [Move("30 mm", "120 deg", law="III(7.2)"), Dwell("60 deg"), Move("-30 mm", law="III(7.2)")]
        >>> round(Cycle(moves, speed="300 rpm").cam("20 ms", damping=0.05).peak(2), 6)
        39.380514
        """
        segments = self._timed.of_cam(period, damping)
        return replace(self, segments=segments, speed=None, period=f"{self.duration!r} s")

    @property
    def limits_of_segments(self) -> tuple[dict[int, tuple[float, float]], ...]:
        """The least and greatest allowed values of derivatives in each segment, by the derivative's order; SI units.

        Of the force or torque by -1 and of the power by -3; nothing of a dwell.

        Examples
        --------
        >>> from optlaws import Return, Rise
        >>> rise = Rise("35 mm", "120 deg", limits={"acceleration": ("-9 m/s^2", "12 m/s^2")})
        >>> Cycle([rise, Return()], speed="100 rpm", limits={"velocity": "1 m/s"}).limits_of_segments
        ({1: (-1.0, 1.0), 2: (-9.0, 12.0)}, {1: (-1.0, 1.0)})
        """
        limits = (limits_of_stretch(stretch, self._cycle_objective, self.axis) for stretch in self.programme.stretches)
        return tuple(
            {} if isinstance(stretch.given, Dwell) else {kind.value: ends for kind, ends in both_sides(limited).items()}
            for limited, stretch in zip(limits, self.programme.stretches, strict=True)
        )

    @property
    def _problems(self) -> list[tuple[LawSpan, Problem]]:
        """Each span with the problem whose solution its law is."""
        laws = zip(self._layout.spans, self._best.laws, strict=True)
        return [(span, solution.problem) for span, (_, solution) in laws]

    @kept_property
    def _timed(self) -> TimedCycle:
        """The laws in their places, with the joints."""
        return TimedCycle(self.programme, self._layout.starts, self.pieces)

    @kept_property
    def _along(self) -> tuple[PieceEffort, ...]:
        """The effort of the drive along each piece."""
        drive = known_drive(self._drive)
        return tuple(PieceEffort(drive, piece) for piece in self.pieces)

    @kept_property
    def _drive(self) -> Drive | None:
        known = None if self.drive is None else read_drive(self.drive, self.axis)
        if not is_process(self.load):
            return known
        if known is None:
            raise InputError("load: a process force is of a drive: give one, such as drive={'mass': '2 kg'}")
        return replace(known, mechanism=read_process(self.load, known.mechanism, self.duration))

    @kept_property
    def _cycle_objective(self) -> CycleObjective:
        motor = motor_limits(self.limits, self._drive, self.programme)
        return CycleObjective(
            self.minimise,
            tightest(read_limits(self.limits, self.axis, "limits"), motor),
            self.order,
            self.degree,
            self._drive,
            self._load,
            read_load_limits(self.limits, self._load),
        )

    @kept_property
    def _load(self) -> Load | None:
        return None if self.load is None or is_process(self.load) else read_load(self.load, self.axis)

    @kept_property
    def _layout(self) -> Layout:
        absolute = self._load is not None and self._load.absolute
        return layout(self.programme, self.durations, whole=self._cycle_objective.of_load, absolute=absolute)

    @kept_property
    def _best(self) -> Best:
        if not self._reports:
            given = copy(self)
            vars(given).update(_best=Best((), (), None), _reports=True)
            refuse_beyond(given, self._cycle_objective.limits)
        return best_of(self._layout, self._cycle_objective, self.axis, self.duration)

    @kept_property
    def _reports(self) -> bool:
        """Whether given laws beyond limits are reported in place of refused."""
        return False
