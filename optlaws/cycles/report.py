"""The report of a cycle: its facts, the table of its segments, its motion, and its curves in units for display."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from optlaws.cycles.answers import PROVEN_BOUND, Answers
from optlaws.cycles.optimisation.objectives import SUMS, kind_of
from optlaws.cycles.optimisation.span_values import has_torque_limit
from optlaws.cycles.placed import Place, broken_limits, limit_rows, overloads
from optlaws.cycles.specification.limits import FORCE_UNITS, FORCES, LOAD, LimitTaken
from optlaws.cycles.specification.load import is_process, read_load
from optlaws.cycles.specified import USUAL_DEGREE
from optlaws.cycles.usual_law import usual_cycle, why_without_usual_law
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.formulas.tree import Number
from optlaws.kept import kept_property
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.derivative_panel import DERIVATIVES, display_unit, motion_panel, picture_unit, times_in
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import MILLI, QUANTITIES, RPM, TURN, TURN_DEG, UNITS, Derived, Kind
from optlaws.numbers import Array, bounded, chop, chopped
from optlaws.sentences import quantity_name
from optlaws.shown.curve_points import refined
from optlaws.shown.difference import Difference, Differences
from optlaws.shown.report import Panel, PanelLimit, ReportSegment, ReportTable, Series
from optlaws.shown.summary import Row, Summary
from optlaws.synthesis.spaces.bases import PolynomialBasis
from optlaws.synthesis.status import Status
from optlaws.tolerances import CYCLE_ROUNDING, INSIDE_PIECE

if TYPE_CHECKING:
    from optlaws.cycles.answers import Solved
    from optlaws.cycles.cycle import Plan
    from optlaws.cycles.fastest_cycle import FastestCycle
    from optlaws.cycles.specified import Specification
    from optlaws.cycles.transitions import TransitionCam

_ACCELERATION, _JERK = 2, 3
_LOAD_UNITS = {
    "length": "m",
    "angle": "rad",
    "acceleration": "m/s²",
    "angular acceleration": "rad/s²",
    "force": "N",
    "torque": "N m",
}
#: what the input of a mechanism is, by its name
_INPUTS = {"rack": "pinion", "belt": "pulley", "screw": "screw", "cam": "cam"}
_INPUTS |= dict.fromkeys(("slider-crank", "four-bar", "toggle"), "crank")
_WIDE_GAP = 0.05  # between the objective and its bound
_RICHER = "laws of a higher degree may take less: give degree = 21 in [[axis]], or in [motion] of a cam"
_BOTH_WAYS = 0.01  # of the work against a load: if more comes back, it acts on the way back too
_EACH = 60  # samples of a piece, to which those are added that its curve needs


class CycleReport:
    """The report of a cycle, whose parts are computed when they are needed."""

    def __init__(self, motion: Answers) -> None:
        self.plan = motion.solve()
        self.units = UNITS[self.plan.axis]

    @kept_property
    def facts(self) -> Summary:
        """The proof of the cycle, its peaks, its limits, its drive and its joints, with places as times in seconds."""
        parts: list[Any] = [proof_rows, peak_rows, jerk_rows, limit_rows, drive_rows, joint_rows]
        return Summary([*(row for rows in parts for row in rows(self.plan)), *self.worse], at="s")

    @kept_property
    def tables(self) -> tuple[ReportTable, ...]:
        """The segments with their ends and their peaks, and the whole cycle."""
        plan, (unit, factor), rows = self.plan, self.units[0], list[list[Any]]()
        for each, position in zip(plan.peaks, plan.programme.offsets[1:], strict=True):
            size = factor * max(abs(position), abs(plan.peak(0)))
            times = [MILLI * each.start, MILLI * each.duration, TURN_DEG * each.duration / plan.duration]
            peaks = [each.peak(nu) * self.unit(nu)[1] for nu in self.orders[1:]]
            rows.append([each.name, *times, chop(factor * position, size, CYCLE_ROUNDING), *peaks])
        sized = [f"peak {DERIVATIVES[nu]}, {self.unit(nu)[0]}" for nu in self.orders[1:]]
        headings = ["segment", "from, ms", "takes, ms", "takes, deg", f"ends at, {unit}", *sized]
        whole = map(max, zip(*(row[-len(sized) :] for row in rows), strict=True))
        last = ["whole cycle", 0.0, MILLI * plan.duration, TURN_DEG, None, *whole]
        segments = ReportTable(headings, [*rows, last])
        return (segments,) if self.beside is None else (segments, self.beside.table)

    @kept_property
    def beside(self) -> Differences | None:
        """What the laws take beside modified sine in the same moves.

        None where no law was looked for, or modified sine is not possible.
        """
        plan = self.plan
        cycle: Any = plan.specification
        usual = usual_cycle(cycle) if plan.solutions else None
        return None if usual is None else cycle_differences(USUAL, usual.unchecked(), plan)

    @property
    def worse(self) -> list[Row]:
        """The remarks on modified sine: what it is better in, which limits it breaks, why it cannot stand beside."""
        if self.beside is not None:
            return self.beside.remark_rows
        specification: Any = self.plan.specification
        why = why_without_usual_law(specification) if self.plan.solutions else ""
        return [Row("remark", why)] if why else []

    def motion(self, count: int) -> ReportTable:
        """Angle, time, position, velocity, acceleration and jerk at equal steps over the cycle.

        With a drive force (or torque) and power, with a motor its speed too; with an elastic load its outputs.
        """
        return motion_table(
            self.plan, (0.0, TURN_DEG), count, lambda times: self._of_drive(times) | self._of_load(times)
        )

    def _of_load(self, times: Array) -> dict[str, Array]:
        plan = self.plan
        if plan.specification.in_si.load is None:
            return {}
        outputs = plan.load_motion.outputs
        return {f"{name} of the load, {load_unit(plan, name)}": plan.load_motion[name](times) for name in outputs}

    def _of_drive(self, times: Array) -> dict[str, Array]:
        plan = self.plan
        if plan.drive is None:
            return {}
        known = {
            f"{FORCES[plan.axis]}, {FORCE_UNITS[plan.axis]}": np.asarray(plan.force(times)),
            "power, W": np.asarray(plan.power(times)),
        }
        if isinstance(plan.drive, Drive):
            known["motor speed, rpm"] = RPM * plan.drive.ratio * np.asarray(plan(times, 1))
        return known

    @kept_property
    def segments(self) -> tuple[ReportSegment, ...]:
        """The segments with their times."""
        return tuple(ReportSegment(each.name, each.start, each.stop) for each in self.plan.peaks)

    @property
    def panels(self) -> tuple[Panel, ...]:
        """Position, velocity, acceleration and jerk; with a drive its force (or torque) and its power."""
        axis = self.plan.axis
        return (*(self.panel(nu, picture_unit(axis, nu)) for nu in range(len(QUANTITIES))), *self.driven)

    @kept_property
    def driven(self) -> tuple[Panel, ...]:
        """The force (or torque) and the power of the drive; none without a drive."""
        plan = self.plan
        if plan.drive is None:
            return ()
        at = plan.effort.peak_force_at
        peak = float(plan.force(at))
        force = Panel(FORCES[plan.axis], FORCE_UNITS[plan.axis], (self._driven(plan.force),), peaks=((at, peak),))
        ends = -plan.effort.braking_power, plan.effort.motoring_power
        return force, Panel("power", "W", (self._driven(plan.power),), ends=ends)

    @property
    def of_input(self) -> tuple[Panel, ...]:
        """Force (or torque) and power of the drive, the speed of its motor or its input, and the input's position."""
        speed, unit = "velocity of the input", self.unit(1)
        if isinstance(self.plan.drive, Drive):
            speed, unit = "speed of the motor", ("rpm", RPM * self.plan.drive.ratio)
        motion = {speed: self.panel(1, unit), "position of the input": self.panel(0)}
        return (*self.driven, *(replace(each, name=name, limits=(), peaks=()) for name, each in motion.items()))

    def least_efforts(self) -> list[tuple[ReportSegment, tuple[float, float | None], tuple[float, float | None]]]:
        """Peak and rms of the force in each move from rest to rest on a mechanism, each with its infimum where known.

        That is of laws that never turn back. Empty of a process, which acts on the whole cycle.
        """
        plan, efforts = self.plan, list[Any]()
        if is_process(plan.load) or not isinstance(plan.drive, Mechanism | Drive):
            return []
        for segment, each, effort in zip(self.segments, plan.peaks, plan.efforts, strict=True):
            moved, ends = each.stretch.displacement, np.abs(each.piece.values(np.array(segment[1:]), 1)).max()
            if moved and ends <= CYCLE_ROUNDING * plan.peak(1):
                move = float(plan(each.start)), moved, each.duration
                peak, rms = (_infimum(plan.drive, name, move) for name in ("peak torque", "rms torque"))
                efforts.append((segment, (effort.peak_force, peak), (effort.rms_force, rms)))
        return efforts

    @property
    def duration(self) -> float:
        return self.plan.duration

    @property
    def demands(self) -> list[Row]:
        return [*peak_rows(self.plan), *drive_rows(self.plan)]

    @property
    def limits_taken(self) -> tuple[LimitTaken, ...]:
        return self.plan.limits_taken

    def shares(self, times: Array) -> dict[str, Array]:
        """The share of the limits of derivatives in each segment that is taken at each time."""
        taken: dict[str, Array] = {}
        for nu in self.orders[1:]:
            share, values = np.zeros(len(times)), np.asarray(self.plan(times, nu))
            for (_, start, stop), limits in zip(self.segments, self.plan.limits_of_segments, strict=True):
                low, high = limits.get(nu, (-inf, inf))
                inside = (times >= start) & (times <= stop)
                uses = [values / side for side in (low, high) if side]
                share = np.where(inside, np.maximum.reduce([share, *uses]), share)
            if share.any():
                taken[DERIVATIVES[nu]] = share
        return taken

    @property
    def orders(self) -> range:
        """The orders of the derivatives that are shown: up to the jerk, or to the one of highest order with a limit."""
        limited = (nu + 1 for limits in self.plan.limits_of_segments for nu in limits)
        return range(max(len(QUANTITIES), *limited, 0))

    def unit(self, nu: int) -> tuple[str, float]:
        """The unit of a derivative, and how many of it are one of SI."""
        return display_unit(self.plan.axis, nu)

    def extremes(self, nu: int) -> list[tuple[Place, Place]]:
        """The least and the greatest value of a derivative in each segment, with their times."""
        return [each.ends(nu) for each in self.plan.peaks]

    def panel(self, nu: int, unit: tuple[str, float] | None = None) -> Panel:
        """A derivative of the motion, through its extremes, with the limits of the segments."""
        limits = [
            PanelLimit(segment.start, segment.stop, *limited[nu])
            for segment, limited in zip(self.segments, self.plan.limits_of_segments, strict=True)
            if nu in limited
        ]
        extremes = [place for ends in self.extremes(nu) for place in ends]
        return motion_panel(self.plan.pieces, nu, unit or self.unit(nu), extremes, limits)

    def _driven(self, function: Callable[[Array], Array]) -> Series:
        """Force or power through the peak of the force, and its kinks, at times as for a derivative."""
        plan = self.plan
        times = [times_in(piece, _EACH) for piece in plan.pieces]
        # the end of a piece has its values, not those of the next
        ends = [piece.stop - INSIDE_PIECE * plan.duration for piece in plan.pieces]
        values = [function(np.minimum(inside, end)) for inside, end in zip(times, ends, strict=True)]
        marks = np.array([plan.effort.peak_force_at])
        at, (drawn,) = refined(
            np.concatenate(times), [np.concatenate(values)], [lambda inside: np.asarray(function(inside))], marks
        )
        return Series(at, drawn)

    @kept_property
    def data(self) -> dict[str, Any]:
        """The cycle for programs, in SI units."""
        plan = self.plan
        drive: dict[str, Any] = {} if plan.drive is None else {"effort": plan.effort.to_dict()}
        if isinstance(plan.drive, Drive):
            drive["motor"] = plan.sheet.to_dict()
        if loaded := load_peaks(plan):
            drive["load"] = loaded
        return {
            "period": plan.duration,
            "status": plan.status.value,
            "minimise": plan.minimise,
            "objective": plan.objective if plan.solutions else None,
            "lower_bound": plan.lower_bound if plan.solutions else None,
            "search_space": plan.search_space,
            "remarks": list(plan.remarks),
            "modified_sine_jerk": plan.specification.modified_sine_jerk,
            **({} if self.beside is None else self.beside.data),
            "segments": [
                {"name": peak.name, "start": peak.start, "duration": peak.duration}
                | {name: bounded(peak.peak(nu)) for nu, name in enumerate(QUANTITIES) if nu}
                for peak in plan.peaks
            ],
            "joints": [{name: bounded(value) for name, value in joint.items()} for joint in plan.joints],
            **drive,
        }

    @property
    def stored(self) -> dict[str, Any]:
        """The plan with its solutions and proofs, its numbers, and its laws in their places."""
        laws = [
            {"start": piece.start, "duration": piece.duration, "offset": piece.offset, "stroke": piece.stroke,
             "law": piece.law.to_dict()}
            for piece in self.plan.pieces
        ]  # fmt: skip
        plan: Any = self.plan
        return {**plan.to_dict(), **self.data, "laws": laws}


