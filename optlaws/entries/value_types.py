"""What the values of an entry may be: each type reads them, writes them as plain data, and says what it takes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar

from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.files.reading import check_names
from optlaws.motion.quantities import DIMENSIONS, either, written
from optlaws.numbers import bounded, finite, is_usual, real, whole

if TYPE_CHECKING:
    from optlaws.numbers import NumberOrQuantity, Quantity

KeptT = TypeVar("KeptT")
GivenT = TypeVar("GivenT")


class Kept(Generic[KeptT, GivenT]):
    """The type of a field for type checkers, where what is kept is of another type than what may be given."""

    if TYPE_CHECKING:

        def __get__(self, instance: object, owner: Any) -> KeptT: ...

        def __set__(self, instance: object, value: GivenT) -> None: ...


#: a number in SI units, given as one or as a quantity
SINumber: TypeAlias = Kept[float, "NumberOrQuantity"]
#: likewise, of which None says that there is none
SILimit: TypeAlias = Kept[float, "NumberOrQuantity | None"]
#: a quantity that follows from others where it is not given
KnownQuantity: TypeAlias = Kept["Quantity", "NumberOrQuantity | None"]


class ValueType(ABC):
    """The type of an entry's values."""

    absent: Any = None  #: what is kept where plain data have none; None where they need one

    @abstractmethod
    def read(self, value: Any, name: str) -> Any:
        """The value that is kept of one that was given; errors call it `name`."""

    def plain(self, value: Any) -> Any:
        """A kept value as plain data, which `read` takes back."""
        return value

    @property
    @abstractmethod
    def words(self) -> str:
        """What the values are, in words."""

    @abstractmethod
    def schema(self) -> dict[str, Any]:
        """The JSON Schema of what is read from a file."""

    def form(self) -> dict[str, Any]:
        """What a form has for it beside a field of text: its `choices`, the `entries` or `kinds` of a table."""
        return {}

    def tables(self) -> Mapping[str, Mapping[str, Any]]:
        """The entries of the tables among its values, by the kinds of these; those of a table without a kind by ""."""
        return {}


@dataclass(frozen=True)
class Text(ValueType):
    """A text that is not empty, unless it may be.

    >>> Text().read("", "name")
    Traceback (most recent call last):
    optlaws.errors.InputError: name must be a text, got ''
    """

    empty: bool = False
    longest: int = 1_000_000

    def read(self, value: Any, name: str) -> str:
        if not isinstance(value, str) or not (value or self.empty):
            quantity = "; a number with a unit is written as text, such as '35 mm'" if real(value) is not None else ""
            raise InputError(f"{name} must be a text, got {shortened(value)}{quantity}")
        if len(value) > self.longest:
            raise InputError(f"{name} must be a text of {self.longest} characters at most, got {shortened(value)}")
        return value

    @property
    def words(self) -> str:
        return "a text"

    def schema(self) -> dict[str, Any]:
        return {"type": "string"} if self.empty else {"type": "string", "minLength": 1}


@dataclass(frozen=True, init=False)
class Choice(ValueType):
    """One of several words.

    >>> Choice("up", "down").read("upp", "way")
    Traceback (most recent call last):
    optlaws.errors.InputError: unknown way 'upp'; did you mean 'up'?
    """

    names: tuple[str, ...]

    def __init__(self, *names: str) -> None:
        object.__setattr__(self, "names", names)

    def read(self, value: Any, name: str) -> str:
        check_names([value], self.names, name)
        return value  # type: ignore[no-any-return] # one of the names

    @property
    def words(self) -> str:
        *most, last = [f'"{name}"' for name in self.names]
        return f"{', '.join(most)} or {last}" if most else last

    def schema(self) -> dict[str, Any]:
        return {"enum": list(self.names)}

    def form(self) -> dict[str, Any]:
        return {"choices": list(self.names)}


class Switch(ValueType):
    """A choice of true or false.

    >>> Switch().read("yes", "animation")
    Traceback (most recent call last):
    optlaws.errors.InputError: animation must be true or false, got 'yes'
    """

    def read(self, value: Any, name: str) -> bool:
        if not isinstance(value, bool):
            raise InputError(f"{name} must be true or false, got {shortened(value)}")
        return value

    @property
    def words(self) -> str:
        return "true or false"

    def schema(self) -> dict[str, Any]:
        return {"type": "boolean"}

    def form(self) -> dict[str, Any]:
        return {"choices": [False, True]}


