"""Reading files and texts: one door for text, one for TOML, one for JSON, each with limits.

Only regular files are read, up to a size, in UTF-8 with or without a byte order mark. What TOML or JSON holds is
checked once: how deep it is nested, how large its integers are, and that its text can be stored and printed.
"""

from __future__ import annotations

import json
import stat
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError

LARGEST_TOML = 1_000_000
LARGEST_JSON = 100_000_000
DEEPEST = 50
_MOST_BITS = 1024


def text(file: Path, largest: int = LARGEST_JSON) -> str:
    """The text of a regular file in UTF-8, without its byte order mark.

    Raises
    ------
    InputError
        If it is no regular file, cannot be read, is larger than `largest` bytes or is not UTF-8.

    Examples
    --------
    >>> text(Path("/dev/null"))
    Traceback (most recent call last):
    optlaws.errors.InputError: cannot read /dev/null: it is not a regular file
    """
    name = _named(file)
    try:
        if not stat.S_ISREG(file.stat().st_mode):
            raise InputError(f"cannot read {name}: it is not a regular file")
        with file.open("rb") as stream:
            data = stream.read(largest + 1)
    except OSError as error:
        raise InputError(f"cannot read {name}: {error.strerror or error}") from None
    if len(data) > largest:
        raise InputError(f"{name} is larger than {largest} bytes")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{name} is not a text file in UTF-8") from None


def _named(file: Path) -> str:
    name = str(file)
    if "\0" in name or not storable(name):
        raise InputError(f"a path may hold neither NUL nor surrogates, got {shortened(name)}")
    return name


def toml(file: Path) -> dict[str, Any]:
    """The contents of a TOML file.

    Raises
    ------
    InputError
        If it cannot be read, is larger than 1 MB, is not TOML, or holds what no problem needs: see `checked`.
    """
    import tomllib

    content = text(file, LARGEST_TOML)
    try:
        data: dict[str, Any] = tomllib.loads(content)
    except RecursionError:
        raise InputError(f"{file} is nested more than {DEEPEST} deep") from None
    except ValueError as error:
        raise InputError(f"{file} is not TOML: {error}") from None
    checked(data, str(file))
    return data


def json_file(file: Path) -> Any:  # noqa: ANN401 - whatever it holds
    """The contents of a JSON file.

    Raises
    ------
    InputError
        If it cannot be read, is larger than 100 MB, is not JSON, or holds what nothing needs: see `checked`.
    """
    return json_text(text(file), str(file))


def json_text(content: Any, name: str) -> Any:  # noqa: ANN401 - it is checked here
    """The contents of a JSON text; `name` is what an error calls it.

    Raises
    ------
    InputError
        If it is not JSON, or holds what nothing needs: see `checked`.

    Examples
    --------
    >>> json_text("[1, 2]", "a list")
    [1, 2]
    """
    try:
        data = json.loads(content)
    except RecursionError:
        raise InputError(f"{name} is nested more than {DEEPEST} deep") from None
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} must be JSON text and is not JSON: {error}") from None
    return checked(data, name)


def checked(data: Any, name: str) -> Any:  # noqa: ANN401 - whatever it holds
    """The data, if it is nested at most 50 deep, its integers fit a float, and its texts hold no NUL or surrogate.

    Raises
    ------
    InputError
        If it is not so.

    Examples
    --------
    >>> checked({"B": [1, 10**400]}, "the study")
    Traceback (most recent call last):
    optlaws.errors.InputError: the study holds an integer of 1329 bits, beyond all floats
    """
    level = [data]
    for _ in range(DEEPEST):
        deeper: list[Any] = []
        for value in level:
            if isinstance(value, Mapping):
                deeper += [*value.keys(), *value.values()]
            elif isinstance(value, list | tuple):
                deeper += value
            else:
                _check_leaf(value, name)
        if not deeper:
            return data
        level = deeper
    raise InputError(f"{name} is nested more than {DEEPEST} deep")


def _check_leaf(value: object, name: str) -> None:
    if isinstance(value, int) and value.bit_length() > _MOST_BITS:
        raise InputError(f"{name} holds {shortened(value)}, beyond all floats")
    if isinstance(value, str) and not storable(value):
        raise InputError(f"{name} holds text with NUL or surrogates: {shortened(value)}")


def storable(value: str) -> bool:
    """Whether a text can be written anywhere: it holds no NUL and no surrogate.

    Examples
    --------
    >>> storable("K"), storable("K" + chr(0))
    (True, False)
    """
    return "\0" not in value and not any("\ud800" <= character <= "\udfff" for character in value)
