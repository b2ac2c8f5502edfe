"""An elastic load of a cycle: a mass on a spring, or any machine, in its steady motion over the whole cycle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Any

from optlaws.cycles.specification.limits import AXES, FORCES
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import KnownQuantity, Measured, Number
from optlaws.errors import InputError, located
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantities import Derived, quantity
from optlaws.numbers import NumberOrQuantity, positive
from optlaws.synthesis.problem.constants import Functional

if TYPE_CHECKING:
    from optlaws.mechanisms.machine.machine import Machine
    from optlaws.mechanisms.machine.over_time import MachineMotion


@declared
class ElasticFollower(Declared, title="an elastic follower"):
    """A mass on a spring, damped against the ground, that a motion drives.

    Raises
    ------
    InputError
        If neither the period nor the frequency is given, or both.

    Examples
    --------
    >>> ElasticFollower("20 ms").damping, ElasticFollower(frequency="50 Hz").period
    (0.0, '0.02 s')
    """

    period: KnownQuantity = entry(
        Measured("time", above=0.0), "Of its free vibration; it or the frequency.", default=None, example="20 ms"
    )
    damping: float = entry(
        Number(least=0.0),
        "Its damping as a share of the critical one, between mass and ground.",
        default=0.0,
        example=0.05,
    )
    frequency: NumberOrQuantity | None = entry(
        Measured("frequency", above=0.0),
        "Of its free vibration, in place of the period.",
        default=None,
        kw_only=True,
        example="50 Hz",
    )

    def _check(self) -> None:
        period = None if isinstance(self.period, Derived) else self.period
        if (period is None) == (self.frequency is None):
            both = "not both" if period is not None else 'such as period = "20 ms" or frequency = "50 Hz"'
            raise InputError(f"{self.named} needs its period or its frequency, {both}")
        if period is None:
            natural = quantity(self.frequency, "frequency", "frequency", above=0.0)
            object.__setattr__(self, "period", Derived(1.0 / natural, "s"))


@declared
class ElasticLoad(ElasticFollower, title="a load"):
    """A mass on a spring that a motion drives, with its mass or moment of inertia where forces are of interest.

    Examples
    --------
    >>> ElasticLoad("20 ms", mass="2 kg").to_dict()
    {'period': '20 ms', 'mass': '2 kg'}
    """

    mass: NumberOrQuantity | None = entry(Measured("mass"), "Of a slide, for its force.", default=None, example="2 kg")
    inertia: NumberOrQuantity | None = entry(
        Measured("moment of inertia"), "Of a table, for its torque.", default=None, example="0.02 kg m^2"
    )


def is_process(given: Any) -> bool:
    """Whether a load of a cycle is a process force, and nothing elastic."""
    return (
        isinstance(given, Mapping)
        and bool({"force", "torque"} & given.keys())
        and not {"period", "frequency"} & given.keys()
    )


@dataclass(frozen=True)
class Load:
    """A machine in seconds and SI units that the motion drives, and the dimensions of its outputs where known."""

    machine: Machine
    dimensions: Mapping[str, str]

    @property
    def absolute(self) -> bool:
        """Whether the load is driven by positions, so that these must return."""
        return "a" in self.machine.inputs

    def constant(self, output: str, period: float, *, mean: bool) -> Functional:
        """Peak or root mean square of an output as a constant of the law of a whole cycle; per metre or radian."""
        from optlaws.mechanisms.machine.output_constants import check_peaks_of_cycle, output_peak, output_rms

        machine = self.machine.at_speed(1.0 / period)
        if not mean:
            check_peaks_of_cycle(machine, output)
        return (output_rms if mean else output_peak)(of=machine, output=output, steady=True)

    def motion(self, pieces: Sequence[Piece]) -> MachineMotion:
        """The steady outputs of the load under pieces that form a cycle, over time in seconds."""
        from optlaws.mechanisms.machine import drives
        from optlaws.mechanisms.machine.over_time import MachineMotion, jumps

        drives_of_pieces, at_breaks = [], list[tuple[float, float]]()
        for piece in pieces:
            drives_of_pieces += drives.of_law(piece.law, piece.start, piece.duration, piece.offset, piece.stroke)
            size = factor(piece.stroke, piece.duration, 1)
            at_breaks += [(piece.start + k * piece.duration, size * jump) for k, jump in jumps(piece.law)]
        return MachineMotion(self.machine.dynamics, self.machine.rows, drives_of_pieces, jumps=at_breaks)

    def limit(self, value: Any, output: str, name: str) -> float:
        """A limit of an output in SI units: with its unit where that is known, else a number."""
        known = self.dimensions.get(output)
        return positive(value, name) if known is None else quantity(value, known, name, above=0.0)


def read_load(given: Any, axis: str) -> Load | None:
    """A load from its entries, or a machine in seconds and SI units; None without one, or of a process force."""
    if given is None or is_process(given):
        return None
    from optlaws.mechanisms.machine.machine import Machine
    from optlaws.mechanisms.machine.state_space import FASTEST

    if isinstance(given, Machine):
        return Load(given, {})
    with located("load"):
        load = ElasticLoad.from_dict(given)
    period = quantity(load.period, "time", "load: period")
    if 2.0 * pi > FASTEST * period:
        raise InputError(
            f"load: a period of {shortened(load.period)} is too short: below {2e6 * pi / FASTEST:.0f} us a load "
            "moves as if it were rigid: leave it out, and minimise or limit the cycle's own quantities"
        )
    # the follower of `Cycle.cam`, damped against the ground, in its deflection x - y, driven by velocity and c
    frequency = 2.0 * pi / period
    n, square = load.damping * frequency, frequency**2
    motion, names = [-square, -2.0 * n], {"acceleration": AXES[axis][2], "deflection": axis}
    rows, direct = [motion, [1.0, 0.0]], [[-2.0 * n, 0.0], [0.0, 0.0]]
    weight, other, kind, article = {
        "length": ("mass", "inertia", "mass", "a"),
        "angle": ("inertia", "mass", "moment of inertia", "an"),
    }[axis]
    if getattr(load, other) is not None:
        raise InputError(f"load: the motion is {article} {axis}: give its {weight}, not its {other}")
    if getattr(load, weight) is not None:
        rows.append([-quantity(getattr(load, weight), kind, f"load: {weight}") * square, 0.0])
        direct.append([0.0, 0.0])
        names[FORCES[axis]] = FORCES[axis]
    driven = [[0.0, 0.0], [-2.0 * n, -1.0]]
    return Load(Machine([[0.0, 1.0], motion], driven, rows, direct, inputs="bc", outputs=list(names)), names)
