"""The points of a table with the functions between them, whatever the layout of its file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from optlaws.laws.catalogue.tables.curve_pieces import CurvePiece, check_joints, joined
from optlaws.numbers import Array


class TableUnits(NamedTuple):
    """The units of the master and of positions; empty where they are not known."""

    master: str = ""
    slave: str = ""


NO_UNITS = TableUnits()


@dataclass(frozen=True)
class TablePoints:
    """The points of a table, and the functions between them where it states these.

    Attributes
    ----------
    places, heights
        Times, angles or lengths, and positions, as the table has them, arrays of shape (n,).
    digit
        The unit of the last digit of the positions; 0 where functions are stated.
    layout
        What the file is.
    pieces
        What runs between the points; empty where that is not stated.
    units
        Where the layout says them; of columns the headings.
    lines
        Where the points stand in the file.
    rate
        How many units of the master go by in a second, where the file says it.
    """

    places: Array
    heights: Array
    digit: float
    layout: str
    pieces: tuple[CurvePiece, ...] = ()
    units: TableUnits = NO_UNITS
    lines: Sequence[int] = ()
    rate: float | None = None

    @classmethod
    def of_pieces(
        cls, pieces: Sequence[CurvePiece], layout: str, lines: Sequence[int], units: TableUnits = NO_UNITS
    ) -> TablePoints:
        """Pieces that follow each other, with the points where they meet."""
        check_joints(pieces, lines)
        pieces = joined(pieces)
        places = [*(piece.start for piece in pieces), pieces[-1].stop]
        heights = [*(piece.ends[0] for piece in pieces), pieces[-1].ends[1]]
        return cls(np.array(places), np.array(heights), 0.0, layout, tuple(pieces), units, lines)


def resolution_of(texts: Sequence[str], values: Sequence[float] | Array) -> float:
    """The unit of the last digit of the large values: small values have more decimals, round ones fewer.

    >>> resolution_of(["0.0001", "12.5", "30.25"], [0.0001, 12.5, 30.25])
    0.01
    """
    large = 0.1 * max(map(abs, values))
    return min(_last_digit(text) for text, value in zip(texts, values, strict=True) if abs(value) >= large)


def _last_digit(text: str) -> float:
    digits, _, exponent = text.replace(",", ".").lower().partition("e")
    return float(f"1e{int(exponent or 0) - len(digits.partition('.')[2])}")
