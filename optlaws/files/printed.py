"""Printed numbers beside recomputed ones, and the verdict on each."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import ROUND_DOWN, ROUND_HALF_UP, Decimal, InvalidOperation
from pathlib import Path

from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.files import reading

REPRODUCED = "reproduced to its digits"
ON_GRID = "reproduced to its digits on the paper's grid"
MISPRINT = "misprint"


@dataclass(frozen=True)
class PrintedNumber:
    """A printed number, its recomputed value, and their agreement.

    Attributes
    ----------
    row, quantity
        Where it is printed.
    printed
        Its digits.
    exact, on_grid
        The number recomputed; the greatest value on the grid that the paper took, if it took one.
    verdict, reason
        What is printed about it, and why.
    """

    row: str
    quantity: str
    printed: str
    exact: float | None
    on_grid: float | None
    verdict: str
    reason: str


def compared(
    row: str,
    quantity: str,
    printed: str,
    exact: float,
    *,
    on_grid: float | None,
    misprint: str | None,
    peak: str = "the peak between them",
) -> PrintedNumber:
    """Compare a printed number with the exact one and, where given, with the greatest value on the paper's grid.

    `peak` says what the exact number is beside the values on the grid.

    A number is reproduced to its digits where the exact one, rounded to as many, is the printed one. The value on the
    grid may be rounded or cut: the paper does both.

    Examples
    --------
    >>> compared("1.859", "C", "5.91", 5.919585, on_grid=5.913140, misprint=None).verdict
    "reproduced to its digits on the paper's grid"
    """
    off = abs(exact / float(printed) - 1.0)
    if misprint is not None:
        verdict, reason = MISPRINT, misprint
    elif same_digits(printed, exact, ROUND_HALF_UP):
        verdict, reason = REPRODUCED, ""
    elif on_grid is not None and same_digits(printed, on_grid, ROUND_HALF_UP, ROUND_DOWN):
        verdict = ON_GRID
        reason = f"printed is the greatest value at the grid's points; {peak} is off by {100 * off:.2g} %"
    else:
        verdict, reason = f"reproduced to {100 * off:.{1 if off < 1e-3 else 2}g} %", ""
    return PrintedNumber(row, quantity, printed, exact, on_grid, verdict, reason)


def rows(file: Path, columns: tuple[str, ...] | None = None) -> list[Mapping[str, str]]:
    """Rows of a CSV file of printed data, of any columns unless they are given; lines that start with # are comments.

    Raises
    ------
    InputError
        If the file cannot be read or has other columns.
    """
    with located(f"cannot read the printed data {file}"):
        text = reading.text(file)
    reader = csv.DictReader(line for line in text.splitlines() if line and not line.startswith("#"))
    columns = tuple(reader.fieldnames or ()) if columns is None else columns
    if tuple(reader.fieldnames or ()) != columns:
        raise InputError(f"{file} must have the columns {', '.join(columns)}, got {reader.fieldnames}")
    lines: list[Mapping[str, str]] = list(reader)
    for i, row in enumerate(lines, 1):
        if None in row or None in row.values():
            raise InputError(f"{file}: row {i} must have {len(columns)} cells ({', '.join(columns)})")
    return lines


def number(text: str, where: str) -> float:
    """A number as printed.

    Raises
    ------
    InputError
        If it is not a finite number.
    """
    try:
        value = Decimal(text)
    except InvalidOperation:
        value = Decimal("nan")
    if not value.is_finite():
        raise InputError(f"{where}: {shortened(text)} is not a number")
    return float(value)


def same_digits(printed: str, exact: float, *roundings: str) -> bool:
    """Whether a number has the printed digits after rounding, half up by default.

    Examples
    --------
    >>> same_digits("2.187", 2.1875), same_digits("2.187", 2.1875, ROUND_DOWN)
    (False, True)
    """
    unit = Decimal(1).scaleb(Decimal(printed).as_tuple().exponent)  # type: ignore[arg-type] # finite: it is parsed
    # what a table prints as 1.53 may come out as 1.5299999999
    tried = Decimal(repr(round(exact, 9)))
    return Decimal(printed) in {tried.quantize(unit, rounding) for rounding in roundings or (ROUND_HALF_UP,)}
