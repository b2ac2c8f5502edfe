"""Tables of points in columns of text: which columns are meant, their numbers, headings and lines."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.files.writing import MARK
from optlaws.laws.catalogue.tables.tokens import NUMBER, cells_of, no_number, uncommented

#: bytes of a table
LARGEST_TABLE = 20_000_000
_MOST_POINTS = 100_000
_SEPARATORS = (";", "\t", ",", "|", None)
#: a heading up to its unit
_HEADING = re.compile(r"[^\s,;(\[]*")
#: columns of tables that optlaws writes
_MASTERS, _SLAVES = ("k", "x", "master", "cam"), ("y", "a", "position", "displacement")
#: of points with derivatives by the master
_DERIVATIVES = ("v", "a", "j")

Column = int | str


class _Line(NamedTuple):
    """A line of a file: its number there, and its cells."""

    number: int
    cells: list[str]

    @property
    def numeric(self) -> list[int]:
        """Which of its cells are numbers."""
        return [i for i, cell in enumerate(self.cells) if NUMBER.fullmatch(cell)]

    def numbers(self, columns: Sequence[int]) -> list[re.Match[str] | None]:
        """The numbers in some of its columns."""
        return [NUMBER.fullmatch(self.cells[i]) if i < len(self.cells) else None for i in columns]


class TablePoints(NamedTuple):
    """The points of a table.

    Attributes
    ----------
    places, heights
        Times or angles, and displacements, as the table has them.
    digit
        The unit of the last digit of the displacements.
    lines
        Where the points stand in the file.
    derivatives
        Velocities, accelerations and jerks by the master, as many as are read.
    headings
        Above the columns of places and of heights, with the units behind their numbers; empty where there are none.
    """

    places: list[float]
    heights: list[float]
    digit: float
    lines: list[int]
    derivatives: tuple[list[float], ...] = ()
    headings: tuple[str, str] = ("", "")


def points_of(
    file: Path, columns: Sequence[Column] | None = None, *, most: int = 2, content: str | None = None
) -> TablePoints:
    """The points of a table, as `law_of_points` reads it.

    Parameters
    ----------
    file
        As of `law_of_points`.
    columns
        As of `law_of_points`, and behind these the derivatives of the displacement by the time or angle, in order.
    most
        How many columns are read: 2 without derivatives.
    content
        The text of the file where it has been read.

    Raises
    ------
    InputError
        If the file cannot be read, has more columns and none are chosen, or a line is no point.
    """
    text = reading.text(file, LARGEST_TABLE, legacy=True) if content is None else content
    lines, headings = _lines_of(text, str(file))
    chosen = _chosen(columns, headings, lines[0], str(file), most, written_by_optlaws=MARK in text)
    while not any(lines[-1].numbers(chosen)):
        lines.pop()
    matches = _checked(lines, chosen, str(file))
    texts = [[str(match[1]).replace(",", ".") for match in row] for row in matches]
    distinct = [i for i, row in enumerate(texts) if not i or row != texts[i - 1]]
    places, heights, *derivatives = ([float(texts[i][n]) for i in distinct] for n in range(len(chosen)))
    above = (headings[i] if i < len(headings) else "" for i in chosen[:2])
    of_place, of_height = (f"{name} {match[2] or ''}".strip() for name, match in zip(above, matches[0], strict=False))
    digit = resolution_of([texts[i][1] for i in distinct], heights)
    numbered = [lines[i].number for i in distinct]
    return TablePoints(places, heights, digit, numbered, tuple(derivatives), (of_place, of_height))


def _lines_of(content: str, name: str) -> tuple[list[_Line], list[str]]:
    """The lines from the first point on, by the separator that makes most of them points, and the headings above."""
    texts = [(number, line) for number, line in enumerate(uncommented(content).splitlines(), 1) if line.strip(" |:-\t")]
    separator = max(_SEPARATORS, key=lambda mark: sum(_fit(cells_of(line, mark)) for _, line in texts))
    lines = [_Line(number, cells_of(line, separator)) for number, line in texts]
    first = next((i for i, line in enumerate(lines) if len(line.numeric) > 1), None)
    if first is None:
        grouped = (no_number(cell) for line in lines for cell in line.cells)
        reason = next((f": {text}" for text in grouped if "thousands" in text), "")
        raise InputError(
            f"{name} holds no points: lines of a time or an angle and a displacement, such as 7.5,0.0959{reason}"
        )
    return lines[first:], lines[first - 1].cells if first else []


def _fit(cells: list[str]) -> int:
    """How well cells are a point: 2 where each is a number, 1 where two are."""
    count = sum(NUMBER.fullmatch(cell) is not None for cell in cells)
    return (count > 1) * (1 + (count == sum(map(bool, cells))))


def _chosen(
    columns: Sequence[Column] | None,
    headings: list[str],
    line: _Line,
    name: str,
    most: int,
    *,
    written_by_optlaws: bool,
) -> tuple[int, ...]:
    """The places of the two columns that are meant, and of derivatives."""
    named = [heading.casefold() for heading in headings]
    if columns is not None:
        if isinstance(columns, str) or not 2 <= len(columns) <= most:
            more = "" if most == 2 else f", and up to {most - 2} of its derivatives by the first"
            raise InputError(
                f"columns are two, of the time or angle and of the displacement{more}, got {shortened(columns)}"
            )
        return tuple(_place(column, headings, len(line.cells), name) for column in columns)
    short = [match[0] if (match := _HEADING.match(heading)) else "" for heading in named]
    of_ours = [next((short.index(word) for word in words if word in short), None) for words in (_MASTERS, _SLAVES)]
    if written_by_optlaws and None not in of_ours:
        derivatives = short[2:] if short[:2] == ["x", "y"] else []
        orders = len(derivatives) if derivatives == list(_DERIVATIVES[: len(derivatives)]) else 0
        return int(of_ours[0] or 0), int(of_ours[1] or 0), *range(2, min(2 + orders, most))
    numeric = line.numeric
    if len(numeric) > 2:
        known = ", ".join(f"{i + 1} {headings[i]!r}" if i < len(headings) else str(i + 1) for i in numeric)
        raise InputError(
            f"{name}, line {line.number}: {len(numeric)} columns of numbers: say by columns which are the time or "
            f"angle and the displacement, such as columns=({numeric[0] + 1}, {numeric[1] + 1}), of {known}"
        )
    return numeric[0], numeric[1]


def _place(column: Column, headings: list[str], width: int, name: str) -> int:
    text = str(column).strip().casefold()
    matches = [
        i
        for i, heading in enumerate(headings)
        if text in {heading.casefold(), _HEADING.match(heading.casefold())[0]}  # type: ignore[index] # matches ""
    ]
    if len(matches) == 1:
        return matches[0]
    if not text.isdecimal() or not 1 <= int(text) <= width:
        raise InputError(
            f"{name} has no column {shortened(column)}: columns are numbers from 1 to {width}"
            + (f", or one of {', '.join(map(repr, headings))}" if headings else "")
        )
    return int(text) - 1


def _checked(lines: list[_Line], columns: tuple[int, ...], name: str) -> list[list[re.Match[str]]]:
    """The numbers of all lines; refuses lines that are no points, or in several units."""
    if len(lines) > _MOST_POINTS:
        raise InputError(f"{name} has more than {_MOST_POINTS} points")
    count, width = "two" if len(columns) == 2 else len(columns), len(lines[0].numeric)
    rows = list[list[re.Match[str]]]()
    for line in lines:
        where, cells = f"{name}, line {line.number}", shortened(", ".join(line.cells))
        row = [match for match in line.numbers(columns) if match]
        if len(row) < len(columns):
            wrong = next((text for text in map(no_number, line.cells) if "thousands" in text), "")
            remedy = wrong or "mend the line, or put # before it if it is a comment"
            raise InputError(f"{where}: a point is {count} numbers, got {cells}; {remedy}")
        if len(line.numeric) > max(width, len(columns)):
            raise InputError(
                f"{where}: {len(line.numeric)} numbers, got {cells}, where the line of the first point has {width}: "
                "write numbers without separators of thousands, and one point on a line"
            )
        if rows and [match[2] for match in row] != [match[2] for match in rows[0]]:
            raise InputError(f"{where}: {cells} is in other units than the line above: mend the line")
        rows.append(row)
    return rows


def resolution_of(texts: list[str], values: list[float]) -> float:
    """The unit of the last digit of the large values: small values have more decimals, round ones fewer."""
    large = 0.1 * max(map(abs, values))
    return min(_last_digit(text) for text, value in zip(texts, values, strict=True) if abs(value) >= large)


def _last_digit(text: str) -> float:
    digits, _, exponent = text.replace(",", ".").lower().partition("e")
    return 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))
