"""Constants of machines as text: the machine is part of it, so that a stored problem or proof needs nothing else."""

from __future__ import annotations

import json
from typing import Any, TypedDict

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.numbers import numbers
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import CLOSURE

_LATEST = 100.0


def text_of(machine: StateSpace, output: str) -> str:
    """A machine with a selected output, as quoted JSON.

    >>> print(text_of(StateSpace([[-2.0]], [[2.0]], [[1.0]], outputs=["speed"]), "speed"))
    '{"A":[[-2.0]],"B":[[2.0]],"C":[[1.0]],"D":[[0.0]],"inputs":"a","outputs":["speed"]}'
    """
    place = machine.place(output)
    plain = machine.to_dict() | {"outputs": [output]}
    plain |= {name: [plain[name][place]] for name in "CD"}
    return f"'{json.dumps(plain, separators=(',', ':'), ensure_ascii=False)}'"


def title_of(machine: StateSpace, what: str, output: str, *words: str) -> str:
    """The title of a constant of a machine in messages."""
    count = len(machine.A)
    states = "1 state" if count == 1 else f"{count} states"
    return ", ".join([f"{what} {output!r} of a machine of {states}", *words])


def machine_of(given: Any) -> StateSpace:
    """The machine that is given, or that a text describes."""
    if isinstance(given, StateSpace):
        return given
    if not isinstance(given, str):
        raise InputError(f"of must be a machine, or one as JSON text, got {shortened(given)}")
    try:
        data = reading.json_text(given, "of, a machine,")
    except InputError as error:
        raise InputError(f"of must be a machine as JSON text, {{...}}: {error}") from None
    return StateSpace.from_dict(data)


def check_repeats(name: str, machine: StateSpace, stroke: float) -> None:
    """Refuse a law that ends elsewhere than it begins where the machine is driven by displacements."""
    if "a" in machine.inputs and abs(stroke) > CLOSURE:
        short = name.partition("(")[0]
        raise InputError(
            f"{short}: steady is of a law that ends where it begins, but its stroke is {stroke:g}: a machine whose "
            "motion goes on is driven by b and c alone"
        )


def check_rest(name: str, space: LawSpace) -> None:
    """Refuse laws that do not begin and end at rest."""
    if space.start_velocity != 0.0 or space.velocity_change != 0.0 or space.boundary.order < 2:
        short = name.partition("(")[0]
        raise InputError(f"{short} of a machine needs laws from rest to rest, of order 2 at least")


class OutputEntries(TypedDict):
    """The common entries of constants of an output."""

    machine: StateSpace
    output: str
    within: tuple[float, float]
    cycle: tuple[float, float] | None
    steady: bool
    offset: float


def output_entries(
    of: str | StateSpace, output: str | None, *, within: object, cycle: object, steady: object, offset: object
) -> tuple[OutputEntries, list[str]]:
    """The checked entries of an output's constant, and the words for them in a text."""
    machine = machine_of(of)
    name = machine.outputs[machine.place(output)]
    times, pauses = _pair(within, "within"), None
    if not times[0] < times[1]:
        raise InputError(f"within must be two times, the first before the last, got {shortened(within)}")
    words = [f"of={text_of(machine, name)}"]
    if cycle is not None:
        pauses = _pair(cycle, "cycle")
        times = 0.0, 2.0 + sum(pauses)
        words.append(f"cycle=({pauses[0]!r}, {pauses[1]!r})")
    elif times != (0.0, 1.0):
        words.append(f"within=({times[0]!r}, {times[1]!r})")
    repeats = _repeats(steady, alone=pauses is None and times == (0.0, 1.0))
    words += ["steady=True"] if repeats else []
    (added,) = numbers([offset], "offset")
    words += [f"offset={added!r}"] if added else []
    entries = OutputEntries(machine=machine, output=name, within=times, cycle=pauses, steady=repeats, offset=added)
    return entries, words


def _repeats(steady: object, *, alone: bool) -> bool:
    # in a text it is a word
    steady = {"True": True, "False": False}.get(steady, steady) if isinstance(steady, str) else steady
    if not isinstance(steady, bool):
        raise InputError(f"steady must be True or False, got {shortened(steady)}")
    if steady and not alone:
        raise InputError("steady is of a law that is a whole cycle: leave within, dwell and cycle out")
    return steady


def _pair(value: object, name: str) -> tuple[float, float]:
    pair = numbers(value, name) if isinstance(value, list | tuple) else ()
    if len(pair) != 2:
        raise InputError(f"{name} must be two times in durations of the rise, got {shortened(value)}")
    return time_of(pair[0], name), time_of(pair[1], name)


def time_of(value: float, name: str) -> float:
    """A time in durations of the rise."""
    (time,) = numbers([value], name)
    if not 0.0 <= time <= _LATEST:
        raise InputError(f"{name}: times are durations of the rise, from 0 to {_LATEST:g}, got {shortened(value)}")
    return time
