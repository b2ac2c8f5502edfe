"""Options of commands that read a problem, derived from the table of a problem's entries."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Literal

from optlaws.cli.law_options import numbers_in
from optlaws.cli.options import Option, Options, Whole
from optlaws.entries import value_types
from optlaws.entries.declared import Entry
from optlaws.entries.value_types import Either, Listed, Switch, Text, ValueType
from optlaws.errors import InputError
from optlaws.synthesis import Basis, BoundaryConditions
from optlaws.synthesis.problem.fields import ConstantBounds
from optlaws.synthesis.problem.problem import ENTRIES
from optlaws.synthesis.problem.ranges import as_range, read_bounds
from optlaws.synthesis.spaces.bases import read_breaks

#: type and reader of an option for each type of an entry
_KINDS: dict[type[ValueType], tuple[Any, Callable[[Any], Any] | None]] = {
    ConstantBounds: (float, None),
    Switch: (bool, None),
    Text: (str, None),
    value_types.Number: (float, None),
    value_types.Whole: (Whole, None),
    Listed: (str, lambda text: numbers_in(text, 'start and end are numbers such as "0, 0.5"')),
    Either: (str, read_breaks),
}


def _at_most(name: str, option: str) -> dict[str, Any]:
    return {"name": option, "about": f"{name} at most this.", "read": lambda high: as_range((None, high), name)}


#: of laws whose ends are not given: those of problem files of moves and cycles
_ORDER = 3
#: options that have names of their own, or mean less than files can say
_OWN: dict[str, dict[str, Any]] = {
    "B": {"name": "--peak-velocity", "about": "B, above 1 (dimensionless; the mean velocity is 1); free unless given."},
    "C": _at_most("C", "--most-acceleration"),
    "D": _at_most("D", "--most-power"),
    "J": _at_most("J", "--most-jerk"),
    "order": {"about": f"Conditions at each end; {_ORDER} unless given, or as many as --start and --end have."},
    "symmetric": {
        "name": "--unsymmetric",
        "about": "Include unsymmetric laws.",
        "read": lambda given: not given,
    },
    "basis": {"type": Literal[tuple(Basis.kinds)]},
    "windows": {"name": "--window", "type": list[str], "read": None},
}
_BOUNDS = (
    Option("--most", list[str], "Any constant at most a value, such as rms_c=4; may be repeated."),
    Option("--least", list[str], "Any constant at least a value; may be repeated."),
)


def options_of(entry: Entry) -> tuple[Option, ...]:
    """The options that give an entry.

    >>> [option.name for option in options_of(ENTRIES["bounds"])], options_of(ENTRIES["degree"])[0].name
    (['--most', '--least'], '--degree')
    """
    if entry.name == "bounds":
        return _BOUNDS
    kind, read = _KINDS.get(type(entry.type), (str, None))
    given = _OWN.get(entry.name, {})
    such = "" if given or read is None else f' Numbers such as "{", ".join(map(str, entry.example))}".'
    plain = {"name": f"--{entry.name}", "type": kind, "about": entry.about + such, "read": read}
    return (Option(signed=isinstance(entry.type, Listed), **{**plain, **given}),)


class _ProblemOptions(Options):
    """The options of a problem, which give its entries."""

    def __init__(self, given: Mapping[str, Any], refused: Mapping[str, str]) -> None:
        self._refused = refused
        for entry in ENTRIES.values():
            for option in options_of(entry):
                usual = None if entry.name in refused else given.get(entry.name)
                default = False if option.type is bool else usual
                self[option.keyword] = replace(option, default=default, shown=entry.name not in refused)

    def values_of(self, typed: Mapping[str, Any]) -> dict[str, Any]:
        entries: dict[str, Any] = {}
        for entry in ENTRIES.values():
            values = {option: typed[option.keyword] for option in options_of(entry)}
            first = next((option for option, value in values.items() if value is not None and value is not False), None)
            if first is None:
                continue
            if entry.name in self._refused:
                raise InputError(f"{first.name} is not for this command: {self._refused[entry.name]}")
            bounds = [value or [] for value in values.values()]
            entries[entry.name] = read_bounds(*bounds) if len(bounds) > 1 else first.value(values[first])
        if not {"order", "start", "end"} & entries.keys():
            entries["order"] = _ORDER
        return entries | ({"symmetric": False} if _is_unsymmetric(entries) else {})


def problem_options(given: Mapping[str, Any], refused: Mapping[str, str] | None = None) -> Options:
    """The options of a problem, with values unless `given` by entry, and why a command does not take some."""
    return _ProblemOptions({"minimise": ENTRIES["minimise"].default, **given}, refused or {})


def _is_unsymmetric(entries: Mapping[str, Any]) -> bool:
    """Whether laws are so without a word: periodic ones, those with an inflexion, and those whose ends move."""
    if "start" in entries and "end" in entries:
        ends = BoundaryConditions(tuple(entries["start"]), tuple(entries["end"]))
        if ends != BoundaryConditions.rest(ends.order):
            return True
    return entries.get("basis") == "periodic" or "inflexion" in entries
