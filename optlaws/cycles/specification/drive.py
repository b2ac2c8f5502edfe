"""The drive of a cycle: a mechanism with or without its motor, as which constants such as a mass are read too."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from optlaws.echo import shortened
from optlaws.entries.declared import TableOf, entry
from optlaws.entries.value_types import Measured
from optlaws.entries.value_types import Number as Share
from optlaws.errors import InputError
from optlaws.formulas.slopes import added, multiplied
from optlaws.formulas.tree import Name, number
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.dimensionless import LinearForce
from optlaws.mechanisms.linkages.mechanism import Mechanism

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


def read_drive(entries: Mapping[str, Any] | Mechanism | Drive, axis: str) -> Drive:
    """A drive, a mechanism that is driven at its input, or constants with their units, 0 unless given, as one.

    Raises
    ------
    InputError
        If an entry is wrong, or the input slides where the cycle turns, or turns where it slides.
    """
    if isinstance(entries, Mechanism | Drive):
        return _on_axis(entries if isinstance(entries, Drive) else Drive.of_input(entries), axis)
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
    return Drive.of_input(mechanism, of[REGENERATION])


def _on_axis(drive: Drive, axis: str) -> Drive:
    """The drive of a mechanism, whose input is to move as the cycle does."""
    mechanism = drive.mechanism
    if mechanism.axis != axis:
        moves = {"angle": "turns", "length": "slides"}
        raise InputError(
            f"drive: the input of the {mechanism.name} {moves[mechanism.axis]} and the motion of the cycle "
            f"{moves[axis]}: "
            f"give the cycle the positions of that input, {'angles' if mechanism.axis == 'angle' else 'lengths'}"
        )
    return drive


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
