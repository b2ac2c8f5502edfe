"""Files as plain data, strictly: nothing twice, every number finite, and no size that would run for days."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from math import isfinite
from numbers import Real
from pathlib import Path
from typing import Any, TypeVar

from optlaws.errors import InputError
from optlaws.synthesis.certificate import Certificate, Contact
from optlaws.synthesis.power_certificate import PowerCertificate, Step

Kind = TypeVar("Kind")

#: greatest entries that are sizes, and how many numbers a law may have
_SIZES = {"order": 100, "degree": 300, "continuity": 300, "breaks": 1000}
_FORMAT = 1
#: what needs a proof
_CLAIMS = {"objective", "lower_bound", "bound", "gap", "certificate", "power_certificate", "contacts", "steps"}


def read(source: Mapping[str, Any] | Path | str) -> Mapping[str, Any]:
    """A JSON object, or data that could be one.

    Raises
    ------
    InputError
        If it cannot be read, is no JSON object, names a key twice, or has numbers that are not finite or too large.

    Examples
    --------
    >>> read({"order": 4, "B": float("inf")})
    Traceback (most recent call last):
    optlaws.errors.InputError: B must be a finite number, got inf
    """
    data = source if isinstance(source, Mapping) else _loaded(Path(source))
    try:
        _check(data, "")
    except RecursionError:
        raise InputError("this is nested too deeply to be a solution") from None
    return data


def _loaded(file: Path) -> Mapping[str, Any]:
    try:
        text = file.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{file} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: not JSON: {error}") from None
    try:
        data = json.loads(text, object_pairs_hook=_once, parse_constant=_no_number)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None
    except RecursionError:
        raise InputError(f"{file}: nested too deeply to be a solution") from None
    except ValueError as error:
        raise InputError(f"{file}: not JSON: {error}") from None
    if not isinstance(data, dict):
        raise InputError(f"{file}: not a JSON object but {type(data).__name__}")
    return data


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise InputError(f"the key {key!r} comes twice")
        found[key] = value
    return found


def _no_number(text: str) -> float:
    raise InputError(f"{text} is no JSON number")


def _check(data: object, path: str) -> None:
    if isinstance(data, Mapping):
        for key, value in data.items():
            _check_size(key, value, path)
            _check(value, f"{path}.{key}" if path else str(key))
        if "format" in data and (data["format"] != _FORMAT or isinstance(data["format"], bool)):
            raise InputError(f"{path or 'the file'} has the format {data['format']!r}; this version reads {_FORMAT}")
    elif isinstance(data, list | tuple):
        for i, value in enumerate(data):
            _check(value, f"{path}[{i}]")
    elif isinstance(data, Real):
        _check_number(data, path)


def _check_number(value: Real, path: str) -> None:
    try:
        finite = isfinite(value)
    except OverflowError:
        raise InputError(f"{path} is beyond the numbers of double precision") from None
    if not finite:
        raise InputError(f"{path} must be a finite number, got {value!r}")


def _check_size(key: str, value: object, path: str) -> None:
    most = _SIZES.get(key)
    size = len(value) if isinstance(value, list | tuple) else value
    if most is not None and isinstance(size, int) and size > most:
        raise InputError(f"{f'{path}.' if path else ''}{key}: {size} is more than exact verification takes, {most}")


def entries(data: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """What can be verified, by where it is: solutions, certificates, and laws with their constants.

    Examples
    --------
    >>> list(entries({"rows": [{"solution": {"law": {}, "constants": {}}}, {"text": "none"}]}))
    ['rows[0].solution']
    """
    return dict(_walk(data, ""))


def unfounded(data: Mapping[str, Any]) -> list[str]:
    """Where something is claimed of a problem without a certificate."""
    return [path for path, one in _mappings(data, "") if _CLAIMS & one.keys() and not is_entry(one)]


def is_entry(data: Mapping[str, Any]) -> bool:
    """Whether this is a solution, a certificate, or a law with its constants and no further claim."""
    solution = {"problem", "law", "certificate"} <= data.keys()
    certificate = {"problem", "contacts"} <= data.keys() or {"problem", "steps"} <= data.keys()
    return solution or certificate or ({"law", "constants"} <= data.keys() and not _CLAIMS & data.keys())


def _walk(data: object, path: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    for place, one in _mappings(data, path):
        if is_entry(one):
            yield place, one


def _mappings(data: object, path: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Every object that is not part of an entry."""
    if isinstance(data, Mapping):
        yield path, data
        if not is_entry(data):
            for key, value in data.items():
                yield from _mappings(value, f"{path}.{key}" if path else str(key))
    elif isinstance(data, list | tuple):
        for i, value in enumerate(data):
            yield from _mappings(value, f"{path}[{i}]")


def built(make: Callable[[Any], Kind], data: object, name: str) -> Kind:
    """What `make` makes of data that may be anything.

    Raises
    ------
    InputError
        If it makes nothing of it.
    """
    try:
        return make(data)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    except (AttributeError, KeyError, OverflowError, TypeError, ValueError) as error:
        raise InputError(f"{name}: {type(error).__name__}: {error}") from None


def certificate_of(data: Mapping[str, Any]) -> Certificate:
    """A certificate of which every entry is of its type.

    Raises
    ------
    InputError
        If one is not.
    """
    found = Certificate.from_dict(data)
    _check_contacts(found.contacts)
    return found


def power_certificate_of(data: Mapping[str, Any]) -> PowerCertificate:
    """A power certificate of which every entry is of its type.

    Raises
    ------
    InputError
        If one is not.
    """
    found = PowerCertificate.from_dict(data)
    for step in found.steps:
        if isinstance(step, Step):
            _check_contacts(step.contacts)
    return found


def _check_contacts(contacts: tuple[Contact, ...]) -> None:
    for one in contacts:
        # what JSON holds need not be what the class declares
        name: Any = one.constraint
        values = (one.sign, one.k, one.multiplier, *one.direction)
        if not isinstance(name, str) or not all(type(value) in {int, float} for value in values):
            raise InputError(f"a contact needs the name of a constraint, and numbers, got {one!r}")


def number(data: Mapping[str, Any], name: str) -> float:
    """An entry that must be a number."""
    value = data.get(name)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"{name} must be a finite number, got {value!r}")
    return float(value)
