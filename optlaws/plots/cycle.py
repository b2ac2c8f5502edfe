"""Pictures of cycles: position, velocity, acceleration and jerk of one axis, or of all axes over one time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.summary import force_name, force_unit
from optlaws.errors import InputError
from optlaws.motion.display_units import UNITS
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import Array, derivative
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, new_figure, plot_style, titled
from optlaws.tolerances import INSIDE_PIECE

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_EACH = 200
_ABOVE: Any = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "ncols": 2, "frameon": False, "fontsize": 8.0}


def cycle_figure(cycle: Cycle, title: str) -> Figure:
    """The motion of one cycle, as a figure."""
    with plot_style():
        panels = _panels(cycle)
        draw_cycle(cycle, panels)
        figure: Figure = panels[0].figure
        figure.align_ylabels()
        return titled(figure, title)


def _panels(cycle: Cycle) -> list[Any]:
    """New axes: four, and with a drive two more, for its force (or torque) and its power."""
    if cycle.drive is not None:
        return list(new_figure(8.6, 11.6).subplots(6, 1, sharex=True))
    return list(new_figure(8.6, 8.2).subplots(4, 1, sharex=True))


def draw_cycle(cycle: Cycle, axes: Any = None, **style: Any) -> list[Artist]:
    """Draw position, velocity, acceleration and jerk into four axes, and return the artists.

    Into six axes force (or torque) and power as well. New axes unless given: six where the cycle has a drive.
    """
    if hasattr(axes, "plot"):
        return _draw_together(cycle, axes, style)
    if axes is None:
        with plot_style():
            axes = _panels(cycle)
    several = list(np.ravel(np.asarray(axes, dtype=object)))
    with_drive = several[4:] if len(several) == 6 and cycle.drive is not None else []
    from optlaws.plots.law import four

    panels = four(several[:4] if with_drive else several)
    artists: list[Artist] = []
    for nu, panel in enumerate(panels):
        artists += draw_curve(cycle, panel, nu, {"color": BLUES[3]} | style)
        mark_segments(cycle, panel)
        artists += _mark_limits(cycle, panel, nu)
    names = f"{force_name(cycle)}, {force_unit(cycle)}", "power, W"
    for panel, function, name in zip(with_drive, (cycle.force, cycle.power), names, strict=False):
        times, values = samples_of_drive(cycle, function, _EACH)
        artists += panel.plot(1e3 * times, values, **{"color": BLUES[3]} | style)
        panel.axhline(0.0, color=GREY, linewidth=0.7)
        panel.set_ylabel(name)
        mark_segments(cycle, panel)
    name_segments(cycle, panels[0])
    (with_drive or panels)[-1].set(xlabel="time, ms", xlim=(0.0, 1e3 * cycle.duration))
    return artists


def _draw_together(cycle: Cycle, axes: Axes, style: dict[str, Any]) -> list[Artist]:
    """All four derivatives, each divided by its peak, with the nearby limits."""
    artists: list[Artist] = []
    for nu, colour in enumerate((GREY, GREEN, BLUES[3], WARM)):
        lines, share = _draw_share(cycle, axes, nu, QUANTITIES[nu], {"color": colour} | style)
        artists += [*lines, *_mark_limits(cycle, axes, nu, share=share)]
    mark_segments(cycle, axes)
    axes.set(xlabel="time, ms", xlim=(0.0, 1e3 * cycle.duration), ylabel="share of the peak")
    axes.legend(**_ABOVE)
    return artists


def _draw_share(cycle: Cycle, axes: Axes, nu: int, name: str, style: dict[str, Any]) -> tuple[list[Artist], float]:
    """A derivative divided by its peak, which the legend states; also returns the divisor."""
    unit, size = UNITS[cycle.axis][nu]
    peak = (cycle.peak(nu) or 1.0) * size
    return draw_curve(cycle, axes, nu, {"label": f"{name} / {peak:.6g} {unit}"} | style, share=1.0 / peak), 1.0 / peak


def name_segments(cycle: Cycle, axes: Axes) -> None:
    """Write each segment's name above the axes."""
    above: Any = {"xycoords": ("data", "axes fraction"), "ha": "center", "va": "bottom", "fontsize": 8.0}
    for peaks in cycle.peaks:
        place = 1e3 * (peaks.start + 0.5 * peaks.duration)
        axes.annotate(peaks.name, (place, 1.02), color=GREY, **above)


def draw_curve(cycle: Cycle, axes: Axes, nu: int, style: dict[str, Any], share: float = 1.0) -> list[Artist]:
    """A derivative over the whole cycle."""
    unit, factor = UNITS[cycle.axis][nu]
    times, values = samples(cycle, nu, _EACH)
    axes.set_ylabel(f"{QUANTITIES[nu]}, {unit}")
    return list(axes.plot(1e3 * times, share * factor * values, **style))


