"""Problem files: TOML that defines a task, read and checked against the entries of its job."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, TypeVar, get_args, get_origin, get_type_hints

import msgspec

from optlaws.echo import unknown_key
from optlaws.errors import InputError
from optlaws.lazy import process_lock

Kind = TypeVar("Kind")

_ONE_AT_A_TIME = process_lock()


def typed(data: Any, kind: type[Kind]) -> Kind:
    """The value of a type from plain data.

    One at a time: two threads that met a kind for the first time have crashed in msgspec (0.22).
    """
    with _ONE_AT_A_TIME:
        return msgspec.convert(data, kind)


#: kinds of values as people call them
_WORDS = {"int": "an integer", "float": "a number", "str": "a text", "array": "a list", "object": "a table"}

#: an entry that many jobs have
Text = Annotated[str, msgspec.Meta(min_length=1)]

Spec = TypeVar("Spec", bound=msgspec.Struct)


def convert(data: Mapping[str, Any], spec: type[Spec], file: Path) -> Spec:
    """Entries of a problem file as a typed value."""
    _check_keys(data, spec, str(file))
    try:
        return typed(data, spec)
    except msgspec.ValidationError as error:
        raise InputError(f"{file}: {_by_entry(str(error))}{_remedy(str(error))}") from None


def _by_entry(error: str) -> str:
    """The error of a type, with the user's entry in front.

    >>> _by_entry("Expected `int` >= 2 - at `$.rows`"), _by_entry("Expected `array` of length >= 1 - at `$.vary[...]`")
    ('rows: expected an integer >= 2', 'an entry of vary: expected a list of length >= 1')
    """
    what, _, place = error.rpartition(" - at `")
    if not place.startswith(("$.", "key in $.")):
        return error
    for name, word in _WORDS.items():
        what = what.replace(f"`{name}`", word)
    entry = place.rstrip("`").replace("$.", "").removesuffix("[...]")
    inside = "an entry of " if place.rstrip("`").endswith("[...]") else ""
    return f"{inside}{entry}: {what[:1].lower()}{what[1:]}"


def _remedy(error: str) -> str:
    """The remedy for a bare number in place of a text, which is mostly a quantity."""
    if not re.match(r"Expected `str.*`, got `(int|float)`", error):
        return ""
    return '; a number with a unit is written as text, such as "35 mm", "120 deg" or "200 rpm"'


def _check_keys(data: Any, spec: Any, where: str) -> None:
    origin, inner = get_origin(spec), get_args(spec)
    for part in inner if origin is UnionType else ():
        _check_keys(data, part, where)
    if origin is Literal and isinstance(data, str) and data not in inner:
        raise InputError(f"{where}: {unknown_key(data, map(str, inner), 'value')}")
    if origin is list and isinstance(data, list):
        for i, item in enumerate(data):
            _check_keys(item, inner[0], f"{where}[{i}]")
    elif origin is dict and isinstance(data, dict):
        for key, item in data.items():
            _check_keys(item, inner[1], f"{where}, {key}")
    elif isinstance(spec, type) and issubclass(spec, msgspec.Struct) and isinstance(data, Mapping):
        hints = get_type_hints(spec)
        names = {field.encode_name: hints[field.name] for field in msgspec.structs.fields(spec)}
        for key, item in data.items():
            if key not in names:
                raise InputError(f"{where}: {unknown_key(key, names)}")
            _check_keys(item, names[key], f"{where}, {key}")
