"""The options of files for cutting: tolerance, decimals, points, degree, feed; quantities with their units."""

from __future__ import annotations

from typing import Literal, TypedDict

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Measured, Whole
from optlaws.errors import InputError
from optlaws.motion.quantities import positive_quantity
from optlaws.numbers import Quantity

DECIMALS, POINTS = Whole(0, 12), Whole(13, 100_000)
DEGREES = (3, 5)


CutFormat = Literal["dxf spline", "dxf polyline", "dxf arcs", "svg", "csv", "csv polar", "g-code", "g-code arcs"]


class CuttingOptions(TypedDict, total=False):
    """The options of files for cutting, each of which `Cutting` documents."""

    tolerance: Quantity | None
    decimals: int | None
    points: int | None
    degree: int | None
    feed: Quantity | None
    about: str | None


@declared
class Cutting(Declared, title="a file for cutting"):
    """The checked options of a file for cutting; `about` is what the file says of itself."""

    tolerance: Quantity = entry(
        Measured("length", above=0.0),
        "How far polygon, arcs or spline may be from the curve.",
        default="1 um",
    )
    decimals: int = entry(DECIMALS, "Of a millimetre.", default=6)
    points: int = entry(POINTS, "Of a table over the whole turn, the last being the first again.", default=721)
    degree: int = entry(Whole(min(DEGREES), max(DEGREES)), "That of splines, 3 or 5.", default=3)
    feed: Quantity | None = entry(
        Measured("velocity", above=0.0),
        "Of the tool; the file has none unless given.",
        default=None,
        example="200 mm/min",
    )
    about: str = "cam"

    def _check(self) -> None:
        if self.degree not in DEGREES:
            raise InputError(f"degree must be 3 or 5, got {self.degree}")
        if not isinstance(self.about, str):
            raise InputError(f"about must be text, got {shortened(self.about)}")

    @property
    def metres(self) -> float:
        return positive_quantity(self.tolerance, "length", "tolerance")

    @property
    def feed_rate(self) -> float:
        """The feed in mm a minute; 0 where none is given."""
        return 0.0 if self.feed is None else 60e3 * positive_quantity(self.feed, "velocity", "feed")

    @property
    def line(self) -> str:
        """The description of the file on one line of plain characters."""
        printable = "".join(
            character if " " <= character <= "~" and character not in "()<>&" else " " for character in self.about
        )
        return " ".join(printable.split())[:200] or "cam"

    def rounded(self, value: float) -> str:
        """A number of millimetres with the requested decimals; zero has no sign."""
        text = f"{value:.{self.decimals}f}"
        return text.removeprefix("-") if not text.strip("-0.") else text
