"""What several commands take alike: whole numbers, laws by name or file, --json, files to write."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter, Token

import optlaws
from optlaws.errors import InputError


def _whole(_: object, tokens: Sequence[Token]) -> int:
    # the parser itself would cut 2.5 to 2
    return int(tokens[0].value)


Whole = Annotated[int, Parameter(converter=_whole)]
AsJson = Annotated[bool, Parameter(name="--json")]

_PICTURES = (".png", ".svg")


def read_law(text: str) -> optlaws.MotionLaw:
    """A law of the catalogue by its name or code, or the law in a JSON file: alone, or of a solution.

    Raises
    ------
    InputError
        If there is no such law, or the file cannot be read or holds none.
    """
    from optlaws.files import reading

    if not text.endswith(".json"):
        return optlaws.catalogue[text].law
    data = reading.json_file(Path(text))
    if isinstance(data, dict) and "kind" not in data and "law" in data:
        data = data["law"]
    try:
        return optlaws.MotionLaw.from_dict(data)
    except InputError as error:
        raise InputError(f"{text}: {error}") from None


def check_picture(file: Path | None) -> None:
    """Refuse a file for --plot whose name says no kind of picture."""
    if file is not None and file.suffix not in _PICTURES:
        raise InputError(f"--plot takes a file name that ends in {' or '.join(_PICTURES)}, got {file}")


def save(file: Path, data: Mapping[str, Any]) -> None:
    """Write what --output asks for, with who made it."""
    from optlaws.files.writing import MARK, write

    write(file, json.dumps({"about": MARK, **data}, indent=1) + "\n")
