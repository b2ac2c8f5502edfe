"""A process force on a mechanism over the time, the master or a position: its load at the mechanism's input."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.slopes import added, derivative, multiplied
from optlaws.formulas.tree import Formula, Name, Table, number, rebuilt, substituted, table_places
from optlaws.mechanisms.linkages.entries import JOINED, TableKind, formula_of
from optlaws.mechanisms.linkages.mechanism import DIMENSIONS, Mechanism
from optlaws.motion.quantities import TURN
from optlaws.numbers import Array
from optlaws.suggest import unknown_key
from optlaws.tolerances import CLOSURE

FORCES = {"force": "length", "torque": "angle"}
OVER = ("time", "master", "driven", "input")
ENTRIES = (*FORCES, "over", "on", "interpolation")


@dataclass(frozen=True)
class ProcessForce:
    """The force of a process on a mechanism's input, as a formula of its position x and of the time t."""

    load: Formula

    def values(self, x: Array, times: Array) -> Array:
        """The load at positions of the input and times in the cycle, N m or N."""
        values = evaluate(self.load, {"x": x, "t": times}, NUMPY)
        return np.broadcast_to(np.asarray(values, dtype=np.float64), np.shape(x))

    def over_span(self, start: float, duration: float) -> Formula:
        """The load over x and k of a law that begins at a time."""
        return _in_k(self.load, start, duration)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times at which the process force has kinks."""
        return tuple(table_places(self.load, "t"))


def is_process(given: Any) -> bool:
    """Whether a load of a cycle is a process force, and nothing elastic."""
    return isinstance(given, Mapping) and bool(FORCES.keys() & given.keys()) and "period" not in given


def read_process(given: Mapping[str, Any], mechanism: Mechanism, period: float) -> ProcessForce:
    """A process force from its entries.

    `force`, or `torque` on a link that turns, is a table, a formula or a quantity, above 0 where it pushes to greater
    positions; `over` the "time", the "master", the position of the "driven" link or of the "input"; `on` names the
    driven link on which it acts, the input itself unless given.

    Raises
    ------
    InputError
        If an entry is unknown or wrong, no link has the name, or a table over time ends within the cycle.
    """
    kind, over, interpolation = process_entries(given, "load", ENTRIES, OVER)
    on = given.get("on")
    position = _position(mechanism, on, kind)
    places, variable = {
        "time": ("time", "t"),
        "master": ("angle", "m"),
        "driven": (FORCES[kind], "s"),
        "input": (mechanism.axis, "x"),
    }[over]
    force = formula_of(
        given[kind],
        (places, kind),
        f"load: {kind}",
        variable=variable,
        interpolation=interpolation,
    )
    end = {"t": period, "m": TURN}.get(variable)
    if end is not None:
        _check_ends(force, variable, end, kind)
    force = _over_time(force, period) if variable == "m" else substituted(force, {"s": position})
    return ProcessForce(multiplied([number(-1.0), force, derivative(position, "x")]))


def process_entries(
    given: Mapping[str, Any], name: str, known: Sequence[str], variables: Sequence[str]
) -> tuple[str, str, TableKind]:
    """The kind of a process, "force" or "torque", its variable, and the continuation of its tables between places.

    >>> process_entries({"force": "3 N", "over": "master"}, "load", ENTRIES, OVER)
    ('force', 'master', 'lines')
    """
    for key in given:
        if key not in known:
            raise InputError(f"{name}: {unknown_key(key, known)}")
    kinds = [key for key in FORCES if key in given]
    if len(kinds) != 1:
        raise InputError(f"{name}: give a force or a torque, {'not both' if kinds else 'such as force = 300 N'}")
    over, interpolation = given.get("over", "time"), given.get("interpolation", "lines")
    if over not in variables:
        raise InputError(f"{name}: over: {unknown_key(over, variables, 'variable')}")
    if interpolation not in tuple(JOINED):
        raise InputError(f"{name}: {unknown_key(interpolation, tuple(JOINED), 'interpolation')}")
    return kinds[0], over, interpolation


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


def _over_time(formula: Formula, period: float) -> Formula:
    """A formula of the master's angle m, rewritten as a formula of the time."""
    return rescaled(formula, "m", "t", (0.0, TURN / period))


def _in_k(formula: Formula, start: float, duration: float) -> Formula:
    """A formula of the time, rewritten as a formula of k."""
    return rescaled(formula, "t", "k", (start, duration))


def rescaled(formula: Formula, name: str, other: str, line: tuple[float, float]) -> Formula:
    """The formula with first + slope times another name for one; tables over it become tables over the other.

    >>> from optlaws.formulas.reading import read
    >>> rescaled(read("3*t"), "t", "m", (0.0, 0.5))
    3*0.5*m
    """
    first, slope = line
    if formula == Name(name):
        way = multiplied([number(slope), Name(other)])
        return added([number(first), way]) if first else way
    if isinstance(formula, Table) and formula.of == Name(name):
        places = tuple((place - first) / slope for place in formula.places)
        return Table(Name(other), places, formula.values, formula.kind, formula.order)
    if name not in formula.names():
        return formula
    return rebuilt(formula, [rescaled(part, name, other, line) for part in formula.parts])
