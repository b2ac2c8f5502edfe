"""Values that declare their entries: constructors, plain data, files and errors are made from the declaration."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields
from functools import wraps
from inspect import signature
from textwrap import wrap
from typing import (
    TYPE_CHECKING,
    Any,
    ClassVar,
    ForwardRef,
    NoReturn,
    Self,
    TypeVar,
    dataclass_transform,
    get_args,
    get_origin,
)

from optlaws.echo import shortened, unknown_key
from optlaws.entries.value_types import AnyTable, Kept, ValueType
from optlaws.errors import CallError, InputError, located
from optlaws.files.reading import JsonText, check_names
from optlaws.motion.quantities import Derived, written
from optlaws.spelling import known_spellings, other_spelling

_MOST_OWNERS = 3  # tables that an error names: what more of them have is of no one in particular


class FrozenTable(dict[str, Any]):
    """A table whose entries cannot be set, added or removed; it is equal to a plain one, and hashed by its entries.

    Examples
    --------
    >>> limits = FrozenTable(velocity="1 m/s")
    >>> limits["velocity"] = "2 m/s"
    Traceback (most recent call last):
    TypeError: a value is not changed once it is there: make another, as with dataclasses.replace
    >>> limits == {"velocity": "1 m/s"}, {**limits, "jerk": "90 m/s^3"}
    (True, {'velocity': '1 m/s', 'jerk': '90 m/s^3'})
    """

    def __hash__(self) -> int:  # type: ignore[override] # a dict has none
        return hash(frozenset(self.items()))

    def _refuse(self, *_: object, **__: object) -> NoReturn:
        """Refused: a value is not changed."""
        raise TypeError("a value is not changed once it is there: make another, as with dataclasses.replace")

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, _: object) -> Self:
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[dict[str, Any]]]:
        return type(self), (dict(self),)


#: no entry has tables or lists within each other so often: what has is refused by whoever reads it
_DEEPEST = 20


def frozen(value: Any, depth: int = 0) -> Any:
    """A value with its tables frozen and its lists as tuples, as far down as entries go; other values unchanged.

    >>> frozen({"acceleration": ["-8 m/s^2", "12 m/s^2"], "motor": True})
    {'acceleration': ('-8 m/s^2', '12 m/s^2'), 'motor': True}
    """
    if depth > _DEEPEST:
        return value
    if isinstance(value, Mapping):
        return FrozenTable({name: frozen(entry, depth + 1) for name, entry in value.items()})
    return tuple(frozen(entry, depth + 1) for entry in value) if type(value) in {list, tuple} else value


def thawed(value: Any) -> Any:
    """A value with its frozen tables and tuples as plain tables and lists, which can be changed and stored.

    >>> thawed(frozen({"motor": {"ratio": (1, 2)}}))
    {'motor': {'ratio': [1, 2]}}
    """
    if isinstance(value, Mapping):
        return {name: thawed(entry) for name, entry in value.items()}
    return [thawed(entry) for entry in value] if type(value) in {list, tuple} else written(value)


_ENTRY = "entry"
_ENTRIES: dict[type, dict[str, Entry]] = {}
DeclaredT = TypeVar("DeclaredT", bound="Declared")
T = TypeVar("T")


@dataclass(frozen=True)
class Entry:
    """An entry of a value, from which every surface knows it."""

    name: str
    field: str  #: the field that it is; its name, unless that is a word of Python
    type: ValueType
    about: str  #: what it says, in a sentence
    label: str  #: what a form calls it
    example: Any  #: a value of it as files have it; None where there is none
    default: Any  #: its value unless given; `MISSING` where one is needed
    shown: bool  #: whether forms and references show it

    @property
    def needed(self) -> bool:
        """Whether a value without it is refused."""
        return self.default is MISSING

    @property
    def kept_default(self) -> Any:
        """What is kept where it is not given; `MISSING` where it is needed."""
        return MISSING if self.needed else self.read(self.default)

    @property
    def plain_default(self) -> Any:
        """The default as files have it; None where there is none to give."""
        if self.needed or self.kept_default is None:
            return None
        plain = self.type.plain(self.kept_default)
        return None if plain in (None, {}, [], "") else plain

    @property
    def schema(self) -> dict[str, Any]:
        """The JSON Schema of the entry."""
        default = {} if self.plain_default is None else {"default": self.plain_default}
        schema = self.type.schema()
        if self.default is None or self.type.absent is not None:
            schema = {"anyOf": [schema, {"type": "null"}]}
        return {**schema, "description": self.about, **default}

    @property
    def form(self) -> dict[str, Any]:
        """The field of a form for it."""
        usual, default = self.plain_default if self.example is None else self.example, self.plain_default
        text = "" if usual is None else usual if isinstance(usual, str) else json.dumps(usual)
        if text and not self.needed and self.example is not None:
            text = f"{default or 'none'}, or {text}"
        shown = {"name": self.name, "label": self.label, "about": self.about, "placeholder": text}
        known = {"example": self.example, "default": default}
        given = {name: value for name, value in known.items() if value is not None}
        return {**shown, **given, "needed": self.needed, **self.type.form()}

    @property
    def sentence(self) -> str:
        """What its values are, and what it is unless given."""
        usual = "" if self.plain_default is None else f"; {self.default!r} unless given"
        return f"{self.type.words[:1].upper()}{self.type.words[1:]}{usual}."

    def missing_in(self, what: str) -> str:
        """What an error says of a value that needs it and has none."""
        such = "" if self.example is None else f", such as {self.name} = {self.example!r}"
        return f"{what} needs its {self.name}{such}"

    def read(self, value: Any) -> Any:
        """What is kept of a value; None where it may be absent and is."""
        if value is None and self.default is None and self.type.absent is None:
            return None
        return self.type.read(value, self.name)


def entry(
    type_: ValueType,
    about: str,
    *,
    default: Any = MISSING,
    kw_only: bool | None = None,
    name: str = "",
    label: str = "",
    example: Any = None,
    shown: bool = True,
) -> Any:
    """An entry of a declared value, in place of a field of a dataclass.

    Parameters
    ----------
    type_
        What its values may be.
    about
        What it says, in a sentence that stands in references, forms and starters.
    default
        Its value unless given; None says that it may be absent. Without a default it is needed.
    kw_only
        Whether the constructor takes it by its name alone; as all after a field of `KW_ONLY` unless given.
    name
        What files call it; as the field unless given.
    label
        What a form calls it; its name unless given.
    example
        As files have it, for errors and forms.
    shown
        Whether forms and references show it.
    """
    declaration = {"type": type_, "about": about, "name": name, "label": label, "example": example, "shown": shown}
    options: dict[str, Any] = {} if kw_only is None else {"kw_only": kw_only}
    return field(default=default, metadata={_ENTRY: declaration}, **options)


def same(cls: type[Declared], name: str, *, default: Any = ...) -> Any:
    """An entry that another class declares, in place of a field, perhaps with another default."""
    each = entries_of(cls)[name]
    known = {"name": name, "label": each.label, "example": each.example, "shown": each.shown}
    return entry(each.type, each.about, default=each.default if default is ... else default, **known)


@dataclass_transform(frozen_default=True, field_specifiers=(entry, same))
def declared(cls: type[DeclaredT]) -> type[DeclaredT]:
    """A class whose fields are entries, as a frozen dataclass that checks them.

    >>> from optlaws.entries.value_types import InSI, Text
    >>> @declared
    ... class Gear(Declared, title="a gear"):
    ...     inertia: float = entry(InSI("moment of inertia", least=0.0), "Of the gear.", example="1 kg m^2")
    ...     name: str = entry(Text(), "What texts call it.", default="gear", kw_only=True)
    >>> Gear("3 kg m^2"), Gear.from_dict({"inertia": 2.0}).to_dict()
    (Gear(inertia=3.0, name='gear'), {'inertia': 2.0})
    >>> Gear.form()["entries"][1]
    {'name': 'name', 'label': 'name', ..., 'placeholder': 'gear', 'default': 'gear', 'needed': False}
    >>> Gear.json_schema()["required"], Gear.json_schema()["properties"]["name"]["default"]
    (['inertia'], 'gear')
    >>> Gear.from_dict({"intertia": 2.0})
    Traceback (most recent call last):
    optlaws.errors.InputError: unknown entry of a gear 'intertia'; did you mean 'inertia'?
    >>> Gear.from_dict({})
    Traceback (most recent call last):
    optlaws.errors.InputError: a gear needs its inertia, such as inertia = '1 kg m^2'
    """
    value = dataclass(frozen=True)(cls)
    _document(value, value)
    types = value.__init__.__annotations__
    known: dict[str, Any] = {}
    for base in reversed(cls.__mro__):
        known |= vars(sys.modules[base.__module__])
    types |= {name: _given_type(text, known) for name, text in types.items()}
    type.__setattr__(value, "__init__", _naming_entries(value))
    return value


def _naming_entries(cls: type[DeclaredT]) -> Callable[..., None]:
    """The constructor of a declared class, which names entries that it does not have, and those that it needs."""
    make = cls.__init__
    takes = {name: each for name, each in signature(make).parameters.items() if name != "self"}
    names, needed = tuple(takes), {name for name, each in takes.items() if each.default is each.empty}

    @wraps(make)
    def constructor(self: DeclaredT, *args: Any, **given: Any) -> None:
        given = known_spellings(given, takes)
        unknown, lacking = given.keys() - takes, needed.difference(names[: len(args)], given)
        if unknown or lacking:
            other = next((name for name in sorted(unknown) if name in cls.instead), None)
            if other is not None:
                called, instead = cls.named.replace("stored ", ""), cls.instead[other].format(given[other])
                raise CallError(f"unknown entry of {called} {other!r}: give {instead}")
            raise CallError(_mistake(cls, unknown, lacking, names))
        make(self, *args, **given)

    return constructor


def _mistake(cls: type[Declared], unknown: set[str], lacking: set[str], names: Sequence[str]) -> str:
    """What an error says of entries that a constructor does not know, or lacks."""
    known, called = entries_of(cls).values(), cls.named.replace("stored ", "")
    if not unknown:
        return next(each for each in known if each.field in lacking).missing_in(called)
    return _unknown(cls, min(unknown), names, f"entry of {called}", similar=True)


def _unknown(cls: type[Declared], name: str, names: Sequence[str], called: str, *, similar: bool = False) -> str:
    """What an error says of a name: which tables among the entries have it, or a `similar` one, or the nearest name."""
    entries = entries_of(cls).values()
    inner = [(each.name, key) for each in entries for table in each.type.tables().values() for key in table]
    owners = dict.fromkeys(repr(owner) for owner, key in inner if key == name)
    if 0 < len(owners) <= _MOST_OWNERS:
        return f"unknown {called} {name!r}; it is an entry of {' and of '.join(owners)}"
    return unknown_key(name, names, called, words={key: owner for owner, key in inner} if similar else None)


def _given_type(text: Any, known: Mapping[str, Any]) -> Any:
    """The type that an argument may have, where that of its field is another."""
    if isinstance(text, str) and text.startswith("InitVar["):
        return text.removeprefix("InitVar[").removesuffix("]")
    alias = known.get(text) if isinstance(text, str) else None
    if get_origin(alias) is not Kept:
        return text
    given = get_args(alias)[1]
    return given.__forward_arg__ if isinstance(given, ForwardRef) else given


def documented_by(values: type[Declared]) -> Callable[[T], T]:
    """Write the entries of declared values into the docstring of a class or a function that takes the same.

    >>> from optlaws.entries.value_types import InSI
    >>> @declared
    ... class Rotor(Declared):
    ...     inertia: float = entry(InSI("moment of inertia"), "Of the rotor.")
    >>> @documented_by(Rotor)
    ... def speed(power, inertia):
    ...     "The speed of a rotor."
    >>> speed.__doc__.splitlines()[-2:]
    ['    inertia', '        Of the rotor. A moment of inertia.']
    """

    def document(documented: T) -> T:
        _document(documented, values)
        return documented

    return document


#: of a section of a docstring
_HEADING = re.compile(r"^( *)([A-Z]\w+)\n\1-{3,}\n", re.MULTILINE)


def _document(documented: Any, values: type[Declared]) -> None:
    """Write entries into a docstring, those that a function takes, below the parameters that have their words there."""
    if documented.__doc__ is None:
        return
    text = documented.__doc__
    headings = list(_HEADING.finditer(text))
    indent = headings[0][1] if headings else "    "
    place = next((each.start() for each in headings if each[2] != "Parameters"), len(text))
    named = next((each.end() for each in headings if each[2] == "Parameters"), place)
    known = [line.split(", ") for line in re.findall(rf"^{indent}(\w[\w, ]*)$", text[named:place], re.MULTILINE)]
    of_class = isinstance(documented, type)
    takes = documented.__init__.__annotations__ if of_class else signature(documented).parameters
    lines = []
    for each in entries_of(values).values():
        name = each.name if each.name in takes else each.field
        if name in takes and not any(name in names for names in known):
            about = wrap(f"{each.about} {each.sentence}", 108 - len(indent))
            lines += [f"{indent}{name}", *(f"{indent}    {line}" for line in about)]
    if lines:
        head = [] if named < place else ["", f"{indent}Parameters", f"{indent}----------"]
        documented.__doc__ = "\n".join([text[:place].rstrip(), *head, *lines, "", text[place:]]).rstrip(" \n")


class Declared(JsonText):
    """A value that declares its entries; `title`, kept as `named`, is what errors call one, such as "a gear"."""

    named: ClassVar[str] = "a value"
    #: whether `to_dict` writes entries that have their default too
    writes_defaults: ClassVar[bool] = False
    #: of these not even then, as versions before do not know them
    newer: ClassVar[tuple[str, ...]] = ()
    #: what a constructor takes in place of entries that it does not have, with the given value in braces
    instead: ClassVar[Mapping[str, str]] = {}
    #: whether plain data have more, which is computed and not read
    computes: ClassVar[bool] = False

    def __init_subclass__(cls, *, title: str = "", **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        if title:
            cls.named = cls._json_name = title

    def __post_init__(self) -> None:
        for each in entries_of(type(self)).values():
            object.__setattr__(self, each.field, each.read(getattr(self, each.field)))
        self._check()

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """The JSON Schema of its plain data."""
        (entries,) = cls.tables().values()
        return {
            "type": "object",
            "properties": {name: each.schema for name, each in entries.items()},
            "required": [name for name, each in entries.items() if each.needed],
            "additionalProperties": cls.computes,
        }

    @classmethod
    def form(cls) -> dict[str, Any]:
        """Its entries as a form shows them: name, label, what each asks, and what may be chosen."""
        (entries,) = cls.tables().values()
        return {"entries": [each.form for each in entries.values() if each.shown]}

    @classmethod
    def tables(cls) -> Mapping[str, Mapping[str, Any]]:
        """Its entries as files have them by "", or those of each kind by its name."""
        return {"": entries_of(cls)}

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """What is called so in the other spelling."""
            other = other_spelling(name)
            if other == name:
                raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)
            return getattr(self, other)

    def _check(self) -> None:
        """Refuse entries that contradict each other."""

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        """Entries as they are called now, from those of earlier files."""
        return data

    def to_dict(self) -> dict[str, Any]:
        """The entries as plain data, which `from_dict` takes back; without those with their default or that follow."""
        plain = {}
        for each in entries_of(type(self)).values():
            value = getattr(self, each.field)
            if isinstance(value, Derived):
                continue
            if (self.writes_defaults and each.name not in self.newer) or value != each.kept_default:
                plain[each.name] = None if value is None else each.type.plain(value)
        return plain

    @classmethod
    def from_dict(cls, data: Any) -> Self:
        """The value of plain data, as `to_dict` writes it or a file has it.

        Raises
        ------
        InputError
            If an entry is unknown, missing or wrong; the error names it.
        """
        known = entries_of(cls)
        if not isinstance(data, Mapping):
            raise InputError(
                f"{cls.named} must be a table of {', '.join(known) or 'no entries'}, got {shortened(data)}"
            )
        given = cls._from_earlier(known_spellings(data, known))
        if cls.computes:
            given = {name: value for name, value in given.items() if name in known}
        other = next((name for name in given if name not in known), None)
        if other is not None:
            raise InputError(_unknown(cls, other, tuple(known), f"entry of {cls.named}"))
        for name, each in known.items():
            absent = name not in given or (given[name] is None and each.type.absent is None)
            if each.needed and absent:
                raise InputError(each.missing_in(cls.named))
        takes = cls.__init__.__annotations__
        return cls(**{name if name in takes else known[name].field: value for name, value in given.items()})


class Kinded(Declared):
    """A declared value of one of several kinds, which are classes by the names that files have for them.

    A class of kinds inherits this one; each kind inherits it with its `kind`, and registers itself by that.

    >>> from optlaws.entries.value_types import Measured
    >>> class Shape(Kinded, title="a shape"):
    ...     pass
    >>> @declared
    ... class Circle(Shape, kind="circle"):
    ...     radius: str = entry(Measured("length", above=0.0), "Of the circle.", example="3 mm")
    >>> Shape.from_dict({"kind": "circle", "radius": "2 mm"}).to_dict()
    {'kind': 'circle', 'radius': '2 mm'}
    >>> Shape.from_dict({"kind": "circel"})
    Traceback (most recent call last):
    optlaws.errors.InputError: unknown kind of a shape 'circel'; did you mean 'circle'?
    """

    kind: ClassVar[str] = ""
    _kinds: ClassVar[dict[str, type[Any]]]

    def __init_subclass__(cls, *, kind: str = "", title: str = "", **keywords: Any) -> None:
        named = f"{'an' if kind[:1] in 'aeiou' else 'a'} {kind}" if kind else ""
        super().__init_subclass__(title=title or named, **keywords)
        if Kinded in cls.__bases__:
            cls._kinds = {}
        if kind:
            cls.kind = kind
            cls._kinds[kind] = cls

    @classmethod
    def kinds(cls) -> dict[str, type[Self]]:
        """The kinds by their names."""
        return dict(cls._kinds)

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """The JSON Schema of the plain data of its kind; of a class of kinds, that of any of them."""
        if not cls.kind:
            return {"oneOf": [kind.json_schema() for kind in cls.kinds().values()]}
        schema = super().json_schema()
        properties, needed = {"kind": {"const": cls.kind}, **schema["properties"]}, ["kind", *schema["required"]]
        return {**schema, "properties": properties, "required": needed}

    @classmethod
    def form(cls) -> dict[str, Any]:
        """The entries of its kind as a form shows them; of a class of kinds, those of each by its name."""
        if not cls.kind:
            return {"kinds": {name: kind.form()["entries"] for name, kind in cls.kinds().items()}}
        return super().form()

    @classmethod
    def tables(cls) -> Mapping[str, Mapping[str, Any]]:
        """The entries of its kind, or of each kind, by the names of the kinds."""
        return {name: entries_of(kind) for name, kind in ({cls.kind: cls} if cls.kind else cls.kinds()).items()}

    def to_dict(self) -> dict[str, Any]:
        """The kind and the entries as plain data; those with their default are left out."""
        return {"kind": self.kind, **super().to_dict()}

    @classmethod
    def from_dict(cls, data: Any) -> Self:
        """The value of plain data, of the kind that the data names.

        Raises
        ------
        InputError
            If there is no such kind, or an entry is unknown, missing or wrong; the error names it.
        """
        if not isinstance(data, Mapping):
            raise InputError(f"{cls.named} must be a table with its kind, got {shortened(data)}")
        kinds = {cls.kind: cls} if cls.kind else cls.kinds()
        kind = data.get("kind")
        if kind is None:
            raise InputError(f"{cls.named} needs its kind: give one of {', '.join(kinds)}")
        check_names([kind], kinds, f"kind of {cls.named}")
        read = super(Kinded, kinds[kind]).from_dict
        return read({name: value for name, value in data.items() if name != "kind"})


@dataclass(frozen=True)
class ValueOf(ValueType):
    """A value that is stored as a table, or that table; of a declared one its entries are known."""

    of: type[JsonText]

    def read(self, value: Any, name: str) -> Any:
        if isinstance(value, self.of):
            return value
        with located(name):
            return self.of.from_dict(value)

    def plain(self, value: Any) -> Any:
        return value.to_dict()

    @property
    def words(self) -> str:
        return f"{self.of._json_name}, a table"  # noqa: SLF001 - what its errors call it

    def schema(self) -> dict[str, Any]:
        return self.of.json_schema() if issubclass(self.of, Declared) else {"type": "object"}

    def form(self) -> dict[str, Any]:
        return self.of.form() if issubclass(self.of, Declared) else {}

    def tables(self) -> Mapping[str, Mapping[str, Any]]:
        return self.of.tables() if issubclass(self.of, Declared) else {}


@dataclass(frozen=True, init=False)
class TableOf(AnyTable):
    """A table with a type for each of its entries, which stays a table; `what` is what errors call an entry.

    `elsewhere` says of names that belong to another table where they are to be given, `further` of what type those
    are whose names are many.

    >>> from optlaws.entries.value_types import Measured
    >>> limits = TableOf("limit", {"velocity": entry(Measured("velocity"), "The greatest.", default=None)})
    >>> limits.read({"velocty": "1 m/s"}, "limits")
    Traceback (most recent call last):
    optlaws.errors.InputError: limits: unknown limit 'velocty'; did you mean 'velocity'?
    """

    what: str
    entries: Mapping[str, Entry]
    keep: Callable[[dict[str, Any]], Any]
    elsewhere: Mapping[str, str]
    further: Callable[[str], ValueType | None]

    def __init__(
        self,
        what: str,
        entries: Mapping[str, Any],
        *,
        keep: Callable[[dict[str, Any]], Any] = dict,
        elsewhere: Mapping[str, str] | None = None,
        further: Callable[[str], ValueType | None] = lambda _: None,
    ) -> None:
        named = {name: each if isinstance(each, Entry) else _entry_of(name, each) for name, each in entries.items()}
        given = {"what": what, "entries": named, "keep": keep, "elsewhere": elsewhere or {}, "further": further}
        for name, value in given.items():
            object.__setattr__(self, name, value)

    @property
    def such(self) -> str:
        given = {key: each.example for key, each in self.entries.items() if each.example is not None}
        return next((f" such as {{{key} = {example!r}}}" for key, example in given.items()), "")

    def type_of(self, key: str) -> ValueType:
        type_ = None if key in self.entries else self.further(key)
        if type_ is not None:
            return type_
        if key in self.elsewhere:
            raise InputError(f"{key} {self.elsewhere[key]}")
        check_names([key], self.entries, self.what)
        return self.entries[key].type

    @property
    def words(self) -> str:
        return f"a table of {', '.join(self.entries)}"

    def schema(self) -> dict[str, Any]:
        properties = {key: each.schema for key, each in self.entries.items()}
        return {"type": "object", "properties": properties, "additionalProperties": False}

    def form(self) -> dict[str, Any]:
        return {"entries": [each.form for each in self.entries.values() if each.shown]}

    def tables(self) -> Mapping[str, Mapping[str, Any]]:
        return {"": self.entries}


def entries_of(cls: type[Declared]) -> dict[str, Entry]:
    """The entries of a declared class by their names, in the order in which it declares them."""
    entries = _ENTRIES.get(cls)
    if entries is None:
        known = [each for each in fields(cls) if _ENTRY in each.metadata]  # type: ignore[arg-type] # its heirs are dataclasses
        entries = _ENTRIES[cls] = {each.name: each for each in (_entry_of(field.name, field) for field in known)}
    return entries


def _entry_of(name: str, given: Any) -> Entry:
    """The entry that a field of this name declares."""
    declaration = given.metadata[_ENTRY]
    called = declaration["name"] or name
    label = declaration["label"] or called.replace("_", " ")
    return Entry(field=name, default=given.default, **{**declaration, "name": called, "label": label})
