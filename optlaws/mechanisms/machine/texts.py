"""Constants of machines as text: the machine is part of it, so that a stored problem or proof needs nothing else."""

from __future__ import annotations

import json
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.synthesis.spaces.space import LawSpace

_CLOSED = 1e-9


def text_of(machine: StateSpace, output: str) -> str:
    """A machine with one of its outputs as JSON in quotes.

    Examples
    --------
    >>> print(text_of(StateSpace([[-2.0]], [[2.0]], [[1.0]], outputs=["speed"]), "speed"))
    '{"A":[[-2.0]],"B":[[2.0]],"C":[[1.0]],"D":[[0.0]],"inputs":"a","outputs":["speed"]}'
    """
    place = machine.place(output)
    plain = machine.to_dict() | {"outputs": [output]}
    plain |= {name: [plain[name][place]] for name in "CD"}
    return f"'{json.dumps(plain, separators=(',', ':'), ensure_ascii=False)}'"


def title_of(machine: StateSpace, what: str, output: str, *said: str) -> str:
    """What messages call a constant of a machine.

    Examples
    --------
    >>> title_of(StateSpace([[-2.0]], [[2.0]], [[1.0]], outputs=["speed"]), "peak of", "speed", "over a cycle")
    "peak of 'speed' of a machine of 1 state, over a cycle"
    """
    count = len(machine.A)
    states = "1 state" if count == 1 else f"{count} states"
    return ", ".join([f"{what} {output!r} of a machine of {states}", *said])


def machine_of(given: Any) -> StateSpace:  # noqa: ANN401 - a machine, or what text calls one
    """The machine that is given, or that a text says.

    Raises
    ------
    InputError
        If it is none.

    Examples
    --------
    >>> machine_of('{"A": [[-2]], "B": [[2]], "C": [[1]]}').A
    ((-2.0,),)
    """
    if isinstance(given, StateSpace):
        return given
    if not isinstance(given, str):
        raise InputError(f"of must be a machine, or one as JSON text, got {shortened(given)}")
    try:
        data = json.loads(given)
    except (ValueError, RecursionError):
        raise InputError(f"of must be a machine as JSON text, {{...}}, got {shortened(given)}") from None
    return StateSpace.from_dict(data)


def check_repeats(name: str, machine: StateSpace, stroke: float) -> None:
    """Refuse a law that ends elsewhere than it begins where the machine is driven by displacements.

    Raises
    ------
    InputError
        If it does.
    """
    if "a" in machine.inputs and abs(stroke) > _CLOSED:
        short = name.partition("(")[0]
        raise InputError(
            f"{short}: steady is of a law that ends where it begins, but its stroke is {stroke:g}: a machine whose "
            "motion goes on is driven by b and c alone"
        )


def check_rest(name: str, space: LawSpace) -> None:
    """Refuse laws that do not begin and end at rest.

    Raises
    ------
    InputError
        If they do not.
    """
    if space.start_velocity != 0.0 or space.velocity_change != 0.0 or space.boundary.order < 2:
        short = name.partition("(")[0]
        raise InputError(f"{short} of a machine needs laws from rest to rest, of order 2 at least")
