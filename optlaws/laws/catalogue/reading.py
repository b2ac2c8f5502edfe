"""Laws by name or from files: names of the catalogue, JSON, and tables of points as CSV."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.files.writing import MARK
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.law import MotionLaw
from optlaws.laws.making.through_points import MOST_THROUGH, law_of_table, law_through
from optlaws.laws.savin import FAMILIES, SavinFamily
from optlaws.numbers import not_negative

_EXACT_DIGITS = 1e-8  # of the stroke: a table whose last digit is less is taken as exact

#: bytes of a table
LARGEST_TABLE = 20_000_000
_MOST_POINTS = 100_000
_SEPARATORS = (";", "\t", ",", None)
_COMMENTS = ("#", "//", "(*", "%", "!")
_BESIDE = re.compile(r"\s+(?:#|//)")
#: a number as written, and the unit behind it
_NUMBER = re.compile(r"([+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?)\s*([^\W\d_][^\d\s]{0,9}|[°%\"'′″])?")
#: a heading up to its unit
_HEADING = re.compile(r"[^\s,;(\[]*")
#: and one of which it is more says nothing of velocities
_COARSEST = 0.01
#: columns of tables that optlaws writes
_MASTERS, _SLAVES = ("k", "x", "master", "cam"), ("y", "a", "position", "displacement")
#: of points with derivatives by the master
_DERIVATIVES = ("v", "a", "j")

Column = int | str


class _Line(NamedTuple):
    """A line of a file: its number there, and its cells."""

    number: int
    cells: list[str]

    def numbers(self, columns: Sequence[int]) -> list[re.Match[str] | None]:
        """The numbers in some of its columns."""
        return [_NUMBER.fullmatch(self.cells[i]) if i < len(self.cells) else None for i in columns]


class _Table(NamedTuple):
    """Lines of points, the columns that are meant, and the headings above."""

    lines: list[_Line]
    columns: tuple[int, ...]
    headings: list[str]

    def texts(self, place: int) -> list[str]:
        """The numbers of a column as written."""
        return [str(match[1]) for line in self.lines if (match := line.numbers(self.columns)[place])]


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
    table = _read(text, str(file), columns, most)
    places, heights, *derivatives = (
        [float(text.replace(",", ".")) for text in table.texts(i)] for i in range(len(table.columns))
    )
    lines = [line.number for line in table.lines]
    units = (match[2] or "" if (match := number) else "" for number in table.lines[0].numbers(table.columns[:2]))
    above = (table.headings[i] if i < len(table.headings) else "" for i in table.columns)
    headings = tuple(f"{heading} {unit}".strip() for heading, unit in zip(above, units, strict=False))
    digit = resolution_of(table.texts(1), heights)
    return TablePoints(places, heights, digit, lines, tuple(derivatives), (headings[0], headings[1]))


def law_of_points(
    file: Path,
    tolerance: float | None = None,
    columns: Sequence[Column] | None = None,
    *,
    content: str | None = None,
) -> MotionLaw:
    """The law of a table of points: as near as its last digit, or as its noise lets it be.

    Numbers stand between commas, semicolons, tabs or blanks, with points, or commas where these do not part them, and
    with the same unit behind all of a column or none. Lines before the first numbers are headings; lines behind the
    last ones without a number are not read.

    Parameters
    ----------
    file
        In UTF-8, UTF-16 or Latin-1.
    tolerance
        How far the law may be off a point, in the unit of the displacements; 0 for a law through them.
    columns
        Which hold the time or angle and the displacement, by their headings or by numbers from 1; where a table has
        just two, or is of optlaws, it need not be given.
    content
        The text of the file where it has been read.

    Raises
    ------
    InputError
        If the file cannot be read, has more columns and none are chosen, a line is no point, or no law keeps to them.
    """
    points = points_of(file, columns, content=content)
    k, a, unit, stroke = points.places, points.heights, points.digit, abs(points.heights[-1] - points.heights[0])
    if unit > _COARSEST * stroke > 0.0:
        raise InputError(f"{file}: the displacements have too few digits, {unit:g} of a stroke of {stroke:g}")
    try:
        if tolerance is not None:
            return law_through(k, a, not_negative(tolerance, "tolerance"))
        exact = unit <= _EXACT_DIGITS * stroke and len(k) <= MOST_THROUGH
        return law_of_table(k, a, 0.0 if exact else unit, lines=points.lines)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def _read(content: str, name: str, columns: Sequence[Column] | None, most: int) -> _Table:
    texts = [(number, line.strip()) for number, line in enumerate(content.splitlines(), 1)]
    texts = [(number, _BESIDE.split(line)[0]) for number, line in texts if line and not line.startswith(_COMMENTS)]
    separator = max(_SEPARATORS, key=lambda mark: sum(_fit(_cells(line, mark)) for _, line in texts))
    lines = [_Line(number, _cells(line, separator)) for number, line in texts]
    first = next((i for i, line in enumerate(lines) if _is_point(line.cells)), None)
    if first is None:
        raise InputError(f"{name} holds no points: lines of a time or an angle and a displacement, such as 7.5,0.0959")
    headings = lines[first - 1].cells if first else []
    chosen = _chosen(columns, headings, lines[first], name, most, written_by_optlaws=MARK in content)
    points = lines[first:]
    while points and not any(points[-1].numbers(chosen)):
        points.pop()
    _check(points, chosen, name)
    cells = [[line.cells[column] for column in chosen] for line in points]
    points = [line for i, line in enumerate(points) if not i or cells[i] != cells[i - 1]]
    return _Table(points, chosen, headings)


def _cells(line: str, separator: str | None) -> list[str]:
    try:
        cells = line.split() if separator is None else next(csv.reader([line], delimiter=separator))
    except csv.Error:
        return []
    return [cell.strip().strip('"') for cell in cells]


def _fit(cells: list[str]) -> int:
    """How well cells are a point: 2 where each is a number, 1 where two are."""
    return _is_point(cells) * (1 + all(_NUMBER.fullmatch(cell) for cell in cells if cell))


def _is_point(cells: list[str]) -> bool:
    return sum(_NUMBER.fullmatch(cell) is not None for cell in cells) >= 2


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
    numeric = [i for i, cell in enumerate(line.cells) if _NUMBER.fullmatch(cell)]
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


def _check(points: list[_Line], columns: tuple[int, ...], name: str) -> None:
    """Refuse lines that are no points, and numbers in several units."""
    if len(points) > _MOST_POINTS:
        raise InputError(f"{name} has more than {_MOST_POINTS} points")
    units: list[str] | None = None
    count = "two" if len(columns) == 2 else len(columns)
    for line in points:
        matches = line.numbers(columns)
        if None in matches:
            raise InputError(
                f"{name}, line {line.number}: a point is {count} numbers, got {shortened(', '.join(line.cells))}; mend "
                "the line, or put # before it if it is a comment"
            )
        here = [match[2] or "" for match in matches if match]
        units = units or here
        if here != units:
            raise InputError(
                f"{name}, line {line.number}: {shortened(', '.join(line.cells))} is in other units than the line above"
            )


def resolution_of(texts: list[str], values: list[float]) -> float:
    """The unit of the last digit of the large values: small values have more decimals, round ones fewer."""
    large = 0.1 * max(map(abs, values))
    return min(_last_digit(text) for text, value in zip(texts, values, strict=True) if abs(value) >= large)


def _last_digit(text: str) -> float:
    digits, _, exponent = text.replace(",", ".").lower().partition("e")
    return 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))


_MEMBER = re.compile(r"\s*(?:family\s+)?(IV|I{1,3})\s*(?:\((.*)\))?\s*", re.IGNORECASE)
_TABLES = (".csv", ".txt", ".tsv", ".tab", ".dat")
_ENDINGS = (".json", *_TABLES)
_OPTIONS: dict[str, Callable[[str], Any]] = {"tolerance": float, "columns": lambda text: tuple(text.split(","))}
#: a file's name, and the remark on its table in brackets
_OF_TABLE = re.compile(r"(.+)\((?=[^()]*=)([^()]*)\)", re.DOTALL)
_LONGEST = 100
#: before a formula that stands for a law
_FORMULA = "formula:"


def read_law(
    text: str | Path, *, tolerance: float | None = None, columns: Sequence[int | str] | None = None
) -> MotionLaw:
    """The law that a text names.

    Parameters
    ----------
    text
        A name or code of the catalogue ("modified sine", "0317(1,5)"), a member of Savin's families by alpha or B
        ("III(7.2)", "III(B=1.8)"), a formula of k ("formula: k - sin(2*pi*k)/(2*pi)"), the JSON text of a law, which
        begins with "{", a JSON file with a law, alone or of a solution, a file with a table of points (.csv, .txt,
        .tsv, .tab, .dat), whose tolerance and columns may stand behind it in brackets:
        "old.csv(tolerance=0.02; columns=1,3)".
    tolerance
        How far the law of a table may be off its points, in the unit of its displacements, 0 for a law through them;
        the last digit, or what its noise requires, unless given.
    columns
        Columns of the time or angle and of the displacement, by headings or numbers from 1; of a table of more than
        two.

    Warns
    -----
    NoisyTable
        If a table without a tolerance is noisy.

    Raises
    ------
    InputError
        If there is no such law, or the file cannot be read or holds none.

    Examples
    --------
    >>> read_law("Modified Sine").constants.C
    Peak(value=5.527957, k=0.125)
    >>> read_law("III(7.2)") == SavinFamily.of("III").law(7.2)
    True
    """
    file = text if isinstance(text, Path) else None
    if isinstance(text, str) and member(text) is None and is_file(text):
        name, options = _of_table(text)
        file, tolerance, columns = Path(name), options.get("tolerance", tolerance), options.get("columns", columns)
    if file is not None and file.suffix.lower() in _TABLES:
        return law_of_points(file, tolerance, columns)
    if tolerance is not None or columns is not None:
        raise InputError(
            f"a tolerance and columns are of a table of points ({', '.join(_TABLES)}), got {shortened(text)}"
        )
    if file is not None:
        return stored_law(file)
    if is_stored(str(text)):
        return MotionLaw.from_json(str(text))
    if is_formula(str(text)):
        from optlaws.laws.making.formula_law import formula_law

        return formula_law(str(text).lstrip().removeprefix(_FORMULA))
    chosen = member(str(text))
    if chosen is not None:
        family, alpha = chosen
        return family.law(alpha)
    return catalogue[str(text)].law


def _of_table(text: str) -> tuple[str, dict[str, Any]]:
    """The name of a file, with the remark on its table in brackets."""
    match = _OF_TABLE.fullmatch(text)
    if match is None or not match[1].lower().endswith(_TABLES):
        return text, {}
    options: dict[str, Any] = {}
    for part in match[2].split(";"):
        name, _, value = (piece.strip() for piece in part.partition("="))
        try:
            options[name] = _OPTIONS[name](value)
        except (KeyError, ValueError):
            raise InputError(
                f"options of a table are written as in old.csv(tolerance=0.02; columns=1,3), got {shortened(text)}"
            ) from None
    return match[1], options


def is_formula(text: str) -> bool:
    """Whether a text is taken for a formula: it begins with "formula:".

    Examples
    --------
    >>> is_formula("formula: k"), is_formula("modified sine")
    (True, False)
    """
    return text.lstrip().startswith(_FORMULA)


def is_stored(text: str) -> bool:
    """Whether a text is taken for the JSON text of a law: it begins with "{".

    Examples
    --------
    >>> is_stored(catalogue["cycloidal"].law.to_json()), is_stored("cycloidal")
    (True, False)
    """
    return text.lstrip().startswith("{")


def is_file(text: str) -> bool:
    """Whether a text means a file: it has the ending of a law or a table, or is no law's name but an existing file's.

    Examples
    --------
    >>> is_file("law.json"), is_file("modified sine")
    (True, False)
    """
    if is_formula(text) or is_stored(text):
        return False
    text = _of_table(text)[0]
    if text.lower().endswith(_ENDINGS):
        return True
    return text not in catalogue and reading.is_file(Path(text))


def is_table(text: str) -> bool:
    """Whether a text is taken for a file with a table of points.

    Examples
    --------
    >>> is_table("old.csv"), is_table("old.csv(tolerance=0.02)"), is_table("law.json")
    (True, True, False)
    """
    return _of_table(text)[0].lower().endswith(_TABLES)


def member(text: str) -> tuple[SavinFamily, float] | None:
    """The family and alpha of a text such as "III(7.2)" or "III(B=1.8)"; None where it names no family.

    Raises
    ------
    InputError
        If it names a family alone, or what is in brackets is no number, or no member.

    Examples
    --------
    >>> member("III(7.2)"), member("cubic")
    ((SavinFamily(u=2), 7.2), None)
    """
    match = _MEMBER.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None:
        return None
    family = SavinFamily.of(match[1].upper())
    if match[2] is None:
        low, high = map(float, family.range)
        name = match[1].upper()
        raise InputError(
            f"{family} has a law for each alpha from {low:.9g} to {high:.9g}: say which by {name}(alpha) or {name}(B=x)"
        )
    name, given, value = match[2].rpartition("=")
    try:
        number = float(value)
    except ValueError:
        raise InputError(
            f"a member is named by a number, such as III(7.2) or III(B=1.8), got {shortened(text)}"
        ) from None
    if given and name.strip() == "B":
        return family, family.alphas(B=number)[0]
    if given and name.strip().casefold() != "alpha":
        raise InputError(f"a member is named by alpha or B, such as III(7.2) or III(B=1.8), got {shortened(text)}")
    family.check(number)
    return family, number


def stored_law(file: Path) -> MotionLaw:
    """The law in a JSON file, alone or under "law" as in what `optlaws solve --output` writes.

    Raises
    ------
    InputError
        If the file cannot be read or holds no law.
    """
    data: Any = reading.json_file(file)
    if isinstance(data, dict) and "kind" not in data and "law" in data:
        data = data["law"]
    if not isinstance(data, dict) or "kind" not in data:
        entries = ", ".join(map(shortened, list(data)[:6])) if isinstance(data, dict) else ""
        contents = f"its entries are {entries}" if entries else "it is no object with entries"
        raise InputError(
            f"{file} holds no law: {contents}, and a law has a 'kind': `optlaws solve --output` writes laws"
        )
    try:
        return MotionLaw.from_dict(data)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def family_of(text: str) -> str | None:
    """The name I to IV if a text names a family, without a member.

    Examples
    --------
    >>> family_of(" iii "), family_of("III(7.2)")
    ('III', None)
    """
    name = text.strip().upper()
    return name if name in FAMILIES else None
