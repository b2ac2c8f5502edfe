"""The options of files for cutting: tolerance, decimals, points, degree, feed; quantities with their units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypedDict

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.motion.quantities import positive_quantity
from optlaws.numbers import Quantity, whole

MOST_POINTS = 100_000
MOST_DECIMALS = 12
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


@dataclass(frozen=True)
class Cutting:
    """The checked options of a file for cutting.

    `tolerance` is how far polygon, arcs or spline may be from the curve, `decimals` are of a millimetre, `points` those
    of a table over the whole turn, the last being the first again, `degree` is that of splines, 3 or 5. Without a
    `feed`, such as "300 mm/min", the file has none; `about` is what it says of itself.
    """

    tolerance: Quantity = "1 um"
    decimals: int = 6
    points: int = 721
    degree: int = 3
    feed: Quantity | None = None
    about: str = "cam"

    def __post_init__(self) -> None:
        self.metres, self.feed_rate  # noqa: B018 - wrong quantities are refused at once
        whole(self.decimals, "decimals", most=MOST_DECIMALS)
        whole(self.points, "points", least=13, most=MOST_POINTS)
        if self.degree not in DEGREES:
            raise InputError(f"degree must be 3 or 5, got {shortened(self.degree)}")
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