class FastestReport(CycleReport):
    """The report of a cycle at its greatest speed."""

    def __init__(self, fastest: FastestCycle) -> None:
        super().__init__(fastest.cycle)
        self.fastest = fastest

    @kept_property
    def facts(self) -> Summary:
        """The speed with what is proven of it, the gain from a tenth more of each limit, and the motions' times."""
        fastest = self.fastest
        rows = [Row("status", fastest.status.value), *fastest.proof_rows(), *self.worse]
        rows += [Row("would give", str(gain)) for gain in fastest.gains]
        return Summary([*rows, *(each.row for each in fastest.segments)])

    @kept_property
    def beside(self) -> Differences | None:
        """The cycle beside modified sine at its own greatest speed; None where that is not possible."""
        given: Any = self.fastest.specification
        usual = usual_cycle(given)
        if usual is None:
            return None
        try:
            slower = replace(usual, limits=given.limits).fastest()
            taken = cycle_differences(USUAL, slower.solve(), self.plan)
        except (InfeasibleProblem, InputError, SolverFailure):
            return None
        fastest, known = self.fastest, [("greatest speed", "rpm", "rpm"), ("least period", "s", "period")]
        times = [Difference(name, unit, getattr(slower, of), getattr(fastest, of)) for name, unit, of in known]
        return Differences(USUAL, [*times, *taken.values], "least period")

    @kept_property
    def data(self) -> dict[str, Any]:
        """The greatest speed for programs, in SI units."""
        fastest = self.fastest
        return {
            "status": fastest.status.value,
            **{name: getattr(fastest, name) for name in ("speed", "rpm", "period", "lower_bound", "best_possible")},
            "gains": [vars(gain) for gain in fastest.gains],
            **({} if self.beside is None else self.beside.data),
            "segments": [each.to_dict() for each in fastest.segments],
        }


