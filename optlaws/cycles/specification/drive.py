"""The drive of a cycle: a mechanism with or without its motor, as which constants such as a mass are read too."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from optlaws.cycles.specification.process import ProcessForce
from optlaws.echo import shortened
from optlaws.entries.declared import TableOf, entry
from optlaws.entries.value_types import Measured
from optlaws.entries.value_types import Number as Share
from optlaws.errors import InputError
from optlaws.formulas.slopes import added, multiplied
from optlaws.formulas.tree import Name, Number, number
from optlaws.mechanisms.drives.drive_train import DimensionlessDrive, Drive
from optlaws.mechanisms.drives.effort import bends
from optlaws.mechanisms.linkages.dimensionless import DimensionlessMechanism
from optlaws.mechanisms.linkages.linear_force import LinearForce
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.piece import Piece
from optlaws.numbers import Array

REGENERATION = "regeneration"


def _constants(weight: str, inertia: str, stiffness: str, force: str, viscous: str) -> TableOf:
    """The constants of a drive: the name of its weight, and the dimensions of that and of what acts on it."""
    acting, against = Measured(force), Measured(force, least=0.0)
    types = {
        weight: (Measured(inertia, least=0.0), "What is moved."),
        "stiffness": (Measured(stiffness), "Of a spring without force at 0."),
        "preload": (acting, "A constant force against the motion to greater positions."),
        "gravity": (acting, "The weight, likewise."),
        "viscous": (Measured(viscous, least=0.0), "Friction in proportion to the speed."),
        "dry": (against, "Friction that does not depend on the speed."),
        REGENERATION: (Share(least=0.0, most=1.0), "The share of the braking energy that is used again."),
    }
    return TableOf(
        "key",
        {
            name: entry(each, about, default=None, example=getattr(each, "example", 0.5))
            for name, (each, about) in types.items()
        },
    )


#: constants of a drive, for slides and for tables
CONSTANTS = {
    "length": _constants("mass", "mass", "stiffness", "force", "viscous friction"),
    "angle": _constants("inertia", "moment of inertia", "torsional stiffness", "torque", "rotary viscous friction"),
}


@dataclass(frozen=True)
class CycleDrive:
    """The torque or force at the input of a mechanism, or at the motor that drives it, in SI units.

    The motion of the cycle is that of the mechanism's input. `fed_back` is the share of the braking energy that is used
    again without a motor.
    """

    source: Mechanism | Drive
    process: ProcessForce | None = None
    fed_back: float = 0.0

    @property
    def mechanism(self) -> Mechanism:
        """The mechanism whose input moves."""
        return self.source.mechanism if isinstance(self.source, Drive) else self.source

    @property
    def linear(self) -> LinearForce | None:
        """The force where it is affine in the motion; None of other mechanisms, with a process, and at a motor."""
        return None if isinstance(self.source, Drive) or self.process is not None else self.source.linear

    @property
    def dry(self) -> float:
        """The greatest friction that changes sign with the velocity; 0 without friction."""
        motor = self.source.train.coulomb if isinstance(self.source, Drive) else 0.0
        return self.mechanism.coulomb + motor

    @property
    def loses(self) -> bool:
        """Whether a gear loses power, so that the torque at the motor is the greater of two."""
        return isinstance(self.source, Drive) and self.source.efficiencies != (1.0, 1.0)

    @property
    def regeneration(self) -> float:
        """The share of the braking energy that is fed back."""
        return self.source.regeneration if isinstance(self.source, Drive) else self.fed_back

    @property
    def copper(self) -> float:
        """The copper heat of the motor by its squared torque, W/(N m)²; 0 without a motor constant."""
        return self.source.motor.constant**-2 if isinstance(self.source, Drive) else 0.0

    @property
    def speed_ratio(self) -> float:
        """The ratio of the motor's speed to the speed of the mechanism's input; 1 without a motor."""
        return self.source.ratio if isinstance(self.source, Drive) else 1.0

    def kinks(self, piece: Piece) -> list[Callable[[Array], Array]]:
        """Functions of the time at whose zeros the torque has kinks.

        They are where a table of straight lines bends, and where the power through a gear turns.
        """
        loads = [self.mechanism.load_formula, *([] if self.process is None else [self.process.load])]
        return [*bends(loads, piece), *([partial(self._before_gear, piece)] if self.loses else [])]

    def _before_gear(self, piece: Piece, times: Array) -> Array:
        """The torque at the mechanism's input."""
        x, v, w = (piece.values(times, nu) for nu in range(3))
        return np.asarray(self.mechanism.torque(x, v, w, piece.direction(times)), dtype=np.float64) + self._process(
            x, times
        )

    def _process(self, x: Array, times: Array) -> Array | float:
        """The load of the process at positions and times."""
        return 0.0 if self.process is None else self.process.values(x, times)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times at which the load has kinks."""
        return () if self.process is None else self.process.breaks

    def along(self, piece: Piece, times: Array) -> Array:
        """The torque or force at times in a piece."""
        y, velocity, acceleration = (piece.values(times, nu) for nu in range(3))
        return self._torque((y, velocity, acceleration), piece.direction(times), times)

    def at_joint(self, motion: tuple[float, float, float], direction: float, time: float) -> float:
        """The torque or force where a move begins or ends, on its way in a direction."""
        y, velocity, acceleration = (np.array([value]) for value in motion)
        way = np.where(velocity == 0.0, direction, np.sign(velocity))
        return float(self._torque((y, velocity, acceleration), way, np.array([time]))[0])

    def _torque(self, motion: tuple[Array, Array, Array], way: Array, times: Array) -> Array:
        (y, velocity, acceleration), process = motion, self._process(motion[0], times)
        if isinstance(self.source, Drive):
            return np.asarray(self.source.torque(y, velocity, acceleration, process, direction=way), dtype=np.float64)
        return np.asarray(self.source.torque(y, velocity, acceleration, way), dtype=np.float64) + process

    def moved(
        self, stroke: float, span: tuple[float, float], offset: float
    ) -> DimensionlessMechanism | DimensionlessDrive:
        """Torque, power and energy over a stroke as formulas of a law that never turns back.

        A span is its start and its duration.
        """
        process = None if self.process is None else self.process.over_span(*span)
        return self.source.dimensionless(offset, stroke, span[1], process=process)

    def formula(self, stroke: float, span: tuple[float, float], offset: float, unit: float) -> str:
        """The torque in a unit, counted in the direction of the stroke, of a law that never turns back."""
        moved = self.moved(stroke, span, offset)
        return f"{moved.unit / unit!r}*({moved.torque})"

    @property
    def brakes_as_it_drives(self) -> bool:
        """Whether motor and load are braked together: the torque of power back is then never greater than the torque.

        So it is where nothing but constant inertia is moved, and where motor and gear take no torque themselves.
        """
        if not isinstance(self.source, Drive):
            return True
        mechanism, train = self.mechanism, self.source.train
        if self.process is not None and (train.inertia or train.viscous or train.coulomb):
            return False
        if not (train.inertia or train.viscous or train.coulomb):
            return True
        rubs = mechanism.viscous or mechanism.coulomb or train.viscous or train.coulomb
        return not rubs and isinstance(mechanism.inertia_formula, Number) and mechanism.load_formula == Number(0.0)

    def size(self, stroke: float, span: tuple[float, float], offset: float) -> float:
        """The order of magnitude of the torque along a motion, as its unit."""
        if self.linear is not None:
            return self.linear.size(stroke, span[1], offset)
        return 4.0 * self.moved(stroke, span, offset).unit


def read_drive(entries: Mapping[str, Any] | Mechanism | Drive, axis: str) -> CycleDrive:
    """A drive from its entries, each a quantity with its unit, of which what is not given is 0, or from a mechanism."""
    if isinstance(entries, Mechanism | Drive):
        return CycleDrive(_on_axis(entries, axis))
    given = CONSTANTS[axis].read(entries, "drive")
    types: Mapping[str, Any] = {name: each.type for name, each in CONSTANTS[axis].entries.items()}
    of = {name: types[name].number(given[name], name) if name in given else 0.0 for name in ("mass", "inertia", *types)}
    mechanism = Mechanism(
        number(of["mass"] + of["inertia"]),
        added([multiplied([number(of["stiffness"]), Name("x")]), number(of["preload"] + of["gravity"])]),
        coulomb=of["dry"],
        viscous=of["viscous"],
        axis="angle" if axis == "angle" else "length",
    )
    return CycleDrive(mechanism, fed_back=of[REGENERATION])


def _on_axis(source: Mechanism | Drive, axis: str) -> Mechanism | Drive:
    """The mechanism or motor, whose input is to move as the cycle does."""
    mechanism = source.mechanism if isinstance(source, Drive) else source
    if mechanism.axis != axis:
        moves = {"angle": "turns", "length": "slides"}
        raise InputError(
            f"drive: the input of the {mechanism.name} {moves[mechanism.axis]} and the motion of the cycle "
            f"{moves[axis]}: "
            f"give the cycle the positions of that input, {'angles' if mechanism.axis == 'angle' else 'lengths'}"
        )
    return source


def read_linear_drive(entries: Mapping[str, Any] | Mechanism | Drive, axis: str) -> tuple[CycleDrive, LinearForce]:
    """A drive whose force is affine in the motion, as of a cam's follower, and that force.

    Raises
    ------
    InputError
        If it is another mechanism or a motor.
    """
    drive = read_drive(entries, axis)
    if drive.linear is None or drive.mechanism.has_end:
        raise InputError(
            f"drive: forces of a cam's follower are of constants such as {{'mass': '2 kg'}}, got {shortened(entries)}; "
            "what a cam and its follower are to the cam's shaft is `cam_mechanism`"
        )
    return drive, drive.linear
