"""Tables of points in columns of text: which columns are meant, their numbers, headings and lines."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from math import isfinite
from pathlib import Path
from typing import NamedTuple

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.files import reading
from optlaws.files.writing import MARK
from optlaws.laws.catalogue.tables.controller_files import FEWEST_POINTS, decoded
from optlaws.laws.catalogue.tables.curve_pieces import TablePoints, TableUnits, pieces_between, resolution_of
from optlaws.laws.catalogue.tables.tokens import NUMBER, TextCell, cells_of, no_number, uncommented
from optlaws.numbers import Array

#: bytes of a table
LARGEST_TABLE = 20_000_000
_MOST_POINTS = 100_000
_RATE = 0.25  # velocities that are so near the slopes of the positions are by the master, not the second
_SLOPE = 0.5  # of the greatest velocity: one that is farther from the slope of the positions is wrong
#: tables whose numbers count so many degrees or millimetres
ISG, _ISG_DIGIT = "ISG and TwinCAT CNC", 1e-4
_HEADER, _BLANK = re.compile(r"([A-Za-z][\w \t-]*?)\s*=\s*(\S+)"), re.compile(r"\s")
_KEYWORD = re.compile(r"[\s;]")
_SEPARATORS = (";", "\t", ",", "|", None)
_LOOKED_AT = 500  # lines by which the separator is chosen
#: a line that is a comment alone
_COMMENT = re.compile(r"(?:#|//)\s*(.*)")
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


def points_of(
    file: Path,
    columns: Sequence[Column] | None = None,
    *,
    most: int = 2,
    content: str | None = None,
    cam: str | None = None,
) -> TablePoints:
    """The points of a table in any layout: columns of text, or what a controller has.

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
    cam
        Which cam of a file with several; the heading of its column.

    Raises
    ------
    InputError
        If the file cannot be read, has more columns and none are chosen, or a line is no point.
    """
    text = reading.text(file, LARGEST_TABLE, legacy=True) if content is None else content
    if columns is None:
        with located(str(file)):
            known = decoded(text, cam)
        if known is not None:
            return known
    lines, headings = _lines_of(text, str(file))
    if cam is not None:
        columns = (1 + lines[0].numeric[0], cam)
    chosen = _chosen(columns, headings, lines[0], str(file), most, written_by_optlaws=MARK in text)
    while lines and not any(lines[-1].numbers(chosen)):
        lines.pop()
    if not lines:
        raise InputError(f"{file} has no numbers in the columns {', '.join(str(i + 1) for i in chosen)}")
    matches = _checked(lines, chosen, str(file))
    texts = [[str(match[1]).replace(",", ".") for match in row] for row in matches]
    distinct = [i for i, row in enumerate(texts) if not i or row != texts[i - 1]]
    places, heights, *derivatives = (np.array([float(texts[i][n]) for i in distinct]) for n in range(len(chosen)))
    above = [headings[i] if i < len(headings) else "" for i in chosen[:2]]
    names = [f"{name} {match[2] or ''}".strip() for name, match in zip(above, matches[0], strict=False)]
    digit, numbered = resolution_of([texts[i][1] for i in distinct], heights), [lines[i].number for i in distinct]
    points = TablePoints(places, heights, digit, "columns of numbers", units=TableUnits(*names), lines=numbered)
    with located(str(file)):
        if derivatives:
            return _with_derivatives(points, derivatives)
        return _with_keywords(points, uncommented(text), len(lines))


def _with_derivatives(points: TablePoints, derivatives: Sequence[Array]) -> TablePoints:
    """The polynomials between points with derivatives, which may be by the second."""
    rate = rate_of(points.places, points.heights, derivatives[0], points.lines)
    scaled = [row / rate**nu for nu, row in enumerate(derivatives, start=1)]
    rows = np.column_stack([points.places, points.heights, *scaled]).tolist()
    pieces = pieces_between(rows, [None] * len(rows), points.lines)
    return TablePoints.of_pieces(pieces, points.layout, units=points.units, lines=points.lines)


def rate_of(places: Array, heights: Array, velocities: Array, lines: Sequence[int]) -> float:
    """The speed of the master where velocities are per second; 1 where they are per unit of the master.

    The integral of their magnitude by the trapezium rule, which is sharp between rests, is the way of the positions
    times the rate. Points that are too few for this have velocities by the master.

    >>> x = np.linspace(0.0, 10.0, 101)
    >>> round(rate_of(x, np.sin(x), 5.0 * np.cos(x), range(101)), 2), rate_of(x, np.sin(x), np.cos(x), range(101))
    (5.0, 1.0)
    """
    steps, means = np.diff(places), 0.5 * (velocities[1:] + velocities[:-1])
    if not np.all(steps > 0.0):
        raise InputError(
            f"line {lines[int(np.argmax(steps <= 0.0)) + 1]}: places of points with velocities must increase"
        )
    if len(places) < FEWEST_POINTS or not velocities.any():
        return 1.0
    way = float(np.abs(np.diff(heights)).sum())
    rate = float(np.abs(steps * means).sum()) / way if way else 1.0
    off = np.abs(means - rate * np.diff(heights) / steps) / max(float(np.abs(velocities).max()), np.finfo(float).tiny)
    worst = int(np.argmax(off))
    if not rate > 0.0 or off[worst] > _SLOPE:
        raise InputError(f"line {lines[worst]}: the velocity there is not that of the positions: check the columns")
    return 1.0 if abs(rate - 1.0) < _RATE else rate


def _with_keywords(points: TablePoints, text: str, count: int) -> TablePoints:
    """The points of a layout with keywords around its columns, or the functions between them where it states these."""
    lines = [TextCell(line.strip(), number) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    keywords = {_KEYWORD.split(line.text)[0].casefold() for line in lines}
    stated = lines[0] if lines[0].text.isdigit() else None
    layout = "SEW MOVI-C" if stated else points.layout
    for begin, end, name in (("TABLE_BEGIN", "TABLE_END", "Kollmorgen KAS"), ("Begintable", "EndTable", ISG)):
        if begin.casefold() in keywords:
            layout = name
            if end.casefold() not in keywords:
                raise InputError(f"line {lines[-1].line}: the table has no {end}: its end is missing")
    header = {}
    for line in lines if layout == ISG else []:
        if match := _HEADER.match(line.text):
            header[_BLANK.sub("", match[1]).casefold()] = TextCell(match[2], line.line)
    stated = header.get("lines", stated)
    if stated is not None and stated.number() != count:
        raise InputError(
            f"line {stated.line}: the file states {stated.text} points and contains {count}: lines are missing or "
            "superfluous"
        )
    if layout != ISG:
        return replace(points, layout=layout)
    places, heights = _ISG_DIGIT * points.places, _ISG_DIGIT * points.heights
    points = replace(points, layout=layout, places=places, heights=heights, digit=_ISG_DIGIT * points.digit)
    kind = header["functiontype"].number() if "functiontype" in header else None
    return _of_lines_and_polynomials(points, first_is_line=kind == 5) if kind in {4, 5} else points


def _of_lines_and_polynomials(points: TablePoints, *, first_is_line: bool) -> TablePoints:
    """The straight lines and polynomials that alternate between the points of a turn of 360 deg, and over its seam.

    Types 4 and 5 of the kernel's manual: polynomials of degree 5 go on with the slopes of the lines beside them,
    without acceleration. It counts from the seam: in POLY5-LINE the first points have a line between them.
    """
    if len(points.places) % 2:
        raise InputError(
            f"line {points.lines[-1]}: lines and polynomials alternate over an even number of points, and the table "
            f"has {len(points.places)}"
        )
    rows = np.column_stack([points.places, points.heights]).tolist()
    rows.append([rows[0][0] + 360.0, rows[0][1]])
    both = ["line", "polyfive"] if first_is_line else ["polyfive", "line"]
    lines = [*points.lines, points.lines[-1]]
    pieces = pieces_between(rows, both * (len(rows) // 2), lines, endless=True)
    return TablePoints.of_pieces(pieces, points.layout, units=points.units, lines=points.lines)


def _lines_of(content: str, name: str) -> tuple[list[_Line], list[str]]:
    """The lines from the first point on, by the separator that makes most of them points, and the headings above."""
    texts = [(number, line) for number, line in enumerate(uncommented(content).splitlines(), 1) if line.strip(" |:-\t")]
    some = texts[:: max(1, len(texts) // _LOOKED_AT)]
    separator = max(_SEPARATORS, key=lambda mark: sum(_fit(cells_of(line, mark)) for _, line in some))
    lines = [_Line(number, cells_of(line, separator)) for number, line in texts]
    first = next((i for i, line in enumerate(lines) if len(line.numeric) > 1), None)
    if first is None:
        form = "lines of a time or an angle and a displacement, such as 7.5,0.0959"
        raise InputError(f"{name} holds no points: {form}{_no_points(lines)}")
    headings = _commented_headings(content, lines[first], separator) or (lines[first - 1].cells if first else [])
    return lines[first:], headings


def _commented_headings(content: str, first: _Line, separator: str | None) -> list[str]:
    """The headings in a comment right above the first point that has as many cells; none where there is no such one."""
    above = (line.strip() for line in reversed(content.splitlines()[: first.number - 1]))
    comment = _COMMENT.match(next(filter(None, above), ""))
    headings = cells_of(comment[1], separator) if comment else []
    return headings if len(headings) == len(first.cells) else []


def _no_points(lines: Sequence[_Line]) -> str:
    """Why lines are no points, by one in the middle, after a colon; "" where nothing tells."""
    grouped = (no_number(cell) for line in lines for cell in line.cells)
    if thousands := next((text for text in grouped if "thousands" in text), ""):
        return f": {thousands}"
    line = lines[len(lines) // 2] if lines else _Line(0, [])
    if len(line.numeric) == len(line.cells) == 1:
        return f": line {line.number} has one number alone"
    angle = re.search(r"\d+°\s*\d\S*", " ".join(line.cells))
    return f": line {line.number}: write {shortened(angle[0])} in decimal degrees" if angle else ""


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
        if not all(isfinite(float(match[1].replace(",", "."))) for match in row):
            raise InputError(f"{where}: {cells} holds no finite numbers: mend the line")
        if rows and [match[2] for match in row] != [match[2] for match in rows[0]]:
            raise InputError(f"{where}: {cells} is in other units than the line above: mend the line")
        rows.append(row)
    return rows
