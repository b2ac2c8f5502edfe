"""What `Problem` keeps of its entries: the type of each, with what files have for it and which values are alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from operator import eq
from typing import Any

from optlaws.echo import shortened
from optlaws.entries.declared import Entry, TableOf
from optlaws.entries.value_types import Choice, Either, Number, Together, ValueType
from optlaws.errors import InputError, located
from optlaws.numbers import MOST_ORDER, MOST_VELOCITY, bounded, real, whole
from optlaws.synthesis.problem.expression import Expression, Term, leaves
from optlaws.synthesis.problem.named_constants import expression, is_named
from optlaws.synthesis.problem.ranges import Range, as_range, beyond
from optlaws.synthesis.problem.windows import Window, read_window
from optlaws.synthesis.spaces.bases import Basis, basis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

FREE = "free"
#: the constants that have an entry of their own
CONSTANTS = ("B", "C", "D", "J")
NO_ORDER = (
    "the problem lacks order, the number of conditions at each end: give order=4, say, or the end conditions themselves"
)


@dataclass(frozen=True, kw_only=True)
class Field(ValueType):
    """The type of an entry of `Problem`, which keeps other values than files have for it."""

    by: Callable[[Any, str], Any]  #: whatever was given, and the name of the entry -> what the problem keeps
    of: ValueType  #: the type of what files have; a table of the entries where these are several
    join: Callable[..., Any] | None = None  #: entries of a file, by keywords -> what `by` takes
    write: Callable[[Any], Any] = lambda value: value  #: what the problem keeps -> its entry, or its entries
    #: whether a warm start leads from one value to another: equal values, or values that differ in numbers
    near: Callable[[Any, Any], bool] = eq
    compared: str = ""  #: the attribute of `Problem` that `near` compares; the field unless given

    def read(self, value: Any, name: str) -> Any:
        return self.by(value, name)

    def plain(self, value: Any) -> Any:
        return self.write(value)

    @property
    def words(self) -> str:
        return self.of.words

    def schema(self) -> dict[str, Any]:
        return self.of.schema()

    @cached_property
    def parts(self) -> Mapping[str, Entry]:
        """Its entries, where files have several."""
        return self.of.entries if isinstance(self.of, TableOf) else {}

    def given(self, data: Mapping[str, Any], name: str) -> dict[str, Any]:
        """What the entries of a file say of the field, by its name; nothing where none of them is its own."""
        entries = {part: data[part] for part in self.parts or (name,) if part in data}
        if not entries:
            return {}
        return entries if self.join is None else {name: self.join(**entries)}


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


def instance(of: Any, words: str) -> Callable[[Any, str], Any]:
    """What keeps a value of a class, which errors ask for in these words."""

    def check(given: Any, name: str) -> Any:
        if not isinstance(given, of):
            raise InputError(f"{name} must be {words}, got {shortened(given)}")
        return given

    return check


def joined_basis(**entries: Any) -> Basis:
    """The basis of its entries."""
    return basis(entries.pop("basis", "chebyshev"), entries.pop("degree", 9), **entries)


def constant(value: Any, name: str) -> float | Range | None:
    """A constant's entry as a number, a range or None."""
    if name == "B" and value is not None and not isinstance(value, Range | tuple | list) and not _velocity(value):
        raise InputError(f"B must be a finite number above 1 (the mean velocity is 1), got {shortened(value)}")
    limits = as_range(value, name)
    if limits is None:
        return None
    if name == "B" and limits.high <= 1.0:
        raise InputError(beyond(name, "1 (the mean velocity is 1)", limits))
    if limits.high <= 0.0:
        raise InputError(beyond(name, "0", limits))
    return limits.high if limits.fixed else limits


def _velocity(value: Any) -> bool:
    number = real(value)
    return number is not None and 1.0 < number <= MOST_VELOCITY


