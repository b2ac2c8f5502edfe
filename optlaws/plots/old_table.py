"""Pictures of old tables: points and laws over the master, beside the laws that better them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from optlaws.cycles.old_tables.report import OldTableReport
from optlaws.errors import InputError
from optlaws.plots.report import mark_segments
from optlaws.plots.style import BLUES, GREY, WARM, one_below_the_other

if TYPE_CHECKING:
    from matplotlib.artist import Artist

    from optlaws.cycles.old_tables.table import OldTable

_LOOKS: dict[str, dict[str, Any]] = {
    "points": {"linestyle": "", "marker": ".", "markersize": 2.0, "color": GREY},
    "old law": {"color": BLUES[3], "linewidth": 1.3},
    "new law": {"color": WARM, "linewidth": 1.3},
}


def draw_old_table(table: OldTable, axes: Any = None, new: OldTable | None = None, **style: Any) -> list[Artist]:
    """Draw positions, velocity, acceleration and jerk into four axes; with a new table five, the second its difference.

    Points are those of the table. New axes unless given.
    """
    report = OldTableReport(table, new)
    shown = [panel for i, panel in enumerate(report.panels) if i != 1 or new is not None]
    panels = one_below_the_other(axes, len(shown), 2.0 * len(shown) + 0.4)
    if len(panels) != len(shown):
        raise InputError(f"ax must be {len(shown)} pairs of axes for this, got {len(panels)}")
    artists: list[Artist] = []
    for panel, each in zip(shown, panels, strict=True):
        for curve in panel.series:
            look = {"label": curve.name} | _LOOKS[curve.name] | ({} if curve.dots else style)
            artists += each.plot(curve.at, curve.values, **look)
        mark_segments(report.segments, each, panel)
        each.set_ylabel(f"{panel.name},\n{panel.unit}")
    panels[0].legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False, fontsize=8.0)
    panels[-1].set(xlabel=shown[0].across, xlim=(table.places[0], table.places[-1]))
    return artists
