"""Plain data as text: CSV, Markdown, and TOML as people write it; the same data give the same bytes."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from optlaws.errors import InputError
from optlaws.files.writing import MARK

Cell = str | float | int | None


def to_csv(columns: Sequence[str], rows: Sequence[Sequence[Cell]], *, about: str, digits: int = 8) -> str:
    """CSV with a first comment line; numbers to a number of significant digits, empty for None."""
    stream = io.StringIO()
    stream.write(f"# {about}; {MARK}\n")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_cell(cell, digits) for cell in row] for row in rows)
    return stream.getvalue()


def to_markdown(columns: Sequence[str], rows: Sequence[Sequence[Cell]], *, digits: int = 7) -> str:
    """A Markdown table with aligned columns."""
    cells = [list(columns), *([_cell(cell, digits) for cell in row] for row in rows)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(columns))]
    lines = ["| " + " | ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)) + " |" for row in cells]
    lines.insert(1, "|" + "|".join("-" * (w + 2) for w in widths) + "|")
    return "\n".join(lines) + "\n"


def _cell(cell: Cell, digits: int) -> str:
    if cell is None:
        return ""
    if isinstance(cell, float):
        return f"{cell:.{digits}g}"
    return str(cell)


def to_toml(data: Mapping[str, Any]) -> str:
    """TOML that reads as the same data: text, numbers, switches, lists and tables; None is left out.

    Examples
    --------
    >>> print(to_toml({"job": "cycle", "axis": [{"name": "slide", "segment": [{"kind": "dwell"}]}]}), end="")
    job = "cycle"
    <BLANKLINE>
    [[axis]]
    name = "slide"
    <BLANKLINE>
    [[axis.segment]]
    kind = "dwell"
    """
    return "\n".join(_lines(data, ())).strip("\n") + "\n"


def _lines(data: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    present = {name: value for name, value in data.items() if value is not None}
    tables = {name: value for name, value in present.items() if _has_own_lines(value)}
    yield from (f"{_key(name)} = {_value(value)}" for name, value in present.items() if name not in tables)
    for name, value in tables.items():
        place = (*path, name)
        heading = ".".join(map(_key, place))
        for entry in value if isinstance(value, list) else [value]:
            yield ""
            yield f"[[{heading}]]" if isinstance(value, list) else f"[{heading}]"
            yield from _lines(entry, place)


def _has_own_lines(value: Any) -> bool:
    """Whether a value is a table of tables, a list of tables, or a table of more than a line."""
    if isinstance(value, list):
        return bool(value) and all(isinstance(entry, Mapping) for entry in value)
    return isinstance(value, Mapping) and (
        len(value) > 4 or any(isinstance(entry, Mapping) for entry in value.values())
    )


def _key(name: str) -> str:
    plain = name and all(letter.isascii() and (letter.isalnum() or letter in "_-") for letter in name)
    return name if plain else _quoted(name)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)  # nan and inf are those of TOML too
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, Mapping):
        inner = ", ".join(f"{_key(name)} = {_value(entry)}" for name, entry in value.items() if entry is not None)
        return f"{{ {inner} }}" if inner else "{}"
    raise InputError(f"TOML has no {type(value).__name__}")


def _quoted(text: str) -> str:
    # the escapes of JSON are those of TOML, which wants DEL escaped too
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