def _infimum(drive: Mechanism | Drive, name: Literal["peak torque", "rms torque"], move: Any) -> float | None:
    try:
        least = drive.limit(name, *move).value
    except OptlawsError:
        return None
    return least if least > 0.0 else None


def cycle_differences(name: str, usual: Solved, chosen: Solved) -> Differences:
    """What two motions of one cycle take: peaks, and where there are such the drive's and the load's; the usual first.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise
    >>> best, sine = (Cycle([Rise("1 m", "1 s", law=law), Return(law=law)], period="2 s") for law in ("optimal", "MS"))
    >>> [(each.name, each.text) for each in cycle_differences("modified sine", sine.solve(), best.solve()).values]
    [('acceleration', '-21.5 %'), ('velocity', '+4.7 %'), ('jerk', '+314.6 %'), ('rms acceleration', '-1.6 %')]
    """
    cycle, force = chosen.specification, FORCES[chosen.axis]
    names = [chosen.minimise, "velocity", "acceleration", "jerk", "rms acceleration"]
    names += [] if cycle.drive is None else [force, f"rms {force}", "power", "energy"]
    if cycle.in_si.load is not None:
        names += [f"{LOAD}{output}" for output in chosen.load_motion.outputs]
    values = (
        [None if name == "jerk" and any(joint["acceleration"] for joint in motion.joints) else motion.value(name)
         for motion in (usual, chosen)]
        for name in dict.fromkeys(names)
    )  # fmt: skip
    known = zip(dict.fromkeys(names), values, strict=True)
    rows = [Difference(each, objective_unit(chosen, each), *both) for each, both in known]
    least = chosen.minimise if chosen.solutions else ""
    return Differences(name, rows, least, partial(broken_limits, usual, chosen.specification))


