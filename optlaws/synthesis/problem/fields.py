"""The entries of a problem, which files, studies, sweeps and commands know, and what `Problem` has of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import isfinite
from operator import eq
from typing import Any

from optlaws.echo import shortened
from optlaws.entries.declared import TableOf, entry
from optlaws.entries.value_types import (
    Choice,
    Either,
    Listed,
    Number,
    ReadBy,
    Switch,
    Table,
    Text,
    Together,
    Whole,
    is_list,
)
from optlaws.errors import InputError, located
from optlaws.files.reading import check_names
from optlaws.numbers import MOST_DEGREE, MOST_ORDER, bounded
from optlaws.synthesis.problem import checks
from optlaws.synthesis.problem.ranges import Bounds, Range
from optlaws.synthesis.problem.windows import Window, read_window
from optlaws.synthesis.spaces.bases import basis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

FREE = "free"


class ConstantBounds(Either):
    """Of a constant: a number, a pair of a least and a greatest one, or "free", which takes a bound away.

    >>> ConstantBounds().read([1, 2], "B"), ConstantBounds().read("free", "B")
    ((1.0, 2.0), 'free')
    """

    def __init__(self) -> None:
        pair = Together(Number(least=0.0), Number(least=0.0), names=("low", "high"))
        super().__init__(Number(above=0.0), pair, Choice(FREE), which=_form_of_bounds)

    @property
    def words(self) -> str:
        return 'a number, a pair [low, high] or "free"'


def _form_of_bounds(value: Any) -> int:
    return 1 if isinstance(value, list | tuple) else 2 * (isinstance(value, str) and value == FREE)


class ProblemTable(TableOf):
    """A table of entries of problems, which stay plain data, in the order in which they are declared here.

    None stands for what is not given, as in stored studies.
    """

    def read(self, value: Any, name: str) -> dict[str, Any]:
        if isinstance(value, Mapping):
            value = {key: part for key, part in value.items() if part is not None}
        given = super().read(value, name)
        return {key: each.type.plain(given[key]) for key, each in self.entries.items() if key in given}

    @property
    def words(self) -> str:
        return "a table of entries of a problem"

    def schema(self) -> dict[str, Any]:
        types = {key: {"anyOf": [each.type.schema(), {"type": "null"}]} for key, each in self.entries.items()}
        return {**super().schema(), "properties": types}


def _entry(type_: Any, about: str, label: str = "", *, default: Any = None, example: Any = None) -> Any:
    return entry(type_, about, label=label, default=default, example=example)


_NUMBERS = Listed(Number())
_WINDOW = Either(
    ReadBy(dict, "a table", json={"type": "object"}), Text(), which=lambda value: int(isinstance(value, str))
)

#: in the order in which files name them; those without a default ask nothing unless given
PROBLEM = ProblemTable(
    "key",
    {
        "minimise": _entry(
            Text(),
            "What to minimise: a constant, a sum or maximum of some, or a formula such as rms(c + 3*b).",
            "minimised",
            default="C",
        ),
        "B": _entry(ConstantBounds(), "Peak velocity, above 1: the mean velocity is 1.", "B asked", example=[1.5, 1.8]),
        "C": _entry(ConstantBounds(), "Peak acceleration.", "C asked"),
        "D": _entry(ConstantBounds(), "Peak power.", "D asked"),
        "J": _entry(ConstantBounds(), "Peak jerk.", "J asked"),
        "order": _entry(
            Whole(1, MOST_ORDER),
            "Number l of boundary conditions at each end: 3 for acceleration 0, 4 for jerk 0 too.",
            "order l",
            example=4,
        ),
        "bounds": _entry(
            Table(ConstantBounds()),
            "The same for any constant, also by names with arguments, such as `peak(c - 2*b)`.",
            example={"rms_c": [0, 4], "snap": [0, 900]},
        ),
        "inflexion": _entry(Number(), "The k of the peak velocity, where c is 0; of unsymmetric laws.", example=0.4),
        "basis": _entry(
            Text(), "Basis of Z(k): powers, chebyshev, bernstein, bsplines, pieces or periodic.", default="chebyshev"
        ),
        "degree": _entry(
            Whole(most=MOST_DEGREE), "Degree of Z(k), or of the law on each piece.", "degree of Z", default=9
        ),
        "breaks": _entry(
            Either(Whole(1), Listed(Number(), least=2), which=is_list),
            "For bsplines, pieces and periodic: places from 0 to 1, or how many equal pieces there are.",
            example=[0, 0.3, 1],
        ),
        "continuity": _entry(Whole(), "For bsplines and pieces: order up to which derivatives are continuous."),
        "straight": _entry(
            _NUMBERS, "For periodic: numbers, from 0 on, of the pieces without acceleration.", example=[0, 2]
        ),
        "monotone": _entry(Switch(), "Ask b >= 0 too: no return within the motion.", default=False),
        "symmetric": _entry(Switch(), "Ask a(k) + a(1-k) = 1; not of uneven formulas unless given.", default=True),
        "start": _entry(
            _NUMBERS, "Values of a, b, c, ... at k = 0; rest unless given. They tell the order too.", example=[0, 0.5]
        ),
        "end": _entry(_NUMBERS, "Values of a, b, c, ... at k = 1; rest unless given.", example=[1, 0.5]),
        "windows": _entry(
            Listed(_WINDOW),
            "a, b, c, j or a formula in bounds, such as `a = 0.3 @ 0.4` or `c + 0.2*b <= 5`.",
            example=["b <= 1.2 @ 0.2..0.3", {"quantity": "a", "value": 0.3, "at": 0.4}],
        ),
    },
)
ENTRIES = PROBLEM.entries
#: lists of what entries are in turn, several in one table at a time
SWEPT = ProblemTable(
    "key", {name: _entry(Listed(each.type, least=1), each.about, each.label) for name, each in ENTRIES.items()}
)

#: the constants that have an entry of their own
CONSTANTS = tuple(name for name, each in ENTRIES.items() if isinstance(each.type, ConstantBounds))


@dataclass(frozen=True)
class Field:
    """A field of `Problem`, and how it is made of entries."""

    name: str
    check: Callable[[Any], Any]  #: whatever was given -> what the problem keeps; its error names the field
    #: whether a warm start leads from one value to another: equal values, or values that differ in numbers
    near: Callable[[Any, Any], bool] = eq
    compared: str = ""  #: the attribute of `Problem` that `near` compares; the field unless given
    parts: tuple[str, ...] = ()  #: its entries, where it has several
    read: Callable[..., Any] | None = None  #: entries, by keywords -> what `check` takes; the entry unless given
    plain: Callable[[Any], Any] | None = None  #: what the problem keeps -> its entry, None for none, or its entries

    def given(self, data: Mapping[str, Any]) -> dict[str, Any]:
        """What entries say of the field, by its name; nothing where none of them is its own."""
        entries = {name: data[name] for name in self.parts or (self.name,) if name in data}
        if not entries:
            return {}
        return {self.name: entries[self.name] if self.read is None else self.read(**entries)}

    def entries(self, problem: object) -> dict[str, Any]:
        """The entries of what a problem keeps, plain and JSON-able."""
        value = getattr(problem, self.name)
        plain = value if self.plain is None else self.plain(value)
        if self.parts:
            return dict(plain)
        return {} if plain is None else {self.name: plain}


def _limited_alike(first: Any, second: Any) -> bool:
    """Numbers, ranges bounded on the same side, or nothing."""
    if isinstance(first, Range) and isinstance(second, Range):
        return isfinite(first.high) == isfinite(second.high)
    return type(first) is type(second)


def _bounded_alike(first: Mapping[Any, Range], second: Mapping[Any, Range]) -> bool:
    return list(first) == list(second) and all(map(_limited_alike, first.values(), second.values()))


def _plain_range(limits: Any) -> Any:
    return [limits.low, bounded(limits.high)] if isinstance(limits, Range) else limits


def _joined_basis(**entries: Any) -> Any:
    name, degree = (entries.pop(entry, ENTRIES[entry].default) for entry in ("basis", "degree"))
    return basis(name, degree, **entries)


def _plain_ends(boundary: BoundaryConditions | None) -> dict[str, Any]:
    if boundary is None:
        return {}
    return {"start": [float(v) for v in boundary.start], "end": [float(v) for v in boundary.end]}


def _read_windows(windows: Any) -> tuple[Window, ...]:
    given = checks.listed(windows, "windows")
    with located("windows"):
        return tuple(read_window(window) if isinstance(window, str) else Window.from_dict(window) for window in given)


#: in the order in which problems are written: first those that each of them has
FIELDS: tuple[Field, ...] = (
    Field(
        "minimise",
        checks.objective,
        near=lambda first, second: [term for _, term in first.terms] == [term for _, term in second.terms],
        compared="objective",
        plain=str,
    ),
    Field("order", checks.order),
    Field(
        "basis",
        checks.chosen_basis,
        near=lambda *_: True,  # the solver compares the spaces that the bases span
        parts=("basis", "degree", "breaks", "continuity", "straight"),
        read=_joined_basis,
        plain=lambda basis: basis.to_dict(),
    ),
    Field("monotone", partial(checks.switch, name="monotone")),
    Field("symmetric", checks.symmetric),
    *(Field(name, partial(checks.constant, name=name), near=_limited_alike, plain=_plain_range) for name in CONSTANTS),
    Field(
        "bounds",
        Bounds,
        near=_bounded_alike,
        plain=lambda bounds: {key.name: r.high if r.fixed else _plain_range(r) for key, r in bounds.items()} or None,
    ),
    Field("inflexion", checks.inflexion),
    Field(
        "boundary",
        checks.boundary,
        parts=("start", "end"),
        read=lambda start=(), end=(): BoundaryConditions(checks.listed(start, "start"), checks.listed(end, "end")),
        plain=_plain_ends,
    ),
    Field(
        "windows",
        checks.windows,
        near=lambda first, second: len(first) == len(second),
        read=_read_windows,
        plain=lambda windows: [window.to_dict() for window in windows] or None,
    ),
)


def from_entries(data: Mapping[str, Any]) -> dict[str, Any]:
    """The fields that entries describe.

    >>> from_entries({"order": 4, "degree": 5})
    {'order': 4, 'basis': Chebyshev(degree=5)}
    """
    if not isinstance(data, Mapping):
        raise InputError(f"a problem must be a table of entries such as order and B, got {shortened(data)}")
    check_names(data, ENTRIES, PROBLEM.what)
    if "order" not in data and "start" not in data:
        raise InputError(checks.NO_ORDER)
    return {name: value for field in FIELDS for name, value in field.given(data).items()}


def to_entries(problem: object) -> dict[str, Any]:
    """The entries of a problem, plain and JSON-able: those that every problem has, then those that are no default."""
    return {name: value for field in FIELDS for name, value in field.entries(problem).items()}


def differ_in_numbers(first: object, second: object) -> bool:
    """Whether two problems differ at most in numbers along which warm starts run, and in their bases."""
    compared = ((field, field.compared or field.name) for field in FIELDS)
    return all(field.near(getattr(first, name), getattr(second, name)) for field, name in compared)