def samples(cycle: Cycle, nu: int, count: int) -> tuple[Array, Array]:
    """Times and values of a derivative, at points in each piece and at its breaks; jumps are vertical lines."""
    times = [_times(piece, count) for piece in cycle.pieces]
    values = [piece.values(inside, nu) for piece, inside in zip(cycle.pieces, times, strict=True)]
    return np.concatenate(times), np.concatenate(values)


def samples_of_drive(cycle: Cycle, function: Callable[[Array], Array], count: int) -> tuple[Array, Array]:
    """Times and values of the drive's force or power, in the same form as for a derivative."""
    times = [_times(piece, count) for piece in cycle.pieces]
    # the end of a piece has its values, not those of the next
    ends = [piece.stop - INSIDE_PIECE * cycle.duration for piece in cycle.pieces]
    values = [function(np.minimum(inside, end)) for inside, end in zip(times, ends, strict=True)]
    return np.concatenate(times), np.concatenate(values)


def _times(piece: Piece, count: int) -> Array:
    breaks = piece.start + piece.duration * np.array(piece.law.breaks)
    return np.unique(np.concatenate([np.linspace(piece.start, piece.stop, count), breaks]))


def mark_segments(cycle: Cycle, axes: Axes) -> None:
    """A line at every joint."""
    for peaks in cycle.peaks[1:]:
        axes.axvline(1e3 * peaks.start, color=GREY, linewidth=0.7, linestyle=":")


def _mark_limits(cycle: Cycle, axes: Axes, nu: int, share: float = 1.0) -> list[Artist]:
    """The limits of each optimal segment, where they are within sight."""
    factor = share * UNITS[cycle.axis][nu][1]
    look: dict[str, Any] = {"color": WARM, "linewidth": 1.1, "linestyle": "--"}
    artists: list[Artist] = []
    for peaks, limits in zip(cycle.peaks, cycle.limits_of_segments, strict=True):
        span = [1e3 * peaks.start, 1e3 * (peaks.start + peaks.duration)]
        for limit in limits.get(nu, ()):
            if abs(limit) < 4.0 * max(cycle.peak(nu), 1e-300):
                artists += axes.plot(span, [limit * factor] * 2, **look)
    return artists


_COLOURS = (BLUES[3], WARM, GREEN, GREY, *BLUES[:3])
_HEIGHT = 1.6


def axes_figure(cycles: Mapping[str, Cycle], title: str) -> Figure:
    """The positions of all axes, as a figure."""
    figure: Figure = draw_axes(cycles)[0].get_figure()  # type: ignore[assignment] # a figure of our own
    with plot_style():
        return titled(figure, title)


def draw_axes(
    cycles: Mapping[str, Cycle],
    axes: Any = None,
    *,
    nu: int = 0,
    **style: Any,
) -> list[Artist]:
    """Draw a derivative of every axis over time, and return the artists."""
    nu = derivative(nu)
    if nu >= len(QUANTITIES):
        raise InputError(f"nu must be at most 3, the jerk, got {nu}")
    if hasattr(axes, "plot"):
        return _draw_in_one(cycles, axes, nu, style)
    if axes is None:
        with plot_style():
            figure = new_figure(8.6, 0.8 + _HEIGHT * len(cycles))
            axes = figure.subplots(len(cycles), 1, sharex=True, squeeze=False)[:, 0]
    panels = list(axes)
    if len(panels) != len(cycles):
        raise InputError(f"{len(cycles)} axes are drawn into one pair of axes or into as many, got {len(panels)}")
    artists: list[Artist] = []
    for panel, (name, cycle) in zip(panels, cycles.items(), strict=True):
        artists += draw_curve(cycle, panel, nu, {"color": BLUES[3]} | style)
        panel.set_ylabel(f"{name}\n{QUANTITIES[nu]}, {UNITS[cycle.axis][nu][0]}")
        mark_segments(cycle, panel)
        name_segments(cycle, panel)
    _set_time(panels[-1], cycles)
    panels[0].figure.align_ylabels()
    return artists


def _draw_in_one(cycles: Mapping[str, Cycle], axes: Axes, nu: int, style: dict[str, Any]) -> list[Artist]:
    """All axes, each divided by its peak."""
    artists: list[Artist] = []
    for i, (name, cycle) in enumerate(cycles.items()):
        artists += _draw_share(cycle, axes, nu, name, {"color": _COLOURS[i % len(_COLOURS)]} | style)[0]
    axes.set_ylabel(f"{QUANTITIES[nu]}, share of the peak")
    axes.legend(**_ABOVE)
    _set_time(axes, cycles)
    return artists


def _set_time(panel: Axes, cycles: Mapping[str, Cycle]) -> None:
    longest = max(cycle.duration for cycle in cycles.values())
    panel.set(xlabel="time, ms", xlim=(0.0, 1e3 * longest))
