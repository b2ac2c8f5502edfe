"""The objective of a cycle with the limits of the whole and of its segments, and the degree of its laws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from optlaws.cycles.optimisation.motion_limits import FORCE, FORCES, MEANS, POWER, LimitKey, Limits, limits_of_segment
from optlaws.cycles.specification.load import Load, load_output
from optlaws.cycles.specification.programme import TimedSegment
from optlaws.errors import InputError
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.quantities import positive_quantity
from optlaws.suggest import unknown_key

LOADED, ENERGY, HEAT = -2, -4, -5
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


@dataclass(frozen=True)
class CycleObjective:
    """The objective of a cycle, from `OBJECTIVES`, the limits of the whole in SI units, and the degree of its laws.

    `limits` are by the order of the derivative or one side of it, of force or torque by -1, of power by -3, of a
    motor's curve by -6; `loaded` by the load's output and whether of its root mean square; `mean_force` is that of the
    root mean square of the force over the whole cycle, `energy` that of its energy.
    """

    minimise: str
    limits: Mapping[LimitKey, float]
    order: int
    degree: int
    drive: Drive | None
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
    """The order of the minimised quantity, and whether its root mean square is minimised.

    -1 is a force, -2 of the load, -3 the power, -4 the energy, -5 the heat.

    >>> kind_of("rms jerk"), kind_of("load acceleration")
    ((3, True), (-2, False))
    """
    return OBJECTIVES.get(minimise, (LOADED, minimise.startswith("rms ")))


def check_objective(minimise: Any, load: Load | None) -> None:
    """Refuse objectives that cannot be minimised."""
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


def read_mean_force(entries: Mapping[str, Any], axis: str) -> float | None:
    """The limit of the root mean square of the force or torque over the cycle, in SI units; None without one."""
    given = [name for name in MEANS if name in entries]
    if len(given) > 1:
        raise InputError(f"limits: {' and '.join(given)} are the same: give one of them")
    if not given:
        return None
    return positive_quantity(entries[given[0]], FORCES[axis], f"limits, {given[0]}")


def read_energy(entries: Mapping[str, Any]) -> float | None:
    """The limit of the energy over the cycle, J; None without one."""
    if "energy" not in entries:
        return None
    if any(name in entries for name in (*MEANS, "motor")):
        raise InputError(
            "limits: energy and an rms force or torque, which a motor has as well, are both of the whole cycle: give "
            "one of them"
        )
    return positive_quantity(entries["energy"], "energy", "limits, energy")


def limits_of_stretch(stretch: TimedSegment, objective: CycleObjective, axis: str) -> Limits:
    """Limits of a segment: the segment's own limits and the cycle's limits, whichever are lower."""
    return limits_of_segment(stretch, objective.limits, axis)


def least_of(limit: float | None, other: float | None) -> float | None:
    """The lesser of two limits of which any may be none."""
    return min((known for known in (limit, other) if known is not None), default=None)