def motion_table(
    motion: Solved | TransitionCam,
    master: tuple[float, float],
    count: int,
    more: Callable[[Array], dict[str, Array]] = lambda _: {},
) -> ReportTable:
    """Angle, time, position, velocity, acceleration and jerk at equal steps over a motion, and more over the time.

    What is rounding beside the greatest value of its column is 0.
    """
    degrees = np.linspace(*master, count)
    times = np.minimum((degrees - master[0]) * (motion.duration / (master[1] - master[0])), motion.duration)
    columns = {"master, deg": degrees.tolist(), "time, s": times.tolist()}
    orders = range(len(QUANTITIES))
    values = [np.asarray(motion(times, nu)) for nu in orders]
    of_motion = motion_columns(values, [motion.peak(nu) for nu in orders], motion.axis)
    columns |= {name: column.tolist() for name, column in of_motion.items()}
    for name, driven in more(times).items():
        columns[name] = chopped(driven, float(np.abs(driven).max()), CYCLE_ROUNDING).tolist()
    return ReportTable.of_columns(columns)


def motion_columns(
    values: Sequence[Array], peaks: Sequence[float], axis: str, names: Sequence[str] = QUANTITIES
) -> dict[str, Array]:
    """A position, m or rad, and its three derivatives by time in units of tables; what is rounding of a peak is 0."""
    return {
        f"{name}, {unit}": factor * chopped(each, peak, CYCLE_ROUNDING)
        for name, (unit, factor), each, peak in zip(names, UNITS[axis], values, peaks, strict=True)
    }


