"""The table of a problem's entries, from which files, studies, sweeps and commands derive their entries."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import partial
from math import isfinite
from operator import eq
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import bounded
from optlaws.suggest import unknown_key
from optlaws.synthesis.problem import checks
from optlaws.synthesis.problem.ranges import Bounds, Range
from optlaws.synthesis.problem.windows import Window, read_window
from optlaws.synthesis.spaces.bases import basis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions


class Kind(Enum):
    """The type of an entry's values; each reader and writer handles it in its own way.

    >>> ENTRIES["degree"].kind
    <Kind.WHOLE: 'a whole number'>
    """

    CONSTANT = 'a number, a pair [low, high] or "free"'
    CONSTANTS = "constants by name, each with a number or a pair [low, high]"
    WHOLE = "a whole number"
    NUMBER = "a number"
    NUMBERS = "numbers"
    TEXT = "text"
    SWITCH = "true or false"
    BASIS = "the name of a basis"
    BREAKS = "a number of pieces, or places from 0 to 1"
    WINDOWS = 'tables, or texts such as "b <= 1.2 @ 0.2..0.3"'


@dataclass(frozen=True)
class Entry:
    """An entry, with its names in files, studies and commands."""

    name: str  #: what it is called
    kind: Kind  #: what its values are
    about: str  #: what it asks, in a sentence
    heading: str  #: what a column of its values is called
    default: Any  #: its value unless given; None where nothing is asked, or where there is none to give


def _entry(name: str, kind: Kind, about: str, heading: str | None = None, *, default: Any = None) -> Entry:
    return Entry(name, kind, about, heading if heading is not None else name, default)


@dataclass(frozen=True)
class Field:
    """A field of `Problem`, with the entries for its parts."""

    name: str  #: the name of the field
    check: Callable[[Any], Any]  #: whatever was given -> what the problem keeps; its error names the field
    entries: tuple[Entry, ...]  #: one or more; a field left out of all of them has the default of `Problem`
    #: whether a warm start leads from one value to another: equal values, or values that differ in numbers
    near: Callable[[Any, Any], bool]
    compared: str  #: the attribute of `Problem` that `near` compares
    joined: Callable[..., Any]  #: entries, by keywords -> what `check` takes
    plain: Callable[[Any], dict[str, Any]]  #: what the problem keeps -> JSON-able entries, none where nothing is asked
    optional: bool = False  #: whether it may ask nothing


def _single(
    entry: Entry,
    check: Callable[[Any], Any],
    *,
    near: Callable[[Any, Any], bool] = eq,
    compared: str | None = None,
    read: Callable[[Any], Any] | None = None,
    plain: Callable[[Any], Any] | None = None,
    optional: bool = False,
) -> Field:
    """A field that is one entry: `read` takes the entry to the field, `plain` takes it back, None to leave it out."""

    def joined(**entries: Any) -> Any:
        value = entries[entry.name]
        return value if read is None else read(value)

    def written(value: Any) -> dict[str, Any]:
        shown = value if plain is None else plain(value)
        return {} if shown is None else {entry.name: shown}

    return Field(entry.name, check, (entry,), near, compared or entry.name, joined, written, optional)


def _constant(name: str, about: str) -> Field:
    entry = _entry(name, Kind.CONSTANT, about, f"{name} asked")
    return _single(entry, partial(checks.constant, name=name), near=_limited_alike, plain=_plain_range, optional=True)


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
    return tuple(read_window(window) if isinstance(window, str) else Window.from_dict(window) for window in given)


#: in the order in which files name them
FIELDS: tuple[Field, ...] = (
    _single(
        _entry(
            "minimise",
            Kind.TEXT,
            "What to minimise: a constant, a sum or maximum of some, or a formula such as rms(c + 3*b).",
            "minimised",
            default="C",
        ),
        checks.objective,
        near=lambda first, second: [term for _, term in first.terms] == [term for _, term in second.terms],
        compared="objective",
        plain=str,
    ),
    _constant("B", "Peak velocity, above 1: the mean velocity is 1."),
    _constant("C", "Peak acceleration."),
    _constant("D", "Peak power."),
    _constant("J", "Peak jerk."),
    _single(
        _entry(
            "order",
            Kind.WHOLE,
            "Number l of boundary conditions at each end: 3 for acceleration 0, 4 for jerk 0 too.",
            "order l",
        ),
        checks.order,
    ),
    _single(
        _entry("bounds", Kind.CONSTANTS, "Any constant at most or at least a value."),
        Bounds,
        near=_bounded_alike,
        plain=lambda bounds: {key.name: r.high if r.fixed else _plain_range(r) for key, r in bounds.items()} or None,
        optional=True,
    ),
    _single(
        _entry("inflexion", Kind.NUMBER, "The k of the peak velocity, where c is 0; of unsymmetric laws."),
        checks.inflexion,
        optional=True,
    ),
    Field(
        "basis",
        checks.chosen_basis,
        (
            _entry("basis", Kind.BASIS, "Basis of Z(k).", default="chebyshev"),
            _entry("degree", Kind.WHOLE, "Degree of Z(k), or of the law on each piece.", "degree of Z", default=9),
            _entry("breaks", Kind.BREAKS, 'For bsplines and pieces: places such as "0 0.3 1", or how many equal ones.'),
            _entry("continuity", Kind.WHOLE, "For bsplines and pieces: order up to which derivatives are continuous."),
            _entry("straight", Kind.NUMBERS, "For periodic pieces: numbers, from 0 on, of those without acceleration."),
        ),
        near=lambda *_: True,  # the solver compares the spaces that the bases span
        compared="basis",
        joined=_joined_basis,
        plain=lambda basis: dict(basis.to_dict()),
    ),
    _single(
        _entry("monotone", Kind.SWITCH, "Ask b >= 0 too: no return within the motion.", default=False),
        partial(checks.switch, name="monotone"),
    ),
    _single(
        _entry("symmetric", Kind.SWITCH, "Ask a(k) + a(1-k) = 1; not of uneven formulas unless given.", default=True),
        checks.symmetric,
    ),
    Field(
        "boundary",
        checks.boundary,
        (
            _entry("start", Kind.NUMBERS, 'Values of a, b, c, ... at k = 0, such as "0, 0.5"; rest unless given.'),
            _entry("end", Kind.NUMBERS, "Values of a, b, c, ... at k = 1; rest unless given."),
        ),
        near=eq,
        compared="boundary",
        joined=lambda start=(), end=(): BoundaryConditions(checks.listed(start, "start"), checks.listed(end, "end")),
        plain=_plain_ends,
        optional=True,
    ),
    _single(
        _entry(
            "windows",
            Kind.WINDOWS,
            'a, b, c, j or a formula in bounds, such as "b <= 1.2 @ 0.2..0.3", "a = 0.3 @ 0.4" or "c + 0.2*b <= 5".',
        ),
        checks.windows,
        near=lambda first, second: len(first) == len(second),
        read=_read_windows,
        plain=lambda windows: [window.to_dict() for window in windows] or None,
        optional=True,
    ),
)

_WRITTEN = sorted(FIELDS, key=lambda field: field.optional)

ENTRIES: dict[str, Entry] = {entry.name: entry for field in FIELDS for entry in field.entries}

#: the constants that have an entry of their own
CONSTANTS = tuple(entry.name for entry in ENTRIES.values() if entry.kind is Kind.CONSTANT)


def from_entries(data: Mapping[str, Any]) -> dict[str, Any]:
    """The fields that entries describe.

    >>> from_entries({"order": 4, "degree": 5})
    {'order': 4, 'basis': Chebyshev(degree=5)}
    """
    if not isinstance(data, Mapping):
        raise InputError(f"a problem must be a table of entries such as order and B, got {shortened(data)}")
    for name in data:
        if name not in ENTRIES:
            raise InputError(unknown_key(name, ENTRIES))
    if "order" not in data and "start" not in data:
        raise InputError(checks.NO_ORDER)
    given = {}
    for field in FIELDS:
        if entries := {entry.name: data[entry.name] for entry in field.entries if entry.name in data}:
            given[field.name] = field.joined(**entries)
    return given


def to_entries(problem: object) -> dict[str, Any]:
    """The entries of a problem, plain and JSON-able: those that every problem has, then those that are no default."""
    entries: dict[str, Any] = {}
    for field in _WRITTEN:
        entries.update(field.plain(getattr(problem, field.name)))
    return entries


def differ_in_numbers(first: object, second: object) -> bool:
    """Whether two problems differ at most in numbers along which warm starts run, and in their bases."""
    return all(field.near(getattr(first, field.compared), getattr(second, field.compared)) for field in FIELDS)
