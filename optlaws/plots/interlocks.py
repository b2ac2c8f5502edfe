"""Pictures of interlocked axes: the timing diagram, the plane of two positions, and clearances over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from optlaws.cycles.interlocks.after import After
from optlaws.cycles.interlocks.clearance import Clearance, bound_of
from optlaws.cycles.interlocks.forbidden_region import Forbidden, corners_of
from optlaws.cycles.interlocks.interlock import SMALL_UNITS
from optlaws.cycles.machine_axes import AxesPicture
from optlaws.cycles.specification.segments import Dwell
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.motion.derivative_panel import samples
from optlaws.motion.display_units import TURN_DEG, UNITS
from optlaws.numbers import Array
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
    from collections.abc import Mapping, Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from optlaws.cycles.cycle import Cycle
    from optlaws.cycles.interlocks.interlock import Interlock, LeastClearance

_COUNT = 2401
_HALF = 0.34  # of a bar's height; rows are 1 apart


def draw_interlocked(
    cycles: Mapping[str, Cycle],
    interlocks: Sequence[Interlock],
    axes: Any,
    what: AxesPicture,
    interlock: int | str,
    style: dict[str, Any],
) -> list[Artist]:
    """Draw the axes with the conditions of their interlocks, and return the artists."""
    check_names([what], get_args(AxesPicture), "picture")
    if what == "timing":
        return _timing(cycles, interlocks, axes, style)
    if not interlocks:
        raise InputError(f"axes without interlocks have no picture of the {what}: give them interlocks=[...]")
    if what == "plane":
        return _plane(cycles, interlocks, _chosen(interlocks, interlock), axes, style)
    return _clearances(cycles, interlocks, axes, style)


def _chosen(interlocks: Sequence[Interlock], which: int | str) -> Interlock:
    labels = {each.label: each for each in interlocks}
    if isinstance(which, str):
        check_names([which], labels, "interlock")
        return labels[which]
    if not 0 <= which < len(interlocks):
        raise InputError(f"interlock must be from 0 to {len(interlocks) - 1}, got {which}")
    return interlocks[which]


def _timing(
    cycles: Mapping[str, Cycle], interlocks: Sequence[Interlock], axes: Axes | None, style: dict[str, Any]
) -> list[Artist]:
    """A row for each axis: moves as bars with the position in them, dwells as lines; arrows from what comes first."""
    if axes is None:
        with plot_style():
            axes = new_figure(8.6, 0.9 + 0.8 * len(cycles)).subplots()
    rows = {name: -i for i, name in enumerate(cycles)}
    artists: list[Artist] = []
    for i, (name, cycle) in enumerate(cycles.items()):
        artists += _bars(axes, cycle, rows[name], {"color": DISTINCT[i % len(DISTINCT)]} | style)
    for interlock in interlocks:
        if isinstance(interlock, After):
            artists += _arrows(axes, cycles, interlock, rows)
    axes.set_yticks(list(rows.values()), list(rows))
    axes.set(xlabel="master, deg", xlim=(0.0, TURN_DEG), ylim=(min(rows.values()) - 0.6, 0.6))
    axes.set_xticks(np.arange(0.0, TURN_DEG + 1.0, 30.0))
    axes.grid(visible=False, axis="y")
    return artists


def _bars(axes: Axes, cycle: Cycle, row: float, style: dict[str, Any]) -> list[Artist]:
    scale = TURN_DEG / cycle.duration
    times, values = samples(cycle.pieces, 0, 60)
    low, high = float(values.min()), float(values.max())
    heights = row - _HALF + 2.0 * _HALF * (values - low) / ((high - low) or 1.0)
    artists: list[Artist] = list(axes.plot(scale * times, heights, **{"linewidth": 1.4} | style))
    for segment, peaks in zip(cycle.segments, cycle.peaks, strict=True):
        place, width = scale * peaks.start, scale * peaks.duration
        if not isinstance(segment, Dwell):
            look: dict[str, Any] = {"alpha": 0.22, "linewidth": 0.0} | style
            artists += axes.bar(place + 0.5 * width, 2.0 * _HALF, width, row - _HALF, **look)
        label = f"{segment.name} {width:.4g}°" if segment.name else f"{width:.4g}°"
        if width > 4.0 * len(label) or not isinstance(segment, Dwell):
            words: Any = {"ha": "center", "va": "bottom", "fontsize": 7.5, "color": GREY}
            still = isinstance(segment, Dwell)
            words |= {} if still else {"ha": "left"}
            artists.append(axes.text(place + (0.5 * width if still else 1.0), row + _HALF, label, **words))
    return artists


def _arrows(axes: Axes, cycles: Mapping[str, Cycle], rule: After, rows: Mapping[str, float]) -> list[Artist]:
    """From when the other axis came beyond its position to when this one passes its own."""
    scale = TURN_DEG / next(iter(cycles.values())).duration
    artists: list[Artist] = []
    position, level = rule.positions(cycles)
    for time, entry, clear in rule.events(cycles):
        colour = GREEN if clear else WARM
        end = scale * time, _height(cycles[rule.axis], position, rows[rule.axis])
        if entry is not None:
            start = scale * entry, _height(cycles[rule.of], level, rows[rule.of])
            look: Any = {"arrowstyle": "-|>", "color": colour, "shrinkA": 2.0, "shrinkB": 2.0, "linewidth": 1.2}
            artists.append(axes.annotate("", end, xytext=start, arrowprops=look))
            artists += axes.plot(*start, "o", color=colour, markersize=3.5)
        artists += axes.plot(*end, "o", color=colour, markersize=3.5)
    return artists


def _height(cycle: Cycle, position: float, row: float) -> float:
    """The height of a position within the bar of a row."""
    values = samples(cycle.pieces, 0, 60)[1]
    low, high = float(values.min()), float(values.max())
    return row - _HALF + 2.0 * _HALF * (position - low) / ((high - low) or 1.0)


def _plane(
    cycles: Mapping[str, Cycle],
    interlocks: Sequence[Interlock],
    rule: Interlock,
    axes: Axes | None,
    style: dict[str, Any],
) -> list[Artist]:
    """The path of two positions, what is forbidden to it shaded, and where it is nearest."""
    if axes is None:
        with plot_style():
            axes = new_figure(6.4, 4.6).subplots()
    across, up = plane_axes(rule)
    times = np.linspace(0.0, cycles[across].duration, _COUNT)
    sizes = [UNITS[cycles[name].axis][0] for name in (across, up)]
    x, y = (size * cycles[name](times) for name, (_, size) in zip((across, up), sizes, strict=True))
    artists: list[Artist] = list(axes.plot(x, y, **{"color": BLUES[3]} | style))
    # before axes are widened by what is forbidden
    limits = [wider([values]) for values in (x, y)]
    for each in interlocks:
        if set(each.axes) == {across, up}:
            artists += _forbidden(axes, cycles, each, (across, up), limits)
            least = each.least_clearance(cycles)
            point = tuple(
                size * float(cycles[name](least.time)) for name, (_, size) in zip((across, up), sizes, strict=True)
            )
            colour = GREEN if least.status == "clear" else WARM
            artists += axes.plot(*point, "o", color=colour, markersize=4.5)
            beside = (6.0, 4.0) if point[0] < 0.5 * sum(limits[0]) else (-6.0, 4.0)
            artists.append(name_point(axes, least.text, (point[0], point[1]), beside))
    axes.set(xlabel=f"{across}, {sizes[0][0]}", ylabel=f"{up}, {sizes[1][0]}", xlim=limits[0], ylim=limits[1])
    return artists


def plane_axes(rule: Interlock) -> tuple[str, str]:
    """The axis of an interlock on the horizontal of its plane, and the axis on the vertical."""
    if isinstance(rule, Clearance):
        return rule.over, rule.axis
    return rule.axes


def _forbidden(
    axes: Axes, cycles: Mapping[str, Cycle], rule: Interlock, plane: tuple[str, str], limits: Sequence[Any]
) -> list[Artist]:
    """Regions that an interlock forbids, in the units of the picture; of an `After` the wall that is not passed."""
    region = forbidden_region(cycles, rule, plane, limits)
    if region is None:
        return []
    if isinstance(rule, After):
        return list(axes.plot(*region.T, color=WARM, linestyle=":"))
    look: Any = {"color": WARM, "alpha": 0.25, "linewidth": 0.0}
    return list(axes.fill(*region.T, **look))


def forbidden_region(
    cycles: Mapping[str, Cycle], rule: Interlock, plane: tuple[str, str], limits: Sequence[tuple[float, float]]
) -> Array | None:
    """The corners of an interlock's forbidden region in the plane of two axes, shape (n, 2), small units; or None.

    Of an `After` they are the two ends of a wall. `limits` are the least and the greatest position to the right and up,
    up to which the forbidden side of a bound, or a wall, reaches.
    """
    sizes = [UNITS[cycles[name].axis][0][1] for name in plane]
    along, across = (0, 1) if rule.axes[0] != plane[0] else (1, 0)
    if isinstance(rule, Forbidden):
        corners = corners_of(rule, *(cycles[name].axis for name in rule.axes))
        return np.array([corner[::-1] if along == 0 else corner for corner in corners]) * sizes
    if isinstance(rule, After):
        passed, level = rule.positions(cycles)
        wall = np.empty((2, 2))
        wall[:, across] = passed * sizes[across]
        wall[:, along] = level * sizes[along], limits[along][0 if rule.sign > 0.0 else 1]
        return wall
    if not isinstance(rule, Clearance):
        return None
    bound = bound_of(rule, *(cycles[name].axis for name in rule.axes))
    places = np.linspace(*limits[along], _COUNT)
    edge = bound(places / sizes[along]) * sizes[across]
    side = limits[across][0 if rule.sign > 0.0 else 1]
    region = np.empty((_COUNT + 2, 2))
    region[:, along] = [*places, places[-1], places[0]]
    region[:, across] = [*edge, side, side]
    return region


def wider(values: Sequence[Array]) -> tuple[float, float]:
    """The range of positions with a little room on both sides."""
    low, high = min(float(each.min()) for each in values), max(float(each.max()) for each in values)
    room = 0.06 * ((high - low) or 1.0)
    return low - room, high + room


def _clearances(
    cycles: Mapping[str, Cycle],
    interlocks: Sequence[Interlock],
    axes: Any,
    style: dict[str, Any],
) -> list[Artist]:
    """The clearance of every interlock over the master, with the least of each."""
    panels = one_below_the_other(axes, len(interlocks), 0.9 + 1.7 * len(interlocks))
    if len(panels) != len(interlocks):
        raise InputError(f"{len(interlocks)} interlocks are drawn into as many axes, got {len(panels)}")
    artists: list[Artist] = []
    duration = next(iter(cycles.values())).duration
    times = np.linspace(0.0, duration, _COUNT)
    for panel, rule in zip(panels, interlocks, strict=True):
        least = rule.least_clearance(cycles)
        artists += _clearance(panel, cycles, rule, least, times, style)
    panels[-1].set(xlabel="master, deg", xlim=(0.0, TURN_DEG))
    panels[-1].set_xticks(np.arange(0.0, TURN_DEG + 1.0, 30.0))
    return artists


def _clearance(
    panel: Axes,
    cycles: Mapping[str, Cycle],
    rule: Interlock,
    least: LeastClearance,
    times: Array,
    style: dict[str, Any],
) -> list[Artist]:
    unit, size = SMALL_UNITS.get(least.unit, (least.unit, 1.0))
    room, degrees = size * rule.room(cycles, times), TURN_DEG * times / times[-1]
    artists: list[Artist] = list(panel.plot(degrees, room, **{"color": BLUES[3]} | style))
    panel.axhline(0.0, color=GREY, linewidth=0.8)
    artists.append(panel.fill_between(degrees, np.minimum(room, 0.0), 0.0, color=WARM, alpha=0.25, linewidth=0.0))
    if isinstance(rule, After):
        passes = np.array([event[0] for event in rule.events(cycles)])
        look: Any = {"color": GREY, "markersize": 4.5}
        artists += panel.plot(TURN_DEG * passes / times[-1], size * rule.room(cycles, passes), "o", **look)
    point = least.angle, size * least.clearance
    artists += panel.plot(*point, "o", color=GREEN if least.status == "clear" else WARM, markersize=4.5)
    artists.append(name_point(panel, least.text, point, at=(6.0, 4.0) if least.angle < 0.6 * TURN_DEG else (-6.0, 4.0)))
    panel.set_title(rule.label, fontsize=8.5, color=GREY)
    panel.set_ylabel(f"clearance, {unit}")
    return artists
