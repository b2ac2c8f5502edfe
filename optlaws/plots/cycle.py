"""Pictures of cycles: position, velocity, acceleration and jerk of one axis, or of all axes over one time."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from optlaws.cycles.report import CycleReport
from optlaws.errors import InputError
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import derivative
from optlaws.plots.report import draw_panels, draw_share, mark_segments, set_range
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, one_below_the_other

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from optlaws.cycles.answers import Answers, Solved


_ABOVE: Any = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "ncols": 2, "frameon": False, "fontsize": 8.0}
_MOTION = len(QUANTITIES)
_WITH_DRIVE = 6


def draw_cycle(plan: Solved, axes: Any = None, **style: Any) -> list[Artist]:
    """Draw position, velocity, acceleration and jerk into four axes, and return the artists.

    Into six axes force (or torque) and power as well. New axes unless given: six where the cycle has a drive.
    """
    if hasattr(axes, "plot"):
        return _draw_together(plan, axes, style)
    from optlaws.plots.law import four

    report = CycleReport(plan)
    count = _MOTION if plan.drive is None else _WITH_DRIVE
    several = one_below_the_other(axes, count, 8.2 if plan.drive is None else 11.6)
    driven = len(several) == _WITH_DRIVE and plan.drive is not None
    into = several if driven else four(several)
    for axis in into[_MOTION:]:
        axis.axhline(0.0, color=GREY, linewidth=0.7)
    return draw_panels(report.panels[: len(into)], report.segments, into, **style)


def _draw_together(plan: Solved, axes: Axes, style: dict[str, Any]) -> list[Artist]:
    """All four derivatives, each divided by its peak, with the nearby limits."""
    report, artists = CycleReport(plan), list["Artist"]()
    motion = report.panels[:_MOTION]
    for panel, colour in zip(motion, (GREY, GREEN, BLUES[3], WARM), strict=True):
        artists += draw_share(panel, axes, panel.name, **{"color": colour} | style)
    mark_segments(report.segments, axes, motion[0])
    set_range(axes, motion)
    axes.set(ylabel="share of the peak")
    axes.legend(**_ABOVE)
    return artists


_COLOURS = (BLUES[3], WARM, GREEN, GREY, *BLUES[:3])
_HEIGHT = 1.6


def draw_axes(
    cycles: Mapping[str, Answers],
    axes: Any = None,
    *,
    nu: int = 0,
    **style: Any,
) -> list[Artist]:
    """Draw a derivative of every axis over time, and return the artists."""
    nu = derivative(nu)
    if nu >= len(QUANTITIES):
        raise InputError(f"nu must be at most 3, the jerk, got {nu}")
    shown = {name: CycleReport(cycle) for name, cycle in cycles.items()}
    panels = [replace(report.panel(nu), limits=()) for report in shown.values()]
    artists: list[Artist] = []
    if hasattr(axes, "plot"):
        for i, (name, panel) in enumerate(zip(shown, panels, strict=True)):
            artists += draw_share(panel, axes, name, **{"color": _COLOURS[i % len(_COLOURS)]} | style)
        axes.set_ylabel(f"{QUANTITIES[nu]}, share of the peak")
        axes.legend(**_ABOVE)
        set_range(axes, panels)
        return artists
    several = one_below_the_other(axes, len(cycles), 0.8 + _HEIGHT * len(cycles))
    if len(several) != len(cycles):
        raise InputError(f"{len(cycles)} axes are drawn into one pair of axes or into as many, got {len(several)}")
    for each, panel, (name, report) in zip(several, panels, shown.items(), strict=True):
        artists += draw_panels([panel], report.segments, [each], **style)
        each.set(xlabel="", ylabel=f"{name}\n{panel.title}")
    set_range(several[-1], panels)
    return artists
