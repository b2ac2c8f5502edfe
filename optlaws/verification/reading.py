"""Files as plain data, strictly: no repeated keys, every number finite, and no size that would run for days."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import isfinite
from numbers import Real
from pathlib import Path
from typing import Any, TypeVar

from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.files.reading import of_known_format
from optlaws.synthesis.proof.data import as_json

Kind = TypeVar("Kind")

#: greatest entries that are sizes, and how many numbers a law may have
_SIZES = {"order": 100, "degree": 300, "continuity": 300, "breaks": 1000}
#: greatest magnitude of a number: none of a motion law comes near, and its powers are still numbers
_GREATEST = 1e100


def read(source: Mapping[str, Any] | Path | str) -> Mapping[str, Any]:
    """A JSON object, or data that could be one.

    >>> read({"order": 4, "B": float("inf")})
    Traceback (most recent call last):
    optlaws.errors.InputError: B must be a finite number, got inf
    """
    data = source if isinstance(source, Mapping) else _loaded(Path(source))
    try:
        _check(data, "")
        plain: dict[str, Any] = as_json(data)
    except InputError:
        raise
    except RecursionError:
        raise InputError("this is nested too deeply to be a solution") from None
    except (TypeError, ValueError) as error:
        raise InputError(f"this is no plain data: {error}") from None
    return plain


def _loaded(file: Path) -> Mapping[str, Any]:
    data = reading.parsed(reading.text(file), str(file))
    if not isinstance(data, dict):
        raise InputError(f"{file}: not a JSON object but {type(data).__name__}")
    return data


def _check(data: object, path: str) -> None:
    if isinstance(data, Mapping):
        for key, value in data.items():
            _check_size(key, value, path)
            _check(value, f"{path}.{key}" if path else str(key))
        if "format" in data:
            of_known_format(data, path or "the file")
    elif isinstance(data, list | tuple):
        for i, value in enumerate(data):
            # most of a file are numbers
            if type(value) is not float or not abs(value) <= _GREATEST:
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
    if abs(float(value)) > _GREATEST:
        raise InputError(f"{path}: {value!r} is beyond what exact verification takes, {_GREATEST:g}")


def _check_size(key: str, value: object, path: str) -> None:
    most = _SIZES.get(key)
    size = len(value) if isinstance(value, list | tuple) else value
    if most is not None and isinstance(size, int) and size > most:
        raise InputError(f"{f'{path}.' if path else ''}{key}: {size} is more than exact verification takes, {most}")


def built(make: Callable[[Any], Kind], data: object, name: str) -> Kind:
    """The value that `make` builds from data of any kind."""
    try:
        return make(data)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        raise InputError(f"{name}: {type(error).__name__}: {error}") from None


def number(data: Mapping[str, Any], name: str) -> float:
    """An entry that must be a number."""
    value = data.get(name)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"{name} must be a finite number, got {value!r}")
    return float(value)
