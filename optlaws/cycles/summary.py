"""Rows that summarise a cycle: its proof, its peaks, its drive, its joints."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

from optlaws.cycles.optimisation.objectives import SUMS, kind_of
from optlaws.cycles.specification.load import LOAD, read_load
from optlaws.cycles.specification.process import is_process
from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import QUANTITIES
from optlaws.motion.quantity_kinds import Kind
from optlaws.shown.summary import Row

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Cycle, Plan

_ACCELERATION, _JERK = 2, 3
_LOAD_UNITS = {
    "length": "m",
    "angle": "rad",
    "acceleration": "m/s²",
    "angular acceleration": "rad/s²",
    "force": "N",
    "torque": "N m",
}


def objective_unit(cycle: Cycle | Plan, name: str = "") -> str:
    """The SI unit of a cycle's objective, or of another value that may be one."""
    name = name or cycle.minimise
    kind, _ = kind_of(name)
    if kind is Kind.LOAD:
        return load_unit(cycle, name.removeprefix("rms ").removeprefix(LOAD))
    if kind is Kind.POWER or kind in SUMS:
        return "W" if kind is Kind.POWER else "J"
    return force_unit(cycle) if kind is Kind.FORCE else unit_of(cycle.axis, kind.order)


def force_unit(cycle: Cycle | Plan) -> str:
    """The unit of the force, or of the torque, of a cycle's drive."""
    return "N" if cycle.axis == "length" else "N m"


def force_name(cycle: Cycle | Plan) -> str:
    """The name of the drive's load in a cycle: a force, or a torque."""
    return "force" if cycle.axis == "length" else "torque"


def proof_rows(plan: Plan) -> list[Row]:
    """The value of the objective and its proof; nothing where no law was optimised."""
    if not plan.solutions:
        return []
    unit = objective_unit(plan)
    rows = [Row("status", plan.status.value), Row(f"least {plan.minimise}", plan.objective, unit)]
    if plan.lower_bound is not None:
        rows.append(Row("proven lower bound", plan.lower_bound, unit))
    return [*rows, Row("found among", plan.search_space), *(Row("remark", remark) for remark in plan.remarks)]


def peak_rows(plan: Plan) -> list[Row]:
    """Peak velocity, acceleration and jerk, each with its time in seconds."""
    rows = []
    for nu, name in enumerate(QUANTITIES[1:], 1):
        extremes = (extreme for peaks in plan.peaks for extreme in peaks.extremes[nu])
        value, time = max(extremes, key=lambda extreme: abs(extreme[0]))
        rows.append(Row(f"peak {name}", abs(value), unit_of(plan.axis, nu), time))
    return rows


def jerk_rows(plan: Plan) -> list[Row]:
    """The jerk of a cycle of least acceleration over modified sine's, and the least acceleration with no more jerk.

    Nothing where the comparison says nothing: see `Cycle.modified_sine_jerk`.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise
    >>> cycle = Cycle([Rise("35 mm", "0.1 s"), Return()], period="0.25 s")
    >>> for row in jerk_rows(cycle.solve()):
    ...     print(row.name, row.text(4), row.unit, row.note, sep="; ")
    peak jerk over that of modified sine; 4.146; ; modified sine has 2431.32 m/s³ in these motions
    least acceleration with no more jerk than modified sine; 17.2; m/s²; limits={"jerk": "2431.325 m/s^3"}
    """
    usual = plan.specification.modified_sine_jerk
    if usual is None or plan.peak(_JERK) <= usual:
        return []
    unit = unit_of(plan.axis, _JERK)
    note = f"modified sine has {usual:.6g} {unit} in these motions"
    rows = [Row("peak jerk over that of modified sine", plan.peak(_JERK) / usual, note=note)]
    name = "least acceleration with no more jerk than modified sine"
    gentle = plan.specification.with_modified_sine_jerk()
    try:
        least = gentle.objective
    except (InfeasibleProblem, SolverFailure):
        return [*rows, Row(name, "none was found within the other limits")]
    offer = f'limits={{"jerk": "{gentle.limits["jerk"]}"}}'
    return [*rows, Row(name, least, unit_of(plan.axis, _ACCELERATION), note=offer)]


def drive_rows(plan: Plan) -> list[Row]:
    """The effort of the drive and the peaks of its load; nothing where there is no drive."""
    rows = []
    if isinstance(plan.drive, Drive):
        rows = list(plan.sheet.summary())
    elif plan.drive is not None:
        effort, force, name = plan.effort, force_unit(plan), force_name(plan)
        rows = [
            Row(f"peak of {name}", effort.peak_force, force),
            Row(f"RMS of {name}", effort.rms_force, force),
            Row("peak of power", effort.peak_power, "W"),
            Row("mean of power", effort.mean_power, "W"),
            Row("peak torque at the master's shaft", effort.shaft_torque(2.0 * pi / plan.duration), "N m"),
        ]
        if isinstance(plan.drive, Mechanism):
            rows += [
                Row("greatest power, motoring", effort.motoring_power, "W"),
                Row("greatest power, braking", effort.braking_power, "W"),
                Row("energy of a cycle, motoring", effort.motoring_energy, "J"),
                Row("energy of a cycle, braking", effort.braking_energy, "J"),
            ]
    if plan.load is not None and not is_process(plan.load):
        for name in plan.load_motion.machine.outputs:
            peak = plan.load_motion.peak(name).value
            rows.append(Row(f"peak of the load's {name}", peak, load_unit(plan, name)))
    return rows


def joint_rows(plan: Plan) -> list[Row]:
    """The greatest jumps of velocity and acceleration where segments meet."""
    return [
        Row(
            f"greatest jump of the {name} at a joint",
            max(abs(joint[name]) for joint in plan.joints),
            unit_of(plan.axis, nu),
        )
        for nu, name in enumerate(QUANTITIES[1:3], 1)
    ]


def load_unit(cycle: Cycle | Plan, output: str) -> str:
    """The unit of an output of the load; an unknown dimension is described as SI."""
    return _LOAD_UNITS.get(read_load(cycle.load, cycle.axis).dimensions.get(output, ""), "SI")