def objective_unit(cycle: Specification | Solved, name: str = "") -> str:
    """The SI unit of a cycle's objective, or of another value that may be one."""
    name = name or cycle.minimise
    kind, _ = kind_of(name)
    if kind is Kind.LOAD:
        return load_unit(cycle, name.removeprefix("rms ").removeprefix(LOAD))
    if kind is Kind.POWER or kind in SUMS:
        return "W" if kind is Kind.POWER else "J"
    return FORCE_UNITS[cycle.axis] if kind is Kind.FORCE else unit_of(cycle.axis, kind.order)


def proof_rows(plan: Solved) -> list[Row]:
    """The value of the objective and its proof; nothing where no law was optimised."""
    if not plan.solutions:
        return []
    unit = objective_unit(plan)
    rows = [Row("status", plan.status.value), Row(f"least {quantity_name(plan.minimise)}", plan.objective, unit)]
    bound, gap = plan.lower_bound, 0.0
    if bound is not None and plan.status is Status.LOCAL and plan.objective > 0.0:
        gap = 1.0 - bound / plan.objective
    none = Row(PROVEN_BOUND, "none is known", note=_why_no_bound(plan))
    note = f"gap {100.0 * gap:.2g} %" if gap else ""
    rows.append(none if bound is None else Row(plan.lower_bound_name, bound, unit, note=note))
    bases = (solution.problem.basis for solution in plan.solutions)
    usual = any(isinstance(basis, PolynomialBasis) and basis.degree == USUAL_DEGREE for basis in bases)
    remarks = [*plan.remarks, *([_RICHER] if gap > _WIDE_GAP and usual else [])]
    return [*rows, Row("search space", plan.search_space), *(Row("remark", remark) for remark in remarks)]


