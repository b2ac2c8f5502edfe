"""The points of a table with the functions between them, whatever the layout of its file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from optlaws.laws.catalogue.tables.curve_pieces import CurvePiece, check_joints


@dataclass(frozen=True)
class TablePoints:
    """The points of a table, and the functions between them where it states these.

    Attributes
    ----------
    places, heights
        Times, angles or lengths, and positions, as the table has them.
    digit
        The unit of the last digit of the positions; 0 where functions are stated.
    layout
        What the file is.
    pieces
        What runs between the points; empty where that is not stated.
    units
        Of places and positions, where the layout or a heading says them; else empty.
    lines
        Where the points stand in the file.
    """

    places: list[float]
    heights: list[float]
    digit: float
    layout: str
    pieces: tuple[CurvePiece, ...] = ()
    units: tuple[str, str] = ("", "")
    lines: Sequence[int] = ()

    @classmethod
    def of_pieces(
        cls, pieces: Sequence[CurvePiece], layout: str, lines: Sequence[int], units: tuple[str, str] = ("", "")
    ) -> TablePoints:
        """Pieces that follow each other, with the points where they meet."""
        check_joints(pieces, lines)
        places = [*(piece.start for piece in pieces), pieces[-1].stop]
        heights = [*(piece.ends[0] for piece in pieces), pieces[-1].ends[1]]
        return cls(places, heights, 0.0, layout, tuple(pieces), units, lines)


def resolution_of(texts: Sequence[str], values: Sequence[float]) -> float:
    """The unit of the last digit of the large values: small values have more decimals, round ones fewer.

    >>> resolution_of(["0.0001", "12.5", "30.25"], [0.0001, 12.5, 30.25])
    0.01
    """
    large = 0.1 * max(map(abs, values))
    return min(_last_digit(text) for text, value in zip(texts, values, strict=True) if abs(value) >= large)


def _last_digit(text: str) -> float:
    digits, _, exponent = text.replace(",", ".").lower().partition("e")
    return float(f"1e{int(exponent or 0) - len(digits.partition('.')[2])}")
