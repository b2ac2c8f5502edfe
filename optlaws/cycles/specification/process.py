"""A process force on a mechanism over the time, the master or a position: its load at the mechanism's input."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Choice, Text
from optlaws.errors import InputError, located
from optlaws.formulas.slopes import derivative, multiplied
from optlaws.formulas.tree import Formula, Name, Table, number, substituted
from optlaws.mechanisms.linkages.entries import JOINED, OverPlace, TableKind, formula_of, rescaled
from optlaws.mechanisms.linkages.mechanism import DIMENSIONS, Mechanism, loaded
from optlaws.motion.quantities import TURN
from optlaws.suggest import unknown_key
from optlaws.tolerances import CLOSURE

_PLACES = "the time t, the master's angle m, the driven position s or the input's x"
FORCES = {"force": "length", "torque": "angle"}


@declared
class ProcessEntries(Declared, title="a process"):
    """The force or the torque of a process, above 0 where it pushes to greater positions, and what it is over."""

    force: Any = entry(OverPlace(_PLACES), "On what slides.", default=None, example=[["0 s", "0 N"], ["0.1 s", "-9 N"]])
    torque: Any = entry(OverPlace(_PLACES), "On what turns, in its place.", default=None, example="2 N m")
    over: str = entry(Choice("time", "master", "driven"), "What it is over, and formulas are of.", default="time")
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
        """The force or the torque as it is given."""
        return getattr(self, self.kind)

    def _check(self) -> None:
        if (self.force is None) == (self.torque is None):
            remedy = "such as force = 300 N" if self.force is None else "not both"
            raise InputError(f"give a force or a torque, {remedy}")


@declared
class MachineProcess(ProcessEntries):
    """A process on a mechanism, at its input or at a driven link."""

    over: str = entry(
        Choice("time", "master", "driven", "input"), "What it is over, and formulas are of.", default="time"
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
    kind = process.kind
    position = _position(mechanism, process.on, kind)
    places, variable = {
        "time": ("time", "t"),
        "master": ("angle", "m"),
        "driven": (FORCES[kind], "s"),
        "input": (mechanism.axis, "x"),
    }[process.over]
    force = formula_of(
        process.given,
        (places, kind),
        f"load: {kind}",
        variable=variable,
        interpolation=process.interpolation,
    )
    end = {"t": period, "m": TURN}.get(variable)
    if end is not None:
        _check_ends(force, variable, end, kind)
    if variable == "m":
        force = rescaled(force, "m", "t", (0.0, TURN / period))
    force = substituted(force, {"s": position})
    return loaded(mechanism, multiplied([number(-1.0), force, derivative(position, "x")]))


def _position(mechanism: Mechanism, on: Any, kind: str) -> Formula:
    """The position on which a force acts, as a formula of the input's."""
    if on is None:
        if DIMENSIONS[mechanism.axis]["load"] != kind:
            raise InputError(
                f"load: the input of the {mechanism.name} takes a {DIMENSIONS[mechanism.axis]['load']}: give one, or "
                "the link on which the force acts, as on='slider'"
            )
        return Name("x")
    driven = dict(mechanism.linkage.driven)
    if on not in driven:
        raise InputError(f"load: on: {unknown_key(on, driven, 'driven link')}")
    return driven[on]


def _check_ends(force: Formula, variable: str, end: float, kind: str) -> None:
    for part in force.walk():
        if isinstance(part, Table) and part.of == Name(variable):
            first, last = part.places[0], part.places[-1]
            if first > CLOSURE * end or last < end * (1.0 - CLOSURE):
                unit = "s" if variable == "t" else "rad"
                raise InputError(
                    f"load: {kind}: its table goes from {first:.6g} to {last:.6g} {unit}, and the cycle from 0 to "
                    f"{end:.6g} {unit}: give a table over the whole cycle"
                )
