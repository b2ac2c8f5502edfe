"""The objective of a cycle with the limits of the whole and of its segments, and the degree of its laws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from optlaws.cycles.optimisation.motion_limits import Sides, limits_of_segment
from optlaws.cycles.specification.load import Load, load_output
from optlaws.cycles.specification.programme import TimedSegment
from optlaws.errors import InputError
from optlaws.motion.quantity_kinds import Kind
from optlaws.suggest import unknown_key

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.drive_train import Drive

#: what is summed over the motions of a cycle as it is
SUMS = (Kind.ENERGY, Kind.HEAT)
#: what may be least over a cycle, and whether it is its root mean square
OBJECTIVES = {
    "velocity": (Kind.VELOCITY, False),
    "acceleration": (Kind.ACCELERATION, False),
    "jerk": (Kind.JERK, False),
    "rms acceleration": (Kind.ACCELERATION, True),
    "rms jerk": (Kind.JERK, True),
    "rms snap": (Kind.SNAP, True),
    "force": (Kind.FORCE, False),
    "torque": (Kind.FORCE, False),
    "power": (Kind.POWER, False),
    "rms force": (Kind.FORCE, True),
    "rms torque": (Kind.FORCE, True),
    "energy": (Kind.ENERGY, False),
    "heat": (Kind.HEAT, False),
}


@dataclass(frozen=True)
class CycleObjective:
    """The objective of a cycle, from `OBJECTIVES`, the limits of the whole in SI units, and the degree of its laws.

    Of the limits the root mean square of the force and the energy are of the whole cycle, the others of each segment;
    `loaded` are by the load's output and whether of its root mean square.
    """

    minimise: str
    limits: Mapping[Kind, tuple[float, float]]
    order: int
    degree: int
    drive: Drive | None
    load: Load | None = None
    loaded: Mapping[tuple[str, bool], float] = field(default_factory=dict)

    @property
    def mean_force(self) -> float | None:
        """The limit of the root mean square of the force over the whole cycle."""
        return self.limits.get(Kind.RMS_FORCE, (None, None))[1]

    @property
    def energy(self) -> float | None:
        """The limit of the energy over the whole cycle."""
        return self.limits.get(Kind.ENERGY, (None, None))[1]

    @property
    def shares(self) -> bool:
        """Whether a limit is of the whole cycle, so that its motions share it."""
        return self.mean_force is not None or self.energy is not None

    @property
    def of_load(self) -> bool:
        """Whether the load is spoken of, so that the cycle is one problem."""
        return bool(self.loaded) or kind_of(self.minimise)[0] is Kind.LOAD


def kind_of(minimise: str) -> tuple[Kind, bool]:
    """The kind of the minimised quantity, and whether its root mean square is minimised.

    >>> kind_of("rms jerk"), kind_of("load acceleration")
    ((<Kind.JERK: 3>, True), (<Kind.LOAD: -2>, False))
    """
    return OBJECTIVES.get(minimise, (Kind.LOAD, minimise.startswith("rms ")))


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


def limits_of_stretch(stretch: TimedSegment, objective: CycleObjective, axis: str) -> Sides:
    """Limits of a segment: the segment's own limits and the cycle's limits, whichever are lower."""
    return limits_of_segment(stretch, objective.limits, axis)
