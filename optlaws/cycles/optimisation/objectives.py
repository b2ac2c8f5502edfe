"""The objective of a cycle with the limits of the whole and of its segments, and the degree of its laws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from typing import Any

from optlaws.cycles.specification.drive import CycleDrive
from optlaws.cycles.specification.load import LOAD, Load, load_output
from optlaws.cycles.specification.position_drive import PositionDrive
from optlaws.cycles.specification.programme import AXES, TimedSegment
from optlaws.cycles.specification.segments import Free, Move
from optlaws.errors import InputError
from optlaws.motion.quantities import in_small_units, positive_quantity, table
from optlaws.suggest import unknown_key

FORCE, LOADED, POWER, ENERGY, HEAT, CURVE = -1, -2, -3, -4, -5, -6
#: what is summed over the motions of a cycle as it is
SUMS = (ENERGY, HEAT)
#: what may be least over a cycle: the order of the derivative, and whether it is its root mean square
OBJECTIVES = {
    "velocity": (1, False),
    "acceleration": (2, False),
    "jerk": (3, False),
    "rms acceleration": (2, True),
    "rms jerk": (3, True),
    "rms snap": (4, True),
    "force": (FORCE, False),
    "torque": (FORCE, False),
    "power": (POWER, False),
    "rms force": (FORCE, True),
    "rms torque": (FORCE, True),
    "energy": (ENERGY, False),
    "heat": (HEAT, False),
}
LIMITS = {"velocity": 1, "acceleration": 2, "jerk": 3, "force": FORCE, "torque": FORCE, "power": POWER}
#: limits of the whole cycle alone
MEANS = ("rms force", "rms torque")
TOTALS = (*MEANS, "energy", "motor")
_FORCES = {"length": "force", "angle": "torque"}


@dataclass(frozen=True)
class CycleObjective:
    """The objective of a cycle, one of `OBJECTIVES`, the limits of the whole in SI units, and the degree of its laws.

    `limits` are by the order of the derivative, of force or torque by -1, of power by -3; `loaded` by the load's output
    and whether of its root mean square; `mean_force` is that of the root mean square of the force over the whole cycle,
    `energy` that of its energy.
    """

    minimise: str
    limits: Mapping[int, float]
    order: int
    degree: int
    drive: CycleDrive | PositionDrive | None
    load: Load | None = None
    loaded: Mapping[tuple[str, bool], float] = field(default_factory=dict)
    mean_force: float | None = None
    energy: float | None = None

    @property
    def shares(self) -> bool:
        """Whether a limit is of the whole cycle, so that its motions share it."""
        return self.mean_force is not None or self.energy is not None

    @property
    def of_load(self) -> bool:
        """Whether the load is spoken of, so that the cycle is one problem."""
        return bool(self.loaded) or kind_of(self.minimise)[0] == LOADED


def kind_of(minimise: str) -> tuple[int, bool]:
    """The order of what is minimised, and whether its root mean square.

    -1 is a force, -2 of the load, -3 the power, -4 the energy, -5 the heat.

    >>> kind_of("rms jerk"), kind_of("load acceleration")
    ((3, True), (-2, False))
    """
    return OBJECTIVES.get(minimise, (LOADED, minimise.startswith("rms ")))


def check_objective(minimise: Any, load: Load | None) -> None:  # noqa: ANN401 - it is checked here
    """Refuse what cannot be minimised."""
    if not isinstance(minimise, str) or (minimise not in OBJECTIVES and load_output(minimise, load) is None):
        raise InputError(f"minimise: {unknown_key(minimise, (*OBJECTIVES, 'load acceleration'), 'objective')}")


def read_load_limits(entries: Mapping[str, Any], load: Load | None) -> dict[tuple[str, bool], float]:
    """Limits of the load in SI units, by output and whether they are of root mean squares."""
    limits = {}
    for name, value in entries.items():
        output = load_output(name, load)
        if output is not None and load is not None:
            limits[output] = load.limit(value, output[0], f"limits, {name}")
    return limits


def read_limits(entries: Mapping[str, Any], axis: str, where: str) -> dict[int, float]:
    """Limits in SI units by the order of the derivative."""
    limits = {}
    for name, value in table(entries, where, "{'velocity': '2 m/s'}").items():
        if name in LIMITS:
            limits[LIMITS[name]] = positive_quantity(value, _dimension(LIMITS[name], axis), f"{where}, {name}")
            continue
        if where != "limits" and name in TOTALS:
            raise InputError(f"{where}, {name} is of the whole cycle: give it among the limits of the Cycle")
        if name not in TOTALS and (where != "limits" or not name.removeprefix("rms ").startswith(LOAD)):
            raise InputError(f"{where}: {unknown_key(name, (*LIMITS, *TOTALS), 'limit')}")
    return limits


def read_mean_force(entries: Mapping[str, Any], axis: str) -> float | None:
    """The limit of the root mean square of the force or torque over the cycle, in SI units; None if there is none."""
    given = [name for name in MEANS if name in entries]
    if len(given) > 1:
        raise InputError(f"limits: {' and '.join(given)} are the same: give one of them")
    if not given:
        return None
    return positive_quantity(entries[given[0]], _FORCES[axis], f"limits, {given[0]}")


def read_energy(entries: Mapping[str, Any]) -> float | None:
    """The limit of the energy over the cycle, J; None if there is none."""
    if "energy" not in entries:
        return None
    if any(name in entries for name in (*MEANS, "motor")):
        raise InputError(
            "limits: energy and an rms force or torque, which a motor has as well, are both of the whole cycle: give "
            "one of them"
        )
    return positive_quantity(entries["energy"], "energy", "limits, energy")


def in_units(nu: int, value: float, axis: str) -> str:
    """A limit as text, in the unit that machines have it in.

    >>> in_units(1, 0.616, "length"), in_units(FORCE, 120.0, "length"), in_units(3, 900.0, "angle")
    ('the velocity 616 mm/s', 'the force 120 N', 'the jerk 900 rad/s^3')
    """
    if nu == CURVE:
        return f"the share {value:.6g} of the motor's curve"
    if nu in {FORCE, POWER}:
        name, unit = ("power", "W") if nu == POWER else (_FORCES[axis], "N" if axis == "length" else "N m")
        return f"the {name} {value:.6g} {unit}"
    name = next(name for name, order in LIMITS.items() if order == nu)
    if nu == 1:
        return f"the {name} {in_small_units(value, axis)}/s"
    return f"the {name} {value:.6g} {'m' if axis == 'length' else 'rad'}/s^{nu}"


def _dimension(nu: int, axis: str) -> str:
    return AXES[axis][nu] if nu > 0 else {FORCE: _FORCES[axis], POWER: "power"}[nu]


def limits_of_stretch(stretch: TimedSegment, objective: CycleObjective, axis: str) -> dict[int, float]:
    """Limits of a segment by order: its own and those of the whole cycle, whichever is less."""
    entries = stretch.given.limits if isinstance(stretch.given, Move | Free) else {}
    given = read_limits(entries, axis, f"{stretch.where}: limits")
    return tightest(objective.limits, given)


def tightest(limits: Mapping[int, float], others: Mapping[int, float]) -> dict[int, float]:
    """Limits of both, whichever is less."""
    return {nu: min(limits.get(nu, inf), others.get(nu, inf)) for nu in sorted({*limits, *others})}


def least_of(limit: float | None, other: float | None) -> float | None:
    """The lesser of two limits of which any may be none."""
    return min((known for known in (limit, other) if known is not None), default=None)