def constant_of_bounds(value: Any, limits: Range, name: str) -> float | Range | None:
    """The bound that `bounds` give of a constant with an entry of its own, if that entry is free."""
    plain = limits.high if limits.fixed else limits
    if value is not None:
        raise InputError(f"{name} is given twice: as {value!r} and in bounds as {plain!r}")
    return constant(plain, name)


def plain_range(limits: Any) -> Any:
    """A number as it is, and a range as a pair."""
    return [limits.low, bounded(limits.high)] if isinstance(limits, Range) else limits


def limited_alike(first: Any, second: Any) -> bool:
    """Whether these are numbers, ranges bounded on the same side, or nothing."""
    if isinstance(first, Range) and isinstance(second, Range):
        return isfinite(first.high) == isfinite(second.high)
    return type(first) is type(second)


def bounded_alike(first: Mapping[Any, Range], second: Mapping[Any, Range]) -> bool:
    """Whether the same constants are bounded on the same sides."""
    return list(first) == list(second) and all(map(limited_alike, first.values(), second.values()))


def _listed(values: Any, name: str) -> tuple[Any, ...]:
    if not isinstance(values, list | tuple):
        raise InputError(f"{name} must be a list, got {shortened(values)}")
    return tuple(values)


def windows(given: Any, name: str) -> tuple[Window, ...]:
    """A single window or several, as a tuple."""
    check = instance(Window, "Window values such as via('a', 0.3, at=0.4)")
    return tuple(check(window, name) for window in (given if isinstance(given, list | tuple) else (given,)))


def read_windows(windows: Any) -> tuple[Window, ...]:
    """The windows of a file, which are texts or tables."""
    given = _listed(windows, "windows")
    with located("windows"):
        return tuple(read_window(window) if isinstance(window, str) else Window.from_dict(window) for window in given)


def inflexion(k: Any, _: str) -> float:
    """The k of the inflexion."""
    number = real(k)
    if number is None or not 0.0 < number < 1.0:
        raise InputError(f"inflexion must be a k between 0 and 1, got {shortened(k)}")
    return number


def joined_ends(start: Any = (), end: Any = ()) -> BoundaryConditions:
    """End conditions of the values at each end."""
    return BoundaryConditions(_listed(start, "start"), _listed(end, "end"))


def plain_ends(boundary: BoundaryConditions) -> dict[str, Any]:
    """The values at each end."""
    return {"start": [float(v) for v in boundary.start], "end": [float(v) for v in boundary.end]}


class NotGiven(int):
    """The order that nobody gave: another value than a 0 that somebody did.

    >>> NotGiven() == 0, type(NotGiven()) is int
    (True, False)
    """


class AsItFits(int):
    """The default of `symmetric`: symmetric laws wherever they may be best; equal to True."""

    def __repr__(self) -> str:
        return repr(bool(self))


def order(given: Any, name: str) -> int:
    """The order l, where it is given."""
    return given if isinstance(given, NotGiven) else whole(given, name, least=1, most=MOST_ORDER)


def order_with(given: int, ends: BoundaryConditions | None) -> int:
    """The given order l, or the order of the boundary conditions."""
    missing = isinstance(given, NotGiven)
    if ends is None:
        if missing:
            raise InputError(NO_ORDER)
        return given
    if not missing and given != ends.order:
        raise InputError(f"order {given} does not fit {ends.order} boundary conditions at each end")
    return ends.order


def objective(minimise: Any, _: str) -> str | Expression:
    """The objective as text if every constant of it has a name, else as an expression."""
    if isinstance(minimise, str):
        terms = expression(minimise)
    elif isinstance(minimise, Term | Expression):
        terms = minimise.expression()
    else:
        raise InputError(f"minimise must be a constant such as 'C', a sum or an expression, got {shortened(minimise)}")
    if terms.vanishes:
        raise InputError(f"an objective needs a weight above 0, got {terms!r}")
    return repr(terms) if all(is_named(leaf) for _, leaf in leaves(terms)) else terms