def _why_no_bound(plan: Solved) -> str:
    """Why nothing is proven of a drive's force, torque or power; blank of what is of no drive."""
    drive, kind = plan.specification.in_si.drive, kind_of(plan.minimise)[0]
    if drive is None:
        return ""
    torque = kind in {Kind.FORCE, Kind.HEAT}
    if torque and not all(has_torque_limit(span, drive) for span, _, _ in plan.laws):
        return "bounds are of moves from rest to rest under loads that do not change with the time"
    if drive.train.loses:
        return "peaks behind a gear with losses are estimated from above, which bounds nothing from below"
    return "what the load gives back may cover it, as far as energies tell"


def peak_rows(plan: Solved) -> list[Row]:
    """Peak velocity, acceleration and jerk, each with its time in seconds."""
    rows = []
    for nu, name in enumerate(QUANTITIES[1:], 1):
        extremes = (extreme for peaks in plan.peaks for extreme in peaks.ends(nu))
        value, time = max(extremes, key=lambda extreme: abs(extreme[0]))
        rows.append(Row(f"peak {name}", abs(value), unit_of(plan.axis, nu), time))
    return rows


def jerk_rows(plan: Plan) -> list[Row]:
    """Of a cycle of least acceleration the least with no more jerk than modified sine.

    Nothing where the comparison says nothing: see `Cycle.modified_sine_jerk`.
    """
    usual = plan.specification.modified_sine_jerk
    if usual is None or plan.peak(_JERK) <= usual:
        return []
    name = "least acceleration with no more jerk than modified sine"
    gentle = plan.specification.with_modified_sine_jerk()
    try:
        least = gentle.objective
    except (InfeasibleProblem, SolverFailure):
        return [Row(name, "none was found within the other limits")]
    offer = f'limits={{"jerk": "{gentle.limits["jerk"]}"}}'
    return [Row(name, least, unit_of(plan.axis, _ACCELERATION), note=offer)]


def drive_rows(plan: Solved) -> list[Row]:
    """The effort of the drive and the peaks of its load; nothing where there is no drive."""
    rows = []
    if isinstance(plan.drive, Drive):
        rows = [*overload_rows(plan), *plan.sheet.summary()]
    elif plan.drive is not None:
        effort, force, name = plan.effort, FORCE_UNITS[plan.axis], FORCES[plan.axis]
        driven, shaft = "the axis", "a cam there that moves"
        if isinstance(plan.drive, Mechanism):
            driven = f"the {_INPUTS.get(plan.drive.name, 'input of the mechanism')}"
            shaft = "a shaft that turns evenly and drives"
        of = f"of {shaft} {driven}: peak power over the master's speed"
        rows = [
            Row(f"peak {name}", effort.peak_force, force, note=f"at {driven}"),
            Row(f"RMS {name}", effort.rms_force, force, note=f"at {driven}"),
            Row("peak power", effort.peak_power, "W"),
            Row("mean power", effort.mean_power, "W"),
        ]
        if not isinstance(plan.specification.speed, Derived):  # else it has a period, and no shaft
            torque = effort.shaft_torque(TURN / plan.duration)
            rows.append(Row("peak torque at the master's shaft", torque, "N m", note=of))
        if isinstance(plan.drive, Mechanism):
            rows += [
                Row("greatest power, motoring", effort.motoring_power, "W"),
                Row("greatest power, braking", effort.braking_power, "W"),
                Row("energy of a cycle, motoring", effort.motoring_energy, "J"),
                Row("energy of a cycle, braking", effort.braking_energy, "J"),
            ]
    rows += load_work_rows(plan)
    loaded = load_peaks(plan).items()
    return rows + [Row(f"peak {name} of the load", peak, load_unit(plan, name)) for name, peak in loaded]


