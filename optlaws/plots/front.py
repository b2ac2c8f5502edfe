"""Plots of fronts: one constant over another, a third in colour."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from optlaws.plots.style import new_axes
from optlaws.synthesis.problem.named_constants import title_of

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from optlaws.synthesis.pareto import Front
    from optlaws.synthesis.proven.front import ProvenFront

_AXES = {"B": "peak velocity B", "C": "peak acceleration C", "D": "peak power D", "J": "peak jerk J"}


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
