"""A whole cycle of a machine: a cycle asks, and its plan, with the laws in their places, answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, field, replace
from math import sqrt
from typing import TYPE_CHECKING, Any, Literal, TypeVar, get_args

import numpy as np

from optlaws.cycles.optimisation.objectives import SUMS, check_objective, kind_of
from optlaws.cycles.optimisation.optimal import remark_on_degrees, search_space, span_problem
from optlaws.cycles.optimisation.shared_limits import best_of
from optlaws.cycles.optimisation.span_values import along, bound_of, is_exact, total
from optlaws.cycles.placed import SegmentPeaks, limits_taken, refuse_beyond, retimed_segments, segments_in_place
from optlaws.cycles.specification.limits import FORCE_UNITS, FORCES, LOAD, MOTOR, LimitTaken
from optlaws.cycles.specification.programme import LawSpan, Programme, period_of
from optlaws.cycles.specification.segments import CycleSegment, Transition
from optlaws.cycles.specified import Specification
from optlaws.entries.declared import Declared, ValueOf, declared, documented_by, entry
from optlaws.entries.value_types import Listed, Text
from optlaws.errors import InputError, located, needed
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.motion.exportable import Exportable
from optlaws.motion.piece import Piece, by_pieces, unit_of, values_of_pieces
from optlaws.motion.quantities import QUANTITIES, TURN, Exact, Kind, positive_quantity, quantity
from optlaws.numbers import Array, Quantity, derivative, number_or_array, real_times
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.status import Status
from optlaws.tolerances import CYCLE_OPTIMALITY, JUMP

if TYPE_CHECKING:
    from optlaws.cycles.fastest_cycle import FastestCycle
    from optlaws.cycles.moves.time_front import TimeFront
    from optlaws.cycles.transitions import TransitionCam, TransitionKind
    from optlaws.mechanisms.drives.drive_train import Drive
    from optlaws.mechanisms.drives.effort import CycleSheet, Effort, PieceEffort, SegmentEffort
    from optlaws.mechanisms.drives.motor import Motor
    from optlaws.mechanisms.linkages.mechanism import Mechanism
    from optlaws.mechanisms.machine.over_time import MachineMotion
    from optlaws.motion.motion import Motion
    from optlaws.shown.report import Report

#: what a picture of a cycle is over
PlotOver = Literal["time", "speed"]
T = TypeVar("T")
_DIGITS = 6  # of the jerk of modified sine as a limit
_STRICTER = (
    "the gear loses power and a load acts: where the motor brakes, its torque is counted as that of power that flows "
    "back, which may be more than it is, so that nothing is proven of it"
)


class answer(kept_property[T]):  # noqa: N801 - as the one of functools
    """A property of a plan, computed once, which whatever has a plan forwards to it."""

    if not TYPE_CHECKING:

        def __get__(self, instance: Answers | None, owner: type | None = None) -> Any:
            return super().__get__(None if instance is None else instance.solve(), owner)


class Answers(Exportable):
    """The motion of a plan: call it for position, velocity, acceleration or jerk in SI units over time."""

    def solve(self) -> Plan:
        """The plan that answers."""
        raise NotImplementedError

    @answer
    def solutions(self) -> tuple[Solution, ...]:
        """The solution of each optimised motion, in order, with its proof; dimensionless."""
        return tuple(self.solve().solutions)

    @answer
    def pieces(self) -> tuple[Piece, ...]:
        """The laws in their places, in order."""
        plan = self.solve()
        pieces = [*plan.specification.layout.pieces, *(piece for _, piece, _ in plan.laws)]
        return tuple(sorted(pieces, key=lambda piece: piece.start))

    @answer
    def status(self) -> Status:
        """The worst status of the solutions; optimal where no motion is optimised.

        Infeasible where a limit is broken, as of other solutions than those that were sought, or `unchecked`.
        """
        if not self.solve().checked and not all(taken.is_kept for taken in self.limits_taken):
            return Status.INFEASIBLE
        worst = Status.worst(solution.status for solution in self.solutions)
        if self.solutions and worst == Status.OPTIMAL and self.lower_bound is not None:
            return Status.OPTIMAL if self.objective <= self.lower_bound * (1.0 + CYCLE_OPTIMALITY) else Status.LOCAL
        return worst

    @answer
    def objective(self) -> float:
        """The value of the objective over the whole cycle, in SI units; recomputed from the laws."""
        return self.value(self.solve().specification.minimise)

    def value(self, name: str) -> float:
        """The value of whatever may be minimised over the whole cycle, in SI units; recomputed from the laws.

        Raises
        ------
        InputError
            If nothing of this name can be minimised, or it is of a drive or load that is not there.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> round(cycle.value("acceleration"), 6), round(cycle.value("rms acceleration"), 6)
        (21.991149, 9.522447)
        """
        plan = self.solve()
        check_objective(name, plan.specification.in_si.load)
        kind, mean = kind_of(name)
        if kind is Kind.LOAD:
            output = name.removeprefix("rms ").removeprefix(LOAD)
            return plan.load_motion.rms(output) if mean else plan.load_motion.peak(output).value
        if kind is Kind.POWER:
            return plan.effort.peak_power
        if kind is Kind.FORCE:
            return plan.effort.rms_force if mean else plan.effort.peak_force
        if kind in SUMS:
            return total(plan.pieces, kind, plan.specification.in_si.drive)
        if not mean:
            return max(peak.peak(kind.order) for peak in plan.peaks)
        return sqrt(sum(piece.duration * piece.mean_square(kind.order) for piece in plan.pieces) / plan.duration)

    @answer
    def limits_taken(self) -> tuple[LimitTaken, ...]:
        """The use of every limit, by the segment that takes most of it; of a motor, those of the `sheet`.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> moves = [Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")]
        >>> cycle = Cycle(moves, period="0.25 s", limits={"velocity": "1 m/s", "acceleration": "25 m/s^2"})
        >>> [(taken.name, round(taken.share, 4)) for taken in cycle.limits_taken]
        [('velocity', 0.7), ('acceleration', 0.8796)]
        """
        return limits_taken(self.solve())

    @answer
    def lower_bound(self) -> float | None:
        """The lower bound of laws of the `search_space` in the same times; with friction, that never turn back.

        Laws that are not in it may be below: of a higher degree, of a lower order, of more pieces.
        """
        plan, cycle = self.solve(), self.solve().specification
        if plan.bound is not None or (plan.laws and cycle.in_si.shares):
            return plan.bound
        laws = tuple((piece, solution) for _, piece, solution in plan.laws)
        return bound_of(cycle.layout, laws, cycle.in_si, cycle.duration)

    @answer
    def search_space(self) -> str | None:
        """The laws, in words, of which none is below the `lower_bound` nor, where the status is optimal, better.

        None where no law was looked for. "All motions through the joints" are all whose derivatives before the one that
        is minimised are continuous.

        Examples
        --------
        >>> from optlaws import Cycle, Free
        >>> ways = [Free("30 mm", "0.2 s"), Free("-30 mm")]
        >>> [Cycle(ways, period="0.5 s", minimise=what).search_space for what in ("rms jerk", "jerk")]
        ['all motions through the joints', 'splines of degree 3 in 48 pieces']
        """
        plan, spaces = self.solve(), []
        for span, piece, solution in plan.laws:
            fastest = max(abs(velocity) for velocity, _ in piece.extremes(1, piece.start, piece.stop))
            spaces.append(search_space(solution.problem, span, plan.specification.order, fastest))
        return "; ".join(dict.fromkeys(spaces)) or None

    @answer
    def remarks(self) -> tuple[str, ...]:
        """The choices beyond the request: a raised degree, or the selection among several optimal laws.

        Examples
        --------
        >>> from optlaws import ConstantVelocity, Cycle, Return
        >>> Cycle([ConstantVelocity("1.5 m/s", "80 ms"), Return()], period="400 ms").remarks
        ('segment 2 (Return): Z has the degree 15, not 9, for the velocities at its ends',)
        """
        plan, cycle = self.solve(), self.solve().specification
        problems = [(span, solution.problem) for span, _, solution in plan.laws]
        stricter = not all(is_exact(span, cycle.in_si) for span in cycle.layout.spans)
        return (*remark_on_degrees(problems, cycle.degree), *plan.chosen, *((_STRICTER,) if stricter else ()))

    @answer
    def peaks(self) -> tuple[SegmentPeaks, ...]:
        """Every segment in its place, with its least and greatest values."""
        cycle = self.solve().specification
        return segments_in_place(cycle.programme, cycle.layout.starts, self.pieces)

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu, up to the jerk, in SI units."""
        nu = derivative(nu)
        if nu > 3:
            raise InputError(f"nu must be at most 3, the jerk, got {nu}")
        return max(peak.peak(nu) for peak in self.peaks)

    @answer
    def joints(self) -> tuple[dict[str, Any], ...]:
        """Every joint: its time, and the jumps of velocity, acceleration and jerk there; 0 where continuous."""
        joints = []
        for start in self.solve().specification.layout.starts[:-1]:
            jumps: dict[str, float] = {"time": start}
            for nu, name in enumerate(QUANTITIES[1:], start=1):
                size = self._jump(start, nu)
                jumps[name] = 0.0 if abs(size) <= JUMP * self.peak(nu) else size
            joints.append(jumps)
        return tuple(joints)

    def _jump(self, start: float, nu: int) -> float:
        """The jump of a derivative, between pieces or inside a law of several segments."""
        for i, piece in enumerate(self.pieces):
            if piece.start == start:
                return piece.end(nu, 0) - self.pieces[i - 1].end(nu, 1)
        return next(piece.jump(start, nu) for piece in self.pieces if piece.start < start < piece.stop)

    @answer
    def load_motion(self) -> MachineMotion:
        """The steady motion of the load over time in seconds: its outputs by their names, in SI units.

        Examples
        --------
        >>> from optlaws import Cycle, Dwell, Return, Rise
        >>> segments = [Rise("30 mm", "120 deg", law="modified sine"), Dwell("60 deg"), Return(law="modified sine")]
        >>> cycle = Cycle(segments, speed="300 rpm", load={"period": "20 ms", "damping": 0.05})
        >>> cycle.load_motion.peak("acceleration").value, cycle.peak(2)
        (70.889663, 37.313710)
        """
        load = self.solve().specification.in_si.load
        if load is None:
            raise InputError("the cycle has no load: give one, such as load={'period': '20 ms', 'damping': 0.05}")
        return load.motion(self.pieces)

    @answer
    def along(self) -> tuple[PieceEffort, ...]:
        drive = self.solve().specification.in_si.drive
        return tuple(along(drive, piece) for piece in self.pieces)

    @answer
    def effort(self) -> Effort:
        """Force or torque and power that the drive takes."""
        from optlaws.mechanisms.drives.effort import Effort

        if self.solve().drive is None:
            raise InputError("the cycle has no drive: give one, such as drive={'mass': '2 kg', 'gravity': '20 N'}")
        return Effort.of(self.along, self.solve().duration)

    @answer
    def geared_motor(self) -> Drive:
        """The drive with its motor; an `InputError` where it has none."""
        from optlaws.mechanisms.drives.drive_train import Drive

        drive = self.solve().drive
        if not isinstance(drive, Drive):
            raise InputError("the cycle has no motor: give one, as drive=Drive(mechanism, Motor(...), ratio=20)")
        return drive

    @answer
    def sheet(self) -> CycleSheet:
        """The motor sheet of the cycle: torques, speed, powers, energies, and margins to the motor's limits."""
        from optlaws.mechanisms.drives.effort import CycleSheet

        self.geared_motor  # noqa: B018 - a drive without one has no sheet
        return CycleSheet.of(self.along, self.solve().duration)

    @answer
    def efforts(self) -> tuple[SegmentEffort, ...]:
        """Peaks of force and power, the RMS force and the energies of every segment, in SI units."""
        from optlaws.mechanisms.drives.effort import SegmentEffort

        drive = self.solve().specification.in_si.drive
        return tuple(
            SegmentEffort.of([along(drive, each.piece, (each.start, each.stop))], each.duration, name=each.name)
            for each in self.peaks
        )

    def force(self, time: Any) -> Any:
        """Force or torque of the drive at a time in seconds: at the follower or table, the input or the motor."""
        return self._of_drive(time, "force")

    def power(self, time: Any) -> Any:
        """Power of the drive at a time in seconds, W: above 0 where it drives, below where it brakes."""
        return self._of_drive(time, "power")

    @answer
    def smooth_times(self) -> Array:
        """Times between which force and power of the drive are smooth and of one sign, s."""
        return np.unique(np.concatenate([each.parts.edges for each in self.along]))

    def _of_drive(self, time: Any, name: str) -> Any:
        places = np.mod(real_times(time), self.solve().duration)
        return number_or_array(by_pieces(self.pieces, [getattr(each, name) for each in self.along], places))

    def __call__(self, time: Any, nu: int = 0) -> Any:
        """Position (nu 0), velocity, acceleration, jerk at a time in seconds, in SI units; the cycle repeats."""
        plan, times, nu = self.solve(), real_times(time), derivative(nu)
        turns = np.floor(times / plan.duration)
        values = values_of_pieces(plan.pieces, np.clip(times - turns * plan.duration, 0.0, plan.duration), nu)
        return number_or_array(values if nu else values + turns * plan.programme.advance)

    def at_angle(self, degrees: Any, nu: int = 0) -> Any:
        """The motion at an angle of the master, in degrees or a text such as "0.5 rad"; derivatives are by time."""
        turns = quantity(degrees, "angle", "angle") / TURN if isinstance(degrees, str) else real_times(degrees) / 360.0
        return self(turns * self.solve().duration, nu)

    def per_angle(self, degrees: Any, nu: int = 0) -> Any:
        """Derivatives by the master's angle in radians, as cams and controllers take them."""
        return self.at_angle(degrees, nu) * (self.solve().duration / TURN) ** nu

    def at(self, speed: Quantity) -> Cycle:
        """The same motion at another speed of the master: laws are unchanged, durations scale in proportion.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm")
        >>> fast = cycle.at("400 rpm")
        >>> fast.duration, round(fast.peak(2) / cycle.peak(2), 9)
        (0.15, 4.0)
        """
        plan, period = self.solve(), period_of(speed, None)
        segments = retimed_segments(self.peaks, plan.axis, period / plan.duration)
        # laws that are known leave nothing of a load to look for
        minimise = "acceleration" if kind_of(plan.minimise)[0] is Kind.LOAD else plan.minimise
        known: dict[str, Any] = {"segments": segments, "minimise": minimise, "limits": {}}
        return replace(plan.specification, speed=None, period=Exact(period, "s"), **known)

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
        >>> from optlaws import Cycle, Dwell, Move
        >>> moves = [Move("30 mm", "120 deg", law="III(7.2)"), Dwell("60 deg"), Move("-30 mm", law="III(7.2)")]
        >>> round(Cycle(moves, speed="300 rpm").cam("20 ms", damping=0.05).peak(2), 6)
        39.380514
        """
        from optlaws.mechanisms.machine.polydyne import polydyne

        cycle, natural = self.solve().specification, positive_quantity(period, "time", "follower: period")
        if len(self.pieces) != len(self.peaks):
            raise InputError(
                "the cam of an elastic follower is computed move by move: use moves in place of adjacent free motions"
            )

        def corrected(each: SegmentPeaks) -> MotionLaw:
            with located(each.stretch.where):
                return polydyne(each.piece.law, TURN * each.duration / natural, damping)

        segments = retimed_segments(self.peaks, cycle.axis, law=corrected)
        return replace(cycle, segments=segments, speed=None, period=Exact(cycle.duration, "s"))

    def with_motor(self, motor: Motor) -> Plan:
        """The same laws by a motor with other limits: torques and proofs stay, the margins of its sheet are new.

        Raises
        ------
        InputError
            If the cycle has no motor, its laws keep the limits of the motor, or the other motor has another inertia,
            friction or motor constant, so that other laws may be optimal.

        Examples
        --------
        >>> from optlaws import Cycle, Drive, Dwell, Mechanism, Motor, Rise
        >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", rated_torque="2 N m"), ratio=20)
        >>> moves = [Rise("45 deg", "0.25 s", law="modified sine"), Dwell()]
        >>> cycle = Cycle(moves, period="0.6 s", advance="45 deg", drive=drive)
        >>> weak = cycle.with_motor(Motor("3e-4 kg m^2", rated_torque="1 N m"))
        >>> [round(each.sheet.margins[0].use, 6) for each in (cycle, weak)]
        [0.729259, 1.458518]
        """
        from optlaws.mechanisms.drives.motor import OF_TORQUE

        plan, source = self.solve(), self.geared_motor
        if plan.limits.get(MOTOR):
            raise InputError("the laws keep the limits of the motor: make the cycle anew with the other motor")
        if any(getattr(motor, name) != getattr(source.motor, name) for name in OF_TORQUE):
            raise InputError(
                f"the motor has another {', '.join(OF_TORQUE[:-1])} or {OF_TORQUE[-1]}: make the cycle anew"
            )
        return replace(plan, specification=replace(plan.specification, drive=replace(source, motor=motor)))

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
        >>> from optlaws import Cycle, Return, Rise
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
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "180 deg", law="cycloidal"), Return(law="cycloidal")], speed="90 rpm")
        >>> stop = cycle.run_out("270 deg", rest="0 mm", over="100 deg")
        >>> stop, round(stop(0.0, 1), 9), stop(stop.duration, 1)
        (TransitionCam('run-out', 270 to 370 deg of the master, 0.185185 s, status='optimal'), -0.21, 0.0)
        """
        return self._transition("run-out", Transition(at, rest, over, order))

    def _transition(self, kind: TransitionKind, given: Transition) -> TransitionCam:
        from optlaws.cycles.transitions import transition_cam

        cycle = self.solve().specification
        return transition_cam(kind, cycle.programme, self.pieces, cycle.in_si, given)

    def motion(self, master: Quantity | None = "360 deg", unit: str | None = None) -> Motion:
        from optlaws.motion.motion import motion_of_pieces

        plan, proof = self.solve(), tuple[str, ...]()
        if plan.solutions:
            bound = "" if plan.lower_bound is None else f", none below {plan.lower_bound:.9g}"
            least = f"least {plan.minimise} {plan.objective:.9g}{bound} (SI units) of {plan.search_space}"
            proof = (f"laws looked for: {len(plan.solutions)}, status {plan.status.value}; {least}", *plan.remarks)
        return motion_of_pieces(plan.pieces, plan.duration, plan.axis, master=master, unit=unit, proof=proof)

    def report(self) -> Report:
        from optlaws.cycles.report import CycleReport

        return CycleReport(self.solve())

    def plot(self, ax: Any = None, *, over: PlotOver = "time", **style: Any) -> list[Any]:
        """Draw position, velocity, acceleration and jerk over time, with segments and limits; return the artists.

        `ax` are four axes of matplotlib, six of a cycle with a drive, which have torque and power as well, or one for
        all, where every curve is divided by its peak; a new figure unless given. Over the "speed" it is torque over
        speed at the motor, with the motor's curves, into one pair of axes. `style` is what `Axes.plot` takes, for the
        curves.

        Raises
        ------
        InputError
            If the cycle has no motor, or is drawn over something else.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> [artist.axes.get_ylabel() for artist in cycle.plot()][2]
        'acceleration, m/s²'
        """
        from optlaws.plots.cycle import draw_cycle
        from optlaws.plots.machine import draw_motor_of_cycle

        check_names([over], get_args(PlotOver), "over")
        return (draw_cycle if over == "time" else draw_motor_of_cycle)(self.solve(), ax, **style)

    def to_pandas(self) -> Any:
        """A data frame with a row for each segment: start, duration, end, peaks, jumps; SI units.

        Needs the extra `optlaws[studies]`.
        """
        pd, plan = needed("pandas", "to_pandas"), self.solve()
        units = {name: unit_of(plan.axis, nu) for nu, name in enumerate(QUANTITIES)}
        rows = []
        for peaks, joint in zip(plan.peaks, plan.joints, strict=True):
            row = {"segment": peaks.name, "start, s": peaks.start, "duration, s": peaks.duration}
            row |= {f"peak {name}, {units[name]}": peaks.peak(nu) for nu, name in enumerate(QUANTITIES)}
            rows.append(row | {f"jump of {name}, {units[name]}": joint[name] for name in QUANTITIES[1:3]})
        for row, taken in zip(rows, plan.efforts if plan.drive is not None else (), strict=False):
            name, unit = FORCES[plan.axis], FORCE_UNITS[plan.axis]
            row |= {f"peak {name}, {unit}": taken.peak_force, f"RMS {name}, {unit}": taken.rms_force}
            row |= {"motoring power, W": taken.motoring_power, "braking power, W": taken.braking_power}
        return pd.DataFrame(rows)


@declared
class Cycle(Answers, Specification):
    """A cycle that repeats: segments and the speed of the master, of which `solve` makes a plan that answers.

    Positions are lengths or angles, whichever the first displacement is. What a plan answers a cycle forwards to its
    plan, which is looked for when it is first needed; between joints that are known the cycle decouples, and each law
    is proven by itself.

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

    __repr__ = Specification.__repr__

    def solve(self) -> Plan:
        """The plan with the best laws, which answers everything else; it is looked for once.

        Raises
        ------
        InfeasibleProblem
            If a given law breaks a limit, or no law keeps one.

        Examples
        --------
        >>> from optlaws import Return, Rise
        >>> Cycle([Rise("35 mm", "0.1 s"), Return()], period="0.25 s").solve()
        Plan(Cycle([Rise, Return], period=0.25 s, minimise='acceleration'), status='optimal')
        """
        return self._plan

    @kept_property
    def _plan(self) -> Plan:
        refuse_beyond(self)
        return replace(self.unchecked(), checked=True)

    def unchecked(self) -> Plan:
        """The plan, of which given laws that break limits are not refused but reported.

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
        return self._unchecked

    @kept_property
    def _unchecked(self) -> Plan:
        best = best_of(self.layout, self.in_si, self.duration)
        solutions = tuple(solution for _, solution in best.laws)
        return Plan(self, solutions, chosen=best.remarks, bound=best.bound)

    def with_solutions(self, solutions: Sequence[Solution]) -> Plan:
        """The plan with other solutions of its motions, such as solutions of problems with further bounds.

        Objective, bound and status are recomputed from them, which are as many as `solutions`.

        Examples
        --------
        >>> from optlaws import Return, Rise, at_most, synthesize
        >>> cycle = Cycle([Rise("35 mm", "0.1 s"), Return(law="cycloidal")], period="0.3 s")
        >>> (solution,) = cycle.solutions
        >>> smooth = cycle.with_solutions([synthesize(replace(solution.problem, J=at_most(60)))])
        >>> [[round(each.peaks[0].peak(nu), 3) for nu in (2, 3)] for each in (cycle, smooth)]
        [[14.537, 20353.531], [17.073, 2100.0]]
        """
        return Plan(self, solutions)

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

        return fastest_cycle(self)

    def front(
        self,
        minimise: str,
        *,
        longest: Quantity | None = None,
        points: int = 17,
        follower: Mapping[str, Any] | None = None,
    ) -> TimeFront:
        """The least of a quantity over the time of a cycle of one move, from its least time within the limits on.

        The limits are those that `fastest` of a move takes, with a `Drive` those of its motor too; parameters, result
        and errors are those of `time_front`.

        Raises
        ------
        InputError
            If there are several segments, a known law, or a limit that is of no single move.

        Examples
        --------
        >>> from optlaws import Rise
        >>> limits = {"velocity": "1 m/s", "jerk": "300 m/s^3"}
        >>> move = Cycle([Rise("100 mm")], period="0.3 s", advance="100 mm", limits=limits)
        >>> front = move.front("rms acceleration", points=3)
        >>> round(front.fastest.duration, 6) == round(move.fastest().period, 6), round(front.values[0], 2)
        (True, 8.92)
        """
        from optlaws.cycles.moves.time_front import front_of_cycle

        return front_of_cycle(self, minimise, longest=longest, points=points, follower=follower)

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
        # rounded upward
        most = f"{self.modified_sine_jerk * (1.0 + 10.0**-_DIGITS):.{_DIGITS + 1}g}"
        return replace(self, limits={**self.limits, "jerk": f"{most} {unit_of(self.axis)}/s^3"})


@declared
class Plan(Answers, Declared, title="a plan"):
    """The laws of a cycle in their places, which answer what the cycle asks; `Cycle.solve` looks for the best.

    Parameters
    ----------
    bound
        The lower bound of laws of the search space; by the solutions unless given.
    checked
        Whether all laws are known to keep the limits; else the status says whether they do, as of a plan that is read.

    Examples
    --------
    >>> from optlaws import Return, Rise
    >>> plan = Cycle([Rise("35 mm", "0.1 s"), Return()], period="0.25 s").solve()
    >>> plan.status.value, round(plan.objective, 6), round(plan.lower_bound, 6), len(plan.pieces)
    ('optimal', 15.197111, 15.197111, 2)
    >>> Plan.from_json(plan.to_json()).objective == plan.objective
    True
    """

    specification: Cycle = entry(ValueOf(Cycle), "What is asked; its entries are those of the plan too.", name="cycle")
    solutions: Sequence[Solution] = entry(  # type: ignore[assignment] # the field in place of the answer
        Listed(ValueOf(Solution)), "Of each motion without a given law, in order, with its proof.", default=()
    )
    _: KW_ONLY
    chosen: Sequence[str] = entry(Listed(Text()), "The selection among several optimal laws, in words.", default=())
    bound: float | None = field(default=None, compare=False)
    checked: bool = field(default=False, compare=False)

    # the cycle's own, under the same names
    segments = kept_property[Sequence[CycleSegment]](lambda plan: plan.specification.segments)
    minimise = kept_property[str](lambda plan: plan.specification.minimise)
    limits = kept_property[Mapping[str, Any]](lambda plan: plan.specification.limits)
    load = kept_property[Any](lambda plan: plan.specification.load)
    programme = kept_property[Programme](lambda plan: plan.specification.programme)
    axis = kept_property[str](lambda plan: plan.specification.axis)
    duration = kept_property[float](lambda plan: plan.specification.duration)
    durations = kept_property[tuple[float, ...]](lambda plan: plan.specification.durations)
    limits_of_segments = kept_property[tuple[dict[int, tuple[float, float]], ...]](
        lambda plan: plan.specification.limits_of_segments
    )

    @property
    def drive(self) -> Mapping[str, Any] | Mechanism | Drive | None:
        """What the motion drives, as the cycle has it."""
        return self.specification.drive

    def _check(self) -> None:
        spans = self.specification.layout.spans
        if len(self.solutions) != len(spans):
            raise InputError(f"the cycle has {len(spans)} optimised motions, got {len(self.solutions)} solutions")

    def solve(self) -> Plan:
        """The plan itself, which is solved."""
        return self

    @kept_property
    def laws(self) -> tuple[tuple[LawSpan, Piece, Solution], ...]:
        """The spans whose laws were looked for, each with its law in its place and its solution."""
        return tuple(
            (span, span.by(solution.law), solution)
            for span, solution in zip(self.specification.layout.spans, self.solutions, strict=True)
        )

    def contradiction(self) -> str:
        """What of its laws contradicts its cycle; empty where they meet its joints and keep its limits."""
        cycle = self.specification
        for span, _, solution in self.laws:
            known = span_problem(span, cycle.in_si)
            if solution.problem.boundary != known.boundary:
                return f"{span.where}: its solution has other ends than its joints"
        return "; ".join(f"{taken} is beyond its limit" for taken in self.limits_taken if not taken.is_kept)

    def with_solutions(self, solutions: Sequence[Solution]) -> Plan:
        """The plan of the same cycle with other solutions, as `Cycle.with_solutions`."""
        return self.specification.with_solutions(solutions)

    def to_dict(self) -> dict[str, Any]:
        """The cycle with its solutions, plain and JSON-able, without the names of their formats."""
        data = super().to_dict()
        del data["cycle"]["format"]
        return data

    def __repr__(self) -> str:
        return f"Plan({self.specification!r}, status={self.status.value!r})"
