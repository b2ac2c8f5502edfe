"""What a result reports: facts, tables, and curves with their limits and peaks, as values that each output renders."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple, Protocol, Self

from optlaws.numbers import Array, bounded
from optlaws.shown.showing import drawing, page, table
from optlaws.shown.summary import Row, Summary


class ReportTable(NamedTuple):
    """A table: headings with the units of their columns, and rows."""

    headings: Sequence[str]
    rows: Sequence[Sequence[Any]]

    @classmethod
    def of_columns(cls, columns: Mapping[str, Iterable[Any]]) -> Self:
        """A table of columns by their headings."""
        return cls(list(columns), [list(row) for row in zip(*columns.values(), strict=True)])

    @classmethod
    def of_pairs(cls, facts: Iterable[Row], first: str, second: str, last: str = "at, deg") -> Self:
        """A table of facts whose values are pairs, each under a heading; the last column has places, or else notes.

        Examples
        --------
        >>> from optlaws.shown.summary import Row
        >>> ReportTable.of_pairs([Row("radius", (5.0, None), "mm", note="optimal")], "value", "bound", "status").rows
        [['radius', 5.0, None, 'mm', 'optimal']]
        """
        rows = []
        for row in facts:
            ends = (None if end is None else bounded(end) for end in row.value)
            rows.append([row.name, *ends, row.unit, row.place if last.startswith("at,") else row.note])
        return cls(["what", first, second, "unit", last], rows)


@dataclass(frozen=True)
class Section:
    """A part of a result's report.

    Attributes
    ----------
    heading
        What stands above it; nothing where it goes on with what is before.
    facts
        Its facts.
    table
        A table that says more than these.
    data
        Its entries for programs.
    figure
        The name of a picture, and its caption.
    draw
        The picture under a title, unless it is made elsewhere.
    text, note
        What stands above and below the table.
    digits
        Of its numbers.
    """

    heading: str = ""
    facts: Sequence[Row] = ()
    table: ReportTable | None = None
    data: Mapping[str, Any] = field(default_factory=dict)
    figure: tuple[str, str] | None = None
    text: str = ""
    note: str = ""
    digits: int = 7
    draw: Callable[[str], Any] | None = None


class ReportSegment(NamedTuple):
    """A segment of what is drawn, with the times at which it begins and ends."""

    name: str
    start: float
    stop: float


class PanelLimit(NamedTuple):
    """The least and the greatest value that a quantity may have from one time to another; infinite where none."""

    start: float
    stop: float
    low: float
    high: float
    name: str = ""


class Series(NamedTuple):
    """A curve of a panel: times and values, the number of its colour, its name, and whether it is points alone."""

    at: Array
    values: Array
    law: int | str = 0
    name: str = ""
    dots: bool = False


@dataclass(frozen=True)
class Panel:
    """A quantity over time in a unit for display: its curves, its limits and its peaks.

    Attributes
    ----------
    name, unit
        The quantity, and the unit of all values.
    series
        The curves.
    limits
        Limits of the quantity.
    peaks
        Times and values that are marked, from the law and not from the curve.
    ends
        The least and the greatest value, from the law as well.
    across, per
        What the values are over, and how many of its unit are 1 of the places of curves, limits and peaks; times are
        in seconds, and shown in milliseconds.
    """

    name: str
    unit: str
    series: tuple[Series, ...]
    limits: tuple[PanelLimit, ...] = ()
    peaks: tuple[tuple[float, float], ...] = ()
    ends: tuple[float, float] = (0.0, 0.0)
    across: str = "time, ms"
    per: float = 1e3

    @property
    def title(self) -> str:
        """The name with its unit."""
        return f"{self.name}, {self.unit}" if self.unit else self.name

    @property
    def peak(self) -> float:
        """The greatest magnitude of the curve."""
        return max(map(abs, self.ends))

    def with_curves(self, curves: Sequence[tuple[int, Panel]]) -> Panel:
        """The panel with the curves of several instead of its own, each in a colour of its own."""
        series = tuple(curve._replace(law=law) for law, panel in curves for curve in panel.series)
        lows, highs = zip(*(panel.ends for _, panel in curves), strict=True)
        return replace(self, series=series, ends=(min(lows), max(highs)))


class Report(Protocol):
    """What every report has; its parts are computed when they are needed."""

    @property
    def facts(self) -> Summary:
        """Rows of facts with their units, places and notes."""

    @property
    def tables(self) -> Sequence[ReportTable]:
        """Tables of the details."""

    @property
    def panels(self) -> Sequence[Panel]:
        """Curves over the time."""

    @property
    def segments(self) -> Sequence[ReportSegment]:
        """Segments of the time."""

    @property
    def data(self) -> dict[str, Any]:
        """The result for programs, in SI units."""


@dataclass(frozen=True)
class PlainReport:
    """A report of what is known already, but for the data, which are computed when they are needed."""

    facts: Summary
    tables: Sequence[ReportTable]
    panels: Sequence[Panel]
    plain: Callable[[], dict[str, Any]]
    segments: Sequence[ReportSegment] = ()

    @property
    def data(self) -> dict[str, Any]:
        """The result for programs, in SI units."""
        return self.plain()


def report_page(title: object, report: Report) -> str:
    """A report as HTML: its facts, its tables, and a small drawing of every panel."""
    tables = (table(*each) for each in report.tables)
    return page(title, report.facts._repr_html_(), *tables, *map(panel_drawing, report.panels))


def panel_drawing(panel: Panel) -> str:
    """A small drawing of the first curve of a panel, as HTML; of what is not over the time, above its least value."""
    at, values, *_ = panel.series[0]
    if panel.across == Panel.across:
        return drawing(panel.title, at.tolist(), values.tolist())
    return drawing(f"{panel.title} over {panel.across}", at.tolist(), (values - max(panel.ends[0], 0.0)).tolist())