@dataclass(frozen=True)
class Whole(ValueType):
    """A whole number in a range."""

    least: int = 0
    most: int = 2**53

    def read(self, value: Any, name: str) -> int:
        return whole(value, name, self.least, self.most)

    @property
    def words(self) -> str:
        return f"a whole number from {self.least}" + (f" to {self.most:,}" if self.most < 2**53 else " on")

    def schema(self) -> dict[str, Any]:
        top = {"maximum": self.most} if self.most < 2**53 else {}
        return {"type": "integer", "minimum": self.least, **top}


@dataclass(frozen=True, kw_only=True)
class _Ranged(ValueType):
    """Numbers above a number, or from one on, and up to another; `absent` is what is kept where none is given."""

    above: float = -inf
    least: float = -inf
    most: float = inf
    absent: float | None = None

    def number(self, value: Any, name: str) -> float:
        """The number of a value, if it is in the range."""
        return self.in_range(finite(value, name), name, value)

    def in_range(self, number: float, name: str, value: Any) -> float:
        """The number, if it is in the range; errors show the value that was given."""
        if number > self.above and self.least <= number <= self.most:
            return number
        end = f"at most {self.most:g}" if number > self.most else f"at least {self.least:g}"
        end = end if number > self.above else f"above {self.above:g}"
        raise InputError(f"{name} must be {end}, got {shortened(value)}")

    def read(self, value: Any, name: str) -> Any:
        if self.absent is not None and (value is None or value == self.absent):
            return self.absent
        return self.number(value, name)

    def plain(self, value: Any) -> Any:
        return None if self.absent is not None and value == self.absent else value

    @property
    def ends(self) -> str:
        """The range behind the name of what is in it, such as " above 0"."""
        if self.least > -inf:
            return f" from {self.least:g} {'on' if self.most == inf else f'to {self.most:g}'}"
        low = f" above {self.above:g}" if self.above > -inf else ""
        return low if self.most == inf else f"{low}{' and' if low else ''} at most {self.most:g}"

    def schema(self) -> dict[str, Any]:
        ends = {"exclusiveMinimum": self.above, "minimum": self.least, "maximum": self.most}
        return {"type": "number", **{key: end for key, end in ends.items() if bounded(end) is not None}}


class Number(_Ranged):
    """A number without a unit, in a range.

    >>> Number(least=0.0).read(-0.1, "damping")
    Traceback (most recent call last):
    optlaws.errors.InputError: damping must be at least 0, got -0.1
    """

    @property
    def words(self) -> str:
        return f"a number{self.ends}"


_NUMBER = Number()


@dataclass(frozen=True, kw_only=True)
class _Physical(_Ranged):
    """A quantity of one of several dimensions, in a range of its number in SI units."""

    dimensions: tuple[str, ...]
    bare: bool = False  #: whether a number is in SI units though there are several dimensions, one of which others say

    def number(self, value: Any, name: str) -> float:
        """The number of a value in SI units, if it is in the range."""
        if self.bare and not isinstance(value, str) and not hasattr(value, "units"):
            return super().number(value, name)
        return self.in_range(either(value, self.dimensions, name)[1], name, value)

    @property
    def words(self) -> str:
        names = [f"{'an' if name[0] in 'aeiou' else 'a'} {name}" for name in self.dimensions]
        return f"{' or '.join(names)}{self.ends}"

    @property
    def example(self) -> str:
        """A quantity of the first dimension."""
        return DIMENSIONS[self.dimensions[0]][1]

    def schema(self) -> dict[str, Any]:
        text = {"type": "string", "description": f"{self.words}, such as {self.example!r}"}
        return {"anyOf": [text, super().schema()]} if self.bare or len(self.dimensions) == 1 else text


class Measured(_Physical):
    """A quantity that stays as it is written, such as "35 mm"; a number of one dimension is one in SI units.

    >>> Measured("length", above=0.0).read("35 mm", "radius"), Measured("length").read(0.02, "radius")
    ('35 mm', '0.02 m')
    >>> Measured("angle", "time").read("35 mm", "at")
    Traceback (most recent call last):
    optlaws.errors.InputError: at must be an angle such as '45 deg' or a time such as '0.3 s', but '35 mm' is a length
    """

    def __init__(self, *dimensions: str, bare: bool = False, **ends: float) -> None:
        super().__init__(dimensions=dimensions, bare=bare, **ends)

    def read(self, value: Any, name: str) -> Any:
        if self.bare and real(value) is not None:
            self.number(value, name)
            return value
        text = written(value, self.dimensions)
        self.in_range(either(text, self.dimensions, name)[1], name, text)
        return text


