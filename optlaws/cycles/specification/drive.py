"""The drive of a cycle, as which constants such as a mass are read too, and the force of a process on its mechanism."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from optlaws.cycles.specification.limits import FORCES
from optlaws.echo import shortened, unknown_key
from optlaws.entries.declared import Declared, TableOf, declared, entry
from optlaws.entries.value_types import Choice, Measured, Text
from optlaws.entries.value_types import Number as Share
from optlaws.errors import InputError, located
from optlaws.formulas.slopes import added, derivative, multiplied
from optlaws.formulas.tree import Name, Table, number, substituted
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism, loaded
from optlaws.mechanisms.linkages.mechanism_formulas import (
    DIMENSIONS,
    JOINED,
    LinearForce,
    OverPlace,
    TableKind,
    formula_of,
    line_of,
    rescaled,
)
from optlaws.motion.quantities import TURN, in_degrees
from optlaws.tolerances import CLOSURE


def _constants(weight: str, inertia: str, stiffness: str, force: str, viscous: str) -> TableOf:
    """The constants of a drive: the name of its weight, and the dimensions of that and of what acts on it."""

    def given(kind: Any, about: str) -> Any:
        return entry(kind, about, default=None, example=getattr(kind, "example", 0.5))

    types = {
        weight: given(Measured(inertia, least=0.0), "What is moved."),
        "stiffness": given(Measured(stiffness), "Of a spring without force at 0."),
        "preload": given(Measured(force), "A constant force against the motion to greater positions."),
        "gravity": given(Measured(force), "The weight, likewise."),
        "viscous": given(Measured(viscous, least=0.0), "Friction in proportion to the speed."),
        "dry": given(Measured(force, least=0.0), "Friction that does not depend on the speed."),
        "regeneration": given(Share(least=0.0, most=1.0), "The share of the braking energy that is used again."),
    }
    return TableOf("key", types)


#: constants of a drive, for slides and for tables
CONSTANTS = {
    "length": _constants("mass", "mass", "stiffness", "force", "viscous friction"),
    "angle": _constants("inertia", "moment of inertia", "torsional stiffness", "torque", "rotary viscous friction"),
}


def _in_proportion(mechanism: Mechanism) -> str:
    """How far the input turns for a way of a slide that moves in proportion to it; blank where none does."""
    for name, position in mechanism.linkage.driven if mechanism.axis == "angle" else ():
        line = line_of(position)
        if line is not None and line[0]:
            return f": 10 mm of the {name} are {in_degrees(0.01 / abs(line[0]))} of the input"
    return ""


def read_drive(entries: Mapping[str, Any] | Mechanism | Drive, axis: str) -> Drive:
    """A drive, a mechanism that is driven at its input, or constants with their units, 0 unless given, as one.

    Raises
    ------
    InputError
        If an entry is wrong, or the input slides where the cycle turns, or turns where it slides.
    """
    if isinstance(entries, Mechanism | Drive):
        drive = entries if isinstance(entries, Drive) else Drive.of_input(entries)
        places, moves = drive.mechanism.axis, {"angle": "turns", "length": "slides"}
        if places == axis:
            return drive
        raise InputError(
            f"drive: the input of the {drive.mechanism.name} {moves[places]} and the motion of the cycle "
            f"{moves[axis]}: give the cycle the positions of that input, {places}s{_in_proportion(drive.mechanism)}"
        )
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
    return Drive.of_input(mechanism, of["regeneration"])


def read_linear_drive(entries: Mapping[str, Any] | Mechanism | Drive, axis: str) -> tuple[Drive, LinearForce]:
    """A drive whose force is affine in the motion, as of a cam's follower, and that force.

    Raises
    ------
    InputError
        If it is another mechanism or a motor.
    """
    drive = read_drive(entries, axis)
    if drive.linear is None or drive.mechanism.has_end or drive.has_motor:
        raise InputError(
            f"drive: forces of a cam's follower are of constants such as {{'mass': '2 kg'}}, got {shortened(entries)}; "
            "what a cam and its follower are to the cam's shaft is `cam_mechanism`"
        )
    return drive, drive.linear


_PLACES = "the time t, the master's angle m, the driven position s or the input's x"
_AXES = {force: axis for axis, force in FORCES.items()}


@declared
class ProcessEntries(Declared, title="a process"):
    """The force or the torque of a process, above 0 where it pushes to greater positions, and what it is over."""

    force: Any = entry(
        OverPlace(_PLACES), "The force on a slide.", default=None, example=[["0 s", "0 N"], ["0.1 s", "-9 N"]]
    )
    torque: Any = entry(
        OverPlace(_PLACES), "The torque on what turns, in place of a force.", default=None, example="2 N m"
    )
    over: str = entry(Choice("time", "master", "driven"), "The argument of tables and formulas.", default="time")
    interpolation: TableKind = entry(
        Choice(*JOINED),
        "Of tables: straight lines, or a smooth curve of their shape.",
        default="lines",
    )

    @property
    def kind(self) -> str:
        """Whether it is a "force" or a "torque"."""
        return "force" if self.torque is None else "torque"

    @property
    def given(self) -> Any:
        return getattr(self, self.kind)

    def _check(self) -> None:
        if (self.force is None) == (self.torque is None):
            remedy = "such as force = 300 N" if self.force is None else "not both"
            raise InputError(f"give a force or a torque, {remedy}")


@declared
class MachineProcess(ProcessEntries):
    """A process on a mechanism, at its input or at a driven link."""

    over: str = entry(
        Choice("time", "master", "driven", "input"), "The argument of tables and formulas.", default="time"
    )
    on: str | None = entry(
        Text(), "The driven link on which it acts; the input itself unless given.", default=None, example="slider"
    )


def read_process(given: Mapping[str, Any], mechanism: Mechanism, period: float) -> Mechanism:
    """The mechanism with the force of a process on it besides, from the entries of a `MachineProcess`.

    Raises
    ------
    InputError
        If an entry is unknown or wrong, no link has the name, or a table over time ends within the cycle.
    """
    with located("load"):
        process = MachineProcess.from_dict(given)
    kind, taken = process.kind, DIMENSIONS[mechanism.axis]["load"]
    driven = dict(mechanism.linkage.driven)
    if process.on is None and taken != kind:
        raise InputError(
            f"load: the input of the {mechanism.name} takes a {taken}: give one, or the link on which the force acts, "
            "as on='slider'"
        )
    if process.on is not None and process.on not in driven:
        raise InputError(f"load: on: {unknown_key(process.on, driven, 'driven link')}")
    position = Name("x") if process.on is None else driven[process.on]
    places, variable, end, unit = {
        "time": ("time", "t", period, "s"),
        "master": ("angle", "m", TURN, "rad"),
        "driven": (_AXES[kind], "s", 0.0, ""),
        "input": (mechanism.axis, "x", 0.0, ""),
    }[process.over]
    force = formula_of(
        process.given, (places, kind), f"load: {kind}", variable=variable, interpolation=process.interpolation
    )
    for part in force.different if unit else ():
        if isinstance(part, Table) and part.of == Name(variable):
            first, last = part.places[0], part.places[-1]
            if first > CLOSURE * end or last < end * (1.0 - CLOSURE):
                raise InputError(
                    f"load: {kind}: its table goes from {first:.6g} to {last:.6g} {unit}, and the cycle from 0 to "
                    f"{end:.6g} {unit}: give a table over the whole cycle"
                )
    if variable == "m":
        force = rescaled(force, "m", "t", (0.0, TURN / period))
    force = substituted(force, {"s": position})
    return loaded(mechanism, multiplied([number(-1.0), force, derivative(position, "x")]))