def overload_rows(plan: Solved) -> list[Row]:
    """The remark that a motion overloads its motor, whose limits it was not to keep; nothing where it does not.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Mechanism, Motor, Rise
    >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", rated_torque="1 N m"), ratio=20)
    >>> table = Cycle([Rise("45 deg", "0.25 s"), Dwell()], period="0.6 s", advance="45 deg", drive=drive)
    >>> overload_rows(table.solve())[0].value
    'the motor is overloaded (RMS torque 143 %): look for laws within its limits by motor = true, or give a ...'
    """
    over = {each.name: f"{each.name} {100.0 * each.use:.3g} %" for each in overloads(plan)}
    if not over:
        return []
    # laws that have the least of what is too much are within no limit of it
    kind, mean = kind_of(plan.minimise)
    least = "RMS torque" if mean or kind is Kind.HEAT else "peak torque"
    hopeless = plan.solutions and kind in {Kind.FORCE, Kind.HEAT} and least in over
    within = "" if hopeless else "look for laws within its limits by motor = true, or "
    text = f"the motor is overloaded ({', '.join(over.values())}): {within}"
    return [Row("remark", f"{text}give a stronger motor, another ratio or more time")]


def load_work_rows(plan: Solved) -> list[Row]:
    """The work against the load of the mechanism in a cycle, with a remark where the load drives or works both ways.

    Weights and springs, whose force is a straight line over the position, work both ways without a remark. Nothing
    where there is no load.

    Examples
    --------
    >>> from optlaws import Cycle, Loads, Return, Rise, slider_crank
    >>> press = slider_crank(
    ...     "0.1 m", "0.4 m", bodies={"slider": "5 kg"}, loads=Loads({"0.3 m": "0 N", "0.5 m": "-90 N"})
    ... )
    >>> strokes = Cycle([Rise("180 deg", "0.3 s", law="345"), Return(law="345")], period="0.6 s", drive=press)
    >>> work, remark = load_work_rows(strokes.solve())
    >>> round(work.value, 9), remark.value
    (0.0, 'the load gives back 9 J of the 9 J that it takes in a cycle: ...')
    """
    drive = plan.specification.in_si.drive
    if drive is None or drive.mechanism.load_formula == Number(0.0):
        return []
    against, back = (sum(works) for works in zip(*(each.load_works for each in plan.along), strict=True))
    work = chop(against - back, against + back, CYCLE_ROUNDING)
    row = Row("work against the load in a cycle", work, "J")
    if drive.mechanism.linear is not None or not against + back:
        return [row]
    if work < 0.0:
        text = (
            f"the load drives the machine: it gives {-work:.4g} J in a cycle; a process that takes this work has a "
            "force of the other sign"
        )
    elif back > _BOTH_WAYS * against:
        text = (
            f"the load gives back {back:.4g} J of the {against:.4g} J that it takes in a cycle: it acts during the "
            "return too; give a process force that acts in one direction alone over the time or the master"
        )
    else:
        return [row]
    return [row, Row("remark", text)]


def load_peaks(plan: Solved) -> dict[str, float]:
    """The peaks of the outputs of an elastic load, in SI units; nothing without one."""
    if plan.specification.in_si.load is None:
        return {}
    return {name: plan.load_motion.peak(name).value for name in plan.load_motion.outputs}


def joint_rows(plan: Solved) -> list[Row]:
    """The greatest jumps of velocity and acceleration where segments meet."""
    jumps = {name: max(abs(joint[name]) for joint in plan.joints) for name in QUANTITIES[1:3]}
    return [
        Row(f"greatest jump of the {name} at a joint", jump, unit_of(plan.axis, nu))
        for nu, (name, jump) in enumerate(jumps.items(), 1)
    ]


def load_unit(cycle: Specification | Solved, output: str) -> str:
    """The unit of an output of the load; an unknown dimension is described as SI."""
    load = read_load(cycle.load, cycle.axis)
    return _LOAD_UNITS.get(load.dimensions.get(output, "") if load else "", "SI")
