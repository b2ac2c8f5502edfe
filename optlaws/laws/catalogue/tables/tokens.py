"""What all tables are read from: text without its comments, and cells that are numbers, each with its line."""

from __future__ import annotations

import csv
import re
from bisect import bisect_right
from functools import lru_cache
from math import isfinite
from typing import NamedTuple

from optlaws.echo import shortened
from optlaws.errors import InputError

#: comments of IEC 61131-3, C and XML; to the end of a line behind // or #, which #Ignore and REAL#1.0 are not
_COMMENT = re.compile(
    r"\(\*.*?\*\)|/\*.*?\*/|<!--.*?-->|(?<!:)//[^\n]*|^[^\S\n]*[#%!][^\n]*|(?<=[^\s=])[^\S\n]+#[^\n]*",
    re.DOTALL | re.MULTILINE,
)
#: signs for which others stand where a text has been set
_SIGNS = str.maketrans({"−": "-", "\u00a0": " ", "\u202f": " ", "\ufeff": " "})
#: a number as written, and the unit behind it
NUMBER = re.compile(r"([+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?)\s*([^\W\d_][^\d\s]{0,9}|[°%\"'′″])?")
#: groups of three digits between marks, of which a decimal mark is another or comes but once
_GROUPED = re.compile(
    r"[+-]?\d{1,3}(?:(?:,\d{3})+\.\d*|(?:\.\d{3})+,\d*|(?:,\d{3}){2,}|(?:\.\d{3}){2,}|(?:['’ ]\d{3})+(?:[.,]\d*)?)"
)
#: types before literals of IEC 61131-3
_TYPED = re.compile(r"^(?:L?REAL|U?[SDL]?INT)#", re.IGNORECASE)


class TextCell(NamedTuple):
    """What stands between separators, and the line of the file."""

    text: str
    line: int

    def number(self, suffix: str = "") -> float:
        """The cell as a number: with the type of a literal before it, or a suffix of C behind it."""
        text = _TYPED.sub("", self.text).replace("_", "").rstrip(suffix)
        try:
            value = float(text)
        except ValueError:
            raise InputError(f"line {self.line}: {no_number(self.text)}") from None
        if not isfinite(value):
            raise InputError(f"line {self.line}: {self.text} is no finite number: mend it")
        return value


def uncommented(content: str) -> str:
    r"""A text without its comments; its lines keep their numbers.

    >>> uncommented("Lines = 2 # two\nBegintable # of 1e-4 deg\n0 0 (* here *)\nv := #Ignore; // none\n")
    'Lines = 2\nBegintable\n0 0  \nv := #Ignore; \n'
    """
    return _COMMENT.sub(lambda match: "\n" * match[0].count("\n") or " " * match[0].startswith(("(*", "/*")), content)


def line_of(text: str, place: int) -> int:
    r"""The line of a text, from 1, in which a place of it is.

    >>> line_of("a\nb\nc", 2)
    2
    """
    return bisect_right(_starts(text), place)


@lru_cache(maxsize=1)
def _starts(text: str) -> list[int]:
    return [0, *(match.end() for match in re.finditer("\n", text))]


def cells_of(line: str, separator: str | None) -> list[str]:
    """The cells of a line between separators; blanks part them where there are none.

    >>> cells_of("| 3.6 | 0.019 |", "|"), cells_of("1,5; 2,25 mm", ";"), cells_of("1 2", None)
    (['3.6', '0.019'], ['1,5', '2,25 mm'], ['1', '2'])
    """
    line = line.translate(_SIGNS).strip()
    if separator == "|":
        line = line.removeprefix("|").removesuffix("|")
    try:
        plain = separator is None or '"' not in line
        cells = line.split(separator) if plain else next(csv.reader([line], delimiter=separator or ""))
    except csv.Error:
        return []
    return [cell.strip().strip('"') for cell in cells]


def no_number(text: str) -> str:
    """What is to be said of a text that should be a number.

    >>> no_number("1,234.5"), no_number("12,5 mmm")
    ("'1,234.5' has separators of thousands: write 1234.5", "'12,5 mmm' is no number: mend it")
    """
    if _GROUPED.fullmatch(text) is None:
        return f"{shortened(text)} is no number: mend it"
    marks = re.findall(r"[.,'’ ]", text)
    decimal = marks[-1] if marks[-1] in ".," and marks.count(marks[-1]) == 1 and len(marks) > 1 else ""
    plain = re.sub(r"[.,'’ ]", lambda match: match[0] if match[0] == decimal else "", text)
    return f"{shortened(text)} has separators of thousands: write {plain}"
