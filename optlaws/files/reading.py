"""Reading of files and texts: a function each for text, TOML and JSON, with limits of size.

Only regular files are read, up to a size, in UTF-8 with or without a byte order mark. How much a JSON text holds is
counted before it is parsed, since its values take many times its size. What TOML or JSON holds is checked once: how
deep it is nested, how large its integers are, and that its text can be stored and printed.
"""

from __future__ import annotations

import json
import os
import re
import stat
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, Self, TypeGuard

from optlaws.echo import shortened, unknown_key
from optlaws.errors import InputError

LARGEST_TOML = 1_000_000
LARGEST_JSON = 64_000_000
DEEPEST = 50
_MOST_BITS = 1024
#: as letters of Central Europe look in Latin-1
_SIGN_IN_WORD = re.compile("[^\\W\\d_][\u0080-\u00bf\u00d7\u00f7][^\\W\\d_]")
#: the newest format of proofs and laws that is read; an object without a `format` is of the first
FORMAT = 1
#: of a JSON text: values (what parts them, and escapes in texts), and lists and objects, each of which takes as much
#: memory as ten numbers; an array of 10,000 solutions has two thirds of the one, and half of the other
_MOST_VALUES, _MOST_BRACKETS = 3_600_000, 600_000


def text(file: Path, largest: int = LARGEST_JSON, *, legacy: bool = False) -> str:
    """The text of a regular file in UTF-8, without its byte order mark; with `legacy` also in older encodings.

    These are UTF-16, Latin-1 and, where signs of Latin-1 would stand within words, Windows-1250 of Central Europe.

    Examples
    --------
    >>> text(Path("/dev/null"))
    Traceback (most recent call last):
    optlaws.errors.InputError: cannot read /dev/null: it is not a regular file
    >>> text(Path("/dev"))
    Traceback (most recent call last):
    optlaws.errors.InputError: cannot read /dev: it is a folder: name a file in it
    """
    name = _named(file)
    try:
        if not stat.S_ISREG(file.stat().st_mode):
            why = "a folder: name a file in it" if file.is_dir() else "not a regular file"
            raise InputError(f"cannot read {name}: it is {why}")
        with file.open("rb") as stream:
            # a file may grow while it is read
            large = os.fstat(stream.fileno()).st_size > largest
            data = b"" if large else stream.read(largest + 1)
    except OSError as error:
        raise InputError(f"cannot read {name}: {error.strerror or error}") from None
    if large or len(data) > largest:
        raise InputError(f"{name} is larger than {largest} bytes")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        if legacy and b"\0" not in data:
            western = data.decode("latin-1")
            return data.decode("cp1250", errors="replace") if _SIGN_IN_WORD.search(western) else western
        if legacy and data.startswith((BOM_UTF16_LE, BOM_UTF16_BE)):
            return data.decode("utf-16", errors="replace")
        raise InputError(f"{name} is not a text file in UTF-8: save it in this encoding") from None


def is_file(file: Path) -> bool:
    """Whether a file exists; a name that no file can have is no file."""
    try:
        return storable(str(file)) and file.is_file()
    except (OSError, ValueError):
        return False


def _named(file: Path) -> str:
    name = str(file)
    if "\0" in name or not storable(name):
        raise InputError(f"a path may hold neither NUL nor surrogates, got {shortened(name)}")
    return name


def toml(file: Path) -> dict[str, Any]:
    """The contents of a TOML file."""
    return toml_text(text(file, LARGEST_TOML), str(file))


def toml_text(content: str, name: str) -> dict[str, Any]:
    """The contents of a TOML text; errors call it `name`."""
    import tomllib

    try:
        data: dict[str, Any] = tomllib.loads(content)
    except RecursionError:
        raise InputError(f"{name} is nested more than {DEEPEST} deep") from None
    except ValueError as error:
        raise InputError(f"{name} is not TOML: {error}") from None
    checked(data, name)
    return data


def json_file(file: Path) -> Any:
    """The contents of a JSON file."""
    return json_text(text(file), str(file))


def json_text(content: Any, name: str) -> Any:
    """The contents of a JSON text; errors call it `name`."""
    return checked(parsed(content, name), name)


#: entries of files that version 1.0 named otherwise, with their present names
_FORMER_ENTRIES = {"limit": "best_possible"}


def renamed_entries(data: Mapping[str, Any]) -> dict[str, Any]:
    """The entries of a stored result by their present names.

    >>> renamed_entries({"objective": 4.0, "limit": 3.9})
    {'objective': 4.0, 'best_possible': 3.9}
    """
    return {_FORMER_ENTRIES.get(name, name): value for name, value in data.items()}


def of_known_format(data: Mapping[str, Any], name: str) -> dict[str, Any]:
    """The other entries of an object whose format is known, by their present names; errors call it `name`.

    Raises
    ------
    InputError
        If it is of a newer format, or its format is no whole number from 1 on.

    Examples
    --------
    >>> of_known_format({"format": 1, "program": "objective"}, "the certificate")
    {'program': 'objective'}
    >>> of_known_format({"format": FORMAT + 1}, "the certificate")
    Traceback (most recent call last):
    optlaws.errors.InputError: the certificate was written by a newer optlaws: format 2, this reads up to 1
    """
    entries = renamed_entries(data)
    stated_format = entries.pop("format", 1)
    if type(stated_format) is not int or stated_format < 1:
        raise InputError(f"{name}: the format must be a whole number from 1 on, got {shortened(stated_format)}")
    if stated_format > FORMAT:
        raise InputError(f"{name} was written by a newer optlaws: format {stated_format}, this reads up to {FORMAT}")
    return entries