class InSI(_Physical):
    """A number in SI units, read from one or from a quantity; `absent` is what is kept where none is given.

    What is kept is read again, where a value is replaced.

    >>> InSI("torque", above=0.0).read("2 kN m", "peak_torque"), InSI("mass", least=0.0).read(3, "mass")
    (2000.0, 3.0)
    """

    def __init__(self, *dimensions: str, absent: float | None = None, **ends: float) -> None:
        super().__init__(dimensions=dimensions, bare=True, absent=absent, **ends)


@dataclass(frozen=True)
class Listed(ValueType):
    """Several values of one type, kept as a tuple.

    >>> Listed(Whole(1), least=2).read([3], "waves")
    Traceback (most recent call last):
    optlaws.errors.InputError: waves must be a list of 2 at least, each a whole number from 1 on, got [3]
    >>> Listed(Number()).read([0.5, 1e200], "places")
    Traceback (most recent call last):
    optlaws.errors.InputError: places 2 must not exceed 1e+100 in magnitude, got 1e+200
    """

    of: ValueType
    least: int = 0
    most: int = 1_000_000
    each: str = ""  #: what an error calls a single value, before its number; the name of the entry unless given
    named: bool = False  #: whether an error calls a table by its entry `name` in place of its number

    def read(self, value: Any, name: str) -> tuple[Any, ...]:
        if isinstance(value, str | Mapping) or not isinstance(value, Sequence):
            remedy = f"; in a file write [[{name}]] in place of [{name}]" if isinstance(value, Mapping) else ""
            raise InputError(f"{name} must be {self.words}, got {shortened(value)}{remedy}")
        if not self.least <= len(value) <= self.most:
            ends = f"{self.least} at least" if len(value) < self.least else f"{self.most} at most"
            raise InputError(f"{name} must be a list of {ends}, each {self.of.words}, got {shortened(list(value))}")
        if self.of == _NUMBER and all(map(is_usual, value)):
            return tuple(value)
        return tuple(
            self.of.read(part, f"{self.each or name} {self._called(part) or i}") for i, part in enumerate(value, 1)
        )

    def _called(self, part: Any) -> str:
        called = part.get("name") if self.named and isinstance(part, Mapping) else None
        return called if isinstance(called, str) else ""

    def plain(self, value: Any) -> Any:
        return [self.of.plain(part) for part in value]

    @property
    def words(self) -> str:
        return f"a list, each {self.of.words}"

    def schema(self) -> dict[str, Any]:
        top = {"maxItems": self.most} if self.most < 1_000_000 else {}
        return {"type": "array", "items": self.of.schema(), "minItems": self.least, **top}

    def form(self) -> dict[str, Any]:
        return {"list": self.of.form()}

    def tables(self) -> Mapping[str, Mapping[str, Any]]:
        return self.of.tables()


@dataclass(frozen=True, init=False)
class Together(ValueType):
    """A tuple of values, each of a type of its own, such as a pair of a time and a position.

    >>> Together(InSI("time"), InSI("length"), names=("time", "position")).read(["1 s", "2 s"], "point")
    Traceback (most recent call last):
    optlaws.errors.InputError: point: position must be a length such as '35 mm', but '2 s' is a time
    """

    of: tuple[ValueType, ...]
    names: tuple[str, ...]  #: what errors call them; their numbers unless given

    def __init__(self, *of: ValueType, names: tuple[str, ...] = ()) -> None:
        object.__setattr__(self, "of", of)
        object.__setattr__(self, "names", names or tuple(str(i) for i in range(1, len(of) + 1)))

    def read(self, value: Any, name: str) -> tuple[Any, ...]:
        if not isinstance(value, list | tuple) or len(value) != len(self.of):
            examples = [getattr(each, "example", None) for each in self.of]
            such = "" if None in examples else f" such as {examples}"
            raise InputError(f"{name} must be {self.words}{such}, got {shortened(value)}")
        parts = zip(self.of, value, self.names, strict=True)
        return tuple(each.read(part, f"{name}: {called}") for each, part, called in parts)

    def plain(self, value: Any) -> Any:
        return [each.plain(part) for each, part in zip(self.of, value, strict=True)]

    @property
    def words(self) -> str:
        *first, last = (each.words for each in self.of)
        if first == [last]:
            return f"a list of two, each {last}"
        return f"a list of {', '.join(first)} and {last}" if first else f"a list of {last}"

    def schema(self) -> dict[str, Any]:
        return {
            "type": "array",
            "prefixItems": [each.schema() for each in self.of],
            "minItems": len(self.of),
            "items": False,
        }

    def form(self) -> dict[str, Any]:
        return {"parts": list(self.names)}


