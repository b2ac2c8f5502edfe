"""Laws in tables of points: CSV files of cam programs, controllers, measuring machines, master and slave in columns."""

from __future__ import annotations

import re
from pathlib import Path

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.laws.law import MotionLaw
from optlaws.laws.making.through_points import MOST_THROUGH, law_through

_LARGEST = 20_000_000
_MOST_POINTS = 100_000
_SEPARATORS = (";", "\t", ",", None)
_COMMENTS = ("#", "//", "(*", "%", "!")
_NUMBER = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?")
#: a table whose last digit is less of the stroke is taken as exact
_EXACT = 1e-8
#: and one of which it is more says nothing of velocities
_COARSEST = 0.01

Point = tuple[str, str]


def law_of_points(file: Path) -> MotionLaw:
    """The law of a table of points: within one unit of the last digit, or through the points where digits are many.

    The first number of a line is the time or angle, the second the displacement, both in any unit; more are not looked
    at. Numbers stand between commas, semicolons, tabs or spaces, with points, or commas where these do not part them.
    Lines before the first numbers are headings.

    Raises
    ------
    InputError
        If the file cannot be read, a line after the headings does not begin with two numbers, or no law
        keeps to the points.
    """
    points = _points(reading.text(file, _LARGEST), str(file))
    k, a = ([_value(text) for text in column] for column in zip(*points, strict=True))
    unit, stroke = _resolution([text for _, text in points], a), abs(a[-1] - a[0])
    if unit > _COARSEST * stroke > 0.0:
        raise InputError(f"{file}: the displacements have too few digits, {unit:g} of a stroke of {stroke:g}")
    try:
        return law_through(k, a, 0.0 if unit <= _EXACT * stroke and len(k) <= MOST_THROUGH else unit)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def _points(content: str, name: str) -> list[Point]:
    lines = [(number, line.strip()) for number, line in enumerate(content.splitlines(), 1)]
    told = [(number, line) for number, line in lines if line and not line.startswith(_COMMENTS)]
    parted = max(_SEPARATORS, key=lambda mark: sum(_point(line, mark) is not None for _, line in told))
    points: list[Point] = []
    for number, line in told:
        point = _point(line, parted)
        if point is not None:
            points.append(point)
        elif points:
            raise InputError(f"{name}, line {number}: a point is two numbers, got {shortened(line)}")
        if len(points) > _MOST_POINTS:
            raise InputError(f"{name} has more than {_MOST_POINTS} points")
    if not points:
        raise InputError(f"{name} holds no points: lines of a time or an angle and a displacement, such as 7.5,0.0959")
    return points


def _point(line: str, parted: str | None) -> Point | None:
    """The first two cells of a line as written, if they are numbers."""
    cells = [cell.strip().strip('"') for cell in line.split(parted)[:2]]
    return (cells[0], cells[1]) if len(cells) == 2 and all(map(_NUMBER.fullmatch, cells)) else None


def _value(text: str) -> float:
    return float(text.replace(",", "."))


def _resolution(texts: list[str], values: list[float]) -> float:
    """The unit of the last digit of the large values: small ones have more decimals, round ones fewer."""
    large = 0.1 * max(map(abs, values))
    return min(_last_digit(text) for text, value in zip(texts, values, strict=True) if abs(value) >= large)


def _last_digit(text: str) -> float:
    digits, _, exponent = text.replace(",", ".").lower().partition("e")
    return 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))
