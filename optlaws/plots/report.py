"""Pictures of reports: each panel's curves with its limits over time, in one pair of axes or one below the other."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from itertools import groupby, pairwise
from math import isfinite
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from optlaws.plots.style import BLUES, GREY, WARM, one_below_the_other, rendered
from optlaws.shown.showing import cell, table
from optlaws.shown.summary import Summary

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from optlaws.shown.report import Panel, Report, ReportSegment

#: a limit is drawn up to so many times what is used of it on its side
_NEAR = 4.0
_INCHES = 2.0  # of a page for each panel
_PRINTED = (
    "body{font:9.5pt sans-serif;margin:12mm;color:#000;background:#fff}h1{font-size:14pt}"
    "table{border-collapse:collapse;margin:1em 0}td,th{text-align:left;padding:1px 1em 1px 0;vertical-align:top}"
    "tr:first-child{border-bottom:1px solid #888}img{display:block;width:100%;max-width:18cm;break-inside:avoid}"
)


def draw_panels(
    panels: Sequence[Panel],
    segments: Sequence[ReportSegment],
    axes: Sequence[Axes],
    **style: Any,
) -> list[Artist]:
    """Draw panels into as many axes, one below the other, under the names of the segments; return the artists."""
    artists: list[Artist] = []
    for panel, each in zip(panels, axes, strict=True):
        artists += draw_panel(panel, each, **style)
        mark_segments(segments, each, panel)
    above: Any = {"xycoords": ("data", "axes fraction"), "ha": "center", "va": "bottom", "fontsize": 8.0}
    for name, start, stop in segments:
        axes[0].annotate(name, (panels[0].per * 0.5 * (start + stop), 1.02), color=GREY, **above)
    set_range(axes[-1], panels)
    return artists


def draw_panel(panel: Panel, axes: Axes, *, share: float = 1.0, **style: Any) -> list[Artist]:
    """Draw the curves of a panel, multiplied by a share, and its limits where these are within sight."""
    artists, per = list["Artist"](), panel.per
    for curve in panel.series:
        artists += axes.plot(per * curve.at, share * curve.values, **{"color": BLUES[3]} | style)
    for start, stop, low, high, name in panel.limits:
        look: dict[str, Any] = {"color": WARM, "linewidth": 1.1, "linestyle": "--"} | ({"label": name} if name else {})
        look |= {"marker": "D", "markersize": 5.0} if start == stop else {}
        for limit, (side, end) in {low: (-1.0, panel.ends[0]), high: (1.0, panel.ends[1])}.items():
            # a limit far from what is used would flatten the curve
            if side * limit < _NEAR * max(side * end, np.finfo(float).tiny):
                artists += axes.plot([per * start, per * stop], [share * limit] * 2, **look)
    axes.set_ylabel(panel.title)
    return artists


def draw_share(panel: Panel, axes: Axes, name: str, **style: Any) -> list[Artist]:
    """Draw a panel divided by its peak, or by the highest sample where it has none, which the legend states."""
    size = (panel.peak if isfinite(panel.peak) else float(np.nanmax(np.abs(panel.series[0].values)))) or 1.0
    label = f"{name} / {size:.6g} {panel.unit}".rstrip() if panel.unit or size != 1.0 else name
    return draw_panel(panel, axes, share=1.0 / size, **{"label": label} | style)


def mark_segments(segments: Sequence[ReportSegment], axes: Axes, panel: Panel) -> None:
    """A line at every joint."""
    for _, after in pairwise(segments):
        axes.axvline(panel.per * after.start, color=GREY, linewidth=0.7, linestyle=":")


def set_range(axes: Axes, panels: Sequence[Panel]) -> None:
    """The whole of the longest curve; of times and angles from 0 on."""
    per = panels[0].per
    longest = max(float(curve.at[-1]) for panel in panels for curve in panel.series)
    least = min(float(panel.series[0].at[0]) if per == 1.0 else 0.0 for panel in panels)
    axes.set(xlabel=panels[0].across, xlim=(per * least, per * longest))


def printable_page(title: object, report: Report, notes: str = "") -> str:
    """A report as a file of HTML by itself, to be read anywhere and printed: facts, tables, pictures of its panels."""
    headings, *rows = Summary((row.on_page() for row in report.facts), report.facts.at).cells(digits=6)
    tables = [table(headings, rows), *(table(*each) for each in report.tables)]
    grouped = groupby(report.panels, lambda panel: panel.across)
    pictures = [_picture(list(panels), report.segments) for _, panels in grouped]
    head = f'<meta charset="utf-8"><title>{cell(title)}</title><style>{_PRINTED}</style>'
    lines = "".join(f"<p>{cell(line)}</p>" for line in notes.splitlines())
    body = "".join([f"<h1>{cell(title)}</h1>{lines}", *tables, *pictures])
    return f'<!doctype html>\n<html lang="en"><head>{head}</head><body>{body}</body></html>\n'


def _picture(panels: Sequence[Panel], segments: Sequence[ReportSegment]) -> str:
    """Panels over one abscissa as an image that the page contains."""
    axes = one_below_the_other(None, len(panels), _INCHES * len(panels) + 0.4)
    draw_panels(panels, segments, axes)
    text = b64encode(rendered(cast("Figure", axes[0].get_figure(root=True)), "svg")).decode()
    return f'<img alt="{cell(", ".join(panel.title for panel in panels))}" src="data:image/svg+xml;base64,{text}">'