class Span(Together):
    """Two ends that ascend, such as the range of an angle.

    >>> Span(InSI("angle")).read(("90 deg", "0 deg"), "over")
    Traceback (most recent call last):
    optlaws.errors.InputError: over must ascend, got ('90 deg', '0 deg')
    """

    def __init__(self, of: ValueType) -> None:
        super().__init__(of, of, names=("low", "high"))

    def read(self, value: Any, name: str) -> tuple[Any, ...]:
        ends = super().read(value, name)
        if not ends[0] < ends[1]:
            raise InputError(f"{name} must ascend, got {shortened(value)}")
        return ends

    @property
    def words(self) -> str:
        return f"a list of two that ascend, each {self.of[0].words}"


class AnyTable(ValueType):
    """Values by their names, each of the type that its name has."""

    keep: Callable[[dict[str, Any]], Any]

    @property
    def such(self) -> str:
        """How an error goes on that asks for a table."""
        return ""

    @abstractmethod
    def type_of(self, key: str) -> ValueType:
        """The type of the value of a name; an unknown one is refused."""

    def read(self, value: Any, name: str) -> Any:
        if self.keep is pairs and isinstance(value, tuple):
            value = dict(value)
        if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
            raise InputError(f"{name} must be a table{self.such}, got {shortened(value)}")
        with located(name):
            types = {key: self.type_of(key) for key in value}
        return self.keep({key: types[key].read(part, f"{name}: {key}") for key, part in value.items()})

    def plain(self, value: Any) -> Any:
        return {key: self.type_of(key).plain(part) for key, part in dict(value).items()}


@dataclass(frozen=True)
class Table(AnyTable):
    """Values of one type by their names; `names` are those that there may be, all unless given.

    >>> Table(Number(least=0.0), ("contact", "guide")).read({"guid": 0.1}, "friction")
    Traceback (most recent call last):
    optlaws.errors.InputError: friction: unknown entry 'guid'; did you mean 'guide'?
    """

    of: ValueType
    names: tuple[str, ...] | None = None
    keep: Callable[[dict[str, Any]], Any] = dict

    def type_of(self, key: str) -> ValueType:
        check_names([key], (key,) if self.names is None else self.names, "entry")
        return self.of

    @property
    def words(self) -> str:
        return f"a table, each {self.of.words}"

    def schema(self) -> dict[str, Any]:
        if self.names is None:
            return {"type": "object", "additionalProperties": self.of.schema()}
        return {
            "type": "object",
            "properties": dict.fromkeys(self.names, self.of.schema()),
            "additionalProperties": False,
        }

    def form(self) -> dict[str, Any]:
        return {} if self.names is None else {"names": list(self.names)}


def pairs(table: Mapping[str, Any]) -> tuple[tuple[str, Any], ...]:
    """How a `Table` is kept whose values are to have a hash."""
    return tuple(table.items())


@dataclass(frozen=True, init=False)
class Either(ValueType):
    """One of several types; `which` is a function of the value that gives the place of its type among them."""

    of: tuple[ValueType, ...]
    which: Callable[[Any], int]

    def __init__(self, *of: ValueType, which: Callable[[Any], int]) -> None:
        object.__setattr__(self, "of", of)
        object.__setattr__(self, "which", which)

    def read(self, value: Any, name: str) -> Any:
        return self.of[self.which(value)].read(value, name)

    def plain(self, value: Any) -> Any:
        return self.of[self.which(value)].plain(value)

    @property
    def words(self) -> str:
        return ", or ".join(each.words for each in self.of)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [each.schema() for each in self.of]}

    def form(self) -> dict[str, Any]:
        return self.of[0].form()

    def tables(self) -> Mapping[str, Mapping[str, Any]]:
        return self.of[0].tables()


def is_list(value: Any) -> int:
    """1 of a list or tuple, 0 of all else: which of two types of `Either` reads it."""
    return int(isinstance(value, list | tuple))


@dataclass(frozen=True)
class ReadBy(ValueType):
    """What a function reads, whose errors are placed at the entry, and another writes as plain data."""

    by: Callable[[Any], Any]
    about: str  #: what the values are, in words
    write: Callable[[Any], Any] = lambda value: value
    json: Mapping[str, Any] | None = None  #: the JSON Schema; anything unless given

    def read(self, value: Any, name: str) -> Any:
        with located(name):
            return self.by(value)

    def plain(self, value: Any) -> Any:
        return self.write(value)

    @property
    def words(self) -> str:
        return self.about

    def schema(self) -> dict[str, Any]:
        return dict(self.json or {})
