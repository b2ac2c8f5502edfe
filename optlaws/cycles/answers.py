"""What a plan answers: its laws in their places, their values, their proofs, the drive, and the forms it leaves in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf, sqrt
from typing import TYPE_CHECKING, Any, Literal, Self, TypeVar, get_args

import numpy as np

from optlaws.cycles.optimisation.objectives import SUMS, check_objective, kind_of
from optlaws.cycles.optimisation.optimal import remark_on_degrees, search_space
from optlaws.cycles.optimisation.span_values import (
    BOUND_ROUNDING,
    along,
    bound_of,
    is_certified,
    is_exact,
    total,
)
from optlaws.cycles.placed import SegmentPeaks, limits_taken, segments_in_place
from optlaws.cycles.specification.limits import FORCE_UNITS, FORCES, LOAD, LimitTaken
from optlaws.cycles.specification.programme import LawSpan, Programme
from optlaws.cycles.specification.segments import CycleSegment, Transition
from optlaws.cycles.specified import Specification
from optlaws.entries.declared import documented_by
from optlaws.errors import InputError, needed
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.motion.motion import Exportable, Motion, motion_of_pieces
from optlaws.motion.piece import Piece, by_pieces, unit_of, values_of_pieces
from optlaws.motion.quantities import QUANTITIES, TURN, Kind, quantity
from optlaws.numbers import Array, Quantity, derivative, number_or_array, real_times
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.status import Status
from optlaws.tolerances import CYCLE_OPTIMALITY, INSIDE_PIECE, JUMP

if TYPE_CHECKING:
    from optlaws.cycles.transitions import TransitionCam, TransitionKind
    from optlaws.mechanisms.drives.drive_train import Drive
    from optlaws.mechanisms.drives.effort import CycleSheet, Effort, PieceEffort, SegmentEffort
    from optlaws.mechanisms.linkages.mechanism import Mechanism
    from optlaws.mechanisms.machine.over_time import MachineMotion
    from optlaws.shown.report import Report

#: what a picture of a cycle is over
PlotOver = Literal["time", "speed"]
T = TypeVar("T")
#: names of lower bounds, which a verification proves with every rounding enclosed or computes again in doubles
PROVEN_BOUND, BOUND_IN_DOUBLES = "proven lower bound", "lower bound in doubles"
_STRICTER = (
    "The gear has losses and carries a load. Where the motor brakes, the search counts the torque as if all power "
    "flowed back through the gear, which is never less than the torque itself. The lower bound does without this, and "
    "is that of all laws that never turn back."
)


class answer(kept_property[T]):  # noqa: N801 - as the one of functools
    """A property of a plan, computed once, which whatever has a plan forwards to it."""

    if not TYPE_CHECKING:

        def __get__(self, instance: Answers | None, owner: type | None = None) -> Any:
            return super().__get__(None if instance is None else instance.solve(), owner)


class Answers(Exportable):
    """The motion of a plan: call it for position, velocity, acceleration or jerk in SI units over time."""

    def solve(self) -> Solved:
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
        bound = self._bound
        # a law that is given, or one of another span, may decide what a law that is local does not
        if self.solutions and worst in {Status.OPTIMAL, Status.LOCAL} and bound is not None:
            return Status.OPTIMAL if self.objective <= bound * (1.0 + CYCLE_OPTIMALITY) else Status.LOCAL
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

        Laws that are not in it may be below: of a higher degree, of a lower order, of more pieces. None where nothing
        is proven: of what cannot be below 0, a bound of 0 says nothing.
        """
        bound, kind = self._bound, kind_of(self.solve().minimise)[0]
        if bound is None or bound == -inf:
            return None
        nothing = kind is not Kind.ENERGY and bound <= BOUND_ROUNDING * self.objective
        return None if nothing and self.objective > 0.0 else bound

    @answer
    def lower_bound_name(self) -> str:
        """What its lower bound is called: proven where the certificates of its laws alone prove it.

        Others, of laws that share a limit or of drives whose friction no law determines, are computed in doubles from
        more than these; `optlaws verify` uses the same words.
        """
        plan, cycle = self.solve(), self.solve().specification
        laws = tuple((piece, solution) for _, piece, solution in plan.laws)
        alone = plan.bound is None and not cycle.in_si.shares and is_certified(cycle.layout, laws, cycle.in_si)
        return PROVEN_BOUND if alone else BOUND_IN_DOUBLES

    @answer
    def _bound(self) -> float | None:
        """The lower bound as it is computed, be it nothing; None where none is."""
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
        _, places = _in_the_cycle(real_times(time), self.solve().duration)
        return number_or_array(by_pieces(self.pieces, [getattr(each, name) for each in self.along], places))

    def __call__(self, time: Any, nu: int = 0) -> Any:
        """Position (nu 0), velocity, acceleration, jerk at a time in seconds, in SI units; the cycle repeats."""
        plan, times, nu = self.solve(), real_times(time), derivative(nu)
        turns, places = _in_the_cycle(times, plan.duration)
        values = values_of_pieces(plan.pieces, places, nu)
        return number_or_array(values if nu else values + turns * plan.programme.advance)

    def at_angle(self, degrees: Any, nu: int = 0) -> Any:
        """The motion at an angle of the master, in degrees or a text such as "0.5 rad"; derivatives are by time."""
        turns = quantity(degrees, "angle", "angle") / TURN if isinstance(degrees, str) else real_times(degrees) / 360.0
        return self(turns * self.solve().duration, nu)

    def per_angle(self, degrees: Any, nu: int = 0) -> Any:
        """Derivatives by the master's angle in radians, as cams and controllers take them."""
        return self.at_angle(degrees, nu) * (self.solve().duration / TURN) ** nu

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
        plan, proof = self.solve(), tuple[str, ...]()
        if plan.solutions:
            bound = "" if plan.lower_bound is None else f", lower bound {plan.lower_bound:.9g}"
            least = f"least {plan.minimise} {plan.objective:.9g}{bound} in SI units, over all {plan.search_space}"
            proof = (f"{len(plan.solutions)} optimised laws, status {plan.status.value}: {least}", *plan.remarks)
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


class Solved(Answers):
    """What answers take of a plan: the cycle that it solves, and the laws of it."""

    specification: Specification
    chosen: Sequence[str]
    bound: float | None
    checked: bool

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

    def solve(self) -> Self:
        """The plan itself, which is solved."""
        return self

    @kept_property
    def laws(self) -> tuple[tuple[LawSpan, Piece, Solution], ...]:
        """The spans whose laws were looked for, each with its law in its place and its solution."""
        return tuple(
            (span, span.by(solution.law), solution)
            for span, solution in zip(self.specification.layout.spans, self.solutions, strict=True)
        )


def _in_the_cycle(times: Array, period: float) -> tuple[Array, Array]:
    """Turns that are done, and the time since; the end of a turn, but for rounding, is the beginning of the next."""
    shares = times / period
    whole = np.rint(shares)
    turns = np.where(np.abs(shares - whole) <= INSIDE_PIECE * np.maximum(np.abs(whole), 1.0), whole, np.floor(shares))
    return turns, np.clip(times - turns * period, 0.0, period)
