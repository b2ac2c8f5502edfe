"""Options of commands that read a problem, derived from the table of a problem's entries."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import wraps
from typing import Any, Literal

from optlaws.cli.options import Command, Option, Whole, takes
from optlaws.echo import shortened
from optlaws.entries import value_types
from optlaws.entries.declared import Entry
from optlaws.entries.value_types import Either, Listed, Switch, Text, ValueType
from optlaws.errors import InputError
from optlaws.synthesis import Basis, BoundaryConditions
from optlaws.synthesis.problem.fields import ConstantBounds
from optlaws.synthesis.problem.problem import ENTRIES
from optlaws.synthesis.problem.ranges import as_range, read_bounds
from optlaws.synthesis.spaces.bases import read_breaks


def _numbers(text: str) -> list[float]:
    try:
        return [float(number) for number in text.replace(",", " ").split()]
    except ValueError:
        raise InputError(f'start and end are numbers such as "0, 0.5", got {shortened(text)}') from None


#: type and reader of an option for each type of an entry
_KINDS: dict[type[ValueType], tuple[Any, Callable[[Any], Any] | None]] = {
    ConstantBounds: (float, None),
    Switch: (bool, None),
    Text: (str, None),
    value_types.Number: (float, None),
    value_types.Whole: (Whole, None),
    Listed: (str, _numbers),
    Either: (str, read_breaks),
}


def _option(
    name: str, entry: str, about: str = "", read: Callable[[Any], Any] | None = None, kind: Any = None
) -> Option:
    each = ENTRIES[entry]
    known, plain = (kind, None) if kind is not None else _KINDS[type(each.type)]
    such = f' Numbers such as "{", ".join(map(str, each.example))}".' if plain is not None else ""
    signed = isinstance(each.type, Listed)
    return Option(name, known, about or each.about + such, read=read or plain, signed=signed)


def _at_most(name: str) -> Callable[[float], Any]:
    return lambda high: as_range((None, high), name)


#: entries whose options have names of their own, or mean less than files can say
_OWN: dict[str, tuple[Option, ...]] = {
    "B": (_option("--peak-velocity", "B", "B, above 1 (dimensionless; the mean velocity is 1); free unless given."),),
    "C": (_option("--most-acceleration", "C", "C at most this.", _at_most("C")),),
    "D": (_option("--most-power", "D", "D at most this.", _at_most("D")),),
    "J": (_option("--most-jerk", "J", "J at most this.", _at_most("J")),),
    "symmetric": (_option("--unsymmetric", "symmetric", "Seek among unsymmetric laws too.", lambda given: not given),),
    "bounds": (
        Option("--most", list[str], "Any constant at most a value, such as rms_c=4; may be repeated."),
        Option("--least", list[str], "Any constant at least a value; may be repeated."),
    ),
    "basis": (_option("--basis", "basis", kind=Literal[tuple(Basis.kinds)]),),
    "windows": (_option("--window", "windows", kind=list[str]),),
}


def options_of(entry: Entry) -> tuple[Option, ...]:
    """The options that give an entry.

    Examples
    --------
    >>> [option.name for option in options_of(ENTRIES["bounds"])], options_of(ENTRIES["degree"])[0].name
    (['--most', '--least'], '--degree')
    """
    return _OWN.get(entry.name) or (_option(f"--{entry.name}", entry.name),)


def asks_for_a_problem(
    *, given: Mapping[str, Any] | None = None, refused: Mapping[str, str] | None = None
) -> Callable[[Command], Command]:
    """Give a command the options of a problem; its parameter `entries` takes those that were given, as a dict.

    Parameters
    ----------
    given
        By entry: the value of its option unless given; `...` requires it.
    refused
        By entry: why the command does not take it.
    """
    why, defaults = refused or {}, given or {}
    options = {
        option.keyword: replace(
            option, default=_default(entry, option, defaults, why), shown=entry.name not in why, read=None
        )
        for entry in ENTRIES.values()
        for option in options_of(entry)
    }

    def decorated(command: Command) -> Command:
        @takes(entries=options)
        @wraps(command)
        def called(entries: Mapping[str, Any], **values: Any) -> None:
            command(_entries(entries, why), **values)

        return called

    return decorated


def _default(entry: Entry, option: Option, given: Mapping[str, Any], refused: Mapping[str, str]) -> Any:
    if option.type is bool:
        return False
    if entry.name in refused:
        return None
    return given.get(entry.name, entry.default if entry.name == "minimise" else None)


def _entries(typed: Mapping[str, Any], refused: Mapping[str, str]) -> dict[str, Any]:
    """The entries that the values of options stand for."""
    entries: dict[str, Any] = {}
    for entry in ENTRIES.values():
        options = options_of(entry)
        values = [typed[option.keyword] for option in options]
        first = next((option for option, value in zip(options, values, strict=True) if _is_given(value)), None)
        if first is None:
            continue
        if entry.name in refused:
            raise InputError(f"{first.name} is not for this command: {refused[entry.name]}")
        entries[entry.name] = (
            read_bounds(*(value or [] for value in values)) if len(values) > 1 else first.value(*values)
        )
    _check_ends(entries)
    _check_breaks(entries)
    return entries


def _is_given(value: object) -> bool:
    return value is not None and value is not False


def _check_ends(entries: dict[str, Any]) -> None:
    """Require the order if nothing fixes it; periodic laws, moving ends and inflexions make laws unsymmetric."""
    ends = [entries[name] for name in ("start", "end") if name in entries]
    if len(ends) == 1:
        raise InputError("--start and --end go together")
    if ends:
        boundary = BoundaryConditions(*map(tuple, ends))
    elif "order" not in entries:
        raise InputError("give --order, the number of conditions at each end, or the conditions by --start and --end")
    repeats = entries.get("basis") == "periodic"
    if repeats or "inflexion" in entries or (ends and boundary != BoundaryConditions.rest(boundary.order)):
        entries["symmetric"] = False


def _check_breaks(entries: Mapping[str, Any]) -> None:
    if "basis" not in entries:
        return
    piecewise = "breaks" in inspect.signature(Basis.kinds[entries["basis"]]).parameters
    if piecewise != ("breaks" in entries) or ("continuity" in entries and not piecewise):
        raise InputError(
            "--basis bsplines, pieces and periodic need --breaks, the others take neither --breaks nor --continuity"
        )
    if "straight" in entries and entries["basis"] != "periodic":
        raise InputError("--straight is for --basis periodic alone")
