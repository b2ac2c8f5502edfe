"""Pictures of interlocked axes: the timing diagram, the plane of two positions, and clearances over the master."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from optlaws.cycles.axes.interlock import After
from optlaws.cycles.axes.machine_answers import AxesPicture
from optlaws.cycles.specification.segments import Dwell
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.motion.quantities import TURN_DEG
from optlaws.plots.report import draw_panel
from optlaws.plots.style import (
    BLUES,
    DISTINCT,
    GREEN,
    GREY,
    WARM,
    name_point,
    new_figure,
    one_below_the_other,
    plot_style,
)

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from optlaws.cycles.axes.interlock import LeastClearance
    from optlaws.cycles.axes.report import Arrow, AxesReport
    from optlaws.shown.report import Panel

_HALF = 0.34  # of a bar's height; rows are 1 apart
_NEAR_TITLE = 0.8  # of the height of a panel: words above a higher point would meet its title


def draw_interlocked(
    report: AxesReport, axes: Any, what: AxesPicture, interlock: int | str, style: dict[str, Any]
) -> list[Artist]:
    """Draw the axes with the conditions of their interlocks, and return the artists."""
    check_names([what], get_args(AxesPicture), "picture")
    if what == "timing":
        return _timing(report, axes, style)
    if not report.rules:
        raise InputError(f"axes without interlocks have no picture of the {what}: give them interlocks=[...]")
    return _plane(report, interlock, axes, style) if what == "plane" else _clearances(report, axes, style)


def _timing(report: AxesReport, axes: Axes | None, style: dict[str, Any]) -> list[Artist]:
    """A row for each axis: moves as bars with the position in them, dwells as lines; arrows from what comes first."""
    if axes is None:
        with plot_style():
            axes = new_figure(8.6, 0.9 + 0.8 * len(report.cycles)).subplots()
    rows = {panel.name: (-i, panel) for i, panel in enumerate(report.positions)}
    artists: list[Artist] = []
    for i, name in enumerate(rows):
        artists += _bars(report, name, axes, rows[name], {"color": DISTINCT[i % len(DISTINCT)]} | style)
    for arrow in report.arrows:
        artists += _arrow(report, arrow, axes, rows)
    axes.set_yticks([row for row, _ in rows.values()], list(rows))
    axes.set(xlabel="master, deg", xlim=(0.0, TURN_DEG), ylim=(0.4 - len(rows), 0.6))
    axes.set_xticks(np.arange(0.0, TURN_DEG + 1.0, 30.0))
    axes.grid(visible=False, axis="y")
    return artists


def _bars(report: AxesReport, name: str, axes: Axes, row: tuple[int, Panel], style: dict[str, Any]) -> list[Artist]:
    cycle, (place_of_row, panel) = report.cycles[name], row
    scale, (curve,) = TURN_DEG / cycle.duration, panel.series
    heights = _height(curve.values, row)
    artists: list[Artist] = list(axes.plot(scale * curve.at, heights, **{"linewidth": 1.4} | style))
    for segment, peaks in zip(cycle.segments, cycle.peaks, strict=True):
        place, width, still = scale * peaks.start, scale * peaks.duration, isinstance(segment, Dwell)
        if not still:
            look: dict[str, Any] = {"alpha": 0.22, "linewidth": 0.0} | style
            artists += axes.bar(place + 0.5 * width, 2.0 * _HALF, width, place_of_row - _HALF, **look)
        label = f"{segment.name} {width:.4g}°" if segment.name else f"{width:.4g}°"
        if width > 4.0 * len(label) or not still:
            words: Any = {"ha": "center" if still else "left", "va": "bottom", "fontsize": 7.5, "color": GREY}
            at = place + (0.5 * width if still else 1.0)
            artists.append(axes.text(at, place_of_row + _HALF, label, **words))
    return artists


def _arrow(report: AxesReport, arrow: Arrow, axes: Axes, rows: dict[str, tuple[int, Panel]]) -> list[Artist]:
    """From when the other axis came beyond its position to when this one passes its own."""
    scale, colour = TURN_DEG / report.duration, GREEN if arrow.clear else WARM
    waits, of = report.rules[arrow.number].axes
    artists: list[Artist] = []
    end = scale * arrow.end[0], _height(arrow.end[1], rows[waits])
    if arrow.start is not None:
        start = scale * arrow.start[0], _height(arrow.start[1], rows[of])
        look: Any = {"arrowstyle": "-|>", "color": colour, "shrinkA": 2.0, "shrinkB": 2.0, "linewidth": 1.2}
        artists.append(axes.annotate("", end, xytext=start, arrowprops=look))
        artists += axes.plot(*start, "o", color=colour, markersize=3.5)
    return [*artists, *axes.plot(*end, "o", color=colour, markersize=3.5)]


def _height(position: Any, row: tuple[int, Panel]) -> Any:
    """The height of a position, or of several, within the bar of a row."""
    place, panel = row
    low, high = panel.ends
    return place - _HALF + 2.0 * _HALF * (position - low) / ((high - low) or 1.0)


def _plane(report: AxesReport, interlock: int | str, axes: Axes | None, style: dict[str, Any]) -> list[Artist]:
    """The path of two positions, what is forbidden to it shaded, and where it is nearest."""
    rules = report.rules
    labels = [rule.label for rule in rules]
    if isinstance(interlock, str):
        check_names([interlock], labels, "interlock")
        interlock = labels.index(interlock)
    if not 0 <= interlock < len(rules):
        raise InputError(f"interlock must be from 0 to {len(rules) - 1}, got {interlock}")
    plane = next((each for each in report.planes if set(each.axes) == set(rules[interlock].axes)), None)
    if plane is None:
        raise InputError(f"interlock {labels[interlock]} is of velocities, which have no plane: choose another one")
    if axes is None:
        with plot_style():
            axes = new_figure(6.4, 4.6).subplots()
    across, up = (next(panel for panel in report.positions if panel.name == name) for name in plane.axes)
    x, y = across.series[0], up.series[0]
    artists: list[Artist] = list(axes.plot(x.values, y.values, **{"color": BLUES[3]} | style))
    for number, region in plane.regions.items():
        if isinstance(rules[number], After):
            artists += axes.plot(*region.T, color=WARM, linestyle=":")
        else:
            artists += axes.fill(*region.T, color=WARM, alpha=0.25, linewidth=0.0)
        least = report.clearances[number]
        right, above = (float(report.position(name, least.time)) for name in plane.axes)
        artists += _least(axes, least, (right, above), right=right < 0.5 * sum(plane.ranges[0]))
    axes.set(xlabel=across.title, ylabel=up.title, xlim=plane.ranges[0], ylim=plane.ranges[1])
    return artists


def _least(axes: Axes, least: LeastClearance, point: tuple[float, float], *, right: bool) -> list[Artist]:
    """A point with the least clearance in words on one side of it."""
    colour = GREEN if least.status == "clear" else WARM
    bottom, top = axes.get_ylim()
    # above the point there is room for words, but not beneath the title
    high = point[1] > bottom + _NEAR_TITLE * (top - bottom)
    words = name_point(axes, least.text, point, at=(6.0 if right else -6.0, -12.0 if high else 4.0))
    return [*axes.plot(*point, "o", color=colour, markersize=4.5), words]


def _clearances(report: AxesReport, axes: Any, style: dict[str, Any]) -> list[Artist]:
    """The clearance of every interlock over the master, with the least of each."""
    clearances = report.clearances
    several = one_below_the_other(axes, len(clearances), 0.9 + 1.7 * len(clearances))
    if len(several) != len(clearances):
        raise InputError(f"{len(clearances)} interlocks are drawn into as many axes, got {len(several)}")
    artists: list[Artist] = []
    scale = TURN_DEG / report.duration
    for number, (each, least) in enumerate(zip(several, clearances, strict=True)):
        panel = report.clearance(number, least)
        (curve,) = panel.series
        artists += draw_panel(panel, each, **style)
        if isinstance(least.interlock, After):
            passes = [0.5 * (limit.start + limit.stop) for limit in panel.limits]
            look: Any = {"color": GREY, "markersize": 4.5}
            artists += each.plot(scale * np.array(passes), np.interp(passes, *curve[:2]), "o", **look)
        else:
            below: Any = {"color": WARM, "alpha": 0.25, "linewidth": 0.0}
            artists.append(each.fill_between(scale * curve.at, np.minimum(curve.values, 0.0), 0.0, **below))
        artists += _least(each, least, (least.angle, panel.peaks[0][1]), right=least.angle < 0.6 * TURN_DEG)
        rule = least.interlock
        # before its position the other axis may be wherever nothing passes
        of = f": how far {rule.of} is beyond its position" if isinstance(rule, After) else ""
        each.set_title(f"{rule.label}{of}", fontsize=8.5, color=GREY)
        each.set_ylabel(panel.unit if of else f"clearance, {panel.unit}")
    several[-1].set(xlabel="master, deg", xlim=(0.0, TURN_DEG))
    several[-1].set_xticks(np.arange(0.0, TURN_DEG + 1.0, 30.0))
    return artists