def check_names(given: Iterable[object], known: Iterable[str], what: str) -> None:
    """Refuse names that are not known; the error says what the nearest one is called.

    >>> check_names(["lenght"], ["length"], "entry of a rod")
    Traceback (most recent call last):
    optlaws.errors.InputError: unknown entry of a rod 'lenght'; did you mean 'length'?
    """
    names = tuple(known)
    for name in given:
        if not isinstance(name, str) or name not in names:
            raise InputError(unknown_key(name, names, what))


def entries_of(data: Any, names: Sequence[str], what: str, *, alone: bool = False) -> dict[str, Any]:
    """The named entries of a stored value, from which others are computed, unless they stand `alone`.

    Raises
    ------
    InputError
        If it is no table, one is missing, or there is another though they stand alone; errors call the value `what`.

    Examples
    --------
    >>> entries_of({"law": {}, "B": 1.5}, ["B"], "a loader")
    {'B': 1.5}
    """
    if not isinstance(data, Mapping):
        raise InputError(f"{what} must be a table, got {shortened(data)}")
    missing = [name for name in names if name not in data]
    if missing:
        raise InputError(f"{what} needs {', '.join(missing)}")
    if alone:
        check_names(data, names, f"entry of {what}")
    return {name: data[name] for name in names}


class JsonText:
    """Values with `to_dict` and `from_dict`, as JSON text too.

    Examples
    --------
    >>> from optlaws import MotionLaw, smoothstep
    >>> MotionLaw.from_json(smoothstep(4).to_json()) == smoothstep(4)
    True
    """

    __slots__ = ()

    #: what an error calls the text, and how it is laid out
    _json_name: ClassVar[str] = "a stored value"
    _json_layout: ClassVar[Mapping[str, Any]] = {"ensure_ascii": False, "indent": 1}

    def to_dict(self) -> dict[str, Any]:
        """The value as plain data: numbers, strings, lists and tables."""
        raise NotImplementedError

    @classmethod
    def from_dict(cls, data: Any) -> Self:
        """The value that `to_dict` described."""
        raise NotImplementedError

    def to_json(self) -> str:
        """The contents of `to_dict` as JSON text."""
        return json.dumps(self.to_dict(), **self._json_layout)

    @classmethod
    def from_json(cls, text: str) -> Self:
        """The value that `to_json` wrote.

        Raises
        ------
        InputError
            If the text is not JSON or does not describe such a value.
        """
        return cls.from_dict(json_text(text, cls._json_name))


def parsed(content: Any, name: str) -> Any:
    """The contents of a JSON text, checked for its size and for repeated keys only.

    Examples
    --------
    >>> parsed('{"B": 1.6, "B": 1.7}', "the problem")
    Traceback (most recent call last):
    optlaws.errors.InputError: the problem: the key 'B' comes twice
    """
    try:
        # as it comes from a network
        content = content.decode("utf-8-sig") if isinstance(content, bytes) else content
        _check_extent(content)
        return json.loads(content, object_pairs_hook=_once, parse_constant=_no_number)
    except RecursionError:
        raise InputError(f"{name} is nested more than {DEEPEST} deep") from None
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} must be JSON text and is not JSON: {error}") from None


def _check_extent(content: Any) -> None:
    """Refuse a text whose values would take more memory than any of ours."""
    if not isinstance(content, str):
        raise InputError(f"must be JSON text, got {shortened(content)}")
    if len(content) > LARGEST_JSON:
        raise InputError(f"larger than {LARGEST_JSON} characters")
    brackets = content.count("[") + content.count("{")
    values = brackets + content.count(",") + content.count(":") + content.count("\\")
    if brackets > _MOST_BRACKETS or values > _MOST_VALUES:
        raise InputError(
            f"{values} values and {brackets} lists and objects are more than {_MOST_VALUES} and {_MOST_BRACKETS}: "
            "give it in parts, such as those of synthesize_chunks"
        )


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    entries: dict[str, Any] = {}
    for key, value in pairs:
        if key in entries:
            raise InputError(f"the key {shortened(key)} comes twice")
        entries[key] = value
    return entries


def _no_number(text: str) -> float:
    raise InputError(f"{text} is no JSON number")


def checked(data: Any, name: str) -> Any:
    """The data, if it is nested at most 50 deep, its integers fit a float, and its texts hold no NUL or surrogate.

    Examples
    --------
    >>> checked({"B": [1, 10**400]}, "the study")
    Traceback (most recent call last):
    optlaws.errors.InputError: the study holds an integer of 1329 bits, outside the range of floating-point numbers
    """
    level = [data]
    for _ in range(DEEPEST):
        deeper: list[Any] = []
        for value in level:
            if isinstance(value, Mapping):
                deeper += [*value.keys(), *value.values()]
            elif isinstance(value, list | tuple):
                # most of a file are numbers
                deeper += [part for part in value if type(part) is not float]
            else:
                _check_leaf(value, name)
        if not deeper:
            return data
        level = deeper
    raise InputError(f"{name} is nested more than {DEEPEST} deep")


def _check_leaf(value: object, name: str) -> None:
    if isinstance(value, int) and value.bit_length() > _MOST_BITS:
        raise InputError(f"{name} holds {shortened(value)}, outside the range of floating-point numbers")
    if isinstance(value, str) and not storable(value):
        raise InputError(f"{name} holds text with NUL or surrogates: {shortened(value)}")


def is_number(value: object) -> TypeGuard[float]:
    """Whether plain data, as JSON and TOML have them, are a number: a switch is none.

    >>> [is_number(value) for value in (2, 0.5, True, "2")]
    [True, True, False, False]
    """
    return isinstance(value, int | float) and not isinstance(value, bool)


def storable(value: str) -> bool:
    """Whether a text can be written anywhere: it holds no NUL and no surrogate."""
    return "\0" not in value and not any("\ud800" <= character <= "\udfff" for character in value)
