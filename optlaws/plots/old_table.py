"""Pictures of old tables: points and laws over the master, beside the laws that better them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cycles.old_tables.better_moves import law_of_move
from optlaws.errors import InputError
from optlaws.laws.report import broken
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import Array
from optlaws.plots.style import BLUES, GREY, WARM, one_below_the_other

if TYPE_CHECKING:
    from matplotlib.artist import Artist

    from optlaws.cycles.old_tables.stretches import Stretch
    from optlaws.cycles.old_tables.table import OldTable

_EACH = 400  # samples in a move


def draw_old_table(table: OldTable, axes: Any = None, new: OldTable | None = None, **style: Any) -> list[Artist]:
    """Draw positions, velocity, acceleration and jerk into four axes; with a new table five, the second its difference.

    Points are those of the table. New axes unless given.
    """
    count = 4 if new is None else 5
    panels = one_below_the_other(axes, count, 2.0 * count + 0.4)
    if len(panels) != count:
        raise InputError(f"ax must be {count} pairs of axes for this, got {len(panels)}")
    points: dict[str, Any] = {"linestyle": "", "marker": ".", "markersize": 2.0, "color": GREY, "label": "points"}
    artists: list[Artist] = list(panels[0].plot(table.places, table.heights, **points))
    shown = [panels[0], *panels[count - 3 :]]
    for each, look in ((table, {"color": BLUES[3], "label": "old law"}), (new, {"color": WARM, "label": "new law"})):
        if each is None:
            continue
        for nu, panel in enumerate(shown):
            artists += panel.plot(*curve(each, nu), **{"linewidth": 1.3} | look | style)
    if new is not None:
        artists += _difference(table, new, panels[1])
    for nu, panel in enumerate(shown):
        panel.set_ylabel(f"{QUANTITIES[nu]},\n{table.unit_of(nu)}")
    for panel in panels:
        for part in table.stretches[1:]:
            panel.axvline(part.start, color=GREY, linewidth=0.7, linestyle=":")
    panels[0].legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False, fontsize=8.0)
    panels[-1].set(xlabel=f"master, {table.master}", xlim=(table.places[0], table.places[-1]))
    return artists


def _difference(table: OldTable, new: OldTable, panel: Any) -> list[Artist]:
    """The deviation of the points, and of the new law, from the old law."""
    at = np.linspace(table.places[0], table.places[-1], 8 * _EACH)
    points: dict[str, Any] = {"linestyle": "", "marker": ".", "markersize": 2.0, "color": GREY}
    artists = list(panel.plot(table.places, table.heights - table.at(table.places), **points))
    artists += panel.plot(at, new.at(at) - table.at(at), color=WARM, linewidth=1.3)
    panel.set_ylabel(f"off the old\nlaw, {table.unit}")
    return artists


def curve(table: OldTable, nu: int, count: int = _EACH) -> tuple[Array, Array]:
    """Places of the master and values of a derivative by it, broken by nan where it jumps."""
    parts = [curve_of_part(part, nu, count) for part in table.stretches]
    places, values = (np.concatenate(row) for row in zip(*parts, strict=True))
    return places, values


def curve_of_part(part: Stretch, nu: int, count: int = _EACH) -> tuple[Array, Array]:
    """Places of the master in a stretch and values of a derivative by it, through its extremes."""
    length, base = part.stop - part.start, part.low if nu == 0 else 0.0
    if part.law is None:
        return np.array([part.start, part.stop]), np.full(2, base)
    law = law_of_move(part)
    k, values = broken(law, nu, count)
    peaks = [] if nu == 0 else [peak.k for peak in law.extrema(nu) if np.isfinite(peak.value)]
    more = np.setdiff1d(peaks, k)
    k, values = np.concatenate([k, more]), np.concatenate([values, np.asarray(law(more, nu))])
    order = np.argsort(k, kind="stable")
    return part.start + length * k[order], base + part.stroke / length**nu * values[order]
