"""Pictures of several axes over one time: a panel for each, or all in one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from optlaws.errors import InputError
from optlaws.numbers import derivative
from optlaws.plots.cycle import QUANTITIES, UNITS, draw_curve, mark_segments, name_segments
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, new_figure, plot_style, titled

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from optlaws.cycles.cycle import Cycle

_COLOURS = (BLUES[3], WARM, GREEN, GREY, *BLUES[:3])
_HEIGHT = 1.6


def axes_figure(cycles: Mapping[str, Cycle], title: str) -> Figure:
    """The positions of all axes, as a figure."""
    figure: Figure = draw_axes(cycles)[0].get_figure()  # type: ignore[assignment] # a figure of our own
    with plot_style():
        return titled(figure, title)


def draw_axes(
    cycles: Mapping[str, Cycle],
    axes: Any = None,  # noqa: ANN401 - matplotlib's
    *,
    nu: int = 0,
    **style: Any,  # noqa: ANN401 - matplotlib's
) -> list[Artist]:
    """Draw a derivative of every axis over time, and return the artists.

    Raises
    ------
    InputError
        If there are neither one nor as many axes of matplotlib, or nu is above 3.
    """
    order = derivative(nu)
    if order >= len(QUANTITIES):
        raise InputError(f"nu must be at most 3, the jerk, got {order}")
    if hasattr(axes, "plot"):
        return _draw_in_one(cycles, axes, order, style)
    if axes is None:
        with plot_style():
            figure = new_figure(8.6, 0.8 + _HEIGHT * len(cycles))
            axes = figure.subplots(len(cycles), 1, sharex=True, squeeze=False)[:, 0]
    panels = list(axes)
    if len(panels) != len(cycles):
        raise InputError(f"{len(cycles)} axes are drawn into one pair of axes or into as many, got {len(panels)}")
    artists: list[Artist] = []
    for panel, (name, cycle) in zip(panels, cycles.items(), strict=True):
        artists += draw_curve(cycle, panel, order, {"color": BLUES[3]} | style)
        panel.set_ylabel(f"{name}\n{QUANTITIES[order]}, {UNITS[cycle.axis][order][0]}")
        mark_segments(cycle, panel)
        name_segments(cycle, panel)
    _set_time(panels[-1], cycles)
    panels[0].figure.align_ylabels()
    return artists


def _draw_in_one(cycles: Mapping[str, Cycle], axes: Axes, nu: int, style: dict[str, Any]) -> list[Artist]:
    """All axes, each divided by its peak."""
    artists: list[Artist] = []
    for i, (name, cycle) in enumerate(cycles.items()):
        unit, size = UNITS[cycle.axis][nu]
        peak = cycle.peak(nu) or 1.0
        look = {"label": f"{name} / {peak * size:.6g} {unit}", "color": _COLOURS[i % len(_COLOURS)]} | style
        artists += draw_curve(cycle, axes, nu, look, share=1.0 / (peak * size))
    axes.set_ylabel(f"{QUANTITIES[nu]}, share of the peak")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False, fontsize=8.0)
    _set_time(axes, cycles)
    return artists


def _set_time(panel: Axes, cycles: Mapping[str, Cycle]) -> None:
    longest = max(cycle.duration for cycle in cycles.values())
    panel.set(xlabel="time, ms", xlim=(0.0, 1e3 * longest))
