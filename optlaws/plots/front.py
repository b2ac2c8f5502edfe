"""Plots of fronts: one constant over another, a third in colour, or what is least over the time of a move."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.plots.style import BLUES, GREY, WARM, new_axes
from optlaws.synthesis.problem.named_constants import title_of
from optlaws.tolerances import BESIDE_POINT

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from optlaws.cycles.moves.time_front import TimeFront
    from optlaws.synthesis.pareto import Front
    from optlaws.synthesis.proven.front import ProvenFront

_AXES = {"B": "peak velocity B", "C": "peak acceleration C", "D": "peak power D", "J": "peak jerk J"}

_BETWEEN = 8
_MS = 1e3


def _label(name: str) -> str:
    """The label of an axis for a constant: constants of machines have units of their own."""
    title = title_of(name)
    return title if title != name else f"{_AXES.get(name, name)} (dimensionless)"


def draw_front(front: Front, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw a front into axes, new ones unless given, and return the artists; a third constant gives the colour."""
    axes = axes or new_axes()
    for axis, name in zip("xy", front.over, strict=False):
        axes.set(**{f"{axis}label": _label(name)})
    values = front.values
    if len(front.over) == 2:
        return list(axes.plot(*values.T, **style))
    style = {"s": 18.0, "c": values[:, 2], **{key: value for key, value in style.items() if key != "color"}}
    points = axes.scatter(values[:, 0], values[:, 1], **style)
    bar = axes.get_figure(root=True).colorbar(points, ax=axes)  # type: ignore[union-attr] # these axes have a figure
    bar.set_label(_label(front.over[2]))
    return [points]


def draw_proven_front(front: ProvenFront, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw a proven front into axes, new ones unless given, as it is at every value, and return the artists."""
    axes = axes or new_axes()
    for axis, name in zip("xy", front.over, strict=True):
        axes.set(**{f"{axis}label": _label(name)})
    return list(axes.plot(*front.curve, **style))


def draw_time_front(front: TimeFront, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw a front over the time into axes, new ones unless given, with what no law is below; return the artists."""
    axes = axes or new_axes()
    colour = style.pop("color", BLUES[-1])
    label = style.pop("label", front.minimise)
    times = np.array(front.durations)
    lower, upper = np.array(front.lower_bounds), np.array(front.values)
    line = {"color": colour, "linewidth": 1.4, "linestyle": "-", "zorder": 4, **style}
    points = axes.plot(_MS * times, upper, marker="o", markersize=3.0, label=label, **line)
    if front.falls:
        # both sides jump at points, and are smooth between two of them
        near = [BESIDE_POINT * (high - low) for low, high in pairwise(times)]
        inside = [
            np.linspace(low + by, high - by, _BETWEEN) for by, (low, high) in zip(near, pairwise(times), strict=True)
        ]
        shown = np.unique(np.concatenate([times, *inside]))
        between = [front(float(time)) for time in shown]
        below = [point.lower_bound for point in between]
        bound = axes.plot(_MS * shown, below, color=GREY, linewidth=0.9, label="no law below")
        axes.fill_between(_MS * shown, below, [point.value for point in between], color=colour, alpha=0.15, linewidth=0)
    else:
        bound = axes.plot(_MS * times, lower, color=GREY, linewidth=0.0, marker="_", label="no law below")
    least = axes.axvline(_MS * front.fastest.duration, color=WARM, linewidth=1.0, linestyle="--", label="least time")
    axes.set(xlabel="time of the move in ms", ylabel=f"least {front.minimise} in {front.unit}")
    axes.set_ylim(bottom=0.0)
    return [*points, *bound, least]
