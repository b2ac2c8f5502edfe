"""Summaries of results: a name, a value with its unit, its place and a note in a row, as text and as HTML."""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees
from typing import Any, NamedTuple, Self

#: units in which pages show lengths, angles and velocities, and how many of each are one of SI
PAGE_UNITS = {
    "m": ("mm", 1e3),
    "m/s": ("mm/s", 1e3),
    "rad": ("deg", degrees(1.0)),
    "rad/s": ("deg/s", degrees(1.0)),
}


class Row(NamedTuple):
    """A row of a summary.

    Attributes
    ----------
    name
        What it is.
    value
        A number, the two ends of an interval, a text, or None.
    unit
        Of the value; empty where it has none.
    place
        Where the value is reached, in the unit that the summary names; None where that says nothing.
    note
        What is to be known of the value.

    Examples
    --------
    >>> Row("C", 5.527957070544, place=0.125).text(), Row("B", (1.5, 1.6)).text(3)
    ('5.527957071', '1.5 to 1.6')
    """

    name: str
    value: Any = None
    unit: str = ""
    place: float | None = None
    note: str = ""

    def text(self, digits: int = 10) -> str:
        """The value to a number of digits.

        Examples
        --------
        >>> Row("status", "optimal").text(), Row("").text()
        ('optimal', '')
        """
        if self.value is None or isinstance(self.value, str):
            return self.value or ""
        ends = self.value if isinstance(self.value, tuple) else (self.value,)
        return " to ".join(dict.fromkeys(f"{end:.{digits}g}" for end in ends))

    def on_page(self) -> Row:
        """The row in the unit in which pages show its dimension.

        Examples
        --------
        >>> Row("velocity", 0.616, "m/s").on_page(), Row("C", 5.5).on_page().unit
        (Row(name='velocity', value=616.0, unit='mm/s', place=None, note=''), '')
        """
        if self.unit not in PAGE_UNITS or isinstance(self.value, str | None):
            return self
        unit, factor = PAGE_UNITS[self.unit]
        ends = tuple(factor * end for end in (self.value if isinstance(self.value, tuple) else (self.value,)))
        return self._replace(unit=unit, value=ends if isinstance(self.value, tuple) else ends[0])


class Summary(tuple[Row, ...]):  # noqa: SLOT001 - what places are is kept beside the rows
    """Rows of facts on a result, which print as a table and appear as one in a notebook.

    Parameters
    ----------
    rows
        Of the result.
    at
        What places are, such as "k" or "deg".

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> summary = smoothstep(3).constants.summary()
    >>> summary[1].name, summary[1].value, summary.at
    ('C', 5.773503, 'k')
    >>> summary
              value        at k
    B          1.875        0.5
    C          5.773502692  0.211325
    D          6.694268727  0.311018
    J          60           0
    RMS of c   4.140393356
    """

    at: str

    def __new__(cls, rows: Iterable[Row], at: str = "") -> Self:
        """Build a summary from its rows."""
        summary = super().__new__(cls, rows)
        summary.at = at
        return summary

    def cells(self, digits: int = 10) -> list[list[str]]:
        """Headings and rows as texts, without the columns that are empty."""
        rows = [
            (row.name, row.text(digits), row.unit, "" if row.place is None else f"{row.place:.6g}", row.note)
            for row in self
        ]
        shown = [0, *(column for column in range(1, 5) if any(row[column] for row in rows))]
        headings = ("", "value", "unit", f"at {self.at}".strip(), "note")
        return [[row[column] for column in shown] for row in (headings, *rows)]

    def __repr__(self) -> str:
        lines = self.cells()
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        padded = (zip(line, widths, strict=True) for line in lines)
        return "\n".join("  ".join(cell.ljust(width) for cell, width in line).rstrip() for line in padded)

    def _repr_html_(self) -> str:
        from optlaws.shown.showing import table

        headings, *rows = self.cells(digits=7)
        return table(headings, rows)
